//! The window: winit's events in, the face and the panel over it out; a frame is drawn only when something changes.
//!
//! ```text
//!  events ─▶ Overlay (egui) ─▶ panel's actions ─┐
//!     └────▶ keys, pointer ─────────────────────┴─▶ act ─▶ Face (motion, poses, clips) ─▶ Stage (GPU) ─▶ picture
//!  files, other threads ─▶ Wake ─▶ follow ──────────────────┘
//! ```

mod act;
mod books;
mod camera;
mod face;
mod filming;
mod follow;
mod frame;
mod input;
mod key_name;
pub(crate) mod keys;
mod loading;
mod messages;
mod motion;
mod overlay;
mod playing;
mod point;
mod shot;
mod stage;
mod watch;

use crate::cli::WindowArgs;
use crate::config::{self, Config};
use crate::files::Files;
use crate::look_args::LookArgs;
use anyhow::{Context, Result, anyhow};
use camera::Camera;
use clap::ArgMatches;
use face::Face;
use filming::Filming;
use frame::Frames;
use input::Drag;
use keys::Keys;
use loading::Loading;
use messages::{About, Messages};
use overlay::Overlay;
use point::Pointing;
use stage::Stage;
use std::sync::Arc;
use std::time::{Duration, Instant};
use watch::{Wake, Watched, Watching, watch};
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::{Modifiers, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

/// How long a changed file has to be left alone before it is read. Saving is several changes: who reads after the first
/// one finds an empty file, or none, and who reads after each tells of one mistake several times.
const SETTLED: Duration = Duration::from_millis(100);

/// Opens the window and runs until it is closed.
pub(crate) fn run(args: &WindowArgs, matches: &ArgMatches) -> Result<()> {
    let files = Files::open(args.pack.pack.as_deref(), &args.pack.with)?;
    let pack = files.load_pack_in_any_case()?;
    let textures = files.load_textures();
    let start = args.face.resolve(&pack, matches)?;
    let event_loop = EventLoop::<Wake>::with_user_event().build().map_err(|_| no_display())?;
    let mut messages = Messages::default();
    let (mut config, mistake) = match args.no_panel {
        // Nothing is remembered of a window that shows nothing but the face.
        true => Default::default(),
        false => Config::load(),
    };
    if let Some(mistake) = mistake {
        messages.warn(About::Settings, "What was remembered cannot be read.", mistake);
    }
    let keys = config::keys().unwrap_or_else(|error| {
        messages.error(About::Keys, "The usual keys are used.", &error);
        Keys::default()
    });
    keys.dead(&pack).iter().for_each(|warning| eprintln!("warning: {warning}"));
    if let Some(path) = args.pack.pack.as_deref().filter(|_| !args.no_panel) {
        config.opened(path);
    }
    let size = match (args.size, config.window) {
        (Some(size), _) => [size.width, size.height],
        (None, Some(size)) => size,
        (None, None) => [1280, 720],
    };
    let proxy = event_loop.create_proxy();
    let face = Face::new(files, pack, textures, Some(start))?;
    // Watches as long as it lives.
    let watching = watch(&face.files, &face.store, proxy.clone());
    let pointing = Pointing::new(&face.pack, proxy.clone(), false);
    let mut app = App {
        proxy,
        pointing,
        size: PhysicalSize::new(size[0], size[1]),
        with_panel: !args.no_panel,
        look: args.look,
        keys,
        config,
        messages,
        camera: Camera::START,
        face,
        overlay: None,
        stage: None,
        frames: Frames::default(),
        loading: None,
        filming: None,
        watching,
        // Nobody told of changes since the avatar was loaded.
        reload_at: [Some(Instant::now() + SETTLED); Watched::ALL.len()],
        modifiers: Modifiers::default(),
        pointer: PhysicalPosition::default(),
        dragging: None,
        interrupted: None,
        is_warned: false,
        failure: None,
    };
    event_loop.run_app(&mut app).context("the window's event loop")?;
    app.remember();
    app.failure.map_or(Ok(()), Err)
}

/// winit's own words name its source files; what a person can change are two variables.
fn no_display() -> anyhow::Error {
    let variable = |name| match std::env::var_os(name) {
        Some(value) => format!("{name}={}", value.to_string_lossy()),
        None => format!("no {name}"),
    };
    let (x11, wayland) = (variable("DISPLAY"), variable("WAYLAND_DISPLAY"));
    anyhow!("expected a display (X11 or Wayland) to open a window on, found {x11} and {wayland}")
}

struct App {
    proxy: EventLoopProxy<Wake>,
    size: PhysicalSize<u32>,
    with_panel: bool,
    look: LookArgs,
    keys: Keys,
    config: Config,
    messages: Messages,
    camera: Camera,
    face: Face,
    overlay: Option<Overlay>,
    stage: Option<Stage>,
    frames: Frames,
    pointing: Pointing,
    loading: Option<Loading>,
    filming: Option<Filming>,
    watching: Watching,
    /// When each of the files is read again, unless it changes once more before.
    reload_at: [Option<Instant>; Watched::ALL.len()],
    modifiers: Modifiers,
    /// The pointer's last place in the window.
    pointer: PhysicalPosition<f64>,
    /// What the pointer drags.
    dragging: Option<Drag>,
    /// A pose was pressed while the pointer holds something; and whether it has let go since.
    interrupted: Option<bool>,
    /// The user was told that clips are not saved.
    is_warned: bool,
    failure: Option<anyhow::Error>,
}

impl ApplicationHandler<Wake> for App {
    fn user_event(&mut self, _: &ActiveEventLoop, wake: Wake) {
        match wake {
            Wake::Changed(file) => self.reload_soon(file),
            Wake::NoDialog => {
                let advice = "Drop a file on the window, or name it where the program is started.";
                self.messages.warn(About::Opening, "The system opens no dialog.", advice);
                self.redraw();
            }
            Wake::Ready => {
                self.pointing.take();
                self.take_loaded();
                self.take_film();
            }
            Wake::Chosen(path) => self.open(&path),
            Wake::Accessibility(event) => {
                if let Some(overlay) = &mut self.overlay {
                    overlay.accesskit(event.window_event);
                }
                self.redraw();
            }
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        self.follow();
        if self.messages.expire() {
            self.redraw();
        }
        let files = self.reload_at.iter().flatten().copied();
        let next = files.chain(self.frames.next()).chain(self.messages.next()).min();
        event_loop.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn new_events(&mut self, _: &ActiveEventLoop, _: winit::event::StartCause) {
        if self.frames.is_due() {
            self.redraw();
        }
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.stage.is_none()
            && let Err(error) = self.open_window(event_loop)
        {
            self.fail(event_loop, error);
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        // Before the panel sees the event: Escape takes the keyboard from it.
        let is_panels = match &event {
            WindowEvent::KeyboardInput { event, .. } => {
                self.overlay.as_ref().is_some_and(|overlay| overlay.takes(&event.logical_key))
            }
            _ => false,
        };
        if let (Some(overlay), Some(stage)) = (&mut self.overlay, &self.stage)
            && !matches!(event, WindowEvent::RedrawRequested)
            && overlay.event(stage.window(), &event).repaint
        {
            self.redraw();
        }
        match event {
            WindowEvent::CloseRequested => self.close(event_loop),
            WindowEvent::Resized(size) => {
                let resized = self.stage.as_mut().map_or(Ok(()), |stage| stage.resize(size));
                match resized {
                    Ok(()) => self.redraw(),
                    Err(error) => self.fail(event_loop, error),
                }
            }
            WindowEvent::ScaleFactorChanged { .. } | WindowEvent::Occluded(false) => self.redraw(),
            WindowEvent::ModifiersChanged(modifiers) => self.modifiers = modifiers,
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } if !is_panels => {
                self.key(event_loop, &event);
            }
            WindowEvent::MouseInput { state, button, .. } => {
                // Only the panel itself knows how far its edges can be gripped.
                self.react(event_loop);
                self.button(state, button);
            }
            WindowEvent::CursorMoved { position, .. } => self.pointer(position),
            WindowEvent::MouseWheel { delta, .. } => self.wheel(delta),
            WindowEvent::DroppedFile(path) => self.open(&path),
            WindowEvent::RedrawRequested => {
                let drawn = self.frame(event_loop);
                // A device may be lost in the middle of a frame; the next one finds out.
                if drawn.is_err() && self.stage.as_ref().is_some_and(Stage::is_found_lost) {
                    self.redraw();
                } else if let Err(error) = drawn {
                    self.fail(event_loop, error);
                }
            }
            _ => {}
        }
    }
}

impl App {
    fn title(&self) -> String {
        format!("Mimik: {}", self.face.files.name())
    }

    fn open_window(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        // A window that is seen before AccessKit knows of it is never read to anybody.
        let attributes = Window::default_attributes()
            .with_title(self.title())
            .with_inner_size(self.size)
            .with_visible(!self.with_panel);
        let window = event_loop.create_window(attributes).context("expected a window, found none")?;
        if self.with_panel {
            let panel = self.config.panel.clone();
            self.overlay = Some(Overlay::new(event_loop, &window, self.proxy.clone(), panel));
            window.set_visible(true);
        }
        self.open_stage(event_loop, Arc::new(window))?;
        self.redraw();
        Ok(())
    }

    fn open_stage(&mut self, event_loop: &ActiveEventLoop, window: Arc<Window>) -> Result<()> {
        let display = event_loop.owned_display_handle();
        self.stage = Some(Stage::open(window, display, &self.face.pack, &self.face.textures, self.look)?);
        Ok(())
    }

    /// Everything on the device is gone: the same face on another one.
    fn reopen(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let Some(window) = self.stage.take().map(Stage::into_window) else { return Ok(()) };
        if let Some(overlay) = &mut self.overlay {
            overlay.forget_device();
        }
        self.frames.forget_miniatures();
        self.open_stage(event_loop, window).context("the graphics device was lost")?;
        self.messages.news(About::Device, "The graphics device was lost, and opened again.", "");
        self.redraw();
        Ok(())
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: anyhow::Error) {
        self.failure = Some(error);
        event_loop.exit();
    }

    fn close(&mut self, event_loop: &ActiveEventLoop) {
        if self.may_leave() {
            event_loop.exit();
        }
    }

    /// Whether nothing is lost with this face; or the user wants the same once more after having been told what is.
    fn may_leave(&mut self) -> bool {
        let loses = self.face.has_unsaved_clips() || self.face.recorded_secs().is_some();
        if !loses || self.overlay.is_none() || std::mem::replace(&mut self.is_warned, true) {
            return true;
        }
        let advice = "Save them in the tab of clips, or do the same once more to go on without them.";
        self.messages.warn(About::Clips, "There are clips that are not saved.", advice);
        self.redraw();
        false
    }

    /// Reads a file again once it has been left alone.
    fn reload_soon(&mut self, file: Watched) {
        for (watched, at) in Watched::ALL.iter().zip(&mut self.reload_at) {
            if *watched == file {
                *at = Some(Instant::now() + SETTLED);
            }
        }
    }

    fn redraw(&self) {
        if let Some(stage) = &self.stage {
            stage.window().request_redraw();
        }
    }

    /// Brings the motion to this moment, so that a press acts at the time of the press.
    fn catch_up(&mut self) {
        let secs = self.frames.catch_up(Instant::now(), self.face.recorded_secs().is_some());
        self.face.advance(secs);
    }

    /// Stores what is remembered from run to run.
    pub(super) fn remember(&mut self) {
        let Some(overlay) = &self.overlay else { return };
        self.config.panel = overlay.panel.state();
        if let Some(stage) = &self.stage
            && stage.window().fullscreen().is_none()
        {
            let size = stage.window().inner_size();
            if size.width > 0 && size.height > 0 {
                self.config.window = Some([size.width, size.height]);
            }
        }
        if let Err(error) = self.config.save() {
            self.messages.error(About::Settings, "Settings were not stored.", &error);
        }
    }
}
