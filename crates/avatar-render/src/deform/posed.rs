//! Deformed parts: the deform pass writes their vertices, and all other passes draw from them.

use crate::gpu::bindings::storage_entry;
use crate::model::part::ModelPart;

/// WGSL `DeformedVertex`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuDeformedVertex {
    pub(crate) position: [f32; 3],
    pub(crate) pad_0: f32,
    pub(crate) normal: [f32; 3],
    pub(crate) pad_1: f32,
}

/// Layout of group 0 of the deform pass: where its results go.
pub(crate) fn deformed_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("deformed vertices"),
        entries: &[storage_entry(0, wgpu::ShaderStages::COMPUTE, false)],
    })
}

/// A deformed part on the GPU.
#[derive(Debug)]
pub(crate) struct PosedPart {
    pub(crate) vertex_count: u32,
    /// [`GpuDeformedVertex`] per vertex.
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) output: wgpu::BindGroup,
}

impl PosedPart {
    pub(crate) fn new(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, part: &ModelPart) -> Self {
        let vertex_count = part.geometry.vertex_count;
        let vertices = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(&format!("{}: deformed vertices", part.label)),
            // WebGPU binds no empty buffers.
            size: u64::from(vertex_count.max(1)) * size_of::<GpuDeformedVertex>() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let output = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&format!("{}: deformed vertices", part.label)),
            layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: vertices.as_entire_binding() }],
        });
        Self { vertex_count, vertices, output }
    }
}
