//! Blend shapes of a part on the GPU. Offsets are stored only for those blocks of vertices in which a shape
//! moves something.

use crate::gpu::program::{Constant, Module, Value};
use crate::model::error::{PartProblem, fits};
use crate::model::weights::WORD;
use avatar_look::Wrinkle;
use avatar_mesh::{Mesh, Offsets, Shape};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Vertices per block. One workgroup deforms one block, so that all of it agrees on whether a shape moves the
/// block, and none of its invocations waits for another.
pub(crate) const SHAPE_BLOCK: u32 = 64;

/// The geometry of a part in WGSL.
pub(crate) const PART: Module = Module { text: include_str!("shaders/part.wgsl"), constants };

fn constants() -> Vec<Constant> {
    vec![("SHAPE_BLOCK", Value::Count(SHAPE_BLOCK)), ("MOST_WRINKLES", Value::Count(Wrinkle::MOST as u32))]
}

/// WGSL `ShapeOffset`; the arrays are three scalars each there.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct GpuShapeOffset {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
}

/// Offsets by blocks of vertices, then by shapes.
#[derive(Debug, Default)]
pub(crate) struct ShapeBlocks {
    /// Words of weights that the shapes follow: the first one, and how many.
    pub(crate) first_word: u32,
    pub(crate) word_count: u32,
    /// A row for each block of vertices: a bit for each place of wrinkles that reaches it; then of each word
    /// a bit for each shape that moves something there, and which block of `offsets` is the first of theirs.
    pub(crate) table: Vec<u32>,
    /// Blocks of offsets; those of the last block of vertices are filled up with zeros.
    pub(crate) offsets: Vec<GpuShapeOffset>,
}

impl ShapeBlocks {
    /// Stores what the shapes of a mesh move, the first of which follows the weight of this number, and where
    /// the skin can be wrinkled. Their lengths must be checked.
    ///
    /// # Errors
    /// More than `binding` bytes; this is checked before anything is allocated.
    pub(crate) fn new(
        mesh: &Mesh,
        first_weight: usize,
        wrinkles: &[Wrinkle],
        binding: u64,
    ) -> Result<Self, PartProblem> {
        // Shaders count in u32.
        let binding = binding.min(u32::MAX.into());
        let block = SHAPE_BLOCK as usize;
        let does_move = |shape: &Shape| moved(shape).next().is_some();
        let moving = mesh.shapes.iter().position(does_move).zip(mesh.shapes.iter().rposition(does_move));
        let (first_word, word_count) = moving.map_or((0, 0), |(first, last)| {
            let first_word = (first_weight + first) / WORD;
            (first_word, (first_weight + last) / WORD + 1 - first_word)
        });
        let row_len = 1 + 2 * word_count;
        let rows = match moving.is_some() || !wrinkles.is_empty() {
            true => mesh.positions.len().div_ceil(block),
            false => 0,
        };
        let slots = rows.saturating_mul(row_len);
        fits("shape blocks (what moves each block of vertices)", slots, size_of::<u32>(), binding)?;
        let mut table = vec![0; slots];
        let mut blocks = 0u32;
        // Where the word and the bit of a shape stand in a row.
        let place = |shape: usize| {
            let weight = first_weight + shape;
            (1 + 2 * (weight / WORD - first_word), 1u32 << (weight % WORD))
        };
        for (shape, own) in mesh.shapes.iter().enumerate() {
            for (vertex, _) in moved(own) {
                let (word, bit) = place(shape);
                let moving = &mut table[vertex / block * row_len + word];
                blocks += u32::from(*moving & bit == 0);
                *moving |= bit;
            }
        }
        let count = (blocks as usize).saturating_mul(block);
        fits("shape offsets (in blocks that shapes move)", count, size_of::<GpuShapeOffset>(), binding)?;
        let mut stored = 0;
        for (row, positions) in table.chunks_mut(row_len).zip(mesh.positions.chunks(block)) {
            row[0] = reaching(wrinkles, positions);
            for word in row[1..].chunks_mut(2) {
                word[1] = stored;
                stored += word[0].count_ones();
            }
        }
        let mut offsets = vec![GpuShapeOffset::zeroed(); count];
        for (shape, own) in mesh.shapes.iter().enumerate() {
            let stored = |vertex: usize| {
                let (word, bit) = place(shape);
                let row = &table[vertex / block * row_len..];
                let earlier = (row[word] & (bit - 1)).count_ones();
                (row[word + 1] + earlier) as usize * block + vertex % block
            };
            own.positions.iter().for_each(|(vertex, d)| offsets[stored(vertex)].position = d.to_array());
            normals(own).for_each(|(vertex, d)| offsets[stored(vertex)].normal = d.to_array());
        }
        Ok(Self { first_word: first_word as u32, word_count: word_count as u32, table, offsets })
    }
}

