use crate::color::srgb_from_linear;
use crate::deformer::Deformer;
use crate::frame::{GpuFrame, Ring, SHADOW_COUNT};
use crate::grower::Grower;
use crate::hair_detail::GpuHairView;
use crate::hair_pipelines::HairPipelines;
use crate::passes::{Drawable, FRAME_PASSES, Pass, draw_order};
use crate::pipelines::{Layouts, PassPipelines, picture_pipeline, view_group};
use crate::record::Frame;
use crate::record_hair::strands_in_view;
use crate::resources::Resources;
use crate::seen::Seen;
use crate::shadows::ShadowViews;
use crate::{AvatarModel, AvatarState, PassTimer, Scene, Shading, Targets};
use std::sync::atomic::{AtomicU64, Ordering};

/// What a renderer draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RendererConfig {
    /// Format of the target. sRGB and float formats get linear values, other normalised formats get encoded ones;
    /// prefer an sRGB format (or an sRGB view), where the corneas are blended in linear light.
    pub color_format: wgpu::TextureFormat,
    /// Samples per pixel: 1 or 4.
    pub samples: u32,
    /// How parts are shaded; see [`Quality::shading`](crate::Quality::shading).
    pub shading: Shading,
}

impl RendererConfig {
    /// Whether the shaders encode their colours because the target does not.
    pub(crate) fn encodes_in_shader(self) -> bool {
        use wgpu::TextureFormat as F;
        matches!(
            self.color_format,
            F::R8Unorm
                | F::Rg8Unorm
                | F::Rgba8Unorm
                | F::Bgra8Unorm
                | F::Rgb10a2Unorm
                | F::R16Unorm
                | F::Rg16Unorm
                | F::Rgba16Unorm
                | F::R8Snorm
                | F::Rg8Snorm
                | F::Rgba8Snorm
                | F::R16Snorm
                | F::Rg16Snorm
                | F::Rgba16Snorm
        )
    }
}

/// Why there is no renderer for a configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
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

/// Why a frame was not drawn. Nothing was recorded then.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DrawError {
    /// The state of another model.
    #[error("avatar {avatar}: expected the state of its model, found that of another one")]
    StateOfAnotherModel {
        /// Position in the slice of avatars.
        avatar: usize,
    },
    /// Targets that were made for another renderer.
    #[error("expected targets made for this renderer, found those of another one")]
    TargetsOfAnotherRenderer,
    /// A view that cannot be drawn into with these targets.
    #[error(
        "expected a single-sampled view of {width}×{height} pixels in {format:?} that can be drawn into, found {found_width}×{found_height} in {found_format:?}"
    )]
    View {
        /// Width of the targets.
        width: u32,
        /// Height of the targets.
        height: u32,
        /// Format of the renderer.
        format: wgpu::TextureFormat,
        /// Width of the view's texture.
        found_width: u32,
        /// Height of the view's texture.
        found_height: u32,
        /// Format of the view's texture.
        found_format: wgpu::TextureFormat,
    },
}

/// WGSL `ShadowView`: what the shadow pass of one lamp needs.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuShadowView {
    pub(crate) shadow_from_world: [[f32; 4]; 4],
}

/// Two for each avatar with hair: its shadow and itself.
const HAIR_VIEWS_PER_FRAME: u32 = 48;

/// Draws avatars into texture views of one format.
#[derive(Debug)]
pub struct Renderer {
    id: u64,
    config: RendererConfig,
    pub(crate) resources: Resources,
    layouts: Layouts,
    pub(crate) deformer: Deformer,
    pub(crate) passes: PassPipelines,
    /// In the order of drawing.
    pub(crate) picture: Vec<(Drawable, wgpu::RenderPipeline)>,
    pub(crate) grower: Grower,
    pub(crate) hair: HairPipelines,
    pub(crate) hair_views: Ring<GpuHairView>,
    pub(crate) hair_view_group: wgpu::BindGroup,
    pub(crate) shadow_views: Ring<GpuShadowView>,
    pub(crate) shadow_group: wgpu::BindGroup,
}

