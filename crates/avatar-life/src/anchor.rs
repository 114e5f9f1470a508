//! What the eyes rest on: a point that may move, and the angles to it.

use crate::curves::{Follow, positive};
use crate::parameters as p;

/// Metres before the eyes within which a point counts as further before them, more and more, so that angles
/// stay smooth where a point goes past the head.
const NEAR: f64 = 0.1;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Anchor {
    place: Follow<3>,
    /// Degrees beside the point.
    beside: [f64; 2],
    /// The angles, of a point that stands still.
    still: Option<[f64; 3]>,
}

impl Anchor {
    fn new(position: [f64; 3], velocity: [f64; 3], beside: [f64; 2], now: f64) -> Self {
        let place = Follow::at(position, velocity, p::PURSUIT_RATE, now);
        let mut anchor = Self { place, beside, still: None };
        anchor.settle(now);
        anchor
    }

    /// Straight ahead, where someone is who is talked to.
    pub(crate) fn ahead() -> Self {
        Self::new([0.0, 0.0, p::PARTNER_METRES], [0.0; 3], [0.0; 2], 0.0)
    }

    /// In this direction (degrees to the character's left and up), so many metres away.
    pub(crate) fn toward(yaw: f64, pitch: f64, metres: f64) -> Self {
        let (yaw, pitch) = (yaw.to_radians(), pitch.to_radians());
        let level = metres * libm::cos(pitch);
        let position = [level * libm::sin(yaw), metres * libm::sin(pitch), level * libm::cos(yaw)];
        Self::new(position, [0.0; 3], [0.0; 2], 0.0)
    }

    /// On a target, or so many metres beside it.
    pub(crate) fn on(position: &[f64; 3], velocity: &[f64; 3], beside: [f64; 2], now: f64) -> Self {
        let metres = length(position).max(NEAR);
        let beside = beside.map(|beside| libm::atan2(beside, metres).to_degrees());
        Self::new(*position, *velocity, beside, now)
    }

    pub(crate) fn is_still(&self) -> bool {
        self.still.is_some()
    }

    pub(crate) fn settle(&mut self, now: f64) {
        self.place.settle(now);
        if self.still.is_none() && self.place.is_still() {
            self.still = Some(self.angles(now));
        }
    }

    /// Follows the point that it is on smoothly to another place and speed.
    pub(crate) fn follow(&mut self, position: [f64; 3], velocity: [f64; 3], now: f64) {
        if self.place.goal(now) != position || self.place.speed() != velocity {
            self.place.lead(position, velocity, now);
            self.still = None;
        }
    }

    /// Degrees between where the point is thought to be and a position.
    pub(crate) fn degrees_off(&self, position: [f64; 3], now: f64) -> f64 {
        let (here, there) = (angles_to(&self.place.goal(now)), angles_to(&position));
        libm::hypot(there[0] - here[0], there[1] - here[1])
    }

    /// Yaw to the character's left, pitch up, and how far the eyes turn in, in degrees.
    pub(crate) fn degrees(&self, now: f64) -> [f64; 3] {
        self.still.unwrap_or_else(|| self.angles(now))
    }

    fn angles(&self, now: f64) -> [f64; 3] {
        let [yaw, pitch, inward] = angles_to(&self.place.value(now));
        [yaw + self.beside[0], pitch + self.beside[1], inward]
    }
}

fn length(v: &[f64; 3]) -> f64 {
    libm::sqrt(v.iter().map(|x| x * x).sum())
}

/// The mean of the angles at which both eyes see a point, and what they turn in together, in degrees.
fn angles_to(&[left, up, ahead]: &[f64; 3]) -> [f64; 3] {
    let ahead = NEAR + positive(ahead - NEAR, NEAR);
    let half = 0.5 * p::PUPILS_APART;
    let (of_left, of_right) = (libm::atan2(left - half, ahead), libm::atan2(left + half, ahead));
    let pitch = libm::atan2(up, libm::sqrt(left * left + ahead * ahead));
    [0.5 * (of_left + of_right), pitch, of_right - of_left].map(f64::to_degrees)
}
