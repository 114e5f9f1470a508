//! Reads back what is drawn: deformed vertices and strands.

use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use crate::deform::deformer::Deformer;
use crate::deform::posed::GpuDeformedVertex;
use crate::gpu::readback::{ReadbackError, mapped};
use crate::hair::grower::Grower;
use crate::hair::uniforms::POINT_STRIDE;
use avatar_groom::SEGMENTS;
use avatar_mesh::Deformed;
use glam::{Vec3, Vec4};
use std::iter;

/// Why a part could not be deformed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DeformerError {
    /// The model has no such part.
    #[error("expected a part below {parts}, found {found}")]
    NoSuchPart {
        /// Number of parts.
        parts: usize,
        /// The part.
        found: usize,
    },
    /// The state of another model.
    #[error("expected the state of this model, found that of another one")]
    StateOfAnotherModel,
    /// The result did not come back.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
}

/// Why strands could not be read back.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GrowerError {
    /// The state of another model, or one made before the model got its hair.
    #[error("expected the state of this model with its hair, found another one")]
    StateOfAnotherModel,
    /// The result did not come back.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
}

impl Deformer {
    /// Records the deformation of an avatar, whether it moved or not.
    /// [`Renderer::draw`](crate::Renderer::draw) does this by itself where it moved; this method is for
    /// measuring it. Does nothing with the state of another model.
    pub fn deform(&self, encoder: &mut wgpu::CommandEncoder, model: &AvatarModel, state: &AvatarState) {
        if state.fits(model) {
            state.pose.deform_again();
            self.record(encoder, None, [state.deforming(model)].into_iter(), iter::empty());
        }
    }

    /// Deforms an avatar and waits for one of its parts. Returns one position and normal per vertex of the
    /// mesh, in its order.
    ///
    /// # Errors
    /// A part or state that does not belong to the model, or a lost device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn run(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        model: &AvatarModel,
        state: &AvatarState,
        part: usize,
    ) -> Result<Deformed, DeformerError> {
        pollster::block_on(self.run_async(device, queue, model, state, part))
    }

    /// The same, for callers that cannot block.
    ///
    /// # Errors
    /// As above.
    pub async fn run_async(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        model: &AvatarModel,
        state: &AvatarState,
        part: usize,
    ) -> Result<Deformed, DeformerError> {
        let missing = DeformerError::NoSuchPart { parts: model.parts.len(), found: part };
        if part >= model.parts.len() {
            return Err(missing);
        }
        if !state.fits(model) {
            return Err(DeformerError::StateOfAnotherModel);
        }
        let (Some(posed), Some(drawn)) = (state.pose.parts.get(part), model.parts.get(part)) else {
            return Err(missing);
        };
        if posed.vertex_count == 0 {
            return Ok(Deformed::default());
        }
        let size = posed.vertices.size();
        let readable = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("deformed vertices: readable"),
            size,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("deform and read back") });
        // A frame that deformed it may not have been submitted.
        state.pose.deform_again();
        self.record(&mut encoder, None, [state.deforming(model)].into_iter(), iter::empty());
        encoder.copy_buffer_to_buffer(&posed.vertices, 0, &readable, 0, size);
        queue.submit([encoder.finish()]);
        let view = mapped(device, &readable).await?;
        let vertices: &[GpuDeformedVertex] = bytemuck::cast_slice(&view);
        let split = |vertex: &GpuDeformedVertex| (Vec3::from(vertex.position), Vec3::from(vertex.normal));
        let (positions, normals) = drawn.geometry.places.spread(vertices).map(split).unzip();
        Ok(Deformed { positions, normals, tangents: Vec::new() })
    }
}

impl Grower {
    /// Records the growth of all strands of an avatar on its skin as it was deformed last.
    /// [`Renderer::draw`](crate::Renderer::draw) does this by itself; this method is for measuring it. Does
    /// nothing with the state of another model.
    pub fn grow(&self, encoder: &mut wgpu::CommandEncoder, model: &AvatarModel, state: &AvatarState) {
        let growing = state.fits(model).then(|| state.growing_all(model)).flatten();
        self.record(encoder, None, growing.into_iter());
    }

    /// Deforms an avatar, grows its hair and waits for it. Returns the points of each strand, from the root
    /// to the tip, from the buffer that is drawn.
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
        pollster::block_on(self.run_async(device, queue, deformer, model, state))
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
        state.pose.deform_again();
        deformer.record(&mut encoder, None, [state.deforming(model)].into_iter(), iter::empty());
        self.record(&mut encoder, None, state.growing_all(model).into_iter());
        encoder.copy_buffer_to_buffer(&grown.points, 0, &readable, 0, size);
        queue.submit([encoder.finish()]);
        let view = mapped(device, &readable).await?;
        let points: &[[f32; 4]] = bytemuck::cast_slice(&view);
        let (strands, _) = points.as_chunks::<POINT_STRIDE>();
        Ok(strands.iter().map(|strand| std::array::from_fn(|i| Vec4::from(strand[i]).truncate())).collect())
    }
}
