mod motion;
mod patch;
mod drawing;

use super::shot::{Kept, Shot};
use crate::adapter;
use crate::look_args::LookArgs;
use anyhow::{Context, Result, bail};
use avatar_groom::Hair;
use avatar_pack::{FaceState, Pack, Textures};
use avatar_render::headless::{Canvas, Gpu, GpuOptions, open_blocking, open_for_surface_blocking};
use avatar_render::{AvatarModel, AvatarState, PassTimer, Renderer, RendererConfig, SeeThrough, Targets};
use avatar_stage::{Drafts, Framing, SAMPLES, View, set_colors, upload_with_hair};
use image::RgbaImage;
use motion::Motion;
use patch::Patch;
use std::sync::Arc;
use std::time::Instant;
use winit::dpi::PhysicalSize;
use winit::event_loop::OwnedDisplayHandle;
use winit::raw_window_handle::{HasWindowHandle, RawWindowHandle};
use winit::window::Window;

pub(super) use drawing::Drawn;

/// The window's surface and everything that draws on it.
pub(super) struct Stage {
    window: Arc<Window>,
    gpu: Gpu,
    /// The picture of the surface that the next frame is drawn on, once there is one.
    next: Option<wgpu::SurfaceTexture>,
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
    /// The format through which the panel is drawn.
    panel_format: wgpu::TextureFormat,
    /// Measures passes while the statistics are shown.
    timer: Option<PassTimer>,
    /// Draws small pictures of poses.
    miniatures: Option<Miniatures>,
    /// The picture without the panel, where surfaces can be copied to: while only the panel changes, the face
    /// is not drawn again.
    kept: Option<Kept>,
    can_keep: bool,
    /// Where one sees through the window: pictures go this way to the surface.
    see_through: Option<SeeThrough>,
    /// Room for a part of the picture.
    patch: Option<Patch>,
    /// Drafts while something moves, on adapters that draw in software. `None` on others: they draw nothing
    /// but whole pictures.
    motion: Option<Motion>,
    /// Whether the hair moved in the frame before.
    hair_moved: bool,
    /// Whether a whole picture has been drawn: what draws it is compiled for the first.
    has_drawn: bool,
    /// Whether the timer has measured a frame that was not asked for yet.
    is_measured: bool,
}

/// A picture beside the window, and a state of the avatar for it.
struct Miniatures {
    canvas: Canvas,
    avatar: AvatarState,
    state: FaceState,
}

/// How a surface tells its compositor what is seen through, the best first.
const SEE_THROUGH_MODES: [wgpu::CompositeAlphaMode; 2] =
    [wgpu::CompositeAlphaMode::PreMultiplied, wgpu::CompositeAlphaMode::PostMultiplied];

/// Whether a window that could be seen through would show nothing at all: Mesa's software drivers, at least
/// up to version 22, send X servers pictures of 24 bits for windows of 32, and these are refused.
fn stays_black(window: &Window, adapter: &wgpu::AdapterInfo) -> bool {
    let handle = window.window_handle().map(|handle| handle.as_raw());
    let is_x11 = matches!(handle, Ok(RawWindowHandle::Xlib(_) | RawWindowHandle::Xcb(_)));
    is_x11 && adapter.device_type == wgpu::DeviceType::Cpu
}

/// Side of a pose's small picture in pixels.
const MINIATURE: u32 = 112;

impl Stage {
    /// Opens a device and a surface, and uploads the avatar. `wants_see_through`: what is behind the window
    /// is to be seen where the face is not; [`Self::is_see_through`] says whether the system can.
    pub(super) fn open(
        window: Arc<Window>,
        display: OwnedDisplayHandle,
        pack: &Pack,
        textures: &Textures,
        look: LookArgs,
        wants_see_through: bool,
    ) -> Result<Self> {
        let instance =
            wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle(Box::new(display)));
        let surface = match instance.create_surface(window.clone()) {
            Ok(surface) => surface,
            // Where no driver is found there is no surface either, for a reason that helps nobody.
            Err(error) => {
                open_blocking(GpuOptions::default()).map_err(adapter::explained)?;
                return Err(error).context("expected a surface to draw on, found none");
            }
        };
        let gpu = open_for_surface_blocking(instance, &surface, GpuOptions::default());
        let gpu = gpu.map_err(adapter::explained)?;

