use super::camera::HandCamera;
use super::filming::{Filming, LARGEST_SIDE, Subject, formats};
use super::frames::Frames;
use super::overlay::Overlay;
use super::pointing::Pointing;
use super::session::Session;
use super::shot::Shot;
use super::stage::Stage;
use super::watch::Wake;
use crate::cli::Size;
use crate::clips::FoundClip;
use crate::film;
use crate::look_args::LookArgs;
use crate::output::{Contents, OutputFile};
use crate::picture_file::{PictureFormat, still};
use anyhow::{Context, Result, bail};
use avatar_groom::Hair;
use avatar_panel::{PanelState, Theme};
use avatar_render::Camera;
use avatar_stage::BACKGROUND;
use glam::Vec2;
use std::path::PathBuf;
use std::sync::Arc;
use winit::dpi::PhysicalSize;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Fullscreen, Window};

/// Background in the light theme.
const LIGHT_BACKGROUND: [u8; 4] = [0xc9, 0xcd, 0xd4, 255];

/// What shows the session: the window with its device, the panel over it, where the camera stands, and when
/// to draw.
pub(super) struct Presenter {
    /// `None` until the window is open.
    pub(super) stage: Option<Stage>,
    /// `None` where there is nothing but the face.
    pub(super) overlay: Option<Overlay>,
    pub(super) frames: Frames,
    pub(super) camera: HandCamera,
    pub(super) pointing: Pointing,
    pub(super) look: LookArgs,
}

impl Presenter {
    pub(super) fn new(look: LookArgs, pointing: Pointing) -> Self {
        Self {
            stage: None,
            overlay: None,
            frames: Frames::default(),
            camera: HandCamera::START,
            pointing,
            look,
        }
    }

    /// Opens the window, with a panel in this state if there is to be one.
    pub(super) fn open(
        &mut self,
        event_loop: &ActiveEventLoop,
        size: PhysicalSize<u32>,
        panel: Option<PanelState>,
        session: &Session,
        proxy: EventLoopProxy<Wake>,
    ) -> Result<()> {
        // A window that is seen before AccessKit knows of it is never read to anybody.
        let attributes = Window::default_attributes()
            .with_title(session.title())
            .with_inner_size(size)
            .with_visible(panel.is_none());
        let window = event_loop.create_window(attributes).context("expected a window, found none")?;
        if let Some(panel) = panel {
            self.overlay = Some(Overlay::new(event_loop, &window, proxy, panel));
            window.set_visible(true);
        }
        self.open_stage(event_loop, Arc::new(window), session)?;
        self.redraw();
        Ok(())
    }

    fn open_stage(
        &mut self,
        event_loop: &ActiveEventLoop,
        window: Arc<Window>,
        session: &Session,
    ) -> Result<()> {
        let display = event_loop.owned_display_handle();
        self.stage = Some(Stage::open(window, display, session.face.pack(), &session.textures, self.look)?);
        Ok(())
    }

    /// Opens another device and uploads the same face, after the device was lost. Returns whether there was a
    /// window.
    pub(super) fn reopen(&mut self, event_loop: &ActiveEventLoop, session: &Session) -> Result<bool> {
        let Some(window) = self.stage.take().map(Stage::into_window) else { return Ok(false) };
        if let Some(overlay) = &mut self.overlay {
            overlay.forget_device();
        }
        self.frames.forget_miniatures();
        self.open_stage(event_loop, window, session)?;
        self.redraw();
        Ok(true)
    }

    pub(super) fn redraw(&self) {
        if let Some(stage) = &self.stage {
            stage.window().request_redraw();
        }
    }

    pub(super) fn set_title(&self, title: &str) {
        if let Some(stage) = &self.stage {
            stage.window().set_title(title);
        }
    }

    /// Enters or leaves full screen.
    pub(super) fn toggle_full_screen(&self) {
        if let Some(stage) = &self.stage {
            let fills = stage.window().fullscreen().is_some();
            stage.window().set_fullscreen((!fills).then_some(Fullscreen::Borderless(None)));
        }
    }

