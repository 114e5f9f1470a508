//! Breath, the small motions of head and brows, and pupils.

use crate::Style;
use crate::chance::{Chance, Stream};
use crate::curves::{Follow, spline, step};
use crate::parameters as p;

/// One breath after the other: in, out, and a pause.
#[derive(Clone, Debug)]
pub(crate) struct Breath {
    seed: u64,
    count: u64,
    start: f64,
    secs: f64,
    depth: f64,
    pub(crate) next: f64,
}

impl Breath {
    pub(crate) fn new(seed: u64, style: &Style) -> Self {
        let secs = 60.0 / style.breaths_per_min;
        let mut chance = Chance::of(seed, Stream::Breath, 0);
        Self { seed, count: 0, start: 0.0, secs, depth: 0.0, next: secs * chance.share() }
    }

    pub(crate) fn happen(&mut self, style: &Style) {
        self.count += 1;
        let mut chance = Chance::of(self.seed, Stream::Breath, self.count);
        self.start = self.next;
        self.secs = chance.log_normal(60.0 / style.breaths_per_min, p::BREATH_SPREAD);
        self.depth = chance.log_normal(style.breath_depth, p::BREATH_SPREAD).min(3.0);
        self.next = self.start + self.secs;
    }

    /// How much air is in, about 0 to 1.
    pub(crate) fn value(&self, now: f64) -> f64 {
        let s = (now - self.start) / self.secs;
        match s < p::BREATH_IN {
            true => self.depth * step(s / p::BREATH_IN),
            false => self.depth * (1.0 - step((s - p::BREATH_IN) / p::BREATH_OUT)),
        }
    }

    pub(crate) fn count(&self) -> u64 {
        self.count
    }
}

/// How many numbers move slowly: three of the head, three of the brows, and the pupils.
pub(crate) const MOTIONS: usize = 7;

/// Random motion without high frequencies: cubic B-splines over knots of random height, in a slow and a fast
/// half. The numbers lie within -1 and 1.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    seed: u64,
    halves: [Half; 2],
}

#[derive(Clone, Debug)]
struct Half {
    secs: f64,
    share: f64,
    /// Number of the knot before now.
    knot: i64,
    /// The four knots around now.
    heights: [[f64; 4]; MOTIONS],
}

impl Motion {
    pub(crate) fn new(seed: u64) -> Self {
        let half = |secs: f64, share: f64| Half { secs, share, knot: i64::MIN, heights: [[0.0; 4]; MOTIONS] };
        let [slow, fast] = p::KNOT_SECS;
        Self { seed, halves: [half(slow, 1.0 - p::FAST_SHARE), half(fast, p::FAST_SHARE)] }
    }

    pub(crate) fn values(&mut self, now: f64) -> [f64; MOTIONS] {
        let mut sums = [0.0; MOTIONS];
        for (number, half) in self.halves.iter_mut().enumerate() {
            let at = now / half.secs;
            let knot = at.floor() as i64;
            if knot != half.knot {
                half.knot = knot;
                for (place, of_motion) in (0..).zip(&mut half.heights) {
                    for (offset, height) in (0i64..).zip(of_motion) {
                        // Knots of all motions of both halves have numbers of their own.
                        let event = (((knot - 1 + offset) as u64) << 5) | (number as u64) << 4 | place;
                        *height = Chance::of(self.seed, Stream::Noise, event).between(-1.0, 1.0);
                    }
                }
            }
            let weights = spline(at - knot as f64);
            for (sum, heights) in sums.iter_mut().zip(&half.heights) {
                let value: f64 = heights.iter().zip(weights).map(|(height, weight)| height * weight).sum();
                *sum += half.share * value;
            }
        }
        sums
    }
}

/// The width of both pupils.
#[derive(Clone, Debug)]
pub(crate) struct Pupils {
    luminance: f64,
    interest: f64,
    /// Millimetres in a lit room.
    in_room: f64,
    follow: Follow<1>,
}

impl Pupils {
    pub(crate) fn new() -> Self {
        let mut pupils = Self {
            luminance: p::ROOM_LUMINANCE,
            interest: 0.0,
            in_room: 0.0,
            follow: Follow::at([0.0], [0.0], p::PUPIL_RATE, 0.0),
        };
        pupils.in_room = pupils.goal();
        pupils.follow = Follow::at([pupils.in_room], [0.0], p::PUPIL_RATE, 0.0);
        pupils
    }

    fn goal(&self) -> f64 {
        let bright = libm::log10(self.luminance.clamp(1e-6, 1e8));
        let wide = 4.9 - 3.0 * libm::tanh(0.4 * bright);
        wide + p::PUPIL_INTEREST * self.interest
    }

    pub(crate) fn light(&mut self, luminance: f64, now: f64) {
        if luminance >= 0.0 {
            self.luminance = luminance;
            self.follow.lead([self.goal()], [0.0], now);
        }
    }

    pub(crate) fn interest(&mut self, interest: f64, now: f64) {
        if !interest.is_nan() {
            self.interest = interest.clamp(-1.0, 1.0);
            self.follow.lead([self.goal()], [0.0], now);
        }
    }

    /// Millimetres in a lit room, without interest.
    pub(crate) fn in_room(&self) -> f64 {
        self.in_room
    }

    /// Millimetres.
    pub(crate) fn value(&mut self, now: f64) -> f64 {
        self.follow.settle(now);
        self.follow.value(now)[0]
    }
}
