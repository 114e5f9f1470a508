//! The outer skin as triangles: rings and scattered vertices, relaxed and joined.

use glam::{DVec2, DVec3};

use super::{
    chart, delaunay,
    half::{Half, Patch},
    rings::{self, Loops},
    scatter,
};

/// Builds the outer skin of the left half.
#[must_use]
pub fn build() -> (Half, Loops) {
    let mut half = Half::default();
    let mut loops = Loops::default();
    rings::eye(&mut half, &mut loops);
    rings::mouth(&mut half, &mut loops);
    rings::ear(&mut half, &mut loops);
    rings::edge(&mut half, &mut loops);
    rings::neckline(&mut half);
    rings::crown(&mut half);
    let free = scatter::fill(&mut half, &loops);
    for _ in 0..5 {
        let triangles = triangles(&half, &loops);
        relax(&mut half, &triangles, &free);
    }
    half.triangles = triangles(&half, &loops);
    rings::stitch(&mut half, &loops);
    (half, loops)
}

/// Triangles between all vertices, without the holes.
fn triangles(half: &Half, loops: &Loops) -> Vec<[usize; 3]> {
    let count = half.nodes.len();
    let flat: Vec<DVec2> = half.nodes.iter().map(|n| chart::flat(n.place)).collect();
    // Rings are joined row by row; only their last row takes part here.
    let inner = |rings: &[Vec<usize>]| rings.iter().rev().skip(1).flatten().copied().collect::<Vec<_>>();
    let mut taken = vec![true; count];
    for i in inner(&loops.eye_rings).into_iter().chain(inner(&loops.mouth_rings)) {
        taken[i] = false;
    }
    let numbers: Vec<usize> = (0..count).filter(|&i| taken[i]).collect();
    // Mirrored twins next to the midline make it a line of the mesh; without them thin triangles could span
    // it.
    let mut points: Vec<DVec2> = numbers.iter().map(|&i| flat[i]).collect();
    let twins: Vec<DVec2> = points.iter().filter(|p| p.x > 0.0).map(|p| DVec2::new(-p.x, p.y)).collect();
    points.extend(twins);
    let last = |rings: &[Vec<usize>]| rings.last().cloned().unwrap_or_default();
    let (eye, mouth) = (last(&loops.eye_rings), last(&loops.mouth_rings));
    let holes: [&[usize]; 4] = [&eye, &mouth, &loops.ear, &loops.edge];
    let mut hole = vec![usize::MAX; count];
    for (h, row) in holes.iter().enumerate() {
        for &i in *row {
            hole[i] = h;
        }
    }
    let in_hole = |t: &[usize; 3]| {
        let h = hole[t[0]];
        h != usize::MAX && t.iter().all(|&i| hole[i] == h)
    };
    let on_midline = |t: &[usize; 3]| t.iter().all(|&i| flat[i].x == 0.0);
    let mut found = delaunay::triangulate(&points);
    found.retain(|t| t.iter().all(|&i| i < numbers.len()));
    for t in &mut found {
        *t = t.map(|i| numbers[i]);
    }
    found.retain(|t| !in_hole(t) && !on_midline(t));
    // The flat chart looks at the head from above: its counter-clockwise is the outside's.
    found
}

/// Moves free vertices toward the middle of their neighbours, back onto the skin.
fn relax(half: &mut Half, triangles: &[[usize; 3]], free: &[usize]) {
    let mut sum = vec![(DVec3::ZERO, 0.0); half.nodes.len()];
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            let (pa, pb) = (half.nodes[a].p, half.nodes[b].p);
            sum[a] = (sum[a].0 + pb, sum[a].1 + 1.0);
            sum[b] = (sum[b].0 + pa, sum[b].1 + 1.0);
        }
    }
    for &i in free {
        let (total, count) = sum[i];
        if count > 0.0 && half.nodes[i].patch == Patch::Sheet {
            let target = half.nodes[i].p.lerp(total / count, 0.7);
            let place = chart::place_of(target);
            half.nodes[i].p = chart::point(place);
            half.nodes[i].place = place;
        }
    }
}