        let size = window.inner_size();
        let mut config = surface
            .get_default_config(&gpu.adapter, size.width.max(1), size.height.max(1))
            .context("expected an adapter that can draw on this surface")?;
        let formats = surface.get_capabilities(&gpu.adapter).formats;
        // Blending and resolving samples are right in linear light, which sRGB formats do in hardware.
        config.format = formats.iter().copied().find(wgpu::TextureFormat::is_srgb).unwrap_or(config.format);
        config.present_mode = wgpu::PresentMode::Fifo;
        // What the user does is to be seen at once, not behind frames that wait.
        config.desired_maximum_frame_latency = 1;
        // The panel blends in the space of the screen: through a view without sRGB, where the surface has
        // such views.
        let flags = gpu.adapter.get_downlevel_capabilities().flags;
        let plain = config.format.remove_srgb_suffix();
        let panel_format = match flags.contains(wgpu::DownlevelFlags::SURFACE_VIEW_FORMATS) {
            true => plain,
            false => config.format,
        };
        let usages = surface.get_capabilities(&gpu.adapter).usages;
        let can_keep = usages.contains(wgpu::TextureUsages::COPY_DST);
        if can_keep {
            config.usage |= wgpu::TextureUsages::COPY_DST;
        }
        if panel_format != config.format {
            config.view_formats.push(panel_format);
        }

