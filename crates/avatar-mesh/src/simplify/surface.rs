use crate::Mesh;
use glam::Vec3;
use std::collections::HashMap;

/// Triangles over points. A point is a place that one or several vertices share in every pose: where the
/// coordinates of a texture are cut, or normals, there are several.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    triangles: Vec<[u32; 3]>,
    is_left: Vec<bool>,
    point_of: Vec<u32>,
    /// Of each point the triangles that are left around it.
    stars: Vec<Vec<u32>>,
    /// The places of each point in the poses.
    places: Vec<Vec3>,
    poses: usize,
    /// Of each point its vertices that triangles have, as ranges of `vertices`.
    starts: Vec<u32>,
    vertices: Vec<u32>,
}

/// A triangle around a point: its number, the vertex at the point, and the other two in order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    pub(super) triangle: u32,
    pub(super) vertex: u32,
    pub(super) others: [u32; 2],
}

/// The points around a point, in ascending order, each with whether the edge to it is a cut.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    pub(super) point: u32,
    pub(super) neighbours: Vec<u32>,
    pub(super) cuts: Vec<bool>,
}

impl Ring {
    /// Cuts are looked for where there may be some.
    pub(super) fn of(surface: &Surface, point: u32, may_have_cuts: bool) -> Self {
        let neighbours = surface.neighbours(point);
        let cuts = neighbours.iter().map(|other| may_have_cuts && surface.is_cut(point, *other)).collect();
        Self { point, neighbours, cuts }
    }

    pub(super) fn is_cut(&self, other: u32) -> bool {
        self.neighbours.binary_search(&other).is_ok_and(|at| self.cuts[at])
    }
}

impl Surface {
    pub(super) fn new(mesh: &Mesh, posed: &[&[Vec3]]) -> Self {
        let count = mesh.positions.len();
        let poses = posed.len().max(1);
        let mut points: HashMap<Vec<[u32; 3]>, u32> = HashMap::with_capacity(count);
        let mut places = Vec::new();
        let mut point_of = Vec::with_capacity(count);
        let mut row = Vec::with_capacity(poses);
        for (vertex, &rest) in mesh.positions.iter().enumerate() {
            row.clear();
            row.extend(posed.iter().map(|positions| positions.get(vertex).copied().unwrap_or(rest)));
            if row.is_empty() {
                row.push(rest);
            }
            let next = points.len() as u32;
            let bits = row.iter().map(|place| place.to_array().map(|x| (x + 0.0).to_bits())).collect();
            let point = *points.entry(bits).or_insert(next);
            if point == next {
                places.extend_from_slice(&row);
            }
            point_of.push(point);
        }
        let is_whole = |triangle: &&[u32; 3]| {
            let points = triangle.map(|vertex| point_of.get(vertex as usize).copied());
            points.iter().all(Option::is_some)
                && points[0] != points[1]
                && points[1] != points[2]
                && points[2] != points[0]
        };
        let triangles: Vec<[u32; 3]> = mesh.triangles.iter().filter(is_whole).copied().collect();
        // Vertices without a triangle have no side of a cut that they could go to.
        let mut is_used = vec![false; count];
        triangles.iter().flatten().for_each(|vertex| is_used[*vertex as usize] = true);
        let mut of_points = vec![Vec::new(); points.len()];
        for (vertex, point) in (0..).zip(&point_of).filter(|(vertex, _)| is_used[*vertex as usize]) {
            of_points[*point as usize].push(vertex);
        }
        let mut starts = vec![0];
        let mut vertices = Vec::with_capacity(count);
        for of_point in &of_points {
            vertices.extend_from_slice(of_point);
            starts.push(vertices.len() as u32);
        }
        let mut stars = vec![Vec::new(); points.len()];
        for (number, triangle) in (0..).zip(&triangles) {
            triangle.iter().for_each(|v| stars[point_of[*v as usize] as usize].push(number));
        }
        let is_left = vec![true; triangles.len()];
        Self { triangles, is_left, point_of, stars, places, poses, starts, vertices }
    }

    /// Number of triangles around a point.
    pub(super) fn degree(&self, point: u32) -> usize {
        self.stars[point as usize].len()
    }

    pub(super) fn point_count(&self) -> usize {
        self.stars.len()
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Those that are left.
    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.triangles.iter().zip(&self.is_left).filter(|(_, is_left)| **is_left).map(|(t, _)| *t)
    }

    pub(super) fn corners(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize]
    }

    pub(super) fn point_of(&self, vertex: u32) -> u32 {
        self.point_of[vertex as usize]
    }

    pub(super) fn vertices_of(&self, point: u32) -> &[u32] {
        let [start, end] = [point, point + 1].map(|place| self.starts[place as usize] as usize);
        &self.vertices[start..end]
    }

    /// The places of a vertex in the poses.
    pub(super) fn places_of(&self, vertex: u32) -> &[Vec3] {
        let first = self.point_of(vertex) as usize * self.poses;
        &self.places[first..first + self.poses]
    }

    /// The place of a vertex in the first pose.
    pub(super) fn place_of(&self, vertex: u32) -> Vec3 {
        self.places[self.point_of(vertex) as usize * self.poses]
    }

    pub(super) fn distance(&self, a: u32, b: u32) -> f32 {
        self.places[a as usize * self.poses].distance(self.places[b as usize * self.poses])
    }

    pub(super) fn around(&self, point: u32) -> impl Iterator<Item = Around> + '_ {
        self.stars[point as usize].iter().filter_map(move |&triangle| {
            let corners = self.triangles[triangle as usize];
            let at = corners.iter().position(|vertex| self.point_of(*vertex) == point)?;
            let [vertex, next, last] = [0, 1, 2].map(|step| corners[(at + step) % 3]);
            Some(Around { triangle, vertex, others: [next, last] })
        })
    }

    /// The points that share an edge with this one, each once.
    pub(super) fn neighbours(&self, point: u32) -> Vec<u32> {
        let others = self.around(point).flat_map(|around| around.others);
        let mut points: Vec<u32> = others.map(|vertex| self.point_of(vertex)).collect();
        points.sort_unstable();
        points.dedup();
        points
    }

    /// Whether an edge is a border, a cut of attributes, or the edge of more than two triangles; `false` of
    /// what is no edge.
    pub(super) fn is_cut(&self, a: u32, b: u32) -> bool {
        let mut sides = self.around(a).filter_map(|around| {
            let other = around.others.into_iter().find(|other| self.point_of(*other) == b)?;
            Some((around.vertex, other))
        });
        match (sides.next(), sides.next(), sides.next()) {
            (Some(one), Some(other), None) => one != other,
            (first, ..) => first.is_some(),
        }
    }

    /// Takes triangles away and gives others a new corner.
    pub(super) fn collapse(&mut self, point: u32, gone: &[u32], changed: &[(u32, u32, u32)]) {
        for &triangle in gone {
            self.is_left[triangle as usize] = false;
            for vertex in self.triangles[triangle as usize] {
                self.stars[self.point_of[vertex as usize] as usize].retain(|other| *other != triangle);
            }
        }
        for &(triangle, from, to) in changed {
            for corner in &mut self.triangles[triangle as usize] {
                if *corner == from {
                    *corner = to;
                }
            }
            self.stars[self.point_of[to as usize] as usize].push(triangle);
        }
        self.stars[point as usize] = Vec::new();
    }
}
