//! SSmile: the corners of the mouth go up, out and a little back, the cheeks rise and narrow the eyes.

use glam::DVec3;

use super::{about_mouth, lid_turn};
use crate::{
    cheek,
    math::{bell3, smooth},
    surface::half::{Node, Patch},
};

/// The displacement field.
pub(super) fn displacement(node: &Node) -> DVec3 {
    let m = about_mouth(node, 1.25);
    let corner = smooth(0.05, 1.0, m.u);
    let pulled = DVec3::new(0.62 * m.u * (0.5 + 0.5 * m.u), 0.78 * corner * m.u, -0.34 * corner * m.u);
    // The lips thin and part a little, so that the teeth show.
    let parted = DVec3::new(0.0, m.side * 0.11 * (1.0 - m.u * m.u * m.u), -0.10 * (1.0 - m.u * m.u));
    let lips = (pulled + parted) * m.pull;
    if node.patch == Patch::Mouth {
        return lips;
    }
    let p = node.p;
    let wing = bell3(p, DVec3::new(1.0, -3.4, 4.6), DVec3::new(0.7, 0.7, 0.9));
    let flare = DVec3::new(0.09, 0.07, 0.0) * wing;
    lips + cheek::risen(p) + flare + lid_turn(node, true, 0.24) + lid_turn(node, false, -0.05)
}
