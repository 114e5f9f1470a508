//! What the corners of the mouth do.

use glam::DVec3;

use super::spot::Spot;
use crate::{
    cheek,
    math::{dome3, smooth},
};

/// The corner goes up, out and back, and the cheek above it rises.
pub(super) fn smile(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let widths = [1.55, 1.35, 1.75, 1.5];
    let across = m.bent(spot, &[(0.0, 0.0), (0.5, 0.42), (1.0, 1.0)], widths);
    let up = m.bent(spot, &[(0.0, 0.04), (0.3, 0.13), (0.6, 0.42), (1.0, 1.0)], widths);
    let back = m.bent(spot, &[(0.0, 0.22), (0.5, 0.5), (1.0, 1.0)], widths);
    // The lips are drawn tight over the teeth, and thin out.
    let thin = DVec3::new(0.0, -0.05 * m.upper, -0.06)
        * ((1.0 - m.u * m.u).max(0.0) * m.front * smooth(1.6, 0.9, m.across));
    DVec3::new(0.78 * across, 0.82 * up, -0.45 * back) + thin + cheek::risen(spot.p()) * spot.on_face()
}

/// The corner goes down.
pub(super) fn frown(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let w = m.corner(spot, 1.35, 1.4, 1.3, 1.5);
    DVec3::new(0.12, -0.60, -0.03) * w
}

/// The corner is drawn straight back and in: a dimple.
pub(super) fn dimple(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let w = m.corner(spot, 1.3, 1.9, 1.6, 1.5);
    let pit = dome3(spot.p(), DVec3::new(2.75, -5.45, 3.2), DVec3::new(0.45, 0.55, 0.9)) * spot.on_face();
    DVec3::new(0.44, 0.24, -0.36) * w + DVec3::new(-0.06, 0.0, -0.16) * pit
}

/// The corner is drawn out, back and down.
pub(super) fn stretch(spot: &Spot) -> DVec3 {
    let m = spot.mouth();
    let w = m.corner(spot, 1.45, 1.5, 1.4, 1.6);
    DVec3::new(0.58, -0.34, -0.40) * w
}
