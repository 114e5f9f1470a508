//! The large masses: cranium, face, neck and the rise toward the shoulders.

use glam::DVec3;

use super::bust;
use crate::{
    math::{curve, pow},
    sdf::{cone, ellipsoid, join},
};

/// Front profile of the bare face (without nose and lips): height → z.
const PROFILE: [(f64, f64); 14] = [
    (-10.6, 0.4),
    (-10.35, 2.0),
    (-9.9, 3.25),
    (-9.2, 3.95),
    (-8.4, 4.12),
    (-7.3, 3.98),
    (-5.6, 4.12),
    (-3.8, 4.15),
    (-2.0, 3.78),
    (0.4, 3.55),
    (2.2, 3.94),
    (4.0, 3.98),
    (6.0, 3.3),
    (9.0, 0.9),
];

/// Front outline of the face: height → half width.
const OUTLINE: [(f64, f64); 13] = [
    (-10.65, 0.5),
    (-10.4, 1.25),
    (-9.9, 2.1),
    (-9.0, 3.1),
    (-7.6, 4.3),
    (-6.0, 5.25),
    (-4.0, 6.05),
    (-2.0, 6.55),
    (0.0, 6.8),
    (2.0, 6.88),
    (4.0, 6.9),
    (6.5, 6.6),
    (9.0, 5.0),
];

/// How far back the face's mass reaches: height → z.
const BACK: [(f64, f64); 6] =
    [(-10.6, -2.0), (-9.5, -3.6), (-7.5, -5.6), (-5.5, -7.0), (-2.0, -9.0), (4.0, -12.0)];

/// Where the face is widest: height → z.
const WIDEST: [(f64, f64); 5] = [(-10.5, -0.6), (-8.0, -2.2), (-5.0, -3.6), (0.0, -4.4), (6.0, -4.8)];

/// Distance from skull and neck.
pub(super) fn distance(q: DVec3) -> f64 {
    let cranium = ellipsoid(q, DVec3::new(0.0, 3.7, -5.0), DVec3::new(7.15, 8.55, 9.1));
    let crown = ellipsoid(q, DVec3::new(0.0, 4.7, -6.9), DVec3::new(6.95, 6.9, 7.2));
    let head = join(join(cranium, crown, 1.5), join(face(q), jaw_bone(q), 1.5), 1.4);
    join(head, bust::join_below(neck(q), q), 1.1)
}

/// The face as a stack of rounded outlines between front profile, side outline and back.
fn face(q: DVec3) -> f64 {
    // The tables were drawn on a longer chin; below the mouth they are used in a shortened form.
    let drawn = if q.y < -6.0 { -6.0 + (q.y + 6.0) * 1.13 } else { q.y };
    let y = drawn.clamp(-10.6, 8.0);
    let (front, half, back, mid) =
        (curve(&PROFILE, y), curve(&OUTLINE, y), curve(&BACK, y), curve(&WIDEST, y));
    let dz = q.z - mid;
    // A front fuller than an ellipse gives the face a plane; the chin is rounder.
    let n = curve(&[(-10.6, 2.0), (-8.0, 2.15), (-4.0, 2.3), (2.0, 2.35), (6.0, 2.2)], y);
    let depth = if dz > 0.0 { front - mid } else { mid - back };
    let (a, b) = (q.x / half, dz.abs() / depth);
    let level = pow(pow(a, n) + pow(b, n), 1.0 / n);
    // First-order distance: the value over its slope, bounded so that the axis is not singular.
    let slope = ((a / half) * (a / half) + (b / depth) * (b / depth)).sqrt() / level.max(0.05);
    let radial = (level - 1.0) / slope.max(1.0 / 9.0);
    let above = (q.y - 8.0).max(-10.07 - q.y);
    if above > 0.0 { radial.max(0.0).hypot(above) } else { radial }
}

/// The edge of the jaw from the chin to its corner, and up to the ear: without it cheek and throat are one
/// ball.
fn jaw_bone(q: DVec3) -> f64 {
    let edge = cone(q, DVec3::new(0.7, -8.4, 1.5), 0.7, DVec3::new(4.1, -6.4, -3.4), 0.72);
    let branch = cone(q, DVec3::new(4.1, -6.4, -3.4), 0.72, DVec3::new(5.2, -2.6, -4.6), 0.8);
    join(edge, branch, 0.8)
}

/// Neck with the muscles that run from behind the ear to the breastbone, and the start of the shoulders.
fn neck(q: DVec3) -> f64 {
    // The column is a little deeper than wide.
    let narrow = DVec3::new(1.06, 1.0, 1.0);
    // It leads down and back: upright, it would be a pillar under the head.
    let column = cone(q * narrow, DVec3::new(0.0, -4.0, -5.3), 4.1, DVec3::new(0.0, -17.0, -6.3), 3.5);
    let strap = cone(q, DVec3::new(4.4, -5.2, -6.0), 0.6, DVec3::new(0.65, -15.7, -2.55), 0.5);
    let nape = cone(q, DVec3::new(0.9, -6.5, -8.1), 1.9, DVec3::new(2.4, -16.5, -7.6), 2.2);
    let base = ellipsoid(q, DVec3::new(0.0, -18.4, -6.25), DVec3::new(6.8, 4.0, 4.3));
    join(join(join(column, nape, 1.8), base, 2.6), strap, 1.4)
}
