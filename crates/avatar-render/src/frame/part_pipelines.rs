//! Builds the pipelines of all passes that draw parts.

use crate::deform::crowd_chunk::crowd_layout;
use crate::deform::posed::GpuDeformedVertex;
use crate::frame::drawables::Drawable;
use crate::frame::programs::{OCCLUSION_PASS, PREPASS, SCATTER_PASS, SHADOW_PASS, SKIN_LIGHT_PASS};
use crate::frame::vertices::{PipelineLayouts, Vertices, build};
use crate::gpu::bindings::dynamic_uniform_entry;
use crate::gpu::pipeline::{Recipe, color_target, pipeline_layout};
use crate::gpu::program::Program;
use crate::gpu::ring::Ring;
use crate::model::bone::GpuBone;
use crate::model::effects::Effects;
use crate::model::extras::GpuExtra;
use crate::model::geometry::GpuVertex;
use crate::model::part::look_layout;
use crate::view::config::RendererConfig;
use crate::view::inputs::view_layout;
use crate::view::shadows::GpuShadowView;
use std::mem::offset_of;

/// Normals of the picture, 0…1.
pub(crate) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// How much ambient light arrives.
pub(crate) const OCCLUSION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;
/// Light under the skin, times the frame's pre-exposure.
pub(crate) const SKIN_LIGHT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Slots of the vertex buffers of a part.
pub(crate) const BIND_SLOT: u32 = 0;
/// What the deform pass wrote.
pub(crate) const POSED_SLOT: u32 = 1;
/// One f32 per vertex.
pub(crate) const CURVATURE_SLOT: u32 = 2;
/// The bone of a rigid part, for all vertices alike.
pub(crate) const BONE_SLOT: u32 = 3;

/// [`GpuExtra`] per vertex, of surfaces of interchange files that have some.
pub(crate) const EXTRA_SLOT: u32 = 4;

/// The layouts of passes that draw parts.
#[derive(Debug)]
pub(crate) struct Layouts {
    /// Group 1: what earlier passes left.
    pub(crate) view: wgpu::BindGroupLayout,
    /// Group 0 of the shadow pass.
    pub(crate) shadow: wgpu::BindGroupLayout,
    pub(crate) pipeline: PipelineLayouts,
    /// Passes over the whole picture know no parts.
    whole_picture: wgpu::PipelineLayout,
    shadow_pipeline: PipelineLayouts,
    /// Shadows of surfaces with holes, which depend on their looks.
    pub(crate) cut_shadow_pipeline: PipelineLayouts,
}

impl Layouts {
    /// `frame` is the layout of group 0.
    pub(crate) fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let view = view_layout(device);
        let shadow = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("shadow view"),
            entries: &[dynamic_uniform_entry(wgpu::ShaderStages::VERTEX, Ring::<GpuShadowView>::BYTES)],
        });
        let (looks, crowd) = (look_layout(device), crowd_layout(device));
        let layouts = |label, groups| PipelineLayouts::new(device, label, groups, &crowd);
        Self {
            pipeline: layouts("parts of avatars", [Some(frame), Some(&view), Some(&looks)]),
            whole_picture: pipeline_layout(device, "whole picture", &[frame, &view]),
            shadow_pipeline: layouts("shadow", [Some(&shadow), None, None]),
            cut_shadow_pipeline: layouts("shadow of what has holes", [Some(&shadow), None, Some(&looks)]),
            view,
            shadow,
        }
    }
}

/// The pipelines of the passes before the picture, where the shading needs them.
#[derive(Debug)]
pub(crate) struct PassPipelines {
    pub(crate) shadow: Option<wgpu::RenderPipeline>,
    /// From the front, and from both sides.
    pub(crate) prepass: Option<[wgpu::RenderPipeline; 2]>,
    pub(crate) occlusion: Option<wgpu::RenderPipeline>,
    pub(crate) scatter_across: Option<wgpu::RenderPipeline>,
}

