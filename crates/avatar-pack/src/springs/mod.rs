//! What moves by itself, after the pose.

mod text;
mod write;

use glam::{DVec3, Vec3};
use joint_springs::{Collider, Constraint, Constraints, Shape, Spring, SpringError, Swing};
use rig_core::Rig;

/// Colliders of all joints, each counted for each joint that bumps against it: ten times what avatars have.
pub(crate) const MOST_BUMPS: usize = 1 << 16;

/// Joints that swing, what they bump against, and joints that turn with others: what `springs.toml` or a VRM
/// says. Joints are numbers in the order of the rig ([`rig_core::JointId::index`]).
///
/// [`FaceState::pose`](crate::FaceState::pose) turns the joints that follow others;
/// [`FaceState::swing`](crate::FaceState::swing) and [`FaceState::settle`](crate::FaceState::settle) move
/// those that swing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Springs {
    /// Joints that swing, at most one spring each.
    pub springs: Vec<Spring>,
    /// What they bump against, by the numbers that springs name.
    pub colliders: Vec<Collider>,
    /// Joints that turn with others, at most one constraint each.
    pub constraints: Vec<Constraint>,
}

impl Springs {
    /// Whether nothing moves by itself.
    pub fn is_empty(&self) -> bool {
        self.springs.is_empty() && self.constraints.is_empty()
    }

    /// What makes the joints of a rig swing; `None` where none does.
    pub(crate) fn swing(&self, rig: &Rig) -> Result<Option<Swing>, SpringError> {
        if self.springs.is_empty() {
            return Ok(None);
        }
        Swing::new(&parents(rig), self.springs.clone(), self.colliders.clone()).map(Some)
    }

    /// What turns joints of a rig with others; `None` where nothing does.
    pub(crate) fn turning(&self, rig: &Rig) -> Result<Option<Constraints>, SpringError> {
        if self.constraints.is_empty() {
            return Ok(None);
        }
        Constraints::new(&parents(rig), rig.world_from_bind(), &self.constraints).map(Some)
    }

    /// The same on a rig whose joints went elsewhere: the ends of springs and the centres of colliders go
    /// where their places in world space go. Radii stay.
    pub(crate) fn moved(&self, from: &Rig, to: &Rig, place: impl Fn(DVec3) -> DVec3) -> Self {
        let carried = |joint: usize, point: Vec3| {
            let (Some(world), Some(back)) =
                (from.world_from_bind().get(joint), to.bind_from_world().get(joint))
            else {
                return point;
            };
            back.transform_point3(place(world.transform_point3(point).as_dvec3()).as_vec3())
        };
        let mut moved = self.clone();
        for spring in &mut moved.springs {
            spring.tail = carried(spring.joint, spring.tail);
        }
        for Collider { joint, shape } in &mut moved.colliders {
            match shape {
                Shape::Sphere { offset, .. } | Shape::Plane { offset, .. } => {
                    *offset = carried(*joint, *offset)
                }
                Shape::Capsule { offset, tail, .. } => {
                    (*offset, *tail) = (carried(*joint, *offset), carried(*joint, *tail));
                }
            }
        }
        moved
    }
}

/// Numbers of the parents.
pub(crate) fn parents(rig: &Rig) -> Vec<Option<usize>> {
    rig.parents().iter().map(|parent| parent.map(|parent| parent.index())).collect()
}
