//! Tests of the crate from outside.
#![allow(clippy::panic, clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "a test reads files")]

mod files;
mod hostile;
mod rates;
mod wav;

use std::f64::consts::TAU;
use std::path::Path;

/// A sound file of the fuzzers' corpus: tones of 440 Hz and half of full scale that SoX made, and ffmpeg
/// coded (`sox -r 8000 -n tone.wav synth 0.06 sine 440 vol 0.5`; FLAC, libvorbis, libmp3lame, libopus).
fn file(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/sound").join(name);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// That tone.
fn tone(frame: usize, rate_hz: u32) -> f64 {
    0.5 * (TAU * 440.0 * frame as f64 / f64::from(rate_hz)).sin()
}

/// What of a sound is that tone.
struct Tone {
    /// Its share of the sound's power, from 0 to 1.
    share: f64,
    /// How many frames later than it should.
    late: f64,
}

/// The tone in samples, the first of which is this frame of a sound: the sums with its sine and cosine.
fn tone_in(samples: &[f32], first: usize, rate_hz: u32) -> Tone {
    let (mut sine, mut cosine, mut power) = (0.0, 0.0, 0.0);
    for (frame, sample) in samples.iter().enumerate() {
        let angle = TAU * 440.0 * (first + frame) as f64 / f64::from(rate_hz);
        sine += f64::from(*sample) * angle.sin();
        cosine += f64::from(*sample) * angle.cos();
        power += f64::from(*sample).powi(2);
    }
    let share = (sine.powi(2) + cosine.powi(2)) / power / samples.len() as f64 * 2.0;
    Tone { share, late: -cosine.atan2(sine) / TAU * f64::from(rate_hz) / 440.0 }
}
