//! What shapes of the mouth do in another way once the jaw is open.
//!
//! Weights of these fields are products of the jaw's opening and of the shape, so they are written for both
//! at their ends.

use glam::DVec3;

use super::{
    jaw,
    spot::{Mouth, Spot, dome},
};

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

/// Pursed lips draw the opening together to a small round one; the lower lip hides its teeth.
pub(super) fn pucker(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let (upper, lower) = both_lips(spot, &m, 1.2, 1.7);
    let middle = m.along(&[(0.0, 1.0), (0.5, 0.8), (1.0, 0.2), (1.4, 0.0)]);
    let aside = m.along(&[(0.0, 0.0), (0.6, 0.5), (1.0, 1.0), (1.4, 0.5), (2.0, 0.0)]);
    // Less beside the midline: the lower edge is a bow, not a wedge.
    let bow = m.along(&[(0.0, 0.80), (0.3, 0.66), (0.6, 0.34), (1.0, 0.06), (1.3, 0.0)]);
    let rise =
        DVec3::new(0.0, -0.24 * upper, 0.10 * (lower + upper)) * middle + DVec3::new(0.0, bow * lower, 0.0);
    unturned(spot, rise + DVec3::new(-0.22 * aside * (lower + upper), 0.0, 0.0))
}

/// The funnel of an open mouth is round: its lower lip rises before the teeth, its sides come in.
pub(super) fn funnel(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let (upper, lower) = both_lips(spot, &m, 1.2, 1.7);
    let middle = m.along(&[(0.0, 1.0), (0.5, 0.8), (1.0, 0.15), (1.4, 0.0)]);
    let aside = m.along(&[(0.0, 0.0), (0.6, 0.5), (1.0, 1.0), (1.4, 0.5), (2.0, 0.0)]);
    let bow = m.along(&[(0.0, 0.56), (0.3, 0.46), (0.6, 0.24), (1.0, 0.04), (1.3, 0.0)]);
    let rise = DVec3::new(0.0, -0.16 * upper, 0.06 * lower) * middle + DVec3::new(0.0, bow * lower, 0.0);
    unturned(spot, rise + DVec3::new(-0.16 * aside * (lower + upper), 0.0, 0.0))
}

/// A laugh: the upper lip bares its teeth, the lower one is drawn up to a wide bow.
pub(super) fn smile(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let (upper, lower) = both_lips(spot, &m, 1.4, 1.9);
    let bared = m.along(&[(0.0, 0.40), (0.45, 0.34), (0.8, 0.12), (1.0, 0.0)]);
    let drawn = m.along(&[(0.0, 0.44), (0.3, 0.32), (0.6, 0.10), (0.85, 0.0)]);
    unturned(spot, DVec3::new(0.0, bared * upper + drawn * lower, 0.0))
}
