//! The raw format of further shapes: only the vertices that a shape moves, little-endian.
//!
//! ```text
//!  shape of a mesh   count u32, then `count` records of 28 bytes, by ascending vertex
//!  record            vertex u32, position offset 3 × f32, normal offset 3 × f32
//! ```
//!
//! Shapes follow each other without gaps. How many there are and which mesh each belongs to stands elsewhere.

use crate::{Offsets, OffsetsError, Shape};
use glam::Vec3;

/// Bytes of the number of records in front of each shape.
pub const COUNT_BYTES: usize = 4;
/// Bytes of one record.
pub const RECORD_BYTES: usize = 28;

/// What is wrong with the bytes of shapes, and where. Offsets of bytes count from the start of the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RawShapesError {
    /// The file ends within a shape.
    #[error("byte {offset}, shape {shape:?}: expected {expected} more bytes for {what}, found {found}")]
    Cut {
        /// Name of the shape.
        shape: String,
        /// Where these bytes begin.
        offset: usize,
        /// What they are: `its number of vertices` or `its moved vertices`.
        what: &'static str,
        /// How many there should be.
        expected: u64,
        /// How many there are.
        found: usize,
    },
    /// A vertex beyond the mesh, or one that does not follow the vertex before.
    #[error(
        "byte {offset}, shape {shape:?}, record {record}: expected a vertex from {least} to {last} (ascending), found {found}"
    )]
    Vertex {
        /// Name of the shape.
        shape: String,
        /// Where the record begins.
        offset: usize,
        /// Which of the shape's records, from 0.
        record: usize,
        /// The vertex after that of the record before.
        least: u64,
        /// The last vertex of the mesh.
        last: u64,
        /// The vertex.
        found: u32,
    },
    /// NaN or infinity.
    #[error(
        "byte {offset}, shape {shape:?}, vertex {vertex}: expected a finite number in its {field} offset, found {found}"
    )]
    NotFinite {
        /// Name of the shape.
        shape: String,
        /// Where the number stands.
        offset: usize,
        /// The vertex.
        vertex: u32,
        /// `position` or `normal`.
        field: &'static str,
        /// The number.
        found: f32,
    },
    /// Bytes behind the last shape.
    #[error("byte {offset}: expected the end of the file behind the last shape, found {found} more bytes")]
    Rest {
        /// Where they begin.
        offset: usize,
        /// How many there are.
        found: usize,
    },
}

/// Reads shapes one after the other.
///
/// ```
/// use avatar_mesh::{Shape, raw_shapes};
/// use glam::Vec3;
///
/// let pout = Shape::from_pairs("pout", 1000, [(410, Vec3::Z)])?.with_normals(vec![Vec3::ZERO; 1000]);
/// let mut bytes = Vec::new();
/// raw_shapes::write(&pout, &mut bytes);
/// assert_eq!(bytes.len(), 4 + 28);
/// let mut reader = raw_shapes::Reader::new(&bytes);
/// assert_eq!(reader.read("pout", 1000)?, pout);
/// reader.finish()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Reader<'a> {
    left: &'a [u8],
    /// Bytes that have been read.
    offset: usize,
}

