use crate::ImportError;
use gltf::json::{Root, deserialize};
use serde_json::Value;

/// The structures of a JSON text, and how many channels of animations had no node to move.
pub(super) fn parse(text: &[u8]) -> Result<(Root, usize), ImportError> {
    let first = match deserialize::from_slice(text) {
        Ok(root) => return Ok((root, 0)),
        Err(error) => error,
    };
    // A target without a node is valid and means nothing (section 3.11), but the structure insists on one.
    if first.to_string().contains("missing field `node`")
        && let Ok(mut value) = deserialize::from_slice::<Value>(text)
    {
        let dropped = drop_channels_without_node(&mut value);
        if dropped > 0 {
            let text = serde_json::to_vec(&value).unwrap_or_default();
            return deserialize::from_slice(&text).map(|root| (root, dropped)).map_err(|error| wrong(&error));
        }
    }
    Err(wrong(&first))
}

fn wrong(error: &serde_json::Error) -> ImportError {
    let place = format!("JSON, line {}, column {}", error.line(), error.column());
    ImportError::new(place, "glTF 2.0", error.to_string())
}

fn drop_channels_without_node(root: &mut Value) -> usize {
    let mut dropped = 0;
    for animation in root.get_mut("animations").and_then(Value::as_array_mut).into_iter().flatten() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let before = channels.len();
        channels.retain(|channel| channel.get("target").is_none_or(|target| target.get("node").is_some()));
        dropped += before - channels.len();
    }
    dropped
}
