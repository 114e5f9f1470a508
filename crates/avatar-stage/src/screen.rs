use crate::drafts::{DraftError, Drafts, picture_to_show};
use crate::pace::Step;
use avatar_render::headless::{Gpu, GpuOptions, NoAdapter, open_for_surface};
use avatar_render::wgpu::util::TextureBlitter;
use avatar_render::{
    AvatarModel, AvatarState, DrawError, Quality, Renderer, RendererConfig, RendererError, Scene, Shading,
    SizeError, Style, Targets, ToneMap, wgpu,
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
    /// A frame in motion that cannot be drawn.
    #[error(transparent)]
    Draft(#[from] DraftError),
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
    /// What draws whole frames, and room for them; made for the first one, and no room while the window has
    /// no area.
    whole: Option<(Renderer, Option<Targets>)>,
    shading: Shading,
    /// How frames are seen by what draws them: in sRGB, whatever the surface has, unless software draws on a
    /// canvas.
    format: wgpu::TextureFormat,
    /// Whether the window has an area.
    has_area: bool,
    /// Made for the first frame in motion.
    drafts: Option<Drafts>,
    /// The tone mapping with which it was made ready for wrinkles.
    prepared: Option<ToneMap>,
    /// Where a surface is only seen as sRGB: what whole frames are drawn on, and how they get from there to
    /// the surface. Samples that are resolved straight to such a view come out dark in some browsers.
    between: Option<(TextureBlitter, Option<wgpu::TextureView>)>,
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
        let mut screen = Self::open_as(window, width, height, natural).await?;
        screen.whole()?;
        Ok(screen)
    }

    /// As [`Self::open`], with the shading that `choose` wants on the adapter that was found. What draws is
    /// built for the first frame, or by [`Self::prepare`].
    ///
    /// # Errors
    /// As [`Self::open`].
    pub async fn open_as(
        window: impl Into<wgpu::SurfaceTarget<'static>>,
        width: u32,
        height: u32,
        choose: impl FnOnce(&wgpu::AdapterInfo) -> Shading,
    ) -> Result<Self, ScreenError> {
        let (instance, surface) = surface_of(window)?;
        let gpu = open_for_surface(instance, &surface, GpuOptions::default()).await?;
        let shading = choose(&gpu.info);
        Self::new(surface, gpu, width, height, shading)
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
        let shading = natural(&gpu.info);
        let mut screen = Self::new(surface, gpu, width, height, shading)?;
        screen.whole()?;
        Ok(screen)
    }

    fn new(
        surface: wgpu::Surface<'static>,
        gpu: Gpu,
        width: u32,
        height: u32,
        shading: Shading,
    ) -> Result<Self, ScreenError> {
        let mut config = surface
            .get_default_config(&gpu.adapter, 1, 1)
            .ok_or_else(|| ScreenError::NotShown { adapter: gpu.info.name.clone() })?;
        // Blending and resolving samples are right in linear light, which sRGB formats do in hardware.
        let formats = surface.get_capabilities(&gpu.adapter).formats;
        config.format = formats.into_iter().find(wgpu::TextureFormat::is_srgb).unwrap_or(config.format);
        let mut format = config.format;
        // A canvas has no such format, but can be seen as if it had. Not where software draws: there it takes
        // thirty times as long to resolve samples in linear light, and a copy beside.
        if cfg!(target_arch = "wasm32") && !format.is_srgb() && !is_software(&gpu) {
            format = format.add_srgb_suffix();
            config.view_formats = vec![format];
        }
        let blitter = || TextureBlitter::new(&gpu.device, format);
        let between = (format != config.format).then(|| (blitter(), None));
        let (whole, drafts, has_area, prepared) = (None, None, false, None);
        let mut screen =
            Self { surface, config, gpu, whole, shading, format, has_area, drafts, prepared, between };
        screen.resize(width, height)?;
        Ok(screen)
    }

    /// Builds what draws frames of this care at once, rather than for the first of them; what draws hair as
    /// well, if there will be some. `None` is the whole picture.
    ///
    /// # Errors
    /// A format or a size that cannot be drawn.
    pub fn prepare(&mut self, step: Option<Step>, has_hair: bool) -> Result<(), ScreenError> {
        let hair_of = |renderer: &Renderer| {
            if has_hair {
                renderer.prepare_hair(step.is_some());
            }
        };
        match step {
            Some(step) => {
                let (format, shading) = (self.format, self.shading);
                let Gpu { device, queue, .. } = &self.gpu;
                let drafts = self.drafts.get_or_insert_with(|| Drafts::new(device, format, shading));
                hair_of(drafts.prepare((device, queue), step)?);
            }
            None => hair_of(&self.whole()?.0),
        }
        Ok(())
    }

    /// Draws a draft of this care that is not shown: a software adapter compiles most of what draws when it
    /// first does, and does so while something else is got ready. A picture without area draws nothing.
    ///
    /// # Errors
    /// As [`draw`](Self::draw).
    pub fn warm_up(
        &mut self,
        step: Step,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), ScreenError> {
        if !self.has_area {
            return Ok(());
        }
        let Gpu { device, queue, .. } = &self.gpu;
        let (format, shading) = (self.format, self.shading);
        let drafts = self.drafts.get_or_insert_with(|| Drafts::new(device, format, shading));
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let size = (self.config.width, self.config.height);
        drafts.draw((device, queue), &mut encoder, step, size, scene, avatars, None)?;
        queue.submit([encoder.finish()]);
        // Whether a frame that failed deformed them is not known.
        self.check().inspect_err(|_| avatars.iter().for_each(|(_, avatar)| avatar.redo()))
    }

    /// What draws whole frames, and room for them.
    fn whole(&mut self) -> Result<&(Renderer, Option<Targets>), ScreenError> {
        let (renderer, targets) = match self.whole.take() {
            Some(whole) => whole,
            None => {
                let config = RendererConfig {
                    color_format: self.format,
                    samples: crate::SAMPLES,
                    shading: self.shading,
                };
                (Renderer::new(&self.gpu.device, &self.gpu.queue, config)?, None)
            }
        };
        let (width, height) = (self.config.width, self.config.height);
        let targets = match targets {
            None if self.has_area => Some(Targets::new(&self.gpu.device, &renderer, width, height)?),
            targets => targets,
        };
        Ok(self.whole.insert((renderer, targets)))
    }

    /// The device with its queue and adapter.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Width by height, for a [`Scene`].
    pub fn aspect(&self) -> f32 {
        self.config.width as f32 / self.config.height as f32
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Fits the surface to the window's size in pixels. Nothing is drawn in a window without area.
    ///
    /// # Errors
    /// A size that the device cannot draw.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<(), ScreenError> {
        self.whole.iter_mut().for_each(|(_, targets)| *targets = None);
        self.has_area = width > 0 && height > 0;
        if !self.has_area {
            return Ok(());
        }
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        (self.config.width, self.config.height) = (width.min(limit), height.min(limit));
        self.surface.configure(&self.gpu.device, &self.config);
        let (width, height) = (self.config.width, self.config.height);
        if let Some((_, picture)) = &mut self.between {
            *picture = Some(picture_to_show(&self.gpu.device, "frame", self.format, (width, height)));
        }
        match self.whole.is_some() {
            true => self.whole().map(|_| ()),
            false => Ok(()),
        }
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
        self.show(scene, avatars, None).map(|_| ())
    }

    /// As [`Self::draw`], with as much care as `step` says; `None` for all. Hair is drawn as the avatars'
    /// detail says ([`Drafts::draw`]). Returns whether a frame is shown, and all of what draws it was there
    /// before: only then its time tells something about the next.
    ///
    /// # Errors
    /// As [`Self::draw`].
    pub fn show(
        &mut self,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        step: Option<Step>,
    ) -> Result<bool, ScreenError> {
        use wgpu::CurrentSurfaceTexture as Acquired;
        if !self.has_area {
            return Ok(false);
        }
        let frame = match self.surface.get_current_texture() {
            Acquired::Success(frame) | Acquired::Suboptimal(frame) => frame,
            Acquired::Outdated => {
                return self.resize(self.config.width, self.config.height).map(|()| false);
            }
            Acquired::Lost => return Err(ScreenError::Lost),
            Acquired::Timeout | Acquired::Occluded => return Ok(false),
            Acquired::Validation => return self.check().map(|()| false),
        };
        let seen = wgpu::TextureViewDescriptor { format: Some(self.format), ..Default::default() };
        let view = frame.texture.create_view(&seen);
        let was_there = step.is_some() || self.whole.is_some();
        if step.is_none() {
            self.whole()?;
        }
        let Gpu { device, queue, .. } = &self.gpu;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let was_there = match (step, &self.whole) {
            (Some(step), _) => {
                let (format, shading) = (self.format, self.shading);
                let drafts = self.drafts.get_or_insert_with(|| Drafts::new(device, format, shading));
                let size = (self.config.width, self.config.height);
                let was_there =
                    drafts.draw((device, queue), &mut encoder, step, size, scene, avatars, None)?;
                drafts.show(device, &mut encoder, &view);
                was_there
            }
            (None, Some((renderer, Some(targets)))) => {
                let was_there = was_there && renderer.is_ready(scene, avatars);
                match &self.between {
                    Some((blitter, Some(picture))) => {
                        renderer.draw(&mut encoder, picture, targets, queue, scene, avatars)?;
                        blitter.copy(device, &mut encoder, picture, &view);
                    }
                    _ => renderer.draw(&mut encoder, &view, targets, queue, scene, avatars)?,
                }
                was_there
            }
            // There is an area, so there are targets.
            (None, _) => return Ok(false),
        };
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.queue.present(frame);
        // Software compiles what draws when it first does, and would wait here for nothing.
        let tone_map = Some(scene.light.tone_map);
        if step.is_none() && !is_software(&self.gpu) && self.prepared != tone_map {
            self.prepared = tone_map;
            let renderer = self.whole.iter().map(|(renderer, _)| renderer);
            renderer
                .for_each(|renderer| avatars.iter().for_each(|(model, _)| renderer.prepare(scene, model)));
        }
        // Whether a frame that failed deformed them is not known.
        self.check().inspect_err(|_| avatars.iter().for_each(|(_, avatar)| avatar.redo()))?;
        Ok(was_there)
    }

    /// The shading of frames at rest.
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// Draws with another shading from now on; the same one costs nothing.
    ///
    /// # Errors
    /// What the device cannot draw.
    pub fn set_shading(&mut self, shading: Shading) -> Result<(), ScreenError> {
        if shading == self.shading {
            return Ok(());
        }
        (self.shading, self.drafts, self.prepared) = (shading, None, None);
        match self.whole.take() {
            Some(_) => self.whole().map(|_| ()),
            None => Ok(()),
        }
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

fn is_software(gpu: &Gpu) -> bool {
    gpu.info.device_type == wgpu::DeviceType::Cpu
}

/// The best that the adapter draws smoothly, after nature.
fn natural(adapter: &wgpu::AdapterInfo) -> Shading {
    Quality::of_adapter(adapter).shading(Style::Natural)
}

fn surface_of(
    window: impl Into<wgpu::SurfaceTarget<'static>>,
) -> Result<(wgpu::Instance, wgpu::Surface<'static>), ScreenError> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let surface = instance.create_surface(window)?;
    Ok((instance, surface))
}
