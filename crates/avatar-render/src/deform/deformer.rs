//! The pass that deforms avatars.

use crate::deform::pose::{AVATAR, Pose, avatar_layout};
use crate::deform::posed::deformed_layout;
use crate::gpu::pipeline::compute_pipeline;
use crate::gpu::program::{Constant, Module, Program, Value};
use crate::model::geometry::Geometry;
use crate::model::part::ModelPart;
use crate::model::shape_blocks::{PART, SHAPE_BLOCK};
use avatar_mesh::MIN_NORMAL_LENGTH;

/// Vertices per workgroup: one block of blend shapes. With WebGPU's default limits, one row of workgroups
/// covers the largest binding of vertices except for one block; larger parts are refused.
pub(crate) const DEFORM_WORKGROUP_SIZE: u32 = SHAPE_BLOCK;

const DEFORM: Module = Module { text: include_str!("shaders/deform.wgsl"), constants };

fn constants() -> Vec<Constant> {
    vec![
        ("MIN_NORMAL_LENGTH", Value::Float(MIN_NORMAL_LENGTH)),
        ("DEFORM_WORKGROUP_SIZE", Value::Count(DEFORM_WORKGROUP_SIZE)),
    ]
}

pub(crate) const DEFORM_PASS: Program = Program {
    label: "deform",
    entry: "deform_main",
    fragment: None,
    modules: &[AVATAR, PART, DEFORM, Module::of(include_str!("shaders/deform_pass.wgsl"))],
};

/// The pass that deforms avatars, the first one of every frame. [`Deformer::run`] reads its results back.
#[derive(Debug)]
pub struct Deformer {
    pipeline: wgpu::ComputePipeline,
}

impl Deformer {
    /// Builds the pipeline.
    pub fn new(device: &wgpu::Device) -> Self {
        let groups = [&deformed_layout(device), &avatar_layout(device), &Geometry::layout(device)];
        Self { pipeline: compute_pipeline(device, &DEFORM_PASS, &groups, &[]) }
    }

    /// Deforms all parts of avatars into the buffers of their poses.
    pub(crate) fn record<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
        avatars: impl Iterator<Item = (&'a [ModelPart], &'a Pose)>,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("deform"),
            timestamp_writes: timestamps,
        });
        pass.set_pipeline(&self.pipeline);
        for (parts, pose) in avatars {
            pass.set_bind_group(1, &pose.bind_group, &[]);
            for (part, posed) in parts.iter().zip(&pose.parts) {
                if part.geometry.vertex_count > 0 {
                    let groups = part.geometry.vertex_count.div_ceil(DEFORM_WORKGROUP_SIZE);
                    pass.set_bind_group(0, &posed.output, &[]);
                    pass.set_bind_group(2, &part.geometry.bind_group, &[]);
                    pass.dispatch_workgroups(groups, 1, 1);
                }
            }
        }
    }
}
