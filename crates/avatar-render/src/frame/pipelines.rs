//! All pipelines that draw parts.

use crate::frame::drawables::{Drawable, draw_order};
use crate::frame::part_pipelines::{Layouts, PassPipelines, picture_pipeline, skin_light_pipeline};
use crate::frame::standard::StandardPipelines;
use crate::frame::vertices::Vertices;
use crate::model::effects::Effects;
use crate::model::part::ModelPart;
use crate::view::config::RendererConfig;
use avatar_mesh::PartKind;
use std::sync::OnceLock;

/// Pipelines that differ in their effects alone. The one without effects is made at once, each other one
/// when a part first needs it.
type ByEffects = [OnceLock<wgpu::RenderPipeline>; Effects::COUNT];

/// All pipelines that draw parts, by where their vertices come from.
#[derive(Debug)]
pub(crate) struct PartPipelines {
    device: wgpu::Device,
    config: RendererConfig,
    vertices: Vertices,
    pub(crate) passes: PassPipelines,
    skin_light: ByEffects,
    /// In the order of drawing.
    picture: Vec<(Drawable, ByEffects)>,
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
        let parts = Self {
            device: device.clone(),
            config,
            vertices,
            passes: PassPipelines::new(device, layouts, config, vertices),
            skin_light: Default::default(),
            picture: drawn.map(|drawable| (drawable, ByEffects::default())).collect(),
            standard: StandardPipelines::new(device, vertices),
        };
        // Faces at rest in their own colours: programs make them while textures are read.
        for (place, _) in parts.drawables() {
            parts.in_picture(layouts, place, Effects::NONE);
        }
        parts.skin_light(layouts, Effects::NONE);
        parts
    }

    /// What is drawn in the picture, in the order of drawing, with its place.
    pub(crate) fn drawables(&self) -> impl Iterator<Item = (usize, &Drawable)> {
        self.picture.iter().map(|(drawable, _)| drawable).enumerate()
    }

    /// The pipeline of the drawable at this place, for parts that need these effects.
    pub(crate) fn in_picture(
        &self,
        layouts: &Layouts,
        place: usize,
        effects: Effects,
    ) -> Option<&wgpu::RenderPipeline> {
        let (drawable, built) = self.picture.get(place)?;
        let effects = effects.among(drawable.effects);
        let build = || picture_pipeline(&self.device, layouts, drawable, self.config, effects, self.vertices);
        Some(built.get(effects.place())?.get_or_init(build))
    }

    /// Whether everything is made that draws this part with these effects.
    pub(crate) fn are_built(&self, part: &ModelPart, effects: Effects) -> bool {
        let is_built = |built: &ByEffects, known: Effects| {
            built.get(effects.among(known).place()).is_none_or(|pipeline| pipeline.get().is_some())
        };
        let is_lit_before = part.kind == PartKind::Skin && self.config.shading.terms().separable();
        let mut drawn = self.picture.iter().filter(|(drawable, _)| drawable.kind == part.kind);
        drawn.all(|(drawable, built)| is_built(built, drawable.effects))
            && (!is_lit_before || is_built(&self.skin_light, Effects::LOOKS))
    }

    /// Makes what draws this part with these effects.
    pub(crate) fn prepare(&self, layouts: &Layouts, part: &ModelPart, effects: Effects) {
        for (place, _) in self.drawables().filter(|(_, drawable)| drawable.kind == part.kind) {
            self.in_picture(layouts, place, effects);
        }
        if part.kind == PartKind::Skin {
            self.skin_light(layouts, effects);
        }
    }

    /// The pipeline that lights the skin before light spreads below it, where the shading has that.
    pub(crate) fn skin_light(&self, layouts: &Layouts, effects: Effects) -> Option<&wgpu::RenderPipeline> {
        let effects = effects.among(Effects::LOOKS);
        let built = self.skin_light.get(effects.place()).filter(|_| self.config.shading.terms().separable());
        let build = || skin_light_pipeline(&self.device, layouts, self.config, effects, self.vertices);
        Some(built?.get_or_init(build))
    }
}
