use crate::look_args::LookArgs;
use crate::scene::{self, BACKGROUND, SAMPLES, View};
use anyhow::{Context, Result, bail};
use avatar_groom::Hair;
use avatar_pack::{FaceState, Pack, Textures};
use avatar_render::headless::{Gpu, GpuOptions, open_for_surface_blocking};
use avatar_render::{AvatarModel, AvatarState, Renderer, RendererConfig, Targets};
use std::sync::Arc;
use wgpu::CurrentSurfaceTexture as Acquired;
use winit::dpi::PhysicalSize;
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

/// The window's surface and everything that draws on it.
pub(super) struct Stage {
    window: Arc<Window>,
    gpu: Gpu,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    renderer: Renderer,
    /// `None` while the window has no area.
    targets: Option<Targets>,
    model: AvatarModel,
    avatar: AvatarState,
    /// Of the hair, if there is any.
    style: Option<avatar_groom::Style>,
    look: LookArgs,
}

impl Stage {
    pub(super) fn open(
        window: Arc<Window>,
        display: OwnedDisplayHandle,
        pack: &Pack,
        textures: &Textures,
        look: LookArgs,
    ) -> Result<Self> {
        let instance =
            wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle(Box::new(display)));
        let surface =
            instance.create_surface(window.clone()).context("expected a surface to draw on, found none")?;
        let gpu = open_for_surface_blocking(instance, &surface, GpuOptions::default())?;

        let size = window.inner_size();
        let mut config = surface
            .get_default_config(&gpu.adapter, size.width.max(1), size.height.max(1))
            .context("expected an adapter that can draw on this surface")?;
        let formats = surface.get_capabilities(&gpu.adapter).formats;
        // Blending and resolving samples are right in linear light, which sRGB formats do in hardware.
        config.format = formats.iter().copied().find(wgpu::TextureFormat::is_srgb).unwrap_or(config.format);
        config.present_mode = wgpu::PresentMode::Fifo;

        let device = &gpu.device;
        let shading = look.shading(&gpu.info);
        let renderer_config = RendererConfig { color_format: config.format, samples: SAMPLES, shading };
        let renderer = Renderer::new(device, &gpu.queue, renderer_config)?;
        let hair = look.hair.choose(pack.hair.as_ref());
        let model = scene::upload(pack, textures, device, &gpu.queue, hair)?;
        let mut avatar = AvatarState::new(device, &model);
        avatar.set_hair_detail(look.hair_detail(&gpu.info));
        let style = hair.map(|hair| hair.style);
        let mut stage =
            Self { window, gpu, surface, config, renderer, targets: None, model, avatar, style, look };
        stage.resize(size)?;
        Ok(stage)
    }

    pub(super) fn window(&self) -> &Window {
        &self.window
    }

    /// Fits surface and targets to the window; a window without area (minimised) is not drawn.
    ///
    /// # Errors
    /// Memory for the targets ran out.
    pub(super) fn resize(&mut self, size: PhysicalSize<u32>) -> Result<()> {
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        self.targets = None;
        if size.width == 0 || size.height == 0 {
            return Ok(());
        }
        (self.config.width, self.config.height) = (size.width.min(limit), size.height.min(limit));
        self.surface.configure(&self.gpu.device, &self.config);
        let (width, height) = (self.config.width, self.config.height);
        self.targets = Some(Targets::new(&self.gpu.device, &self.renderer, width, height)?);
        Ok(())
    }

    /// Gives the parts the looks that the pack has now.
    ///
    /// # Errors
    /// A model with fewer parts than the pack has.
    pub(super) fn set_materials(&self, pack: &Pack) -> Result<()> {
        scene::set_materials(pack, &self.model, &self.gpu.queue)
    }

    /// Plants this hair, or takes it away.
    ///
    /// # Errors
    /// More strands than the device binds; the hair stays as it is then.
    pub(super) fn set_hair(&mut self, pack: &Pack, textures: &Textures, hair: Option<Hair>) -> Result<()> {
        scene::set_hair(pack, textures, &mut self.model, &self.gpu.device, &self.gpu.queue, hair)?;
        self.style = hair.map(|hair| hair.style);
        self.avatar = AvatarState::new(&self.gpu.device, &self.model);
        self.avatar.set_hair_detail(self.look.hair_detail(&self.gpu.info));
        Ok(())
    }

    /// Lets as much time pass for the hair; seconds that are no number leave it still.
    pub(super) fn advance_hair(&mut self, seconds: f32) {
        self.avatar.advance_hair(&self.gpu.queue, seconds);
    }

    /// Whether there is hair that swings on after the head has stopped.
    pub(super) fn has_swinging_hair(&self) -> bool {
        self.model.strand_count() > 0 && self.style.is_some_and(|style| style.swings())
    }

    /// Draws one frame. A surface that is not ready loses this frame, not the window.
    pub(super) fn draw(&mut self, pack: &Pack, state: &FaceState, view: View) -> Result<()> {
        if self.targets.is_none() {
            return Ok(());
        }
        let frame = match self.surface.get_current_texture() {
            Acquired::Success(frame) | Acquired::Suboptimal(frame) => frame,
            Acquired::Timeout => {
                self.window.request_redraw();
                return Ok(());
            }
            Acquired::Validation => {
                let error = self.gpu.errors.take().unwrap_or_default();
                bail!("expected a picture of the window to draw on, found: {error}");
            }
            Acquired::Occluded => return Ok(()),
            Acquired::Outdated => {
                self.resize(self.window.inner_size())?;
                self.window.request_redraw();
                return Ok(());
            }
            Acquired::Lost => {
                self.surface =
                    self.gpu.instance.create_surface(self.window.clone()).context("the lost surface")?;
                self.resize(self.window.inner_size())?;
                self.window.request_redraw();
                return Ok(());
            }
        };
        let Some(targets) = &self.targets else { return Ok(()) };
        let (width, height) = (self.config.width, self.config.height);
        self.avatar.set(&self.gpu.queue, state.bones(), state.weights())?;
        let scene = scene::scene(pack, view, width, height, BACKGROUND, self.look.light());
        let label = Some("frame");
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        let target = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let avatars = [(&self.model, &self.avatar)];
        self.renderer.draw(&mut encoder, &target, targets, &self.gpu.queue, &scene, &avatars)?;
        self.gpu.queue.submit([encoder.finish()]);
        self.window.pre_present_notify();
        self.gpu.queue.present(frame);
        match self.gpu.errors.take() {
            None => Ok(()),
            Some(error) => {
                bail!("expected adapter {:?} to draw the frame, found: {error}", self.gpu.info.name)
            }
        }
    }
}
