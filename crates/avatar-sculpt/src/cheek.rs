//! The cheek that a smile lifts.

use glam::DVec3;

use crate::{
    anatomy::mouth_line,
    math::{curve, dome, dome3, smooth},
};

/// Where the fold from the wing of the nose around the corner of the mouth runs, seen from the front:
/// heights, and how far from the midline. The painted groove (`paint::wrinkles`) lies in it.
const FOLD: [(f64, f64); 6] =
    [(-6.9, 3.02), (-6.1, 3.18), (-5.2, 2.95), (-4.3, 2.40), (-3.25, 1.74), (-2.5, 1.30)];

/// What a smile does to the cheek of the left half: the corner of the mouth pushes it up against the bone,
/// where it swells below the eye, and it hangs over the fold beside the mouth.
#[must_use]
pub fn risen(p: DVec3) -> DVec3 {
    let apple = dome3(p, DVec3::new(3.55, -2.85, 2.6), DVec3::new(1.4, 1.35, 2.0));
    // Below the apple the edge of the swelling follows the fold, and the fold itself sinks.
    let along = curve(&[(-6.7, 0.0), (-5.6, 0.55), (-4.6, 1.0), (-3.5, 0.9), (-2.9, 0.5), (-2.3, 0.0)], p.y);
    let beside = (p.x - curve(&FOLD, p.y)) * 0.85;
    let front = smooth(0.6, 2.4, p.z) * along;
    let edge = dome(((beside - 0.72) / 0.6).powi(2)) * front;
    let sunk = dome((beside / 0.3).powi(2)) * front;
    // What has risen is missing below.
    let below = dome3(p, DVec3::new(4.3, -5.3, 1.6), DVec3::new(1.3, 1.1, 2.0));
    let cheek = DVec3::new(0.26, 0.40, 0.62) * apple + DVec3::new(0.06, 0.08, 0.26) * edge
        - DVec3::new(0.06, 0.0, 0.17) * sunk
        - DVec3::new(0.10, 0.0, 0.12) * below;
    // At the corner of the mouth triangles are so small that any further difference folds them.
    cheek * smooth(0.6, 1.4, p.truncate().distance(mouth_line(1.0)))
}
