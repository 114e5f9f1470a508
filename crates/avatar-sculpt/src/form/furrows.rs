//! Shallow furrows and swellings, added to the distance: positive values sink the skin.

use glam::DVec3;

use crate::{
    anatomy::{EYE, MOUTH_HALF_WIDTH, MOUTH_Y, lid_crease},
    math::{bell, bell3, smooth},
};

/// Depth of all furrows at a point.
pub(super) fn depth(q: DVec3) -> f64 {
    if q.z < -6.5 || q.y > 8.0 {
        return 0.0;
    }
    philtrum(q) + crease(q) + corner(q) + under_lip(q) + temple(q)
}

/// The groove between nose and upper lip, with its two ridges.
fn philtrum(q: DVec3) -> f64 {
    let along = smooth(-3.75, -4.2, q.y) * smooth(-5.1, -4.7, q.y) * smooth(3.0, 3.8, q.z);
    along * (0.075 * bell(q.x, 0.26) - 0.03 * bell(q.x - 0.42, 0.20))
}

/// The fold above the upper lid.
fn crease(q: DVec3) -> f64 {
    let rel = q - EYE;
    if rel.length_squared() > 9.0 || rel.z < 0.3 {
        return 0.0;
    }
    let along = smooth(-1.15, -0.1, rel.x) * smooth(2.1, 1.1, rel.x);
    let off = rel.y - lid_crease(rel.x);
    along * (0.10 * bell(off, 0.09) - 0.06 * bell(off - 0.26, 0.24))
}

/// The small pit at the corner of the mouth.
fn corner(q: DVec3) -> f64 {
    0.05 * bell3(q, DVec3::new(MOUTH_HALF_WIDTH + 0.14, MOUTH_Y - 0.04, 3.5), DVec3::new(0.30, 0.34, 0.9))
}

/// The hollow under the lower lip.
fn under_lip(q: DVec3) -> f64 {
    0.18 * bell3(q, DVec3::new(0.0, -7.15, 4.0), DVec3::new(1.5, 0.45, 1.0))
}

/// The hollow of the temple.
fn temple(q: DVec3) -> f64 {
    0.22 * bell3(q, DVec3::new(6.6, 2.2, -1.0), DVec3::new(1.2, 1.9, 1.8))
}
