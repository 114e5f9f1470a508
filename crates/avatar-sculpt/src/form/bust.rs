//! Collarbones, shoulders and the upper end of the chest, down to the edge where the bust stops.

use glam::DVec3;

use crate::{
    math::{bell, smooth},
    sdf::{cone, ellipsoid, join},
};

/// Where the bust stands under the neck; its parts are written for an upright neck.
const PLACE: DVec3 = DVec3::new(0.0, -0.2, -0.2);

/// Above this height nothing of the bust can show.
const TOP: f64 = -7.0;

/// Joins the bust with the neck, whose distance is `neck`.
pub(super) fn join_below(neck: f64, q: DVec3) -> f64 {
    if q.y > TOP {
        return neck;
    }
    join(neck, distance(q - PLACE), 2.4)
}

/// How thick the cloth of the top is.
const CLOTH: f64 = 0.14;
/// How far below the neckline the cloth has its whole thickness.
pub const HEM_EDGE: f64 = 0.13;

/// How far a place lies below the neckline of the top, in head units; negative above.
#[must_use]
pub fn below_neckline(p: DVec3) -> f64 {
    // A plane cut: low over the breastbone, over the shoulders beside the neck, high at the nape; in front it
    // is rounder than a plane would be.
    let plane = -16.35 - 0.50 * (p.z + 7.0) + 0.045 * p.x * p.x * smooth(-9.0, -2.0, p.z);
    // Cloth goes straight from the shoulder to the collarbone; it would creep into the hollow between them.
    let hollow = 1.6 * bell(p.x.abs() - 5.6, 2.6) * bell(p.z + 6.0, 1.7);
    0.9 * (plane - hollow - p.y)
}

/// How far the cloth lies over the skin.
pub(super) fn cloth(q: DVec3) -> f64 {
    if q.y > TOP { 0.0 } else { CLOTH * smooth(0.0, HEM_EDGE, below_neckline(q)) }
}

fn distance(q: DVec3) -> f64 {
    let ribs = ellipsoid(q, DVec3::new(0.0, -27.6, -6.3), DVec3::new(12.4, 11.8, 6.6));
    let girdle = cone(q, DVec3::new(0.0, -19.2, -7.2), 3.0, DVec3::new(12.0, -19.9, -7.0), 2.5);
    let arm = cone(q, DVec3::new(12.9, -20.4, -6.9), 3.0, DVec3::new(13.6, -31.0, -6.7), 2.9);
    // From the nape down to the end of the shoulder.
    let trapezius = cone(q, DVec3::new(1.6, -11.6, -7.3), 1.8, DVec3::new(11.0, -18.7, -7.4), 1.5);
    let chest = cone(q, DVec3::new(4.6, -26.0, -2.6), 3.0, DVec3::new(10.0, -22.0, -5.2), 2.2);
    let body = join(join(join(ribs, girdle, 3.4), arm, 5.0), chest, 3.0);
    let body = join(join(body, trapezius, 2.8), upper_chest(q), 2.0);
    join(body, collarbone(q), 1.5)
}

/// The muscle below the collarbone: without it the bone would overhang.
fn upper_chest(q: DVec3) -> f64 {
    cone(q, DVec3::new(2.2, -19.6, -4.3), 2.2, DVec3::new(9.6, -19.8, -6.2), 1.9)
}

/// An S from the breastbone to the shoulder.
fn collarbone(q: DVec3) -> f64 {
    let inner = cone(q, DVec3::new(1.15, -16.75, -2.55), 0.60, DVec3::new(5.2, -16.65, -3.05), 0.46);
    let outer = cone(q, DVec3::new(5.2, -16.65, -3.05), 0.46, DVec3::new(11.6, -17.3, -6.3), 0.62);
    join(inner, outer, 1.0)
}
