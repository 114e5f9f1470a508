//! What one lip does.

use glam::DVec3;

use super::spot::{Mouth, Spot};
use crate::math::{curve, dome, smooth};

/// How the upper lip and the skin up to the nose follow the lip's edge.
fn upper(spot: &Spot, m: &Mouth, reach: f64) -> f64 {
    m.is_upper() * dome((m.fade_height(spot).max(0.0) / reach).powi(2)) * m.front
}

/// How the lower lip and the skin down to the chin follow the lip's edge.
fn lower(spot: &Spot, m: &Mouth, reach: f64) -> f64 {
    m.is_lower() * dome((m.fade_height(spot).min(0.0) / reach).powi(2)) * m.front
}

/// What of a motion backward the lips' inner side takes, behind which teeth and gums stand.
fn outer(spot: &Spot) -> f64 {
    if spot.in_mouth() { smooth(0.25, 0.0, spot.node.own.x) } else { 1.0 }
}

/// The upper lip rises on one side.
pub(super) fn upper_up(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let along = m.along(&[(0.0, 0.85), (0.45, 1.0), (0.8, 0.6), (1.1, 0.25), (1.7, 0.0)]);
    DVec3::new(0.14, 0.52, 0.03) * (upper(spot, &m, 1.5) * along)
}

/// The lower lip sinks on one side.
pub(super) fn lower_down(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let along = m.along(&[(0.0, 0.9), (0.4, 1.0), (0.75, 0.55), (1.05, 0.2), (1.6, 0.0)]);
    DVec3::new(0.22, -0.50, 0.06) * (lower(spot, &m, 2.1) * along)
}

/// The lips are pressed together on one side: the red thins, the corner is drawn out and up.
pub(super) fn press(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let corner = m.corner(spot, 1.7, 1.6, 1.4, 1.6);
    let along = m.along(&[(0.0, 0.9), (0.45, 0.95), (0.8, 0.32), (1.0, 0.04), (1.2, 0.0)]) * m.front;
    let thin = curve(&[(0.0, 0.0), (0.5, 0.7), (1.0, 1.0), (1.5, 0.5), (2.0, 0.0)], m.across);
    let back = curve(&[(0.0, 0.4), (0.5, 1.0), (1.0, 0.4), (1.6, 0.0)], m.across);
    DVec3::new(0.32, 0.20, 0.02) * corner + DVec3::new(0.0, -0.22 * m.upper * thin, -0.17 * back) * along
}

/// The upper lip is rolled inward over the teeth; the skin up to the nose is drawn down.
pub(super) fn roll_upper(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let along = m.along(&[(0.0, 1.0), (0.4, 0.85), (0.75, 0.35), (1.0, 0.06), (1.4, 0.0)]);
    let down = curve(&[(0.0, 0.12), (0.5, 0.29), (1.0, 0.48), (1.5, 0.50), (2.0, 0.40)], m.across);
    let back = curve(&[(0.0, 0.20), (0.5, 0.44), (1.0, 0.38), (1.5, 0.22), (2.0, 0.12)], m.across);
    let above = dome(((m.fade_height(spot) - 0.9).max(0.0) / 1.25).powi(2));
    DVec3::new(0.0, -down, -back * outer(spot)) * (m.is_upper() * along * above * m.front)
}

/// The lower lip is rolled inward over the teeth; the skin below it is drawn up over them.
pub(super) fn roll_lower(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let along = m.along(&[(0.0, 1.0), (0.45, 0.95), (0.8, 0.38), (1.0, 0.06), (1.3, 0.0)]);
    let up = curve(&[(0.0, 0.12), (0.5, 0.40), (1.0, 0.64), (1.5, 0.58), (2.0, 0.40)], m.across);
    let forward = curve(&[(0.0, -0.20), (0.4, -0.22), (0.8, 0.0), (1.1, 0.16), (2.0, 0.20)], m.across);
    let below = dome(((m.fade_height(spot) + 1.0).min(0.0) / 1.3).powi(2));
    let forward = if forward < 0.0 { forward * outer(spot) } else { forward };
    DVec3::new(0.0, up, forward) * (m.is_lower() * along * below * m.front)
}

/// The chin pushes the lower lip up and forward, and the upper lip gives way.
pub(super) fn shrug_lower(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let along = m.along(&[(0.0, 1.0), (0.5, 0.8), (1.0, 0.2), (1.4, 0.0)]);
    let given = m.is_upper() * dome((m.fade_height(spot).max(0.0) / 0.45).powi(2)) * m.front;
    let p = spot.p();
    let chin = dome((p.x / 1.5).powi(2) + ((p.y + 8.3) / 1.1).powi(2)) * spot.on_face();
    DVec3::new(0.0, 0.42, 0.26) * (lower(spot, &m, 1.5) * along)
        + DVec3::new(0.0, 0.40, 0.10) * (given * along)
        + DVec3::new(0.0, 0.24, 0.06) * chin
}

/// The upper lip pouts: its red turns outward toward the nose. Both lips stay closed.
pub(super) fn shrug_upper(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let along = m.along(&[(0.0, 1.0), (0.5, 0.85), (0.9, 0.35), (1.3, 0.0)]);
    // Where the lips touch little rises, so that no tooth is seen; the lower lip comes along there.
    let up = curve(&[(0.0, 0.14), (0.5, 0.34), (1.0, 0.56), (1.5, 0.52), (2.0, 0.44)], m.across);
    let forward = curve(&[(0.0, 0.08), (0.5, 0.20), (1.0, 0.24), (1.5, 0.12), (2.0, 0.04)], m.across);
    let up = if spot.in_mouth() { 0.14 } else { up };
    let given = m.is_lower() * dome((m.fade_height(spot).min(0.0) / 0.7).powi(2)) * m.front;
    DVec3::new(0.0, up, forward) * (upper(spot, &m, 1.3) * along)
        + DVec3::new(0.0, 0.14, 0.06) * (given * along)
}
