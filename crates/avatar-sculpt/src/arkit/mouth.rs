//! What the whole mouth does.

use glam::DVec3;

use super::{jaw, spot::Spot};
use crate::math::{curve, dome, smooth};

/// How the skin around the mouth follows it.
fn around(spot: &Spot, wide: f64, up: f64, down: f64) -> f64 {
    let m = spot.mouth();
    let h = m.fade_height(spot);
    dome((m.u / wide).powi(2) + (h / if h < 0.0 { down } else { up }).powi(2)) * m.front
}

/// The lips form an open funnel: they turn outward, and the skin around follows toward its middle.
pub(super) fn funnel(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let w = around(spot, 1.35, 1.6, 1.6);
    let open = m.along(&[(0.0, 1.0), (0.5, 0.95), (0.9, 0.45), (1.2, 0.15), (2.0, 0.1)]);
    // The line between the lips goes furthest; above the upper lip skin is drawn down.
    let apart = if m.upper > 0.0 {
        curve(&[(0.0, 0.36), (0.6, 0.26), (1.0, 0.08), (1.5, -0.18), (2.0, -0.26)], m.across)
    } else {
        curve(&[(0.0, 0.44), (0.6, 0.42), (1.0, 0.32), (1.5, 0.18), (2.0, 0.10)], m.across)
    };
    let forward = curve(&[(0.0, 0.70), (0.6, 0.62), (1.0, 0.46), (1.5, 0.22), (2.0, 0.10)], m.across);
    DVec3::new(-0.66 * m.u.min(1.2), apart * m.upper * open, forward) * w
}

/// The closed lips are drawn together and forward, as for a kiss.
pub(super) fn pucker(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let w = around(spot, 1.25, 1.4, 1.5) + 0.2 * around(spot, 2.4, 2.6, 2.6);
    let lips = curve(&[(0.0, 1.0), (1.0, 0.9), (2.0, 0.55)], m.across);
    // What is drawn together becomes thicker.
    let thick = curve(&[(0.0, 0.0), (1.0, 0.12), (2.0, 0.06)], m.across) * m.upper;
    DVec3::new(-0.84 * m.u.min(1.35), 0.02 + thick, 0.84 * lips) * w
}

/// The mouth slides to the shape's own side, about the teeth.
pub(super) fn sideways(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let w = around(spot, 1.5, 1.7, 2.0) + 0.2 * around(spot, 2.4, 2.6, 2.6);
    // On its own side the corner goes out, back and up; on the other it comes in and forward.
    let turned = 0.42 * smooth(0.0, 1.2, m.u) * m.u.min(1.2);
    let up = smooth(-0.3, 1.0, spot.side * m.u);
    DVec3::new(0.78 * spot.side, 0.26 * up, -turned * spot.side) * w
}

/// Holds the lips of the closed jaw together a little more firmly: they turn inward by a trace.
pub(super) fn close(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let along = m.along(&[(0.0, 1.0), (0.6, 0.9), (0.95, 0.2), (1.2, 0.0)]);
    let red = curve(&[(0.0, 0.0), (0.5, 0.8), (1.0, 1.0), (1.5, 0.4), (2.0, 0.0)], m.across);
    DVec3::new(0.0, -0.06 * m.upper, -0.04) * (along * red * m.front)
}

/// Closes the lips of the fully opened jaw: the lower lip comes up by what the jaw took it down, the upper
/// lip meets it on the way.
///
/// The displacement is added before bones move the skin, so it is the one that the jaw's turn carries to the
/// wanted place.
pub(super) fn close_opened(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    if m.front == 0.0 || m.u > 2.4 {
        return DVec3::ZERO;
    }
    let p = spot.p();
    let (turn, shift) = jaw::opened(jaw::share(spot.node));
    let opened = turn * p + shift;
    let along = m.along(&[(0.0, 1.0), (0.6, 0.85), (1.0, 0.5), (1.6, 0.2), (2.2, 0.0)]);
    let met = p + DVec3::new(0.0, -0.45, -0.10) * along;
    let h = m.fade_height(spot);
    let fade = dome((h / if h < 0.0 { 1.9 } else { 1.1 }).powi(2)) * smooth(2.3, 1.0, m.u) * m.front;
    // Solved for the place that the bones carry there.
    turn.inverse() * (opened.lerp(met, fade) - shift) - p
}
