//! Limits of what a file may unpack to. A few bytes can describe gigabytes: accessors without data, many
//! parts that share one mesh, the same mesh at thousands of nodes.

use crate::scene::ImportError;

/// Vertices and moved vertices of shapes that one file may have where they are counted: some 1 GiB.
#[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
const MAX_VERTICES: u64 = 1 << 24;
/// Bytes that every file may unpack to,
#[cfg(feature = "gltf")]
const BASE_BYTES: u64 = 256 << 20;
/// and so many more for each of its own.
#[cfg(feature = "gltf")]
const BYTES_PER_BYTE: u64 = 64;

/// How much may still be unpacked.
#[derive(Debug)]
pub(crate) struct Budget {
    left: u64,
    unit: Unit,
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
    /// Counts vertices of all parts, of their shapes and of motion: [`MAX_VERTICES`] whatever the file's
    /// size.
    #[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
    pub(crate) fn of_vertices() -> Self {
        Self { left: MAX_VERTICES, unit: Unit::Vertices }
    }

    /// As [`Budget::of_vertices`], with so many left.
    #[cfg(all(test, feature = "fbx"))]
    pub(crate) fn with_vertices_left(left: u64) -> Self {
        Self { left, ..Self::of_vertices() }
    }

    /// Counts bytes: 256 MiB and 64 times the file's own bytes.
    #[cfg(feature = "gltf")]
    pub(crate) fn of_bytes(input_bytes: usize) -> Self {
        let mut budget = Self { left: BASE_BYTES, unit: Unit::Bytes };
        budget.grow(input_bytes);
        budget
    }

    /// How much may still be unpacked.
    #[cfg(feature = "gltf")]
    pub(crate) fn left(&self) -> u64 {
        self.left
    }

    /// Another file of so many bytes was read.
    #[cfg(feature = "gltf")]
    pub(crate) fn grow(&mut self, input_bytes: usize) {
        self.left = self.left.saturating_add((input_bytes as u64).saturating_mul(BYTES_PER_BYTE));
    }

    /// Takes `count` times `size` units, before what they stand for is allocated.
    ///
    /// # Errors
    /// Less is left; nothing is taken then.
    pub(crate) fn take(&mut self, count: usize, size: usize) -> Result<(), Exceeded> {
        let wanted = (count as u64).saturating_mul(size as u64);
        match self.left.checked_sub(wanted) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(match self.unit {
                #[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
                Unit::Vertices => Exceeded {
                    expected: format!("at most {MAX_VERTICES} vertices in all parts and shapes"),
                    found: "more".to_owned(),
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
