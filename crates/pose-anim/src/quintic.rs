use crate::{Jet, goal::ROUNDING};

/// The only polynomial of degree five that starts in a given state and comes to rest at a target: the move of least
/// jerk (Flash & Hogan 1985).
///
/// Because it ends at rest, it has a triple root of `x − target` at its end; with `s = age / duration`:
///
/// ```text
/// x(s) = target + (1 − s)³ · (c0 + c1·s + c2·s²)
/// c0 = x₀ − target        c1 = v₀D + 3c0        c2 = a₀D²/2 + 3v₀D + 6c0
/// ```
///
/// In this form the arrival is exact in floating point, and the velocity is `(1 − s)²` times a quadratic, so that
/// the extrema have a closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quintic {
    pub(crate) target: f64,
    duration_secs: f64,
    c: [f64; 3],
}

impl Quintic {
    /// At rest at `target`.
    pub(crate) const fn rest(target: f64) -> Self {
        Self { target, duration_secs: 0.0, c: [0.0; 3] }
    }

    /// From `state` to rest at `target` in `duration_secs` (greater than 0).
    pub(crate) fn new(state: Jet, target: f64, duration_secs: f64) -> Self {
        let c0 = state.value - target;
        let v = state.velocity * duration_secs;
        let a = state.acceleration * duration_secs * duration_secs;
        Self { target, duration_secs, c: [c0, v + 3.0 * c0, 0.5 * a + 3.0 * v + 6.0 * c0] }
    }

    pub(crate) const fn duration_secs(&self) -> f64 {
        self.duration_secs
    }

    pub(crate) fn at(&self, age_secs: f64) -> Jet {
        if age_secs >= self.duration_secs {
            return Jet::rest(self.target);
        }
        let [c0, c1, c2] = self.c;
        let rate = 1.0 / self.duration_secs;
        let s = age_secs * rate;
        let u = 1.0 - s;
        let g = c0 + s * (c1 + s * c2);
        let dg = c1 + 2.0 * c2 * s;
        Jet {
            value: self.target + u * u * u * g,
            velocity: u * u * (u * dg - 3.0 * g) * rate,
            acceleration: u * (u * (2.0 * u * c2 - 6.0 * dg) + 6.0 * g) * rate * rate,
        }
    }

    /// Whether the whole move stays in a range. Its ends are taken to be inside.
    pub(crate) fn stays_within(&self, min: f64, max: f64) -> bool {
        let [c0, c1, c2] = self.c;
        // dx/ds = (1 − s)² · (q0 + q1·s + q2·s²)
        let (q0, q1, q2) = (c1 - 3.0 * c0, 2.0 * c2 - 4.0 * c1, -5.0 * c2);
        // A move that touches an end of its range must not fail by rounding. What this lets through is cut off.
        let slack = ROUNDING * (max - min);
        roots(q2, q1, q0).iter().filter(|s| (0.0..1.0).contains(*s)).all(|s| {
            let u = 1.0 - s;
            let extremum = self.target + u * u * u * (c0 + s * (c1 + s * c2));
            (min - slack..=max + slack).contains(&extremum)
        })
    }
}

/// Real roots of `a·x² + b·x + c`; NaN where there are none. No cancellation (Press et al., Numerical Recipes, 5.6).
pub(crate) fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return [f64::NAN; 2];
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    [q / a, c / q]
}
