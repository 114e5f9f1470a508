//! `KHR_animation_pointer`: channels that name what they move by its place in the JSON.

use serde_json::{Value, json};
use std::collections::BTreeMap;

const NAME: &str = "KHR_animation_pointer";

/// Channels that plain glTF has no words for.
#[derive(Debug, Default)]
pub(super) struct Pointers {
    /// By animation and channel.
    pub(super) special: BTreeMap<(usize, usize), Special>,
    /// Animations and pointers of channels that are left out.
    pub(super) left_out: Vec<(usize, String)>,
    /// Whether there were any.
    pub(super) changed: bool,
}

/// What such a channel of weights moves.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Special {
    /// A mesh: all nodes that show it and have no weights of their own.
    pub(super) mesh: Option<usize>,
    /// One weight of all.
    pub(super) weight: Option<usize>,
}

/// What a pointer leads to.
#[derive(Debug, PartialEq)]
enum Place<'p> {
    Node(usize, &'p str),
    NodeWeight(usize, usize),
    Mesh(usize, Option<usize>),
}

/// Whether a text has such channels at all.
pub(super) fn may_occur(text: &[u8]) -> bool {
    text.windows(NAME.len()).any(|window| window == NAME.as_bytes())
}

/// Gives channels with pointers to nodes and weights a node and a path, and drops those with other pointers.
pub(super) fn resolve(root: &mut Value) -> Pointers {
    let mut pointers = Pointers::default();
    let animations = root.get_mut("animations").and_then(Value::as_array_mut);
    for (animation, json) in animations.into_iter().flatten().enumerate() {
        let Some(channels) = json.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        // The channels without a node are dropped afterwards, so these are not counted.
        let mut number = 0;
        channels.retain_mut(|channel| {
            let Some(target) = channel.get_mut("target").and_then(Value::as_object_mut) else { return true };
            let pointer =
                target.get("extensions").and_then(|all| all.get(NAME)).map(|own| own.get("pointer"));
            let Some(pointer) = pointer else {
                number += usize::from(target.contains_key("node"));
                return true;
            };
            pointers.changed = true;
            let pointer = pointer.and_then(Value::as_str).unwrap_or_default().to_owned();
            let (node, path, special) = match place(&pointer) {
                Some(Place::Node(node, path)) => (node, path, None),
                Some(Place::NodeWeight(node, weight)) => {
                    (node, "weights", Some(Special { mesh: None, weight: Some(weight) }))
                }
                Some(Place::Mesh(mesh, weight)) => (0, "weights", Some(Special { mesh: Some(mesh), weight })),
                None => {
                    pointers.left_out.push((animation, pointer));
                    return false;
                }
            };
            target.insert("node".to_owned(), json!(node));
            target.insert("path".to_owned(), json!(path));
            special.map(|special| pointers.special.insert((animation, number), special));
            number += 1;
            true
        });
    }
    pointers
}

/// The properties that channels of the scene move, in the words of the glTF object model.
fn place(pointer: &str) -> Option<Place<'_>> {
    let mut parts = pointer.strip_prefix('/')?.split('/');
    let (list, number, property) = (parts.next()?, parts.next()?.parse().ok()?, parts.next()?);
    let element = match parts.next() {
        None => None,
        Some(element) => Some(element.parse().ok()?),
    };
    if parts.next().is_some() {
        return None;
    }
    match (list, property, element) {
        ("nodes", "translation" | "rotation" | "scale" | "weights", None) => {
            Some(Place::Node(number, property))
        }
        ("nodes", "weights", Some(weight)) => Some(Place::NodeWeight(number, weight)),
        ("meshes", "weights", weight) => Some(Place::Mesh(number, weight)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{Place, place};

    #[test]
    fn pointers_to_nodes_and_weights_are_known() {
        assert_eq!(place("/nodes/3/rotation"), Some(Place::Node(3, "rotation")));
        assert_eq!(place("/nodes/3/weights/2"), Some(Place::NodeWeight(3, 2)));
        assert_eq!(place("/meshes/0/weights"), Some(Place::Mesh(0, None)));
        assert_eq!(place("/meshes/0/weights/1"), Some(Place::Mesh(0, Some(1))));
        for other in [
            "",
            "nodes/0/scale",
            "/nodes/0",
            "/nodes/x/scale",
            "/nodes/0/scale/0",
            "/nodes/0/weights/0/1",
            "/nodes/0/matrix",
            "/materials/0/alphaCutoff",
        ] {
            assert_eq!(place(other), None, "{other}");
        }
    }
}
