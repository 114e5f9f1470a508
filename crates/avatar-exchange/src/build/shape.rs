use avatar_mesh::{Offsets, Shape};
use glam::Vec3;

/// Bytes that [`shape`] takes for each vertex at most.
pub(crate) const SHAPE_BYTES_PER_VERTEX: usize = 2 * size_of::<Vec3>();

/// A shape from dense offsets, one for each of `vertices` vertices; shapes without offsets do not move.
pub(crate) fn shape(
    name: String,
    vertices: usize,
    positions: Option<Vec<Vec3>>,
    normals: Option<Vec<Vec3>>,
) -> Shape {
    let still = || Offsets::from_pairs(vertices, []).unwrap_or_default();
    let mut shape = Shape::new(name, positions.map_or_else(still, Offsets::from_dense));
    shape.normals = normals.map(Offsets::from_dense);
    shape
}
