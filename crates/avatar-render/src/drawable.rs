//! One pipeline per kind of part.

mod cornea;
mod eyeball;
mod skin;
mod teeth;

use crate::frame::FrameRing;
use crate::model::look_layout;
use crate::part::Geometry;
use crate::renderer::RendererConfig;
use crate::shaders::{ENCODE_SRGB, Program, VERTEX_ENTRY};
use crate::state::avatar_layout;
use crate::targets::DEPTH_FORMAT;
use avatar_mesh::PartKind;

/// What distinguishes the pipeline of a kind from the others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawable {
    pub(crate) kind: PartKind,
    /// Name of its group in graphics debuggers.
    pub(crate) label: &'static str,
    program: Program,
    cull_mode: Option<wgpu::Face>,
    blend: Option<wgpu::BlendState>,
    writes_depth: bool,
}

/// The order in which a frame is drawn, all avatars step by step. The skin comes first because it hides most of the rest,
/// its back sides after everything that hides them, and what is transparent last, from far to near.
pub(crate) const DRAW_ORDER: [Drawable; 5] =
    [skin::SKIN, teeth::TEETH, eyeball::EYEBALL, skin::SKIN_BACK, cornea::CORNEA];

impl Drawable {
    pub(crate) fn is_transparent(&self) -> bool {
        self.blend.is_some()
    }
}

/// The bind group layouts in the order of their groups.
#[derive(Debug)]
pub(crate) struct Layouts {
    pub(crate) frame: wgpu::BindGroupLayout,
    pub(crate) pipeline: wgpu::PipelineLayout,
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let frame = FrameRing::layout(device);
        let pipeline = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("parts of avatars"),
            bind_group_layouts: &[
                Some(&frame),
                Some(&avatar_layout(device)),
                Some(&Geometry::layout(device)),
                Some(&look_layout(device)),
            ],
            immediate_size: 0,
        });
        Self { frame, pipeline }
    }
}

/// Builds the pipeline of a kind.
pub(crate) fn pipeline(
    device: &wgpu::Device,
    layouts: &Layouts,
    drawable: &Drawable,
    config: RendererConfig,
) -> wgpu::RenderPipeline {
    let module = drawable.program.module(device);
    let encode = [(ENCODE_SRGB, f64::from(u8::from(config.encodes_in_shader())))];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(drawable.label),
        layout: Some(&layouts.pipeline),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(VERTEX_ENTRY),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState { cull_mode: drawable.cull_mode, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(drawable.writes_depth),
            // Depth is reversed: nearer is greater.
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: config.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(drawable.program.entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &encode,
                ..Default::default()
            },
            targets: &[Some(wgpu::ColorTargetState {
                format: config.color_format,
                blend: drawable.blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
