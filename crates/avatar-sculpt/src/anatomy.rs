//! The measures that form, mesh, weights and paint must agree on. One unit is about a centimetre of a real
//! head.
//!
//! All of it describes the character's left half (x ≥ 0); the right half is the mirror image.

use glam::{DVec2, DVec3};

use crate::math::{asin, curve, lerp, pow, sin, smooth};

/// Centre of the left eye, the pivot of its eyeball and of both its lids.
pub const EYE: DVec3 = DVec3::new(3.27, 0.25, 1.447);
/// Radius of the white of the eye.
pub const EYEBALL_RADIUS: f64 = 1.8;
/// How far the corneal apex stands out of the eyeball's sphere.
pub const CORNEA_RISE: f64 = 0.05;
/// Radius of the iris disc.
pub const IRIS_RADIUS: f64 = 0.68;
/// Radius that nothing of the eye ever reaches, whatever the gaze.
pub const EYE_REACH: f64 = EYEBALL_RADIUS + CORNEA_RISE;
/// Radius of the ball that the skin of the lids lies on.
pub const LID_RADIUS: f64 = 2.03;
/// Radius of the lids' inner edge, where they do not stretch.
pub const LID_INNER_RADIUS: f64 = EYE_REACH + 0.015;

/// Where the lids end, measured from the eye's centre: the inner and the outer corner.
pub const CANTHUS_INNER: DVec2 = DVec2::new(-1.54, -0.20);
/// See [`CANTHUS_INNER`].
pub const CANTHUS_OUTER: DVec2 = DVec2::new(1.64, 0.22);

/// Half the width of the mouth.
pub const MOUTH_HALF_WIDTH: f64 = 2.2;
/// Height of the line between the lips at the midline.
pub const MOUTH_Y: f64 = -5.6;

/// Pivot of the jaw, just in front of the ear.
pub const JAW: DVec3 = DVec3::new(0.0, -1.9, -4.2);
/// Pivot of the head.
pub const HEAD: DVec3 = DVec3::new(0.0, -9.2, -5.6);
/// Pivot of the neck.
pub const NECK: DVec3 = DVec3::new(0.0, -13.6, -6.2);
/// Height of the neck's lower end: what lies below follows no joint but the neck's.
pub const NECK_BASE_Y: f64 = -15.4;
/// Height of the edge where the bust stops.
pub const BUST_EDGE_Y: f64 = -24.5;

/// The margin of a lid as a height above the eye's centre, at `s` from the inner (0) to the outer corner (1).
#[must_use]
pub fn lid_margin(s: f64, upper: bool) -> DVec2 {
    let at = CANTHUS_INNER.lerp(CANTHUS_OUTER, s);
    // The upper arch peaks a little to the inner side, the lower one to the outer: an almond, not an ellipse.
    let skewed = if upper { pow(s, 0.86) } else { pow(s, 1.22) };
    let arch = pow(4.0 * skewed * (1.0 - skewed), if upper { 0.62 } else { 0.72 });
    DVec2::new(at.x, at.y + arch * if upper { 0.58 } else { -0.57 })
}

/// The line between the lips: a point for `u` from the midline (0) to the corner (1), seen from the front.
#[must_use]
pub fn mouth_line(u: f64) -> DVec2 {
    let wave = curve(&[(0.0, -0.07), (0.12, -0.06), (0.42, 0.045), (0.8, 0.005), (1.0, 0.045)], u);
    DVec2::new(u * MOUTH_HALF_WIDTH, MOUTH_Y + wave)
}

/// Depth of the line between the lips at `u` from the midline to the corner.
#[must_use]
pub fn mouth_depth(u: f64) -> f64 {
    lerp(4.50, 3.62, pow(u, 2.1))
}

/// Height of the red of the upper lip at `u` from the midline to the corner, with the cupid's bow.
#[must_use]
pub fn upper_lip(u: f64) -> f64 {
    let bow = [(0.0, 0.61), (0.06, 0.62), (0.21, 0.70), (0.45, 0.57), (0.75, 0.31), (1.0, 0.05)];
    curve(&bow, u)
}

/// Height of the red of the lower lip at `u` from the midline to the corner.
#[must_use]
pub fn lower_lip(u: f64) -> f64 {
    curve(&[(0.0, 0.94), (0.25, 0.91), (0.55, 0.70), (0.82, 0.33), (1.0, 0.05)], u)
}

/// Height of the crease above the upper lid at a lateral offset from the eye's centre.
#[must_use]
pub fn lid_crease(offset_x: f64) -> f64 {
    let s = ((offset_x - CANTHUS_INNER.x) / (CANTHUS_OUTER.x - CANTHUS_INNER.x)).clamp(-0.2, 1.2);
    curve(&[(-0.2, -0.25), (0.0, 0.16), (0.25, 0.94), (0.5, 1.16), (0.8, 0.98), (1.0, 0.62), (1.2, 0.3)], s)
}

/// The middle of the eyebrow at `s` from the inner end (0) to the tail (1), seen from the front, and its half
/// height.
#[must_use]
pub fn brow(s: f64) -> (DVec2, f64) {
    let x = lerp(1.25, 5.75, s);
    let y = curve(&[(0.0, 2.22), (0.3, 2.50), (0.62, 2.84), (0.8, 2.74), (1.0, 2.22)], s);
    (DVec2::new(x, y), curve(&[(0.0, 0.26), (0.15, 0.36), (0.6, 0.30), (1.0, 0.06)], s))
}

/// How much of the jaw's motion the skin at `p` takes, before the neck is considered; `lower` says on which
/// side of the mouth line a point lies that could be on either.
#[must_use]
pub fn below_mouth(p: DVec3, lower: bool) -> f64 {
    // The angle about the jaw's pivot, measured down from the level line, against that of the line between
    // the lips: the cheek's transition is a fan that opens toward the corner of the mouth.
    let about_jaw = |y: f64, z: f64| crate::math::atan2(JAW.y - y, z - JAW.z);
    let rel = p - JAW;
    let x = p.x.abs();
    let u = (x / MOUTH_HALF_WIDTH).min(1.0);
    let below = about_jaw(p.y, p.z) - about_jaw(mouth_line(u).y, mouth_depth(u));
    // As a length, so that the transition stays gentle close to the joint.
    let radius = rel.y.hypot(rel.z).max(4.0);
    // Toward the corner the lips are thin, and what is beside them has to take the stretch.
    let near = lerp(0.67, 1.35, smooth(0.3, 1.0, u));
    let spread = lerp(near, 2.8, smooth(MOUTH_HALF_WIDTH - 0.3, MOUTH_HALF_WIDTH + 2.2, x));
    // An opened mouth is an oval. Lips at the heights 1 and -1 of this line part by as much of the jaw's way
    // as the cubic ease below gives them, (3h - h³)/2 = sin(3a) for h = 2 sin(a): solved for the height of an
    // ellipse over its axis, (1 - u²)^½ = sin(π/2 - asin(u)).
    let inside = 2.0 * sin((0.5 * std::f64::consts::PI - asin(u)) / 3.0);
    let side = if lower { 1.0 } else { -1.0 };
    smooth(-1.0, 1.0, below * radius / spread + side * inside)
}
