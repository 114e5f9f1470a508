//! Keys and pointer become actions.

use super::action::Action;
use super::books::Books;
use super::camera::CameraMove;
use super::keys::{self, Keys};
use winit::dpi::PhysicalPosition;
use winit::event::{ElementState, KeyEvent, Modifiers, MouseButton, MouseScrollDelta};

/// What the pointer drags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Drag {
    Orbit,
    Pan,
}

/// The keys that are bound, and what keyboard and pointer do at the moment.
pub(super) struct Input {
    pub(super) keys: Keys,
    pub(super) modifiers: Modifiers,
    /// The pointer's last place in the window.
    pub(super) pointer: PhysicalPosition<f64>,
    dragging: Option<Drag>,
    /// A pose was pressed while the pointer holds a slider.
    interrupted: Option<Interrupted>,
}

/// Why the values of a slider are ignored: a pose was pressed while the pointer held the slider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Interrupted {
    /// The pointer still holds it.
    Held,
    /// The pointer has let go of it; the slider will send one last value.
    Released,
}

impl Input {
    pub(super) fn new(keys: Keys) -> Self {
        Self {
            keys,
            modifiers: Modifiers::default(),
            pointer: PhysicalPosition::default(),
            dragging: None,
            interrupted: None,
        }
    }

    /// What a key that is not the panel's does.
    pub(super) fn key(&self, event: &KeyEvent, books: &Books) -> Option<Action> {
        if event.state != ElementState::Pressed {
            return None;
        }
        if self.keys.has(&event.logical_key, &self.modifiers) {
            return self.keys.action(&event.logical_key, &self.modifiers, event.repeat);
        }
        // A key that is held down repeats itself; a pose is pressed once. Ctrl is no part of a pose's key.
        let state = self.modifiers.state();
        if event.repeat || state.control_key() || state.alt_key() || state.super_key() {
            return None;
        }
        let pose = keys::pose(books.poses(), &event.logical_key, event.physical_key).map(Action::PressPose);
        pose.or_else(|| keys::clip(books.clips(), &event.logical_key).map(Action::PressClip))
    }

    /// A button goes down or up; `is_panels` says whether the pointer is the panel's.
    pub(super) fn button(&mut self, state: ElementState, button: MouseButton, is_panels: bool) {
        let drag = match button {
            MouseButton::Left if self.modifiers.state().shift_key() => Drag::Pan,
            MouseButton::Left => Drag::Orbit,
            MouseButton::Right | MouseButton::Middle => Drag::Pan,
            _ => return,
        };
        if state == ElementState::Released && self.interrupted.is_some() {
            self.interrupted = Some(Interrupted::Released);
        }
        self.dragging = (state == ElementState::Pressed && !is_panels).then_some(drag);
    }

    /// What turning the wheel does.
    pub(super) fn wheel(delta: MouseScrollDelta) -> Action {
        Action::Camera(CameraMove::wheel(match delta {
            MouseScrollDelta::LineDelta(_, lines) => lines,
            MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / 40.0,
        }))
    }

    /// The pointer is at another place of a window of this height: what that does to the camera.
    pub(super) fn pointer(&mut self, position: PhysicalPosition<f64>, height: u32) -> Option<Action> {
        let (dx, dy) = ((position.x - self.pointer.x) as f32, (position.y - self.pointer.y) as f32);
        self.pointer = position;
        let height = height.max(1) as f32;
        Some(Action::Camera(match self.dragging? {
            Drag::Orbit => CameraMove::dragged(dx, dy),
            Drag::Pan => CameraMove::Pan(dx / height, -dy / height),
        }))
    }

    pub(super) fn is_dragging(&self) -> bool {
        self.dragging.is_some()
    }

    /// A slider that is held lets go of the face: a key is the newer wish.
    pub(super) fn interrupt(&mut self) {
        self.interrupted = Some(Interrupted::Held);
    }

    /// Whether the values of sliders are ignored.
    pub(super) fn is_interrupted(&self) -> bool {
        self.interrupted.is_some()
    }

    /// The slider's last value has arrived, if the pointer has let go of it.
    pub(super) fn heard(&mut self) {
        self.interrupted.take_if(|interrupted| *interrupted == Interrupted::Released);
    }
}
