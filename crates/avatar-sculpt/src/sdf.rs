//! Distance-like primitives and the blends that join them into one skin.
//!
//! A value below zero means inside. The values of ellipsoids are first-order distances: good enough to march
//! along a ray with a cautious step, exact at the surface.

use glam::DVec3;

/// A ball.
#[must_use]
pub fn ball(p: DVec3, centre: DVec3, radius: f64) -> f64 {
    (p - centre).length() - radius
}

/// An ellipsoid along the axes.
#[must_use]
pub fn ellipsoid(p: DVec3, centre: DVec3, radii: DVec3) -> f64 {
    let q = p - centre;
    let k0 = (q / radii).length();
    let k1 = (q / (radii * radii)).length();
    if k1 < 1e-9 { -radii.min_element() } else { k0 * (k0 - 1.0) / k1 }
}

/// An ellipsoid turned about the x axis by `angle_rad` (positive tips its +y axis toward +z).
#[must_use]
pub fn ellipsoid_pitched(p: DVec3, centre: DVec3, radii: DVec3, angle_rad: f64) -> f64 {
    let (s, c) = (crate::math::sin(angle_rad), crate::math::cos(angle_rad));
    let q = p - centre;
    ellipsoid(DVec3::new(q.x, c * q.y + s * q.z, c * q.z - s * q.y), DVec3::ZERO, radii)
}

/// A capsule whose radius changes linearly from `a` to `b`.
#[must_use]
pub fn cone(p: DVec3, a: DVec3, radius_a: f64, b: DVec3, radius_b: f64) -> f64 {
    let ab = b - a;
    let s = ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (p - a - ab * s).length() - (radius_a + (radius_b - radius_a) * s)
}

/// Union with a fillet of size `k`.
#[must_use]
pub fn join(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    // The cubic fillet is smooth to the second derivative: highlights run across it without a line.
    a.min(b) - h * h * h * k / 6.0
}

/// `a` without `b`, with a rounded edge of size `k`.
#[must_use]
pub fn carve(a: f64, b: f64, k: f64) -> f64 {
    -join(-a, b, k)
}
