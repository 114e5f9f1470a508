//! All pipelines that draw parts.

use crate::frame::drawables::{Drawable, draw_order};
use crate::frame::part_pipelines::{Layouts, PassPipelines, picture_pipeline};
use crate::frame::standard::StandardPipelines;
use crate::frame::vertices::Vertices;
use crate::view::config::RendererConfig;

/// All pipelines that draw parts, by where their vertices come from.
#[derive(Debug)]
pub(crate) struct PartPipelines {
    pub(crate) passes: PassPipelines,
    /// In the order of drawing.
    pub(crate) picture: Vec<(Drawable, wgpu::RenderPipeline)>,
    /// Of surfaces of interchange files.
    pub(crate) standard: StandardPipelines,
}

impl PartPipelines {
    pub(crate) fn new(
        device: &wgpu::Device,
        layouts: &Layouts,
        config: RendererConfig,
        vertices: Vertices,
    ) -> Self {
        let drawn = draw_order(config.shading).into_iter();
        Self {
            passes: PassPipelines::new(device, layouts, config, vertices),
            picture: drawn
                .map(|drawable| (drawable, picture_pipeline(device, layouts, &drawable, config, vertices)))
                .collect(),
            standard: StandardPipelines::new(device, vertices),
        }
    }
}
