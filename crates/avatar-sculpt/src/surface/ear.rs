//! The auricle: a path from the ear's root over the rim into its bowl, swept around.

use glam::{DVec2, DVec3};

use super::{
    ear_root::{EAR_AROUND, to_head},
    half::{Half, Node, Patch},
    rings::Loops,
};
use crate::math::{bell, cos, curve, lerp, sin, smooth};

const PI: f64 = std::f64::consts::PI;
/// Steps of the path between its knots.
const STEPS: usize = 3;

/// The rim in the ear's own plane, by the angle from the back over the top, in degrees: (angle, back, up). A
/// human ear with a soft point behind its top.
const RIM: [(f64, f64, f64); 18] = [
    (-15.0, 1.42, -0.60),
    (0.0, 1.64, 0.30),
    (28.0, 1.74, 1.50),
    (52.0, 1.62, 2.62),
    (72.0, 0.92, 2.98),
    (100.0, 0.02, 2.80),
    (130.0, -0.70, 2.22),
    (160.0, -1.02, 1.20),
    (180.0, -1.06, 0.35),
    (205.0, -1.02, -0.70),
    (230.0, -0.98, -1.80),
    (250.0, -0.84, -2.62),
    (270.0, -0.30, -3.06),
    (288.0, 0.30, -2.94),
    (306.0, 0.80, -2.34),
    (325.0, 1.14, -1.56),
    (345.0, 1.42, -0.60),
    (360.0, 1.64, 0.30),
];

/// The place on the rim at `beta` radians.
fn rim(beta: f64) -> DVec2 {
    let at = beta * 180.0 / PI;
    let of = |pick: fn(&(f64, f64, f64)) -> (f64, f64)| curve(&RIM.map(|knot| pick(&knot)), at);
    DVec2::new(of(|knot| (knot.0, knot.1)), of(|knot| (knot.0, knot.2)))
}

/// Knots of the path at `beta`: share of the way from the ear's middle to its rim, and height over the front
/// edge.
fn knots(beta: f64, root: DVec3, front_x: f64) -> Vec<DVec3> {
    let edge = rim(beta);
    let middle = DVec2::new(-0.18, -0.15);
    let back = 0.5 * (1.0 + cos(beta));
    let lobe = bell(beta - 4.75, 0.55);
    let front = bell(beta - PI, 0.75);
    let groove = (1.0 - lobe) * (1.0 - 0.9 * front);
    let lift = (0.12 + 1.05 * back + 0.40 * smooth(0.2, 1.0, sin(beta))) * (1.0 - 0.45 * lobe) - 0.25 * lobe;
    let tragus = bell(beta - 3.45, 0.30);
    let at = |share: f64, height: f64| {
        let own = middle + (edge - middle) * share;
        let head = to_head(own);
        DVec3::new(front_x + height, head.y, head.x)
    };
    let outer = at(0.96, lift - 0.36);
    let half_way = root.lerp(outer, 0.55) + DVec3::new(0.04, 0.0, 0.0);
    // A hollow where ear and head meet, instead of a fold.
    let hollow = root.lerp(outer, 0.20) + DVec3::new(0.07, 0.0, 0.0);
    vec![
        root,
        hollow,
        half_way,
        outer,
        at(1.04, lift - 0.10),
        at(0.97, lift + 0.10),
        at(0.87, lift + 0.04 + 0.22 * tragus),
        at(0.79 - 0.05 * tragus, lift - 0.36 * groove + 0.34 * tragus),
        at(0.62 - 0.12 * tragus, lift - 0.02 * groove - 0.04 * lobe + 0.30 * tragus),
        at(0.47, lerp(lift, 0.5, 0.62) - 0.08 * (1.0 - lobe) - 0.1 * tragus),
        at(0.28, -0.08 + 0.36 * back),
        at(0.11, -0.26 + 0.16 * back),
    ]
}

/// Adds the auricle inside the ear's loop.
pub fn add(half: &mut Half, loops: &Loops) {
    let front_x = half.nodes[loops.ear[EAR_AROUND / 2]].p.x;
    let paths: Vec<Vec<DVec3>> = loops
        .ear
        .iter()
        .enumerate()
        .map(|(i, &start)| {
            let beta = 2.0 * PI * i as f64 / EAR_AROUND as f64;
            knots(beta, half.nodes[start].p, front_x)
        })
        .collect();
    let spans = paths[0].len() - 1;
    let mut row = loops.ear.clone();
    for (i, &start) in row.iter().enumerate() {
        half.nodes[start].own = DVec2::new(0.0, i as f64 / EAR_AROUND as f64);
    }
    for k in 1..=(spans * STEPS) {
        let along = k as f64 / STEPS as f64;
        let mut next = Vec::with_capacity(EAR_AROUND);
        for (i, path) in paths.iter().enumerate() {
            let own = DVec2::new(along / (spans + 1) as f64, i as f64 / EAR_AROUND as f64);
            let node = Node { patch: Patch::Ear, own, ..Node::sheet(on_path(path, along)) };
            next.push(half.add(node));
        }
        half.stitch(&row, &next, true);
        row = next;
    }
    let middle = row.iter().fold(DVec3::ZERO, |m, &i| m + half.nodes[i].p) / row.len() as f64;
    let own = DVec2::new(1.0, 0.0);
    let pole = half.add(Node { patch: Patch::Ear, own, ..Node::sheet(middle) });
    half.stitch(&row, &vec![pole; EAR_AROUND], true);
}

/// A Catmull–Rom curve through the knots.
fn on_path(path: &[DVec3], along: f64) -> DVec3 {
    let last = path.len() - 1;
    let i = (along as usize).min(last - 1);
    let s = along - i as f64;
    let (p1, p2) = (path[i], path[i + 1]);
    let p0 = if i == 0 { p1 } else { path[i - 1] };
    let p3 = if i + 2 > last { p2 } else { path[i + 2] };
    let (s2, s3) = (s * s, s * s * s);
    0.5 * (2.0 * p1
        + (p2 - p0) * s
        + (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * s2
        + (3.0 * (p1 - p2) + p3 - p0) * s3)
}
