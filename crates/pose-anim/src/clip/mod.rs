mod edit;
mod reduce;
mod set;

use crate::{ClipError, Easing, Jet};
use std::collections::HashSet;

pub use reduce::Reduction;
pub use set::ClipSet;

/// Later than any clip ends.
pub(crate) const LATEST_SECS: f64 = 1e6;

/// How a track runs from one key to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transition {
    /// `v_a + (v_b − v_a) · f(u)`, `u` the share of the span's time.
    Ease(Easing),
    /// A piece of an eased span, from the share `from` to the share `to` of its time, where the whole would
    /// rise by `rise`: what baking a key into such a span leaves on either side. It goes through its keys
    /// wherever they are moved: `v_a + (v_b − v_a)·u + rise · (f(s) − f(from) − u·(f(to) − f(from)))`, `s =
    /// from + u·(to − from)`.
    Part {
        /// The function of the whole.
        easing: Easing,
        /// Where in the whole this span begins, 0 to 1.
        from: f64,
        /// Where in the whole it ends, 0 to 1.
        to: f64,
        /// Rise of the whole.
        rise: f64,
    },
    /// The cubic with these slopes, per second, at its ends (Hermite).
    Hermite {
        /// Slope at the key where the span begins.
        leaving: f64,
        /// Slope at the key where it ends.
        arriving: f64,
    },
}

impl Transition {
    /// Straight.
    pub const LINEAR: Self = Self::Ease(Easing::Linear);
    /// The value of the first key, until the second one.
    pub const STEP: Self = Self::Ease(Easing::StepEnd);

    /// The state `age_secs` into a span that runs from value `a` to value `b` in `span_secs` (more than 0).
    pub(crate) fn at(self, age_secs: f64, span_secs: f64, a: f64, b: f64) -> Jet {
        let rate = 1.0 / span_secs;
        // The product need not be 1 at the end.
        let u = if age_secs >= span_secs { 1.0 } else { (age_secs * rate).clamp(0.0, 1.0) };
        let share = Jet { value: u, velocity: rate, acceleration: 0.0 };
        let line = Jet { value: a + (b - a) * u, velocity: (b - a) * rate, acceleration: 0.0 };
        match self {
            Self::Ease(Easing::Linear) => line,
            Self::Ease(easing) => Jet::rest(a) + Jet::rest(b - a) * share.through(easing.at(u)),
            Self::Part { easing, from, to, rise } => {
                let s = Jet::rest(from) + Jet::rest(to - from) * share;
                let (start, end) = (easing.at(from).value, easing.at(to).value);
                let bow = s.through(easing.at(s.value)) - Jet::rest(start) - Jet::rest(end - start) * share;
                line + Jet::rest(rise) * bow
            }
            Self::Hermite { leaving, arriving } => {
                let (l, r) = (leaving * span_secs - (b - a), arriving * span_secs - (b - a));
                // x = line + u(1−u)·(l(1−u) − r·u), with l and r the slopes beyond the line's.
                let (c1, c2, c3) = (l, -2.0 * l - r, l + r);
                line + share.through(Jet {
                    value: u * (c1 + u * (c2 + u * c3)),
                    velocity: c1 + u * (2.0 * c2 + u * 3.0 * c3),
                    acceleration: 2.0 * c2 + 6.0 * c3 * u,
                })
            }
        }
    }
}

/// A value at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Seconds from the start of the clip.
    pub time_secs: f64,
    /// Value of the control.
    pub value: f64,
    /// How the track goes on from here to the next key. Without meaning at the last key.
    pub transition: Transition,
}

impl Key {
    /// A key from which the track goes on with a transition function.
    pub const fn new(time_secs: f64, value: f64, easing: Easing) -> Self {
        Self { time_secs, value, transition: Transition::Ease(easing) }
    }
}

/// The keys of one control, in order of time. Two keys may have one time: there the value jumps to the
/// second.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    control: usize,
    pub(crate) keys: Vec<Key>,
}

impl Track {
    /// A track from its keys.
    ///
    /// # Errors
    /// No key; a time that is before its predecessor's, below 0 or above 10⁶ s; a number that is not finite.
    pub fn new(control: usize, keys: Vec<Key>) -> Result<Self, ClipError> {
        if keys.is_empty() {
            return Err(ClipError::NoKeys { control });
        }
        let mut earliest_secs = 0.0;
        for (index, key) in keys.iter().enumerate() {
            key.check(control, index)?;
            if !(earliest_secs..=LATEST_SECS).contains(&key.time_secs) {
                let time_secs = key.time_secs;
                return Err(ClipError::Time {
                    control,
                    key: index,
                    time_secs,
                    earliest_secs,
                    latest_secs: LATEST_SECS,
                });
            }
            earliest_secs = key.time_secs;
        }
        Ok(Self { control, keys })
    }

