//! The pass that deforms avatars.

use crate::deform::crowd_chunk::{CROWD_CHUNK, output_layout};
use crate::deform::crowd_pose::CrowdPose;
use crate::deform::pose::{AVATAR, Pose, avatar_layout};
use crate::deform::posed::{PosedPart, deformed_layout};
use crate::deform::reversed::{DEFORMED, REVERSE_PASS, reversed_layout};
use crate::gpu::pipeline::compute_pipeline;
use crate::gpu::program::{Constant, Module, Program, Value};
use crate::model::geometry::Geometry;
use crate::model::part::ModelPart;
use crate::model::shape_blocks::{PART, SHAPE_BLOCK};
use avatar_mesh::MIN_NORMAL_LENGTH;
use std::sync::OnceLock;

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
    modules: &[AVATAR, PART, DEFORMED, DEFORM, Module::of(include_str!("shaders/deform_pass.wgsl"))],
};

pub(crate) const DEFORM_CROWD_PASS: Program = Program {
    label: "deform a crowd",
    entry: "deform_crowd_main",
    fragment: None,
    modules: &[
        AVATAR,
        PART,
        DEFORMED,
        CROWD_CHUNK,
        DEFORM,
        Module::of(include_str!("shaders/deform_crowd.wgsl")),
    ],
};

/// What a program of the pass can do. What a part does not need costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Ability {
    /// Eight bones a vertex instead of four.
    pub(crate) has_further_bones: bool,
    /// Bones that scale unevenly, shear or mirror.
    pub(crate) is_uneven: bool,
}

impl Ability {
    pub(crate) fn choices(self) -> [Constant; 2] {
        let sets = if self.has_further_bones { 2 } else { 1 };
        [("BONE_SETS", Value::Count(sets)), ("UNEVEN", Value::Flag(self.is_uneven))]
    }
}

/// The pass that deforms avatars, the first one of every frame. [`Deformer::run`] reads its results back.
#[derive(Debug)]
pub struct Deformer {
    /// Of four bones a vertex that turn evenly: the usual case.
    usual: wgpu::ComputePipeline,
    /// The others, made for the first frame that needs them.
    others: [OnceLock<wgpu::ComputePipeline>; 3],
    reverse: OnceLock<wgpu::ComputePipeline>,
    /// Of crowds, made for the first one.
    crowds: [OnceLock<wgpu::ComputePipeline>; 4],
    device: wgpu::Device,
}

