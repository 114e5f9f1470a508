//! Lashes: thin curved spikes on the edges of the lids, open only where they stand in the skin.

use glam::{DVec2, DVec3};

use super::{
    half::{Half, Node, Patch},
    rings::{self, EYE_AROUND, Loops},
};
use crate::{
    anatomy::EYE,
    math::{cos, curve, hash01, lerp, sin},
};

const PI: f64 = std::f64::consts::PI;
/// Corners of a lash's cross-section.
const SIDES: usize = 4;
/// Cross-sections from the root upward; the tip is a point.
const RINGS: usize = 3;
/// Cells along one side of the square of the picture that all lashes of an eye share.
const CELLS: usize = 9;

/// The lashes of one lid.
struct Row {
    count: usize,
    /// From where to where they stand between the inner (0) and the outer corner (1).
    from: f64,
    to: f64,
    /// Length along that way.
    length: &'static [(f64, f64)],
    /// Half the width of a lash at its root.
    radius: f64,
    /// How far they rise per unit that they lead forward, at their roots and at their tips.
    rise: (f64, f64),
    lower: bool,
}

const UPPER: Row = Row {
    count: 48,
    from: 0.10,
    to: 0.985,
    length: &[(0.0, 0.28), (0.3, 0.56), (0.7, 0.82), (0.92, 0.80), (1.0, 0.58)],
    radius: 0.021,
    rise: (0.05, 1.45),
    lower: false,
};
const LOWER: Row = Row {
    count: 30,
    from: 0.24,
    to: 0.96,
    length: &[(0.2, 0.24), (0.6, 0.38), (0.9, 0.44), (1.0, 0.32)],
    radius: 0.014,
    rise: (-0.45, -1.0),
    lower: true,
};

/// Adds the lashes of the left eye.
pub fn add(half: &mut Half, loops: &Loops) {
    let mut cell = 0;
    for row in [UPPER, LOWER] {
        for k in 0..row.count {
            let chance = |n: u64| hash01((cell as u64) * 8 + n);
            let even = (k as f64 + 0.5 + 0.5 * (chance(0) - 0.5)) / row.count as f64;
            let s = lerp(row.from, row.to, even);
            lash(half, loops, &row, s, cell);
            cell += 1;
        }
    }
}

/// One lash at `s` between the corners of the eye.
fn lash(half: &mut Half, loops: &Loops, row: &Row, s: f64, cell: usize) {
    let chance = |n: u64| hash01((cell as u64) * 8 + n) - 0.5;
    // The edge's vertices stand at these turns, along the lower lid first.
    let around = rings::at_lids(s);
    let around = if row.lower { around } else { EYE_AROUND as f64 - around };
    let near = (around as usize).min(EYE_AROUND - 1);
    let (a, b) = (loops.eye[near], loops.eye[(near + 1) % EYE_AROUND]);
    let root = half.nodes[a].p.lerp(half.nodes[b].p, around.fract());
    let follows = if around.fract() < 0.5 { a } else { b };

    let outward = (root - EYE).normalize_or_zero();
    let forward = (outward + DVec3::Z * 0.7).normalize_or_zero();
    let fan = DVec3::X * (1.15 * (s - 0.46) + 0.30 * chance(1));
    let length = curve(row.length, s) * (1.0 + 0.35 * chance(2));
    let tip = (1.0 + 0.25 * chance(3)) * row.rise.1;
    let direction = |t: f64| (forward + fan * t + DVec3::Y * lerp(row.rise.0, tip, t)).normalize_or_zero();

    // From a trace inside the skin.
    let mut at = root - outward * 0.03;
    let mut last: Vec<usize> = Vec::new();
    for ring in 0..=RINGS {
        let t = ring as f64 / RINGS as f64;
        let along = direction(t);
        let across = along.cross(DVec3::Y).normalize_or_zero();
        let up = across.cross(along);
        let radius = row.radius * (1.0 - t);
        let corners = if ring == RINGS { 1 } else { SIDES };
        let mut next = Vec::with_capacity(corners);
        for corner in 0..corners {
            let turn = 2.0 * PI * corner as f64 / SIDES as f64;
            let (c, s) = (cos(turn), sin(turn));
            let p = at + (across * c + up * s) * radius;
            let own = in_picture(cell, DVec2::new(-c, s) * (1.0 - t));
            let node =
                Node { patch: Patch::Lash, own, lower: row.lower, follows: Some(follows), ..Node::sheet(p) };
            next.push(half.add(node));
        }
        for k in 0..last.len() {
            let (p, q) = (last[k], last[(k + 1) % last.len()]);
            if corners == 1 {
                half.triangles.push([p, q, next[0]]);
            } else {
                let (r, s) = (next[k], next[(k + 1) % SIDES]);
                half.triangles.extend([[p, q, s], [p, s, r]]);
            }
        }
        last = next;
        let step = length / RINGS as f64;
        at += direction(t + 0.5 / RINGS as f64) * step;
    }
}

/// A place in a lash's own cell of the picture: its tip in the middle, its root around it.
fn in_picture(cell: usize, from_middle: DVec2) -> DVec2 {
    let corner = DVec2::new((cell % CELLS) as f64, (cell / CELLS) as f64);
    (corner + DVec2::splat(0.5) + from_middle * 0.45) / CELLS as f64
}
