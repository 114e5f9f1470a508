//! Where the vertices of a mesh are on the GPU.

use avatar_mesh::{Mesh, Welded, weld_repeated};
use std::sync::Arc;

/// For each vertex of a mesh its place on the GPU, which stores vertices once that are alike to the bit: they
/// deform and draw alike. Files that repeat the corners of every triangle have several times as many vertices
/// as they need.
#[derive(Clone, Debug)]
pub(crate) enum Places {
    /// All of so many vertices have their own.
    Own(u32),
    Welded(Arc<[u32]>),
}

impl Places {
    /// The mesh that is uploaded, where it has fewer vertices.
    pub(crate) fn weld(mesh: &Mesh) -> (Option<Mesh>, Self) {
        match weld_repeated(mesh) {
            Some(Welded { mesh, welded_from_original }) => {
                (Some(mesh), Self::Welded(welded_from_original.into()))
            }
            None => (None, Self::Own(mesh.positions.len() as u32)),
        }
    }

    pub(crate) fn mesh_vertex_count(&self) -> u32 {
        match self {
            Self::Own(count) => *count,
            Self::Welded(places) => places.len() as u32,
        }
    }

    /// The place of a vertex of the mesh, if it has that vertex.
    pub(crate) fn get(&self, vertex: u32) -> Option<u32> {
        match self {
            Self::Own(count) => (vertex < *count).then_some(vertex),
            Self::Welded(places) => places.get(vertex as usize).copied(),
        }
    }

    /// What the GPU has of each of its vertices, in the order of the mesh.
    pub(crate) fn spread<'a, T>(&'a self, on_gpu: &'a [T]) -> impl Iterator<Item = &'a T> {
        (0..self.mesh_vertex_count()).filter_map(|vertex| on_gpu.get(self.get(vertex)? as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::device::gpu_for_tests;
    use crate::model::desc::{PartBones, PartDesc};
    use crate::model::geometry::Geometry;
    use avatar_mesh::PartKind;
    use glam::{Vec2, Vec3};

    /// Two triangles of a square, with and without corners in common.
    fn square(corners: &[Vec3], triangles: Vec<[u32; 3]>) -> Mesh {
        let count = corners.len();
        Mesh {
            positions: corners.to_vec(),
            normals: vec![Vec3::Z; count],
            uvs: vec![Vec2::ZERO; count],
            triangles,
            ..Mesh::default()
        }
    }

    #[test]
    fn vertices_that_are_alike_are_one_on_the_gpu() {
        let Some(gpu) = gpu_for_tests() else { return };
        let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y];
        let apart = square(&[a, b, c, c, b, d], vec![[0, 1, 2], [3, 4, 5]]);
        let shared = square(&[a, b, c, d], vec![[0, 1, 2], [2, 1, 3]]);
        let [apart, shared] = [apart, shared].map(|mesh| {
            let desc = PartDesc {
                label: "square",
                mesh: &mesh,
                first_weight: 0,
                kind: PartKind::Surface,
                bones: PartBones::Rigid(0),
                textures: Default::default(),
            };
            Geometry::new(&gpu.device, &Geometry::layout(&gpu.device), &desc, 1).expect("a square")
        });
        for (geometry, expected) in [(apart, &[0, 1, 2, 2, 1, 3][..]), (shared, &[0, 1, 2, 3])] {
            assert_eq!(geometry.vertex_count, 4);
            let places = &geometry.places;
            assert_eq!(places.mesh_vertex_count() as usize, expected.len());
            let found: Vec<_> = (0..expected.len() as u32).filter_map(|vertex| places.get(vertex)).collect();
            assert_eq!(found, expected);
            assert_eq!(places.get(expected.len() as u32), None);
            assert_eq!(places.spread(&[0, 1, 2, 3]).copied().collect::<Vec<_>>(), expected);
        }
    }
}