    /// A track that goes straight from sample to sample.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_samples(
        control: usize,
        samples: impl IntoIterator<Item = (f64, f64)>,
    ) -> Result<Self, ClipError> {
        let key = |(time_secs, value)| Key { time_secs, value, transition: Transition::LINEAR };
        Self::new(control, samples.into_iter().map(key).collect())
    }

    /// Index of the control.
    pub const fn control(&self) -> usize {
        self.control
    }

    /// The keys in order of time; at least one.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// The state at a time; before the first and after the last key it rests there.
    pub fn at(&self, time_secs: f64) -> Jet {
        let after = self.keys.partition_point(|key| key.time_secs <= time_secs);
        match (after.checked_sub(1).and_then(|before| self.keys.get(before)), self.keys.get(after)) {
            (Some(a), Some(b)) => {
                a.transition.at(time_secs - a.time_secs, b.time_secs - a.time_secs, a.value, b.value)
            }
            (Some(key), None) | (None, Some(key)) => Jet::rest(key.value),
            (None, None) => Jet::default(),
        }
    }

    /// The state just before a time: that of the span that ends there, not of the one that begins.
    pub(crate) fn just_before(&self, time_secs: f64) -> Jet {
        let at = self.keys.partition_point(|key| key.time_secs < time_secs);
        match (at.checked_sub(1).and_then(|before| self.keys.get(before)), self.keys.get(at)) {
            (Some(a), Some(b)) => {
                a.transition.at(time_secs - a.time_secs, b.time_secs - a.time_secs, a.value, b.value)
            }
            _ => self.at(time_secs),
        }
    }

    /// Whether a transition function takes the track beyond the values of its keys on purpose.
    pub(crate) fn overshoots(&self) -> bool {
        self.keys.iter().any(|key| match key.transition {
            Transition::Ease(easing) | Transition::Part { easing, .. } => easing.overshoots(),
            Transition::Hermite { .. } => false,
        })
    }

    pub(crate) fn end_secs(&self) -> f64 {
        self.keys.last().map_or(0.0, |key| key.time_secs)
    }
}

impl Key {
    pub(crate) fn check(&self, control: usize, key: usize) -> Result<(), ClipError> {
        let numbers = match self.transition {
            Transition::Ease(Easing::Bezier(numbers)) => numbers,
            Transition::Ease(_) => [0.0; 4],
            Transition::Part { from, to, rise, .. } => [from, to, rise, 0.0],
            Transition::Hermite { leaving, arriving } => [leaving, arriving, 0.0, 0.0],
        };
        let sound = |number: &f64| number.abs() <= 1e12;
        if !numbers.iter().chain([&self.time_secs, &self.value]).all(sound) {
            return Err(ClipError::NotFinite { control, key });
        }
        match self.transition {
            Transition::Part { from, to, .. }
                if !(0.0..=1.0).contains(&from.min(to)) || from.max(to) > 1.0 =>
            {
                Err(ClipError::Share { control, key })
            }
            _ => Ok(()),
        }
    }
}

/// What follows the end of a clip.
///
/// The seams are as smooth as the clip makes them. A loop goes on from its last values to its first ones, so
/// where they differ the value jumps, and where they arrive and leave with different rates there is a corner.
/// Ping-pong turns every rate round, so what arrives at speed (a straight span) turns in a corner. A track
/// that ends before the clip does rests from its last key to the end of the repetition, at once, however fast
/// it was. Equal first and last keys and spans that rest at both ends ([`Easing::MinimumJerk`]) make a seam
/// that cannot be felt. Starting, stopping and interrupting is smooth whatever the seams are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The last values stay. (In a player they come to rest smoothly, each from where its own track ends.)
    #[default]
    Once,
    /// The start.
    Loop,
    /// The way back to the start, and so on.
    PingPong,
}

/// A piece of animation: tracks of keys for some controls.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip {
    /// Name.
    pub name: String,
    /// Name of the key that plays the clip.
    pub key: Option<String>,
    /// What follows the end.
    pub wrap: Wrap,
    pub(crate) tracks: Vec<Track>,
}

impl Clip {
    /// A clip from its tracks, to be played once.
    ///
    /// # Errors
    /// Two tracks of one control.
    pub fn new(name: impl Into<String>, tracks: Vec<Track>) -> Result<Self, ClipError> {
        let mut controls = HashSet::with_capacity(tracks.len());
        if let Some(track) = tracks.iter().find(|track| !controls.insert(track.control)) {
            return Err(ClipError::TwoTracks { control: track.control });
        }
        Ok(Self { name: name.into(), tracks, ..Self::default() })
    }

    /// The same clip with another end.
    #[must_use]
    pub fn wrapped(self, wrap: Wrap) -> Self {
        Self { wrap, ..self }
    }

    /// The tracks, each of another control.
    pub fn tracks(&self) -> &[Track] {
        &self.tracks
    }

    /// The track of a control.
    pub fn track(&self, control: usize) -> Option<&Track> {
        self.tracks.iter().find(|track| track.control == control)
    }

    /// Time of the last key.
    pub fn duration_secs(&self) -> f64 {
        self.tracks.iter().map(Track::end_secs).fold(0.0, f64::max)
    }

    /// The state of a control `time_secs` after the start, through all repetitions; `None` without a track.
    pub fn at(&self, control: usize, time_secs: f64) -> Option<Jet> {
        Some(self.track_at(self.track(control)?, time_secs))
    }

    /// Writes the values at a time into a slice of one value per control; those without a track stay as they
    /// are.
    pub fn sample(&self, time_secs: f64, values: &mut [f32]) {
        for track in &self.tracks {
            if let Some(value) = values.get_mut(track.control) {
                *value = self.track_at(track, time_secs).value as f32;
            }
        }
    }

    fn track_at(&self, track: &Track, time_secs: f64) -> Jet {
        self.wrap.at(track, self.duration_secs(), time_secs)
    }
}

impl Wrap {
    /// The state of a track of a clip that lasts `duration_secs`.
    pub(crate) fn at(self, track: &Track, duration_secs: f64, time_secs: f64) -> Jet {
        if duration_secs <= 0.0 || !time_secs.is_finite() {
            return track.at(time_secs);
        }
        match self {
            Self::Once => track.at(time_secs),
            Self::Loop => track.at(time_secs.rem_euclid(duration_secs)),
            Self::PingPong => {
                let phase_secs = time_secs.rem_euclid(2.0 * duration_secs);
                if phase_secs <= duration_secs {
                    return track.at(phase_secs);
                }
                let state = track.just_before(2.0 * duration_secs - phase_secs);
                Jet { velocity: -state.velocity, ..state }
            }
        }
    }
}