/// A bit for each place of wrinkles that reaches one of the points.
fn reaching(wrinkles: &[Wrinkle], points: &[Vec3]) -> u32 {
    let places = wrinkles.iter().take(Wrinkle::MOST).enumerate();
    let reached = places.filter(|(_, wrinkle)| points.iter().any(|point| wrinkle.reach(*point) > 0.0));
    reached.fold(0, |bits, (place, _)| bits | 1 << place)
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
        let shapes = vec![shape(130, &[]), shape(130, &[63, 129]), normals_only, shape(130, &[])];
        // The first weights of the two that move something are the last of a word and the first of the next.
        let found = ShapeBlocks::new(&mesh(130, shapes), 30, &[], LIMIT).expect("it fits");
        assert_eq!((found.first_word, found.word_count), (0, 2));
        let (last, first) = (1 << 31, 1);
        assert_eq!(found.table, [0, last, 0, first, 1, 0, 0, 2, 0, 2, 0, last, 2, 0, 3]);
        let moves: Vec<(usize, GpuShapeOffset)> = (found.offsets.iter().copied().enumerate())
            .filter(|(_, offset)| *offset != GpuShapeOffset::zeroed())
            .collect();
        let offset =
            |position: f32, normal: f32| GpuShapeOffset { position: [position; 3], normal: [normal; 3] };
        assert_eq!(moves, [(63, offset(64.0, 0.0)), (64, offset(0.0, 1.0)), (128 + 1, offset(130.0, 0.0))]);
        assert_eq!(found.offsets.len(), 3 * 64);
    }

    #[test]
    fn words_of_weights_before_the_first_shape_take_nothing() {
        let found = ShapeBlocks::new(&mesh(64, vec![shape(64, &[]), shape(64, &[3])]), 127, &[], LIMIT);
        let found = found.expect("it fits");
        assert_eq!((found.first_word, found.word_count), (4, 1));
        assert_eq!(found.table, [0, 1, 0]);
    }

    #[test]
    fn places_of_wrinkles_are_told_where_they_reach() {
        let mut mesh = mesh(130, Vec::new());
        mesh.positions[70] = Vec3::new(10.0, 0.0, 0.0);
        mesh.positions[128] = Vec3::new(0.0, 5.0, 0.0);
        let at = |x, y, radius| Wrinkle { center: Vec3::new(x, y, 0.0), radius, shapes: Vec::new() };
        let wrinkles = [at(10.5, 0.0, 1.0), at(0.0, 6.1, 1.0), at(0.0, 4.0, 2.0)];
        let found = ShapeBlocks::new(&mesh, 0, &wrinkles, LIMIT).expect("it fits");
        assert_eq!((found.word_count, found.table), (0, vec![0, 0b001, 0b100]));
    }

    #[test]
    fn shapes_that_move_nothing_take_nothing() {
        for mesh in [mesh(0, vec![Shape::default(); 3]), mesh(1000, vec![shape(1000, &[]); 300])] {
            let found = ShapeBlocks::new(&mesh, 0, &[], 0).expect("it fits");
            assert_eq!((found.word_count, found.table.len(), found.offsets.len()), (0, 0, 0));
        }
    }

    #[test]
    fn limits_hold_for_what_is_stored() {
        let of = |limit| ShapeBlocks::new(&mesh(6400, vec![shape(6400, &[5, 6]); 10]), 0, &[], limit);
        let (table, offsets) = (100 * 3 * 4, 10 * 64 * 24);
        assert_eq!(of(offsets).expect("it fits").offsets.len(), 640);
        let what = "shape offsets (in blocks that shapes move)";
        let limit = offsets - 1;
        assert_eq!(of(limit).err(), Some(PartProblem::TooLarge { what, count: 640, bytes: offsets, limit }));
        let what = "shape blocks (what moves each block of vertices)";
        let limit = table - 1;
        assert_eq!(of(limit).err(), Some(PartProblem::TooLarge { what, count: 300, bytes: table, limit }));
    }
}
