//! Keys and pointer.

use super::overlay::Overlay;
use super::{App, keys};
use winit::dpi::PhysicalPosition;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta};
use winit::event_loop::ActiveEventLoop;

/// What the pointer drags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Drag {
    Orbit,
    Pan,
}

impl App {
    pub(super) fn key(&mut self, event_loop: &ActiveEventLoop, event: &KeyEvent) {
        if event.state != ElementState::Pressed {
            return;
        }
        if self.keys.has(&event.logical_key, &self.modifiers) {
            if let Some(action) = self.keys.action(&event.logical_key, &self.modifiers, event.repeat) {
                self.act_on_key(event_loop, action);
            }
            return;
        }
        // A key that is held down repeats itself; a pose is pressed once. Ctrl is no part of a pose's key.
        let state = self.modifiers.state();
        if event.repeat || state.control_key() || state.alt_key() || state.super_key() {
            return;
        }
        if let Some(pose) = keys::pose(&self.face.pack, &event.logical_key, event.physical_key) {
            self.catch_up();
            self.interrupt();
            self.face.go_to(pose);
            self.redraw();
        } else if let Some(clip) = keys::clip(&self.face.pack, &event.logical_key) {
            self.catch_up();
            self.interrupt();
            self.play(clip);
        }
    }

    /// A slider that is held lets go of the face: the key is the newer wish.
    fn interrupt(&mut self) {
        if self.overlay.as_ref().is_some_and(|overlay| overlay.ctx.egui_is_using_pointer()) {
            self.interrupted = Some(false);
        }
    }

    pub(super) fn button(&mut self, state: ElementState, button: MouseButton) {
        let drag = match button {
            MouseButton::Left if self.modifiers.state().shift_key() => Drag::Pan,
            MouseButton::Left => Drag::Orbit,
            MouseButton::Right | MouseButton::Middle => Drag::Pan,
            _ => return,
        };
        if state == ElementState::Released && self.interrupted.is_some() {
            self.interrupted = Some(true);
        }
        let is_ours = !self.overlay.as_ref().is_some_and(Overlay::takes_pointer);
        self.dragging = (state == ElementState::Pressed && is_ours).then_some(drag);
    }

    pub(super) fn wheel(&mut self, delta: MouseScrollDelta) {
        if self.overlay.as_ref().is_some_and(Overlay::takes_pointer) {
            return;
        }
        self.camera.wheel(match delta {
            MouseScrollDelta::LineDelta(_, lines) => lines,
            MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / 40.0,
        });
        self.redraw();
    }

    pub(super) fn pointer(&mut self, position: PhysicalPosition<f64>) {
        let (dx, dy) = ((position.x - self.pointer.x) as f32, (position.y - self.pointer.y) as f32);
        self.pointer = position;
        self.pointing.moved();
        if self.pointing.follows {
            self.redraw();
        }
        match self.dragging {
            Some(Drag::Orbit) => self.camera.drag(dx, dy),
            Some(Drag::Pan) => {
                let height = self.stage.as_ref().map_or(1.0, |stage| stage.size().1.max(1) as f32);
                self.camera.pan(dx / height, -dy / height);
            }
            None => return,
        }
        self.redraw();
    }
}
