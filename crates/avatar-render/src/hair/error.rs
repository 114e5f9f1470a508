//! What can be wrong with hair.

/// Why a head can have no such hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
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
    /// A groom whose lists have different lengths.
    #[error(
        "strand {strand}: expected a comb, a length, a phase and a guide, found fewer of them than roots"
    )]
    Incomplete {
        /// The strand.
        strand: usize,
    },
    /// A guide that is no strand.
    #[error("expected guides below {strands}, found {found}")]
    Guide {
        /// The guide.
        found: u32,
        /// Number of strands.
        strands: usize,
    },
    /// More guides than a binding of the device holds.
    #[error("expected at most {limit} guides, found {found}")]
    TooManyGuides {
        /// Number of guides.
        found: usize,
        /// What the device allows.
        limit: usize,
    },
    /// Hair that moves with a bone that the model does not have.
    #[error("expected a bone below {bones}, found {found}")]
    Bone {
        /// The bone.
        found: u32,
        /// Number of bones of the model.
        bones: u32,
    },
    /// A field of distances that does not fill its grid.
    #[error("expected distances for a grid of {} × {} × {}, found {found}", expected[0], expected[1], expected[2])]
    Field {
        /// Size of the grid.
        expected: [u32; 3],
        /// Number of distances.
        found: usize,
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