impl Renderer {
    /// Builds the pipelines, tables and shadow maps.
    ///
    /// # Errors
    /// A number of samples or a format that not every device draws.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        config: RendererConfig,
    ) -> Result<Self, RendererError> {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        check_config(device, config)?;
        let resources = Resources::new(device, queue, config.shading.terms());
        let layouts = Layouts::new(device, &resources.layout);
        let shadow_views = Ring::new(device, "shadow views", SHADOW_COUNT as u32);
        let shadow_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow view"),
            layout: &layouts.shadow,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: shadow_views.binding() }],
        });
        let hair_views = Ring::new(device, "views of hair", HAIR_VIEWS_PER_FRAME);
        let hair_view_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view of hair"),
            layout: &layouts.hair_view,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: hair_views.binding() }],
        });
        Ok(Self {
            id: NEXT.fetch_add(1, Ordering::Relaxed),
            config,
            deformer: Deformer::new(device),
            grower: Grower::new(device),
            hair: HairPipelines::new(device, &layouts, config),
            hair_views,
            hair_view_group,
            passes: PassPipelines::new(device, &layouts, config),
            picture: (draw_order(config.shading).into_iter())
                .map(|drawable| (drawable, picture_pipeline(device, &layouts, &drawable, config)))
                .collect(),
            resources,
            layouts,
            shadow_views,
            shadow_group,
        })
    }

    /// What it was built for.
    pub fn config(&self) -> RendererConfig {
        self.config
    }

    /// Tells renderers apart.
    pub(crate) fn id(&self) -> u64 {
        self.id
    }

    pub(crate) fn view_group(
        &self,
        device: &wgpu::Device,
        label: &str,
        views: [&wgpu::TextureView; 4],
        hair_map: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        view_group(device, &self.layouts, &self.resources, label, views, hair_map)
    }

    /// Records one frame: clears `view`, then draws all avatars. Colours are premultiplied by alpha in the view.
    ///
    /// Shadow maps are fitted around the avatars in the picture, but for those that look less than an eighth as large as the
    /// largest; what is beyond the map is in no cast shadow. All in a lamp's way cast shadows, in the picture or not. How soft
    /// shadows are and how far hollows darken follows from the height of the avatar that looks largest.
    ///
    /// Neighbours in `avatars` that share a model share its bindings as well. Up to 256 frames may be recorded before a
    /// submission, with 4096 heads of hair in all; they share one environment, the last one's. A change of the environment takes some milliseconds.
    ///
    /// # Errors
    /// A view, targets or states that do not belong together; nothing is recorded then.
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        targets: &Targets,
        queue: &wgpu::Queue,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), DrawError> {
        self.draw_timed(encoder, view, targets, queue, scene, avatars, None)
    }

    /// [`Renderer::draw`] that notes when each pass starts and ends.
    ///
    /// # Errors
    /// As above.
    #[allow(clippy::too_many_arguments, reason = "those of `draw` and one more")]
    pub fn draw_timed(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        targets: &Targets,
        queue: &wgpu::Queue,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        timer: Option<&PassTimer>,
    ) -> Result<(), DrawError> {
        self.check(view, targets, avatars)?;
        let terms = self.config.shading.terms();
        let boxes = avatars.iter().map(|(model, state)| (state.bounds(model), model.height));
        let seen = Seen::new(&scene.camera, boxes.clone());
        let casters = boxes.filter_map(|(bounds, _)| bounds);
        let shadows = ShadowViews::new(&scene.light, seen.bounds, casters, terms.shadows);
        let irradiance = self.resources.irradiance(queue, &scene.light.environment, terms);
        let mut gpu_frame = GpuFrame::new(scene, &irradiance, &shadows, targets.size(), seen.height);
        let pixels_per_unit = gpu_frame.pixels_per_unit;
        let has_hair = avatars.iter().any(|(model, state)| {
            strands_in_view(model, state, scene, pixels_per_unit, f32::INFINITY).is_some()
        });
        if has_hair {
            gpu_frame.set_hair(&scene.camera, seen.bounds, Pass::HairShadow.runs(terms, has_hair));
        }
        let frame = Frame {
            renderer: self,
            view,
            targets,
            scene,
            avatars,
            clear: self.clear_color(scene.background),
            frame_offset: self.resources.frames.push(queue, &gpu_frame),
            shadow_offsets: shadows.0.map(|view| {
                let shadow_from_world = view.shadow_from_world.to_cols_array_2d();
                self.shadow_views.push(queue, &GpuShadowView { shadow_from_world })
            }),
            timer,
            has_hair,
            pixels_per_unit,
            queue,
        };
        let passes = || FRAME_PASSES.into_iter().filter(|pass| pass.runs(terms, has_hair));
        for pass in passes() {
            frame.record(encoder, pass);
        }
        if let Some(timer) = timer {
            timer.finish(encoder, passes());
        }
        Ok(())
    }

    fn clear_color(&self, [r, g, b, a]: [f32; 4]) -> wgpu::Color {
        let channel = |linear: f32| {
            let encoded = if self.config.encodes_in_shader() { srgb_from_linear(linear) } else { linear };
            f64::from(encoded * a)
        };
        wgpu::Color { r: channel(r), g: channel(g), b: channel(b), a: f64::from(a) }
    }

    fn check(
        &self,
        view: &wgpu::TextureView,
        targets: &Targets,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), DrawError> {
        if targets.renderer != self.id {
            return Err(DrawError::TargetsOfAnotherRenderer);
        }
        let texture = view.texture();
        // A view of a smaller mip level does not tell its size.
        let size_fits = texture.mip_level_count() > 1
            || (texture.width() == targets.width && texture.height() == targets.height);
        // A view may differ from its texture in being sRGB.
        let format_fits =
            texture.format().remove_srgb_suffix() == self.config.color_format.remove_srgb_suffix();
        let drawable = texture.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        if !(size_fits && format_fits && drawable && texture.sample_count() == 1) {
            return Err(DrawError::View {
                width: targets.width,
                height: targets.height,
                format: self.config.color_format,
                found_width: texture.width(),
                found_height: texture.height(),
                found_format: texture.format(),
            });
        }
        match avatars.iter().position(|(model, state)| !state.fits(model)) {
            Some(avatar) => Err(DrawError::StateOfAnotherModel { avatar }),
            None => Ok(()),
        }
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

    #[test]
    fn every_normalised_format_without_srgb_gets_encoded_colours_and_no_other() {
        use wgpu::TextureFormat as F;
        for color_format in [
            F::R8Unorm,
            F::R8Snorm,
            F::R16Unorm,
            F::R16Snorm,
            F::R16Float,
            F::Rg8Unorm,
            F::Rg8Snorm,
            F::R32Float,
            F::Rg16Unorm,
            F::Rg16Snorm,
            F::Rg16Float,
            F::Rgba8Unorm,
            F::Rgba8UnormSrgb,
            F::Rgba8Snorm,
            F::Bgra8Unorm,
            F::Bgra8UnormSrgb,
            F::Rgb10a2Unorm,
            F::Rg11b10Ufloat,
            F::Rgba16Unorm,
            F::Rgba16Snorm,
            F::Rgba16Float,
            F::Rgba32Float,
        ] {
            let config = RendererConfig { color_format, samples: 1, shading: Shading::Plain };
            let is_normalised = format!("{color_format:?}").ends_with("norm");
            assert_eq!(config.encodes_in_shader(), is_normalised, "{color_format:?}");
        }
    }
}
