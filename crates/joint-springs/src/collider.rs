//! What tails bump against.

use crate::law::within;
use glam::{Affine3A, Vec3, Vec3A};

/// A body that tails bump against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collider {
    /// The joint that it follows.
    pub joint: usize,
    /// Its form.
    pub shape: Shape,
}

/// Form of a collider, in the space of its joint. A radius is not scaled with the joint, as in the standard's
/// programs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// All points near a point; or, from inside, all others.
    Sphere {
        /// The centre.
        offset: Vec3,
        /// The radius; not below 0.
        radius: f32,
        /// Whether tails are kept inside.
        inside: bool,
    },
    /// All points near a line; or, from inside, all others.
    Capsule {
        /// One end of the line.
        offset: Vec3,
        /// Its other end.
        tail: Vec3,
        /// The radius; not below 0.
        radius: f32,
        /// Whether tails are kept inside.
        inside: bool,
    },
    /// Everything behind a plane.
    Plane {
        /// A point of the plane.
        offset: Vec3,
        /// Where its front looks; any length.
        normal: Vec3,
    },
}

impl Shape {
    /// The direction that leads a point with a radius out of this shape, and how far it has to go, if it is
    /// in it at all. A point in the very middle has no way out.
    pub(crate) fn way_out(
        &self,
        world_from_joint: &Affine3A,
        point: Vec3A,
        radius_of_point: f32,
    ) -> Option<(Vec3A, f32)> {
        let (nearest, radius, inside) = match *self {
            Self::Sphere { offset, radius, inside } => {
                (world_from_joint.transform_point3(offset).into(), radius, inside)
            }
            Self::Capsule { offset, tail, radius, inside } => {
                let start = Vec3A::from(world_from_joint.transform_point3(offset));
                let line = Vec3A::from(world_from_joint.transform_point3(tail)) - start;
                let along = (point - start).dot(line) / line.length_squared();
                // NaN where the line is a point.
                (start + line * within(along, 0.0, 1.0), radius, inside)
            }
            Self::Plane { offset, normal } => {
                // Of a plane, normals turn with the inverse transposed matrix.
                let normal = world_from_joint.matrix3.inverse().transpose() * Vec3A::from(normal);
                let normal = normal.try_normalize()?;
                let start = Vec3A::from(world_from_joint.transform_point3(offset));
                let depth = radius_of_point - (point - start).dot(normal);
                return (depth > 0.0).then_some((normal, depth));
            }
        };
        let away = point - nearest;
        let distance = away.length();
        let radius = within(radius, 0.0, f32::MAX);
        let depth =
            if inside { distance + radius_of_point - radius } else { radius + radius_of_point - distance };
        let out = away.try_normalize()? * if inside { -1.0 } else { 1.0 };
        (depth > 0.0 && depth.is_finite()).then_some((out, depth))
    }
}
