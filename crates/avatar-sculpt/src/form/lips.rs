//! The lips: two tapering pads that follow the line of the mouth.

use glam::DVec3;

use crate::{
    anatomy::{MOUTH_HALF_WIDTH, lower_lip, mouth_depth, mouth_line, upper_lip},
    math::{bell, smooth},
    sdf::{carve, ellipsoid, join},
};

/// Adds both lips to the face.
pub(super) fn add(d: f64, q: DVec3) -> f64 {
    if (q.y + 5.6).abs() > 3.0 || q.x > 4.5 || q.z < 0.0 {
        return d;
    }
    let u = (q.x / MOUTH_HALF_WIDTH).min(1.0);
    let line = mouth_line(u).y;
    let depth = mouth_depth(u);
    let fade = 1.0 - smooth(0.55, 1.08, q.x / MOUTH_HALF_WIDTH);
    // At the corner the pads run out flat: blades there would draw lines onto the cheek.
    let taper = 1.0 - smooth(0.72, 1.04, q.x / MOUTH_HALF_WIDTH);
    let overshoot = (q.x - MOUTH_HALF_WIDTH).max(0.0);
    // Each pad is an ellipse across the mouth line; its distance is taken in that plane only.
    let pad = |centre_y: f64, centre_z: f64, ry: f64, rz: f64| {
        let flat = DVec3::new(overshoot, q.y - centre_y, q.z - centre_z);
        ellipsoid(flat, DVec3::ZERO, DVec3::new(0.25, ry, rz))
    };
    let (hu, hl) = (upper_lip(u), lower_lip(u));
    let tubercle = 0.05 * bell(q.x, 0.35);
    let upper =
        pad(line + 0.44 * hu, depth - 0.17, 0.60 * hu + 0.02, 0.05 + 0.09 * taper + (0.30 + tubercle) * fade);
    let lower = pad(line - 0.46 * hl, depth - 0.26, 0.58 * hl + 0.02, 0.05 + 0.07 * taper + 0.36 * fade);
    // The skin falls in a little where it meets the mouth line: the crease reads even when the lips touch.
    let crease = ellipsoid(
        DVec3::new(overshoot, q.y - line, q.z - depth - 0.05 - 0.20 * fade),
        DVec3::ZERO,
        DVec3::new(0.16, 0.06, 0.12 + 0.23 * fade),
    );
    let d = join(d, upper, 0.26);
    let d = join(d, lower, 0.26);
    carve(d, crease, 0.08)
}
