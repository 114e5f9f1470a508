//! One sound in many rooms: other voices, other microphones, noise.

use avatar_hearing::{
    features::{FEATURES, Features, HOP, WINDOW},
    resample::{RATE, Resampler},
};

use crate::corpus::Sound;

/// Numbers by chance: SplitMix64 (Steele, Lea, Flood, 2014).
#[derive(Clone, Debug)]
pub(crate) struct Chance(pub(crate) u64);

impl Chance {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut value = self.0;
        value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        value ^ (value >> 31)
    }

    /// From 0 to 1.
    pub(crate) fn part(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1 << 24) as f32
    }

    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.part()
    }
}

/// Frames of a sound as the model takes them, each with its viseme.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frames {
    pub(crate) features: Vec<[f32; FEATURES]>,
    pub(crate) visemes: Vec<Option<usize>>,
}

/// The sound at 16 kHz; `speed` times as fast, and as high, as if a smaller or larger person spoke.
pub(crate) fn at_rate(sound: &Sound, speed: f32) -> Vec<f32> {
    let rate = (sound.rate as f32 * speed) as u32;
    let mut resampler = Resampler::new(rate);
    let mut out = Vec::with_capacity(sound.samples.len() * RATE as usize / rate as usize + 2);
    for sample in &sound.samples {
        resampler.push(*sample, |value| out.push(value));
    }
    for _ in 0..resampler.half() {
        resampler.push(0.0, |value| out.push(value));
    }
    out
}

/// Mean square of where the sound is loud: of its louder half.
pub(crate) fn power(samples: &[f32]) -> f32 {
    let mut powers: Vec<f32> =
        samples.chunks(HOP).map(|part| part.iter().map(|s| s * s).sum::<f32>()).collect();
    powers.sort_by(f32::total_cmp);
    let loud = &powers[powers.len() / 2..];
    loud.iter().sum::<f32>() / (loud.len().max(1) * HOP) as f32
}

/// Adds noise of the power `wanted`; `colour` 0 is white, towards 1 lower.
pub(crate) fn add_noise(samples: &mut [f32], wanted: f32, colour: f32, chance: &mut Chance) {
    let mut low = 0.0;
    let noise: Vec<f32> = samples
        .iter()
        .map(|_| {
            low = colour * low + chance.between(-1.0, 1.0);
            low
        })
        .collect();
    let found = noise.iter().map(|n| n * n).sum::<f32>() / noise.len().max(1) as f32;
    let scale = (wanted / found.max(1e-9)).sqrt();
    for (sample, noise) in samples.iter_mut().zip(noise) {
        *sample += scale * noise;
    }
}

/// A room: echoes that fade.
fn add_room(samples: &mut [f32], chance: &mut Chance) {
    let fade = chance.between(0.02, 0.12);
    let echoes: Vec<(usize, f32)> = (0..14)
        .map(|_| {
            let time = chance.between(0.003, 2.5 * fade);
            let sign = if chance.part() < 0.5 { -1.0 } else { 1.0 };
            ((time * RATE as f32) as usize, sign * 0.4 * (-time / fade).exp())
        })
        .collect();
    let dry = samples.to_vec();
    for (delay, gain) in echoes {
        for index in delay..samples.len() {
            samples[index] += gain * dry[index - delay];
        }
    }
}

/// A microphone: the treble louder or softer, a wide hump somewhere, sometimes nothing above some pitch.
fn change_tone(samples: &mut [f32], chance: &mut Chance) {
    let (tilt, cut) = (chance.between(-0.6, 0.6), chance.part() < 0.15);
    let mut before = 0.0;
    for sample in samples.iter_mut() {
        let now = *sample;
        *sample = now - tilt * before;
        before = now;
    }
    let (angle, radius) = (chance.between(0.05, 2.2), chance.between(0.3, 0.8));
    let (a, b, gain) = (2.0 * radius * angle.cos(), -radius * radius, chance.between(-0.3, 0.6));
    let mut past = [0.0; 2];
    for sample in samples.iter_mut() {
        let hump = (1.0 - radius) * *sample + a * past[0] + b * past[1];
        past = [hump, past[0]];
        *sample += gain * hump;
    }
    if cut {
        let mut slow = [0.0; 3];
        let part = chance.between(0.5, 0.85);
        for sample in samples.iter_mut() {
            let mut value = *sample;
            for state in &mut slow {
                *state += part * (value - *state);
                value = *state;
            }
            *sample = value;
        }
    }
}

