//! What draws avatars: pipelines, tables and shadow maps.

use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use crate::deform::deformer::Deformer;
use crate::frame::far_to_near::FarToNear;
use crate::frame::part_pipelines::Layouts;
use crate::frame::pipelines::PartPipelines;
use crate::frame::vertices::Vertices;
use crate::gpu::identity::Identity;
use crate::gpu::ring::Ring;
use crate::hair::grower::Grower;
use crate::hair::pipelines::{HairPipelines, HairViews};
use crate::model::part::ModelPart;
use crate::view::config::RendererConfig;
use crate::view::lamps::SHADOW_COUNT;
use crate::view::resources::Resources;
use crate::view::scene::Scene;
use crate::view::shadows::GpuShadowView;
use std::sync::{Mutex, OnceLock};

/// Why there is no renderer for a configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RendererError {
    /// Another number of samples than WebGPU promises.
    #[error("expected 1 or 4 samples, found {found}")]
    Samples {
        /// The number.
        found: u32,
    },
    /// A format that cannot be drawn into, blended or resolved with so many samples on every device.
    #[error(
        "expected a colour format that can be drawn, blended and resolved at {samples} samples, found {found:?}"
    )]
    Format {
        /// The format.
        found: wgpu::TextureFormat,
        /// Samples per pixel.
        samples: u32,
    },
}

/// Draws avatars into texture views of one format.
#[derive(Debug)]
pub struct Renderer {
    id: Identity,
    config: RendererConfig,
    pub(crate) resources: Resources,
    pub(crate) layouts: Layouts,
    pub(crate) deformer: Deformer,
    pub(crate) parts: PartPipelines,
    /// Made for the first picture with a crowd.
    crowd_parts: OnceLock<PartPipelines>,
    pub(crate) grower: Grower,
    pub(crate) device: wgpu::Device,
    /// Made for the first picture with hair.
    hair: OnceLock<HairPipelines>,
    pub(crate) hair_views: HairViews,
    pub(crate) shadow_views: Ring<GpuShadowView>,
    pub(crate) shadow_group: wgpu::BindGroup,
    /// Memory for the order of transparent parts.
    pub(crate) far_to_near: Mutex<FarToNear>,
}

impl Renderer {
    /// Builds the tables and shadow maps, and the pipelines of faces at rest in their own colours. Those of
    /// wrinkles, of other colours, of hair and of surfaces of interchange files are built for the first
    /// picture with some; [`Renderer::prepare`] builds the first two ahead.
    ///
    /// # Errors
    /// A number of samples or a format that not every device draws.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        config: RendererConfig,
    ) -> Result<Self, RendererError> {
        check_config(device, config)?;
        let resources = Resources::new(device, queue, config.shading.terms());
        let layouts = Layouts::new(device, &resources.layout);
        let shadow_views = Ring::new(device, "shadow views", SHADOW_COUNT as u32);
        let shadow_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow view"),
            layout: &layouts.shadow,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: shadow_views.binding() }],
        });
        Ok(Self {
            id: Identity::new(),
            config,
            deformer: Deformer::new(device),
            grower: Grower::new(device),
            device: device.clone(),
            hair: OnceLock::new(),
            hair_views: HairViews::new(device),
            parts: PartPipelines::new(device, &layouts, config, Vertices::OfOne),
            crowd_parts: OnceLock::new(),
            resources,
            layouts,
            shadow_views,
            shadow_group,
            far_to_near: Mutex::default(),
        })
    }

    /// Builds what draws hair that hangs still at once, rather than for the first picture with some: where
    /// the hair is still on its way, that time is free. `is_draft` is for hair that is drawn coarsely
    /// ([`HairDetail::draft`](crate::HairDetail::draft)).
    pub fn prepare_hair(&self, is_draft: bool) {
        self.grower.still();
        match is_draft {
            true => {
                self.hair().draft(&self.device);
            }
            false => {
                self.hair().fine(&self.device);
            }
        }
    }

    /// What it was built for.
    pub fn config(&self) -> RendererConfig {
        self.config
    }

    /// Builds what faces of this model need in this scene as they look now, at rest and with wrinkles, so
    /// that the first smile does not wait for its pipelines. Call it when there is time, such as after the
    /// first picture. Where software draws, [`Renderer::rehearse`] does more.
    pub fn prepare(&self, scene: &Scene, model: &AvatarModel) {
        for (_, part) in model.parts_with_triangles().filter(|(_, part)| part.finish.get().is_none()) {
            for is_wrinkled in [false, true] {
                self.parts.prepare(&self.layouts, part, part.effects(is_wrinkled, scene.light.tone_map));
            }
        }
    }

    /// Whether a frame of these avatars as they are now builds nothing for their faces first: the time of
    /// another one tells nothing about the next.
    pub fn is_ready(&self, scene: &Scene, avatars: &[(&AvatarModel, &AvatarState)]) -> bool {
        avatars.iter().all(|(model, state)| {
            let mut parts = model.parts_with_triangles().filter(|(_, part)| part.finish.get().is_none());
            let effects = |part: &ModelPart| part.effects(state.pose.is_wrinkled(), scene.light.tone_map);
            parts.all(|(_, part)| self.parts.are_built(part, effects(part)))
        })
    }

    /// What draws strands.
    pub(crate) fn hair(&self) -> &HairPipelines {
        self.hair.get_or_init(|| HairPipelines::new(&self.device, &self.resources.layout, self.config))
    }

    /// What draws the parts of crowds.
    pub(crate) fn crowd_parts(&self) -> &PartPipelines {
        let build = || PartPipelines::new(&self.device, &self.layouts, self.config, Vertices::OfCrowd);
        self.crowd_parts.get_or_init(build)
    }

    /// Tells renderers apart.
    pub(crate) fn id(&self) -> Identity {
        self.id
    }
}

