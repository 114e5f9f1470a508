//! Which side of a surface a place is on: J. Bærentzen, H. Aanæs, "Signed Distance Computation Using the
//! Angle Weighted Pseudonormal", 2005. Normals for shading would not do: in creases they look along the
//! surface.

use avatar_mesh::{Mesh, weld_positions};
use glam::Vec3;

/// The outward direction on a triangle: inside of it, at its edges (each opposite of a corner), and at its
/// corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pseudonormals {
    face: Vec3,
    edges: [Vec3; 3],
    corners: [Vec3; 3],
}

impl Pseudonormals {
    /// The outward direction at the point with these weights of the corners; its length has no meaning.
    pub(crate) fn at(&self, weights: [f32; 3]) -> Vec3 {
        let zero = weights.map(|weight| weight == 0.0);
        match zero.iter().filter(|zero| **zero).count() {
            0 => self.face,
            1 => zero.iter().position(|zero| *zero).map_or(self.face, |i| self.edges[i]),
            _ => zero.iter().position(|zero| !*zero).map_or(self.face, |i| self.corners[i]),
        }
    }
}

/// The triangles whose corners exist and are numbers, each with its pseudonormals.
pub(crate) fn pseudonormals(skin: &Mesh) -> Vec<([u32; 3], Pseudonormals)> {
    let at = |i: u32| skin.positions.get(i as usize).copied().filter(|p| p.is_finite());
    let welded = weld_positions(&skin.positions, 0.0);
    let triangles: Vec<([u32; 3], [Vec3; 3])> = (skin.triangles.iter())
        .filter_map(|corners| {
            let [Some(a), Some(b), Some(c)] = corners.map(at) else { return None };
            Some((*corners, [a, b, c]))
        })
        .collect();
    let face = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).normalize_or_zero();
    // Each edge with the number of the corner opposite of it, three to a triangle.
    let mut edges: Vec<([u32; 2], usize)> = Vec::with_capacity(3 * triangles.len());
    let mut vertices = vec![Vec3::ZERO; skin.positions.len()];
    // Triangles of some files run clockwise seen from outside; the normals tell.
    let mut agreement = 0.0;
    for (corners, positions) in &triangles {
        let face = face(*positions);
        for i in 0..3 {
            let (next, last) = ((i + 1) % 3, (i + 2) % 3);
            edges.push((edge(&welded, corners[next], corners[last]), edges.len()));
            let (to_next, to_last) = (positions[next] - positions[i], positions[last] - positions[i]);
            let angle = to_next.cross(to_last).length().atan2(to_next.dot(to_last));
            vertices[welded[corners[i] as usize] as usize] += face * angle;
            agreement += skin.normals.get(corners[i] as usize).map_or(0.0, |n| n.dot(face).signum());
        }
    }
    edges.sort_unstable();
    let mut at_edges = vec![Vec3::ZERO; edges.len()];
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        let sum = same.iter().fold(Vec3::ZERO, |sum, (_, corner)| sum + face(triangles[corner / 3].1));
        same.iter().for_each(|(_, corner)| at_edges[*corner] = sum);
    }
    let side = if agreement < 0.0 { -1.0 } else { 1.0 };
    let of = |(number, (corners, positions)): (usize, ([u32; 3], [Vec3; 3]))| {
        let normals = Pseudonormals {
            face: face(positions) * side,
            edges: [0, 1, 2].map(|i| at_edges[3 * number + i] * side),
            corners: corners.map(|i| vertices[welded[i as usize] as usize] * side),
        };
        (corners, normals)
    };
    triangles.into_iter().enumerate().map(of).collect()
}

fn edge(welded: &[u32], a: u32, b: u32) -> [u32; 2] {
    let (a, b) = (welded[a as usize], welded[b as usize]);
    [a.min(b), a.max(b)]
}
