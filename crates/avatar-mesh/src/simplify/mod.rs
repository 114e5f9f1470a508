//! Simplified meshes for faces that are small in the picture: edges are collapsed onto one of their ends, so
//! that the vertices that are left are vertices of the mesh as they were, with all that they carry: shapes,
//! bones, coordinates of textures.
//!
//! Of each vertex that went the place on the simplified surface is known, the nearest one in the first of
//! the given poses. What a collapse costs is the largest distance, in any of them, between such a vertex and
//! its place; tilted normals and shifted coordinates of textures count as distances, too. Cheap collapses go
//! first, and none goes that costs more than is asked for. So the error of a level, at the vertices of the
//! original, is measured, not an estimate as by quadrics of planes (Garland and Heckbert, 1997), from whose
//! method the greedy order is taken.

mod cost;
mod surface;

use crate::Mesh;
use crate::weld::picked;
use cost::{Costs, Place};
use glam::Vec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use surface::{Ring, Surface};

/// How much more an error counts at vertices that others must not come through, such as those of lids in
/// front of eyes.
const CARE: f32 = 4.0;
/// Among collapses that cost the same, as all do on a plane, short edges go first: this share of their length
/// is added.
const LENGTH_SHARE: f32 = 1e-4;

/// Points with more triangles than this stay, and nothing collapses onto them: the time that a collapse takes
/// grows faster than their number.
const MOST_TRIANGLES: usize = 128;

/// A mesh on the way to fewer triangles.
///
/// ```
/// use avatar_mesh::{Mesh, Simplifier};
/// use glam::{Vec2, Vec3};
///
/// // A flat grid of 8 × 8 squares needs no more than its corners.
/// let places = (0..81).map(|i| Vec2::new((i % 9) as f32, (i / 9) as f32));
/// let mesh = Mesh {
///     positions: places.clone().map(|p| p.extend(0.0)).collect(),
///     uvs: places.collect(),
///     normals: vec![Vec3::Z; 81],
///     triangles: (0..72)
///         .filter(|i| i % 9 < 8)
///         .flat_map(|i| [[i, i + 1, i + 10], [i, i + 10, i + 9]])
///         .collect(),
///     ..Mesh::default()
/// };
/// let mut simplifier = Simplifier::new(&mesh, &[], &[]);
/// simplifier.run(1e-3);
/// let simplified = simplifier.simplified();
/// assert!(simplified.mesh.triangles.len() < 8);
/// assert!(simplified.error(&mesh.positions) <= 1e-3);
/// ```
#[derive(Clone, Debug)]
pub struct Simplifier<'a> {
    mesh: &'a Mesh,
    surface: Surface,
    costs: Costs<'a>,
    queue: BinaryHeap<Waiting>,
    /// Of each point the collapse that it waits for; the ones in the queue with another turn are outdated.
    next: Vec<Next>,
    has_begun: bool,
}

/// A mesh with fewer triangles, and where the vertices that went lie on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Simplified {
    /// The mesh: vertices that are left keep their order and everything that they carry.
    pub mesh: Mesh,
    /// For each vertex of [`Simplified::mesh`] its place in the original.
    pub originals: Vec<u32>,
    gone: Vec<Gone>,
}

/// A vertex of the original that went, and its place: corners of a triangle, in the original's order, and
/// their shares.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gone {
    vertex: u32,
    corners: [u32; 3],
    shares: [f32; 3],
}