        let device = &gpu.device;
        let alphas = surface.get_capabilities(&gpu.adapter).alpha_modes;
        let may = wants_see_through && !stays_black(&window, &gpu.info);
        let alpha = SEE_THROUGH_MODES.into_iter().find(|mode| may && alphas.contains(mode));
        let see_through = alpha.map(|alpha| {
            config.alpha_mode = alpha;
            let is_weighted = alpha == wgpu::CompositeAlphaMode::PreMultiplied;
            SeeThrough::new(device, config.format, (config.width, config.height), panel_format, is_weighted)
        });
        let shading = look.shading(&gpu.info);
        let renderer_config = RendererConfig { color_format: config.format, samples: SAMPLES, shading };
        let renderer = Renderer::new(device, &gpu.queue, renderer_config)?;
        let hair = look.hair.choose(pack.hair());
        let model = upload_with_hair(device, &gpu.queue, pack, textures, hair.as_ref())?;
        set_colors(&gpu.queue, pack, &model, &look.colors())?;
        let mut avatar = AvatarState::new(device, &model);
        avatar.set_hair_detail(look.hair_detail(&gpu.info));
        let style = hair.map(|hair| hair.style);
        let is_software = gpu.info.device_type == wgpu::DeviceType::Cpu;
        let motion = (is_software && can_keep)
            .then(|| Motion::new(Drafts::new(device, config.format, shading), Instant::now()));
        let mut stage = Self {
            window,
            gpu,
            next: None,
            surface,
            config,
            renderer,
            targets: None,
            model,
            avatar,
            style,
            look,
            panel_format,
            timer: None,
            miniatures: None,
            kept: None,
            can_keep,
            see_through,
            patch: None,
            motion,
            hair_moved: false,
            has_drawn: false,
            is_measured: false,
        };
        stage.resize(size)?;
        Ok(stage)
    }

    pub(super) fn window(&self) -> &Window {
        &self.window
    }

    /// Gives up everything but the window.
    pub(super) fn into_window(self) -> Arc<Window> {
        self.window
    }

    /// Fits surface and targets to the window; a window without area (minimised) is not drawn.
    ///
    /// # Errors
    /// Memory for the targets ran out.
    pub(super) fn resize(&mut self, size: PhysicalSize<u32>) -> Result<()> {
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        self.targets = None;
        self.kept = None;
        if size.width == 0 || size.height == 0 {
            return Ok(());
        }
        if self.next.take().is_some() {
            // That frame is not drawn any more.
            self.window.request_redraw();
        }
        (self.config.width, self.config.height) = (size.width.min(limit), size.height.min(limit));
        self.surface.configure(&self.gpu.device, &self.config);
        let (width, height) = (self.config.width, self.config.height);
        if let Some(see_through) = &mut self.see_through {
            see_through.resize(&self.gpu.device, (width, height));
        }
        self.targets = Some(Targets::new(&self.gpu.device, &self.renderer, width, height)?);
        Ok(())
    }

    /// Shows another avatar.
    ///
    /// # Errors
    /// The device cannot hold it; then the old one stays.
    pub(super) fn set_avatar(&mut self, pack: &Pack, textures: &Textures, look: LookArgs) -> Result<()> {
        let hair = look.hair.choose(pack.hair());
        let model = upload_with_hair(&self.gpu.device, &self.gpu.queue, pack, textures, hair.as_ref())?;
        set_colors(&self.gpu.queue, pack, &model, &look.colors())?;
        if let Some(error) = self.gpu.errors.take() {
            bail!("expected adapter {:?} to hold the avatar, found: {error}", self.gpu.info.name);
        }
        self.avatar = AvatarState::new(&self.gpu.device, &model);
        self.avatar.set_hair_detail(look.hair_detail(&self.gpu.info));
        self.model = model;
        self.style = hair.map(|hair| hair.style);
        self.look = look;
        self.miniatures = None;
        self.forget_kept();
        Ok(())
    }

    /// Whether what is behind the window is seen where the face is not.
    pub(super) fn is_see_through(&self) -> bool {
        self.see_through.is_some()
    }

    /// Whether pictures are drawn in software.
    pub(super) fn is_software(&self) -> bool {
        self.gpu.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Name of the adapter, triangles and strands.
    pub(super) fn numbers(&self, pack: &Pack) -> (&str, u64, u64) {
        let triangles = pack.parts().iter().map(|part| part.mesh.triangles.len() as u64).sum();
        (&self.gpu.info.name, triangles, self.model.strand_count() as u64)
    }

    /// Whether the device is lost: everything on it has to be made anew on another.
    pub(super) fn is_lost(&self) -> bool {
        self.gpu.errors.is_lost()
    }

    /// As [`Stage::is_lost`], for use after something has failed: some losses are only reported when the
    /// device is polled.
    pub(super) fn is_found_lost(&self) -> bool {
        // If the call fails, the reason is the loss of the device, which `is_lost` reports.
        let _ = self.gpu.device.poll(wgpu::PollType::Poll);
        self.is_lost()
    }

    /// Size of the surface in pixels.
    pub(super) fn size(&self) -> (u32, u32) {
        (self.config.width, self.config.height)
    }

    /// Measures the passes of frames from now on, or no longer.
    pub(super) fn measure(&mut self, is_wanted: bool) {
        if !is_wanted {
            self.timer = None;
        } else if self.timer.is_none() {
            self.timer = PassTimer::new(&self.gpu.device, &self.gpu.queue);
        }
    }

    /// Milliseconds of the passes of the last frame in which the face was drawn; `None` if they were already
    /// returned. Waits for that frame to end.
    pub(super) fn passes(&mut self) -> Option<Vec<(&'static str, f32)>> {
        if !std::mem::take(&mut self.is_measured) {
            return None;
        }
        let times = self.timer.as_ref()?.read(&self.gpu.device).unwrap_or_default();
        Some(times.into_iter().map(|(pass, ns)| (pass, (ns / 1e6) as f32)).collect())
    }

    /// The picture in the window without the panel, whatever its size.
    ///
    /// # Errors
    /// The device cannot draw it.
    pub(super) fn picture(&mut self, shot: &Shot<'_>, width: u32, height: u32) -> Result<RgbaImage> {
        let shading = self.look.shading(&self.gpu.info);
        let canvas = Canvas::new(&self.gpu, width, height, SAMPLES, shading)?;
        self.avatar.set_hair_detail(self.look.hair_detail(&self.gpu.info));
        self.avatar.set(&self.gpu.queue, shot.state.bones(), shot.state.weights())?;
        let scene = shot.scene(width, height, &self.look);
        let picture = canvas.render(&self.gpu, &scene, &[(&self.model, &self.avatar)])?;
        RgbaImage::from_raw(picture.width, picture.height, picture.rgba).context("a whole picture")
    }

    /// A small picture of the face with these control values.
    ///
    /// # Errors
    /// The device cannot draw it.
    pub(super) fn miniature(
        &mut self,
        pack: &Pack,
        values: &[f32],
        background: [u8; 4],
    ) -> Result<RgbaImage> {
        let miniatures = match self.miniatures.take() {
            Some(miniatures) => miniatures,
            None => {
                let shading = self.look.shading(&self.gpu.info);
                let mut avatar = AvatarState::new(&self.gpu.device, &self.model);
                avatar.set_hair_detail(self.look.hair_detail(&self.gpu.info));
                let canvas = Canvas::new(&self.gpu, MINIATURE, MINIATURE, SAMPLES, shading)?;
                Miniatures { canvas, avatar, state: FaceState::new(pack) }
            }
        };
        let Miniatures { canvas, avatar, state } = self.miniatures.insert(miniatures);
        state.pose(pack, values)?;
        state.settle(pack)?;
        avatar.set(&self.gpu.queue, state.bones(), state.weights())?;
        let view = View { distance: 0.92, framing: Framing::Head, ..View::FRONT };
        let scene = view.scene(pack, 1.0, background, self.look.light());
        let picture = canvas.render(&self.gpu, &scene, &[(&self.model, avatar)])?;
        RgbaImage::from_raw(picture.width, picture.height, picture.rgba).context("a whole picture")
    }

    /// Gives the parts the looks that the pack has now.
    ///
    /// # Errors
    /// A model with fewer parts than the pack has.
    pub(super) fn set_materials(&mut self, pack: &Pack) -> Result<()> {
        self.forget_kept();
        Ok(set_colors(&self.gpu.queue, pack, &self.model, &self.look.colors())?)
    }

    /// Plants this hair, or takes it away.
    ///
    /// # Errors
    /// More strands than the device binds; the hair stays as it is then.
    pub(super) fn set_hair(&mut self, pack: &Pack, textures: &Textures, hair: Option<Hair>) -> Result<()> {
        let Gpu { device, queue, .. } = &self.gpu;
        avatar_stage::set_hair(device, queue, pack, textures, &mut self.model, hair.as_ref())?;
        self.style = hair.map(|hair| hair.style);
        self.avatar = AvatarState::new(&self.gpu.device, &self.model);
        self.avatar.set_hair_detail(self.look.hair_detail(&self.gpu.info));
        self.miniatures = None;
        self.forget_kept();
        Ok(())
    }

    /// How high the hair reaches at bind pose.
    pub(super) fn hair_top(&self) -> Option<f32> {
        self.model.hair_top()
    }

    /// Lets as much time pass for the hair; seconds that are no number leave it still. At rest it need not
    /// grow again then.
    pub(super) fn advance_hair(&mut self, dt_secs: f64, is_at_rest: bool) {
        let moves = dt_secs.is_finite();
        // What was in motion hangs still in the first frame without any.
        if moves || self.hair_moved {
            self.forget_kept();
        }
        self.hair_moved = moves;
        if moves || !is_at_rest {
            self.avatar.advance_hair(&self.gpu.queue, dt_secs);
        } else {
            self.avatar.still_hair();
        }
    }

    /// Marks the kept picture as out of date: the next frame draws the face again.
    fn forget_kept(&mut self) {
        if let Some(kept) = &mut self.kept {
            kept.is_fresh = false;
        }
    }

    /// Whether there is hair that swings on after the head has stopped.
    pub(super) fn has_swinging_hair(&self) -> bool {
        self.model.strand_count() > 0 && self.style.is_some_and(|style| style.swings())
    }
}
