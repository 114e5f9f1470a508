//! The window: winit's events in, the face and the panel over it out; a frame is drawn only when something
//! changes.
//!
//! ```text
//!  events ─▶ Overlay (egui) ─▶ panel's actions ─┐
//!     └────▶ Input (keys, pointer) ─────────────┴─▶ act ─▶ Session (Face, Books)
//!  files, other threads ─▶ Wake ─▶ follow, loading ────────┘       │
//!                       Presenter (Stage, Overlay, Frames) ◀───────┘ ─▶ picture
//! ```

mod camera;
pub(crate) mod action;
mod key_name;
pub(crate) mod keys;
mod messages;
mod watch;
mod books;
mod face;
mod live;
mod loading;
mod filming;
mod session;
mod input;
mod stirring;
mod shot;
mod overlay;
mod stage;
mod frames;
mod pointing;
mod presenter;
mod point;
mod frame;
mod act;
mod follow;
mod failing;
mod driven;
mod talking;
mod open;

use crate::cli::WindowArgs;
use crate::config::Config;
use crate::files::Files;
use crate::live_args::LiveOptions;
use crate::picture_args::Background;
use crate::standard;
use anyhow::{Context, Result, anyhow};
use avatar_pack::Texture;
use clap::ArgMatches;
use face::Lively;
use input::Input;
use keys::Keys;
use live::Live;
use loading::Loaded;
use messages::{About, Messages};
use pointing::Pointing;
use presenter::Presenter;
use session::Session;
use stage::Stage;
use talking::Talking;
use watch::Wake;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

/// Opens the window and runs until it is closed.
pub(crate) fn run(args: &WindowArgs, matches: &ArgMatches) -> Result<()> {
    open(args, matches, None)
}

/// Opens the window with a face that follows a sender.
pub(crate) fn run_live(args: &WindowArgs, matches: &ArgMatches, live: &LiveOptions) -> Result<()> {
    open(args, matches, Some(live))
}

fn open(args: &WindowArgs, matches: &ArgMatches, live: Option<&LiveOptions>) -> Result<()> {
    let files = Files::of_args(&args.pack)?;
    let pack = files.load_pack_in_any_case()?;
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
    let keys = Keys::load().unwrap_or_else(|error| {
        messages.error(About::Keys, "The usual keys are used.", &error);
        Keys::default()
    });
    keys.dead(pack.poses()).iter().for_each(standard::warn);
    if let Some(path) = args.pack.pack.as_deref().filter(|_| !args.no_panel) {
        config.opened(path);
    }
    let size = match (args.size, config.window) {
        (Some(size), _) => [size.width, size.height],
        (None, Some(size)) => size,
        (None, None) => [1280, 720],
    };
    let proxy = event_loop.create_proxy();
    let loaded = Loaded { textures: files.load_textures(&Texture::DRAWN), files, pack };
    let session = Session::new(loaded, start, Lively::default(), proxy.clone())?;
    let pointing = Pointing::new(session.face.performer.pack(), proxy.clone(), false);
    // A face that a tracker drives blinks as its person does.
    let says_life = args.face.says_life() || live.is_some();
    let live = Live::new(live, &session, &mut messages, proxy.clone())?;
    let mut app = App {
        session,
        live,
        presenter: Presenter::new(args.look, pointing, args.background.map(|Background(color)| color)),
        input: Input::new(keys),
        messages,
        talking: Talking::default(),
        config,
        opening: Opening {
            size: PhysicalSize::new(size[0], size[1]),
            with_panel: !args.no_panel,
            says_life,
            is_on_top: args.on_top,
        },
        proxy,
        failed_frames: 0,
        failure: None,
    };
    event_loop.run_app(&mut app).context("the window's event loop")?;
    app.remember();
    let finished = app.live.finish(app.session.face.pack());
    app.failure.map_or(finished, Err)
}

/// winit's own message names its source files. This one names the two variables that a user can change.
fn no_display() -> anyhow::Error {
    let variable = |name| match std::env::var_os(name) {
        Some(value) => format!("{name}={}", value.to_string_lossy()),
        None => format!("no {name}"),
    };
    let (x11, wayland) = (variable("DISPLAY"), variable("WAYLAND_DISPLAY"));
    anyhow!("expected a display (X11 or Wayland) to open a window on, found {x11} and {wayland}")
}

/// The program behind the window: the session, its presentation and the user's input.
struct App {
    session: Session,
    /// What drives the face from outside.
    live: Live,
    presenter: Presenter,
    input: Input,
    messages: Messages,
    talking: Talking,
    config: Config,
    opening: Opening,
    proxy: EventLoopProxy<Wake>,
    /// Frames in a row that were not drawn.
    failed_frames: u32,
    /// Why the window was closed, if not by the user.
    failure: Option<anyhow::Error>,
}

/// How the window opens.
struct Opening {
    size: PhysicalSize<u32>,
    with_panel: bool,
    /// Whether the command line says how the face lives, or that it does not, or somebody drives it.
    says_life: bool,
    /// Whether it stays above others.
    is_on_top: bool,
}

