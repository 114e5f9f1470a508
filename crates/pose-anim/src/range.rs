use crate::Jet;

/// Share of its range by which a value may leave it through rounding.
pub(crate) const ROUNDING: f64 = 1e-12;

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

    /// The range with a share of its width more at either end.
    pub(crate) fn widened(self, share: f64) -> Self {
        let margin = share * self.width();
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// Whether a value is in the range, up to rounding.
    pub(crate) fn holds(self, value: f64) -> bool {
        (self.clamp(value) - value).abs() <= ROUNDING * self.width()
    }

    /// The end of the pipeline: a state out of range rests at the end of the range. A state that is out by
    /// rounding only keeps its rates.
    pub(crate) fn confine(self, state: Jet) -> Jet {
        if self.holds(state.value) {
            Jet { value: self.clamp(state.value), ..state }
        } else {
            Jet::rest(self.clamp(state.value))
        }
    }
}
