//! Skinning of [`LANES`] vertices at once, with the bits of one by one.

use crate::Skinning;
use crate::turning::MIN_NORMAL_LENGTH;
use glam::{Affine3A, Vec3};
use lanes::{LANES, Lanes, Simd, Wide, Work, steps};

/// What moves a block of vertices.
type Bones = [[u16; 4]; LANES];
type Weights = [[f32; 4]; LANES];
/// Three numbers of each of [`LANES`] vertices.
type Columns = [Lanes; 3];

/// Moves positions and normals by up to four bones each, as the skinning one by one does, where all bones
/// turn evenly and exist. Arrays have one length. Blocks with a normal that is too short to have a direction
/// are left alone, as are the last vertices, of which there are fewer than [`LANES`]: `left` is called with
/// the first vertex of each and their number.
pub(crate) struct SkinLanes<'a, F> {
    pub(crate) skinning: &'a Skinning,
    pub(crate) bones: &'a [Affine3A],
    /// Positions and normals before the bones, where they are not in `positions` and `normals`.
    pub(crate) from: Option<(&'a [Vec3], &'a [Vec3])>,
    pub(crate) positions: &'a mut [Vec3],
    pub(crate) normals: &'a mut [Vec3],
    pub(crate) left: F,
}

impl<F: FnMut(&mut [Vec3], &mut [Vec3], usize)> Work for SkinLanes<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let (bones, _) = self.skinning.bones.as_chunks::<LANES>();
        let (weights, _) = self.skinning.weights.as_chunks::<LANES>();
        let (positions, last_positions) = self.positions.as_chunks_mut::<LANES>();
        let (normals, last_normals) = self.normals.as_chunks_mut::<LANES>();
        let from = self.from.map(|(from, along)| (from.as_chunks::<LANES>().0, along.as_chunks::<LANES>().0));
        let blocks = bones.len();
        let influences = bones.iter().zip(weights);
        for (block, ((positions, normals), (bones, weights))) in
            positions.iter_mut().zip(normals).zip(influences).enumerate()
        {
            let from = match from.and_then(|(from, along)| Some((from.get(block)?, along.get(block)?))) {
                Some((from, along)) => (columns(from), columns(along)),
                None => (columns(positions), columns(normals)),
            };
            if !skin_block(simd, self.bones, bones, weights, &from, positions, normals) {
                (self.left)(positions, normals, block * LANES);
            }
        }
        (self.left)(last_positions, last_normals, blocks * LANES);
    }
}

/// Whether it was done: not where a normal has no direction.
#[inline(always)]
fn skin_block<S: Simd>(
    simd: S,
    matrices: &[Affine3A],
    bones: &Bones,
    weights: &Weights,
    (from, along): &(Columns, Columns),
    positions: &mut [Vec3; LANES],
    normals: &mut [Vec3; LANES],
) -> bool {
    let mut sums = [[Lanes::splat(0.0); 3]; 2];
    // Bones as floats, which compare beside their weights.
    let (mut of_slots, mut of_weights) = ([Lanes::splat(0.0); 4], [Lanes::splat(0.0); 4]);
    for lane in 0..LANES {
        for slot in 0..4 {
            of_slots[slot][lane] = f32::from(bones[lane][slot]);
            of_weights[slot][lane] = weights[lane][slot];
        }
    }
    for (slot, (of_slot, all)) in of_slots.iter().zip(&of_weights).enumerate() {
        // The lanes with a weight whose bones are still to come.
        let mut left = ALL & !equal_bits(simd, all, 0.0);
        while left != 0 {
            let bone = of_slot[left.trailing_zeros() as usize];
            let Some(matrix) = matrices.get(bone as usize) else { return false };
            let same = equal_bits(simd, of_slot, bone);
            // Most blocks follow one bone wholly: no weights are needed.
            if slot == 0 && same == ALL && equal_bits(simd, all, 1.0) == ALL {
                add(simd, matrix, None, from, along, &mut sums);
                break;
            }
            left &= !same;
            let mut weights = Lanes::splat(0.0);
            let (bone, zero) = (Wide::splat(simd, bone), Wide::splat(simd, 0.0));
            for step in 0..steps::<S>() {
                let weight = Wide::load(simd, all, step);
                Wide::load(simd, of_slot, step).equal(bone, weight, zero).store(&mut weights, step);
            }
            add(simd, matrix, Some(&weights), from, along, &mut sums);
        }
    }
    let is_long = make_unit(simd, along, &mut sums[1]);
    if is_long {
        write(&sums[0], positions);
        write(&sums[1], normals);
    }
    is_long
}

