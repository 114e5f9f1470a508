//! Whether geometries of several files can be shapes of one mesh.
//!
//! Shapes blend vertex by vertex, so all geometries of a set need the same number of vertices in the same
//! order. Files do not say what their order means; their faces do: where vertices were reordered, faces name
//! others. (Vertices of no face, and an order that turns a symmetric net of faces into itself, tell nothing.)

use glam::Vec3;
use std::cmp::Ordering;
use std::collections::HashMap;
use std::fmt;

/// Faces of any number of corners: the vertices that they go around.
#[derive(Clone, Copy, Debug)]
pub enum Faces<'a> {
    /// Three corners each.
    Triangles(&'a [[u32; 3]]),
    /// One face after the other.
    Polygons {
        /// The corners of all faces.
        corners: &'a [u32],
        /// For each face where the next one's corners begin.
        ends: &'a [u32],
    },
}

impl<'a> Faces<'a> {
    /// How many there are.
    pub fn len(self) -> usize {
        match self {
            Self::Triangles(triangles) => triangles.len(),
            Self::Polygons { ends, .. } => ends.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// The corners of a face; none where ends do not rise or go beyond the corners.
    pub fn corners(self, face: usize) -> &'a [u32] {
        match self {
            Self::Triangles(triangles) => triangles.get(face).map_or(&[], |corners| corners),
            Self::Polygons { corners, ends } => {
                let start = face.checked_sub(1).map_or(Some(0), |before| ends.get(before).copied());
                let range = start.zip(ends.get(face)).map(|(start, end)| start as usize..*end as usize);
                range.and_then(|range| corners.get(range)).unwrap_or(&[])
            }
        }
    }

    fn all(self) -> impl Iterator<Item = &'a [u32]> {
        (0..self.len()).map(move |face| self.corners(face))
    }
}

/// A geometry and where it came from.
#[derive(Clone, Copy, Debug)]
pub struct Geometry<'a> {
    /// The file, for messages.
    pub file: &'a str,
    /// Name of the shape, for messages.
    pub shape: &'a str,
    /// Positions of its vertices.
    pub positions: &'a [Vec3],
    /// Its faces, as the file lists them.
    pub faces: Faces<'a>,
}

