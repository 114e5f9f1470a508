//! Triangles of the topologies of glTF 2.0, section 3.7.2.1.

use gltf::json::mesh::Mode;

/// Triangles from the vertices' numbers in drawing order, and how many of these numbers are left over; `None`
/// for topologies of points and lines.
pub(super) fn of(mode: Mode, corners: &[u32]) -> Option<(Vec<[u32; 3]>, usize)> {
    let triangles = match mode {
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return None,
        Mode::Triangles => {
            let (triangles, rest) = corners.as_chunks::<3>();
            return Some((triangles.to_vec(), rest.len()));
        }
        // Every other triangle of a strip runs the other way round.
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            .map(|(i, v)| if i % 2 == 0 { [v[0], v[1], v[2]] } else { [v[0], v[2], v[1]] })
            .collect(),
        Mode::TriangleFan => match corners.split_first() {
            Some((&hub, rim)) => rim.windows(2).map(|v| [v[0], v[1], hub]).collect(),
            None => Vec::new(),
        },
    };
    let left_over = if corners.len() < 3 { corners.len() } else { 0 };
    Some((triangles, left_over))
}
