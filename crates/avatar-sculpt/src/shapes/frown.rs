//! Frown: the corners of the mouth sink, the brows come together and down.

use glam::DVec3;

use super::{about_mouth, lid_turn};
use crate::{
    math::{bell3, smooth},
    surface::half::{Node, Patch},
};

/// The displacement field.
pub(super) fn displacement(node: &Node) -> DVec3 {
    let m = about_mouth(node, 1.2);
    let corner = smooth(0.1, 1.0, m.u);
    let pulled = DVec3::new(-0.10 * m.u, -0.60 * corner * m.u, -0.10 * corner);
    // The lower lip is pushed up and forward by the chin.
    let pushed = DVec3::new(0.0, 0.05, 0.10) * (1.0 - m.u * m.u);
    let lips = (pulled + pushed) * m.pull;
    if node.patch == Patch::Mouth {
        return lips;
    }
    let p = node.p;
    let inner = bell3(p, DVec3::new(1.25, 2.0, 3.9), DVec3::new(1.25, 1.05, 2.0));
    let outer = bell3(p, DVec3::new(3.6, 2.6, 3.2), DVec3::new(1.7, 0.9, 2.0));
    let toward = smooth(0.0, 1.0, p.x);
    let brow = DVec3::new(-0.34 * toward, -0.46, 0.14) * inner + DVec3::new(-0.10, -0.16, 0.02) * outer;
    let chin = DVec3::new(0.0, 0.18, 0.06) * bell3(p, DVec3::new(0.0, -8.6, 4.2), DVec3::new(1.2, 0.9, 1.2));
    let wing = DVec3::new(0.03, 0.10, 0.0) * bell3(p, DVec3::new(1.0, -3.3, 4.5), DVec3::new(0.8, 0.7, 0.9));
    // The brow must not press the lid into the eye: skin near the eye follows by turning about it instead.
    let from_eye = (p - crate::anatomy::EYE).length();
    let keep = if node.patch == Patch::Socket { 0.0 } else { smooth(2.0, 2.9, from_eye) };
    lips + brow * keep + chin + wing + lid_turn(node, false, -0.10)
}
