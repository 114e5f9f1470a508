//! What of a sound tells which viseme it is: how loud it is in each of 24 bands of pitch, a hundred times a
//! second, against how loud the voice is at all.

use std::f64::consts::PI;

use crate::resample::RATE;

/// Samples of 16 kHz from one frame to the next: a hundredth of a second.
pub const HOP: usize = 160;

/// Samples that a frame hears: 25 ms.
pub const WINDOW: usize = 400;

/// Bands of pitch.
pub const BANDS: usize = 24;

/// Numbers of a frame: the bands, then all of them together.
pub const FEATURES: usize = BANDS + 1;

/// Points of the Fourier transform.
const POINTS: usize = 512;

/// The lowest and the highest pitch that is heard, in Hz.
const PITCHES: [f64; 2] = [80.0, 7_600.0];

/// Power that is added to each, of full scale: -80 dB, so that digital silence is as quiet as a quiet room.
const FLOOR: f32 = 1e-8;

/// The least level of a voice, as the logarithm of its power: -55 dB. What is quieter than this is not made
/// louder.
const LEAST_LEVEL: f32 = -12.7;

/// The level before anything was heard: -28 dB.
const FIRST_LEVEL: f32 = -6.5;

/// How fast the level rises towards louder sound, part a frame.
const RISE: f32 = 0.2;

/// How much the level falls a frame: 6.5 dB a second.
const FALL: f32 = 0.015;

/// Range of a feature, so that a bang or a gap does not drown the rest.
const RANGE: [f32; 2] = [-11.0, 4.0];

/// The middle of what features of speech are, and the inverse of how far they lie around it: networks learn
/// faster from numbers around 0.
const MIDDLE: f32 = -4.0;
const SCALE: f32 = 0.3;

/// One frame's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    /// Logarithms of the power in each band and of all, minus the level of the voice, scaled to be around 0.
    pub features: [f32; FEATURES],
    /// Logarithm of the mean square of the samples, full scale being 0.
    pub power: f32,
}

/// Makes a [`Spectrum`] of every [`HOP`] samples of 16 kHz. Frame `k` hears the samples from `160 k` to
/// `160 k + 400`; its time is the middle of them.
#[derive(Clone, Debug)]
pub struct Features {
    samples: [f32; WINDOW],
    /// Samples that are there.
    filled: usize,
    level: f32,
    window: Vec<f32>,
    /// `cos` and `sin` of the transform's steps.
    turns: Vec<[f32; 2]>,
    /// For each band, its first point and the weights of the points from there on.
    bands: Vec<(usize, Vec<f32>)>,
    work: Vec<[f32; 2]>,
}

impl Default for Features {
    fn default() -> Self {
        Self::new()
    }
}

impl Features {
    /// With nothing heard yet.
    #[must_use]
    pub fn new() -> Self {
        let window: Vec<f32> = (0..WINDOW)
            .map(|index| (0.5 - 0.5 * libm::cos(2.0 * PI * (index as f64 + 0.5) / WINDOW as f64)) as f32)
            .collect();
        let turns = (0..POINTS / 2).map(|index| {
            let angle = -2.0 * PI * index as f64 / POINTS as f64;
            [libm::cos(angle) as f32, libm::sin(angle) as f32]
        });
        Self {
            samples: [0.0; WINDOW],
            filled: 0,
            level: FIRST_LEVEL,
            window,
            turns: turns.collect(),
            bands: (0..BANDS).map(band).collect(),
            work: vec![[0.0; 2]; POINTS],
        }
    }

    /// As if nothing had been heard.
    pub fn reset(&mut self) {
        self.filled = 0;
        self.level = FIRST_LEVEL;
    }

    /// Takes a sample of 16 kHz; the frame that ends with it, if one does.
    pub fn push(&mut self, sample: f32) -> Option<Spectrum> {
        self.samples[self.filled] = sample;
        self.filled += 1;
        if self.filled < WINDOW {
            return None;
        }
        let spectrum = self.spectrum();
        self.samples.copy_within(HOP.., 0);
        self.filled = WINDOW - HOP;
        Some(spectrum)
    }

    fn spectrum(&mut self) -> Spectrum {
        self.work.fill([0.0; 2]);
        let mut square = 0.0;
        for (index, (sample, window)) in self.samples.iter().zip(&self.window).enumerate() {
            self.work[reversed(index)][0] = sample * window;
            square += sample * sample;
        }
        transform(&mut self.work, &self.turns);
        let power = libm::logf(square / WINDOW as f32 + FLOOR);
        // The level of the voice: its loud parts at once, and slowly down from there.
        if power > self.level {
            self.level += RISE * (power - self.level);
        } else {
            self.level = (self.level - FALL).max(LEAST_LEVEL).max(power.min(self.level));
        }
        let mut features = [0.0; FEATURES];
        for (feature, (first, weights)) in features.iter_mut().zip(&self.bands) {
            let points = self.work[*first..].iter().zip(weights);
            let sum: f32 = points.map(|([re, im], weight)| weight * (re * re + im * im)).sum();
            *feature = libm::logf(sum + FLOOR);
        }
        features[BANDS] = power;
        for feature in &mut features {
            *feature = ((*feature - self.level).clamp(RANGE[0], RANGE[1]) - MIDDLE) * SCALE;
        }
        Spectrum { features, power }
    }
}

