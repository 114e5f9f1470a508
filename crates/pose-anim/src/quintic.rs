use crate::Jet;
use crate::quadratic::roots;
use crate::range::ROUNDING;

/// The only polynomial of degree five that starts in a given state and comes to rest at a target: the move of
/// least jerk (Flash & Hogan 1985).
///
/// Because it ends at rest, it has a triple root of `x − target` at its end; with `s = age / duration`:
///
/// ```text
/// x(s) = target + (1 − s)³ · (c0 + c1·s + c2·s²)
/// c0 = x₀ − target        c1 = v₀D + 3c0        c2 = a₀D²/2 + 3v₀D + 6c0
/// ```
///
/// In this form the arrival is exact in floating point, and the velocity is `(1 − s)²` times a quadratic, so
/// that the extrema have a closed form.
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

    /// `c0`, `c1` and `c2` of the formula.
    pub(crate) const fn coefficients(&self) -> [f64; 3] {
        self.c
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
        // A move that touches an end of its range must not fail by rounding. The excess that this allows is
        // clamped at the end of the pipeline.
        let slack = ROUNDING * (max - min);
        roots(q2, q1, q0).iter().filter(|s| (0.0..1.0).contains(*s)).all(|s| {
            let u = 1.0 - s;
            let extremum = self.target + u * u * u * (c0 + s * (c1 + s * c2));
            (min - slack..=max + slack).contains(&extremum)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        /// The closed form of the extrema against a look at many points.
        #[test]
        fn stays_within_is_what_a_dense_look_sees(
            value in -1.0f64..=1.0, velocity in -40.0f64..40.0, acceleration in -400.0f64..400.0,
            target in prop_oneof![-1.0f64..=1.0, Just(-1.0), Just(1.0)], secs in 0.01f64..0.5,
        ) {
            let quintic = Quintic::new(Jet { value, velocity, acceleration }, target, secs);
            let beyond = (0..=4000)
                .map(|step| quintic.at(f64::from(step) / 4000.0 * secs).value.abs() - 1.0)
                .fold(f64::MIN, f64::max);
            // Between two of the points an extremum is higher by the curvature there times a quarter of a
            // step squared at most.
            let curve = [0.0, 0.25, 0.5, 0.75, 1.0].map(|s| quintic.at(s * secs * (1.0 - 1e-9)).acceleration.abs());
            let missed = curve.into_iter().fold(0.0, f64::max) * 4.0 * (secs / 4000.0).powi(2);
            if quintic.stays_within(-1.0, 1.0) {
                prop_assert!(beyond <= 4e-12, "{}", beyond);
            } else {
                prop_assert!(beyond > -missed - 1e-12, "{} {}", beyond, missed);
            }
        }

        #[test]
        fn it_begins_with_its_state_and_ends_at_rest(
            value in -1.0f64..=1.0, velocity in -40.0f64..40.0, acceleration in -400.0f64..400.0,
            target in -1.0f64..=1.0, secs in 0.01f64..5.0,
        ) {
            let quintic = Quintic::new(Jet { value, velocity, acceleration }, target, secs);
            let start = quintic.at(0.0);
            prop_assert!((start.value - value).abs() < 1e-15 * 4.0);
            prop_assert!((start.velocity - velocity).abs() < 1e-12 * (1.0 + 1.0 / secs + velocity.abs()));
            let size = 1.0 / (secs * secs) + velocity.abs() / secs + acceleration.abs();
            prop_assert!((start.acceleration - acceleration).abs() < 1e-13 * (1.0 + size));
            prop_assert_eq!(quintic.at(secs), Jet::rest(target));
            // On the way there, too, and not only from the very end on.
            let last = quintic.at(secs * (1.0 - 1e-8));
            prop_assert!((last.value - target).abs() < 1e-12 && last.velocity.abs() < 1e-6 * (1.0 + size));
            prop_assert!(last.acceleration.abs() < 1e-4 * (1.0 + size));
        }
    }
}
