//! What pulls at a tail, and how far that moves it in a given time.

use glam::Vec3;
use std::f64::consts::TAU;

/// What pulls at the tail of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// A damped harmonic oscillator about the place where the animation has the tail:
    /// `x″ = −ω² (x − rest) − 2 ζ ω (x′ − rest′) + gravity`, solved in closed form, so no stiffness is too
    /// much for it.
    Oscillator {
        /// Swings a second without damping, `ω / 2π`; taken as 0.05…1000.
        frequency_hz: f32,
        /// ζ: 0 swings for ever, 1 returns fastest without swinging past rest; taken as 0…100.
        damping_ratio: f32,
        /// Acceleration in world space; the tail hangs `gravity / ω²` beside its rest.
        gravity: Vec3,
    },
    /// The rule of VRM spring bones, of both versions of the standard,
    /// <https://github.com/vrm-c/vrm-specification/tree/master/specification/VRMC_springBone-1.0>. A joint
    /// keeps its length.
    Vrm {
        /// Force towards rest; not below 0.
        stiffness: f32,
        /// Share of the speed that is lost at each tick, 0…1.
        drag: f32,
        /// Force in world space: the standard's direction times its power.
        gravity: Vec3,
    },
}

impl Law {
    /// The same with every number in its range, so that nothing infinite is computed.
    pub(crate) fn sane(self) -> Self {
        match self {
            Self::Oscillator { frequency_hz, damping_ratio, gravity } => Self::Oscillator {
                frequency_hz: within(frequency_hz, 0.05, 1000.0),
                damping_ratio: within(damping_ratio, 0.0, 100.0),
                gravity: force(gravity),
            },
            Self::Vrm { stiffness, drag, gravity } => Self::Vrm {
                stiffness: within(stiffness, 0.0, 1e6),
                drag: within(drag, 0.0, 1.0),
                gravity: force(gravity),
            },
        }
    }
}

/// NaN becomes the lowest value.
pub(crate) fn within(value: f32, lowest: f32, highest: f32) -> f32 {
    value.max(lowest).min(highest)
}

fn force(force: Vec3) -> Vec3 {
    if force.is_finite() { force.clamp_length_max(1e6) } else { Vec3::ZERO }
}

/// What a time does to an oscillator at the distance `x` from rest, with the speed `v`:
/// `x₁ = xx · x + xv · v` and `v₁ = vx · x + vv · v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Response {
    pub(crate) xx: f32,
    pub(crate) xv: f32,
    pub(crate) vx: f32,
    pub(crate) vv: f32,
}

impl Response {
    /// The solution of `x″ = −ω² x − 2 ζ ω x′` after `secs`.
    pub(crate) fn new(frequency_hz: f32, damping_ratio: f32, secs: f64) -> Self {
        let omega = TAU * f64::from(frequency_hz);
        let zeta = f64::from(damping_ratio);
        let root = libm::sqrt((zeta * zeta - 1.0).abs());
        // The decaying cosine, and the decaying sine divided by its own frequency.
        let (cosine, sine) = if root * omega * secs < 1e-6 {
            let decay = libm::exp(-zeta * omega * secs);
            (decay, decay * secs)
        } else if zeta < 1.0 {
            let decay = libm::exp(-zeta * omega * secs);
            let turn = omega * root * secs;
            (decay * libm::cos(turn), decay * libm::sin(turn) / (omega * root))
        } else {
            // ζ − √(ζ² − 1) without the difference of large numbers.
            let slow = libm::exp(-omega * secs / (zeta + root));
            let fast = libm::exp(-omega * secs * (zeta + root));
            (0.5 * (slow + fast), 0.5 * (slow - fast) / (omega * root))
        };
        Self {
            xx: (cosine + zeta * omega * sine) as f32,
            xv: sine as f32,
            vx: (-omega * omega * sine) as f32,
            vv: (cosine - zeta * omega * sine) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Response;

    /// Against a thousand steps of Runge and Kutta's fourth order.
    #[test]
    fn the_closed_form_solves_the_equation() {
        for (frequency, damping) in
            [(0.5, 0.0), (2.0, 0.3), (3.0, 1.0), (3.0, 1.000_001), (1.0, 2.5), (8.0, 0.05)]
        {
            let (omega, secs) = (std::f64::consts::TAU * frequency, 0.4);
            let slope = |[x, v]: [f64; 2]| [v, -omega * omega * x - 2.0 * damping * omega * v];
            let along = |[x, v]: [f64; 2], [dx, dv]: [f64; 2], h: f64| [x + h * dx, v + h * dv];
            let [mut a, h] = [[0.7, -1.3], [secs / 1000.0; 2]];
            for _ in 0..1000 {
                let h = h[0];
                let k1 = slope(a);
                let k2 = slope(along(a, k1, h / 2.0));
                let k3 = slope(along(a, k2, h / 2.0));
                let k4 = slope(along(a, k3, h));
                for part in 0..2 {
                    a[part] += h / 6.0 * (k1[part] + 2.0 * k2[part] + 2.0 * k3[part] + k4[part]);
                }
            }
            let found = Response::new(frequency as f32, damping as f32, secs);
            let x = f64::from(found.xx) * 0.7 - f64::from(found.xv) * 1.3;
            let v = f64::from(found.vx) * 0.7 - f64::from(found.vv) * 1.3;
            assert!((x - a[0]).abs() < 1e-5, "{frequency} Hz, damping {damping}: {x} for {}", a[0]);
            assert!(
                (v - a[1]).abs() < 1e-5 * omega.max(1.0),
                "{frequency} Hz, damping {damping}: {v} for {}",
                a[1]
            );
        }
    }

    /// Two steps are one of the sum of their times.
    #[test]
    fn steps_add_up() {
        for damping in [0.0, 0.4, 1.0, 3.0] {
            let [a, b, whole] = [0.013, 0.031, 0.044].map(|secs| Response::new(4.0, damping, secs));
            assert!((b.xx * a.xx + b.xv * a.vx - whole.xx).abs() < 1e-6);
            assert!((b.xx * a.xv + b.xv * a.vv - whole.xv).abs() < 1e-6);
            assert!((b.vx * a.xx + b.vv * a.vx - whole.vx).abs() < 1e-5);
        }
    }
}
