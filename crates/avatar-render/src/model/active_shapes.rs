//! Blend shapes that are not at rest, on the GPU.

/// WGSL `ActiveShapes` up to its array.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuActiveShapesHead {
    pub(crate) count: u32,
}

/// WGSL `ActiveShape`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuActiveShape {
    pub(crate) index: u32,
    pub(crate) weight: f32,
}
