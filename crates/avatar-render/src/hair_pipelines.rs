//! Builds the pipelines that draw strands.

use crate::pipelines::{Layouts, Recipe, color_target};
use crate::renderer::RendererConfig;
use crate::resources::HAIR_MAP_FORMAT;
use crate::shaders::{
    COMPOSE_HAIR, COMPOSE_HAIR_DEPTH, Constants, HAIR_SHADOW_PASS, LAYERED_STRANDS, MASKED_STRANDS,
    STRAND_LAYERS, STRAND_SLICES,
};
use crate::targets::{HAIR_CLEAR_FORMAT, HAIR_SUM_FORMAT};

/// The pipelines of all passes that draw strands.
#[derive(Debug)]
pub(crate) struct HairPipelines {
    /// What the key sees of hair, where the shading has shadows.
    pub(crate) shadow: Option<wgpu::RenderPipeline>,
    pub(crate) strands: Strands,
}

/// How strands get into the picture.
#[derive(Debug)]
pub(crate) enum Strands {
    /// Each covers some of a pixel's samples.
    Masked(wgpu::RenderPipeline),
    /// Where pixels have one sample: where they lie, how much they cover at each depth, all of them blended, and
    /// the two steps that lay them over the picture: colour and depth.
    Layered {
        layers: wgpu::RenderPipeline,
        slices: wgpu::RenderPipeline,
        blended: wgpu::RenderPipeline,
        compose: [wgpu::RenderPipeline; 2],
    },
}

impl HairPipelines {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts, config: RendererConfig) -> Self {
        use wgpu::CompareFunction::{Always, Greater};
        let terms = config.shading.terms();
        let constants = Constants::of(config);
        let ribbons = Recipe {
            program: &MASKED_STRANDS,
            layout: &layouts.hair,
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            buffers: &[],
            // Ribbons have no sides.
            cull_mode: None,
            depth: Some((Greater, true)),
            bias: Default::default(),
            samples: config.samples,
            target: color_target(config.color_format, None),
            beside: None,
        };
        let shadow = (terms.shadows.lamps() > 0).then(|| {
            let recipe = Recipe {
                program: &HAIR_SHADOW_PASS,
                depth: None,
                samples: 1,
                target: blended(HAIR_MAP_FORMAT, added(), largest()),
                ..ribbons.again()
            };
            recipe.build(device, &constants)
        });
        if constants.coverage_mask {
            return Self { shadow, strands: Strands::Masked(ribbons.build(device, &constants)) };
        }
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        let compose = Recipe {
            program: &COMPOSE_HAIR,
            layout: &layouts.whole_picture,
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth: Some((Always, false)),
            target: blended(config.color_format, over.color, over.alpha),
            ..ribbons.again()
        };
        let compose_depth = Recipe {
            program: &COMPOSE_HAIR_DEPTH,
            depth: Some((Greater, true)),
            target: Some(wgpu::ColorTargetState {
                write_mask: wgpu::ColorWrites::empty(),
                ..config.color_format.into()
            }),
            ..compose.again()
        };
        let layers = Recipe {
            program: &STRAND_LAYERS,
            depth: Some((Greater, false)),
            target: blended(HAIR_SUM_FORMAT, added(), largest()),
            ..ribbons.again()
        };
        let slices = Recipe {
            program: &STRAND_SLICES,
            target: blended(HAIR_SUM_FORMAT, added(), added()),
            beside: blended(HAIR_SUM_FORMAT, added(), added()),
            ..layers.again()
        };
        let layered = Recipe {
            program: &LAYERED_STRANDS,
            depth: Some((Greater, false)),
            target: blended(HAIR_SUM_FORMAT, added(), added()),
            beside: blended(HAIR_CLEAR_FORMAT, multiplied(), multiplied()),
            ..ribbons.again()
        };
        let strands = Strands::Layered {
            layers: layers.build(device, &constants),
            slices: slices.build(device, &constants),
            blended: layered.build(device, &constants),
            compose: [compose, compose_depth].map(|recipe| recipe.build(device, &constants)),
        };
        Self { shadow, strands }
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

/// What is there, by what the source leaves clear.
fn multiplied() -> wgpu::BlendComponent {
    use wgpu::{BlendFactor, BlendOperation::Add};
    let dst_factor = BlendFactor::OneMinusSrc;
    wgpu::BlendComponent { src_factor: BlendFactor::Zero, dst_factor, operation: Add }
}
