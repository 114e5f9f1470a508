//! Sharp folds: where one normal cannot serve all triangles of a vertex, the vertex is split.
//!
//! Lips that touch and the root of an ear fold the skin by more than a right angle. An averaged normal there
//! points along neither side and shades both wrongly.

use glam::DVec3;

use crate::{mesh, surface::half::Half};

/// Cosine of the largest angle between a triangle and a normal that it uses.
const LIMIT: f64 = 0.57;

/// Splits vertices until every triangle agrees with its normals. `normal` gives the normals to start from;
/// the result names, for every vertex, whether it was split off.
pub fn split(half: &mut Half, normal: &[DVec3]) -> Vec<bool> {
    let mut normals = normal.to_vec();
    let mut split_off = vec![false; half.nodes.len()];
    // Two rounds: first all strangers of a vertex share one new vertex; who disagrees with that gets its own.
    for round in 0..2 {
        let mut shared: Vec<Option<usize>> = vec![None; half.nodes.len()];
        for k in 0..half.triangles.len() {
            let t = half.triangles[k];
            let p = t.map(|i| half.nodes[i].p);
            let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
            for (corner, &i) in t.iter().enumerate() {
                if face.dot(normals[i]) >= LIMIT {
                    continue;
                }
                let twin = match shared[i] {
                    Some(twin) if round == 0 => twin,
                    _ => half.add(half.nodes[i]),
                };
                shared[i] = Some(twin);
                half.triangles[k][corner] = twin;
            }
        }
        split_off.resize(half.nodes.len(), true);
        let places: Vec<DVec3> = half.nodes.iter().map(|n| n.p).collect();
        let fresh = mesh::normals(&places, &half.triangles);
        let known = normals.len();
        normals.extend_from_slice(&fresh[known..]);
    }
    split_off
}
