use glam::Vec3;
use lanes::{Simd, Work};
use std::fmt;

/// One offset per vertex of a mesh, stored in the smaller of two ways: all of them, or those of the moved
/// vertices with their indices. A vertex is moved where its offset is anything but `+0.0` in all coordinates,
/// so that nothing is lost to the bit.
#[derive(Clone, PartialEq)]
pub struct Offsets {
    store: Store,
}

#[derive(Clone, PartialEq)]
enum Store {
    /// One per vertex.
    Dense(Vec<Vec3>),
    /// Ascending indices below `len`, and one offset each.
    Sparse { len: usize, vertices: Vec<u32>, offsets: Vec<Vec3> },
}

/// Why pairs of vertices and offsets cannot become [`Offsets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum OffsetsError {
    /// A vertex that the mesh lacks.
    #[error("pair {pair}: expected a vertex below {vertices}, found {found}")]
    OutOfRange {
        /// Which of the pairs.
        pair: usize,
        /// Number of vertices.
        vertices: usize,
        /// The vertex.
        found: u32,
    },
    /// A vertex with two offsets.
    #[error("pair {pair}: expected each vertex once, found {vertex} again")]
    Repeated {
        /// The later of the two pairs.
        pair: usize,
        /// The vertex.
        vertex: u32,
    },
}

const OFFSET_BYTES: usize = size_of::<Vec3>();
const PAIR_BYTES: usize = size_of::<Vec3>() + size_of::<u32>();

fn is_moved(offset: Vec3) -> bool {
    // Without a branch per coordinate.
    offset.to_array().iter().fold(0, |bits, x| bits | x.to_bits()) != 0
}

/// Whether pairs take less room than one offset per vertex.
fn pairs_are_smaller(moved: usize, len: usize) -> bool {
    moved.saturating_mul(PAIR_BYTES) < len.saturating_mul(OFFSET_BYTES)
}

impl Offsets {
    /// Offsets of all vertices.
    pub fn from_dense(offsets: Vec<Vec3>) -> Self {
        let len = offsets.len();
        let moved = offsets.iter().filter(|offset| is_moved(**offset)).count();
        if !pairs_are_smaller(moved, len) || u32::try_from(len).is_err() {
            return Self { store: Store::Dense(offsets) };
        }
        let mut vertices = Vec::with_capacity(moved);
        let mut offsets = offsets;
        let mut vertex = 0;
        // In place: there is never a second array of offsets.
        offsets.retain(|offset| {
            let kept = is_moved(*offset);
            if kept {
                vertices.push(vertex);
            }
            vertex += 1;
            kept
        });
        offsets.shrink_to_fit();
        Self { store: Store::Sparse { len, vertices, offsets } }
    }

    /// Offsets of some vertices of a mesh of `len` vertices, in any order; all others rest.
    ///
    /// # Errors
    /// A vertex beyond the mesh, or one that comes twice.
    pub fn from_pairs(
        len: usize,
        pairs: impl IntoIterator<Item = (u32, Vec3)>,
    ) -> Result<Self, OffsetsError> {
        let mut pairs: Vec<(usize, u32, Vec3)> =
            pairs.into_iter().enumerate().map(|(pair, (vertex, offset))| (pair, vertex, offset)).collect();
        if let Some(&(pair, found, _)) = pairs.iter().find(|(_, vertex, _)| *vertex as usize >= len) {
            return Err(OffsetsError::OutOfRange { pair, vertices: len, found });
        }
        pairs.sort_by_key(|(_, vertex, _)| *vertex);
        if let Some(twice) = pairs.windows(2).find(|two| two[0].1 == two[1].1) {
            return Err(OffsetsError::Repeated { pair: twice[1].0, vertex: twice[1].1 });
        }
        pairs.retain(|(_, _, offset)| is_moved(*offset));
        if pairs_are_smaller(pairs.len(), len) {
            let (vertices, offsets) = pairs.iter().map(|(_, vertex, offset)| (*vertex, *offset)).unzip();
            return Ok(Self { store: Store::Sparse { len, vertices, offsets } });
        }
        // At most a third more room than the pairs themselves took, however long the mesh claims to be.
        let mut offsets = vec![Vec3::ZERO; len];
        pairs.iter().for_each(|(_, vertex, offset)| offsets[*vertex as usize] = *offset);
        Ok(Self { store: Store::Dense(offsets) })
    }

