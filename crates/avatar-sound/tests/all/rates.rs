//! Sounds at other rates.

use crate::{Tone, tone, tone_in};
use avatar_sound::{Sound, SoundError};

fn at(rate_hz: u32, channels: u16) -> Sound {
    let frames = 0..rate_hz as usize / 10;
    let samples = frames.flat_map(|frame| vec![tone(frame, rate_hz) as f32; channels.into()]).collect();
    Sound { rate_hz, channels, samples }
}

/// The sine is the independent source: at every rate it is the same function of the time, to within a frame
/// or so, which is what the resampler rounds its delay to.
#[test]
fn a_tone_is_the_same_tone_in_its_place() {
    for (from, to) in
        [(8_000, 48_000), (44_100, 48_000), (192_000, 96_000), (176_400, 48_000), (22_050, 16_000)]
    {
        for channels in [1_u16, 2] {
            let sound = at(from, channels).resampled(to).unwrap();
            assert_eq!((sound.rate_hz, sound.channels), (to, channels));
            assert!(sound.frames().abs_diff(to as usize / 10) <= 1, "{from} {to}: {}", sound.frames());
            for channel in 0..usize::from(channels) {
                let samples: Vec<f32> =
                    sound.samples.iter().skip(channel).step_by(channels.into()).copied().collect();
                // Not at the ends, where the tone begins and ends suddenly; 22 whole periods.
                let (first, last) = (to as usize / 50, to as usize * 7 / 100);
                let Tone { share, late, .. } = tone_in(&samples[first..last], first, to);
                assert!(share > 0.9999, "{from} {to}: {share}");
                assert!(late.abs() < 1.1, "{from} {to}: {late}");
            }
        }
    }
}

/// A tone of 30 kHz is none at 48 kHz, and must not come back as one of 18 kHz.
#[test]
fn what_is_too_high_is_left_out() {
    let high = |frame: i32| (f64::from(frame) * 30_000.0 / 192_000.0 * std::f64::consts::TAU).sin() as f32;
    let sound = Sound { rate_hz: 192_000, channels: 1, samples: (0..19_200).map(high).collect() };
    let low = sound.resampled(48_000).unwrap();
    let edge = 960;
    let loudest = low.samples[edge..low.frames() - edge].iter().fold(0.0, |most: f32, x| most.max(x.abs()));
    assert!(loudest < 1e-3, "{loudest}");
}

#[test]
fn strange_sounds_have_strange_rates_refused() {
    assert_eq!(at(8_000, 1).resampled(8_000).unwrap(), at(8_000, 1));
    assert_eq!(at(8_000, 1).resampled(10), Err(SoundError::Rate { found: 10 }));
    let short = Sound { rate_hz: 8_000, channels: 2, samples: vec![0.5; 3] };
    assert_eq!(short.resampled(16_000).unwrap().frames(), 2);
    let empty = Sound { rate_hz: 8_000, channels: 2, samples: Vec::new() };
    assert_eq!(empty.resampled(16_000).unwrap().frames(), 0);
}
