//! Builds the pipelines of all passes that draw.

use crate::deformer::GpuDeformedVertex;
use crate::frame::{Ring, uniform_entry};
use crate::hair::draw_layout;
use crate::hair_detail::GpuHairView;
use crate::model::look_layout;
use crate::part::GpuVertex;
use crate::passes::Drawable;
use crate::renderer::{GpuShadowView, RendererConfig};
use crate::resources::Resources;
use crate::shaders::{
    Constants, OCCLUSION_PASS, PREPASS, Program, SCATTER_PASS, SHADOW_PASS, SKIN_LIGHT_PASS,
};
use crate::state::GpuBone;
use crate::targets::{DEPTH_FORMAT, NORMAL_FORMAT, OCCLUSION_FORMAT, SKIN_LIGHT_FORMAT};
use std::mem::offset_of;

/// Slots of the vertex buffers of a part.
pub(crate) const BIND_SLOT: u32 = 0;
/// What the deform pass wrote.
pub(crate) const POSED_SLOT: u32 = 1;
/// One f32 per vertex.
pub(crate) const CURVATURE_SLOT: u32 = 2;
/// The bone of a rigid part, for all vertices alike.
pub(crate) const BONE_SLOT: u32 = 3;

/// The bind group layouts of passes that draw, in the order of their groups.
#[derive(Debug)]
pub(crate) struct Layouts {
    /// Group 1: what earlier passes left.
    pub(crate) view: wgpu::BindGroupLayout,
    /// Group 0 of the shadow pass.
    pub(crate) shadow: wgpu::BindGroupLayout,
    pipeline: wgpu::PipelineLayout,
    /// Passes over the whole picture know no parts.
    pub(crate) whole_picture: wgpu::PipelineLayout,
    /// Group 3 of passes that draw strands: which of them.
    pub(crate) hair_view: wgpu::BindGroupLayout,
    pub(crate) hair: wgpu::PipelineLayout,
    shadow_pipeline: wgpu::PipelineLayout,
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout) -> Self {
        let view = view_layout(device);
        let shadow = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("shadow view"),
            entries: &[uniform_entry(wgpu::ShaderStages::VERTEX, Ring::<GpuShadowView>::BYTES)],
        });
        let hair_view = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("view of hair"),
            entries: &[uniform_entry(wgpu::ShaderStages::VERTEX_FRAGMENT, Ring::<GpuHairView>::BYTES)],
        });
        let layout = |label, groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        Self {
            pipeline: layout("parts of avatars", &[Some(frame), Some(&view), Some(&look_layout(device))]),
            hair: layout("hair", &[Some(frame), Some(&view), Some(&draw_layout(device)), Some(&hair_view)]),
            whole_picture: layout("whole picture", &[Some(frame), Some(&view)]),
            shadow_pipeline: layout("shadow", &[Some(&shadow)]),
            view,
            shadow,
            hair_view,
        }
    }
}

fn view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        // Strands are lit at their points.
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    let texture = |binding, sample_type, view_dimension| {
        entry(binding, wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false })
    };
    let flat = wgpu::TextureViewDimension::D2;
    // Read texel by texel.
    let color = wgpu::TextureSampleType::Float { filterable: false };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("view"),
        entries: &[
            texture(0, wgpu::TextureSampleType::Depth, wgpu::TextureViewDimension::D2Array),
            entry(1, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison)),
            texture(2, wgpu::TextureSampleType::Depth, flat),
            texture(3, color, flat),
            texture(4, color, flat),
            texture(5, color, flat),
            texture(6, color, flat),
        ],
    })
}

/// The pipelines of the passes before the picture, where the shading needs them.
#[derive(Debug)]
pub(crate) struct PassPipelines {
    pub(crate) shadow: Option<wgpu::RenderPipeline>,
    /// Skin and eyeballs from the front, teeth from both sides.
    pub(crate) prepass: Option<[wgpu::RenderPipeline; 2]>,
    pub(crate) occlusion: Option<wgpu::RenderPipeline>,
    pub(crate) skin_light: Option<wgpu::RenderPipeline>,
    pub(crate) scatter_across: Option<wgpu::RenderPipeline>,
}

/// What distinguishes a pipeline.
pub(crate) struct Recipe<'a> {
    pub(crate) program: &'a Program,
    pub(crate) layout: &'a wgpu::PipelineLayout,
    pub(crate) topology: wgpu::PrimitiveTopology,
    pub(crate) buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    pub(crate) cull_mode: Option<wgpu::Face>,
    /// How depths are compared, and whether they are written.
    pub(crate) depth: Option<(wgpu::CompareFunction, bool)>,
    pub(crate) bias: wgpu::DepthBiasState,
    pub(crate) samples: u32,
    pub(crate) target: Option<wgpu::ColorTargetState>,
    /// A second target beside the first.
    pub(crate) beside: Option<wgpu::ColorTargetState>,
}

