//! Delaunay triangulation of points in the plane (Bowyer and Watson, with points taken from left to right so
//! that finished triangles leave the search).

use glam::DVec2;

use crate::math::hash01;

#[derive(Clone, Copy)]
struct Open {
    corner: [usize; 3],
    centre: DVec2,
    radius2: f64,
}

/// Triangles (counter-clockwise) over `points`. Points that coincide are not allowed.
#[must_use]
pub fn triangulate(points: &[DVec2]) -> Vec<[usize; 3]> {
    let n = points.len();
    // Rows and rings put many points on one circle, where the answer is not unique; a nudge far below any
    // distance that matters decides, the same way every time.
    let mut at: Vec<DVec2> = points
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let nudge = 1e-6 * p.length().max(1e-3);
            let chance = |k: u64| nudge * (hash01(2 * i as u64 + k) - 0.5);
            *p + DVec2::new(chance(0), chance(1))
        })
        .collect();
    let far = 40.0 * points.iter().fold(1.0_f64, |m, p| m.max(p.x.abs()).max(p.y.abs()));
    at.extend([DVec2::new(-far, -0.7 * far), DVec2::new(far, -0.8 * far), DVec2::new(0.03 * far, far)]);

    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| at[a].x.total_cmp(&at[b].x).then(at[a].y.total_cmp(&at[b].y)));

    let mut open = vec![circle(&at, [n, n + 1, n + 2])];
    let mut done: Vec<[usize; 3]> = Vec::new();
    let mut rim: Vec<(usize, usize)> = Vec::new();
    for i in order {
        let p = at[i];
        rim.clear();
        let mut k = 0;
        while k < open.len() {
            let t = open[k];
            let dx = p.x - t.centre.x;
            if dx > 0.0 && dx * dx > t.radius2 {
                done.push(t.corner);
                open.swap_remove(k);
            } else if (p - t.centre).length_squared() < t.radius2 {
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    let edge = (t.corner[a], t.corner[b]);
                    match rim.iter().position(|&e| e == (edge.1, edge.0)) {
                        Some(twin) => drop(rim.swap_remove(twin)),
                        None => rim.push(edge),
                    }
                }
                open.swap_remove(k);
            } else {
                k += 1;
            }
        }
        for &(a, b) in &rim {
            open.push(circle(&at, [a, b, i]));
        }
    }
    done.extend(open.iter().map(|t| t.corner));
    done.retain(|t| t.iter().all(|&c| c < n));
    // The sweep's order depends on nothing but the points, yet rows sorted by corner read better in a diff.
    for t in &mut done {
        let lead = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
        t.rotate_left(lead);
    }
    done.sort_unstable();
    done
}

fn circle(at: &[DVec2], corner: [usize; 3]) -> Open {
    let (a, b, c) = (at[corner[0]], at[corner[1]], at[corner[2]]);
    let (u, v) = (b - a, c - a);
    let area2 = u.perp_dot(v);
    let (uu, vv) = (u.length_squared(), v.length_squared());
    let offset = DVec2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / (2.0 * area2);
    let corner = if area2 < 0.0 { [corner[0], corner[2], corner[1]] } else { corner };
    Open { corner, centre: a + offset, radius2: offset.length_squared() }
}
