//! The jaw pushed forward, and the tongue.

use glam::{DMat3, DVec3};

use super::spot::Spot;
use crate::{
    anatomy::JAW,
    math::{cos, curve, dome, lerp, sin, smooth},
    skin::Skin,
    surface::half::Node,
    weights,
};

/// The turn of the fully opened jaw.
const OPEN_DEG: f64 = 20.0;
/// The turn of the jaw that is quite at one side.
const ASIDE_DEG: f64 = 8.0;

/// How much of the jaw's motion a vertex takes.
pub(super) fn share(node: &Node) -> f64 {
    weights::of(node).iter().filter(|(bone, _)| *bone == weights::JAW).map(|(_, w)| w).sum()
}

/// What a turn of the jaw does to places that take a share of it: their turn, and where the origin goes.
fn turned(turn: DMat3, share: f64) -> (DMat3, DVec3) {
    (DMat3::IDENTITY * (1.0 - share) + turn * share, (JAW - turn * JAW) * share)
}

/// [`turned`] by the fully opened jaw.
pub(super) fn opened(share: f64) -> (DMat3, DVec3) {
    let (s, c) = (sin(OPEN_DEG.to_radians()), cos(OPEN_DEG.to_radians()));
    turned(DMat3::from_cols(DVec3::X, DVec3::new(0.0, c, s), DVec3::new(0.0, -s, c)), share)
}

/// [`opened`] for each vertex of the skin.
pub(super) fn bones(skin: &Skin) -> Vec<(DMat3, DVec3)> {
    skin.vertices.iter().map(|v| opened(share(skin.half.mover(v.source)))).collect()
}

/// [`turned`] for each vertex of the skin by the jaw that is quite at one side: 1 for left, −1 for right.
pub(super) fn bones_aside(skin: &Skin, side: f64) -> Vec<(DMat3, DVec3)> {
    let (s, c) = (side * sin(ASIDE_DEG.to_radians()), cos(ASIDE_DEG.to_radians()));
    let turn = DMat3::from_cols(DVec3::new(c, 0.0, -s), DVec3::Y, DVec3::new(s, 0.0, c));
    skin.vertices.iter().map(|v| turned(turn, share(skin.half.mover(v.source)))).collect()
}

/// How far the jaw goes forward: down by a little, too, so that the lower teeth pass below the upper ones.
pub const FORWARD: DVec3 = DVec3::new(0.0, -0.145, 0.56);

/// The skin follows the jaw as it does when it turns.
pub(super) fn forward(spot: &Spot) -> DVec3 {
    let share = share(spot.node);
    // In the mouth the floor goes with the lower gum, and the roof stays with the upper one.
    let inside = if spot.in_mouth() { smooth(0.15, 0.55, spot.node.own.x) } else { 0.0 };
    // The lower lip stands before the upper one, and covers what would be a gap between them.
    let m = spot.mouth();
    let height = m.fade_height(spot).min(0.0);
    let lip = m.is_lower() * dome((height / 1.1).powi(2)) * m.front * smooth(1.1, 0.5, m.u);
    FORWARD * lerp(share, smooth(0.1, 0.7, share), inside) + DVec3::new(0.0, 0.34, 0.10) * lip
}

/// How far the lower jaw sinks for the tongue that is put out, so that it passes between the rows of teeth.
pub const TONGUE_DROP: DVec3 = DVec3::new(0.0, -0.52, -0.06);

/// Jaw and lips part for the tongue: the skin follows the jaw, and both lips lie on the tongue.
pub(super) fn tongue_room(spot: &Spot) -> DVec3 {
    let share = share(spot.node);
    let inside = if spot.in_mouth() { smooth(0.15, 0.55, spot.node.own.x) } else { 0.0 };
    let m = spot.mouth();
    let along = m.along(&[(0.0, 1.0), (0.4, 0.9), (0.75, 0.35), (1.0, 0.0)]) * m.front;
    let h = m.fade_height(spot);
    let up = m.is_upper() * dome((h.max(0.0) / 1.0).powi(2));
    let down = m.is_lower() * dome((h.min(0.0) / 1.2).powi(2));
    // The angle of the jaw stays: only its front sinks.
    TONGUE_DROP * (lerp(share, smooth(0.1, 0.7, share), inside) * smooth(-3.6, 0.6, spot.p().z))
        + (DVec3::new(0.0, 0.16, 0.08) * up + DVec3::new(0.0, -0.22, 0.16) * down) * along
}

/// Height of the tongue's middle over where it lies, along the depth that it has reached: it climbs over the
/// lower teeth and lip, and hangs down in front of them.
const CLIMB: [(f64, f64); 8] =
    [(-0.5, 0.0), (1.2, 0.35), (2.6, 1.0), (4.3, 1.12), (5.2, 1.0), (5.9, 0.6), (6.4, 0.0), (7.1, -1.1)];
/// Height of the middle of the tongue at rest.
const TONGUE_Y: f64 = -6.42;

/// Displacement of a point of the tongue that is put out.
pub(super) fn tongue_out(p: DVec3) -> DVec3 {
    // All of it comes forward, the tip the most, and becomes thin.
    let s = smooth(-0.9, 2.8, p.z);
    let forward = 0.9 + 3.05 * s;
    let thin = 0.55 * s * (p.y - TONGUE_Y);
    TONGUE_DROP + DVec3::new(-0.16 * p.x * s, curve(&CLIMB, p.z + forward) - thin, forward)
}

/// Displacement of a point of the tongue whose tip lies behind the upper teeth's edge, as for t, d and n.
pub(super) fn tongue_tip_up(p: DVec3) -> DVec3 {
    DVec3::new(0.0, 0.80, 0.12) * smooth(0.3, 2.7, p.z)
}

/// Displacement of a point of the tongue that is drawn back and raised behind, as for k and g.
pub(super) fn tongue_back_up(p: DVec3) -> DVec3 {
    let tip = smooth(0.8, 2.8, p.z);
    DVec3::new(0.0, 0.62 * dome((p.z + 0.3).powi(2)) - 0.15 * tip, -0.8 * tip)
}
