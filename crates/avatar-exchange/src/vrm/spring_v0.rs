//! `secondaryAnimation` of VRM 0.x as the springs of VRM 1.0. A file names roots; everything below them
//! swings, each node towards its first child, and the last one towards a point seven centimetres beyond it.

use super::descent::Descent;
use super::note;
use super::place::Place;
use super::spring::{ColliderGroup, ColliderShape, SpringChain, SpringCollider, SpringJoint, Springs};
use crate::scene::{Finding, ImportError, RawScene};
use glam::Vec3;

/// Length of the end that the last joint of a chain gets, in metres.
const TAIL: f32 = 0.07;
/// Each chain of a group has the group's name and colliders; more of these are no avatar.
const MOST_REFERENCES: usize = 1 << 20;

pub(super) fn read(place: &Place<'_>, raw: &mut RawScene) -> Result<Springs, ImportError> {
    let mut springs = Springs::default();
    for place in place.list("colliderGroups")? {
        let node = place.need("node")?.index_or_none("a node", raw.nodes.len())?;
        let first = springs.colliders.len();
        for place in place.list("colliders")? {
            let offset = match place.get("offset")? {
                Some(offset) => mirrored(&offset)?,
                None => Vec3::ZERO,
            };
            let radius = place.clamped("radius", 0.0, 0.0..=f32::MAX, raw)?;
            let shape = ColliderShape::Sphere { offset, radius, inside: false };
            springs.colliders.extend(node.map(|node| SpringCollider { node, shape }));
        }
        let colliders = (first..springs.colliders.len()).collect();
        springs.collider_groups.push(ColliderGroup { name: String::new(), colliders });
    }
    let descent = Descent::of(&raw.nodes);
    let mut left = MOST_REFERENCES;
    let mut used = vec![false; raw.nodes.len()];
    for place in place.list("boneGroups")? {
        let model = SpringChain {
            name: place.text("comment")?,
            joints: Vec::new(),
            collider_groups: place.indices("colliderGroups", "a group", springs.collider_groups.len())?,
            center: match place.get("center")? {
                Some(center) => center.index_or_none("a node", raw.nodes.len())?,
                None => None,
            },
            tail: Some(TAIL),
        };
        let joint = joint(&place, raw)?;
        let mut again = 0;
        for root in place.list("bones")? {
            let Some(root) = root.index_or_none("a node", raw.nodes.len())? else { continue };
            let first = springs.chains.len();
            again += add(root, &model, joint, &descent, &mut used, &mut left, &mut springs.chains);
            if left == 0 && springs.chains.len() > first {
                let expected = format!("at most {MOST_REFERENCES} mentions of colliders in all chains");
                return Err(place.wrong(expected));
            }
        }
        if again > 0 {
            let text = format!("{again} of its bones are in another spring already, and left out");
            note(raw, place.path(), Finding::LeftOut(text));
        }
    }
    Ok(springs)
}

/// The setting of all joints of a group.
fn joint(place: &Place<'_>, raw: &mut RawScene) -> Result<SpringJoint, ImportError> {
    let joint = SpringJoint::at(0);
    let gravity_dir = match place.get("gravityDir")? {
        // Forward is +z of that left-handed space and of a scene that is turned around.
        Some(dir) => mirrored(&dir)? * Vec3::new(-1.0, 1.0, -1.0),
        None => joint.gravity_dir,
    };
    Ok(SpringJoint {
        // The misspelt name is the standard's.
        stiffness: place.clamped("stiffiness", joint.stiffness, 0.0..=f32::MAX, raw)?,
        hit_radius: place.clamped("hitRadius", joint.hit_radius, 0.0..=f32::MAX, raw)?,
        drag_force: place.clamped("dragForce", joint.drag_force, 0.0..=1.0, raw)?,
        gravity_power: place.float_or("gravityPower", joint.gravity_power)?,
        gravity_dir,
        ..joint
    })
}

/// Of a left-handed space: forward is +z there and −z in the file.
fn mirrored(place: &Place<'_>) -> Result<Vec3, ImportError> {
    let [x, y, z] = ["x", "y", "z"].map(|axis| place.float_or(axis, 0.0));
    Ok(Vec3::new(x?, y?, -z?))
}

/// A chain along the first children, and one more from each other child on. `left` counts what may still be
/// copied for chains. Returns at how many nodes another spring had been already.
fn add(
    root: usize,
    model: &SpringChain,
    joint: SpringJoint,
    descent: &Descent,
    used: &mut [bool],
    left: &mut usize,
    chains: &mut Vec<SpringChain>,
) -> usize {
    let mut again = 0;
    let mut starts = vec![root];
    while let Some(start) = starts.pop() {
        let mut joints = Vec::new();
        let mut next = Some(start);
        while let Some(node) = next.filter(|node| !std::mem::replace(&mut used[*node], true)) {
            joints.push(SpringJoint { node, ..joint });
            starts.extend(descent.children(node).iter().skip(1).rev());
            next = descent.children(node).first().copied();
        }
        again += usize::from(next.is_some());
        if !joints.is_empty() && *left > 0 {
            *left = left.saturating_sub(1 + model.collider_groups.len() + model.name.len());
            chains.push(SpringChain { joints, ..model.clone() });
        }
    }
    again
}
