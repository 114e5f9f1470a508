//! The plain top that she wears: where it lies, its colour and its relief.

use glam::DVec3;

use super::rgb;
use crate::{
    form::{HEM_EDGE, below_neckline},
    math::{fbm, sin, smooth},
};

/// Width of the hem.
const HEM: f64 = 0.62;

/// The colour of the cloth.
#[must_use]
pub fn colour(p: DVec3) -> DVec3 {
    let below = below_neckline(p);
    let seam = smooth(0.07, 0.0, (below - HEM).abs());
    let edge = smooth(HEM_EDGE, 0.0, below);
    let worn = 1.0 + 0.06 * fbm(p * 0.6, 3) + 0.05 * fbm(p * 5.0, 2);
    rgb(52, 66, 78) * worn * (1.0 - 0.35 * seam) * (1.0 - 0.30 * edge)
}

/// Ribs of the knit: radians per unit of width.
pub const RIBS: f64 = 24.0;

/// Height of the relief of the cloth: the hem is rolled, the rest is a fine knit, of which `knit` shows.
#[must_use]
pub fn height(p: DVec3, knit: f64) -> f64 {
    let below = below_neckline(p);
    let hem = 0.03 * smooth(HEM + 0.12, HEM - 0.08, below);
    let knit = 0.006 * knit * sin(p.x * RIBS) * smooth(HEM, HEM + 0.1, below);
    hem + knit
}
