//! What is written as WAV.

use crate::file;
use avatar_sound::{Limits, Sound, SoundError, decode};
use proptest::prelude::*;

/// The file that SoX wrote of the same samples.
#[test]
fn a_written_wav_is_that_of_another_program() {
    let bytes = file("tone.wav");
    let (sound, _) = decode(&bytes, &Limits::default()).unwrap();
    assert_eq!(sound.to_wav().unwrap(), bytes);
}

#[test]
fn samples_that_are_none_are_cut_off_or_0() {
    let samples = vec![1.0, 2.0, -1.0, -7.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0];
    let wav = Sound { rate_hz: 8_000, channels: 1, samples }.to_wav().unwrap();
    let written: Vec<i16> =
        wav[44..].chunks_exact(2).map(|pair| i16::from_le_bytes(pair.try_into().unwrap())).collect();
    assert_eq!(written, [32_767, 32_767, -32_768, -32_768, 0, 32_767, -32_768, 0]);
}

#[test]
fn no_wav_has_rates_or_channels_that_no_sound_has() {
    let wav = |rate_hz, channels| Sound { rate_hz, channels, samples: vec![0.0; 6] }.to_wav();
    assert_eq!(wav(0, 1), Err(SoundError::Rate { found: 0 }));
    assert_eq!(wav(768_001, 1), Err(SoundError::Rate { found: 768_001 }));
    assert_eq!(wav(8_000, 0), Err(SoundError::Channels { found: 0 }));
    assert_eq!(wav(8_000, 33), Err(SoundError::Channels { found: 33 }));
    // 768,000 Hz in 32 channels of 2 bytes are 49,152,000 bytes a second.
    assert_eq!(wav(768_000, 32).unwrap()[28..32], 49_152_000_u32.to_le_bytes());
    // A last frame that lacks channels is left out.
    assert_eq!(wav(8_000, 4).unwrap().len(), 44 + 8);
}

#[test]
fn one_channel_is_the_mean_of_all() {
    let sound = Sound { rate_hz: 8_000, channels: 2, samples: vec![0.5, 0.25, -1.0, 1.0, 0.75] };
    assert_eq!(*sound.mono(), [0.375, 0.0]);
    assert_eq!((sound.frames(), sound.secs()), (2, 0.00025));
    let one = Sound { rate_hz: 8_000, channels: 1, samples: vec![0.5, 0.25] };
    assert_eq!(*one.mono(), [0.5, 0.25]);
    let none = Sound { rate_hz: 0, channels: 0, samples: vec![0.5] };
    assert_eq!((none.frames(), none.secs(), none.mono().len()), (1, 1.0, 1));
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(
        numbers in proptest::collection::vec(any::<i16>(), 1..300),
        channels in 1_u16..=8,
        rate_hz in 1_000_u32..=768_000,
    ) {
        let whole = numbers.len() / usize::from(channels) * usize::from(channels);
        prop_assume!(whole > 0);
        let samples: Vec<f32> = numbers[..whole].iter().map(|number| f32::from(*number) / 32_768.0).collect();
        let sound = Sound { rate_hz, channels, samples };
        let (read, notes) = decode(&sound.to_wav().unwrap(), &Limits::default()).unwrap();
        prop_assert_eq!(notes, []);
        prop_assert_eq!(read, sound);
    }
}
