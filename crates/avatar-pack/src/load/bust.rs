//! What of a skin is the head, where it has shoulders.

use avatar_mesh::{Bounds, FACE_BONES, Mesh};
use glam::Vec3;

/// How much higher than its head a skin must be to have shoulders: most heads end with some neck.
const SHOULDERS: f32 = 1.15;

/// The box around the vertices in which any bone beside the neck's has a share; `None` where that is about
/// the whole skin, whose box is `all`.
pub(crate) fn head(skin: &Mesh, all: Bounds) -> Option<Bounds> {
    let skinning = skin.skinning.as_ref()?;
    let neck = FACE_BONES.iter().position(|bone| *bone == "NeckJoint")? as u16;
    let mut head = Bounds { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };
    // In one go over what was just read: loading is measured in fractions of a millisecond.
    for ((place, bones), weights) in skin.positions.iter().zip(&skinning.bones).zip(&skinning.weights) {
        let of_neck: f32 = (0..4).map(|k| if bones[k] == neck { weights[k] } else { 0.0 }).sum();
        if of_neck < 1.0 {
            head = Bounds { min: head.min.min(*place), max: head.max.max(*place) };
        }
    }
    (head.min.y <= head.max.y && all.size().y > SHOULDERS * head.size().y).then_some(head)
}
