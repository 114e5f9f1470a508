//! Grooves that shapes bring in: how deep each is, whatever the face does. `arkit/wrinkles.toml` says which
//! shapes do so, and where.

use glam::{DVec2, DVec3};

use super::canvas::Site;
use crate::{
    math::{bell, cos, noise3, sin, smooth, to_segment},
    surface::half::Patch,
};

/// A groove: points of the left half, seen from the front, its width and its depth, 0…1.
struct Groove<'a> {
    line: &'a [[f64; 2]],
    width: f64,
    depth: f64,
    /// Whether it ends at its first point, rather than going on across the midline.
    ends: bool,
}

/// Between the brows, on the root of the nose, beside its bridge, under the eye, and from the wing of the
/// nose around the mouth.
const GROOVES: [Groove<'_>; 10] = [
    Groove { line: &[[0.40, 1.50], [0.48, 2.30], [0.74, 3.15]], width: 0.075, depth: 1.0, ends: true },
    Groove { line: &[[0.92, 1.85], [0.96, 2.30], [1.10, 2.75]], width: 0.055, depth: 0.5, ends: true },
    Groove { line: &[[0.0, 1.42], [0.4, 1.36], [0.85, 1.18]], width: 0.060, depth: 0.7, ends: false },
    Groove { line: &[[0.0, 0.98], [0.4, 0.93], [0.85, 0.78]], width: 0.065, depth: 0.9, ends: false },
    Groove { line: &[[0.42, 0.62], [0.92, 0.16], [1.30, -0.50]], width: 0.060, depth: 0.8, ends: true },
    Groove { line: &[[0.48, 0.14], [0.95, -0.34], [1.28, -1.00]], width: 0.060, depth: 0.8, ends: true },
    Groove { line: &[[0.55, -0.36], [0.98, -0.80], [1.26, -1.40]], width: 0.055, depth: 0.6, ends: true },
    Groove {
        line: &[[2.1, -0.92], [2.7, -1.19], [3.3, -1.28], [3.9, -1.21], [4.5, -0.98]],
        width: 0.075,
        depth: 0.5,
        ends: true,
    },
    Groove {
        line: &[[2.3, -1.36], [2.9, -1.63], [3.5, -1.72], [4.1, -1.63], [4.7, -1.36]],
        width: 0.085,
        depth: 0.3,
        ends: true,
    },
    Groove {
        line: &[[1.30, -2.50], [1.74, -3.25], [2.40, -4.30], [2.95, -5.20], [3.18, -6.10], [3.02, -6.90]],
        width: 0.13,
        depth: 1.0,
        ends: true,
    },
];

/// How deep the deepest groove is here: 0…1.
#[must_use]
pub fn depth(site: &Site) -> DVec3 {
    let p = site.p;
    if site.node.patch != Patch::Sheet || p.z < -1.5 || p.y < -7.5 || p.y > 7.2 {
        return DVec3::ZERO;
    }
    // No line of a face is straight.
    let wander = DVec2::new(noise3(p * 1.6), noise3(p * 1.6 + DVec3::splat(7.0))) * 0.05;
    let at = DVec2::new(p.x.abs(), p.y) + wander;
    let drawn = GROOVES.iter().map(|groove| depth_of(groove, at));
    DVec3::splat(drawn.fold(forehead(at).max(crows_feet(at)), f64::max).min(1.0))
}

/// Four lines over the brows, lower in the middle.
fn forehead(at: DVec2) -> f64 {
    let line = |k: i32| {
        let y = 3.55 + 0.80 * f64::from(k);
        let line =
            [[0.0, y - 0.04], [0.9, y], [2.0, y + 0.14], [3.2, y + 0.20], [4.5, y - 0.05], [5.6, y - 0.55]];
        depth_of(&Groove { line: &line, width: 0.085, depth: 0.75 - 0.07 * f64::from(k), ends: false }, at)
    };
    (0..4).map(line).fold(0.0, f64::max)
}

/// Rays from the outer corner of the eye, seen from the front where the face turns away.
fn crows_feet(at: DVec2) -> f64 {
    let ray = |(angle, reach): &(f64, f64)| {
        let along = |r: f64, turn: f64| [5.0 + 0.72 * r * cos(angle + turn), 0.42 + r * sin(angle + turn)];
        let line = [along(0.35, 0.0), along(0.5 * (0.35 + reach), 0.05), along(*reach, 0.12)];
        depth_of(&Groove { line: &line, width: 0.070, depth: 0.75, ends: true }, at)
    };
    [(0.66, 1.5), (0.24, 1.9), (-0.18, 1.9), (-0.60, 1.7)].iter().map(ray).fold(0.0, f64::max)
}

fn depth_of(groove: &Groove<'_>, at: DVec2) -> f64 {
    let segments = groove.line.len() as f64 - 1.0;
    let mut nearest = (f64::MAX, 0.0);
    for (number, pair) in groove.line.windows(2).enumerate() {
        let (off, share) = to_segment(at, DVec2::from(pair[0]), DVec2::from(pair[1]));
        if off < nearest.0 {
            nearest = (off, (number as f64 + share) / segments);
        }
    }
    let (off, along) = nearest;
    let begins = if groove.ends { smooth(0.0, 0.3, along) } else { 1.0 };
    groove.depth * begins * smooth(1.0, 0.65, along) * bell(off, groove.width)
}
