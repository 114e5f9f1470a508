//! What can be wrong with hair.

/// Why hair could not be planted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HairError {
    /// The model has no such part.
    #[error("expected a part below {parts}, found {found}")]
    NoSuchPart {
        /// Number of parts.
        parts: usize,
        /// The part.
        found: usize,
    },
    /// A root on a vertex that the part does not have.
    #[error("strand {strand}: expected a vertex below {vertices}, found {found}")]
    Corner {
        /// The strand.
        strand: usize,
        /// The vertex.
        found: u32,
        /// Number of vertices of the part.
        vertices: u32,
    },
    /// Hair that moves with a bone that the model does not have.
    #[error("expected a bone below {bones}, found {found}")]
    Bone {
        /// The bone.
        found: u32,
        /// Number of bones of the model.
        bones: u32,
    },
    /// A field that is larger than a texture of the device.
    #[error("expected at most {limit} places along each side of the field, found {} × {} × {}", found[0], found[1], found[2])]
    FieldSize {
        /// Size of the grid.
        found: [u32; 3],
        /// What the device allows.
        limit: u32,
    },
    /// A skin that is larger than a texture of the device.
    #[error("expected at most {limit} vertices of the part, found {found}")]
    SkinSize {
        /// Number of vertices.
        found: u32,
        /// What the device allows.
        limit: usize,
    },
    /// More strands than a binding of the device holds.
    #[error("expected at most {limit} strands, found {found}")]
    TooMany {
        /// Number of strands.
        found: usize,
        /// What the device allows.
        limit: usize,
    },
}
