//! Where a move goes and how, and the limits of its duration.

use crate::range::Range;
use crate::{Easing, Jet, Pace};

/// Durations that a move may have. In a shorter one the derivatives would be meaningless.
const DURATIONS_SECS: std::ops::RangeInclusive<f64> = 0.001..=3600.0;

/// Where to go and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MoveSpec {
    /// In range.
    pub(crate) target: f64,
    /// `None`: by the distance at the start.
    pub(crate) duration_secs: Option<f64>,
    pub(crate) pace: Pace,
    /// Of either duration.
    pub(crate) factor: f64,
    /// `None`: least jerk.
    pub(crate) easing: Option<Easing>,
}

impl MoveSpec {
    pub(crate) const NONE: Self =
        Self { target: 0.0, duration_secs: None, pace: Pace::OTHER, factor: 1.0, easing: None };

    /// How long the move takes from this state.
    pub(crate) fn duration_from(&self, state: Jet, range: Range) -> f64 {
        let own_secs = self.pace.duration_secs(self.target - state.value, range.width());
        let secs = self.duration_secs.unwrap_or(own_secs) * self.factor;
        clamp_duration(secs, own_secs)
    }
}

/// The duration, clamped to [`DURATIONS_SECS`]; `otherwise_secs` if it is NaN.
pub(crate) fn clamp_duration(secs: f64, otherwise_secs: f64) -> f64 {
    let secs = if secs.is_nan() { otherwise_secs } else { secs };
    secs.max(*DURATIONS_SECS.start()).min(*DURATIONS_SECS.end())
}