    /// Number of vertices of the mesh, moved or not.
    pub fn len(&self) -> usize {
        match &self.store {
            Store::Dense(offsets) => offsets.len(),
            Store::Sparse { len, .. } => *len,
        }
    }

    /// Whether they belong to a mesh without vertices.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether only moved vertices are stored.
    pub fn is_sparse(&self) -> bool {
        matches!(self.store, Store::Sparse { .. })
    }

    /// Number of vertices that are moved.
    pub fn moved_vertices(&self) -> usize {
        self.stored().iter().filter(|offset| is_moved(**offset)).count()
    }

    /// Bytes that the offsets and their indices take.
    pub fn memory_bytes(&self) -> usize {
        match &self.store {
            Store::Dense(offsets) => offsets.len() * OFFSET_BYTES,
            Store::Sparse { vertices, .. } => vertices.len() * PAIR_BYTES,
        }
    }

    /// The offset of a vertex; `None` beyond the mesh. A search among the moved vertices where only these are
    /// stored.
    pub fn get(&self, vertex: usize) -> Option<Vec3> {
        match &self.store {
            Store::Dense(offsets) => offsets.get(vertex).copied(),
            Store::Sparse { len, vertices, offsets } => (vertex < *len).then(|| {
                let found = vertices.binary_search_by(|other| (*other as usize).cmp(&vertex));
                found.ok().and_then(|at| offsets.get(at).copied()).unwrap_or_default()
            }),
        }
    }

    /// The moved vertices with their offsets, in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Vec3)> + '_ {
        let (dense, vertices, sparse) = match &self.store {
            Store::Dense(offsets) => (&offsets[..], &[][..], &[][..]),
            Store::Sparse { vertices, offsets, .. } => (&[][..], &vertices[..], &offsets[..]),
        };
        let moved = dense.iter().copied().enumerate().filter(|(_, offset)| is_moved(*offset));
        moved.chain(vertices.iter().zip(sparse).map(|(vertex, offset)| (*vertex as usize, *offset)))
    }

    /// The offsets of all vertices, one after the other.
    pub fn per_vertex(&self) -> impl Iterator<Item = Vec3> + '_ {
        let mut moved = self.iter().peekable();
        (0..self.len())
            .map(move |vertex| moved.next_if(|(next, _)| *next == vertex).map_or(Vec3::ZERO, |(_, d)| d))
    }

    /// Adds `weight · d` to each vertex's sum: for all vertices, or for the moved ones only where only these
    /// are stored. Vertices without a sum are left out.
    pub fn add_scaled(&self, weight: f32, sums: &mut [Vec3]) {
        match &self.store {
            Store::Dense(offsets) => {
                let (offsets, sums) = (bytemuck::cast_slice(offsets), bytemuck::cast_slice_mut(sums));
                lanes::run(AddScaled { weight, offsets, sums });
            }
            Store::Sparse { vertices, offsets, .. } => {
                for (&vertex, offset) in vertices.iter().zip(offsets) {
                    if let Some(sum) = sums.get_mut(vertex as usize) {
                        *sum += weight * *offset;
                    }
                }
            }
        }
    }

    /// The stored offsets, whether of all vertices or only of those that move.
    pub(crate) fn stored(&self) -> &[Vec3] {
        match &self.store {
            Store::Dense(offsets) | Store::Sparse { offsets, .. } => offsets,
        }
    }
}

/// Adds a product of each number to its sum.
struct AddScaled<'a> {
    weight: f32,
    offsets: &'a [f32],
    sums: &'a mut [f32],
}

impl Work for AddScaled<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (sum, offset) in self.sums.iter_mut().zip(self.offsets) {
            *sum += self.weight * offset;
        }
    }
}

impl Default for Offsets {
    fn default() -> Self {
        Self { store: Store::Dense(Vec::new()) }
    }
}

impl From<Vec<Vec3>> for Offsets {
    fn from(offsets: Vec<Vec3>) -> Self {
        Self::from_dense(offsets)
    }
}

impl FromIterator<Vec3> for Offsets {
    fn from_iter<I: IntoIterator<Item = Vec3>>(offsets: I) -> Self {
        Self::from_dense(offsets.into_iter().collect())
    }
}

impl fmt::Debug for Offsets {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {} vertices: ", self.moved_vertices(), self.len())?;
        f.debug_map().entries(self.iter()).finish()
    }
}
