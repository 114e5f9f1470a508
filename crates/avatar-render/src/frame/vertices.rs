//! Pipelines that draw parts, of one avatar or of a crowd.

use crate::frame::crowd_programs::crowd_vertices;
use crate::gpu::pipeline::Recipe;
use crate::model::effects::Effects;
use crate::view::config::RendererConfig;

/// Where the vertices of a draw come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Vertices {
    /// Buffers of one avatar.
    OfOne,
    /// The buffer of a crowd; an avatar is an instance.
    OfCrowd,
}

/// The layouts of pipelines that draw parts, by where their vertices come from.
#[derive(Debug)]
pub(crate) struct PipelineLayouts {
    of_one: wgpu::PipelineLayout,
    of_crowd: wgpu::PipelineLayout,
}

impl PipelineLayouts {
    /// Of these groups, 0 to 2, and that of crowds as group 3.
    pub(crate) fn new(
        device: &wgpu::Device,
        label: &str,
        groups: [Option<&wgpu::BindGroupLayout>; 3],
        crowd: &wgpu::BindGroupLayout,
    ) -> Self {
        let layout = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let used = groups.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        let [a, b, c] = groups;
        Self { of_one: layout(&groups[..used]), of_crowd: layout(&[a, b, c, Some(crowd)]) }
    }

    pub(crate) fn of(&self, vertices: Vertices) -> &wgpu::PipelineLayout {
        match vertices {
            Vertices::OfOne => &self.of_one,
            Vertices::OfCrowd => &self.of_crowd,
        }
    }
}

/// Builds the pipeline of a recipe that draws parts with these effects.
pub(crate) fn build(
    recipe: &Recipe<'_>,
    device: &wgpu::Device,
    config: RendererConfig,
    effects: Effects,
    vertices: Vertices,
) -> wgpu::RenderPipeline {
    let mut choices = config.choices();
    choices.extend(effects.choices());
    let of_crowd = crowd_vertices(recipe.program.entry).filter(|_| vertices == Vertices::OfCrowd);
    let Some(stage) = of_crowd else { return recipe.build(device, &choices) };
    // What crowds read from storage has no slot: positions and normals, and the bone of an instance.
    let is_own = |buffer: &&wgpu::VertexBufferLayout<'_>| {
        let is_posed = buffer.attributes.iter().any(|one| one.format == wgpu::VertexFormat::Float32x3);
        buffer.step_mode == wgpu::VertexStepMode::Vertex && !is_posed
    };
    let buffers: Vec<_> = recipe.buffers.iter().map(|slot| slot.as_ref().filter(is_own).cloned()).collect();
    Recipe { buffers: &buffers, ..recipe.clone() }.build_with(device, &choices, stage)
}
