//! The triangles of a part that bones mirror, with their fronts outside again.
//!
//! Drawing decides by the order of corners what a front is, and a bone with a negative determinant reverses
//! the order that is seen. One part can have such bones and others, so each triangle is decided by its own
//! vertices, by a pass that only runs for parts with such bones.

use crate::gpu::bindings::storage_entry;
use crate::gpu::program::{Constant, Module, Program, Value};

/// WGSL of what the deform pass leaves, which the pass reads.
pub(crate) const DEFORMED: Module = Module::of(include_str!("shaders/deformed.wgsl"));

const REVERSE_WORKGROUP_SIZE: u32 = 64;
/// Workgroups in a row of a dispatch: WebGPU's default limit.
const ROW: u32 = 65_535;

const REVERSE: Module = Module { text: include_str!("shaders/reverse_pass.wgsl"), constants };

fn constants() -> Vec<Constant> {
    vec![("REVERSE_WORKGROUP_SIZE", Value::Count(REVERSE_WORKGROUP_SIZE))]
}

pub(crate) const REVERSE_PASS: Program = Program {
    label: "reverse mirrored triangles",
    entry: "reverse_main",
    fragment: None,
    modules: &[DEFORMED, REVERSE],
};

/// Layout of the pass's one group.
pub(crate) fn reversed_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let compute = wgpu::ShaderStages::COMPUTE;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("mirrored triangles"),
        entries: &[
            storage_entry(0, compute, true),
            storage_entry(1, compute, true),
            storage_entry(2, compute, false),
        ],
    })
}

/// The triangles of one part of one avatar.
#[derive(Debug)]
pub(crate) struct Reversed {
    pub(crate) indices: wgpu::Buffer,
    group: wgpu::BindGroup,
    triangles: u32,
}

impl Reversed {
    /// Room for the triangles of a part that has some, which are in `corners`. `vertices` are what the deform
    /// pass makes of it.
    pub(crate) fn new(
        device: &wgpu::Device,
        corners: &wgpu::Buffer,
        corner_count: u32,
        vertices: &wgpu::Buffer,
    ) -> Self {
        let indices = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("mirrored triangles"),
            size: corners.size(),
            usage: wgpu::BufferUsages::INDEX | wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let buffers = [vertices, corners, &indices];
        let entries: [_; 3] = std::array::from_fn(|binding| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource: buffers[binding].as_entire_binding(),
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("mirrored triangles"),
            layout: &reversed_layout(device),
            entries: &entries,
        });
        Self { indices, group, triangles: corner_count / 3 }
    }

    /// Fills the buffer. The pipeline is set.
    pub(crate) fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        let groups = self.triangles.div_ceil(REVERSE_WORKGROUP_SIZE);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
    }
}
