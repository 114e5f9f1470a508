use std::ops::{Add, Mul, Sub};

/// A quantity that changes in time, at one moment: its value and its first two derivatives by seconds.
///
/// Sums and products follow the rules of Leibniz, so whatever is built from jets carries its analytic
/// derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// Value.
    pub value: f64,
    /// First derivative, per second.
    pub velocity: f64,
    /// Second derivative, per second squared.
    pub acceleration: f64,
}

impl Jet {
    /// A value at rest.
    pub const fn rest(value: f64) -> Self {
        Self { value, velocity: 0.0, acceleration: 0.0 }
    }

    /// Whether nothing moves.
    pub fn is_rest(self) -> bool {
        self.velocity == 0.0 && self.acceleration == 0.0
    }

    /// The minimum-jerk step: `r(s) = 10s³ − 15s⁴ + 6s⁵` at `s = age / duration`, 0 before and 1 after (Flash
    /// & Hogan 1985, *The coordination of arm movements*, eq. 3). Both derivatives are 0 at either end.
    pub fn step(age_secs: f64, duration_secs: f64) -> Self {
        if age_secs <= 0.0 {
            return Self::rest(0.0);
        }
        if age_secs >= duration_secs {
            return Self::rest(1.0);
        }
        let rate = 1.0 / duration_secs;
        let s = age_secs * rate;
        let u = 1.0 - s;
        Self {
            value: minimum_jerk(s),
            velocity: 30.0 * s * s * u * u * rate,
            acceleration: 60.0 * s * u * (1.0 - 2.0 * s) * rate * rate,
        }
    }

    /// `f(self)` in time, from `f` with its two derivatives by its argument, at the value of `self`.
    pub(crate) fn through(self, f: Self) -> Self {
        Self {
            value: f.value,
            velocity: f.velocity * self.velocity,
            acceleration: f.acceleration * self.velocity * self.velocity + f.velocity * self.acceleration,
        }
    }

    /// `(1 − share) · self + share · other`.
    pub fn mix(self, other: Self, share: Self) -> Self {
        self + share * (other - self)
    }
}

impl Add for Jet {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            velocity: self.velocity + other.velocity,
            acceleration: self.acceleration + other.acceleration,
        }
    }
}

impl Sub for Jet {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            velocity: self.velocity - other.velocity,
            acceleration: self.acceleration - other.acceleration,
        }
    }
}

impl Mul for Jet {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            velocity: self.velocity * other.value + self.value * other.velocity,
            acceleration: self.acceleration * other.value
                + 2.0 * self.velocity * other.velocity
                + self.value * other.acceleration,
        }
    }
}

/// The values of [`Jet::step`] without its derivatives, at `s = age / duration`.
pub(crate) fn minimum_jerk(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}