#[derive(Clone, Copy, Debug, Default)]
struct Next {
    turn: u32,
    target: u32,
    /// Whether the vertices that went before were counted.
    is_whole: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Waiting {
    cost: f32,
    point: u32,
    turn: u32,
}

impl Eq for Waiting {}

impl Ord for Waiting {
    /// The cheapest is the greatest, which the queue gives first.
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then(other.point.cmp(&self.point))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<'a> Simplifier<'a> {
    /// Starts with the whole mesh. `posed` are positions of its vertices in the poses that count, the first
    /// one at rest; without any, the bind pose counts. A vertex that a pose lacks is where it is at bind
    /// pose. `careful` are vertices where an error counts fourfold, since another surface lies close by.
    /// Vertices that are alike are to be welded before ([`crate::weld`]): else each triangle is cut from its
    /// neighbours, and nothing collapses.
    pub fn new(mesh: &'a Mesh, posed: &[&[Vec3]], careful: &[bool]) -> Self {
        let surface = Surface::new(mesh, posed);
        let next = vec![Next::default(); surface.point_count()];
        let costs = Costs::new(mesh, &surface, careful);
        Self { mesh, surface, costs, queue: BinaryHeap::new(), next, has_begun: false }
    }

    /// Collapses edges as long as one costs no more than this, in units of the mesh. A larger error later
    /// goes on from here.
    pub fn run(&mut self, largest_error: f32) {
        if !std::mem::replace(&mut self.has_begun, true) {
            (0..self.surface.point_count() as u32).for_each(|point| self.consider(point));
        }
        while let Some(first) = self.queue.peek().copied() {
            // Not a number: nothing is that cheap.
            if first.cost.partial_cmp(&largest_error).is_none_or(Ordering::is_gt) {
                return;
            }
            self.queue.pop();
            let next = self.next[first.point as usize];
            if next.turn != first.turn {
                continue;
            }
            if !next.is_whole {
                self.consider_whole(first.point);
                continue;
            }
            let ring = self.costs.ring(&self.surface, first.point);
            if self.costs.collapse(&mut self.surface, &ring, next.target) {
                self.next[first.point as usize].turn += 1;
                ring.neighbours.into_iter().for_each(|point| self.consider(point));
            }
        }
    }

    /// Finds the cheapest collapse of a point onto a neighbour, not counting the vertices that went before:
    /// its cost is at least that.
    fn consider(&mut self, point: u32) {
        if self.surface.degree(point) > MOST_TRIANGLES {
            return self.wait(point, None, false);
        }
        let ring = self.costs.ring(&self.surface, point);
        let best = self.cheapest(&ring, false);
        self.wait(point, best, false);
    }

    /// What the collapse that a point waits for costs in whole; if it is not allowed, another one.
    fn consider_whole(&mut self, point: u32) {
        let ring = self.costs.ring(&self.surface, point);
        let target = self.next[point as usize].target;
        let error = self.costs.of(&self.surface, &ring, target, true, f32::INFINITY);
        let length = self.surface.distance(point, target) * LENGTH_SHARE;
        let best = error.map(|error| (error + length, target)).or_else(|| self.cheapest(&ring, true));
        self.wait(point, best, true);
    }

    fn cheapest(&self, ring: &Ring, is_whole: bool) -> Option<(f32, u32)> {
        let mut best: Option<(f32, u32)> = None;
        for &target in &ring.neighbours {
            if self.surface.degree(target) > MOST_TRIANGLES {
                continue;
            }
            let length = self.surface.distance(ring.point, target) * LENGTH_SHARE;
            let most = best.map_or(f32::INFINITY, |(least, _)| least - length);
            if let Some(error) = self.costs.of(&self.surface, ring, target, is_whole, most) {
                best = Some((error + length, target));
            }
        }
        best
    }

    fn wait(&mut self, point: u32, best: Option<(f32, u32)>, is_whole: bool) {
        let next = &mut self.next[point as usize];
        next.turn += 1;
        if let Some((cost, target)) = best.filter(|(cost, _)| cost.is_finite()) {
            *next = Next { turn: next.turn, target, is_whole };
            self.queue.push(Waiting { cost, point, turn: next.turn });
        }
    }

    /// What is left now.
    pub fn simplified(&self) -> Simplified {
        let triangles: Vec<[u32; 3]> = self.surface.triangles().collect();
        let mut is_left = vec![false; self.mesh.positions.len()];
        triangles.iter().flatten().for_each(|vertex| is_left[*vertex as usize] = true);
        let originals: Vec<usize> = (0..is_left.len()).filter(|vertex| is_left[*vertex]).collect();
        let mut new_from_original = vec![0; is_left.len()];
        (0..).zip(&originals).for_each(|(new, original)| new_from_original[*original] = new);
        let triangles = triangles.iter().map(|t| t.map(|i| new_from_original[i as usize])).collect();
        let gone = self.costs.places().map(|(vertex, Place { triangle, shares })| Gone {
            vertex,
            corners: self.surface.corners(triangle),
            shares,
        });
        Simplified {
            mesh: picked(self.mesh, &originals, triangles),
            originals: originals.iter().map(|original| *original as u32).collect(),
            gone: gone.collect(),
        }
    }
}

impl Simplified {
    /// The largest distance between a vertex of the original that went and its place on the simplified
    /// surface, where the original's vertices are at `posed`; vertices that it lacks are left out. Both
    /// meshes deform alike, so no vertex of the original lies further from the simplified mesh in that pose.
    pub fn error(&self, posed: &[Vec3]) -> f32 {
        let place = |vertex: u32| posed.get(vertex as usize).copied();
        let distance = |gone: &Gone| {
            let [a, b, c] = gone.corners.map(place);
            let [wa, wb, wc] = gone.shares;
            Some(place(gone.vertex)?.distance(a? * wa + b? * wb + c? * wc))
        };
        self.gone.iter().filter_map(distance).fold(0.0, f32::max)
    }
}
