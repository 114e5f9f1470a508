//! Bone matrices on the GPU.

use glam::Affine3A;

/// WGSL `Bone`: the rows of a bone matrix.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuBone {
    pub(crate) rows: [[f32; 4]; 3],
}

impl GpuBone {
    pub(crate) fn new(posed_from_bind: &Affine3A) -> Self {
        let columns = posed_from_bind.matrix3.transpose();
        let t = posed_from_bind.translation;
        let row = |axes: glam::Vec3A, t: f32| [axes.x, axes.y, axes.z, t];
        Self { rows: [row(columns.x_axis, t.x), row(columns.y_axis, t.y), row(columns.z_axis, t.z)] }
    }
}
