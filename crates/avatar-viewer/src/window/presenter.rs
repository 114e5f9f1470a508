use super::camera::HandCamera;
use super::filming::{Filming, LARGEST_SIDE, Subject, formats};
use super::frames::Frames;
use super::overlay::Overlay;
use super::pointing::Pointing;
use super::session::Session;
use super::shot::Shot;
use super::stage::Stage;
use super::stirring::{Change, Stirring};
use super::watch::Wake;
use crate::cli::Size;
use crate::clips::FoundClip;
use crate::film;
use crate::look_args::LookArgs;
use crate::output::{Contents, OutputFile};
use crate::picture_file::{PictureFormat, still};
use crate::speech::{Line, Spoken};
use anyhow::{Context, Result, bail};
use avatar_groom::Hair;
use avatar_panel::{PanelState, Theme};
use avatar_render::Camera;
use avatar_stage::{BACKGROUND, View};
use glam::Vec2;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::dpi::PhysicalSize;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Fullscreen, Window, WindowLevel};

/// Background in the light theme.
const LIGHT_BACKGROUND: [u8; 4] = [0xc9, 0xcd, 0xd4, 255];

/// How often a face that does nothing but live is looked at, to see whether it has changed.
const STIR: Duration = Duration::from_micros(16_600);
const STIR_IN_SOFTWARE: Duration = Duration::from_millis(80);

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
    /// The background that was asked for, in sRGB.
    backdrop: Option<[u8; 4]>,
    /// Whether what is behind the window was to be seen, and cannot be.
    has_given_up: bool,
    /// What the panel left of the window in the last frame: left, top, right and bottom in pixels.
    pub(super) free: Option<[f32; 4]>,
    /// What a face that lives has changed since it was drawn.
    pub(super) stirring: Stirring,
}

impl Presenter {
    pub(super) fn new(look: LookArgs, pointing: Pointing, backdrop: Option<[u8; 4]>) -> Self {
        Self {
            stage: None,
            overlay: None,
            frames: Frames::default(),
            camera: HandCamera::START,
            pointing,
            look,
            backdrop,
            has_given_up: false,
            free: None,
            stirring: Stirring::default(),
        }
    }

    /// Whether pictures are drawn in software.
    pub(super) fn is_software(&self) -> bool {
        self.stage.as_ref().is_some_and(Stage::is_software)
    }

    /// What has changed of a face that does nothing but live since it was drawn.
    pub(super) fn change(&mut self, session: &Session) -> Change {
        if !session.face.lives() {
            return self.stirring.forget();
        }
        let Some((camera, size)) = self.present_camera(session, self.free) else { return Change::Any };
        let size = [size.x as u32, size.y as u32];
        let is_software = self.is_software();
        let (pack, state) = (session.face.pack(), session.face.performer.state());
        self.stirring.look(pack, state, &camera, size, is_software)
    }

    /// Looks again after a while at a face that does nothing but live, or that may have heard something.
    pub(super) fn stir_later(&mut self, session: &Session) {
        let stirs = (session.face.lives() || self.frames.sounds) && !session.face.acts();
        let is_dear = self.is_software() && !self.frames.sounds;
        let after = if is_dear { STIR_IN_SOFTWARE } else { STIR };
        self.frames.stir_at(stirs.then(|| Instant::now() + after));
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
        self.open_window(event_loop, size, panel.clone(), session, proxy.clone())?;
        if self.wants_see_through() {
            match self.stage.as_ref().filter(|stage| stage.is_see_through()) {
                Some(stage) => stage.window().set_visible(true),
                // What a window can show is decided when it is made.
                None => {
                    (self.overlay, self.stage) = (None, None);
                    (self.backdrop, self.has_given_up) = (None, true);
                    self.open_window(event_loop, size, panel, session, proxy)?;
                }
            }
        }
        self.redraw();
        Ok(())
    }

    fn open_window(
        &mut self,
        event_loop: &ActiveEventLoop,
        size: PhysicalSize<u32>,
        panel: Option<PanelState>,
        session: &Session,
        proxy: EventLoopProxy<Wake>,
    ) -> Result<()> {
        // Only the device tells whether one can see through a window: until then nobody sees it.
        let is_seen = !self.wants_see_through();
        // A window that is seen before AccessKit knows of it is never read to anybody.
        let attributes = Window::default_attributes()
            .with_title(session.title())
            .with_inner_size(size)
            .with_transparent(self.wants_see_through())
            .with_visible(panel.is_none() && is_seen);
        let window = event_loop.create_window(attributes).context("expected a window, found none")?;
        if let Some(panel) = panel {
            self.overlay = Some(Overlay::new(event_loop, &window, proxy, panel));
            window.set_visible(is_seen);
        }
        self.open_stage(event_loop, Arc::new(window), session)
    }

    fn open_stage(
        &mut self,
        event_loop: &ActiveEventLoop,
        window: Arc<Window>,
        session: &Session,
    ) -> Result<()> {
        let display = event_loop.owned_display_handle();
        let (pack, textures) = (session.face.pack(), &session.textures);
        let wants = self.wants_see_through();
        self.stage = Some(Stage::open(window, display, pack, textures, self.look, wants)?);
        Ok(())
    }

    /// Whether what is behind the window is to be seen.
    fn wants_see_through(&self) -> bool {
        self.backdrop.is_some_and(|[.., alpha]| alpha < 255)
    }

    /// Whether the system could not show what is behind the window: the usual background is there instead.
    pub(super) fn has_given_up_see_through(&self) -> bool {
        self.has_given_up
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

    /// Keeps the window above others, or does not.
    pub(super) fn set_on_top(&self, is_on_top: bool) {
        if let Some(stage) = &self.stage {
            let level = if is_on_top { WindowLevel::AlwaysOnTop } else { WindowLevel::Normal };
            stage.window().set_window_level(level);
        }
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
        if let Some(backdrop) = self.backdrop {
            return backdrop;
        }
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
            view: View { hair_top: self.stage.as_ref().and_then(Stage::hair_top), ..self.camera.view },
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

    /// Begins a film of a clip, of something that is said and the beginning of its name, or of the present
    /// face from all around.
    pub(super) fn film(
        &self,
        session: &Session,
        format: usize,
        (clip, said): (Option<usize>, Option<(Line, String)>),
        window: EventLoopProxy<Wake>,
    ) -> Result<Filming> {
        let formats = formats();
        let Some((_, ending)) = formats.get(format) else { bail!("expected a format that there is") };
        let Some(stage) = &self.stage else { bail!("expected a window, found none") };
        let (width, height) = stage.size();
        let size = Size { width: width.min(LARGEST_SIDE), height: height.min(LARGEST_SIDE) };
        let face = &session.face;
        let of_file = face.motion.as_ref().filter(|motion| motion.is_wanted() && said.is_none());
        let of_file = of_file.map(|motion| FoundClip::File(motion.name.clone()));
        let chosen = clip.and_then(|clip| session.books.clip(clip));
        let clip = of_file.or(chosen.map(|clip| FoundClip::Controls(clip.clone())));
        let (line, said) = said.unzip();
        let stem = said.unwrap_or_else(|| clip.as_ref().map_or("around", FoundClip::name).to_owned());
        let subject = Subject {
            pack: Arc::clone(face.performer.pack()),
            textures: session.textures.clone(),
            look: self.look,
            clip,
            spoken: line.map(|line| Spoken::new(line, face.pack())),
            life: face.life_anew(),
            values: face.targets(),
            view: self.camera.view,
            size,
            background: self.background(),
        };
        Filming::start(subject, film::free_name(&stem, ending)?, window)
    }
}