/// A bit for each lane.
const ALL: u32 = (1 << LANES) - 1;

/// The lanes that hold a number, a bit each.
#[inline(always)]
fn equal_bits<S: Simd>(simd: S, lanes: &Lanes, number: f32) -> u32 {
    let mut bits = 0;
    for step in 0..steps::<S>() {
        let own = Wide::load(simd, lanes, step).equal_bits(Wide::splat(simd, number));
        bits |= own << (step * S::F32_LANES);
    }
    bits
}

/// Adds what a bone makes of positions and normals, times the weights; without weights, all are 1.
#[inline(always)]
fn add<S: Simd>(
    simd: S,
    matrix: &Affine3A,
    weights: Option<&Lanes>,
    from: &Columns,
    along: &Columns,
    sums: &mut [Columns; 2],
) {
    let m = matrix.to_cols_array();
    for row in 0..3 {
        let splat = [m[row], m[3 + row], m[6 + row], m[9 + row]];
        let numbers = [
            Wide::splat(simd, splat[0]),
            Wide::splat(simd, splat[1]),
            Wide::splat(simd, splat[2]),
            Wide::splat(simd, splat[3]),
        ];
        for step in 0..steps::<S>() {
            let moved = times(numbers, load(simd, from, step)) + numbers[3];
            let turned = times(numbers, load(simd, along, step));
            add_weighted(simd, weights, moved, &mut sums[0][row], step);
            add_weighted(simd, weights, turned, &mut sums[1][row], step);
        }
    }
}

/// A row of a matrix times vectors.
#[inline(always)]
fn times<S: Simd>(row: [Wide<S>; 4], vectors: [Wide<S>; 3]) -> Wide<S> {
    row[0] * vectors[0] + row[1] * vectors[1] + row[2] * vectors[2]
}

#[inline(always)]
fn load<S: Simd>(simd: S, columns: &Columns, step: usize) -> [Wide<S>; 3] {
    [
        Wide::load(simd, &columns[0], step),
        Wide::load(simd, &columns[1], step),
        Wide::load(simd, &columns[2], step),
    ]
}

#[inline(always)]
fn add_weighted<S: Simd>(simd: S, weights: Option<&Lanes>, moved: Wide<S>, sum: &mut Lanes, step: usize) {
    let before = Wide::load(simd, sum, step);
    let after = match weights {
        None => before + moved,
        Some(weights) => {
            let weight = Wide::load(simd, weights, step);
            // What is not moved must not become NaN by a matrix that is not finite.
            weight.equal(Wide::splat(simd, 0.0), before, before + weight * moved)
        }
    };
    after.store(sum, step);
}

/// Divides by the length. Returns whether all lengths, also those before the bones, say something.
#[inline(always)]
fn make_unit<S: Simd>(simd: S, along: &Columns, normals: &mut Columns) -> bool {
    // Of the length before the bones only the square: whoever comes after looks closer.
    let (mut squares, mut lengths) = (Lanes::splat(0.0), Lanes::splat(0.0));
    for step in 0..steps::<S>() {
        let [x, y, z] = load(simd, along, step);
        (x * x + y * y + z * z).store(&mut squares, step);
        let [x, y, z] = load(simd, normals, step);
        let length = (x * x + y * y + z * z).sqrt();
        length.store(&mut lengths, step);
        (x / length).store(&mut normals[0], step);
        (y / length).store(&mut normals[1], step);
        (z / length).store(&mut normals[2], step);
    }
    let mut is_short = false;
    for lane in 0..LANES {
        is_short |= squares[lane] < 2.0 * MIN_NORMAL_LENGTH * MIN_NORMAL_LENGTH;
        is_short |= lengths[lane] < MIN_NORMAL_LENGTH;
    }
    !is_short
}

#[inline(always)]
fn columns(vectors: &[Vec3; LANES]) -> Columns {
    let mut columns = [Lanes::splat(0.0); 3];
    for (lane, vector) in vectors.iter().enumerate() {
        columns[0][lane] = vector.x;
        columns[1][lane] = vector.y;
        columns[2][lane] = vector.z;
    }
    columns
}

#[inline(always)]
fn write(columns: &Columns, vectors: &mut [Vec3; LANES]) {
    for (lane, vector) in vectors.iter_mut().enumerate() {
        *vector = Vec3::new(columns[0][lane], columns[1][lane], columns[2][lane]);
    }
}
