//! Limits of what a file may unpack to. A few bytes can describe gigabytes: accessors without data, many
//! parts that share one mesh, the same mesh at thousands of nodes.

use crate::memory::{self, UNPACKED};
use crate::scene::ImportError;

/// What a vertex takes, or one that a shape moves, where these are counted.
#[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
const BYTES_PER_VERTEX: u64 = 64;

/// Keys that may be looked at for each vertex that may be read; a fraction of a microsecond each.
#[cfg(feature = "fbx")]
const KEYS_PER_VERTEX: u64 = 16;

/// How much may still be unpacked.
#[derive(Debug)]
pub(crate) struct Budget {
    left: u64,
    unit: Unit,
    /// How many keys may still be looked at, of which few may be left in the end.
    #[cfg(feature = "fbx")]
    keys: u64,
}

#[derive(Debug)]
enum Unit {
    #[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
    Vertices,
    #[cfg(feature = "gltf")]
    Bytes,
}

/// What was expected and what was found instead, at a place that the caller knows.
#[derive(Debug)]
pub(crate) struct Exceeded {
    expected: String,
    found: String,
}

impl Exceeded {
    /// As an error at a place of the file.
    pub(crate) fn at(self, place: impl Into<String>) -> ImportError {
        ImportError::new(place, self.expected, self.found)
    }
}

impl Budget {
    /// Counts vertices of all parts, of their shapes and of motion, as many as the bytes of
    /// [`Budget::of_bytes`] hold.
    #[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
    pub(crate) fn of_vertices(input_bytes: usize) -> Self {
        let bytes = memory::share(UNPACKED, input_bytes as u64);
        let left = bytes / BYTES_PER_VERTEX;
        Self {
            left,
            unit: Unit::Vertices,
            #[cfg(feature = "fbx")]
            keys: left.saturating_mul(KEYS_PER_VERTEX),
        }
    }

    /// As [`Budget::of_vertices`], with so many left.
    #[cfg(all(test, feature = "fbx"))]
    pub(crate) fn with_vertices_left(left: u64) -> Self {
        Self { left, ..Self::of_vertices(0) }
    }

    /// Counts bytes: the share that [`UNPACKED`] says.
    #[cfg(feature = "gltf")]
    pub(crate) fn of_bytes(input_bytes: usize) -> Self {
        Self {
            left: memory::share(UNPACKED, input_bytes as u64),
            unit: Unit::Bytes,
            #[cfg(feature = "fbx")]
            keys: 0,
        }
    }

    /// As [`Budget::of_bytes`], with so many left.
    #[cfg(all(test, feature = "gltf"))]
    pub(crate) fn with_bytes_left(left: u64) -> Self {
        Self { left, ..Self::of_bytes(0) }
    }

    /// How much may still be unpacked.
    #[cfg(feature = "gltf")]
    pub(crate) fn left(&self) -> u64 {
        self.left
    }

    /// Another file of so many bytes was read.
    #[cfg(feature = "gltf")]
    pub(crate) fn grow(&mut self, input_bytes: usize) {
        self.left = memory::share((self.left, UNPACKED.1), input_bytes as u64);
    }

    /// Takes `count` times `size` units, before what they stand for is allocated.
    ///
    /// # Errors
    /// Less is left; nothing is taken then.
    pub(crate) fn take(&mut self, count: usize, size: usize) -> Result<(), Exceeded> {
        self.left = self.after((count as u64).saturating_mul(size as u64))?;
        Ok(())
    }

    /// Whether so many units are left, for what goes again.
    ///
    /// # Errors
    /// Less is left.
    #[cfg(any(feature = "fbx", feature = "gltf"))]
    pub(crate) fn check(&self, wanted: usize) -> Result<(), Exceeded> {
        self.after(wanted as u64).map(|_| ())
    }

    /// Takes from the keys that may be looked at: many properties can share a long curve, and keep little of
    /// it.
    ///
    /// # Errors
    /// Fewer are left.
    #[cfg(feature = "fbx")]
    pub(crate) fn look_at_keys(&mut self, count: usize) -> Result<(), Exceeded> {
        self.keys = self.keys.checked_sub(count as u64).ok_or_else(|| Exceeded {
            expected: format!("at most {} keys more of all properties in a file of this size", self.keys),
            found: count.to_string(),
        })?;
        Ok(())
    }

    fn after(&self, wanted: u64) -> Result<u64, Exceeded> {
        match self.left.checked_sub(wanted) {
            Some(left) => Ok(left),
            None => Err(match self.unit {
                #[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
                Unit::Vertices => Exceeded {
                    expected: format!(
                        "at most {} vertices more in parts and shapes of a file of this size",
                        self.left
                    ),
                    found: wanted.to_string(),
                },
                #[cfg(feature = "gltf")]
                Unit::Bytes => Exceeded {
                    expected: format!("at most {} bytes more in a file of this size", self.left),
                    found: wanted.to_string(),
                },
            }),
        }
    }
}
