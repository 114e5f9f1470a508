//! The plain top that she wears: where it lies, its colour and its relief.

use glam::DVec3;

use super::rgb;
use crate::math::{fbm, sin, smooth};

/// How far a place lies below the neckline, in head units; negative above.
#[must_use]
pub fn below_neckline(p: DVec3) -> f64 {
    // A plane cut: low over the breastbone, over the shoulders beside the neck, high at the nape; in front it
    // is rounder than a plane would be.
    let plane = -16.35 - 0.50 * (p.z + 7.0) + 0.045 * p.x * p.x * smooth(-9.0, -2.0, p.z);
    0.9 * (plane - p.y)
}

/// How much of a place is cloth, 0…1.
#[must_use]
pub fn at(p: DVec3) -> f64 {
    smooth(-0.10, 0.10, below_neckline(p))
}

/// Width of the hem.
const HEM: f64 = 0.62;

/// The colour of the cloth.
#[must_use]
pub fn colour(p: DVec3) -> DVec3 {
    let below = below_neckline(p);
    let seam = smooth(0.07, 0.0, (below - HEM).abs());
    let edge = smooth(0.16, 0.0, below);
    let worn = 1.0 + 0.06 * fbm(p * 0.6, 3) + 0.05 * fbm(p * 5.0, 2);
    rgb(52, 66, 78) * worn * (1.0 - 0.35 * seam) * (1.0 - 0.30 * edge)
}

/// Height of the cloth over the skin: the hem is rolled, the rest is a fine knit.
#[must_use]
pub fn height(p: DVec3) -> f64 {
    let below = below_neckline(p);
    if below < -0.2 {
        return 0.0;
    }
    let cloth = 0.05 * smooth(-0.14, 0.14, below);
    let hem = 0.03 * smooth(HEM + 0.12, HEM - 0.08, below) * smooth(-0.05, 0.1, below);
    let knit = 0.006 * sin(p.x * 24.0) * smooth(HEM, HEM + 0.1, below);
    cloth + hem + knit
}
