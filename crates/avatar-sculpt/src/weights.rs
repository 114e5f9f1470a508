//! Which bone moves which skin, and by how much.

use crate::{
    anatomy::{NECK_BASE_Y, below_mouth},
    lids,
    math::{lerp, smooth},
    surface::half::{Node, Patch},
};

/// Bone numbers of the raw format.
pub const NECK: usize = 0;
/// See [`NECK`].
pub const HEAD: usize = 1;
/// See [`NECK`]. The right lid is the next number.
pub const UPPER_LID: usize = 2;
/// See [`NECK`]. The right lid is the next number.
pub const LOWER_LID: usize = 4;
/// See [`NECK`].
pub const JAW: usize = 6;

/// Four bones and their weights.
pub type Influence = [(usize, f64); 4];

/// Influences on a vertex of the left half. The weights sum to 1.
#[must_use]
pub fn of(node: &Node) -> Influence {
    let p = node.p;
    // Shoulders stay where they are, however high the muscle between them and the neck rises.
    let aside = 0.6 * smooth(-10.5, -14.0, p.y) * (p.x.hypot(p.z + 6.0) - 4.4).max(0.0);
    let height = p.y + 0.22 * (p.z + 5.0) - aside;
    let neck = smooth(-8.6, -15.6, height).max(smooth(NECK_BASE_Y + 1.4, NECK_BASE_Y, p.y));
    let near_lid = node.lid <= 1.0;
    let lower_lid = if near_lid { node.lower } else { p.y - crate::anatomy::EYE.y < 0.0 };
    let lid = if node.patch == Patch::Mouth { 0.0 } else { lids::weight(p, lower_lid) };
    let jaw = (1.0 - neck) * jaw(node) * (1.0 - lid);
    let lid_bone = if lower_lid { LOWER_LID } else { UPPER_LID };
    [(HEAD, 1.0 - neck - jaw - lid), (JAW, jaw), (NECK, neck), (lid_bone, lid)]
}

/// The jaw's share before the neck takes its own.
fn jaw(node: &Node) -> f64 {
    let p = node.p;
    if node.patch == Patch::Ear || node.patch == Patch::Socket {
        return 0.0;
    }
    let lower = if node.lip <= 2.0 { node.lower } else { p.y < crate::anatomy::MOUTH_Y };
    let outside = below_mouth(p, lower);
    if node.patch == Patch::Mouth {
        // Inside, the roof stays and the floor follows; the cheeks' inner side shares the turn evenly. Half
        // way round the mouth (the corner) lies at 0.5 of the row.
        let round = smooth(0.26, 0.74, node.own.y);
        // The throat's wall is shared by all, but only behind the gums: beside them it would go into them.
        let round = lerp(round, 0.5, smooth(0.72, 0.97, node.own.x));
        return lerp(outside, round, smooth(0.15, 0.6, node.own.x));
    }
    // Around the joint itself, in front of the ear, skin slides instead of turning.
    let pivot = crate::anatomy::JAW;
    let behind = smooth(-6.4, -2.4, p.z) * smooth(1.0, 4.8, (p.y - pivot.y).hypot(p.z - pivot.z));
    let throat = lerp(1.0, smooth(-2.0, 1.9, p.z), smooth(-8.2, -10.6, p.y));
    outside * behind * throat
}
