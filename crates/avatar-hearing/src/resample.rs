//! Sound of any rate at the rate that the model hears.

use std::f64::consts::PI;

/// Samples a second that the model hears.
pub const RATE: u32 = 16_000;

/// Rates that are taken, in samples a second.
pub const RATES: std::ops::RangeInclusive<u32> = 8_000..=192_000;

/// How many zeros of the kernel there are on each side.
const ZEROS: usize = 8;

/// Places between two input samples for which the kernel is known; between them it is interpolated.
const PLACES: u32 = 160;

/// Sums that run side by side, so that the processor adds several at once; the order is the same everywhere.
const LANES: usize = 8;

/// The part of the band that the kernel lets through.
const PASS: f64 = 0.92;

/// Brings sound of one rate to [`RATE`], sample by sample: band-limited interpolation with a windowed sinc
/// (J. O. Smith, "Digital Audio Resampling", 2002). Output `k` is the sound at input sample `k * rate /
/// 16000` exactly, so nothing drifts in a sound of any length; it is known [`Resampler::half`] input samples
/// later.
#[derive(Clone, Debug)]
pub struct Resampler {
    rate: u32,
    /// Input samples on each side of an output.
    half: usize,
    /// The kernel at `PLACES + 1` places, `2 * half` weights each.
    kernel: Vec<f32>,
    /// The newest input samples, `2 * half` of them, each twice, so that they lie in one piece.
    recent: Vec<f32>,
    place: usize,
    /// Input samples still to come until the next output can be made.
    wanted: u64,
    /// Where the next output lies between two input samples, in parts of [`RATE`].
    fraction: u32,
}

impl Resampler {
    /// A resampler of sound of `rate` samples a second. Rates outside of [`RATES`] are brought to its ends.
    #[must_use]
    pub fn new(rate: u32) -> Self {
        let rate = rate.clamp(*RATES.start(), *RATES.end());
        let slow = f64::from(RATE.min(rate)) / f64::from(rate);
        let cut = PASS * slow;
        // As many samples as lanes divide.
        let half = (libm::ceil(ZEROS as f64 / cut) as usize).next_multiple_of(LANES / 2);
        let weight = |distance: f64| {
            let zeros = distance.abs() * cut;
            let sinc = if zeros == 0.0 { 1.0 } else { libm::sin(PI * zeros) / (PI * zeros) };
            // A window of Hann.
            let window = 0.5 + 0.5 * libm::cos(PI * (zeros / ZEROS as f64).min(1.0));
            (cut * sinc * window) as f32
        };
        let place = |place: u32| half as f64 - 1.0 + f64::from(place) / f64::from(PLACES);
        let kernel =
            (0..=PLACES).flat_map(|at| (0..2 * half).map(move |index| weight(index as f64 - place(at))));
        let mut made = Self {
            rate,
            half,
            kernel: kernel.collect(),
            recent: vec![0.0; 4 * half],
            place: 0,
            wanted: 0,
            fraction: 0,
        };
        made.reset();
        made
    }

    /// Samples of the input that have to follow an output before it is made.
    #[must_use]
    pub fn half(&self) -> usize {
        self.half
    }

    /// As if nothing had been heard.
    pub fn reset(&mut self) {
        self.recent.fill(0.0);
        self.place = 0;
        self.fraction = 0;
        // The sample at the output's place, and those behind it.
        self.wanted = self.half as u64 + 1;
    }

    /// Takes a sample, and gives to `out` what can now be made: none, one or two samples.
    pub fn push(&mut self, sample: f32, mut out: impl FnMut(f32)) {
        let sample = if sample.is_finite() { sample.clamp(-1.0, 1.0) } else { 0.0 };
        let length = 2 * self.half;
        self.recent[self.place] = sample;
        self.recent[self.place + length] = sample;
        self.place = (self.place + 1) % length;
        self.wanted = self.wanted.saturating_sub(1);
        while self.wanted == 0 {
            out(self.value());
            let next = self.fraction + self.rate;
            self.wanted = u64::from(next / RATE);
            self.fraction = next % RATE;
        }
    }

    /// The sound between the two middle ones of the recent samples.
    fn value(&self) -> f32 {
        let length = 2 * self.half;
        let recent = &self.recent[self.place..self.place + length];
        let step = RATE / PLACES;
        let row = (self.fraction / step) as usize * length;
        let low = dot(recent, &self.kernel[row..row + length]);
        let between = (self.fraction % step) as f32 / step as f32;
        if between == 0.0 {
            return low;
        }
        let high = dot(recent, &self.kernel[row + length..row + 2 * length]);
        low + (high - low) * between
    }
}

/// The sum of products.
fn dot(samples: &[f32], weights: &[f32]) -> f32 {
    let (samples, _) = samples.as_chunks::<LANES>();
    let (weights, _) = weights.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (samples, weights) in samples.iter().zip(weights) {
        for lane in 0..LANES {
            sums[lane] += samples[lane] * weights[lane];
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(hertz: f64, rate: u32, at: f64) -> f64 {
        libm::sin(2.0 * PI * hertz * at / f64::from(rate))
    }

    /// At each rate, a tone is the tone itself at 16 kHz: the sine is the independent source.
    #[test]
    fn a_tone_is_the_same_tone_at_any_rate() {
        for rate in [8_000, 11_025, 16_000, 22_050, 32_000, 44_100, 48_000, 96_000, 192_000] {
            for hertz in [100.0, 440.0, 1_000.0, 2_500.0] {
                let mut resampler = Resampler::new(rate);
                let mut heard = Vec::new();
                for sample in 0..rate / 4 {
                    resampler
                        .push(0.5 * tone(hertz, rate, f64::from(sample)) as f32, |value| heard.push(value));
                }
                assert!(heard.len() > 3_900, "{rate}: {}", heard.len());
                // Not at the beginning, where the tone starts suddenly.
                for (index, value) in heard.iter().enumerate().skip(40) {
                    let meant = 0.5 * tone(hertz, RATE, index as f64);
                    assert!(
                        (f64::from(*value) - meant).abs() < 0.004,
                        "{rate} {hertz} {index}: {value} {meant}"
                    );
                }
            }
        }
    }

    /// What 16 kHz cannot carry does not come back as something lower.
    #[test]
    fn what_is_too_high_is_left_out() {
        let mut resampler = Resampler::new(48_000);
        let mut power = 0.0;
        let mut count = 0;
        for sample in 0..48_000 {
            resampler.push(tone(9_500.0, 48_000, f64::from(sample)) as f32, |value| {
                if count > 40 {
                    power += value * value;
                }
                count += 1;
            });
        }
        assert!(power / 16_000.0 < 0.5 * 1e-4, "{power}");
    }
}
