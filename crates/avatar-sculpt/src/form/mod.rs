//! The head as a solid: one distance-like function, put together from the skull, the features and fine
//! furrows.
//!
//! A sculpt of smooth unions was chosen over a hand-placed control mesh because every feature stays a named
//! thing with a place and a size, because forms that meet blend by themselves, and because any mesh density
//! can be drawn from it. What a distance function is poor at (thin sheets: lids' edges, mouth bag, ears) is
//! swept directly.

mod bust;
mod features;
mod furrows;
mod lips;
mod skull;

use glam::DVec3;

pub use bust::{HEM_EDGE, below_neckline};

use crate::sdf::join;

/// Signed distance (to first order) from the skin; negative inside. Even in `x`.
#[must_use]
pub fn distance(p: DVec3) -> f64 {
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    let mut d = skull::distance(q);
    // Far from the skin the details cannot matter; skipping them there makes marching several times faster.
    if d > 3.5 {
        return d - 1.2;
    }
    d = features::add_cheeks_and_brow(d, q);
    d = features::add_eyes(d, q);
    d = features::add_nose(d, q);
    d = lips::add(d, q);
    d = join(d, features::chin(q), 0.9);
    d + furrows::depth(q) - bust::cloth(q)
}

/// Distance from the hollow of a nostril; negative inside. For the left half, x ≥ 0.
#[must_use]
pub fn nostril(q: DVec3) -> f64 {
    features::nostril(q)
}

/// Outward direction of the skin at `p`.
#[must_use]
pub fn normal(p: DVec3) -> DVec3 {
    const H: f64 = 1e-4;
    let along = |axis: DVec3| distance(p + axis * H) - distance(p - axis * H);
    let n = DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z));
    // On the midline the mirrored halves must agree exactly.
    let n = if p.x == 0.0 { DVec3::new(0.0, n.y, n.z) } else { n };
    n.normalize_or_zero()
}