impl PassPipelines {
    pub(crate) fn new(
        device: &wgpu::Device,
        layouts: &Layouts,
        config: RendererConfig,
        vertices: Vertices,
    ) -> Self {
        let terms = config.shading.terms();
        let bind = bind_attributes();
        let posed = posed_attributes();
        let curvature = curvature_attributes();
        let part = part_buffers(&bind, &posed, &curvature, None);
        let front = Recipe {
            program: &PREPASS,
            layout: layouts.pipeline.of(vertices),
            topology: wgpu::PrimitiveTopology::TriangleList,
            buffers: &part,
            cull_mode: Some(wgpu::Face::Back),
            depth: Some((wgpu::CompareFunction::Greater, true)),
            bias: Default::default(),
            samples: 1,
            target: color_target(NORMAL_FORMAT, None),
            beside: None,
        };
        let shadow_position = [wgpu::VertexAttribute { shader_location: 0, ..posed[0] }];
        let shadow_buffers = [Some(buffer_layout(
            size_of::<GpuDeformedVertex>(),
            wgpu::VertexStepMode::Vertex,
            &shadow_position,
        ))];
        let build = |recipe: &Recipe<'_>| build(recipe, device, config, Effects::NONE, vertices);
        let built = |needed: bool, recipe: Recipe<'_>| needed.then(|| build(&recipe));
        Self {
            shadow: built(
                terms.shadows.lamps() > 0,
                Recipe {
                    program: &SHADOW_PASS,
                    layout: layouts.shadow_pipeline.of(vertices),
                    buffers: &shadow_buffers,
                    // Open sheets cast shadows, too.
                    cull_mode: None,
                    depth: Some((wgpu::CompareFunction::Less, true)),
                    bias: wgpu::DepthBiasState { constant: 0, slope_scale: 1.0, clamp: 0.0 },
                    samples: 1,
                    topology: wgpu::PrimitiveTopology::TriangleList,
                    target: None,
                    beside: None,
                },
            ),
            prepass: terms.prepass().then(|| {
                [front.clone(), Recipe { cull_mode: None, ..front.clone() }].map(|recipe| build(&recipe))
            }),
            // Knows no parts: that of single avatars serves all.
            occlusion: built(
                terms.occlusion && vertices == Vertices::OfOne,
                Recipe {
                    program: &OCCLUSION_PASS,
                    layout: &layouts.whole_picture,
                    buffers: &[],
                    cull_mode: None,
                    depth: None,
                    target: color_target(OCCLUSION_FORMAT, None),
                    ..front.clone()
                },
            ),
            scatter_across: terms
                .separable()
                .then(|| on_skin(device, layouts, &SCATTER_PASS, config, Effects::NONE, vertices)),
        }
    }
}

/// Builds the pipeline that lights the skin before light spreads below it.
pub(crate) fn skin_light_pipeline(
    device: &wgpu::Device,
    layouts: &Layouts,
    config: RendererConfig,
    effects: Effects,
    vertices: Vertices,
) -> wgpu::RenderPipeline {
    on_skin(device, layouts, &SKIN_LIGHT_PASS, config, effects, vertices)
}

/// Builds the pipeline of a pass over the skin that is seen.
fn on_skin(
    device: &wgpu::Device,
    layouts: &Layouts,
    program: &Program,
    config: RendererConfig,
    effects: Effects,
    vertices: Vertices,
) -> wgpu::RenderPipeline {
    let recipe = Recipe {
        program,
        layout: layouts.pipeline.of(vertices),
        topology: wgpu::PrimitiveTopology::TriangleList,
        buffers: &standard_buffers(false),
        cull_mode: Some(wgpu::Face::Back),
        // Only what the depth pass saw.
        depth: Some((wgpu::CompareFunction::GreaterEqual, false)),
        bias: Default::default(),
        samples: 1,
        target: color_target(SKIN_LIGHT_FORMAT, None),
        beside: None,
    };
    build(&recipe, device, config, effects, vertices)
}

/// Builds the pipeline of a drawable that shows these effects.
pub(crate) fn picture_pipeline(
    device: &wgpu::Device,
    layouts: &Layouts,
    drawable: &Drawable,
    config: RendererConfig,
    effects: Effects,
    vertices: Vertices,
) -> wgpu::RenderPipeline {
    let bind = bind_attributes();
    let posed = posed_attributes();
    let curvature = curvature_attributes();
    let bone = bone_attributes();
    let part = part_buffers(&bind, &posed, &curvature, Some(&bone));
    let blend = drawable.is_transparent.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
    let recipe = Recipe {
        program: &drawable.program,
        layout: layouts.pipeline.of(vertices),
        topology: wgpu::PrimitiveTopology::TriangleList,
        buffers: &part,
        cull_mode: drawable.cull_mode,
        // Depth is reversed: nearer is greater.
        depth: Some((wgpu::CompareFunction::Greater, !drawable.is_transparent)),
        bias: Default::default(),
        samples: config.samples,
        target: color_target(config.color_format, blend),
        beside: None,
    };
    build(&recipe, device, config, effects, vertices)
}

