//! The inside of the mouth: where the lips touch, behind them, and a closed bag around teeth and tongue.

use glam::{DVec2, DVec3};

use super::{
    half::{Half, Node, Patch},
    rings::{Loops, MOUTH_AROUND},
};
use crate::{
    anatomy::{MOUTH_HALF_WIDTH, MOUTH_Y},
    math::{cos, lerp, sin},
};

/// Rows behind the lips: depth behind the line between them, half opening, share of the mouth's width.
const BEHIND: [(f64, f64, f64); 6] = [
    (0.06, 0.012, 0.995),
    (0.18, 0.016, 0.985),
    (0.32, 0.020, 0.975),
    (0.45, 0.10, 0.97),
    (0.53, 0.40, 0.98),
    (0.57, 0.90, 1.00),
];

/// Rows of the bag: depth at the upper and at the lower end, height above and below the line, half width, and
/// how far the sides lie behind. The first row lies before the gums, and well behind the skin of the chin.
const BAG: [(f64, f64, f64, f64, f64, f64); 6] = [
    (3.80, 3.63, 1.45, 1.50, 2.60, 1.4),
    (2.3, 2.3, 1.95, 2.35, 3.15, 0.6),
    (1.0, 1.0, 2.15, 2.45, 3.40, 0.2),
    (-0.4, -0.4, 1.9, 2.15, 3.1, 0.0),
    (-1.6, -1.6, 1.4, 1.5, 2.2, 0.0),
    (-2.5, -2.5, 0.8, 0.8, 1.2, 0.0),
];

/// Adds the bag inside the line between the lips.
pub fn add(half: &mut Half, loops: &Loops) {
    let rows = BEHIND.len() + BAG.len();
    // The loop runs over the upper lip first; seen from the front the hole lies on its right.
    let mut row: Vec<usize> = loops.mouth.iter().rev().copied().collect();
    for (i, &start) in loops.mouth.iter().enumerate() {
        half.nodes[start].own = DVec2::new(0.0, i as f64 / (MOUTH_AROUND - 1) as f64);
    }
    for k in 1..=rows {
        let mut next = Vec::with_capacity(MOUTH_AROUND);
        for j in 0..MOUTH_AROUND {
            let i = MOUTH_AROUND - 1 - j;
            let start = half.nodes[loops.mouth[i]];
            let tau = std::f64::consts::PI * (0.5 - i as f64 / (MOUTH_AROUND - 1) as f64);
            let on_midline = i == 0 || i == MOUTH_AROUND - 1;
            let u = if on_midline { 0.0 } else { cos(tau) };
            let side = sin(tau);
            let p = if k <= BEHIND.len() {
                let (depth, open, share) = BEHIND[k - 1];
                // Toward the corner the lips come together again, behind as well as in front.
                let along = start.p.x / MOUTH_HALF_WIDTH;
                let height = open * side.signum() * side.abs().min(1.0) * (1.0 - along * along * along);
                // Thinner before the canines: a jaw that goes sideways moves the lips across there.
                let depth = depth * (1.0 - 0.8 * along * along * (1.0 - along * along));
                DVec3::new(start.p.x * share, start.p.y + height, start.p.z - depth)
            } else {
                let (above, below, up, down, width, back) = BAG[k - 1 - BEHIND.len()];
                let height = if side > 0.0 { up } else { down };
                let depth = lerp(above, below, (-side).max(0.0));
                DVec3::new(u * width, MOUTH_Y + height * side, depth - back * u * u)
            };
            let inside = k as f64 / (rows + 1) as f64;
            let own = DVec2::new(inside, i as f64 / (MOUTH_AROUND - 1) as f64);
            next.push(half.add(Node { p, patch: Patch::Mouth, lip: -inside, own, ..start }));
        }
        half.stitch(&row, &next, false);
        row = next;
    }
    let back = DVec3::new(0.0, MOUTH_Y, lerp(-2.5, -2.9, 1.0));
    let own = DVec2::new(1.0, 0.5);
    let pole = half.add(Node { patch: Patch::Mouth, lip: -1.0, own, ..Node::sheet(back) });
    half.stitch(&row, &vec![pole; MOUTH_AROUND], false);
}