impl Deformer {
    /// Builds the pipeline.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            usual: pipeline(device, Ability::default()),
            others: Default::default(),
            reverse: OnceLock::new(),
            crowds: Default::default(),
            device: device.clone(),
        }
    }

    fn pipeline(&self, ability: Ability) -> &wgpu::ComputePipeline {
        let other = match (ability.has_further_bones, ability.is_uneven) {
            (false, false) => return &self.usual,
            (true, false) => 0,
            (false, true) => 1,
            (true, true) => 2,
        };
        self.others[other].get_or_init(|| pipeline(&self.device, ability))
    }

    /// Deforms those avatars of crowds that moved.
    pub(crate) fn record_crowds<'a>(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        crowds: impl Iterator<Item = (&'a [ModelPart], &'a CrowdPose)>,
    ) {
        for (parts, pose) in crowds {
            pass.set_bind_group(1, &pose.bind_group, &[]);
            for (index, part) in parts.iter().enumerate().filter(|(_, part)| part.geometry.vertex_count > 0) {
                let ability = Ability {
                    has_further_bones: part.geometry.has_further_bones,
                    is_uneven: pose.is_uneven(),
                };
                let place = usize::from(ability.has_further_bones) + 2 * usize::from(ability.is_uneven);
                let built = || crowd_pipeline(&self.device, ability);
                let groups = part.geometry.vertex_count.div_ceil(DEFORM_WORKGROUP_SIZE);
                let mut is_set = false;
                for chunk in pose.chunks.iter().filter(|chunk| chunk.moved > 0) {
                    let Some(own) = chunk.parts.get(index) else { continue };
                    if !std::mem::replace(&mut is_set, true) {
                        pass.set_pipeline(self.crowds[place].get_or_init(built));
                        pass.set_bind_group(2, &part.geometry.bind_group, &[]);
                    }
                    pass.set_bind_group(0, &own.output, &[]);
                    pass.dispatch_workgroups(groups, chunk.moved, 1);
                }
            }
        }
    }

    /// Deforms all parts of those avatars that moved since they were deformed, into the buffers of their
    /// poses. Returns their number, without those of crowds.
    pub(crate) fn record<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
        avatars: impl Iterator<Item = (&'a [ModelPart], &'a Pose)>,
        crowds: impl Iterator<Item = (&'a [ModelPart], &'a CrowdPose)>,
    ) -> usize {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("deform"),
            timestamp_writes: timestamps,
        });
        let mut set = None;
        let mut moved = 0;
        for (parts, pose) in avatars.filter(|(_, pose)| pose.take_moved()) {
            moved += 1;
            pass.set_bind_group(1, &pose.bind_group, &[]);
            for (part, posed) in parts.iter().zip(&pose.parts) {
                if part.geometry.vertex_count > 0 {
                    let ability = Ability {
                        has_further_bones: part.geometry.has_further_bones,
                        is_uneven: !posed.is_even,
                    };
                    if set != Some(ability) {
                        pass.set_pipeline(self.pipeline(ability));
                        set = Some(ability);
                    }
                    let groups = part.geometry.vertex_count.div_ceil(DEFORM_WORKGROUP_SIZE);
                    pass.set_bind_group(0, &posed.output, &[]);
                    pass.set_bind_group(2, &part.geometry.bind_group, &[]);
                    pass.dispatch_workgroups(groups, 1, 1);
                }
            }
            for reversed in pose.parts.iter().filter_map(PosedPart::reversed) {
                pass.set_pipeline(self.reverse.get_or_init(|| reverse_pipeline(&self.device)));
                set = None;
                reversed.record(&mut pass);
            }
        }
        self.record_crowds(&mut pass, crowds);
        moved
    }
}

fn reverse_pipeline(device: &wgpu::Device) -> wgpu::ComputePipeline {
    compute_pipeline(device, &REVERSE_PASS, &[&reversed_layout(device)], &[])
}

fn pipeline(device: &wgpu::Device, ability: Ability) -> wgpu::ComputePipeline {
    let groups = [&deformed_layout(device), &avatar_layout(device), &Geometry::layout(device)];
    compute_pipeline(device, &DEFORM_PASS, &groups, &ability.choices())
}

fn crowd_pipeline(device: &wgpu::Device, ability: Ability) -> wgpu::ComputePipeline {
    let groups = [&output_layout(device), &avatar_layout(device), &Geometry::layout(device)];
    compute_pipeline(device, &DEFORM_CROWD_PASS, &groups, &ability.choices())
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "tests stop at the first surprise")]
mod tests {
    use super::*;
    use crate::gpu::device::gpu_for_tests;
    use glam::Affine3A;
    use std::iter;

    #[test]
    fn what_did_not_move_is_not_deformed_again() {
        let Some(gpu) = gpu_for_tests() else { return };
        let deformer = Deformer::new(&gpu.device);
        let mut poses = [(); 2].map(|()| Pose::new(&gpu.device, &[], 1, 1));
        let deformed = |poses: &[Pose; 2]| {
            let label = Some("test");
            let described = wgpu::CommandEncoderDescriptor { label };
            let mut encoder = gpu.device.create_command_encoder(&described);
            // Twice in one frame is once.
            let all = poses.iter().chain(poses).map(|pose| (&[][..], pose));
            let count = deformer.record(&mut encoder, None, all, iter::empty());
            gpu.queue.submit([encoder.finish()]);
            count
        };
        assert_eq!(deformed(&poses), 2, "new ones have moved");
        assert_eq!(deformed(&poses), 0);
        poses[1].set(&gpu.queue, &[Affine3A::IDENTITY], &[0.5]).expect("one bone, one weight");
        assert_eq!(deformed(&poses), 1);
        let wrong = poses[0].set(&gpu.queue, &[], &[0.5]);
        assert_eq!(wrong, Err(crate::StateError::BoneCount { expected: 1, found: 0 }));
        assert_eq!(deformed(&poses), 0, "what is refused moves nothing");
    }
}
