//! Blend shapes that are not at rest, on the GPU.

/// WGSL `ActiveShape`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuActiveShape {
    pub(crate) index: u32,
    pub(crate) weight: f32,
}

impl GpuActiveShape {
    /// What stands before so many shapes of an avatar.
    pub(crate) fn head(count: usize) -> Self {
        Self { index: count as u32, weight: 0.0 }
    }
}