const fn attribute(format: wgpu::VertexFormat, offset: usize, shader_location: u32) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset: offset as u64, shader_location }
}

const fn bind_attributes() -> [wgpu::VertexAttribute; 2] {
    use wgpu::VertexFormat::Float32x4;
    [
        attribute(Float32x4, offset_of!(GpuVertex, position), 0),
        attribute(Float32x4, offset_of!(GpuVertex, normal), 1),
    ]
}

const fn posed_attributes() -> [wgpu::VertexAttribute; 3] {
    use wgpu::VertexFormat::{Float32, Float32x3};
    [
        attribute(Float32x3, offset_of!(GpuDeformedVertex, position), 2),
        attribute(Float32x3, offset_of!(GpuDeformedVertex, normal), 3),
        attribute(Float32, offset_of!(GpuDeformedVertex, wrinkled), 10),
    ]
}

const fn curvature_attributes() -> [wgpu::VertexAttribute; 1] {
    [attribute(wgpu::VertexFormat::Float32, 0, 4)]
}

fn bone_attributes() -> [wgpu::VertexAttribute; 3] {
    let row = size_of::<[f32; 4]>();
    [0, 1, 2].map(|i| attribute(wgpu::VertexFormat::Float32x4, i * row, 5 + i as u32))
}

fn buffer_layout(
    stride: usize,
    step_mode: wgpu::VertexStepMode,
    attributes: &[wgpu::VertexAttribute],
) -> wgpu::VertexBufferLayout<'_> {
    wgpu::VertexBufferLayout { array_stride: stride as u64, step_mode, attributes }
}

/// The vertex buffers by their slots.
fn part_buffers<'a>(
    bind: &'a [wgpu::VertexAttribute],
    posed: &'a [wgpu::VertexAttribute],
    curvature: &'a [wgpu::VertexAttribute],
    bone: Option<&'a [wgpu::VertexAttribute]>,
) -> Vec<Option<wgpu::VertexBufferLayout<'a>>> {
    let vertex = wgpu::VertexStepMode::Vertex;
    let mut buffers = vec![
        Some(buffer_layout(size_of::<GpuVertex>(), vertex, bind)),
        Some(buffer_layout(size_of::<GpuDeformedVertex>(), vertex, posed)),
        Some(buffer_layout(size_of::<f32>(), vertex, curvature)),
    ];
    buffers.extend(
        bone.map(|bone| Some(buffer_layout(size_of::<GpuBone>(), wgpu::VertexStepMode::Instance, bone))),
    );
    buffers
}

static BIND: [wgpu::VertexAttribute; 2] = bind_attributes();
static POSED: [wgpu::VertexAttribute; 3] = posed_attributes();
static CURVATURE: [wgpu::VertexAttribute; 1] = curvature_attributes();
static EXTRA: [wgpu::VertexAttribute; 2] = [
    attribute(wgpu::VertexFormat::Float32x2, offset_of!(GpuExtra, uv_1), 8),
    attribute(wgpu::VertexFormat::Float16x4, offset_of!(GpuExtra, color), 9),
];

/// The vertex buffers of surfaces of interchange files by their slots.
pub(crate) fn standard_buffers(has_extras: bool) -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
    let mut buffers = part_buffers(&BIND, &POSED, &CURVATURE, None);
    buffers.extend(extra_slot(has_extras));
    buffers
}

/// The same for shadows of what has holes.
pub(crate) fn cut_shadow_buffers(has_extras: bool) -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
    let vertex = wgpu::VertexStepMode::Vertex;
    let mut buffers = vec![
        Some(buffer_layout(size_of::<GpuVertex>(), vertex, &BIND)),
        Some(buffer_layout(size_of::<GpuDeformedVertex>(), vertex, &POSED[..1])),
        None,
    ];
    buffers.extend(extra_slot(has_extras));
    buffers
}

/// Bones are no input of these programs: their slot is empty.
fn extra_slot(has_extras: bool) -> impl Iterator<Item = Option<wgpu::VertexBufferLayout<'static>>> {
    let extra = || buffer_layout(size_of::<GpuExtra>(), wgpu::VertexStepMode::Vertex, &EXTRA);
    has_extras.then(|| [None, Some(extra())]).into_iter().flatten()
}
