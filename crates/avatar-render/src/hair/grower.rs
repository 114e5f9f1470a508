//! The passes that grow hair.

use crate::deform::pose::{Pose, avatar_layout};
use crate::gpu::pipeline::compute_pipeline;
use crate::hair::layouts::grow_layouts;
use crate::hair::programs::{GROW_PASS, swinging};
use crate::hair::state::HairState;
use crate::hair::swing::swing_pipeline;
use crate::hair::uniforms::GROW_WORKGROUP_SIZE;
use std::sync::OnceLock;

/// The passes that grow hair in every frame. [`Grower::run`] reads their results back.
#[derive(Debug)]
pub struct Grower {
    device: wgpu::Device,
    /// Made for the first hair that grows: most of the time until a bald face is drawn is compilation.
    built: OnceLock<Pipelines>,
}

#[derive(Debug)]
struct Pipelines {
    still: wgpu::ComputePipeline,
    swinging: wgpu::ComputePipeline,
    swing: wgpu::ComputePipeline,
}

impl Grower {
    /// The pipelines are built when the first hair grows.
    pub fn new(device: &wgpu::Device) -> Self {
        Self { device: device.clone(), built: OnceLock::new() }
    }

    #[cfg(test)]
    pub(crate) fn is_built(&self) -> bool {
        self.built.get().is_some()
    }

    /// Grows the given numbers of strands on the deformed skins of avatars.
    pub(crate) fn record<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
        growing: impl Iterator<Item = (&'a Pose, &'a HairState, u32)> + Clone,
    ) {
        if growing.clone().next().is_none() {
            return;
        }
        let pipelines = self.built.get_or_init(|| Pipelines::new(&self.device));
        // Growth reads textures: what earlier passes wrote to buffers is copied in between.
        growing.clone().for_each(|(_, hair, _)| hair.take_skin(encoder));
        let (start, end) = match timestamps {
            Some(times) => (
                Some(wgpu::ComputePassTimestampWrites { end_of_pass_write_index: None, ..times.clone() }),
                Some(wgpu::ComputePassTimestampWrites { beginning_of_pass_write_index: None, ..times }),
            ),
            None => (None, None),
        };
        let mut pass = compute_pass(encoder, "grow guides of hair", start);
        for (pose, hair, _) in growing.clone() {
            pass.set_pipeline(&pipelines.still);
            dispatch(&mut pass, pose, hair, &hair.grow_guides, hair.guide_count);
            hair.swing.record(&mut pass, &pipelines.swing);
        }
        drop(pass);
        growing.clone().for_each(|(_, hair, _)| hair.take_guides(encoder));
        let mut pass = compute_pass(encoder, GROW_PASS.label, end);
        for (pose, hair, strands) in growing {
            pass.set_pipeline(if hair.swing.is_moving() { &pipelines.swinging } else { &pipelines.still });
            dispatch(&mut pass, pose, hair, &hair.grow, strands);
        }
    }
}

impl Pipelines {
    fn new(device: &wgpu::Device) -> Self {
        let [hair, skin] = grow_layouts(device);
        let pipeline = |is_swinging| {
            let groups = [&hair, &avatar_layout(device), &skin];
            compute_pipeline(device, &GROW_PASS, &groups, &[swinging(is_swinging)])
        };
        Self { still: pipeline(false), swinging: pipeline(true), swing: swing_pipeline(device) }
    }
}

fn compute_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'_>>,
) -> wgpu::ComputePass<'a> {
    encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes })
}

fn dispatch(
    pass: &mut wgpu::ComputePass<'_>,
    pose: &Pose,
    hair: &HairState,
    grown: &wgpu::BindGroup,
    strands: u32,
) {
    pass.set_bind_group(0, grown, &[]);
    pass.set_bind_group(1, &pose.bind_group, &[]);
    pass.set_bind_group(2, &hair.skin, &[]);
    pass.dispatch_workgroups(strands.div_ceil(GROW_WORKGROUP_SIZE), 1, 1);
}
