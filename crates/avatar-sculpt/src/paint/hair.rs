//! Where hair grows: the scalp with its hairline, and the brows.

use glam::DVec3;

use super::canvas::Site;
use crate::{
    anatomy::{EYE, brow},
    lids,
    math::{atan2, curve, fbm, hash01, lerp, smooth},
    surface::half::Patch,
};

/// Turn from straight ahead → height of the hairline.
const HAIRLINE: [(f64, f64); 13] = [
    (0.0, 6.75),
    (0.35, 6.95),
    (0.65, 6.3),
    (0.9, 5.1),
    (1.08, 3.9),
    (1.22, 2.2),
    (1.36, 0.9),
    (1.5, 1.0),
    (1.75, 1.25),
    (1.95, -1.6),
    (2.2, -4.7),
    (2.6, -6.3),
    (3.15, -7.8),
];

/// Density of the hair on the scalp, 0…1.
#[must_use]
pub fn scalp(site: &Site) -> f64 {
    if site.node.patch != Patch::Sheet {
        return 0.0;
    }
    let p = site.p;
    let turn = atan2(p.x.abs(), p.z + 4.5);
    let wander = 0.28 * fbm(p * 1.7, 3);
    let over = p.y + wander - curve(&HAIRLINE, turn);
    // At the nape the hair thins out over a longer way than at the forehead.
    let nape = smooth(1.9, 2.4, turn);
    smooth(lerp(-0.45, -1.1, nape), lerp(1.0, 1.7, nape), over)
}

/// Density of a brow, 0…1, drawn as single strokes when `strokes` is set.
#[must_use]
pub fn brows(p: DVec3, strokes: bool) -> f64 {
    let x = p.x.abs();
    if !(1.0..6.2).contains(&x) || p.z < -0.5 || (p.y - 2.4).abs() > 1.2 {
        return 0.0;
    }
    let s = (x - 1.25) / 4.5;
    let (middle, half) = brow(s.clamp(0.0, 1.0));
    let off = (p.y - middle.y) / half;
    let ends = smooth(-0.06, 0.22, s) * smooth(1.02, 0.85, s);
    let body = ends * smooth(1.25, 0.35, off.abs());
    if !strokes || body <= 0.0 {
        return body;
    }
    // Hairs lean outward: steep at the inner end, nearly along the brow at the tail. Those of the upper half
    // lean less, so that both cross along the middle.
    let steep = smooth(0.0, 0.6, s);
    let lower = stroke(p, x - lerp(0.35, 2.2, steep) * (p.y - middle.y), off + 0.35, 0);
    let upper = stroke(p, x - lerp(0.75, 3.0, steep) * (p.y - middle.y), off - 0.25, 1);
    (body * lerp(0.34, 1.0, lower.max(upper))).min(1.0)
}

/// One of many hairs side by side: `across` runs over them, `along` is 0 at the middle of each and ±1 near
/// its ends.
fn stroke(p: DVec3, across: f64, along: f64, layer: u64) -> f64 {
    const PER_UNIT: f64 = 19.0;
    let at = across * PER_UNIT + 900.0;
    let chance = |k: u64| hash01(((at as u64) * 4 + k) * 4 + layer * 2 + u64::from(p.x > 0.0));
    let within = at.fract() - 0.5 + 0.3 * (chance(0) - 0.5);
    let end = along - 0.5 * (chance(1) - 0.5);
    smooth(0.46, 0.08, within.abs() + 0.14 * end.max(0.0))
        * smooth(1.15, 0.7, end.abs())
        * lerp(0.6, 1.0, chance(2))
}

/// Density of the lashes: a thin line on the outer edge of the lids, stronger above and toward the outer
/// corner.
fn lashes(site: &Site) -> f64 {
    let node = &site.node;
    if node.patch != Patch::Sheet || node.lid > 0.05 {
        return 0.0;
    }
    let s = lids::along(node.p - EYE);
    let strength = if node.lower { 0.10 } else { 0.30 };
    strength * smooth(0.05, 0.02, node.lid) * smooth(0.12, 0.5, s) * smooth(1.03, 0.97, s)
}

/// The density picture's colour.
#[must_use]
pub fn density_colour(site: &Site) -> DVec3 {
    let brow = if site.node.patch == Patch::Sheet { 0.4 * brows(site.p, false) } else { 0.0 };
    DVec3::splat(scalp(site).max(brow).max(lashes(site)))
}
