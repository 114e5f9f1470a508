//! Cheeks and nose.

use glam::DVec3;

use super::spot::Spot;
use crate::{
    anatomy::EYE,
    math::{curve, dome, dome3, smooth},
};

/// The cheek of the left half over a fully opened jaw, as a displacement of the opened face: it is drawn long
/// between the bone and the jaw, and falls in.
pub(super) fn hollowed(p: DVec3) -> DVec3 {
    let hollow = dome3(p, DVec3::new(4.6, -4.6, 1.3), DVec3::new(1.7, 2.0, 2.4));
    let apple = dome3(p, DVec3::new(3.5, -3.0, 2.6), DVec3::new(1.5, 1.4, 2.0));
    DVec3::new(-0.40, 0.0, -0.34) * hollow + DVec3::new(-0.06, -0.22, -0.12) * apple
}

/// Air behind closed lips: the cheeks swell, and the skin around the lips with them.
pub(super) fn puff(spot: &Spot) -> DVec3 {
    let p = spot.p();
    let cheek = dome3(p, DVec3::new(4.3, -4.9, 1.7), DVec3::new(1.9, 1.9, 2.6)) * spot.on_face();
    let m = spot.mouth();
    let around = dome((m.u / 1.3).powi(2) + (m.fade_height(spot) / 1.3).powi(2)) * m.front;
    // Air presses outward; the closed lips are held together at their corners.
    DVec3::new(0.78, 0.0, 1.10) * cheek + DVec3::new(-0.12 * smooth(0.0, 2.2, p.x), 0.0, 0.34) * around
}

/// The cheek rises toward the lower lid.
pub(super) fn squint(spot: &Spot) -> DVec3 {
    let p = spot.p();
    let d2 = ((p - DVec3::new(4.5, -2.8, 1.9)) / DVec3::new(1.9, 1.5, 2.8)).length_squared();
    let w = (0.75 * dome(d2) + 0.25 * dome(0.4 * d2)) * spot.on_face();
    // Toward the nose less moves.
    let beside = smooth(0.6, 2.8, p.x);
    let rel = p - EYE;
    let under = dome(((rel.x - 0.4) / 1.7).powi(2) + ((rel.y + 1.2) / 0.8).powi(2)) * spot.on_face();
    let lower = if spot.on_lower_lid() { 1.0 } else { 0.0 };
    DVec3::new(0.16, 0.86, 0.24) * w * beside + spot.about_eye(0.09 * under * lower)
}

/// The wing of the nose and the fold beside it rise, the skin at the root of the nose comes down.
pub(super) fn sneer(spot: &Spot) -> DVec3 {
    let p = spot.p();
    let on_face = spot.on_face();
    let wing = dome3(p, DVec3::new(1.3, -2.7, 4.3), DVec3::new(0.9, 1.2, 1.3)) * on_face;
    let beside = dome3(p, DVec3::new(1.7, -1.2, 3.5), DVec3::new(1.1, 1.2, 1.3)) * on_face;
    let cheek = dome3(p, DVec3::new(3.2, -2.2, 3.2), DVec3::new(1.3, 1.2, 1.4)) * on_face;
    let lip = dome3(p, DVec3::new(1.5, -4.4, 4.1), DVec3::new(1.1, 0.9, 1.3)) * on_face;
    let (s, h) = spot.brow();
    let along = curve(&[(-0.4, 0.5), (0.0, 1.0), (0.3, 0.85), (0.6, 0.4), (1.0, 0.0)], s);
    let brow = along * dome((h / 1.15).powi(2)) * on_face;
    DVec3::new(0.10, 0.52, 0.0) * wing
        + DVec3::new(-0.04, 0.30, 0.10) * beside
        + DVec3::new(-0.12, 0.10, 0.02) * cheek
        + DVec3::new(0.03, 0.30, -0.02) * lip
        + DVec3::new(-0.32, -0.54, 0.12) * brow
}
