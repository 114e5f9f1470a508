use crate::deformer::compute_pipeline_of;
use crate::hair::{GROW_WORKGROUP_SIZE, HairState, POINT_STRIDE, grow_layouts};
use crate::readback::{ReadbackError, mapped};
use crate::shaders::{Constants, GROW_PASS};
use crate::state::avatar_layout;
use crate::swing::swing_pipeline;
use crate::{AvatarModel, AvatarState, Deformer};
use avatar_groom::SEGMENTS;
use glam::{Vec3, Vec4};

/// Grows hair: a pass of every frame. By itself it reads back what is drawn.
#[derive(Debug)]
pub struct Grower {
    still: wgpu::ComputePipeline,
    swinging: wgpu::ComputePipeline,
    swing: wgpu::ComputePipeline,
}

/// Why strands could not be read back.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GrowerError {
    /// The state of another model, or one made before the model got its hair.
    #[error("expected the state of this model with its hair, found another one")]
    StateOfAnotherModel,
    /// The result did not come back.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
}

impl Grower {
    /// Builds the pipeline.
    pub fn new(device: &wgpu::Device) -> Self {
        let [hair, skin] = grow_layouts(device);
        let pipeline = |swinging| {
            let constants = Constants { swinging, ..Constants::default() };
            compute_pipeline_of(device, &GROW_PASS, &[&hair, &avatar_layout(device), &skin], &constants)
        };
        Self { still: pipeline(false), swinging: pipeline(true), swing: swing_pipeline(device) }
    }

    /// Grows as many strands of avatars on their deformed skins.
    pub(crate) fn record<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
        avatars: impl Iterator<Item = (&'a AvatarState, u32)> + Clone,
    ) {
        let growing = avatars.filter_map(|(state, strands)| Some((state, state.hair.as_ref()?, strands)));
        // What passes write to buffers and growth reads from textures is copied in between.
        growing.clone().for_each(|(_, hair, _)| hair.take_skin(encoder));
        let (start, end) = match timestamps {
            Some(times) => (
                Some(wgpu::ComputePassTimestampWrites { end_of_pass_write_index: None, ..times.clone() }),
                Some(wgpu::ComputePassTimestampWrites { beginning_of_pass_write_index: None, ..times }),
            ),
            None => (None, None),
        };
        let mut pass = compute_pass(encoder, "grow guides of hair", start);
        for (state, hair, _) in growing.clone() {
            pass.set_pipeline(&self.still);
            dispatch(&mut pass, state, hair, &hair.grow_guides, hair.guide_count);
            hair.swing.record(&mut pass, &self.swing);
        }
        drop(pass);
        growing.clone().for_each(|(_, hair, _)| hair.take_guides(encoder));
        let mut pass = compute_pass(encoder, GROW_PASS.label, end);
        for (state, hair, strands) in growing {
            pass.set_pipeline(if hair.swing.is_moving() { &self.swinging } else { &self.still });
            dispatch(&mut pass, state, hair, &hair.grow, strands);
        }
    }

    /// Records the growth of all strands of an avatar on its skin as it was deformed last. Frames do that by themselves;
    /// alone it can be measured. A state of another model is left as it is.
    pub fn grow(&self, encoder: &mut wgpu::CommandEncoder, model: &AvatarModel, state: &AvatarState) {
        let fits = state.fits(model);
        let strands = u32::try_from(model.strand_count()).unwrap_or(u32::MAX);
        self.record(encoder, None, fits.then_some((state, strands)).into_iter());
    }

    /// Deforms an avatar, grows its hair and waits for it: the points of each strand, from the root to the tip, from the
    /// very buffer that is drawn.
    ///
    /// # Errors
    /// A state that does not belong to the model, or a lost device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn run(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        deformer: &Deformer,
        model: &AvatarModel,
        state: &AvatarState,
    ) -> Result<Vec<[Vec3; SEGMENTS + 1]>, GrowerError> {
        crate::readback::block_on(self.run_async(device, queue, deformer, model, state))
    }

    /// The same, for callers that cannot block.
    ///
    /// # Errors
    /// As above.
    pub async fn run_async(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        deformer: &Deformer,
        model: &AvatarModel,
        state: &AvatarState,
    ) -> Result<Vec<[Vec3; SEGMENTS + 1]>, GrowerError> {
        if !state.fits(model) {
            return Err(GrowerError::StateOfAnotherModel);
        }
        let Some(grown) = &state.hair else { return Ok(Vec::new()) };
        let size = grown.points.size();
        let readable = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("hair: readable"),
            size,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("grow and read back") });
        deformer.record(&mut encoder, None, &[(model, state)]);
        let strands = u32::try_from(model.strand_count()).unwrap_or(u32::MAX);
        self.record(&mut encoder, None, [(state, strands)].into_iter());
        encoder.copy_buffer_to_buffer(&grown.points, 0, &readable, 0, size);
        queue.submit([encoder.finish()]);
        let view = mapped(device, &readable).await?;
        let points: &[[f32; 4]] = bytemuck::cast_slice(&view);
        let (strands, _) = points.as_chunks::<POINT_STRIDE>();
        Ok(strands.iter().map(|strand| std::array::from_fn(|i| Vec4::from(strand[i]).truncate())).collect())
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
    state: &AvatarState,
    hair: &HairState,
    grown: &wgpu::BindGroup,
    strands: u32,
) {
    pass.set_bind_group(0, grown, &[]);
    pass.set_bind_group(1, &state.bind_group, &[]);
    pass.set_bind_group(2, &hair.skin, &[]);
    pass.dispatch_workgroups(strands.div_ceil(GROW_WORKGROUP_SIZE), 1, 1);
}
