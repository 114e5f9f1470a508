//! What can be wrong with a model.

use crate::gpu::image::ImageSizeError;

/// Why a model could not be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// Something is wrong with a part.
    #[error("part {label:?}: {problem}")]
    Part {
        /// The part's label.
        label: String,
        /// What is wrong.
        problem: PartProblem,
    },
    /// More bones than a binding holds.
    #[error("expected at most {limit} bones, found {found}")]
    PaletteTooLarge {
        /// Number of bones.
        found: usize,
        /// What the device allows.
        limit: u64,
    },
}

/// What is wrong with a part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PartProblem {
    /// An array that is not as long as the mesh has vertices.
    #[error("expected {expected} {what}, found {found}")]
    Count {
        /// Which array.
        what: &'static str,
        /// Number of vertices.
        expected: usize,
        /// Its length.
        found: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle}: expected a vertex below {vertices}, found {found}")]
    Index {
        /// The triangle.
        triangle: usize,
        /// The index.
        found: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A part with bones per vertex whose mesh has none.
    #[error("expected bones per vertex, found none in the mesh")]
    NoVertexBones,
    /// A vertex names a bone that does not exist.
    #[error("vertex {vertex}: expected a bone below {palette_len}, found {found}")]
    VertexBone {
        /// The vertex.
        vertex: usize,
        /// Its bone.
        found: usize,
        /// Length of the palette.
        palette_len: usize,
    },
    /// A rigid part follows a bone that does not exist.
    #[error("expected a bone below {palette_len}, found {found}")]
    RigidBone {
        /// The bone.
        found: usize,
        /// Length of the palette.
        palette_len: usize,
    },
    /// More data than a binding of the device holds.
    #[error("expected at most {limit} bytes of {what}, found {bytes} ({count} elements)")]
    TooLarge {
        /// What is too large.
        what: &'static str,
        /// Number of elements.
        count: usize,
        /// Their size.
        bytes: u64,
        /// What the device allows.
        limit: u64,
    },
    /// A picture whose bytes do not fit its size.
    #[error("{which} texture: {error}")]
    Texture {
        /// Which of the part's pictures.
        which: &'static str,
        /// The size and the number of bytes.
        error: ImageSizeError,
    },
}

/// A part that a model does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected a part below {parts}, found {found}")]
pub struct NoSuchPart {
    /// Number of parts.
    pub parts: usize,
    /// The part that was asked for, from 0.
    pub found: usize,
}

/// Whether `count` elements of so many bytes keep within the limit.
pub(crate) fn fits(what: &'static str, count: usize, element: usize, limit: u64) -> Result<(), PartProblem> {
    let bytes = (count as u64).saturating_mul(element as u64);
    match bytes <= limit {
        true => Ok(()),
        false => Err(PartProblem::TooLarge { what, count, bytes, limit }),
    }
}
