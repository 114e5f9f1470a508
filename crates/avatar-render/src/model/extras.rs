//! What only some meshes have: second texture coordinates, and colours of vertices.

use crate::gpu::color::half_bits;
use avatar_mesh::Mesh;
use glam::Vec4;

/// Of one vertex.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuExtra {
    pub(crate) uv_1: [f32; 2],
    /// Bits of f16.
    pub(crate) color: [u16; 4],
}

/// Those of all vertices; `None` where the mesh has neither.
pub(crate) fn extras(mesh: &Mesh) -> Option<Vec<GpuExtra>> {
    if mesh.uvs_1.is_empty() && mesh.colors.is_empty() || mesh.positions.is_empty() {
        return None;
    }
    let extra = |vertex: usize| GpuExtra {
        uv_1: mesh.uvs_1.get(vertex).copied().unwrap_or_default().to_array(),
        color: mesh.colors.get(vertex).copied().unwrap_or(Vec4::ONE).to_array().map(half_bits),
    };
    Some((0..mesh.positions.len()).map(extra).collect())
}
