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

/// How the camera moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CameraMove {
    /// Around the face: degrees to the character's left, degrees up.
    Orbit(f32, f32),
    /// Multiplies its distance.
    Zoom(f32),
    /// Moves the picture: shares of its height to the right and up.
    Pan(f32, f32),
    /// To a place.
    Go(Place),
}

/// The view, as it is moved by hand.
#[derive(Clone, Copy, Debug)]
pub(super) struct HandCamera {
    pub(super) view: View,
}

impl HandCamera {
    pub(super) const START: Self = Self { view: View { framing: Framing::Portrait, ..View::FRONT } };

    /// Moves as the user wants.
    pub(super) fn apply(&mut self, wanted: CameraMove) {
        match wanted {
            CameraMove::Orbit(yaw, pitch) => self.orbit(yaw, pitch),
            CameraMove::Zoom(factor) => self.zoom(factor),
            CameraMove::Pan(right, up) => self.pan(right, up),
            CameraMove::Go(place) => self.go(place),
        }
    }

    /// Goes to a place.
    fn go(&mut self, place: Place) {
        self.view = match place {
            Place::View(view) => View { framing: Framing::Portrait, ..view.view() },
            Place::Face => View { distance: 1.0, pan: [0.0; 2], framing: Framing::Face, ..self.view },
        };
    }

    /// Turns around the face, in degrees.
    fn orbit(&mut self, yaw: f32, pitch: f32) {
        let view = &mut self.view;
        let around = view.yaw_degrees + yaw;
        // Only a full turn is taken away, so that small angles stay the numbers that they are.
        view.yaw_degrees = if around.abs() > 180.0 { around - 360.0 * around.signum() } else { around };
        view.pitch_degrees = (view.pitch_degrees + pitch).clamp(-MAX_PITCH_DEGREES, MAX_PITCH_DEGREES);
    }

    /// Goes nearer (factor below 1) or farther.
    fn zoom(&mut self, factor: f32) {
        let distance = self.view.distance * factor;
        self.view.distance = distance.clamp(*DISTANCES.start(), *DISTANCES.end());
    }

    /// Moves the picture by shares of its height, to the right and up.
    fn pan(&mut self, right: f32, up: f32) {
        // What lies farther away moves by more of the head.
        let [x, y] = self.view.pan;
        let moved = |old: f32, by: f32| (old + by * self.view.distance).clamp(-MAX_PAN, MAX_PAN);
        self.view.pan = [moved(x, right), moved(y, up)];
    }
}

impl CameraMove {
    /// What dragging by pixels does: the face follows the pointer, so dragging to the right shows the
    /// character's right side.
    pub(super) fn dragged(dx: f32, dy: f32) -> Self {
        Self::Orbit(-dx * DEGREES_PER_PIXEL, dy * DEGREES_PER_PIXEL)
    }

    /// What turning the wheel by notches does.
    pub(super) fn wheel(notches: f32) -> Self {
        Self::Zoom(WHEEL_ZOOM.powf(notches))
    }
}
