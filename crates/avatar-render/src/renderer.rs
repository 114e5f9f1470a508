use crate::color::srgb_from_linear;
use crate::drawable::{DRAW_ORDER, Drawable, Layouts, pipeline};
use crate::frame::{FrameRing, GpuFrame};
use crate::model::ModelPart;
use crate::{AvatarModel, AvatarState, Scene, Targets};

/// What a renderer draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RendererConfig {
    /// Format of the target. sRGB and float formats get linear values, other normalised formats get encoded ones;
    /// prefer an sRGB format (or an sRGB view), where the corneas are blended in linear light.
    pub color_format: wgpu::TextureFormat,
    /// Samples per pixel: 1 or 4.
    pub samples: u32,
}

impl RendererConfig {
    /// Whether the shaders encode their colours because the target does not.
    pub(crate) fn encodes_in_shader(self) -> bool {
        use wgpu::TextureFormat as F;
        matches!(self.color_format, F::Rgba8Unorm | F::Bgra8Unorm | F::Rgb10a2Unorm | F::Rgba16Unorm)
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
    /// Targets that were made for another configuration.
    #[error("expected targets made for this renderer, found those of another configuration")]
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

/// Draws avatars into texture views of one format.
#[derive(Debug)]
pub struct Renderer {
    config: RendererConfig,
    frames: FrameRing,
    /// In the order of [`DRAW_ORDER`].
    pipelines: [wgpu::RenderPipeline; DRAW_ORDER.len()],
}

impl Renderer {
    /// Builds the pipelines.
    ///
    /// # Errors
    /// A number of samples or a format that not every device draws.
    pub fn new(device: &wgpu::Device, config: RendererConfig) -> Result<Self, RendererError> {
        check_config(device, config)?;
        let layouts = Layouts::new(device);
        Ok(Self {
            config,
            frames: FrameRing::new(device, &layouts.frame),
            pipelines: DRAW_ORDER.map(|drawable| pipeline(device, &layouts, &drawable, config)),
        })
    }

    /// What it was built for.
    pub fn config(&self) -> RendererConfig {
        self.config
    }

    /// Records one frame: clears `view`, then draws all avatars. Colours are premultiplied by alpha in the view.
    ///
    /// Neighbours in `avatars` that share a model share its bindings as well. Up to 256 frames may be recorded before a
    /// submission.
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
        self.check(view, targets, avatars)?;
        let frame_offset = self.frames.push(queue, &GpuFrame::new(scene));
        let mut pass = begin_pass(encoder, view, targets, self.clear_color(scene.background));
        pass.set_bind_group(0, &self.frames.bind_group, &[frame_offset]);
        for (drawable, pipeline) in DRAW_ORDER.iter().zip(&self.pipelines) {
            pass.push_debug_group(drawable.label);
            pass.set_pipeline(pipeline);
            match drawable.is_transparent() {
                false => draw_opaque(&mut pass, drawable, avatars),
                true => draw_far_to_near(&mut pass, drawable, scene, avatars),
            }
            pass.pop_debug_group();
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
        if targets.format != self.config.color_format
            || targets.multisampled.is_some() != (self.config.samples > 1)
        {
            return Err(DrawError::TargetsOfAnotherRenderer);
        }
        let texture = view.texture();
        // A view of a smaller mip level does not tell its size.
        let size_fits = texture.mip_level_count() > 1
            || (texture.width() == targets.width && texture.height() == targets.height);
        // A view may differ from its texture in being sRGB.
        let format_fits = texture.format().remove_srgb_suffix() == targets.format.remove_srgb_suffix();
        let drawable = texture.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        if !(size_fits && format_fits && drawable && texture.sample_count() == 1) {
            return Err(DrawError::View {
                width: targets.width,
                height: targets.height,
                format: targets.format,
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

fn begin_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    targets: &Targets,
    clear: wgpu::Color,
) -> wgpu::RenderPass<'a> {
    let (color, resolve, store) = match &targets.multisampled {
        Some(multisampled) => (multisampled, Some(view), wgpu::StoreOp::Discard),
        None => (view, None, wgpu::StoreOp::Store),
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("avatars"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: resolve,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &targets.depth,
            // Depth is reversed: 0 is far.
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

fn draw_opaque(
    pass: &mut wgpu::RenderPass<'_>,
    drawable: &Drawable,
    avatars: &[(&AvatarModel, &AvatarState)],
) {
    for group in avatars.chunk_by(|(a, _), (b, _)| std::ptr::eq(*a, *b)) {
        let Some((model, _)) = group.first() else { continue };
        for part in model.parts_of(drawable.kind) {
            bind_part(pass, part);
            for (_, state) in group {
                draw_part(pass, part, state);
            }
        }
    }
}

fn draw_far_to_near(
    pass: &mut wgpu::RenderPass<'_>,
    drawable: &Drawable,
    scene: &Scene,
    avatars: &[(&AvatarModel, &AvatarState)],
) {
    let eye = scene.camera.eye();
    let mut parts: Vec<(f32, &ModelPart, &AvatarState)> = avatars
        .iter()
        .flat_map(|(model, state)| model.parts_of(drawable.kind).map(move |part| (part, *state)))
        .map(|(part, state)| (state.center_of(&part.geometry).distance_squared(eye), part, state))
        .collect();
    parts.sort_by(|(a, ..), (b, ..)| b.total_cmp(a));
    for (_, part, state) in parts {
        bind_part(pass, part);
        draw_part(pass, part, state);
    }
}

fn bind_part(pass: &mut wgpu::RenderPass<'_>, part: &ModelPart) {
    pass.set_bind_group(2, &part.geometry.bind_group, &[]);
    pass.set_bind_group(3, &part.look, &[]);
    pass.set_index_buffer(part.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
}

fn draw_part(pass: &mut wgpu::RenderPass<'_>, part: &ModelPart, state: &AvatarState) {
    pass.set_bind_group(1, &state.bind_group, &[]);
    pass.insert_debug_marker(&part.label);
    pass.draw_indexed(0..part.geometry.index_count, 0, 0..1);
}
