//! Blend shapes of a part on the GPU. Offsets are stored only for those blocks of vertices in which a shape
//! moves something.

use crate::gpu::program::{Constant, Module, Value};
use crate::model::error::{PartProblem, fits};
use avatar_look::Wrinkle;
use avatar_mesh::{Mesh, Offsets, Shape};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Vertices per block. One workgroup deforms one block, so that all of it agrees on whether a shape moves the
/// block, and none of its invocations waits for another.
pub(crate) const SHAPE_BLOCK: u32 = 64;

/// Entry of the table for a block in which the shape moves nothing.
pub(crate) const RESTING_BLOCK: u32 = u32::MAX;

/// The geometry of a part in WGSL.
pub(crate) const PART: Module = Module { text: include_str!("shaders/part.wgsl"), constants };

fn constants() -> Vec<Constant> {
    vec![
        ("SHAPE_BLOCK", Value::Count(SHAPE_BLOCK)),
        ("RESTING_BLOCK", Value::Count(RESTING_BLOCK)),
        ("MOST_WRINKLES", Value::Count(Wrinkle::MOST as u32)),
    ]
}

/// WGSL `ShapeOffset`; the arrays are three scalars each there.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct GpuShapeOffset {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
}

/// Offsets by blocks.
#[derive(Debug, Default)]
pub(crate) struct ShapeBlocks {
    /// Rows of the table: the shapes up to the last one that moves anything.
    pub(crate) shape_count: u32,
    /// By shape, then by block of vertices: which block of `offsets`, or [`RESTING_BLOCK`].
    pub(crate) table: Vec<u32>,
    /// Blocks of offsets; the last block of vertices is filled up with zeros.
    pub(crate) offsets: Vec<GpuShapeOffset>,
}

impl ShapeBlocks {
    /// Stores what the shapes of a mesh move. Their lengths must be checked.
    ///
    /// # Errors
    /// More than `binding` bytes; this is checked before anything is allocated.
    pub(crate) fn new(mesh: &Mesh, binding: u64) -> Result<Self, PartProblem> {
        // Shaders count in u32.
        let binding = binding.min(u32::MAX.into());
        let block = SHAPE_BLOCK as usize;
        let shape_count = mesh.shapes.iter().rposition(|shape| moved(shape).next().is_some());
        let shapes = &mesh.shapes[..shape_count.map_or(0, |last| last + 1)];
        let blocks = mesh.positions.len().div_ceil(block);
        let slots = shapes.len().saturating_mul(blocks);
        fits("shape blocks (blocks of vertices times shapes)", slots, size_of::<u32>(), binding)?;
        let mut table = vec![RESTING_BLOCK; slots];
        let mut stored = 0;
        // Without vertices there is no row, but chunks of 0 are not allowed either.
        for (shape, row) in shapes.iter().zip(table.chunks_mut(blocks.max(1))) {
            moved(shape).for_each(|(vertex, _)| row[vertex / block] = 0);
            for slot in row.iter_mut().filter(|slot| **slot != RESTING_BLOCK) {
                *slot = stored;
                stored += 1;
            }
        }
        let count = (stored as usize).saturating_mul(block);
        fits("shape offsets (in blocks that shapes move)", count, size_of::<GpuShapeOffset>(), binding)?;
        let mut offsets = vec![GpuShapeOffset::zeroed(); count];
        for (shape, row) in shapes.iter().zip(table.chunks(blocks.max(1))) {
            let place = |vertex: usize| row[vertex / block] as usize * block + vertex % block;
            shape.positions.iter().for_each(|(vertex, d)| offsets[place(vertex)].position = d.to_array());
            normals(shape).for_each(|(vertex, d)| offsets[place(vertex)].normal = d.to_array());
        }
        Ok(Self { shape_count: shapes.len() as u32, table, offsets })
    }
}

/// Offsets of normals, if the shape has any; if not, its blocks hold zeros.
fn normals(shape: &Shape) -> impl Iterator<Item = (usize, Vec3)> {
    shape.normals.iter().flat_map(Offsets::iter)
}

/// Vertices whose position or normal the shape changes; those with both come twice.
fn moved(shape: &Shape) -> impl Iterator<Item = (usize, Vec3)> {
    shape.positions.iter().chain(normals(shape))
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "tests stop at the first surprise")]
mod tests {
    use super::*;

    const LIMIT: u64 = 128 << 20;

    fn shape(vertices: usize, moved: &[usize]) -> Shape {
        let pairs = moved.iter().map(|vertex| (*vertex as u32, Vec3::splat(*vertex as f32 + 1.0)));
        Shape::from_pairs("shape", vertices, pairs).expect("vertices of the mesh, each once")
    }

    fn mesh(vertices: usize, shapes: Vec<Shape>) -> Mesh {
        Mesh { positions: vec![Vec3::ZERO; vertices], shapes, ..Mesh::default() }
    }

    #[test]
    fn only_blocks_in_which_something_moves_are_stored() {
        let mut normals_only = shape(130, &[]);
        normals_only.normals = Some(shape(130, &[0]).positions);
        let shapes = vec![shape(130, &[63, 129]), shape(130, &[]), normals_only, shape(130, &[])];
        let found = ShapeBlocks::new(&mesh(130, shapes), LIMIT).expect("it fits");
        let rest = RESTING_BLOCK;
        assert_eq!(found.shape_count, 3, "the last shape moves nothing");
        assert_eq!(found.table, [0, rest, 1, rest, rest, rest, 2, rest, rest]);
        let moves: Vec<(usize, GpuShapeOffset)> = (found.offsets.iter().copied().enumerate())
            .filter(|(_, offset)| *offset != GpuShapeOffset::zeroed())
            .collect();
        let offset =
            |position: f32, normal: f32| GpuShapeOffset { position: [position; 3], normal: [normal; 3] };
        assert_eq!(moves, [(63, offset(64.0, 0.0)), (64 + 1, offset(130.0, 0.0)), (128, offset(0.0, 1.0))]);
        assert_eq!(found.offsets.len(), 3 * 64);
    }

    #[test]
    fn shapes_that_move_nothing_take_nothing() {
        for mesh in [mesh(0, vec![Shape::default(); 3]), mesh(1000, vec![shape(1000, &[]); 300])] {
            let found = ShapeBlocks::new(&mesh, 0).expect("it fits");
            assert_eq!((found.shape_count, found.table.len(), found.offsets.len()), (0, 0, 0));
        }
    }

    #[test]
    fn limits_hold_for_what_is_stored() {
        let of = |limit| ShapeBlocks::new(&mesh(6400, vec![shape(6400, &[5, 6]); 10]), limit);
        let (table, offsets) = (10 * 100 * 4, 10 * 64 * 24);
        assert_eq!(of(offsets).expect("it fits").offsets.len(), 640);
        let what = "shape offsets (in blocks that shapes move)";
        let limit = offsets - 1;
        assert_eq!(of(limit).err(), Some(PartProblem::TooLarge { what, count: 640, bytes: offsets, limit }));
        let what = "shape blocks (blocks of vertices times shapes)";
        let limit = table - 1;
        assert_eq!(of(limit).err(), Some(PartProblem::TooLarge { what, count: 1000, bytes: table, limit }));
    }
}
