use std::f64::consts::TAU;

/// The 1€ filter (Casiez, Roussel & Vogel, CHI 2012): a lag whose cutoff grows with speed, so that what
/// rests does not tremble and what moves is not late.
///
/// ```
/// use avatar_live::OneEuro;
/// let mut filter = OneEuro::default();
/// assert_eq!(filter.next(5.0, 1.0 / 60.0, 1.0, 0.01), 5.0);
/// assert!(filter.next(6.0, 1.0 / 60.0, 1.0, 0.01) < 5.2);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OneEuro {
    value: f64,
    speed: f64,
    has_value: bool,
}

/// Cutoff of the filter of the speed, in Hz: the paper's own.
const SPEED_CUTOFF: f64 = 1.0;

impl OneEuro {
    /// The filtered value of the next sample, `dt_secs` after the one before. The cutoff in Hz is
    /// `least + beta · |speed|`, so that nothing is later than `1 / (2π least)` seconds. A sample that is not
    /// finite, and one that comes at no time, leave the value as it is.
    pub fn next(&mut self, sample: f64, dt_secs: f64, least: f64, beta: f64) -> f64 {
        if !self.has_value && sample.is_finite() {
            *self = Self { value: sample, speed: 0.0, has_value: true };
        } else if sample.is_finite() && dt_secs > 0.0 && least > 0.0 {
            let speed = (sample - self.value) / dt_secs;
            self.speed += share(dt_secs, SPEED_CUTOFF) * (speed - self.speed);
            self.value += share(dt_secs, least + beta * self.speed.abs()) * (sample - self.value);
        }
        self.value
    }

    /// Takes a value as it is, with no speed.
    pub(crate) fn rest_at(&mut self, value: f64) {
        *self = Self { value, speed: 0.0, has_value: true };
    }
}

/// The share of a sample in the next value: `1 / (1 + τ / T)` with `τ = 1 / (2π f)`.
fn share(dt_secs: f64, cutoff: f64) -> f64 {
    1.0 / (1.0 + 1.0 / (TAU * cutoff * dt_secs))
}
