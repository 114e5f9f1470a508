//! Meshes from formats whose normals and texture coordinates belong to corners of faces, and whose weights
//! and shapes belong to points: corners that agree become one vertex.

use super::budget::{Budget, Exceeded};
use super::influences::Influences;
use super::normals::{NormalSums, Weighting};
use avatar_mesh::{Mesh, Offsets, Shape, Skinning};
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;
use std::hash::BuildHasher;

/// One corner of a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Corner {
    /// The point of the file's mesh.
    pub(crate) point: u32,
    /// Texture coordinates, origin top left.
    pub(crate) uv: Vec2,
    /// Without: as the triangles around the point say.
    pub(crate) normal: Option<Vec3>,
    /// Empty (w = 0) where the file has none.
    pub(crate) tangent: Vec4,
    /// Second texture coordinates, if the file has some.
    pub(crate) uv_1: Option<Vec2>,
    /// Linear colour and opacity. Without: white.
    pub(crate) color: Option<Vec4>,
}

impl Corner {
    /// Equal for corners that become one vertex.
    fn bits(&self) -> [u32; 16] {
        const NONE: u32 = u32::MAX;
        let mut bits = [NONE; 16];
        let [point, rest @ ..] = &mut bits;
        *point = self.point;
        let (uv, rest) = rest.split_at_mut(2);
        let (normal, rest) = rest.split_at_mut(3);
        let (tangent, rest) = rest.split_at_mut(4);
        let (uv_1, color) = rest.split_at_mut(2);
        uv.copy_from_slice(&self.uv.to_array().map(f32::to_bits));
        tangent.copy_from_slice(&self.tangent.to_array().map(f32::to_bits));
        if let Some(value) = self.normal {
            normal.copy_from_slice(&value.to_array().map(f32::to_bits));
        }
        if let Some(value) = self.uv_1 {
            uv_1.copy_from_slice(&value.to_array().map(f32::to_bits));
        }
        if let Some(value) = self.color {
            color.copy_from_slice(&value.to_array().map(f32::to_bits));
        }
        bits
    }
}

/// A mesh in the making.
#[derive(Debug, Default)]
pub(crate) struct Corners {
    /// By the hash of a corner's bits, the last vertex that has it. Keys of all bits would take more memory
    /// than the vertices.
    known: HashMap<u64, u32>,
    /// For each vertex, the one before it with the same hash.
    earlier: Vec<Option<u32>>,
    /// The vertices, each a corner that stands for all like it.
    pub(crate) vertices: Vec<Corner>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Corners {
    /// Adds a triangle.
    pub(crate) fn triangle(&mut self, corners: [Corner; 3]) {
        let triangle = corners.map(|corner| self.vertex(corner));
        self.triangles.push(triangle);
    }

    fn vertex(&mut self, corner: Corner) -> u32 {
        let bits = corner.bits();
        let hash = self.known.hasher().hash_one(bits);
        let last = self.known.get(&hash).copied();
        let mut candidate = last;
        while let Some(vertex) = candidate {
            if self.vertices.get(vertex as usize).is_some_and(|known| known.bits() == bits) {
                return vertex;
            }
            candidate = self.earlier.get(vertex as usize).copied().flatten();
        }
        let vertex = self.vertices.len() as u32;
        self.vertices.push(corner);
        self.earlier.push(last);
        self.known.insert(hash, vertex);
        vertex
    }

    /// Whether some normals are to be computed.
    pub(crate) fn lacks_normals(&self) -> bool {
        self.vertices.iter().any(|vertex| vertex.normal.is_none())
    }

    /// Whether there is nothing to draw.
    pub(crate) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The mesh, with tangents where all corners have one, second texture coordinates where some have them,
    /// and colours where some are not white. Points beyond `points` were checked before.
    pub(crate) fn mesh(&self, points: &[Vec3]) -> Mesh {
        let point = |corner: &Corner| points.get(corner.point as usize).copied().unwrap_or_default();
        let smooth = if self.lacks_normals() { self.smooth_normals(points) } else { HashMap::new() };
        let normal = |corner: &Corner| match corner.normal {
            Some(normal) => normal,
            None => smooth.get(&corner.point).copied().unwrap_or(Vec3::Z),
        };
        let complete = self.vertices.iter().all(|corner| corner.tangent.w != 0.0);
        let tangents = self.vertices.iter().filter(|_| complete).map(|corner| corner.tangent);
        let has_second = self.vertices.iter().any(|corner| corner.uv_1.is_some());
        let seconds = self.vertices.iter().filter(|_| has_second).map(|corner| corner.uv_1);
        let color = |corner: &Corner| corner.color.unwrap_or(Vec4::ONE);
        let is_colored = self.vertices.iter().any(|corner| color(corner) != Vec4::ONE);
        Mesh {
            positions: self.vertices.iter().map(point).collect(),
            uvs_1: seconds.map(Option::unwrap_or_default).collect(),
            colors: self.vertices.iter().filter(|_| is_colored).map(color).collect(),
            uvs: self.vertices.iter().map(|corner| corner.uv).collect(),
            normals: self.vertices.iter().map(normal).collect(),
            tangents: tangents.collect(),
            triangles: self.triangles.clone(),
            ..Mesh::default()
        }
    }

    /// The bones of vertices: those of their points.
    pub(crate) fn skinning(&self, influences: &Influences) -> Skinning {
        influences.of_points(self.vertices.iter().map(|corner| corner.point as usize))
    }

    /// Normals of points, for corners that have none.
    fn smooth_normals(&self, points: &[Vec3]) -> HashMap<u32, Vec3> {
        let mut groups: HashMap<u32, u32> = HashMap::new();
        for corner in &self.vertices {
            let next = groups.len() as u32;
            groups.entry(corner.point).or_insert(next);
        }
        let mut sums = NormalSums::new(groups.len(), Weighting::Area);
        for triangle in &self.triangles {
            let at =
                triangle.map(|vertex| self.vertices.get(vertex as usize).map_or(0, |corner| corner.point));
            let positions = at.map(|at| points.get(at as usize).copied().unwrap_or_default());
            sums.add(positions, at.map(|at| groups.get(&at).copied().unwrap_or(u32::MAX)));
        }
        groups.into_iter().map(|(point, group)| (point, sums.normal(group))).collect()
    }

    /// A shape that moves vertices as it moves their points. `normals` are those of vertices.
    pub(crate) fn shape(
        &self,
        name: String,
        offsets: &HashMap<u32, Vec3>,
        normals: Option<Vec<Vec3>>,
        budget: &mut Budget,
    ) -> Result<Shape, Exceeded> {
        let moved = self.vertices.iter().enumerate();
        let pairs: Vec<(u32, Vec3)> = moved
            .filter_map(|(vertex, corner)| Some((vertex as u32, *offsets.get(&corner.point)?)))
            .collect();
        budget.take(pairs.len() + normals.as_ref().map_or(0, Vec::len), 1)?;
        // The vertices of pairs are in range and rise, so that no input makes this fail.
        let positions = Offsets::from_pairs(self.vertices.len(), pairs).unwrap_or_default();
        Ok(Shape { name, positions, normals: normals.map(Offsets::from_dense), tangents: None })
    }
}
