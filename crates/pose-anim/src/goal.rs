//! What a move is asked to do, and the limits of what may be asked.

use crate::{Easing, Jet, Pace};

/// Share of its range by which a value may leave it through rounding.
pub(crate) const ROUNDING: f64 = 1e-12;

/// Durations that a move may have: a shorter one has derivatives without meaning, a longer one no end.
const DURATIONS_SECS: std::ops::RangeInclusive<f64> = 0.001..=3600.0;

/// The values that a control may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) min: f64,
    pub(crate) max: f64,
}

impl Range {
    pub(crate) fn clamp(self, value: f64) -> f64 {
        value.max(self.min).min(self.max)
    }

    pub(crate) fn width(self) -> f64 {
        self.max - self.min
    }

    /// Whether a value is in the range, up to rounding.
    pub(crate) fn holds(self, value: f64) -> bool {
        (self.clamp(value) - value).abs() <= ROUNDING * self.width()
    }

    /// The end of the pipeline: what is out of range rests at its end. What is so by rounding only keeps its rates.
    pub(crate) fn confine(self, state: Jet) -> Jet {
        if self.holds(state.value) {
            Jet { value: self.clamp(state.value), ..state }
        } else {
            Jet::rest(self.clamp(state.value))
        }
    }
}

/// Where to go and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
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

impl Goal {
    pub(crate) const NONE: Self =
        Self { target: 0.0, duration_secs: None, pace: Pace::OTHER, factor: 1.0, easing: None };

    /// How long the move takes that starts in this state.
    pub(crate) fn duration_from(&self, state: Jet, range: Range) -> f64 {
        let own_secs = self.pace.duration_secs(self.target - state.value, range.width());
        let secs = self.duration_secs.unwrap_or(own_secs) * self.factor;
        sensible(secs, own_secs)
    }
}

/// A duration within [`DURATIONS_SECS`]; `otherwise` if it is no number.
pub(crate) fn sensible(secs: f64, otherwise_secs: f64) -> f64 {
    let secs = if secs.is_nan() { otherwise_secs } else { secs };
    secs.max(*DURATIONS_SECS.start()).min(*DURATIONS_SECS.end())
}
