//! Eyeballs with an iris bowl, and the corneas over them.

use glam::{DVec2, DVec3};

use crate::{
    anatomy::{CORNEA_RISE, EYE, EYEBALL_RADIUS, IRIS_RADIUS},
    math::{cos, lerp, pow, sin, smooth},
    mesh::Part,
};

const PI: f64 = std::f64::consts::PI;
const AROUND: usize = 56;

/// Angle between the gaze and the iris's edge.
#[must_use]
pub fn iris_angle() -> f64 {
    libm::asin(IRIS_RADIUS / EYEBALL_RADIUS)
}

/// Distance from the image's middle for an angle from the gaze: the iris gets more than its share.
#[must_use]
pub fn image_radius(angle: f64) -> f64 {
    0.498 * pow(angle / PI, 0.6)
}

fn uv(angle: f64, turn: f64) -> DVec2 {
    DVec2::splat(0.5) + image_radius(angle) * DVec2::new(cos(turn), -sin(turn))
}

/// A surface around the gaze axis: `profile` gives (distance from the axis, depth) for an angle from the
/// gaze.
fn around_gaze(angles: &[f64], profile: impl Fn(f64) -> (f64, f64)) -> Part {
    let mut part = Part::default();
    part.add_grid(angles.len(), AROUND + 1, |r, c| {
        let turn = if c == AROUND { 0.0 } else { 2.0 * PI * c as f64 / AROUND as f64 };
        let (radius, depth) = profile(angles[r]);
        // The pole is one point: every column must agree on it to the last bit.
        let radius = if radius < 1e-9 { 0.0 } else { radius };
        let p = EYE + DVec3::new(radius * cos(turn), radius * sin(turn), depth);
        (p, uv(angles[r], turn))
    });
    part.finish();
    part
}

/// The left eyeball.
#[must_use]
pub fn eyeball() -> Part {
    let edge = iris_angle();
    let mut angles: Vec<f64> = (0..=8).map(|i| edge * f64::from(i) / 8.0).collect();
    angles.extend((1..=22).map(|i| lerp(edge, PI, pow(f64::from(i) / 22.0, 1.15))));
    let rim_depth = EYEBALL_RADIUS * cos(edge);
    around_gaze(&angles, |angle| {
        if angle >= edge {
            return (EYEBALL_RADIUS * sin(angle.min(PI)), EYEBALL_RADIUS * cos(angle));
        }
        let s = angle / edge;
        (IRIS_RADIUS * s, rim_depth - 0.17 * (1.0 - s * s) * (1.0 - 0.35 * smooth(0.5, 0.0, s)))
    })
}

/// The left cornea.
#[must_use]
pub fn cornea() -> Part {
    let edge = iris_angle();
    let angles: Vec<f64> = (0..=16).map(|i| 1.32 * edge * f64::from(i) / 16.0).collect();
    around_gaze(&angles, |angle| {
        let rise = smooth(1.22 * edge, 0.35 * edge, angle);
        let radius = EYEBALL_RADIUS + 0.004 + (CORNEA_RISE - 0.005) * rise;
        (radius * sin(angle), radius * cos(angle))
    })
}
