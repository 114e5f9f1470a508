//! Random numbers that depend on a seed and on which event they are for, and on nothing else: so a face does
//! the same whatever the steps are in which its time passes.

use std::f64::consts::TAU;

/// What a number is for. Each has numbers of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stream {
    Blink = 1,
    Gaze,
    Micro,
    Breath,
    Noise,
    Trigger,
}

/// The numbers of one event.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chance {
    state: u64,
}

/// The step of SplitMix64 (Steele, Lea & Flood 2014), and its last mixing of bits.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

fn mixed(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

impl Chance {
    pub(crate) fn of(seed: u64, stream: Stream, event: u64) -> Self {
        let of_stream = mixed(seed ^ mixed((stream as u64).wrapping_mul(STEP)));
        Self { state: mixed(of_stream ^ event.wrapping_mul(STEP)) }
    }

    /// From 0 to below 1.
    pub(crate) fn share(&mut self) -> f64 {
        self.state = self.state.wrapping_add(STEP);
        (mixed(self.state) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.share()
    }

    pub(crate) fn happens(&mut self, probability: f64) -> bool {
        self.share() < probability
    }

    /// A normal distribution of mean 0 and deviation 1 (Box & Muller 1958).
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.share()));
        radius * libm::cos(TAU * self.share())
    }

    /// A log-normal distribution of this mean, whose logarithm has the deviation `spread`.
    pub(crate) fn log_normal(&mut self, mean: f64, spread: f64) -> f64 {
        mean * libm::exp(spread * self.normal() - 0.5 * spread * spread)
    }

    /// An exponential distribution of this mean.
    pub(crate) fn exponential(&mut self, mean: f64) -> f64 {
        -mean * libm::log(1.0 - self.share())
    }
}