fn check_config(device: &wgpu::Device, config: RendererConfig) -> Result<(), RendererError> {
    if !matches!(config.samples, 1 | 4) {
        return Err(RendererError::Samples { found: config.samples });
    }
    let features = config.color_format.guaranteed_format_features(device.features());
    let mut needed = wgpu::TextureFormatFeatureFlags::BLENDABLE;
    if config.samples > 1 {
        needed |= wgpu::TextureFormatFeatureFlags::MULTISAMPLE_RESOLVE;
    }
    let drawable = features.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
    match drawable && features.flags.contains(needed) && !config.color_format.is_depth_stencil_format() {
        true => Ok(()),
        false => Err(RendererError::Format { found: config.color_format, samples: config.samples }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::targets::Targets;
    use crate::gpu::device::gpu_for_tests;
    use crate::view::camera::Camera;
    use crate::view::scene::Scene;
    use crate::view::shading::{Shading, Terms};
    use avatar_look::Light;

    #[test]
    fn what_hair_needs_is_not_made_without_hair() {
        let Some(gpu) = gpu_for_tests() else { return };
        let (color_format, samples) = (wgpu::TextureFormat::Rgba8UnormSrgb, 4);
        let config = RendererConfig { color_format, samples, shading: Shading::Natural(Terms::LOW) };
        let renderer = Renderer::new(&gpu.device, &gpu.queue, config).expect("a renderer");
        let targets = Targets::new(&gpu.device, &renderer, 8, 8).expect("targets");
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("test"),
            size: wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: color_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let view =
            texture.create_view(&wgpu::TextureViewDescriptor { label: Some("test"), ..Default::default() });
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("test") });
        let model = crate::AvatarModel::new(&gpu.device, &gpu.queue, &[], 1).expect("no parts");
        let avatar = crate::AvatarState::new(&gpu.device, &model);
        let avatars = [(&model, &avatar)];
        let camera = Camera::orbit(glam::Vec3::ZERO, 0.0, 0.0, 1.0, 0.5, 1.0);
        let scene = Scene { camera, background: [0.0; 4], light: Light::default() };
        let drawn = renderer.draw(&mut encoder, &view, &targets, &gpu.queue, &scene, &avatars);
        assert_eq!(drawn, Ok(()));
        assert!(renderer.hair.get().is_none() && !renderer.grower.is_built());
    }
}
