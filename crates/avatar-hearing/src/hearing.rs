//! Samples in, visemes out.

use crate::{
    features::{FEATURES, Features, HOP, Spectrum, WINDOW},
    model::{AFTER, Between, INPUTS, Model, OUTPUTS},
    resample::{RATE, RATES, Resampler},
};

/// Names of the visemes in the order of [`Frame::weights`], which is that of Oculus Lipsync.
pub const VISEMES: [&str; OUTPUTS] =
    ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou"];

/// How long after its time a frame is told, in seconds: half of the window, the frames that the model hears
/// of what follows, and half of the resampler's kernel at the least rate.
pub const DELAY_SECS: f64 =
    WINDOW as f64 / 2.0 / RATE as f64 + AFTER as f64 * HOP as f64 / RATE as f64 + 12.0 / 8_000.0;

/// Below this power (-62 dB of full scale) nobody speaks.
const SILENCE: f32 = -14.3;

/// Powers, as logarithms, between which loudness goes from 0 to 1: -50 and -8 dB.
const LOUDNESS: [f32; 2] = [-11.5, -1.84];

/// How much of the weights before stays from frame to frame, so that a single frame flickers less.
const KEPT: f32 = 0.3;

/// What can go wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HearingError {
    /// The rate is not one that is heard.
    #[error("sound of {found} samples a second is not heard: take {least} to {most}")]
    Rate {
        /// The rate that was given.
        found: u32,
        /// The least one.
        least: u32,
        /// The greatest one.
        most: u32,
    },
    /// The model that ships with the crate is not one.
    #[error("the model of the crate is not one: src/model.bin is damaged")]
    Model,
}

/// A hundredth of a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// When it was, in seconds since the first sample: the middle of what was heard.
    pub time_secs: f64,
    /// How much of each viseme, from 0 to 1; together 1. In the order of [`VISEMES`].
    pub weights: [f32; OUTPUTS],
    /// How loud, from 0 (-50 dB of full scale) to 1 (-8 dB).
    pub loudness: f32,
}

impl Frame {
    /// The viseme of the most weight, as its place in [`VISEMES`].
    #[must_use]
    pub fn strongest(&self) -> usize {
        (1..OUTPUTS)
            .fold(0, |most, index| if self.weights[index] > self.weights[most] { index } else { most })
    }
}

/// Hears one voice.
#[derive(Clone, Debug)]
pub struct Hearing {
    resampler: Resampler,
    features: Features,
    model: Model,
    between: Between,
    /// Features of the frames that the model hears, the oldest first.
    inputs: Box<[f32; INPUTS]>,
    /// Features of a silent frame.
    silence: [f32; FEATURES],
    /// Powers of the newest frames, the oldest first.
    powers: [f32; AFTER + 1],
    weights: [f32; OUTPUTS],
    /// Frames whose spectrum is there.
    spectra: u64,
    /// Input samples since the beginning.
    taken: u64,
    rate: u32,
}

impl Hearing {
    /// Ears for sound of `sample_rate` samples a second, from 8,000 to 192,000.
    ///
    /// # Errors
    ///
    /// [`HearingError::Rate`] for other rates.
    pub fn new(sample_rate: u32) -> Result<Self, HearingError> {
        let model = Model::shipped().ok_or(HearingError::Model)?;
        Self::with_model(sample_rate, model)
    }

    /// With another model than the shipped one, as the program that trains has it.
    ///
    /// # Errors
    ///
    /// [`HearingError::Rate`] for rates that are not heard.
    pub fn with_model(sample_rate: u32, model: Model) -> Result<Self, HearingError> {
        if !RATES.contains(&sample_rate) {
            return Err(HearingError::Rate { found: sample_rate, least: *RATES.start(), most: *RATES.end() });
        }
        let mut quiet = Features::new();
        let silence = (0..WINDOW).find_map(|_| quiet.push(0.0));
        let mut made = Self {
            resampler: Resampler::new(sample_rate),
            features: Features::new(),
            model,
            between: Between::new(),
            inputs: Box::new([0.0; INPUTS]),
            silence: silence.map_or([0.0; FEATURES], |spectrum| spectrum.features),
            powers: [0.0; AFTER + 1],
            weights: [0.0; OUTPUTS],
            spectra: 0,
            taken: 0,
            rate: sample_rate,
        };
        made.reset();
        Ok(made)
    }

    /// As if nothing had been heard.
    pub fn reset(&mut self) {
        self.resampler.reset();
        self.features.reset();
        for frame in self.inputs.chunks_exact_mut(FEATURES) {
            frame.copy_from_slice(&self.silence);
        }
        self.powers.fill(f32::MIN);
        self.weights = [0.0; OUTPUTS];
        self.weights[0] = 1.0;
        self.spectra = 0;
        self.taken = 0;
    }

    /// Takes samples of one channel, and gives to `heard` every frame that can now be told, in order of time.
    pub fn push(&mut self, samples: &[f32], mut heard: impl FnMut(&Frame)) {
        for sample in samples {
            self.taken += 1;
            let (resampler, features) = (&mut self.resampler, &mut self.features);
            let mut spectrum = None;
            // Two samples at most come of one, and a frame takes a hundred and sixty.
            resampler.push(*sample, |value| spectrum = features.push(value).or(spectrum));
            if let Some(frame) = spectrum.and_then(|spectrum| self.frame(&spectrum)) {
                heard(&frame);
            }
        }
    }

    /// At the end of a sound: gives the frames that still wait for what follows, as if that were silence.
    pub fn finish(&mut self, mut heard: impl FnMut(&Frame)) {
        let end = self.taken as f64 / f64::from(self.rate);
        let silence = [0.0; 64];
        let mut missing = libm::ceil((DELAY_SECS + 0.02) * f64::from(self.rate)) as usize;
        while missing > 0 {
            let count = missing.min(silence.len());
            missing -= count;
            self.push(&silence[..count], |frame| {
                if frame.time_secs <= end {
                    heard(frame);
                }
            });
        }
    }

    fn frame(&mut self, spectrum: &Spectrum) -> Option<Frame> {
        self.inputs.copy_within(FEATURES.., 0);
        let newest = INPUTS - FEATURES;
        self.inputs[newest..].copy_from_slice(&spectrum.features);
        self.powers.copy_within(1.., 0);
        self.powers[AFTER] = spectrum.power;
        self.spectra += 1;
        let index = self.spectra.checked_sub(AFTER as u64 + 1)?;
        let mut weights = [0.0; OUTPUTS];
        let power = self.powers[0];
        if power < SILENCE {
            weights[0] = 1.0;
        } else {
            self.model.name(&self.inputs, &mut self.between, &mut weights);
        }
        for (kept, new) in self.weights.iter_mut().zip(weights) {
            *kept = KEPT * *kept + (1.0 - KEPT) * new;
        }
        let samples = index as f64 * HOP as f64 + WINDOW as f64 / 2.0;
        Some(Frame {
            time_secs: samples / f64::from(RATE),
            weights: self.weights,
            loudness: ((power - LOUDNESS[0]) / (LOUDNESS[1] - LOUDNESS[0])).clamp(0.0, 1.0),
        })
    }
}
