use crate::part::Geometry;
use crate::readback::{ReadbackError, mapped};
use crate::shaders::{Constants, DEFORM_PASS, Program};
use crate::state::avatar_layout;
use crate::{AvatarModel, AvatarState};
use avatar_mesh::Deformed;

/// Vertices per workgroup: a block of blend shapes. The number of workgroups that WebGPU promises reaches the largest binding of
/// vertices that it promises but for one block; larger parts are refused.
pub(crate) const DEFORM_WORKGROUP_SIZE: u32 = 64;

/// WGSL `DeformedVertex`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuDeformedVertex {
    pub(crate) position: [f32; 3],
    pub(crate) pad_0: f32,
    pub(crate) normal: [f32; 3],
    pub(crate) pad_1: f32,
}

/// Why a part could not be deformed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
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

/// Layout of group 0 of the deform pass: where its results go.
pub(crate) fn deformed_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("deformed vertices"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: false },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

/// The pipeline of a compute pass; `groups` are the layouts of its bind groups in their order.
pub(crate) fn compute_pipeline(
    device: &wgpu::Device,
    program: &Program,
    groups: [&wgpu::BindGroupLayout; 3],
) -> wgpu::ComputePipeline {
    compute_pipeline_of(device, program, &groups, &Constants::default())
}

pub(crate) fn compute_pipeline_of(
    device: &wgpu::Device,
    program: &Program,
    groups: &[&wgpu::BindGroupLayout],
    constants: &Constants,
) -> wgpu::ComputePipeline {
    let groups: Vec<_> = groups.iter().copied().map(Some).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(program.label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(program.label),
        layout: Some(&layout),
        module: &program.module(device, constants),
        entry_point: Some(program.entry),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// Deforms avatars: the first pass of every frame. By itself it reads back what is drawn.
#[derive(Debug)]
pub struct Deformer {
    pipeline: wgpu::ComputePipeline,
}

impl Deformer {
    /// Builds the pipeline.
    pub fn new(device: &wgpu::Device) -> Self {
        let groups = [&deformed_layout(device), &avatar_layout(device), &Geometry::layout(device)];
        let pipeline = compute_pipeline(device, &DEFORM_PASS, groups);
        Self { pipeline }
    }

    /// Deforms all parts of avatars into the buffers of their states.
    pub(crate) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("deform"),
            timestamp_writes: timestamps,
        });
        pass.set_pipeline(&self.pipeline);
        for (model, state) in avatars {
            pass.set_bind_group(1, &state.bind_group, &[]);
            for (part, posed) in model.parts.iter().zip(&state.posed) {
                if part.geometry.vertex_count > 0 {
                    pass.set_bind_group(0, &posed.output, &[]);
                    pass.set_bind_group(2, &part.geometry.bind_group, &[]);
                    pass.dispatch_workgroups(
                        part.geometry.vertex_count.div_ceil(DEFORM_WORKGROUP_SIZE),
                        1,
                        1,
                    );
                }
            }
        }
    }

    /// Deforms an avatar and waits for one part of it: one position and normal per vertex of the mesh, in its order.
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
        crate::readback::block_on(self.run_async(device, queue, model, state, part))
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
        let posed = state.posed.get(part).ok_or(missing)?;
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
        self.record(&mut encoder, None, &[(model, state)]);
        encoder.copy_buffer_to_buffer(&posed.vertices, 0, &readable, 0, size);
        queue.submit([encoder.finish()]);
        let view = mapped(device, &readable).await?;
        let vertices: &[GpuDeformedVertex] = bytemuck::cast_slice(&view);
        Ok(Deformed {
            positions: vertices.iter().map(|vertex| vertex.position.into()).collect(),
            normals: vertices.iter().map(|vertex| vertex.normal.into()).collect(),
            tangents: Vec::new(),
        })
    }
}
