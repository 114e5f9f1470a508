use avatar_stage::{Framing, NamedView, View};
use std::ops::RangeInclusive;

/// Degrees that the camera turns for a pixel of dragging.
const DEGREES_PER_PIXEL: f32 = 0.35;
/// How far up or down the camera may go: at the poles "up" would flip.
const MAX_PITCH_DEGREES: f32 = 85.0;
/// How near and far, as multiples of the distance that shows the whole head.
const DISTANCES: RangeInclusive<f32> = 0.2..=4.0;
/// How far the picture may be moved, in its heights at the distance that shows the whole head.
const MAX_PAN: f32 = 1.0;
/// One notch of the wheel.
const WHEEL_ZOOM: f32 = 0.92;

/// Where the camera can be taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// A view of the whole avatar.
    View(NamedView),
    /// Near enough that the face fills the picture, in the direction in which the camera looks already.
    Face,
}

impl Place {
    /// All of them, in the order in which the panel shows them.
    pub(crate) const ALL: [Self; 6] = [
        Self::View(NamedView::Front),
        Self::View(NamedView::ThreeQuarter),
        Self::View(NamedView::Left),
        Self::View(NamedView::Right),
        Self::View(NamedView::Back),
        Self::Face,
    ];

    /// Its name, for people.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::View(view) => view.name(),
            Self::Face => "face",
        }
    }
}

/// The camera, moved by hand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    pub(super) view: View,
}

impl Camera {
    pub(super) const START: Self = Self { view: View::FRONT };

    /// Goes to a place.
    pub(super) fn go(&mut self, place: Place) {
        self.view = match place {
            Place::View(view) => view.view(),
            Place::Face => View { distance: 1.0, pan: [0.0; 2], framing: Framing::Face, ..self.view },
        };
    }

    /// Turns around the face, in degrees.
    pub(super) fn orbit(&mut self, yaw: f32, pitch: f32) {
        let view = &mut self.view;
        let around = view.yaw_degrees + yaw;
        // Only a full turn is taken away, so that small angles stay the numbers that they are.
        view.yaw_degrees = if around.abs() > 180.0 { around - 360.0 * around.signum() } else { around };
        view.pitch_degrees = (view.pitch_degrees + pitch).clamp(-MAX_PITCH_DEGREES, MAX_PITCH_DEGREES);
    }

    /// Turns as the pointer drags: the face follows it, so dragging to the right shows the character's right side.
    pub(super) fn drag(&mut self, dx: f32, dy: f32) {
        self.orbit(-dx * DEGREES_PER_PIXEL, dy * DEGREES_PER_PIXEL);
    }

    /// Goes nearer (factor below 1) or farther.
    pub(super) fn zoom(&mut self, factor: f32) {
        let distance = self.view.distance * factor;
        self.view.distance = distance.clamp(*DISTANCES.start(), *DISTANCES.end());
    }

    /// Goes nearer or farther as the wheel turns.
    pub(super) fn wheel(&mut self, notches: f32) {
        self.zoom(WHEEL_ZOOM.powf(notches));
    }

    /// Moves the picture by shares of its height, to the right and up.
    pub(super) fn pan(&mut self, right: f32, up: f32) {
        // What lies farther away moves by more of the head.
        let [x, y] = self.view.pan;
        let moved = |old: f32, by: f32| (old + by * self.view.distance).clamp(-MAX_PAN, MAX_PAN);
        self.view.pan = [moved(x, right), moved(y, up)];
    }
}
