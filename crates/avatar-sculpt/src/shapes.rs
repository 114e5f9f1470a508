//! The blend shapes: named displacement fields over the face at rest.
//!
//! A field knows nothing of meshes: it maps a place on the left half to a displacement, and the mesh builder
//! evaluates, mirrors and differentiates it. A further shape is one more function and one more row in
//! [`SHAPES`].

mod frown;
mod smile;

use glam::DVec3;

use crate::{
    anatomy::{EYE, MOUTH_HALF_WIDTH, mouth_line},
    lids,
    math::{bell, cos, sin, smooth},
    surface::half::{Node, Patch},
};

/// A displacement for a place on the left half of the face.
pub type Field = fn(&Node) -> DVec3;

/// All shapes in the order of the raw vertex format.
pub const SHAPES: [(&str, Field); 2] = [("SSmile", smile::displacement), ("Frown", frown::displacement)];

/// Where a place lies about the mouth.
#[derive(Clone, Copy, Debug)]
pub struct AboutMouth {
    /// 0 at the midline, 1 at the corner, held there.
    pub u: f64,
    /// Height over the line between the lips.
    pub height: f64,
    /// 1 for upper-lip places, −1 for lower-lip ones.
    pub side: f64,
    /// How much of a motion of the lips arrives here: 1 at the lips, fading outward and into the mouth.
    pub pull: f64,
}

/// Describes a place relative to the mouth; `reach` is the width of the fade above and below.
#[must_use]
pub fn about_mouth(node: &Node, reach: f64) -> AboutMouth {
    let p = node.p;
    let u = (p.x / MOUTH_HALF_WIDTH).min(1.0);
    let height = p.y - mouth_line(u).y;
    let lower = if node.lip <= 2.0 { node.lower } else { height < 0.0 };
    let sideways = bell((p.x - MOUTH_HALF_WIDTH).max(0.0), 1.25);
    let inward =
        if node.patch == Patch::Mouth { smooth(0.62, 0.25, node.own.x) } else { smooth(0.0, 2.0, p.z) };
    // Inside the mouth the bag's rows spread far up and down; they follow the lip they hang on.
    let fade = if node.patch == Patch::Mouth { 1.0 } else { bell(height, reach) };
    AboutMouth { u, height, side: if lower { -1.0 } else { 1.0 }, pull: sideways * inward * fade }
}

/// Displacement of a lid that turns about the eye by `angle_rad` (positive lifts). Toward the corners of the
/// eye, where the two lids meet, it dies out: the smallest triangles would fold there.
#[must_use]
pub fn lid_turn(node: &Node, lower: bool, angle_rad: f64) -> DVec3 {
    let is_lower = if node.lid <= 1.0 { node.lower } else { node.p.y < EYE.y };
    if is_lower != lower || node.patch == Patch::Mouth {
        return DVec3::ZERO;
    }
    let rel = node.p - EYE;
    let along = lids::along(rel);
    let within = smooth(0.0, 0.2, along) * smooth(1.0, 0.8, along);
    let angle = angle_rad * within * lids::weight(node.p, lower);
    let (s, c) = (sin(angle), cos(angle));
    DVec3::new(0.0, c * rel.y + s * rel.z - rel.y, c * rel.z - s * rel.y - rel.z)
}
