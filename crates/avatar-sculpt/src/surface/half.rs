//! Half a mesh while it is being built: the character's left half, midline included.

use glam::{DVec2, DVec3};

use super::chart::{self, Place};

/// Which part of the skin a vertex belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Patch {
    /// The outer skin, drawn from the solid.
    Sheet,
    /// The edge and the inside of the lids, and the socket behind the eyeball.
    Socket,
    /// The inside of lips and cheeks.
    Mouth,
    /// The auricle.
    Ear,
    /// The lashes.
    Lash,
}

/// A vertex of the half mesh.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Place at rest.
    pub p: DVec3,
    /// Place in the chart. Near the lips it is that of a face without the furrow between them, so that the
    /// chart never folds.
    pub place: Place,
    /// Part of the skin.
    pub patch: Patch,
    /// For points on or near lips and lids: whether they belong to the lower one.
    pub lower: bool,
    /// Distance across the lip: 0 at the line between the lips, 1 at the border of the red, 2 at the last
    /// ring; negative inside the mouth; 3 elsewhere.
    pub lip: f64,
    /// Distance across the lid: 0 at its outer edge, 1 at the last ring; negative inside; 3 elsewhere.
    pub lid: f64,
    /// A swept patch's own coordinates (ring, place along the ring), 0…1; a lash's place in its picture.
    pub own: DVec2,
    /// The vertex whose motion this one takes over; none for its own.
    pub follows: Option<usize>,
}

impl Node {
    /// A vertex of the outer skin away from lips and lids.
    #[must_use]
    pub fn sheet(p: DVec3) -> Self {
        Self {
            p,
            place: chart::place_of(p),
            patch: Patch::Sheet,
            lower: false,
            lip: 3.0,
            lid: 3.0,
            own: DVec2::ZERO,
            follows: None,
        }
    }
}

/// The half mesh. Triangles are counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Half {
    /// Vertices.
    pub nodes: Vec<Node>,
    /// Triangles.
    pub triangles: Vec<[usize; 3]>,
}

impl Half {
    /// The vertex that decides how a vertex moves: weights and shapes are those of its place.
    #[must_use]
    pub fn mover(&self, number: usize) -> &Node {
        &self.nodes[self.nodes[number].follows.unwrap_or(number)]
    }

    /// Adds a vertex and returns its number.
    pub fn add(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// Joins two rows of equal length with triangles. Seen from outside, `from` → `to` turns left of the
    /// row's direction. `closed` joins the ends too.
    pub fn stitch(&mut self, from: &[usize], to: &[usize], closed: bool) {
        let n = from.len().min(to.len());
        let last = if closed { n } else { n.saturating_sub(1) };
        for i in 0..last {
            let j = (i + 1) % n;
            let (a, b, c, d) = (from[i], from[j], to[j], to[i]);
            // Rows that meet in a point make triangles, not quadrangles.
            if a != b && b != c && a != c {
                self.triangles.push([a, b, c]);
            }
            if a != c && c != d && a != d {
                self.triangles.push([a, c, d]);
            }
        }
    }
}
