//! How the lids turn about the eye.
//!
//! A lid joint turns about the level axis through the eye's centre, so in coordinates (along the axis,
//! radius, angle) a lid only changes its angle. Linear blending of a still and a turning bone cuts the corner
//! of that arc and brings skin nearer to the axis; [`shrink`] says by how much, and the lids' inner side
//! keeps that distance.

use glam::DVec3;

use crate::{
    anatomy::{CANTHUS_INNER, CANTHUS_OUTER, EYE, LID_RADIUS, lid_margin},
    math::{atan2, cos, lerp, pow, smooth},
};

/// Largest closing angles of the lids, in radians.
pub const UPPER_CLOSE: f64 = std::f64::consts::FRAC_PI_4;
/// See [`UPPER_CLOSE`].
pub const LOWER_CLOSE: f64 = 0.436_332_312_998_582_4;
/// How far past the line where they meet the upper and the lower lid close in the middle, in radians: brows
/// and cheeks that draw at the lids must not part them.
const PAST_LINE: (f64, f64) = (0.075, 0.025);
/// How fast that comes with the height of the opening, from the corners on.
const PAST_FADE: f64 = 0.45;

/// Where a point lies between the corners of the eye: 0 at the inner, 1 at the outer one.
#[must_use]
pub fn along(rel: DVec3) -> f64 {
    (rel.x - CANTHUS_INNER.x) / (CANTHUS_OUTER.x - CANTHUS_INNER.x)
}

/// Height of the line through both corners at a point beside the eye's centre.
#[must_use]
pub fn corner_line(rel: DVec3) -> f64 {
    lerp(CANTHUS_INNER.y, CANTHUS_OUTER.y, along(rel).clamp(-0.3, 1.3))
}

/// Angle about the lids' axis of a height over the eye's centre, on the lids' ball.
fn angle_of(offset_x: f64, height: f64) -> f64 {
    let radius = (LID_RADIUS * LID_RADIUS - offset_x * offset_x).max(0.2).sqrt();
    libm::asin((height / radius).clamp(-1.0, 1.0))
}

/// Angle of a lid's margin, and the share of its joint's largest turn that takes the margin to the line where
/// the lids meet, and a little past it.
fn margin_and_share(s: f64, lower: bool) -> (f64, f64) {
    let margin = lid_margin(s, !lower);
    let arch = 4.0 * s * (1.0 - s);
    // Closed lids meet below the middle: the upper one does most of the way.
    let line = lerp(CANTHUS_INNER.y, CANTHUS_OUTER.y, s) - 0.26 * arch;
    let angle = angle_of(margin.x, margin.y);
    let way = (angle - angle_of(margin.x, line)).abs();
    let past = if lower { PAST_LINE.1 } else { PAST_LINE.0 } * pow(arch, PAST_FADE);
    let turn = if lower { LOWER_CLOSE } else { UPPER_CLOSE };
    (angle, ((way + past) / turn).min(1.0))
}

/// How far the edge of the lower lid lies behind the upper lid when both are closed, in radians.
#[must_use]
pub fn covered(s: f64) -> f64 {
    (PAST_LINE.0 + PAST_LINE.1) * pow((4.0 * s * (1.0 - s)).max(0.0), PAST_FADE)
}

/// How much a point of the skin follows its lid.
#[must_use]
pub fn weight(p: DVec3, lower: bool) -> f64 {
    let rel = p - EYE;
    if rel.length_squared() > 12.0 {
        return 0.0;
    }
    let s = along(rel);
    if s <= 0.0 || s >= 1.0 || rel.z <= 0.0 {
        return 0.0;
    }
    let (margin_angle, near) = margin_and_share(s, lower);
    let angle = atan2(rel.y, rel.z);
    let beyond = if lower { margin_angle - angle } else { angle - margin_angle };
    // Away from the margin the motion dies out more gently toward the corners than the opening itself does.
    let far = margin_and_share(0.5, lower).1 * smooth(0.0, 0.32, s) * smooth(1.0, 0.68, s);
    let spread = lerp(near, far, smooth(0.05, 0.6, beyond));
    let reach = if lower { 0.46 } else { 0.58 };
    // Brow and cheek lie farther out than any lid and stay where they are.
    let on_ball = smooth(2.95, 2.3, rel.length());
    spread * on_ball * smooth(0.0, 0.4, rel.z) * smooth(reach, 0.06, beyond)
}

/// Nearest approach to the axis, as a factor, of skin that follows a turn up to `angle_rad` by `weight`.
#[must_use]
pub fn shrink(weight: f64, angle_rad: f64) -> f64 {
    (1.0 - 2.0 * weight * (1.0 - weight) * (1.0 - cos(angle_rad))).sqrt()
}
