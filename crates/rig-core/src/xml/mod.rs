//! `Transformations.xml`: `JointSet / Joint@name[@omit] / (Matrix[@transposed], Children / Joint …)`.

mod encoding;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;

/// Joints may be nested this deep. Faces have 3 levels and whole bodies some 30; the limit keeps hostile files from
/// costing more than they weigh.
pub const MAX_DEPTH: usize = 256;
