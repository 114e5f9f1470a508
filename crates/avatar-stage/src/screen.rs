use avatar_render::headless::{Gpu, GpuOptions, NoAdapter, open_for_surface};
use avatar_render::{
    AvatarModel, AvatarState, DrawError, Quality, Renderer, RendererConfig, RendererError, Scene, SizeError,
    Style, Targets, wgpu,
};

/// Why there is nothing on the screen.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScreenError {
    /// The window has nothing to draw on.
    #[error("expected a surface to draw on, found: {0}")]
    Surface(#[from] wgpu::CreateSurfaceError),
    /// No adapter shows pictures on this surface.
    #[error(transparent)]
    Adapter(#[from] NoAdapter),
    /// The adapter that was opened does not show pictures on this surface.
    #[error("adapter {adapter:?}: expected one that shows pictures in the window, found one that does not")]
    NotShown {
        /// Name of the adapter.
        adapter: String,
    },
    /// The surface has a format that cannot be drawn.
    #[error(transparent)]
    Renderer(#[from] RendererError),
    /// A size that the device cannot draw.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// Avatars that do not fit their models.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The surface or its device is lost. This screen shows nothing any more: drop it, open another
    /// [`Screen`] for the window, and upload models to its device.
    #[error("expected a surface to draw on, found that it or its device is lost")]
    Lost,
    /// What the device complained about, for example that memory ran out.
    #[error("expected a frame, found an error of the device: {reason}")]
    Device {
        /// What wgpu says.
        reason: String,
    },
}

/// The surface of a window with everything that draws avatars on it, for programs that have no device of
/// their own.
#[derive(Debug)]
pub struct Screen {
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    gpu: Gpu,
    renderer: Renderer,
    /// `None` while the window has no area.
    targets: Option<Targets>,
}

impl Screen {
    /// Opens the best adapter for a window, such as an `Arc` of winit's, of this size in pixels.
    ///
    /// # Errors
    /// A window without a surface, no adapter for it, a surface that cannot be drawn on.
    pub async fn open(
        window: impl Into<wgpu::SurfaceTarget<'static>>,
        width: u32,
        height: u32,
    ) -> Result<Self, ScreenError> {
        let (instance, surface) = surface_of(window)?;
        let gpu = open_for_surface(instance, &surface, GpuOptions::default()).await?;
        Self::new(surface, gpu, width, height)
    }

    /// [`Self::open`] for callers without an executor.
    ///
    /// # Errors
    /// As [`Self::open`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn open_blocking(
        window: impl Into<wgpu::SurfaceTarget<'static>>,
        width: u32,
        height: u32,
    ) -> Result<Self, ScreenError> {
        let (instance, surface) = surface_of(window)?;
        let gpu =
            avatar_render::headless::open_for_surface_blocking(instance, &surface, GpuOptions::default())?;
        Self::new(surface, gpu, width, height)
    }

    fn new(surface: wgpu::Surface<'static>, gpu: Gpu, width: u32, height: u32) -> Result<Self, ScreenError> {
        let mut config = surface
            .get_default_config(&gpu.adapter, 1, 1)
            .ok_or_else(|| ScreenError::NotShown { adapter: gpu.info.name.clone() })?;
        // Blending and resolving samples are right in linear light, which sRGB formats do in hardware.
        let formats = surface.get_capabilities(&gpu.adapter).formats;
        config.format = formats.into_iter().find(wgpu::TextureFormat::is_srgb).unwrap_or(config.format);
        let renderer = Renderer::new(
            &gpu.device,
            &gpu.queue,
            RendererConfig {
                color_format: config.format,
                samples: crate::SAMPLES,
                shading: Quality::of_adapter(&gpu.info).shading(Style::Natural),
            },
        )?;
        let mut screen = Self { surface, config, gpu, renderer, targets: None };
        screen.resize(width, height)?;
        Ok(screen)
    }

    /// The device with its queue and adapter.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Width by height, for a [`Scene`].
    pub fn aspect(&self) -> f32 {
        self.config.width as f32 / self.config.height as f32
    }

    /// Fits the surface to the window's size in pixels. Nothing is drawn in a window without area.
    ///
    /// # Errors
    /// A size that the device cannot draw.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<(), ScreenError> {
        self.targets = None;
        if width == 0 || height == 0 {
            return Ok(());
        }
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        (self.config.width, self.config.height) = (width.min(limit), height.min(limit));
        self.surface.configure(&self.gpu.device, &self.config);
        let (width, height) = (self.config.width, self.config.height);
        self.targets = Some(Targets::new(&self.gpu.device, &self.renderer, width, height)?);
        Ok(())
    }

    /// Draws a frame and shows it. A surface that is not ready shows none this time, which is no error.
    ///
    /// # Errors
    /// Avatars that do not fit their models; an error of the device, after which a later frame may succeed.
    /// [`ScreenError::Lost`] where the surface or its device is lost: no later frame will succeed.
    pub fn draw(
        &mut self,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), ScreenError> {
        use wgpu::CurrentSurfaceTexture as Acquired;
        let Some(targets) = &self.targets else { return Ok(()) };
        let frame = match self.surface.get_current_texture() {
            Acquired::Success(frame) | Acquired::Suboptimal(frame) => frame,
            Acquired::Outdated => return self.resize(self.config.width, self.config.height),
            Acquired::Lost => return Err(ScreenError::Lost),
            Acquired::Timeout | Acquired::Occluded => return Ok(()),
            Acquired::Validation => return self.check(),
        };
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.renderer.draw(&mut encoder, &view, targets, &self.gpu.queue, scene, avatars)?;
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.queue.present(frame);
        // Whether a frame that failed deformed them is not known.
        self.check().inspect_err(|_| avatars.iter().for_each(|(_, avatar)| avatar.redo()))
    }

    fn check(&self) -> Result<(), ScreenError> {
        if self.gpu.errors.is_lost() {
            return Err(ScreenError::Lost);
        }
        match self.gpu.errors.take() {
            None => Ok(()),
            Some(reason) => Err(ScreenError::Device { reason }),
        }
    }
}

fn surface_of(
    window: impl Into<wgpu::SurfaceTarget<'static>>,
) -> Result<(wgpu::Instance, wgpu::Surface<'static>), ScreenError> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let surface = instance.create_surface(window)?;
    Ok((instance, surface))
}
