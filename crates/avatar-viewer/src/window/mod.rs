//! The window: winit's events in, presses and camera moves out, a frame drawn only when something moves.

mod follow;
pub(crate) mod keys;
mod stage;
mod watch;

use crate::cli::WindowArgs;
use crate::face_args::FaceChoice;
use crate::files::Files;
use crate::look_args::LookArgs;
use crate::scene::View;
use anyhow::{Context, Result, anyhow};
use avatar_pack::{FaceState, Pack, Textures};
use clap::ArgMatches;
use keys::Action;
use pose_anim::{Player, Pose};
use stage::Stage;
use std::sync::Arc;
use std::time::{Duration, Instant};
use watch::{WATCHED, Wake, watch};
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::{Window, WindowId};

/// Degrees that the camera turns for a pixel of dragging.
const DEGREES_PER_PIXEL: f32 = 0.35;
/// How far up or down the camera may go: at the poles "up" would flip.
const MAX_PITCH_DEGREES: f32 = 85.0;
/// How near and far, as multiples of the distance that shows the whole head.
const DISTANCES: std::ops::RangeInclusive<f32> = 0.35..=4.0;
/// One notch of the wheel.
const WHEEL_ZOOM: f32 = 0.92;
/// A frame that takes longer (a suspended laptop) does not let the motion jump.
const MAX_FRAME_SECS: f64 = 0.25;
/// How long hair swings on after the head has stopped.
const SWINGS_ON: Duration = Duration::from_millis(1800);
/// How long a changed file has to be left alone before it is read. Saving is several changes: who reads after the first
/// one finds an empty file, or none, and who reads after each tells of one mistake several times.
const SETTLED: Duration = Duration::from_millis(100);

/// Opens the window and runs until it is closed.
pub(crate) fn run(args: &WindowArgs, matches: &ArgMatches) -> Result<()> {
    let files = Files::open(args.pack.pack.as_deref())?;
    let pack = files.load_pack()?;
    let textures = files.load_textures();
    let start = args.face.resolve(&pack, matches)?;
    keys::dead(&pack).for_each(|warning| eprintln!("warning: {warning}"));
    let event_loop = EventLoop::<Wake>::with_user_event().build().map_err(|_| no_display())?;
    // Watches as long as it lives.
    let _watcher = watch(&files, event_loop.create_proxy());
    let mut player = Player::new(&pack.controls);
    player.jump_to(&start.start_values())?;
    let mut app = App {
        title: format!("Mimik: {}", files.name()),
        files,
        size: PhysicalSize::new(args.size.width, args.size.height),
        state: FaceState::new(&pack),
        pack,
        textures,
        look: args.look,
        player,
        start: Some(start),
        view: View::FRONT,
        stage: None,
        last_frame: None,
        swing: None,
        // Nobody told of changes since the pack was loaded.
        reload_at: [Some(Instant::now() + SETTLED); WATCHED.len()],
        pointer: PhysicalPosition::default(),
        dragging: false,
        failure: None,
    };
    event_loop.run_app(&mut app).context("the window's event loop")?;
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
    title: String,
    files: Files,
    size: PhysicalSize<u32>,
    pack: Pack,
    textures: Textures,
    look: LookArgs,
    player: Player,
    state: FaceState,
    /// The face of the command line, with its single controls and joints; until a pose is pressed.
    start: Option<FaceChoice>,
    view: View,
    stage: Option<Stage>,
    /// When the last frame of a running motion was drawn; `None` while nothing moves.
    last_frame: Option<Instant>,
    /// When the last frame was drawn that hair moved in, and until when it does.
    swing: Option<(Instant, Instant)>,
    /// When each of the files is read again, unless it changes once more before.
    reload_at: [Option<Instant>; WATCHED.len()],
    /// The pointer's last place in the window.
    pointer: PhysicalPosition<f64>,
    dragging: bool,
    failure: Option<anyhow::Error>,
}

impl ApplicationHandler<Wake> for App {
    fn user_event(&mut self, _: &ActiveEventLoop, wake: Wake) {
        for ((file, _), at) in WATCHED.iter().zip(&mut self.reload_at) {
            if *file == wake {
                *at = Some(Instant::now() + SETTLED);
            }
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        for (index, (file, _)) in WATCHED.iter().enumerate() {
            if self.reload_at[index].take_if(|at| *at <= Instant::now()).is_some() {
                match file {
                    Wake::Materials => self.reload_materials(),
                    Wake::Hair => self.reload_hair(),
                }
            }
        }
        let next = self.reload_at.iter().flatten().min().copied();
        event_loop.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.stage.is_none()
            && let Err(error) = self.open(event_loop)
        {
            self.fail(event_loop, error);
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => {
                let resized = self.stage.as_mut().map_or(Ok(()), |stage| stage.resize(size));
                match resized {
                    Ok(()) => self.redraw(),
                    Err(error) => self.fail(event_loop, error),
                }
            }
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => self.key(event_loop, &event),
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                self.dragging = state == ElementState::Pressed;
            }
            WindowEvent::CursorMoved { position, .. } => self.pointer(position),
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => lines,
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / 40.0,
                };
                self.zoom(WHEEL_ZOOM.powf(notches));
            }
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.frame() {
                    self.fail(event_loop, error);
                }
            }
            _ => {}
        }
    }
}

