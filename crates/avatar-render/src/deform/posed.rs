//! Deformed parts: the deform pass writes their vertices, and all other passes draw from them.

use crate::deform::reversed::Reversed;
use crate::gpu::bindings::storage_entry;
use crate::model::part::ModelPart;
use avatar_mesh::{mirrors, turns_evenly};
use glam::Affine3A;
use std::sync::Arc;

/// WGSL `DeformedVertex`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuDeformedVertex {
    pub(crate) position: [f32; 3],
    pub(crate) is_mirrored: u32,
    pub(crate) normal: [f32; 3],
    pub(crate) wrinkled: f32,
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
    /// Whether each bone that moves the part turns normals as it turns everything.
    pub(crate) is_even: bool,
    is_mirrored: bool,
    /// The bones that move the part.
    used_bones: Arc<[u32]>,
    indices: wgpu::Buffer,
    index_count: u32,
    /// Made for the first pose in which a bone mirrors the part.
    reversed: Option<Reversed>,
}

/// What a bone does to normals and fronts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    /// A rotation with one scale for all directions.
    Even,
    /// It scales unevenly or shears.
    Uneven,
    /// It makes a left hand of a right one.
    Mirroring,
}

impl Turn {
    pub(crate) fn of(bone: &Affine3A) -> Self {
        match (turns_evenly(bone), mirrors(bone)) {
            (true, _) => Self::Even,
            (false, true) => Self::Mirroring,
            (false, false) => Self::Uneven,
        }
    }
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
        Self {
            vertex_count,
            vertices,
            output,
            is_even: true,
            is_mirrored: false,
            used_bones: part.geometry.used_bones.clone(),
            indices: part.geometry.indices.clone(),
            index_count: part.geometry.index_count,
            reversed: None,
        }
    }

    /// Takes in what the bones of the palette do. Allocates nothing, but for the first time that a bone
    /// mirrors this part.
    pub(crate) fn set_turns(&mut self, device: &wgpu::Device, turns: &[Turn]) {
        let has = |wanted: fn(&Turn) -> bool| {
            let mut used = self.used_bones.iter().filter_map(|bone| turns.get(*bone as usize));
            used.any(wanted)
        };
        self.is_even = !has(|turn| *turn != Turn::Even);
        self.is_mirrored = self.index_count > 0 && has(|turn| *turn == Turn::Mirroring);
        if self.is_mirrored && self.reversed.is_none() {
            self.reversed = Some(Reversed::new(device, &self.indices, self.index_count, &self.vertices));
        }
    }

    /// The triangles to draw instead of those of the geometry, where bones mirror some.
    pub(crate) fn reversed(&self) -> Option<&Reversed> {
        self.reversed.as_ref().filter(|_| self.is_mirrored)
    }
}