impl<'a> Reader<'a> {
    /// A reader at the start of these bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { left: bytes, offset: 0 }
    }

    /// Bytes that have not been read.
    pub fn left(&self) -> usize {
        self.left.len()
    }

    /// Reads the next shape, for a mesh of `vertices` vertices. The shape has offsets of normals, if only
    /// zeros, and takes no more memory than a small multiple of its bytes.
    ///
    /// # Errors
    /// The bytes end too early, vertices that do not ascend or that the mesh lacks, numbers that are not
    /// finite. The reader then stays at the place of the error.
    pub fn read(&mut self, name: &str, vertices: usize) -> Result<Shape, RawShapesError> {
        let cut = |what, offset, expected, found| RawShapesError::Cut {
            shape: name.to_owned(),
            offset,
            what,
            expected,
            found,
        };
        let Some((count, rest)) = self.left.split_first_chunk::<COUNT_BYTES>() else {
            let found = self.left.len();
            return Err(cut("its number of vertices", self.offset, COUNT_BYTES as u64, found));
        };
        self.left = rest;
        self.offset += COUNT_BYTES;
        let count = u32::from_le_bytes(*count);
        let expected = u64::from(count) * RECORD_BYTES as u64;
        let length = usize::try_from(expected).ok().filter(|length| *length <= rest.len());
        let Some((records, rest)) = length.and_then(|length| rest.split_at_checked(length)) else {
            return Err(cut("its moved vertices", self.offset, expected, rest.len()));
        };
        let (records, _) = records.as_chunks::<RECORD_BYTES>();
        let (mut positions, mut normals) =
            (Vec::with_capacity(records.len()), Vec::with_capacity(records.len()));
        let mut least = 0;
        for (number, bytes) in records.iter().enumerate() {
            let offset = self.offset + number * RECORD_BYTES;
            let (vertex, numbers) = record(bytes);
            if u64::from(vertex) < least || vertex as usize >= vertices {
                return Err(RawShapesError::Vertex {
                    shape: name.to_owned(),
                    offset,
                    record: number,
                    least,
                    last: (vertices as u64).saturating_sub(1),
                    found: vertex,
                });
            }
            if let Some(at) = numbers.iter().position(|x| !x.is_finite()) {
                return Err(RawShapesError::NotFinite {
                    shape: name.to_owned(),
                    offset: offset + 4 * (at + 1),
                    vertex,
                    field: if at < 3 { "position" } else { "normal" },
                    found: numbers[at],
                });
            }
            least = u64::from(vertex) + 1;
            let [x, y, z, nx, ny, nz] = numbers;
            positions.push((vertex, Vec3::new(x, y, z)));
            normals.push((vertex, Vec3::new(nx, ny, nz)));
        }
        // Vertices ascend and exist, as `from_pairs` wants it; were they not, the first would be told.
        let offsets = |pairs: Vec<(u32, Vec3)>| Offsets::from_pairs(vertices, pairs);
        let both = offsets(positions).and_then(|positions| Ok((positions, offsets(normals)?)));
        let (positions, normals) = both.map_err(|error| self.misplaced(name, vertices, error))?;
        self.offset += records.as_flattened().len();
        self.left = rest;
        Ok(Shape::new(name, positions).with_normals(normals))
    }

    fn misplaced(&self, name: &str, vertices: usize, error: OffsetsError) -> RawShapesError {
        let (OffsetsError::OutOfRange { pair: record, found, .. }
        | OffsetsError::Repeated { pair: record, vertex: found }) = error;
        RawShapesError::Vertex {
            shape: name.to_owned(),
            offset: self.offset + record * RECORD_BYTES,
            record,
            least: 0,
            last: (vertices as u64).saturating_sub(1),
            found,
        }
    }

    /// Checks that nothing is left.
    ///
    /// # Errors
    /// Bytes behind the last shape.
    pub fn finish(self) -> Result<(), RawShapesError> {
        match self.left.len() {
            0 => Ok(()),
            found => Err(RawShapesError::Rest { offset: self.offset, found }),
        }
    }
}

fn record(bytes: &[u8; RECORD_BYTES]) -> (u32, [f32; 6]) {
    let (words, _) = bytes.as_chunks::<4>();
    (u32::from_le_bytes(words[0]), std::array::from_fn(|i| f32::from_le_bytes(words[i + 1])))
}

/// Writes a shape behind what is there: the vertices whose position or normal it moves. Offsets of tangents
/// have no place in the format.
pub fn write(shape: &Shape, out: &mut Vec<u8>) {
    let start = out.len();
    out.extend([0; COUNT_BYTES]);
    let none = Offsets::default();
    let mut positions = shape.positions.iter().peekable();
    let mut normals = shape.normals.as_ref().unwrap_or(&none).iter().peekable();
    let mut count = 0u32;
    loop {
        let next = match (positions.peek(), normals.peek()) {
            (Some((a, _)), Some((b, _))) => Some(*a.min(b)),
            (a, b) => a.or(b).map(|(vertex, _)| *vertex),
        };
        // A mesh has no more vertices than its triangles can name.
        let Some((vertex, number)) = next.and_then(|vertex| Some((vertex, u32::try_from(vertex).ok()?)))
        else {
            break;
        };
        let position = positions.next_if(|(other, _)| *other == vertex);
        let normal = normals.next_if(|(other, _)| *other == vertex);
        out.extend(number.to_le_bytes());
        for offset in [position, normal] {
            let offset = offset.map_or(Vec3::ZERO, |(_, offset)| offset);
            out.extend(offset.to_array().into_iter().flat_map(f32::to_le_bytes));
        }
        count += 1;
    }
    if let Some(place) = out.get_mut(start..start + COUNT_BYTES) {
        place.copy_from_slice(&count.to_le_bytes());
    }
}
