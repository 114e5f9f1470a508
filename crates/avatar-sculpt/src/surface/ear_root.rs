//! Where the ear grows out of the head.

use glam::DVec2;

use crate::math::{cos, sin};

/// Vertices around an ear's root.
pub const EAR_AROUND: usize = 44;
/// Middle of the ear as (z, y).
const CENTRE: DVec2 = DVec2::new(-5.15, -0.85);
/// Size of the ear, against the one that its tables were drawn in.
const SIZE: f64 = 0.93;
/// How far the ear leans back.
const LEAN: f64 = 0.20;

/// From the ear's own plane (back, up) to (z, y).
#[must_use]
pub fn to_head(own: DVec2) -> DVec2 {
    let (s, c) = (sin(LEAN), cos(LEAN));
    CENTRE + DVec2::new(-c * own.x - s * own.y, -s * own.x + c * own.y) * SIZE
}

/// The line where the ear grows out of the head, as (z, y); `beta` runs from the back over the top.
#[must_use]
pub fn root(beta: f64) -> DVec2 {
    to_head(root_own(beta))
}

fn root_own(beta: f64) -> DVec2 {
    let up = if sin(beta) > 0.0 { 2.1 } else { 1.95 };
    DVec2::new(-0.25 + 0.66 * cos(beta), up * sin(beta))
}
