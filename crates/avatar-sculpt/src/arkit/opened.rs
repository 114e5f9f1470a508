//! What shapes of the mouth do in another way once the jaw is open.
//!
//! Weights of these fields are products of the jaw's opening and of the shape, so they are written for both
//! at their ends.

use glam::DVec3;

use super::{
    cheeks, jaw,
    spot::{Mouth, Spot},
};
use crate::math::{dome, smooth};

/// A wanted displacement of the opened face, before bones turn it there.
fn unturned(spot: &Spot, d: DVec3) -> DVec3 {
    jaw::opened(jaw::share(spot.node)).0.inverse() * d
}

/// How the lower lip and the skin below it follow the lip's edge, and the same for the upper one.
fn both_lips(spot: &Spot, m: &Mouth, up: f64, down: f64) -> (f64, f64) {
    let h = m.fade_height(spot);
    let upper = m.is_upper() * dome((h.max(0.0) / up).powi(2)) * m.front;
    (upper, m.is_lower() * dome((h.min(0.0) / down).powi(2)) * m.front)
}

/// What the jaw's bone leaves out: the cheeks fall in, and the corners of the mouth come toward the midline.
pub(super) fn face(spot: &Spot) -> DVec3 {
    let corner = spot.mouth().corner(spot, 1.6, 1.2, 1.5, 1.5);
    let inward = DVec3::new(-0.22 * smooth(0.0, 1.6, spot.p().x), 0.0, 0.06) * corner;
    unturned(spot, inward + cheeks::hollowed(spot.p()) * spot.on_face())
}

/// Pursed lips draw the opening together to a small round one; the lower lip hides its teeth.
pub(super) fn pucker(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let (upper, lower) = both_lips(spot, &m, 1.2, 1.7);
    let middle = m.along(&[(0.0, 1.0), (0.5, 0.8), (1.0, 0.2), (1.4, 0.0)]);
    let aside = m.along(&[(0.0, 0.0), (0.6, 0.55), (1.0, 1.0), (1.5, 0.6), (2.4, 0.0)]);
    // Less beside the midline: the lower edge is a bow, not a wedge.
    let bow = m.along(&[(0.0, 1.30), (0.3, 1.20), (0.6, 0.80), (1.0, 0.22), (1.5, 0.0)]);
    let rise =
        DVec3::new(0.0, -0.24 * upper, 0.10 * (lower + upper)) * middle + DVec3::new(0.0, bow * lower, 0.0);
    unturned(spot, rise + DVec3::new(-0.28 * aside * (lower + upper), 0.0, 0.0))
}

/// The funnel of an open mouth is round: its lower lip rises before the teeth, its sides come in.
pub(super) fn funnel(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let (upper, lower) = both_lips(spot, &m, 1.2, 1.7);
    let middle = m.along(&[(0.0, 1.0), (0.5, 0.8), (1.0, 0.15), (1.4, 0.0)]);
    let aside = m.along(&[(0.0, 0.0), (0.6, 0.55), (1.0, 1.0), (1.5, 0.6), (2.4, 0.0)]);
    let bow = m.along(&[(0.0, 1.05), (0.3, 0.97), (0.6, 0.64), (1.0, 0.17), (1.5, 0.0)]);
    let rise = DVec3::new(0.0, -0.16 * upper, 0.06 * lower) * middle + DVec3::new(0.0, bow * lower, 0.0);
    unturned(spot, rise + DVec3::new(-0.20 * aside * (lower + upper), 0.0, 0.0))
}

/// A laugh: the upper lip bares its teeth, the lower one is drawn up to a wide bow.
pub(super) fn smile(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let (upper, lower) = both_lips(spot, &m, 1.4, 1.9);
    let bared = m.along(&[(0.0, 0.40), (0.45, 0.34), (0.8, 0.12), (1.0, 0.0)]);
    let drawn = m.along(&[(0.0, 0.12), (0.4, 0.10), (0.8, 0.0)]);
    unturned(spot, DVec3::new(0.0, bared * upper + drawn * lower, 0.0))
}
