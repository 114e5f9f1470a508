//! How surfaces of interchange files are drawn: their programs, and pipelines that are built when the first
//! part needs them, so that faces without such parts never wait for them.

use crate::frame::part_pipelines::{Layouts, NORMAL_FORMAT, cut_shadow_buffers, standard_buffers};
use crate::frame::programs::{Standards, standards};
use crate::frame::vertices::{Vertices, build as build_parts};
use crate::gpu::pipeline::{Recipe, color_target};
use crate::gpu::program::Program;
use crate::model::effects::Effects;
use crate::model::part::ModelPart;
use crate::view::config::RendererConfig;
use std::sync::OnceLock;

/// What a pipeline is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// The shadow of what has holes.
    CutShadow,
    /// Depth and normals of what has holes.
    CutPrepass,
    /// What is opaque.
    Opaque,
    /// What has holes.
    Cut,
    /// The line around a cartoon.
    Outline,
    /// What is blended.
    Blended,
}

/// Which sides are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sides {
    Both,
    Front,
    Back,
}

impl Sides {
    pub(crate) fn of(is_double_sided: bool) -> Self {
        if is_double_sided { Self::Both } else { Self::Front }
    }

    fn cull_mode(self) -> Option<wgpu::Face> {
        match self {
            Self::Both => None,
            Self::Front => Some(wgpu::Face::Back),
            Self::Back => Some(wgpu::Face::Front),
        }
    }
}

const STEPS: usize = 6;
const SIDES: usize = 3;

/// The pipelines by step, sides, and whether vertices have second texture coordinates or colours.
#[derive(Debug)]
pub(crate) struct StandardPipelines {
    device: wgpu::Device,
    vertices: Vertices,
    built: [OnceLock<wgpu::RenderPipeline>; STEPS * SIDES * 2],
}

impl StandardPipelines {
    pub(crate) fn new(device: &wgpu::Device, vertices: Vertices) -> Self {
        Self { device: device.clone(), vertices, built: [const { OnceLock::new() }; STEPS * SIDES * 2] }
    }

    /// The pipeline for a part.
    pub(crate) fn get(
        &self,
        layouts: &Layouts,
        config: RendererConfig,
        step: Step,
        sides: Sides,
        part: &ModelPart,
    ) -> &wgpu::RenderPipeline {
        let has_extras = part.geometry.extras.is_some();
        let place = (step as usize * SIDES + sides as usize) * 2 + usize::from(has_extras);
        let build = || build(&self.device, layouts, config, self.vertices, (step, sides, has_extras));
        self.built[place].get_or_init(build)
    }
}

/// The program of a step, with or without extras.
fn program(of: &Standards, step: Step, has_extras: bool) -> Program {
    let [without, with] = match step {
        Step::CutShadow => of.cut_shadow,
        Step::CutPrepass => of.cut_prepass,
        Step::Opaque => of.opaque,
        Step::Cut => of.cut,
        Step::Outline => of.outline,
        Step::Blended => of.blended,
    };
    if has_extras { with } else { without }
}

fn build(
    device: &wgpu::Device,
    layouts: &Layouts,
    config: RendererConfig,
    vertices: Vertices,
    (step, sides, has_extras): (Step, Sides, bool),
) -> wgpu::RenderPipeline {
    use wgpu::CompareFunction::{Greater, Less};
    let program = program(&standards(config.shading), step, has_extras);
    // Depth is reversed: nearer is greater. Those of shadows are not.
    let picture = (Greater, true, config.samples, color_target(config.color_format, None));
    let (compare, writes, samples, target) = match step {
        Step::CutShadow => (Less, true, 1, None),
        Step::CutPrepass => (Greater, true, 1, color_target(NORMAL_FORMAT, None)),
        Step::Opaque | Step::Cut | Step::Outline => picture,
        Step::Blended => {
            let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
            (Greater, false, config.samples, color_target(config.color_format, Some(over)))
        }
    };
    let is_shadow = step == Step::CutShadow;
    let slope_scale = if is_shadow { 1.0 } else { 0.0 };
    let recipe = Recipe {
        program: &program,
        layout: if is_shadow { &layouts.cut_shadow_pipeline } else { &layouts.pipeline }.of(vertices),
        topology: wgpu::PrimitiveTopology::TriangleList,
        buffers: &if is_shadow { cut_shadow_buffers(has_extras) } else { standard_buffers(has_extras) },
        cull_mode: sides.cull_mode(),
        depth: Some((compare, writes)),
        bias: wgpu::DepthBiasState { constant: 0, slope_scale, clamp: 0.0 },
        samples,
        target,
        beside: None,
    };
    build_parts(&recipe, device, config, Effects::TONES, vertices)
}
