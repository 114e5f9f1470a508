use super::pointer::{self, Pointers};
use super::scan::Found;
use crate::build::budget::Budget;
use crate::scene::{ImportError, quoted};
use gltf::json::Root;
use serde_json::error::Category;
use serde_json::{Value, json};

/// The structures of a JSON text, and what had to be changed to fit them.
pub(super) struct Parsed {
    pub(super) root: Root,
    /// How many channels of animations had no node to move.
    pub(super) dropped: usize,
    pub(super) pointers: Pointers,
}

/// Structures of a text take more than the text: their bytes are taken from the budget before they are made.
pub(super) fn parse(text: &[u8], found: &Found, budget: &mut Budget) -> Result<Parsed, ImportError> {
    if text.is_empty() {
        return Err(ImportError::new("JSON", "glTF 2.0", "nothing"));
    }
    budget.take(found.bytes, 1).map_err(|exceeded| exceeded.at("JSON"))?;
    let first = match Root::from_slice(text) {
        Ok(root) if !pointer::may_occur(text) => {
            return Ok(Parsed { root, dropped: 0, pointers: Pointers::default() });
        }
        Ok(_) => None,
        Err(error) => Some(error),
    };
    // The tree is gone when the structures are made.
    let more_for_tree = found.bytes_of_tree.saturating_sub(found.bytes);
    if let Err(exceeded) = budget.check(more_for_tree) {
        return Err(first.map_or_else(|| exceeded.at("JSON"), |error| wrong(&error)));
    }
    if let Ok(mut value) = serde_json::from_slice::<Value>(text) {
        if let Some(error) = other_version(&value) {
            return Err(error);
        }
        let pointers = pointer::resolve(&mut value);
        // A target without a node is valid and means nothing (section 3.11), as is a scene without nodes
        // (3.5.1), but the structures insist on both.
        let dropped = drop_channels_without_node(&mut value);
        let is_changed = add_nodes_to_scenes(&mut value) + dropped > 0 || pointers.changed;
        let text = serde_json::to_vec(&value).unwrap_or_default();
        drop(value);
        return match (Root::from_slice(&text), first) {
            (Ok(root), _) => Ok(Parsed { root, dropped, pointers }),
            // Places in the file's own text say more than those in a changed one.
            (Err(_), Some(error)) if !is_changed => Err(wrong(&error)),
            (Err(error), _) => Err(wrong(&error)),
        };
    }
    Err(first.map_or_else(|| ImportError::new("JSON", "glTF 2.0", "another text"), |error| wrong(&error)))
}

fn wrong(error: &serde_json::Error) -> ImportError {
    let place = format!("JSON, line {}, column {}", error.line(), error.column());
    let reason = error.to_string();
    // The place stands in front of it.
    let reason = reason.split(" at line ").next().unwrap_or_default();
    match error.classify() {
        Category::Syntax | Category::Eof => {
            ImportError::new(place, "valid JSON", format!("a mistake in it ({reason})"))
        }
        Category::Data | Category::Io => ImportError::new(place, "glTF 2.0", reason),
    }
}

/// Files of glTF 1.0 have objects where 2.0 has lists: their version tells more than the first of these.
fn other_version(root: &Value) -> Option<ImportError> {
    let found = match root.get("asset")?.get("version")? {
        Value::String(version) if version == "2" || version.starts_with("2.") => return None,
        Value::String(version) => quoted(version),
        Value::Number(version) => version.to_string(),
        _ => return None,
    };
    Some(ImportError::new("asset.version", "glTF 2.0", found))
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

fn add_nodes_to_scenes(root: &mut Value) -> usize {
    let scenes = root.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten();
    let empty = scenes.filter_map(Value::as_object_mut).filter(|scene| !scene.contains_key("nodes"));
    empty.map(|scene| scene.insert("nodes".to_owned(), json!([]))).count()
}

/// A number that f32 can hold.
pub(super) fn float(value: &Value) -> Option<f32> {
    value.as_f64().map(|value| value as f32).filter(|value| value.is_finite())
}

/// A value of the file in a message.
pub(super) fn shortened(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(60) {
        None => text,
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}