/// Pitch as it is heard (S. S. Stevens and others, 1937; the formula of D. O'Shaughnessy, 1987).
fn mel(hertz: f64) -> f64 {
    2595.0 * libm::log10(1.0 + hertz / 700.0)
}

/// A triangle over the points of the transform, from the middle of the band before to that of the band after.
fn band(index: usize) -> (usize, Vec<f32>) {
    let [low, high] = PITCHES.map(mel);
    let step = (high - low) / (BANDS + 1) as f64;
    let middle = low + step * (index + 1) as f64;
    let weight = |point: usize| {
        let pitch = mel(point as f64 * f64::from(RATE) / POINTS as f64);
        (1.0 - (pitch - middle).abs() / step).max(0.0)
    };
    let first = (0..POINTS / 2).find(|point| weight(*point) > 0.0).unwrap_or(0);
    // The window's energy and both halves of the spectrum, so that the bands add up to the mean square.
    let scale = 2.0 / (POINTS as f64 * 0.375 * WINDOW as f64);
    let weights = (first..POINTS / 2).map(weight).take_while(|weight| *weight > 0.0);
    (first, weights.map(|weight| (weight * scale) as f32).collect())
}

/// The place of a sample in the order that the transform takes.
fn reversed(index: usize) -> usize {
    (index as u32).reverse_bits() as usize >> (32 - POINTS.trailing_zeros())
}

/// The Fourier transform of Cooley and Tukey, 1965, of numbers in [`reversed`] order.
fn transform(work: &mut [[f32; 2]], turns: &[[f32; 2]]) {
    let mut size = 2;
    while size <= work.len() {
        let (half, stride) = (size / 2, turns.len() / (size / 2));
        for block in work.chunks_exact_mut(size) {
            let (low, high) = block.split_at_mut(half);
            for (index, (a, b)) in low.iter_mut().zip(high).enumerate() {
                let [cos, sin] = turns[index * stride];
                let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        size *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the definition of the transform.
    #[test]
    fn the_transform_is_the_sum_that_defines_it() {
        let features = Features::new();
        let input: Vec<f32> =
            (0..POINTS).map(|i| ((i * 37 + i * i * 11) % 101) as f32 / 101.0 - 0.5).collect();
        let mut work = vec![[0.0; 2]; POINTS];
        for (index, value) in input.iter().enumerate() {
            work[reversed(index)][0] = *value;
        }
        transform(&mut work, &features.turns);
        for (point, value) in work.iter().enumerate().step_by(7) {
            let mut sum = [0.0, 0.0];
            for (index, sample) in input.iter().enumerate() {
                let angle = -2.0 * PI * (index * point % POINTS) as f64 / POINTS as f64;
                sum[0] += f64::from(*sample) * angle.cos();
                sum[1] += f64::from(*sample) * angle.sin();
            }
            for axis in 0..2 {
                assert!((f64::from(value[axis]) - sum[axis]).abs() < 1e-3, "{point}: {value:?} {sum:?}");
            }
        }
    }

    /// A tone is loudest in the band around its pitch, and as loud there as its mean square.
    #[test]
    fn a_tone_is_in_its_band() {
        for hertz in [200.0_f64, 500.0, 1_500.0, 4_000.0] {
            let mut features = Features::new();
            let mut last = None;
            for index in 0..WINDOW {
                let sample = 0.1 * (2.0 * PI * hertz * index as f64 / f64::from(RATE)).sin();
                last = features.push(sample as f32).or(last);
            }
            let spectrum = last.expect("a window of samples is a frame");
            let [low, high] = PITCHES.map(mel);
            let place = (mel(hertz) - low) / (high - low) * (BANDS + 1) as f64 - 1.0;
            let loudest = (0..BANDS).max_by(|a, b| spectrum.features[*a].total_cmp(&spectrum.features[*b]));
            let loudest = loudest.expect("there are bands");
            assert!((loudest as f64 - place).abs() < 1.0, "{hertz}: {loudest} {place}");
            assert!((spectrum.power - (0.005_f32).ln()).abs() < 0.1, "{}", spectrum.power);
        }
    }
}
