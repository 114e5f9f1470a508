//! What a VRM says of springs, colliders and constraints of nodes, for the joints of the avatar.

use crate::springs::MOST_BUMPS;
use crate::{SceneMotion, Springs};
use avatar_exchange::vrm::{ColliderShape, ConstraintKind as Kind, NodeConstraint, SpringChain, Vrm};
use glam::{Affine3A, Vec3};
use joint_springs::{Collider, Constraint, ConstraintKind, Law, Shape, Spring, SpringError};
use rig_core::Rig;

/// Circles of constraints by way of nodes above that are broken one by one; a file with more has none
/// followed.
const MOST_CIRCLES: usize = 16;
/// Constraints times joints: each constraint looks for what is below.
const MOST_TURNS: usize = 1 << 22;

/// The springs of a file. `notes` gets what is left out.
pub(super) fn springs(vrm: &Vrm, rig: &Rig, motion: &SceneMotion, notes: &mut Vec<String>) -> Springs {
    let joint = |node: usize| motion.joint(node).map(|joint| joint.index());
    let file = &vrm.springs;
    // Every node became a joint, so that places of colliders stay.
    let colliders = file.colliders.iter().filter_map(|collider| {
        let shape = match collider.shape {
            ColliderShape::Sphere { offset, radius, inside } => Shape::Sphere { offset, radius, inside },
            ColliderShape::Capsule { offset, tail, radius, inside } => {
                Shape::Capsule { offset, tail, radius, inside }
            }
            ColliderShape::Plane { offset, normal } => Shape::Plane { offset, normal },
        };
        Some(Collider { joint: joint(collider.node)?, shape })
    });
    let mut springs = Springs { colliders: colliders.collect(), ..Springs::default() };
    let mut count = 0usize;
    for chain in &file.chains {
        let groups = || chain.collider_groups.iter().filter_map(|group| file.collider_groups.get(*group));
        // Counted before they are listed: a short file can name one group many times.
        let bumps = groups().fold(0usize, |sum, group| sum.saturating_add(group.colliders.len()));
        count = count.saturating_add(chain.joints.len().max(1).saturating_mul(bumps));
        if count > MOST_BUMPS {
            let text =
                format!("more than {MOST_BUMPS} colliders of joints are no avatar: all springs are left out");
            notes.push(format!("VRM: {text}"));
            (springs.springs, springs.colliders) = (Vec::new(), Vec::new());
            break;
        }
        let bumps: Vec<usize> = groups().flat_map(|group| group.colliders.iter().copied()).collect();
        for (at, one) in chain.joints.iter().enumerate() {
            let (Some(number), Some(tail)) = (joint(one.node), tail(chain, at, rig, joint)) else { continue };
            let gravity = one.gravity_dir * one.gravity_power;
            let law = Law::Vrm { stiffness: one.stiffness, drag: one.drag_force, gravity };
            springs.springs.push(Spring {
                hit_radius: one.hit_radius,
                center: chain.center.and_then(joint),
                colliders: bumps.clone(),
                ..Spring::new(number, tail, law)
            });
        }
    }
    let constraint = |constraint: &NodeConstraint| {
        let kind = match constraint.kind {
            Kind::Roll { axis } => ConstraintKind::Roll { axis },
            Kind::Aim { axis } => ConstraintKind::Aim { axis },
            Kind::Rotation => ConstraintKind::Rotation,
        };
        let (number, source) = (joint(constraint.node)?, joint(constraint.source)?);
        Some(Constraint { joint: number, source, weight: constraint.weight, kind })
    };
    springs.constraints = vrm.constraints.iter().filter_map(constraint).collect();
    if springs.constraints.len().saturating_mul(rig.len()) > MOST_TURNS {
        notes
            .push(format!("VRM: {} constraints are no avatar: they are left out", springs.constraints.len()));
        springs.constraints.clear();
    }
    break_circles(&mut springs, rig, notes);
    springs
}

/// The end of a joint of a chain in the joint's space; `None` for the last joint of VRM 1.0, which is the
/// end of the one before. That of 0.x has an end of a given length, straight on from the node above it, as
/// in UniVRM.
fn tail(chain: &SpringChain, at: usize, rig: &Rig, joint: impl Fn(usize) -> Option<usize>) -> Option<Vec3> {
    let number = joint(chain.joints.get(at)?.node)?;
    let world = |joint: usize| rig.world_from_bind().get(joint).copied().unwrap_or(Affine3A::IDENTITY);
    let place = |joint: usize| world(joint).translation;
    let end = match (chain.joints.get(at + 1), chain.tail) {
        (Some(next), _) => place(joint(next.node)?),
        (None, Some(length)) => {
            let parent = rig.parents().get(number).copied().flatten();
            let above = parent.map_or_else(Default::default, |parent| place(parent.index()));
            place(number) + (place(number) - above).normalize_or_zero() * length
        }
        (None, None) => return None,
    };
    rig.bind_from_world().get(number).map(|back| back.transform_point3a(end).into())
}

/// Leaves out constraints that wait for themselves by way of nodes above.
fn break_circles(springs: &mut Springs, rig: &Rig, notes: &mut Vec<String>) {
    for _ in 0..MOST_CIRCLES {
        let Err(SpringError::Circle { joint }) = springs.turning(rig) else { return };
        springs.constraints.retain(|constraint| constraint.joint != joint);
        let name = rig.names().get(joint).map_or("", String::as_str);
        notes.push(format!(
            "VRM: node {name:?} would follow itself by way of nodes above: its constraint is left out"
        ));
    }
    if springs.turning(rig).is_err() {
        let count = springs.constraints.len();
        notes.push(format!(
            "VRM: {count} nodes would follow each other in circles: their constraints are left out"
        ));
        springs.constraints.clear();
    }
}
