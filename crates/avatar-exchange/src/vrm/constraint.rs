//! Nodes that turn with others: the extension `VRMC_node_constraint` 1.0,
//! <https://github.com/vrm-c/vrm-specification/tree/master/specification/VRMC_node_constraint-1.0>. Here they
//! are only read; nothing is moved.

use super::note;
use super::place::Place;
use crate::scene::{Finding, ImportError, RawScene};
use glam::Vec3;
use serde_json::{Map, Value};

/// The name of the extension.
pub(super) const EXTENSION: &str = "VRMC_node_constraint";

/// A node that turns with another one. No node follows itself, not even by way of others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeConstraint {
    /// The node that turns.
    pub node: usize,
    /// The node that it follows.
    pub source: usize,
    /// How far it goes from its own rest to what the source demands, 0…1.
    pub weight: f32,
    /// What it takes over.
    pub kind: ConstraintKind,
}

/// What a node takes over from its source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConstraintKind {
    /// The turn about an axis.
    Roll {
        /// The axis in the space of the node that turns: +X, +Y or +Z.
        axis: Vec3,
    },
    /// An axis points to the source.
    Aim {
        /// The axis in the space of the node that turns: one of the six along X, Y and Z.
        axis: Vec3,
    },
    /// The source's rotation from its rest, each in its own space.
    Rotation,
}

/// `extensions` are those of each node.
pub(super) fn read(
    extensions: &[Map<String, Value>],
    raw: &mut RawScene,
) -> Result<Vec<NodeConstraint>, ImportError> {
    let mut constraints: Vec<Option<NodeConstraint>> = Vec::with_capacity(extensions.len());
    for (node, extension) in extensions.iter().enumerate() {
        let constraint = extension.get(EXTENSION).map(|value| {
            let place = Place::new(value, &place_of(node));
            constraint(node, &place, raw)
        });
        constraints.push(constraint.transpose()?);
    }
    for node in circular(&constraints, raw.nodes.len()) {
        constraints[node] = None;
        let text = "follows itself, perhaps by way of others: the constraint is left out";
        note(raw, place_of(node), Finding::left_out(text));
    }
    Ok(constraints.into_iter().flatten().collect())
}

fn place_of(node: usize) -> String {
    format!("node {node}, {EXTENSION}")
}

/// One node of each circle. Every node has one source at most, so that the way from one to the next is a line
/// or ends in a circle; ways that were gone before are not gone again.
fn circular(constraints: &[Option<NodeConstraint>], nodes: usize) -> Vec<usize> {
    let mut circular = Vec::new();
    // Per node the start of the way that came by first.
    let mut visited = vec![None; nodes];
    for start in 0..nodes {
        let (mut here, mut last) = (start, start);
        loop {
            if let Some(way) = visited[here] {
                circular.extend((way == start).then_some(last));
                break;
            }
            visited[here] = Some(start);
            let Some(constraint) = constraints.get(here).copied().flatten() else { break };
            (last, here) = (here, constraint.source);
        }
    }
    circular
}

fn constraint(node: usize, place: &Place<'_>, raw: &mut RawScene) -> Result<NodeConstraint, ImportError> {
    place.version_1("specVersion")?;
    let one = place.need("constraint")?;
    let (place, kind) = match (one.get("roll")?, one.get("aim")?, one.get("rotation")?) {
        (Some(place), None, None) => {
            let axis = axis(&place.need("rollAxis")?, &["X", "Y", "Z"], "X, Y or Z")?;
            (place, ConstraintKind::Roll { axis })
        }
        (None, Some(place), None) => {
            let names = ["PositiveX", "PositiveY", "PositiveZ", "NegativeX", "NegativeY", "NegativeZ"];
            let axis = axis(&place.need("aimAxis")?, &names, "PositiveX, NegativeX and so on to NegativeZ")?;
            (place, ConstraintKind::Aim { axis })
        }
        (None, None, Some(place)) => (place, ConstraintKind::Rotation),
        _ => return Err(one.wrong("one of roll, aim and rotation")),
    };
    let source = place.need("source")?.index("a node", raw.nodes.len())?;
    Ok(NodeConstraint { node, source, weight: place.clamped("weight", 1.0, 0.0..=1.0, raw)?, kind })
}

/// The unit vector of a name among those of X, Y, Z and perhaps their opposites.
fn axis(place: &Place<'_>, names: &[&str], expected: &str) -> Result<Vec3, ImportError> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
    let name = place.str()?;
    let found = names.iter().zip(axes).find(|(known, _)| **known == name);
    found.map(|(_, axis)| axis).ok_or_else(|| place.wrong(expected))
}