    /// Size of the window in pixels, unless it fills the screen or has no area.
    pub(super) fn window_size(&self) -> Option<[u32; 2]> {
        let window = self.stage.as_ref()?.window();
        let size = window.inner_size();
        (window.fullscreen().is_none() && size.width > 0 && size.height > 0)
            .then_some([size.width, size.height])
    }

    /// Whether the pointer is the panel's.
    pub(super) fn panel_takes_pointer(&self) -> bool {
        self.overlay.as_ref().is_some_and(Overlay::takes_pointer)
    }

    /// The window's background in sRGB.
    pub(super) fn background(&self) -> [u8; 4] {
        let Some(overlay) = &self.overlay else { return BACKGROUND };
        match overlay.panel.state().theme {
            Theme::Light => LIGHT_BACKGROUND,
            Theme::System if overlay.ctx.theme() == egui::Theme::Light => LIGHT_BACKGROUND,
            _ => BACKGROUND,
        }
    }

    /// The hair that is chosen for the session's avatar.
    pub(super) fn hair(&self, session: &Session) -> Option<Hair> {
        self.look.hair.choose(session.face.pack().hair())
    }

    /// The camera of the frame, and the size of the window in pixels; `free` is what the panel leaves of it.
    pub(super) fn present_camera(&self, session: &Session, free: Option<[f32; 4]>) -> Option<(Camera, Vec2)> {
        let (width, height) = self.stage.as_ref()?.size();
        let shot = self.shot(session, free);
        Some((shot.scene(width, height, &self.look).camera, Vec2::new(width as f32, height as f32)))
    }

    /// What a frame shows.
    pub(super) fn shot<'a>(&self, session: &'a Session, free: Option<[f32; 4]>) -> Shot<'a> {
        Shot {
            pack: session.face.pack(),
            state: session.face.performer.state(),
            view: self.camera.view,
            background: self.background(),
            free,
        }
    }

    /// Saves the picture as the window shows it, without the panel, in the first free name of the folder that
    /// the program was started in; returns the name.
    pub(super) fn save_picture(&mut self, session: &mut Session) -> Result<PathBuf> {
        session.face.pose()?;
        let shot = self.shot(session, None);
        let Some(stage) = &mut self.stage else { bail!("expected a window, found none") };
        let (width, height) = stage.size();
        let picture = stage.picture(&shot, width, height)?;
        let face = &session.face;
        let stem = face.active_pose.and_then(|pose| session.books.poses().poses.get(pose));
        let path = film::free_name(stem.map_or("face", |pose| pose.name.as_str()), "png")?;
        let out = OutputFile::check(&path, Contents::Binary("a picture"))?;
        still(&out, PictureFormat::Png, &picture, &face.choice().describe(face.pack()))?;
        Ok(path)
    }

    /// Begins a film of a clip, or of the present face from all around.
    pub(super) fn film(
        &self,
        session: &Session,
        format: usize,
        clip: Option<usize>,
        window: EventLoopProxy<Wake>,
    ) -> Result<Filming> {
        let formats = formats();
        let Some((_, ending)) = formats.get(format) else { bail!("expected a format that there is") };
        let Some(stage) = &self.stage else { bail!("expected a window, found none") };
        let (width, height) = stage.size();
        let size = Size { width: width.min(LARGEST_SIDE), height: height.min(LARGEST_SIDE) };
        let face = &session.face;
        let of_file = face.motion.as_ref().filter(|motion| motion.is_wanted());
        let of_file = of_file.map(|motion| FoundClip::File(motion.name.clone()));
        let chosen = clip.and_then(|clip| session.books.clip(clip));
        let clip = of_file.or(chosen.map(|clip| FoundClip::Controls(clip.clone())));
        let stem = clip.as_ref().map_or("around", FoundClip::name).to_owned();
        let subject = Subject {
            pack: Arc::clone(face.performer.pack()),
            textures: session.textures.clone(),
            look: self.look,
            clip,
            values: face.targets(),
            view: self.camera.view,
            size,
            background: self.background(),
        };
        Filming::start(subject, film::free_name(&stem, ending)?, window)
    }
}
