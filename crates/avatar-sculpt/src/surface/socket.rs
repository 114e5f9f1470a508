//! The edge of the lids, their inner side and the closed socket behind the eyeball.

use glam::{DVec2, DVec3};

use super::{
    half::{Half, Node, Patch},
    rings::Loops,
};
use crate::{
    anatomy::{EYE, EYEBALL_RADIUS, LID_INNER_RADIUS},
    lids,
    math::{atan2, cos, lerp, sin, smooth},
};

/// Rows of the edge, and of the inner side behind it.
const EDGE: usize = 3;
const INSIDE: usize = 10;

/// Which row a vertex of the edge or the inner side stands in: 1 next to the outer skin.
#[must_use]
pub fn row(node: &Node) -> usize {
    (-node.lid * (EDGE + INSIDE) as f64).round() as usize
}

/// Adds edge, inner side and socket inside the eye's loop.
pub fn add(half: &mut Half, loops: &Loops) {
    let mut row = loops.eye.clone();
    let count = row.len();
    let total = (EDGE + INSIDE) as f64;
    for (i, &start) in loops.eye.iter().enumerate() {
        half.nodes[start].own = DVec2::new(0.0, i as f64 / count as f64);
    }
    for k in 1..=(EDGE + INSIDE) {
        let mut next = Vec::with_capacity(count);
        for (i, &start) in loops.eye.iter().enumerate() {
            let outer = half.nodes[start];
            let rel = outer.p - EYE;
            let from_axis = rel.x.hypot(rel.y);
            let opening = atan2(from_axis, rel.z);
            let turn = atan2(rel.y, rel.x);
            let p = if k <= EDGE {
                let f = k as f64 / EDGE as f64;
                let direction = rel.normalize_or_zero();
                // The edge bulges a trace into the opening, like a real lid's rim.
                let bulge = sin(std::f64::consts::PI * f);
                // At the inner corner flesh fills the angle between the lids: the caruncle.
                let flesh =
                    0.06 * smooth(0.09, 0.02, lids::along(rel)) * sin(0.75 * std::f64::consts::PI * f);
                let narrowed = polar(opening - 0.02 * bulge - flesh, turn);
                let radius = lerp(rel.length(), inner_radius(direction, outer.lower), f);
                EYE + narrowed * radius
            } else {
                let f = (k - EDGE) as f64 / (INSIDE + 1) as f64;
                let spread = lerp(opening, std::f64::consts::PI, 0.45 * f + 0.55 * f * f);
                let direction = polar(spread, turn);
                // Past the edge nothing shows: the inner side may stay close to the eye, and must stay under
                // the skin.
                let edge = inner_radius(rel.normalize_or_zero(), outer.lower);
                EYE + direction * lerp(edge, EYEBALL_RADIUS + 0.03, smooth(0.0, 0.2, f))
            };
            let own = DVec2::new(k as f64 / (total + 1.0), i as f64 / count as f64);
            let lid = -(k as f64) / total;
            next.push(half.add(Node { p, patch: Patch::Socket, lid, own, ..outer }));
        }
        half.stitch(&row, &next, true);
        row = next;
    }
    let back = EYE - DVec3::Z * (EYEBALL_RADIUS + 0.03);
    let own = DVec2::new(1.0, 0.0);
    let pole = half.add(Node { patch: Patch::Socket, lid: -1.0, own, ..Node::sheet(back) });
    half.stitch(&row, &vec![pole; count], true);
}

fn polar(opening: f64, turn: f64) -> DVec3 {
    DVec3::new(sin(opening) * cos(turn), sin(opening) * sin(turn), cos(opening))
}

/// Radius along a direction that still clears the eye when the lid has turned all the way.
fn inner_radius(direction: DVec3, lower: bool) -> f64 {
    let at = EYE + direction * LID_INNER_RADIUS;
    let angle = if lower { lids::LOWER_CLOSE } else { lids::UPPER_CLOSE };
    let s = lids::shrink(lids::weight(at, lower), angle);
    let across = direction.y.hypot(direction.z) * s;
    LID_INNER_RADIUS / direction.x.hypot(across)
}
