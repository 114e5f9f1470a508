//! Neighbours in a crowd whose vertices share buffers.

use crate::deform::posed::GpuDeformedVertex;
use crate::gpu::bindings::{storage_entry, uniform_entry};
use crate::gpu::program::Module;
use crate::model::part::ModelPart;
use wgpu::util::DeviceExt;

/// WGSL of a chunk.
pub(crate) const CROWD_CHUNK: Module = Module::of(include_str!("shaders/crowd_chunk.wgsl"));

/// WGSL `CrowdChunk`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuCrowdChunk {
    pub(crate) first_avatar: u32,
    pub(crate) vertex_count: u32,
    pub(crate) bone_count: u32,
    pub(crate) weight_stride: u32,
    pub(crate) rigid_bone: u32,
}

/// The avatars of a crowd that a pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Chosen {
    /// In view, from near to far.
    Drawn,
    /// The same from far to near.
    Blended,
    /// In view, or between a lamp and what is in view.
    Casting,
}

/// Buffers that all chunks of a crowd share: lists of avatars by what they are chosen for, and bones.
#[derive(Debug)]
pub(crate) struct CrowdBuffers {
    pub(crate) bones: wgpu::Buffer,
    pub(crate) weights: wgpu::Buffer,
    pub(crate) drawn: wgpu::Buffer,
    pub(crate) blended: wgpu::Buffer,
    pub(crate) casting: wgpu::Buffer,
    pub(crate) moved: wgpu::Buffer,
}

/// Some neighbours in a crowd, as many as fit into one buffer with the largest part.
#[derive(Debug)]
pub(crate) struct Chunk {
    pub(crate) first: usize,
    pub(crate) len: usize,
    pub(crate) parts: Vec<ChunkPart>,
    /// How many are in view.
    pub(crate) drawn: u32,
    /// How many of these and of others cast shadows.
    pub(crate) casting: u32,
    /// How many of those that cast shadows moved since they were deformed.
    pub(crate) moved: u32,
    /// Whether shapes wrinkle the skin of any that is in view.
    pub(crate) is_wrinkled: bool,
}

/// One part of all avatars of a chunk.
#[derive(Debug)]
pub(crate) struct ChunkPart {
    /// Group 0 of the deform pass.
    pub(crate) output: wgpu::BindGroup,
    /// Group 3 of the passes that draw.
    drawn: wgpu::BindGroup,
    blended: wgpu::BindGroup,
    casting: wgpu::BindGroup,
}

/// Layout of group 0 of the deform pass.
pub(crate) fn output_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let compute = wgpu::ShaderStages::COMPUTE;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("deformed vertices of a crowd"),
        entries: &[
            storage_entry(0, compute, false),
            uniform_entry(1, compute),
            storage_entry(2, compute, true),
        ],
    })
}

/// Layout of group 3 of the passes that draw.
pub(crate) fn crowd_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let vertex = wgpu::ShaderStages::VERTEX;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("crowd"),
        entries: &[
            storage_entry(0, vertex, true),
            uniform_entry(1, vertex),
            storage_entry(2, vertex, true),
            storage_entry(3, vertex, true),
        ],
    })
}

impl Chunk {
    /// Room for the deformed vertices of avatars `first` to `first + len`. `head` is what all its parts have
    /// in common.
    pub(crate) fn new(
        device: &wgpu::Device,
        parts: &[ModelPart],
        buffers: &CrowdBuffers,
        [first, len]: [usize; 2],
        head: GpuCrowdChunk,
    ) -> Self {
        let layouts = [output_layout(device), crowd_layout(device)];
        let head = GpuCrowdChunk { first_avatar: first as u32, ..head };
        let part = |part: &ModelPart| ChunkPart::new(device, &layouts, part, buffers, len, head);
        let parts = parts.iter().map(part).collect();
        Self { first, len, parts, drawn: 0, casting: 0, moved: 0, is_wrinkled: false }
    }
}

impl Chunk {
    /// How many avatars are chosen.
    pub(crate) fn count(&self, chosen: Chosen) -> u32 {
        match chosen {
            Chosen::Drawn | Chosen::Blended => self.drawn,
            Chosen::Casting => self.casting,
        }
    }
}

impl ChunkPart {
    fn new(
        device: &wgpu::Device,
        [output_layout, crowd_layout]: &[wgpu::BindGroupLayout; 2],
        part: &ModelPart,
        buffers: &CrowdBuffers,
        avatars: usize,
        head: GpuCrowdChunk,
    ) -> Self {
        let label = Some(part.label.as_str());
        let (vertex_count, rigid_bone) = (part.geometry.vertex_count, part.geometry.rigid_bone);
        let vertices = device.create_buffer(&wgpu::BufferDescriptor {
            label,
            size: avatars.max(1) as u64 * bytes_of(part),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let chunk = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label,
            contents: bytemuck::bytes_of(&GpuCrowdChunk { vertex_count, rigid_bone, ..head }),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let group = |layout, buffers: &[&wgpu::Buffer]| {
            let all = buffers.iter().enumerate().map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding: binding as u32,
                resource: buffer.as_entire_binding(),
            });
            let entries: Vec<_> = all.collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout, entries: &entries })
        };
        Self {
            output: group(output_layout, &[&vertices, &chunk, &buffers.moved]),
            drawn: group(crowd_layout, &[&vertices, &chunk, &buffers.drawn, &buffers.bones]),
            blended: group(crowd_layout, &[&vertices, &chunk, &buffers.blended, &buffers.bones]),
            casting: group(crowd_layout, &[&vertices, &chunk, &buffers.casting, &buffers.bones]),
        }
    }

    /// Group 3 of a pass that draws.
    pub(crate) fn group(&self, chosen: Chosen) -> &wgpu::BindGroup {
        match chosen {
            Chosen::Drawn => &self.drawn,
            Chosen::Blended => &self.blended,
            Chosen::Casting => &self.casting,
        }
    }
}

/// Bytes of a part's deformed vertices, of each avatar.
pub(crate) fn bytes_of(part: &ModelPart) -> u64 {
    u64::from(part.geometry.vertex_count.max(1)) * size_of::<GpuDeformedVertex>() as u64
}