/// How the faces of a candidate are those of the base.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FaceMatch {
    /// One by one.
    Same,
    /// All of them, but listed in another order, or beginning at other corners: harmless for blending, but
    /// whatever is stored per face or per corner must be moved along.
    Reordered {
        /// For each face of the base, the one of the candidate that it is.
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

/// Why a geometry cannot be a shape of the base.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}, shape {shape:?}: expected {}, found {}", .mismatch.expected(), .mismatch.found())]
pub struct CoherenceError {
    /// The candidate's file.
    pub file: String,
    /// The candidate's name.
    pub shape: String,
    /// What differs.
    pub mismatch: Mismatch,
}

/// A difference that makes blending vertex by vertex meaningless.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mismatch {
    /// Another number of vertices.
    VertexCount {
        /// Vertices of the base.
        expected: usize,
        /// Vertices of the candidate.
        found: usize,
    },
    /// Another number of faces.
    FaceCount {
        /// Faces of the base.
        expected: usize,
        /// Faces of the candidate.
        found: usize,
    },
    /// The same faces, but their vertices are numbered otherwise.
    VertexOrder {
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
    Faces {
        /// Number of faces of each.
        faces: usize,
        /// How many of the base's the candidate lacks.
        missing: usize,
        /// The first of them, in the base.
        face: usize,
        /// Its vertices.
        corners: Vec<u32>,
    },
}

impl Mismatch {
    /// What the base has.
    pub fn expected(&self) -> String {
        match self {
            Self::VertexCount { expected, .. } => format!("{expected} vertices"),
            Self::FaceCount { expected, .. } => format!("{expected} faces"),
            Self::VertexOrder { .. } => "the base's order of vertices".to_owned(),
            Self::Faces { faces, .. } => format!("the base's {faces} faces"),
        }
    }

    /// What the candidate has.
    pub fn found(&self) -> String {
        match self {
            Self::VertexCount { found, .. } | Self::FaceCount { found, .. } => found.to_string(),
            Self::VertexOrder { vertices, reordered, vertex, found } => {
                format!("{reordered} of {vertices} in another place (first vertex {vertex} as {found})")
            }
            Self::Faces { missing, face, corners, .. } => {
                let shown = &corners[..corners.len().min(8)];
                let more = if shown.len() < corners.len() { " and more" } else { "" };
                format!("none for {missing} of them (first {face}: {shown:?}{more})")
            }
        }
    }
}

/// Checks that a candidate has the base's vertices and faces.
///
/// # Errors
/// Other counts, another order of vertices, other faces; a face that runs the other way around is another
/// face.
pub fn check(base: Geometry<'_>, candidate: Geometry<'_>) -> Result<FaceMatch, CoherenceError> {
    compare(base, candidate).map_err(|mismatch| CoherenceError {
        file: candidate.file.to_owned(),
        shape: candidate.shape.to_owned(),
        mismatch,
    })
}

fn compare(base: Geometry<'_>, candidate: Geometry<'_>) -> Result<FaceMatch, Mismatch> {
    let (expected, found) = (base.positions.len(), candidate.positions.len());
    if expected != found {
        return Err(Mismatch::VertexCount { expected, found });
    }
    let (vertices, expected, found) = (expected, base.faces.len(), candidate.faces.len());
    if expected != found {
        return Err(Mismatch::FaceCount { expected, found });
    }
    if base.faces.all().eq(candidate.faces.all()) {
        return Ok(FaceMatch::Same);
    }
    matched(base.faces, candidate.faces).map_err(|(missing, face)| {
        match renumbered(base.faces, candidate.faces) {
            Some((reordered, vertex, found)) => Mismatch::VertexOrder { vertices, reordered, vertex, found },
            None => {
                let corners = base.faces.corners(face).to_vec();
                Mismatch::Faces { faces: expected, missing, face, corners }
            }
        }
    })
}

/// The corner from which a face reads as the first of all its turns. Two faces are the same but for where
/// they begin if they read the same from there. Linear in the corners: of two beginnings, the one that loses
/// after k corners takes the k that follow it along.
pub fn first_corner(corners: &[u32]) -> usize {
    let count = corners.len();
    let at = |start: usize, k: usize| corners[(start + k) % count];
    let (mut one, mut other, mut k) = (0, 1, 0);
    while one < count && other < count && k < count {
        match at(one, k).cmp(&at(other, k)) {
            Ordering::Equal => {
                k += 1;
                continue;
            }
            Ordering::Greater => one += k + 1,
            Ordering::Less => other += k + 1,
        }
        other += usize::from(one == other);
        k = 0;
    }
    one.min(other)
}

/// A face from its first corner on.
fn canonical(corners: &[u32]) -> Vec<u32> {
    let (rest, start) = corners.split_at(first_corner(corners));
    [start, rest].concat()
}

/// The candidate's face for each face of the base. The error is the number of faces of the base without a
/// counterpart, and the first of them.
fn matched(base: Faces<'_>, candidate: Faces<'_>) -> Result<FaceMatch, (usize, usize)> {
    // Faces that are there several times are matched in their order: the last of a list is its first.
    let mut places: HashMap<Vec<u32>, Vec<u32>> = HashMap::with_capacity(candidate.len());
    for place in (0..candidate.len()).rev() {
        places.entry(canonical(candidate.corners(place))).or_default().push(place as u32);
    }
    let mut candidate_from_base = Vec::with_capacity(base.len());
    let (mut missing, mut moved, mut rotated) = (None, 0, 0);
    for (face, corners) in base.all().enumerate() {
        match places.get_mut(&canonical(corners)).and_then(Vec::pop) {
            Some(place) => {
                moved += usize::from(place as usize != face);
                rotated += usize::from(candidate.corners(place as usize) != corners);
                candidate_from_base.push(place);
            }
            None => {
                let (count, first) = missing.unwrap_or((0, face));
                missing = Some((count + 1, first));
            }
        }
    }
    match missing {
        Some(missing) => Err(missing),
        None => Ok(FaceMatch::Reordered { candidate_from_base, moved, rotated }),
    }
}

/// Where the faces are the same but for a new numbering of their vertices: how many vertices have another
/// number, and the first with its new one.
fn renumbered(base: Faces<'_>, candidate: Faces<'_>) -> Option<(usize, u32, u32)> {
    let mut new_of: HashMap<u32, u32> = HashMap::new();
    let mut old_of: HashMap<u32, u32> = HashMap::new();
    for (base, candidate) in base.all().zip(candidate.all()) {
        if base.len() != candidate.len() {
            return None;
        }
        for (old, new) in base.iter().zip(candidate) {
            if new_of.insert(*old, *new).is_some_and(|other| other != *new)
                || old_of.insert(*new, *old).is_some_and(|other| other != *old)
            {
                return None;
            }
        }
    }
    let changed = || new_of.iter().filter(|(old, new)| old != new);
    let (vertex, found) = changed().min()?;
    Some((changed().count(), *vertex, *found))
}
