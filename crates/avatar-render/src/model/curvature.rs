//! The curvature of a surface at each vertex, which pre-integrated scattering needs.

use avatar_mesh::{Mesh, weld_positions};
use glam::Vec3;

/// Rounds of averaging with neighbours, so that the edges between triangles do not count as curvature.
const SMOOTHING_ROUNDS: usize = 3;

/// 1 / radius per vertex: how fast the normal turns along the edges around it, whichever way it bends.
pub(crate) fn curvatures(mesh: &Mesh) -> Vec<f32> {
    let welded = weld_positions(&mesh.positions, 0.0);
    let count = mesh.positions.len();
    let edges = || {
        mesh.triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]).filter_map(|(a, b)| {
            let (a, b) = (a as usize, b as usize);
            (a < count && b < count).then_some((a, b))
        })
    };
    let place = |vertex: usize| welded.get(vertex).copied().unwrap_or(0) as usize;
    let mut sums = vec![(0.0f32, 0.0f32); count];
    for (a, b) in edges() {
        let length = mesh.positions[a].distance(mesh.positions[b]);
        let turn = normal(mesh, a).distance(normal(mesh, b));
        if length > 0.0 {
            for vertex in [a, b] {
                let sum = &mut sums[place(vertex)];
                *sum = (sum.0 + turn, sum.1 + length);
            }
        }
    }
    let mut values: Vec<f32> =
        sums.iter().map(|(turn, length)| turn / length.max(f32::MIN_POSITIVE)).collect();
    for _ in 0..SMOOTHING_ROUNDS {
        let mut around = vec![(0.0f32, 0.0f32); count];
        for (a, b) in edges() {
            let (a, b) = (place(a), place(b));
            around[a] = (around[a].0 + values[b], around[a].1 + 1.0);
            around[b] = (around[b].0 + values[a], around[b].1 + 1.0);
        }
        for (value, (sum, n)) in values.iter_mut().zip(around) {
            if n > 0.0 {
                *value = 0.5 * (*value + sum / n);
            }
        }
    }
    (0..count).map(|vertex| values[place(vertex)]).map(|c| if c.is_finite() { c } else { 0.0 }).collect()
}

fn normal(mesh: &Mesh, vertex: usize) -> Vec3 {
    mesh.normals.get(vertex).copied().unwrap_or(Vec3::Z)
}
