//! Builds the pipelines that draw strands.

use crate::gpu::pipeline::{Recipe, color_target, pipeline_layout};
use crate::gpu::program::{Constant, Value};
use crate::gpu::ring::{FRAME_SLOTS, Ring};
use crate::hair::detail::GpuHairView;
use crate::hair::layouts::{compose_layout, draw_layout, hair_view_layout, inputs_layout};
use crate::hair::programs::{
    COMPOSE_HAIR, COMPOSE_HAIR_DEPTH, HAIR_SHADOW_PASS, LAYERED_STRANDS, MASKED_STRANDS, STRAND_LAYERS,
    STRAND_SLICES,
};
use crate::hair::targets::{HAIR_CLEAR_FORMAT, HAIR_SUM_FORMAT};
use crate::model::effects::AGX;
use crate::view::config::{COVERAGE_MASK, RendererConfig};
use crate::view::resources::HAIR_MAP_FORMAT;
use std::sync::OnceLock;

/// The pipelines of all passes that draw strands.
#[derive(Debug)]
pub(crate) struct HairPipelines {
    /// For the map of hair that the key lamp sees, if the shading has shadows.
    pub(crate) shadow: Option<wgpu::RenderPipeline>,
    /// Made for the first picture with strands that are drawn finely.
    fine: OnceLock<Strands>,
    /// Made for the first picture with strands that are drawn coarsely.
    draft: OnceLock<wgpu::RenderPipeline>,
    strands_layout: wgpu::PipelineLayout,
    compose_layout: wgpu::PipelineLayout,
    config: RendererConfig,
}

/// How strands get into the picture.
#[derive(Debug)]
pub(crate) enum Strands {
    /// Each covers some of a pixel's samples.
    Masked(wgpu::RenderPipeline),
    /// With one sample per pixel: where strands lie, how much they cover at each depth, all of them blended,
    /// and the two steps that lay them over the picture: colour and depth.
    Layered {
        layers: wgpu::RenderPipeline,
        slices: wgpu::RenderPipeline,
        blended: wgpu::RenderPipeline,
        compose: [wgpu::RenderPipeline; 2],
    },
}

impl HairPipelines {
    /// `frame` is the layout of group 0.
    pub(crate) fn new(device: &wgpu::Device, frame: &wgpu::BindGroupLayout, config: RendererConfig) -> Self {
        let (inputs, drawn, view) = (inputs_layout(device), draw_layout(device), hair_view_layout(device));
        let mut pipelines = Self {
            shadow: None,
            fine: OnceLock::new(),
            draft: OnceLock::new(),
            strands_layout: pipeline_layout(device, "hair", &[frame, &inputs, &drawn, &view]),
            compose_layout: pipeline_layout(
                device,
                "hair over the picture",
                &[frame, &compose_layout(device)],
            ),
            config,
        };
        pipelines.shadow = (config.shading.terms().shadows.lamps() > 0).then(|| {
            let recipe = Recipe {
                program: &HAIR_SHADOW_PASS,
                depth: None,
                samples: 1,
                target: blended(HAIR_MAP_FORMAT, added(), largest()),
                ..pipelines.ribbons()
            };
            recipe.build(device, &config.choices())
        });
        pipelines
    }

    /// Draws strands finely.
    pub(crate) fn fine(&self, device: &wgpu::Device) -> &Strands {
        self.fine.get_or_init(|| self.strands(device))
    }

    /// Draws strands coarsely: in one pass, whatever the samples.
    pub(crate) fn draft(&self, device: &wgpu::Device) -> &wgpu::RenderPipeline {
        if self.config.samples > 1
            && let Strands::Masked(pipeline) = self.fine(device)
        {
            return pipeline;
        }
        // Strands cover the only sample of a pixel or not, by the same random numbers.
        self.draft.get_or_init(|| self.ribbons().build(device, &masked(choices(self.config))))
    }

