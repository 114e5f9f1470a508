//! `Transformations.xml`: `JointSet / Joint@name[@omit] / (Matrix[@transposed], Children / Joint …)`.

mod encoding;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;

/// Joints may be nested this deep. Faces have 3 levels and whole bodies some 30; the limit keeps hostile files from
/// costing more than they weigh.
pub const MAX_DEPTH: usize = 256;

/// A joint's name may have this many bytes. Every child repeats its parent's name in memory, so a hostile file could
/// otherwise make a long one cost far more than it weighs.
pub const MAX_NAME_BYTES: usize = 1024;
