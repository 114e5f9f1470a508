//! The passes that grow hair.

use crate::deform::pose::{Pose, avatar_layout};
use crate::gpu::pipeline::compute_pipeline;
use crate::hair::layouts::grow_layouts;
use crate::hair::programs::{GROW_PASS, swinging};
use crate::hair::state::HairState;
use crate::hair::swing::swing_pipeline;
use crate::hair::uniforms::GROW_WORKGROUP_SIZE;
use std::sync::OnceLock;

/// The passes that grow hair on what moved. [`Grower::run`] reads their results back.
#[derive(Debug)]
pub struct Grower {
    device: wgpu::Device,
    /// Made for the first hair that grows: most of the time until a bald face is drawn is compilation.
    still: OnceLock<wgpu::ComputePipeline>,
    /// Made for the first hair that swings.
    swinging: OnceLock<wgpu::ComputePipeline>,
    swing: OnceLock<wgpu::ComputePipeline>,
}

impl Grower {
    /// The pipelines are built when the first hair grows, and when the first one swings.
    pub fn new(device: &wgpu::Device) -> Self {
        let device = device.clone();
        Self { device, still: OnceLock::new(), swinging: OnceLock::new(), swing: OnceLock::new() }
    }

    /// Grows hair that hangs still.
    pub(crate) fn still(&self) -> &wgpu::ComputePipeline {
        self.still.get_or_init(|| self.pipeline(false))
    }

    fn swinging(&self) -> &wgpu::ComputePipeline {
        self.swinging.get_or_init(|| self.pipeline(true))
    }

    fn swing(&self) -> &wgpu::ComputePipeline {
        self.swing.get_or_init(|| swing_pipeline(&self.device))
    }

    fn pipeline(&self, is_swinging: bool) -> wgpu::ComputePipeline {
        let [hair, skin] = grow_layouts(&self.device);
        let groups = [&hair, &avatar_layout(&self.device), &skin];
        compute_pipeline(&self.device, &GROW_PASS, &groups, &[swinging(is_swinging)])
    }

    #[cfg(test)]
    pub(crate) fn is_built(&self) -> bool {
        self.still.get().is_some()
    }

    /// Grows those of the given strands that are not where the pose and their swinging want them, and takes
    /// them for grown from then on. Returns for how many avatars.
    pub(crate) fn record_due<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
        wanted: impl Iterator<Item = (&'a Pose, &'a HairState, u32)> + Clone,
    ) -> usize {
        let due = wanted.filter(|(_, hair, strands)| hair.must_grow(*strands));
        let count = due.clone().count();
        self.record(encoder, timestamps, due.clone());
        due.for_each(|(_, hair, strands)| hair.set_grown(strands));
        count
    }

    /// Grows the given numbers of strands on the deformed skins of avatars.
    pub(crate) fn record<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
        growing: impl Iterator<Item = (&'a Pose, &'a HairState, u32)> + Clone,
    ) {
        if growing.clone().next().is_none() {
            // The times are read all the same.
            if timestamps.is_some() {
                drop(compute_pass(encoder, GROW_PASS.label, timestamps));
            }
            return;
        }
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
            pass.set_pipeline(self.still());
            dispatch(&mut pass, pose, hair, &hair.grow_guides, hair.guide_count);
            hair.swing.record(&mut pass, || self.swing());
        }
        drop(pass);
        growing.clone().for_each(|(_, hair, _)| hair.take_guides(encoder));
        let mut pass = compute_pass(encoder, GROW_PASS.label, end);
        for (pose, hair, strands) in growing {
            pass.set_pipeline(if hair.swing.is_moving() { self.swinging() } else { self.still() });
            dispatch(&mut pass, pose, hair, &hair.grow, strands);
        }
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

#[cfg(test)]
#[allow(clippy::expect_used, reason = "tests stop at the first surprise")]
mod tests {
    use super::*;
    use crate::gpu::device::gpu_for_tests;
    use crate::gpu::texture::Textures;
    use crate::hair::model::HairModel;
    use crate::model::desc::{PartBones, PartDesc, PartTextures};
    use crate::model::part::{ModelPart, PartLayouts};
    use avatar_groom::{DensityMap, Groom, Style};
    use avatar_mesh::{Mesh, PartKind};
    use glam::{Affine3A, Vec2, Vec3};

    #[test]
    fn hair_grows_again_only_where_something_changed() {
        let Some(gpu) = gpu_for_tests() else { return };
        let skin = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z; 3],
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let desc = PartDesc {
            label: "skin",
            mesh: &skin,
            first_weight: 0,
            kind: PartKind::Skin,
            bones: PartBones::Rigid(0),
            textures: PartTextures::default(),
        };
        let (layouts, known) = (PartLayouts::new(&gpu.device), &mut Textures::default());
        let part = ModelPart::new(&gpu.device, &gpu.queue, &layouts, known, &desc, &[desc], 1, 1.0);
        let parts = [part.expect("a part")];
        let density = DensityMap::new(1, 1, vec![255]).expect("a map");
        let groom = Groom::new(&skin, &density, &[], Style::BOB, 40.0, 3);
        let model = HairModel::new(&gpu.device, &gpu.queue, 0, &parts[0].geometry, 1, &groom).expect("hair");
        let mut pose = Pose::new(&gpu.device, &parts, 1, 0);
        let mut hair = HairState::new(&gpu.device, &model, &pose.parts[0].vertices);
        let grower = Grower::new(&gpu.device);
        let grows = |pose: &Pose, hair: &HairState, strands: u32| {
            let described = wgpu::CommandEncoderDescriptor { label: Some("test") };
            let mut encoder = gpu.device.create_command_encoder(&described);
            let wanted = [(pose, hair, strands)].into_iter();
            let count = grower.record_due(&mut encoder, None, wanted);
            gpu.queue.submit([encoder.finish()]);
            count == 1
        };
        assert!(grows(&pose, &hair, 20), "new hair");
        assert!(!grows(&pose, &hair, 20));
        assert!(!grows(&pose, &hair, 10), "fewer are there already");
        assert!(grows(&pose, &hair, 30), "more are not");
        let mut set = |bone: Affine3A, hair: &HairState| {
            let is_another = pose.set(&gpu.queue, &[bone], &[]).expect("one bone");
            if is_another {
                hair.set_pose(&gpu.queue, &[bone]);
            }
            (is_another, grows(&pose, hair, 30))
        };
        assert_eq!(set(Affine3A::IDENTITY, &hair), (false, false), "the pose that it has");
        assert_eq!(set(Affine3A::from_rotation_z(0.5), &hair), (true, true));
        assert_eq!(set(Affine3A::from_rotation_z(0.5), &hair), (false, false));
        // The first call lets hair hang still; later ones let it swing, as long as time passes.
        for _ in 0..3 {
            hair.swing.advance(&gpu.queue, 0.1);
            assert!(grows(&pose, &hair, 30));
            assert!(!grows(&pose, &hair, 30), "no time passed");
        }
        hair.hang_still();
        assert!(grows(&pose, &hair, 30), "it hangs where it swung");
        hair.hang_still();
        assert!(!grows(&pose, &hair, 30), "it hangs still already");
        hair.redo();
        assert!(grows(&pose, &hair, 30), "what was done is lost");
    }
}