    /// The pipeline of strands that cover some of a pixel's samples, on which the others build.
    fn ribbons(&self) -> Recipe<'_> {
        Recipe {
            program: &MASKED_STRANDS,
            layout: &self.strands_layout,
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            buffers: &[],
            // Ribbons are seen from both sides.
            cull_mode: None,
            depth: Some((wgpu::CompareFunction::Greater, true)),
            bias: Default::default(),
            samples: self.config.samples,
            target: color_target(self.config.color_format, None),
            beside: None,
        }
    }

    fn strands(&self, device: &wgpu::Device) -> Strands {
        use wgpu::CompareFunction::{Always, Greater};
        let (config, choices, ribbons) = (self.config, choices(self.config), self.ribbons());
        if config.samples > 1 {
            return Strands::Masked(ribbons.build(device, &choices));
        }
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        let compose = Recipe {
            program: &COMPOSE_HAIR,
            layout: &self.compose_layout,
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth: Some((Always, false)),
            target: blended(config.color_format, over.color, over.alpha),
            ..ribbons.clone()
        };
        let compose_depth = Recipe {
            program: &COMPOSE_HAIR_DEPTH,
            depth: Some((Greater, true)),
            target: Some(wgpu::ColorTargetState {
                write_mask: wgpu::ColorWrites::empty(),
                ..config.color_format.into()
            }),
            ..compose.clone()
        };
        let layers = Recipe {
            program: &STRAND_LAYERS,
            depth: Some((Greater, false)),
            target: blended(HAIR_SUM_FORMAT, added(), largest()),
            ..ribbons.clone()
        };
        let slices = Recipe {
            program: &STRAND_SLICES,
            target: blended(HAIR_SUM_FORMAT, added(), added()),
            beside: blended(HAIR_SUM_FORMAT, added(), added()),
            ..layers.clone()
        };
        let layered = Recipe {
            program: &LAYERED_STRANDS,
            depth: Some((Greater, false)),
            target: blended(HAIR_SUM_FORMAT, added(), added()),
            beside: blended(HAIR_CLEAR_FORMAT, multiplied(), multiplied()),
            ..ribbons.clone()
        };
        Strands::Layered {
            layers: layers.build(device, &choices),
            slices: slices.build(device, &choices),
            blended: layered.build(device, &choices),
            compose: [compose, compose_depth].map(|recipe| recipe.build(device, &choices)),
        }
    }
}

/// The constants of programs that draw strands, in any tone.
fn choices(config: RendererConfig) -> Vec<Constant> {
    let mut choices = config.choices();
    choices.push((AGX, Value::Flag(true)));
    choices
}

/// The constants with which strands cover samples, even if there is only one.
fn masked(mut choices: Vec<Constant>) -> Vec<Constant> {
    for (name, value) in &mut choices {
        if *name == COVERAGE_MASK {
            *value = Value::Flag(true);
        }
    }
    choices
}

/// Group 3 of passes that draw strands: which of them.
#[derive(Debug)]
pub(crate) struct HairViews {
    pub(crate) ring: Ring<GpuHairView>,
    pub(crate) group: wgpu::BindGroup,
}

/// One for the shadow of a head of hair and one for the hair itself.
const VIEWS_PER_HEAD: u32 = 2;
const HEADS_PER_FRAME: u32 = 24;
/// The most heads of hair in all frames before one submission.
pub(crate) const MOST_HEADS: u32 = HEADS_PER_FRAME * FRAME_SLOTS;

impl HairViews {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let ring = Ring::new(device, "views of hair", VIEWS_PER_HEAD * HEADS_PER_FRAME);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view of hair"),
            layout: &hair_view_layout(device),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: ring.binding() }],
        });
        Self { ring, group }
    }
}

fn blended(
    format: wgpu::TextureFormat,
    color: wgpu::BlendComponent,
    alpha: wgpu::BlendComponent,
) -> Option<wgpu::ColorTargetState> {
    color_target(format, Some(wgpu::BlendState { color, alpha }))
}

fn added() -> wgpu::BlendComponent {
    use wgpu::{BlendFactor::One, BlendOperation::Add};
    wgpu::BlendComponent { src_factor: One, dst_factor: One, operation: Add }
}

fn largest() -> wgpu::BlendComponent {
    use wgpu::{BlendFactor::One, BlendOperation::Max};
    wgpu::BlendComponent { src_factor: One, dst_factor: One, operation: Max }
}

/// The target times what the source leaves clear.
fn multiplied() -> wgpu::BlendComponent {
    use wgpu::{BlendFactor, BlendOperation::Add};
    let dst_factor = BlendFactor::OneMinusSrc;
    wgpu::BlendComponent { src_factor: BlendFactor::Zero, dst_factor, operation: Add }
}
