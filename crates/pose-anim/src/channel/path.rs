//! Where a control goes by itself, before any interruption.

use super::clip_path::ClipPath;
use crate::quintic::Quintic;
use crate::range::Range;
use crate::{Easing, Jet};

/// A motion that is a closed function of its own age.
#[derive(Clone, Debug)]
pub(crate) enum Path {
    /// To rest by the move of least jerk. Also: at rest.
    Quintic(Quintic),
    /// Along a transition function.
    Eased(Eased),
    /// Along a track of a clip.
    Clip(ClipPath),
}

impl Path {
    pub(crate) const fn rest(value: f64) -> Self {
        Self::Quintic(Quintic::rest(value))
    }

    /// The state at an age, of a control with this range.
    pub(crate) fn at(&self, age_secs: f64, range: Range) -> Jet {
        match self {
            Self::Quintic(quintic) => quintic.at(age_secs),
            Self::Eased(eased) => eased.at(age_secs),
            Self::Clip(clip) => clip.at(age_secs, range),
        }
    }

    /// Seconds until the motion rests; infinite if it does not.
    pub(crate) fn remaining_secs(&self, age_secs: f64) -> f64 {
        let duration_secs = match self {
            Self::Quintic(quintic) => quintic.duration_secs(),
            Self::Eased(eased) => eased.duration_secs,
            Self::Clip(clip) => clip.duration_secs(),
        };
        (duration_secs - age_secs).max(0.0)
    }

    /// Where the motion comes to rest, or, if it does not, a value on its way.
    pub(crate) fn end(&self) -> f64 {
        match self {
            Self::Quintic(quintic) => quintic.target,
            Self::Eased(eased) => eased.target,
            Self::Clip(clip) => clip.end(),
        }
    }
}

/// `from + (target − from) · f(s)`, which in its last part is led to rest: transition functions may arrive at
/// speed (linear) or jump at their end (step), but a face arrives at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eased {
    pub(crate) from: f64,
    pub(crate) target: f64,
    pub(crate) duration_secs: f64,
    pub(crate) easing: Easing,
}

impl Eased {
    /// Share of the duration in which the motion before fades out, and share in which this one comes to rest.
    pub(crate) const BLEND: f64 = 0.3;

    fn at(&self, age_secs: f64) -> Jet {
        if age_secs >= self.duration_secs {
            return Jet::rest(self.target);
        }
        let rate = 1.0 / self.duration_secs;
        // An infinite slope at the very start or end would meet a weight of 0 there, or one of a few ulps.
        // The weights are of third order in time, so a billionth of a millisecond further in, the product is
        // next to nothing.
        let curve = self.easing.at((age_secs * rate).clamp(1e-12, 1.0 - 1e-12));
        let rise = self.target - self.from;
        let along = Jet {
            value: self.from + rise * curve.value,
            velocity: rise * curve.velocity * rate,
            acceleration: rise * curve.acceleration * rate * rate,
        };
        let landing_secs = Self::BLEND * self.duration_secs;
        let left_secs = self.duration_secs - age_secs;
        if left_secs >= landing_secs {
            return along;
        }
        // The step backward in time, `1 − r(s) = r(1 − s)`: near its end, `1 − r(s)` would be made of
        // rounding errors only, and some functions (the circle) have derivatives there that make something of
        // them.
        let back = Jet::step(left_secs, landing_secs);
        let weight = Jet { velocity: -back.velocity, ..back };
        Jet::rest(self.target) + weight * (along - Jet::rest(self.target))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Transition functions with infinite derivatives at an end meet a weight of nothing there, and not one
    /// of rounding errors: just after the start the move has no weight yet (the fade into it takes care of
    /// that), and just before its end nothing moves any more.
    #[test]
    fn landings_are_free_of_rounding() {
        for name in ["circ-in", "ease-in", "quint-in", "expo-in", "linear", "step"] {
            for step in 0..2000 {
                let duration_secs = 0.05 + 0.001_234_567 * f64::from(step);
                let easing = Easing::from_name(name).unwrap();
                let eased = Eased { from: 1.0, target: -0.3, duration_secs, easing };
                let mut age_secs = duration_secs;
                for _ in 0..6 {
                    age_secs = age_secs.next_down();
                    let state = eased.at(age_secs);
                    assert!((state.value + 0.3).abs() < 1e-15, "{name} {state:?}");
                    assert!(
                        state.velocity.abs() < 1e-9 && state.acceleration.abs() < 1e-5,
                        "{name} {state:?}"
                    );
                }
                assert_eq!(eased.at(duration_secs), Jet::rest(-0.3));
                assert!(eased.at(0.0).acceleration.is_finite());
            }
        }
    }
}