impl ApplicationHandler<Wake> for App {
    fn user_event(&mut self, _: &ActiveEventLoop, wake: Wake) {
        match wake {
            Wake::Changed(file) => self.session.reload_soon(file),
            Wake::NoDialog => {
                let advice = "Drop a file on the window, or name it where the program is started.";
                self.messages.warn(About::Opening, "The system opens no dialog.", advice);
                self.presenter.redraw();
            }
            Wake::Ready => {
                self.presenter.pointing.take();
                self.take_loaded();
                self.take_speech();
                self.take_film();
            }
            Wake::Chosen(path) => self.open(&path),
            Wake::ChosenSpeech(path) => self.open_speech(&path),
            Wake::SoundFailed(error) => self.lose_sound(error),
            Wake::ChosenRecording(path) => self.play_recording(&path),
            Wake::Packet => self.presenter.redraw(),
            Wake::Accessibility(event) => {
                if let Some(overlay) = &mut self.presenter.overlay {
                    overlay.accesskit(event.window_event);
                }
                self.presenter.redraw();
            }
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        self.follow();
        if self.messages.expire() {
            self.presenter.redraw();
        }
        let frames = &self.presenter.frames;
        let times = [self.session.next_reload(), frames.next(), frames.next_stir(), self.messages.next()];
        let next = times.into_iter().flatten().min();
        event_loop.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn new_events(&mut self, _: &ActiveEventLoop, _: winit::event::StartCause) {
        if self.presenter.frames.is_due() {
            self.presenter.redraw();
        } else if self.presenter.frames.is_stirring() {
            self.stir();
        }
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.presenter.stage.is_some() {
            return;
        }
        let panel = self.opening.with_panel.then(|| self.config.panel.clone());
        let (size, proxy) = (self.opening.size, self.proxy.clone());
        if let Err(error) = self.presenter.open(event_loop, size, panel, &self.session, proxy) {
            self.fail(event_loop, error);
        }
        if self.presenter.has_given_up_see_through() {
            let advice = "The system shows nothing through windows. A colour that streaming programs take \
                          away does the same: --background '#00ff00'.";
            self.messages.warn(About::Opening, "The background is not transparent.", advice);
        }
        self.set_on_top(self.opening.is_on_top);
        let face = &mut self.session.face;
        face.spare(self.presenter.is_software());
        if !self.opening.says_life {
            face.set_life(true);
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Presenter { overlay, stage, .. } = &mut self.presenter;
        // Before the panel sees the event: Escape takes the keyboard from it.
        let is_panels = match &event {
            WindowEvent::KeyboardInput { event, .. } => {
                overlay.as_ref().is_some_and(|overlay| overlay.takes(&event.logical_key))
            }
            _ => false,
        };
        if let (Some(overlay), Some(stage)) = (overlay, stage)
            && !matches!(event, WindowEvent::RedrawRequested)
            && overlay.event(stage.window(), &event).repaint
        {
            self.presenter.redraw();
        }
        match event {
            WindowEvent::CloseRequested => self.close(event_loop),
            WindowEvent::Resized(size) => {
                let resized = self.presenter.stage.as_mut().map_or(Ok(()), |stage| stage.resize(size));
                match resized {
                    Ok(()) => self.presenter.redraw(),
                    Err(error) => self.frame_failed(event_loop, &error),
                }
            }
            WindowEvent::Occluded(true) => self.presenter.frames.stir_at(None),
            WindowEvent::ScaleFactorChanged { .. } | WindowEvent::Occluded(false) => self.presenter.redraw(),
            WindowEvent::ModifiersChanged(modifiers) => self.input.modifiers = modifiers,
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } if !is_panels => {
                if let Some(action) = self.input.key(&event, &self.session.books) {
                    self.act(event_loop, action);
                }
            }
            WindowEvent::MouseInput { state, button, .. } => {
                // Only the panel itself knows how far its edges can be gripped.
                self.react(event_loop);
                self.input.button(state, button, self.presenter.panel_takes_pointer());
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.presenter.pointing.moved();
                if self.presenter.pointing.follows {
                    self.presenter.redraw();
                }
                let height = self.presenter.stage.as_ref().map_or(1, |stage| stage.size().1);
                if let Some(action) = self.input.pointer(position, height) {
                    self.act(event_loop, action);
                }
            }
            WindowEvent::MouseWheel { delta, .. } if !self.presenter.panel_takes_pointer() => {
                self.act(event_loop, Input::wheel(delta));
            }
            WindowEvent::DroppedFile(path) => self.open(&path),
            WindowEvent::RedrawRequested => match self.frame(event_loop) {
                Ok(()) => self.failed_frames = 0,
                // A device may be lost in the middle of a frame; the next one finds out.
                Err(_) if self.presenter.stage.as_ref().is_some_and(Stage::is_found_lost) => {
                    self.presenter.redraw();
                }
                Err(error) => self.frame_failed(event_loop, &error),
            },
            _ => {}
        }
    }
}

impl App {
    pub(super) fn fail(&mut self, event_loop: &ActiveEventLoop, error: anyhow::Error) {
        self.failure = Some(error);
        event_loop.exit();
    }

    fn close(&mut self, event_loop: &ActiveEventLoop) {
        if self.may_leave() {
            event_loop.exit();
        }
    }

    /// Whether nothing is lost with this face; or the user wants the same once more after having been told
    /// what is.
    fn may_leave(&mut self) -> bool {
        if !self.session.has_unsaved()
            || self.presenter.overlay.is_none()
            || std::mem::replace(&mut self.session.is_warned, true)
        {
            return true;
        }
        let advice = "Save them in the tab of clips, or do the same once more to go on without them.";
        self.messages.warn(About::Clips, "There are clips that are not saved.", advice);
        self.presenter.redraw();
        false
    }

    /// Stores the settings that the next run starts with.
    fn remember(&mut self) {
        let Some(overlay) = &self.presenter.overlay else { return };
        self.config.panel = overlay.panel.state();
        if let Some(size) = self.presenter.window_size() {
            self.config.window = Some(size);
        }
        if let Err(error) = self.config.save() {
            self.messages.error(About::Settings, "Settings were not stored.", &error);
        }
    }
}