impl PassPipelines {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts, config: RendererConfig) -> Self {
        let terms = config.shading.terms();
        let constants = Constants::of(config);
        let bind = bind_attributes();
        let posed = posed_attributes();
        let curvature = curvature_attributes();
        let part = part_buffers(&bind, &posed, &curvature, None);
        let front = Recipe {
            program: &PREPASS,
            layout: &layouts.pipeline,
            topology: wgpu::PrimitiveTopology::TriangleList,
            buffers: &part,
            cull_mode: Some(wgpu::Face::Back),
            depth: Some((wgpu::CompareFunction::Greater, true)),
            bias: Default::default(),
            samples: 1,
            target: color_target(NORMAL_FORMAT, None),
            beside: None,
        };
        let on_skin = |program| Recipe {
            program,
            // What the depth pass saw, and nothing behind it.
            depth: Some((wgpu::CompareFunction::GreaterEqual, false)),
            target: color_target(SKIN_LIGHT_FORMAT, None),
            ..front.again()
        };
        let shadow_position = [wgpu::VertexAttribute { shader_location: 0, ..posed[0] }];
        let shadow_buffers = [Some(buffer_layout(
            size_of::<GpuDeformedVertex>(),
            wgpu::VertexStepMode::Vertex,
            &shadow_position,
        ))];
        let build = |needed: bool, recipe: Recipe<'_>| needed.then(|| recipe.build(device, &constants));
        Self {
            shadow: build(
                terms.shadows.lamps() > 0,
                Recipe {
                    program: &SHADOW_PASS,
                    layout: &layouts.shadow_pipeline,
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
                [front.again(), Recipe { cull_mode: None, ..front.again() }]
                    .map(|recipe| recipe.build(device, &constants))
            }),
            occlusion: build(
                terms.occlusion,
                Recipe {
                    program: &OCCLUSION_PASS,
                    layout: &layouts.whole_picture,
                    buffers: &[],
                    cull_mode: None,
                    depth: None,
                    target: color_target(OCCLUSION_FORMAT, None),
                    ..front.again()
                },
            ),
            skin_light: build(terms.separable(), on_skin(&SKIN_LIGHT_PASS)),
            scatter_across: build(terms.separable(), on_skin(&SCATTER_PASS)),
        }
    }
}

/// A target of which all channels are written.
pub(crate) fn color_target(
    format: wgpu::TextureFormat,
    blend: Option<wgpu::BlendState>,
) -> Option<wgpu::ColorTargetState> {
    Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })
}

/// Builds the pipeline of something in the picture.
pub(crate) fn picture_pipeline(
    device: &wgpu::Device,
    layouts: &Layouts,
    drawable: &Drawable,
    config: RendererConfig,
) -> wgpu::RenderPipeline {
    let bind = bind_attributes();
    let posed = posed_attributes();
    let curvature = curvature_attributes();
    let bone = bone_attributes();
    let part = part_buffers(&bind, &posed, &curvature, Some(&bone));
    let blend = drawable.is_transparent.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
    let recipe = Recipe {
        program: &drawable.program,
        layout: &layouts.pipeline,
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
    recipe.build(device, &Constants::of(config))
}

impl Recipe<'_> {
    pub(crate) fn again(&self) -> Self {
        Self { target: self.target.clone(), beside: self.beside.clone(), ..*self }
    }

    pub(crate) fn build(&self, device: &wgpu::Device, constants: &Constants) -> wgpu::RenderPipeline {
        let module = self.program.module(device, constants);
        let targets = [self.target.clone(), self.beside.clone()];
        let count = if self.beside.is_some() { 2 } else { 1 };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.program.label),
            layout: Some(self.layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(self.program.entry),
                compilation_options: Default::default(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: self.cull_mode,
                topology: self.topology,
                ..Default::default()
            },
            depth_stencil: self.depth.map(|(compare, writes)| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(writes),
                depth_compare: Some(compare),
                stencil: Default::default(),
                bias: self.bias,
            }),
            multisample: wgpu::MultisampleState { count: self.samples, ..Default::default() },
            fragment: self.program.fragment.map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &targets[..count],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

const fn attribute(format: wgpu::VertexFormat, offset: usize, shader_location: u32) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset: offset as u64, shader_location }
}

fn bind_attributes() -> [wgpu::VertexAttribute; 2] {
    use wgpu::VertexFormat::Float32x4;
    [
        attribute(Float32x4, offset_of!(GpuVertex, position), 0),
        attribute(Float32x4, offset_of!(GpuVertex, normal), 1),
    ]
}

fn posed_attributes() -> [wgpu::VertexAttribute; 2] {
    use wgpu::VertexFormat::Float32x3;
    [
        attribute(Float32x3, offset_of!(GpuDeformedVertex, position), 2),
        attribute(Float32x3, offset_of!(GpuDeformedVertex, normal), 3),
    ]
}

fn curvature_attributes() -> [wgpu::VertexAttribute; 1] {
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

/// Layout of the group of resources that passes leave; see [`Resources`] for the group before it.
pub(crate) fn view_group(
    device: &wgpu::Device,
    layouts: &Layouts,
    resources: &Resources,
    label: &str,
    views: [&wgpu::TextureView; 4],
    hair_map: &wgpu::TextureView,
) -> wgpu::BindGroup {
    let texture = |binding: u32, view| wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::TextureView(view),
    };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout: &layouts.view,
        entries: &[
            texture(0, &resources.shadow_map),
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::Sampler(&resources.shadow_sampler),
            },
            texture(2, views[0]),
            texture(3, views[1]),
            texture(4, views[2]),
            texture(5, views[3]),
            texture(6, hair_map),
        ],
    })
}
