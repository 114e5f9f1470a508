//! The jaw pushed forward, and the tongue.

use glam::{DMat3, DVec3};

use super::Spot;
use crate::{
    anatomy::JAW,
    math::{cos, curve, lerp, sin, smooth},
    skin::Skin,
    surface::half::Node,
    weights,
};

/// The turn of the fully opened jaw.
const OPEN_DEG: f64 = 20.0;

/// How much of the jaw's motion a vertex takes.
pub(super) fn share(node: &Node) -> f64 {
    weights::of(node).iter().filter(|(bone, _)| *bone == weights::JAW).map(|(_, w)| w).sum()
}

/// What the fully opened jaw does to places that take a share of its motion: the turn, and where the origin
/// goes.
pub(super) fn opened(share: f64) -> (DMat3, DVec3) {
    let (s, c) = (sin(OPEN_DEG.to_radians()), cos(OPEN_DEG.to_radians()));
    let turn = DMat3::from_cols(DVec3::X, DVec3::new(0.0, c, s), DVec3::new(0.0, -s, c));
    (DMat3::IDENTITY * (1.0 - share) + turn * share, (JAW - turn * JAW) * share)
}

/// [`opened`] for each vertex of the skin.
pub(super) fn bones(skin: &Skin) -> Vec<(DMat3, DVec3)> {
    skin.vertices.iter().map(|v| opened(share(skin.half.mover(v.source)))).collect()
}

/// How far the jaw goes forward: down by a little, too, so that the lower teeth pass below the upper ones.
pub const FORWARD: DVec3 = DVec3::new(0.0, -0.16, 0.62);

/// The skin follows the jaw as it does when it turns.
pub(super) fn forward(spot: &Spot) -> DVec3 {
    let share = share(spot.node);
    // In the mouth the floor goes with the lower gum, and the roof stays with the upper one.
    let inside = if spot.in_mouth() { smooth(0.15, 0.55, spot.node.own.x) } else { 0.0 };
    FORWARD * lerp(share, smooth(0.1, 0.7, share), inside)
}

/// Height of the tongue's middle over where it lies, along the depth that it has reached: it climbs over the
/// lower teeth and lip, and hangs down in front of them.
const CLIMB: [(f64, f64); 6] = [(-0.5, 0.0), (1.2, 0.35), (2.6, 1.0), (4.3, 1.08), (5.1, 0.8), (5.6, 0.35)];
/// Height of the middle of the tongue at rest.
const TONGUE_Y: f64 = -6.42;

/// Displacement of a point of the tongue that is put out.
pub(super) fn tongue_out(p: DVec3) -> DVec3 {
    // All of it comes forward, the tip the most, and becomes thin.
    let s = smooth(-0.9, 2.8, p.z);
    let forward = 0.9 + 1.8 * s;
    let thin = 0.55 * s * (p.y - TONGUE_Y);
    DVec3::new(-0.16 * p.x * s, curve(&CLIMB, p.z + forward) - thin, forward)
}
