//! Bone matrices on the GPU.

use avatar_mesh::Bounds;
use glam::{Affine3A, Vec3, Vec4};

/// WGSL `Bone`: the rows of a bone matrix.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuBone {
    pub(crate) rows: [[f32; 4]; 3],
}

impl GpuBone {
    /// The box around a box that this bone moves.
    pub(crate) fn moved(&self, bounds: Bounds) -> Bounds {
        let (center, half) = (bounds.center().extend(1.0), (bounds.size() * 0.5).extend(0.0));
        let center = Vec3::from_array(self.rows.map(|row| center.dot(row.into())));
        let half = Vec3::from_array(self.rows.map(|row| half.dot(Vec4::from(row).abs())));
        Bounds { min: center - half, max: center + half }
    }

    pub(crate) fn new(posed_from_bind: &Affine3A) -> Self {
        let columns = posed_from_bind.matrix3.transpose();
        let t = posed_from_bind.translation;
        let row = |axes: glam::Vec3A, t: f32| [axes.x, axes.y, axes.z, t];
        Self { rows: [row(columns.x_axis, t.x), row(columns.y_axis, t.y), row(columns.z_axis, t.z)] }
    }
}
