//! Brows and lids.

use glam::DVec3;

use super::spot::{Spot, dome_skewed};
use crate::{
    anatomy::EYE,
    lids,
    math::{curve, dome, lerp, smooth},
};

/// How the skin about the brow follows it: all at the brow, less up the forehead and down to the lid.
fn follow(spot: &Spot, along: &[(f64, f64)], up: f64, down: f64) -> f64 {
    let (s, h) = spot.brow();
    curve(along, s) * dome_skewed(h, down, up) * spot.on_face()
}

/// The brow comes down and toward the nose.
pub(super) fn down(spot: &Spot) -> DVec3 {
    let along = [(-0.5, 0.25), (0.0, 0.80), (0.3, 1.0), (0.7, 0.8), (1.05, 0.5), (1.7, 0.0)];
    let w = follow(spot, &along, 1.6, 1.05);
    DVec3::new(-0.30, -0.56, 0.12) * w
}

/// The inner ends of both brows rise.
pub(super) fn inner_up(spot: &Spot) -> DVec3 {
    let along = [(-0.4, 0.8), (0.0, 1.0), (0.2, 0.9), (0.5, 0.3), (0.85, 0.0)];
    let w = follow(spot, &along, 2.3, 1.1);
    let inward = smooth(0.0, 1.4, spot.p().x);
    DVec3::new(-0.05 * inward, 0.62, 0.03) * w
}

/// The outer half of the brow rises.
pub(super) fn outer_up(spot: &Spot) -> DVec3 {
    let along = [(-0.1, 0.0), (0.25, 0.3), (0.65, 1.0), (0.95, 0.9), (1.5, 0.0)];
    let w = follow(spot, &along, 2.1, 1.3);
    DVec3::new(0.05, 0.60, -0.16) * w
}

/// Displacement of a lid that slides about the eye by an angle (positive lifts), in radians. Toward the
/// corners of the eye, where the two lids meet, it dies out.
fn lid(spot: &Spot, lower: bool, angle_rad: f64) -> DVec3 {
    if spot.on_lower_lid() != lower || spot.in_mouth() {
        return DVec3::ZERO;
    }
    let s = lids::along(spot.p() - EYE);
    let within = smooth(0.0, 0.3, s) * smooth(1.0, 0.7, s);
    spot.about_eye(angle_rad * within * lids::weight(spot.p(), lower))
}

/// The lower lid of a squint: it rises by the same share of its way to the closed one, so that its edge stays
/// a bow from corner to corner.
fn lower_lid_drawn_up(spot: &Spot) -> DVec3 {
    if !spot.on_lower_lid() || spot.in_mouth() {
        return DVec3::ZERO;
    }
    let rel = spot.p() - EYE;
    let below = dome(((rel.x - 0.4) / 1.9).powi(2) + ((rel.y + 1.45) / 0.95).powi(2)) * spot.on_face();
    let s = lids::along(rel);
    let within = smooth(0.0, 0.25, s) * smooth(1.0, 0.75, s);
    // Next to the corners, where the smallest triangles are, less.
    let share = SQUINT * lerp(0.2, 1.0, smooth(0.0, 0.12, s) * smooth(1.0, 0.88, s));
    let of_edge = share * lids::LOWER_CLOSE * lids::weight(spot.p(), true);
    spot.about_eye(of_edge + 0.10 * below * within)
}

/// Share of its way to the closed one by which a squint draws the lower lid up.
const SQUINT: f64 = 0.8;
/// By how much it turns the upper lid, in radians for skin that follows it wholly.
const UPPER_SQUINT: f64 = -0.12;

/// The ring muscle of the eye: the lower lid rises with the skin below and beside it, the upper one comes
/// down by a little.
pub(super) fn eye_squint(spot: &Spot) -> DVec3 {
    lower_lid_drawn_up(spot) + lid(spot, false, UPPER_SQUINT) + beside_drawn_in(spot)
}

/// The skin beside and below the outer corner is drawn toward it.
fn beside_drawn_in(spot: &Spot) -> DVec3 {
    let rel = spot.p() - EYE;
    let outer = dome(((rel.x - 2.2) / 1.5).powi(2) + ((rel.y + 1.2) / 1.5).powi(2)) * spot.on_face();
    DVec3::new(-0.17, 0.13, 0.06) * outer
}

/// Closed lids have no way left: what a squint draws them together is taken back, and part of what it draws
/// in beside them.
pub(super) fn closed_squint(spot: &Spot) -> DVec3 {
    let near = if spot.node.lid <= 1.0 { smooth(0.8, 0.2, spot.node.lid) } else { 0.0 };
    -lower_lid_drawn_up(spot) * near
        - lid(spot, false, UPPER_SQUINT)
        - beside_drawn_in(spot) * BESIDE_TAKEN_BACK
}

/// How much of that closed lids take back.
const BESIDE_TAKEN_BACK: f64 = 0.5;

/// The upper lid rises and the lower one sinks by a trace.
pub(super) fn eye_wide(spot: &Spot) -> DVec3 {
    let rel = spot.p() - EYE;
    let above = dome(((rel.x - 0.1) / 1.7).powi(2) + ((rel.y - 1.3) / 0.7).powi(2)) * spot.on_face();
    lid(spot, false, 0.30) + lid(spot, true, -0.10) + spot.about_eye(0.06 * above)
}