impl App {
    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let attributes = Window::default_attributes().with_title(&self.title).with_inner_size(self.size);
        let window = event_loop.create_window(attributes).context("expected a window, found none")?;
        let stage = Stage::open(
            Arc::new(window),
            event_loop.owned_display_handle(),
            &self.pack,
            &self.textures,
            self.look,
        )?;
        self.stage = Some(stage);
        self.redraw();
        Ok(())
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: anyhow::Error) {
        self.failure = Some(error);
        event_loop.exit();
    }

    fn redraw(&self) {
        if let Some(stage) = &self.stage {
            stage.window().request_redraw();
        }
    }

    fn key(&mut self, event_loop: &ActiveEventLoop, event: &KeyEvent) {
        if event.state != ElementState::Pressed {
            return;
        }
        match keys::action(&event.logical_key) {
            Some(Action::Close) => event_loop.exit(),
            Some(Action::Orbit(yaw, pitch)) => self.orbit(yaw, pitch),
            Some(Action::Zoom(factor)) => self.zoom(factor),
            Some(Action::Front) => {
                self.view = View::FRONT;
                self.redraw();
            }
            Some(Action::Defaults) => {
                let defaults = self.pack.controls.defaults();
                self.press(&Pose::from_values("defaults", &defaults));
            }
            // Planting takes a moment: a key that is held down would run ahead of what is seen.
            Some(Action::Hair { .. }) if event.repeat => {}
            Some(Action::Hair { backward }) => self.next_hair(backward),
            // A key that is held down repeats itself; a pose is pressed once.
            None if event.repeat => {}
            None => {
                if let Some(pose) = keys::pose(&self.pack, &event.logical_key, event.physical_key).cloned() {
                    self.press(&pose);
                }
            }
        }
    }

    fn press(&mut self, pose: &Pose) {
        self.start = None;
        self.catch_up();
        self.player.press(pose);
        self.redraw();
    }

    fn pointer(&mut self, position: PhysicalPosition<f64>) {
        let (dx, dy) = (position.x - self.pointer.x, position.y - self.pointer.y);
        self.pointer = position;
        if self.dragging {
            // The face follows the pointer: dragging to the right shows the character's right side.
            self.orbit(-dx as f32 * DEGREES_PER_PIXEL, dy as f32 * DEGREES_PER_PIXEL);
        }
    }

    fn orbit(&mut self, yaw: f32, pitch: f32) {
        let around = self.view.yaw_degrees + yaw;
        // Only a full turn is taken away, so that small angles stay the numbers that they are.
        self.view.yaw_degrees = if around.abs() > 180.0 { around - 360.0 * around.signum() } else { around };
        self.view.pitch_degrees =
            (self.view.pitch_degrees + pitch).clamp(-MAX_PITCH_DEGREES, MAX_PITCH_DEGREES);
        self.redraw();
    }

    fn zoom(&mut self, factor: f32) {
        self.view.distance = (self.view.distance * factor).clamp(*DISTANCES.start(), *DISTANCES.end());
        self.redraw();
    }

    /// Brings the motion to this moment, so that a press acts at the time of the press.
    fn catch_up(&mut self) {
        let now = Instant::now();
        if let Some(last) = self.last_frame.replace(now) {
            let elapsed = now.duration_since(last).as_secs_f64().min(MAX_FRAME_SECS);
            // Elapsed times are neither negative nor NaN, the only errors there are.
            let _ = self.player.advance(elapsed);
        }
    }

    fn frame(&mut self) -> Result<()> {
        if self.last_frame.is_some() {
            self.catch_up();
        }
        let Some(stage) = &mut self.stage else { return Ok(()) };
        match &self.start {
            Some(start) => start.apply(&self.pack, &mut self.state)?,
            None => self.state.pose(&self.pack, self.player.values())?,
        }
        let now = Instant::now();
        let is_at_rest = self.player.is_at_rest();
        // Hair goes on a little after the head; where nothing has moved for longer it hangs still.
        let until = match is_at_rest {
            false => Some(now + SWINGS_ON),
            true => self.swing.map(|(_, until)| until).filter(|until| now < *until),
        };
        let last = self.swing.filter(|_| until.is_some()).map(|(last, _)| last);
        stage.advance_hair(last.map_or(f32::NAN, |last| now.duration_since(last).as_secs_f32()));
        self.swing = until.filter(|_| stage.has_swinging_hair()).map(|until| (now, until));
        stage.draw(&self.pack, &self.state, self.view)?;
        if is_at_rest {
            self.last_frame = None;
        } else {
            self.last_frame.get_or_insert_with(Instant::now);
        }
        // Nothing moves: no frame until something happens.
        if !is_at_rest || self.swing.is_some() {
            self.redraw();
        }
        Ok(())
    }
}
