//! Meshes from formats whose normals and texture coordinates belong to corners of faces, and whose weights
//! and shapes belong to points: corners that agree become one vertex.

use super::budget::{Budget, Exceeded};
use super::influences::Influences;
use super::normals::{NormalSums, Weighting};
use avatar_mesh::{Mesh, Offsets, Shape, Skinning};
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;

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
}

/// A mesh in the making.
#[derive(Debug, Default)]
pub(crate) struct Corners {
    known: HashMap<[u32; 10], u32>,
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
        let normal = corner.normal.map_or([u32::MAX; 3], |normal| normal.to_array().map(f32::to_bits));
        let uv = corner.uv.to_array().map(f32::to_bits);
        let tangent = corner.tangent.to_array().map(f32::to_bits);
        let key = [
            corner.point,
            uv[0],
            uv[1],
            normal[0],
            normal[1],
            normal[2],
            tangent[0],
            tangent[1],
            tangent[2],
            tangent[3],
        ];
        let vertices = &mut self.vertices;
        *self.known.entry(key).or_insert_with(|| {
            vertices.push(corner);
            (vertices.len() - 1) as u32
        })
    }

    /// Whether some normals are to be computed.
    pub(crate) fn lacks_normals(&self) -> bool {
        self.vertices.iter().any(|vertex| vertex.normal.is_none())
    }

    /// Whether there is nothing to draw.
    pub(crate) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The mesh, with tangents where all corners have one. Points beyond `points` were checked before.
    pub(crate) fn mesh(&self, points: &[Vec3]) -> Mesh {
        let point = |corner: &Corner| points.get(corner.point as usize).copied().unwrap_or_default();
        let smooth = if self.lacks_normals() { self.smooth_normals(points) } else { HashMap::new() };
        let normal = |corner: &Corner| match corner.normal {
            Some(normal) => normal,
            None => smooth.get(&corner.point).copied().unwrap_or(Vec3::Z),
        };
        let complete = self.vertices.iter().all(|corner| corner.tangent.w != 0.0);
        let tangents = self.vertices.iter().filter(|_| complete).map(|corner| corner.tangent);
        Mesh {
            positions: self.vertices.iter().map(point).collect(),
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
