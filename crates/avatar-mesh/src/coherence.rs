//! Whether geometries of several files can be shapes of one mesh.
//!
//! Shapes blend vertex by vertex, so all geometries of a set need the same number of vertices in the same order. Files do not say
//! what their order means; their faces do: where vertices were reordered, faces name others. (Vertices of no face, and an order that
//! turns a symmetric net of faces into itself, tell nothing.)

use glam::Vec3;
use std::collections::HashMap;
use std::fmt;

/// A geometry and where it came from.
#[derive(Clone, Copy, Debug)]
pub struct Geometry<'a> {
    /// The file, for messages.
    pub file: &'a str,
    /// Name of the shape, for messages.
    pub shape: &'a str,
    /// Positions of its vertices.
    pub positions: &'a [Vec3],
    /// Its triangles, as the file lists them.
    pub triangles: &'a [[u32; 3]],
}

/// How the faces of a candidate are those of the base.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FaceMatch {
    /// One by one.
    Same,
    /// All of them, but listed in another order, or beginning at other corners: harmless for blending, but whatever is stored
    /// per face or per corner must be moved along.
    Reordered {
        /// For each triangle of the base, the one of the candidate that it is.
        candidate_from_base: Vec<u32>,
        /// How many are not in their place.
        moved: usize,
        /// How many begin at another corner.
        rotated: usize,
    },
}

impl FaceMatch {
    /// Whether it deserves a warning, which its text is.
    pub fn is_warning(&self) -> bool {
        *self != Self::Same
    }
}

impl fmt::Display for FaceMatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Same => write!(f, "the same faces"),
            Self::Reordered { candidate_from_base, moved, rotated } => write!(
                f,
                "expected faces in the base's order, found {moved} of {} elsewhere and {rotated} that begin at another corner",
                candidate_from_base.len()
            ),
        }
    }
}

/// Why a geometry is no shape of the base.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CoherenceError {
    /// Another number of vertices.
    #[error("{file}, shape {shape:?}: expected {expected} vertices, found {found}")]
    VertexCount {
        /// The candidate's file.
        file: String,
        /// The candidate's name.
        shape: String,
        /// Vertices of the base.
        expected: usize,
        /// Vertices of the candidate.
        found: usize,
    },
    /// Another number of triangles.
    #[error("{file}, shape {shape:?}: expected {expected} triangles, found {found}")]
    FaceCount {
        /// The candidate's file.
        file: String,
        /// The candidate's name.
        shape: String,
        /// Triangles of the base.
        expected: usize,
        /// Triangles of the candidate.
        found: usize,
    },
    /// The same faces, but their vertices are numbered otherwise.
    #[error(
        "{file}, shape {shape:?}: expected the base's order of vertices, found {reordered} of {vertices} in another place \
        (first vertex {vertex} as {found})"
    )]
    VertexOrder {
        /// The candidate's file.
        file: String,
        /// The candidate's name.
        shape: String,
        /// Number of vertices of each.
        vertices: usize,
        /// How many have another number.
        reordered: usize,
        /// The first of them, in the base.
        vertex: u32,
        /// Its number in the candidate.
        found: u32,
    },
    /// Other faces.
    #[error(
        "{file}, shape {shape:?}: expected the base's {faces} triangles, {missing} are missing (first {triangle}: {corners:?})"
    )]
    Faces {
        /// The candidate's file.
        file: String,
        /// The candidate's name.
        shape: String,
        /// Number of triangles of each.
        faces: usize,
        /// How many of the base's the candidate lacks.
        missing: usize,
        /// The first of them, in the base.
        triangle: usize,
        /// Its vertices.
        corners: [u32; 3],
    },
}

/// Checks that a candidate has the base's vertices and faces.
///
/// # Errors
/// Other counts, another order of vertices, other faces; a triangle that runs the other way around is another face.
pub fn check(base: Geometry<'_>, candidate: Geometry<'_>) -> Result<FaceMatch, CoherenceError> {
    let (file, shape) = (candidate.file.to_owned(), candidate.shape.to_owned());
    let (expected, found) = (base.positions.len(), candidate.positions.len());
    if expected != found {
        return Err(CoherenceError::VertexCount { file, shape, expected, found });
    }
    let (vertices, expected, found) = (expected, base.triangles.len(), candidate.triangles.len());
    if expected != found {
        return Err(CoherenceError::FaceCount { file, shape, expected, found });
    }
    if base.triangles == candidate.triangles {
        return Ok(FaceMatch::Same);
    }
    match matched(base.triangles, candidate.triangles) {
        Ok(face_match) => Ok(face_match),
        Err((missing, triangle)) => Err(match renumbered(base.triangles, candidate.triangles) {
            Some((reordered, vertex, found)) => {
                CoherenceError::VertexOrder { file, shape, vertices, reordered, vertex, found }
            }
            None => {
                let corners = base.triangles.get(triangle).copied().unwrap_or_default();
                CoherenceError::Faces { file, shape, faces: expected, missing, triangle, corners }
            }
        }),
    }
}

/// A triangle as it reads from the corner that puts it first.
fn canonical([a, b, c]: [u32; 3]) -> [u32; 3] {
    [a, b, c].min([b, c, a]).min([c, a, b])
}

/// The candidate's triangle for each of the base's, or how many there are none for, and the first.
fn matched(base: &[[u32; 3]], candidate: &[[u32; 3]]) -> Result<FaceMatch, (usize, usize)> {
    // Triangles that are there several times are matched in their order: the last of a list is its first.
    let mut places: HashMap<[u32; 3], Vec<u32>> = HashMap::with_capacity(candidate.len());
    for (place, corners) in candidate.iter().enumerate().rev() {
        places.entry(canonical(*corners)).or_default().push(place as u32);
    }
    let mut candidate_from_base = Vec::with_capacity(base.len());
    let (mut missing, mut moved, mut rotated) = (None, 0, 0);
    for (triangle, corners) in base.iter().enumerate() {
        match places.get_mut(&canonical(*corners)).and_then(Vec::pop) {
            Some(place) => {
                moved += usize::from(place as usize != triangle);
                rotated += usize::from(candidate.get(place as usize) != Some(corners));
                candidate_from_base.push(place);
            }
            None => {
                let (count, first) = missing.unwrap_or((0, triangle));
                missing = Some((count + 1, first));
            }
        }
    }
    match missing {
        Some(missing) => Err(missing),
        None => Ok(FaceMatch::Reordered { candidate_from_base, moved, rotated }),
    }
}

/// Where the triangles are the same but for a new numbering of their vertices: how many vertices have another number, and the
/// first with its new one.
fn renumbered(base: &[[u32; 3]], candidate: &[[u32; 3]]) -> Option<(usize, u32, u32)> {
    let mut new_of: HashMap<u32, u32> = HashMap::new();
    let mut old_of: HashMap<u32, u32> = HashMap::new();
    for (old, new) in base.iter().flatten().zip(candidate.iter().flatten()) {
        if new_of.insert(*old, *new).is_some_and(|other| other != *new)
            || old_of.insert(*new, *old).is_some_and(|other| other != *old)
        {
            return None;
        }
    }
    let changed = || new_of.iter().filter(|(old, new)| old != new);
    let (vertex, found) = changed().min()?;
    Some((changed().count(), *vertex, *found))
}