/// Chords of plucked and blown tones, with a drum: what is to be heard as nobody speaking.
pub(crate) fn music(samples: usize, chance: &mut Chance) -> Vec<f32> {
    let mut out = vec![0.0; samples];
    let mut begin = 0;
    while begin < samples {
        let length = (chance.between(0.15, 0.7) * RATE as f32) as usize;
        let end = (begin + length).min(samples);
        for _ in 0..2 + chance.next() % 4 {
            let hertz = 65.4 * 2.0_f32.powf((chance.next() % 48) as f32 / 12.0);
            let (decay, bright) = (chance.between(0.0, 8.0), chance.between(0.3, 0.85));
            let gain = chance.between(0.05, 0.2);
            let harmonics = 1 + chance.next() % 12;
            for harmonic in 1..=harmonics {
                let turn = std::f32::consts::TAU * hertz * harmonic as f32 / RATE as f32;
                if turn > 3.0 {
                    break;
                }
                let loud = gain * bright.powi(harmonic as i32);
                for (index, sample) in out[begin..end].iter_mut().enumerate() {
                    let time = index as f32 / RATE as f32;
                    *sample +=
                        loud * (-decay * time).exp() * (turn * index as f32).sin() * (time * 200.0).min(1.0);
                }
            }
        }
        if chance.part() < 0.4 {
            for (index, sample) in out[begin..end].iter_mut().enumerate() {
                *sample += chance.between(-0.3, 0.3) * (-40.0 * index as f32 / RATE as f32).exp();
            }
        }
        begin = end;
    }
    out
}

/// The frames of samples of 16 kHz, without labels.
pub(crate) fn features(samples: &[f32]) -> Vec<[f32; FEATURES]> {
    let mut features = Features::new();
    let clipped = samples.iter().map(|sample| sample.clamp(-1.0, 1.0));
    clipped.filter_map(|sample| features.push(sample)).map(|spectrum| spectrum.features).collect()
}

/// A sound as somebody else's, somewhere else; or, once in a while, music or noise without a voice.
pub(crate) fn frames(sound: &Sound, chance: &mut Chance) -> Frames {
    if chance.part() < 0.025 {
        let samples = 3 * RATE as usize;
        let mut made = if chance.part() < 0.7 { music(samples, chance) } else { vec![0.0; samples] };
        let (noise, colour) = (10.0_f32.powf(chance.between(-7.0, -2.5)), chance.between(0.0, 0.97));
        add_noise(&mut made, noise, colour, chance);
        let features = features(&made);
        return Frames { visemes: vec![Some(0); features.len()], features };
    }
    let speed = chance.between(0.8, 1.25);
    let mut samples = at_rate(sound, speed);
    // Quiet before and behind.
    let before = (chance.between(0.05, 0.5) * RATE as f32) as usize;
    samples.splice(0..0, std::iter::repeat_n(0.0, before));
    samples.extend(std::iter::repeat_n(0.0, 4_000));
    change_tone(&mut samples, chance);
    if chance.part() < 0.35 {
        add_room(&mut samples, chance);
    }
    let wanted = 10.0_f32.powf(chance.between(-3.6, -1.3));
    let gain = (wanted / power(&samples).max(1e-9)).sqrt();
    samples.iter_mut().for_each(|sample| *sample *= gain);
    // Never quite silent; often noisy.
    let ratio = if chance.part() < 0.5 { chance.between(3.0, 25.0) } else { chance.between(30.0, 60.0) };
    let colour = chance.between(0.0, 0.97);
    add_noise(&mut samples, wanted * 10.0_f32.powf(-ratio / 10.0), colour, chance);
    let features = features(&samples);
    let visemes = (0..features.len()).map(|index| {
        let time = (index * HOP + WINDOW / 2) as f64 - before as f64;
        if time < 0.0 { Some(0) } else { sound.viseme(time / f64::from(RATE) * f64::from(speed)) }
    });
    Frames { visemes: visemes.collect(), features }
}
