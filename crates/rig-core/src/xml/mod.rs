//! `Transformations.xml`: `JointSet / Joint@name[@omit] / (Matrix[@transposed], Children / Joint …)`.

mod encoding;
mod read;
mod write;

use crate::{RawRig, RigError, XmlError};

/// Joints may be nested this deep. Faces have 3 levels and whole bodies some 30; the limit keeps hostile
/// files from costing more than they weigh.
pub const MAX_DEPTH: usize = 256;

/// A joint's name may have this many bytes. Every child repeats its parent's name in memory, so a hostile
/// file could otherwise make a long one cost far more than it weighs.
pub const MAX_NAME_BYTES: usize = 1024;

impl RawRig {
    /// Reads a `Transformations.xml`. Rigidity is not checked here, so that a broken rig can be repaired.
    ///
    /// # Errors
    /// The first thing in the text that is not as the format demands, with its place.
    pub fn from_xml(bytes: &[u8]) -> Result<Self, XmlError> {
        read::read(bytes)
    }

    /// Writes a `Transformations.xml`. Reading it back gives every matrix to the last bit.
    ///
    /// # Errors
    /// What could not be read back: duplicate or empty names, unknown parents, cycles, more than
    /// [`MAX_DEPTH`] levels, matrices that are not finite.
    pub fn to_xml(&self) -> Result<String, RigError> {
        write::write(self)
    }
}
