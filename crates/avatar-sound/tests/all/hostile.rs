//! Files that are damaged, that lie, or that nobody should have made.

use crate::file;
use avatar_sound::{Limits, SoundError, SoundReader, decode};
use proptest::prelude::*;

/// A WAV of floats.
fn floats(samples: &[f32], said_bytes: u32) -> Vec<u8> {
    let mut wav = [&b"RIFF"[..], &(said_bytes.saturating_add(36)).to_le_bytes(), b"WAVEfmt "].concat();
    wav.extend(16_u32.to_le_bytes());
    for half in [3_u16, 1] {
        wav.extend(half.to_le_bytes());
    }
    wav.extend(8_000_u32.to_le_bytes());
    wav.extend(32_000_u32.to_le_bytes());
    for half in [4_u16, 32] {
        wav.extend(half.to_le_bytes());
    }
    wav.extend(b"data");
    wav.extend(said_bytes.to_le_bytes());
    wav.extend(samples.iter().flat_map(|sample| sample.to_le_bytes()));
    wav
}

#[test]
fn numbers_that_are_none_are_0_and_noted() {
    let samples = [0.25, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -3.0, 1.5, f32::MIN_POSITIVE];
    let (sound, notes) = decode(&floats(&samples, 32), &Limits::default()).unwrap();
    assert_eq!(sound.samples, [0.25, 0.0, 0.0, 0.0, 1.0, -1.0, 1.0, f32::MIN_POSITIVE]);
    let told: Vec<String> = notes.iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 2, "{told:?}");
    assert_eq!(told[0], "at 0.000 s: 3 samples are no numbers, and are taken for 0");
    assert!(told[1].starts_with("at 0.000 s: samples from here on reach 1"), "{told:?}");
}

/// A file that was cut off keeps what there is of it, and says so; one whose writer did not know its length,
/// as a program does that writes to a pipe, is not cut off.
#[test]
fn lengths_that_lie_are_noted() {
    let samples = [0.25; 8_000];
    let (sound, notes) = decode(&floats(&samples, 64_000), &Limits::default()).unwrap();
    assert_eq!(sound.frames(), 8_000);
    assert_eq!(notes.len(), 1);
    assert_eq!(notes[0].to_string(), "at 1.000 s: the file ends here, of 2.000 s that it says it has");
    for unknown in [u32::MAX, 0x7fff_f000, u32::MAX - 36, 0xffff_f000] {
        let (sound, notes) = decode(&floats(&samples, unknown), &Limits::default()).unwrap();
        assert_eq!((sound.frames(), notes), (8_000, Vec::new()), "{unknown}");
    }
}

/// Cut off anywhere, every file is an error or a beginning of the sound.
#[test]
fn files_may_end_anywhere() {
    for name in ["tone.wav", "tone24.wav", "tone.flac", "toneflac.ogg", "tone.ogg", "tone.mp3", "bare.mp3"] {
        let bytes = file(name);
        let whole = decode(&bytes, &Limits::default()).unwrap().0;
        let mut read = 0;
        for end in 0..bytes.len() {
            match decode(&bytes[..end], &Limits::default()) {
                Ok((sound, _)) => {
                    read += 1;
                    assert!(sound.frames() <= whole.frames() + 1_200, "{name} {end}");
                }
                Err(error) => assert!(error.to_string().contains("expected"), "{name} {end}: {error}"),
            }
        }
        // Short sounds are a single page of Ogg, which is there or is not.
        assert_eq!(read > 0, !name.ends_with(".ogg"), "{name}");
    }
}

#[test]
fn a_file_without_samples_is_none() {
    let error = decode(&floats(&[], 0), &Limits::default()).unwrap_err();
    assert_eq!(error, SoundError::Empty { reason: String::new() });
    assert_eq!(error.to_string(), "expected a sound, found a file without a single sample");
}

/// The sum that ends a FLAC frame (polynomial x^16 + x^15 + x^2 + 1) and its header (x^8 + x^2 + x + 1).
fn sum(bytes: &[u8], bits: u32, polynomial: u32) -> u32 {
    bytes.iter().fold(0, |sum, byte| {
        (0..8).fold(sum ^ (u32::from(*byte) << (bits - 8)), |sum, _| {
            let top = (sum >> (bits - 1)) & 1;
            ((sum << 1) ^ (top * polynomial)) & ((1 << bits) - 1)
        })
    })
}

/// Twelve hours of silence in FLAC are 620 kB: frames of 65,535 equal samples in 15 bytes or so (RFC 9639).
fn long_flac() -> Vec<u8> {
    let mut flac = b"fLaC".to_vec();
    flac.extend([0x80, 0, 0, 34, 0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0, 0, 0]);
    // 48,000 Hz, one channel, 16 bits, a number of samples that is not known, no sum of the samples.
    flac.extend([0x0b, 0xb8, 0x00, 0xf0, 0, 0, 0, 0]);
    flac.extend([0; 16]);
    for number in 0..31_640_u32 {
        let mut frame = vec![0xff, 0xf8, 0x7a, 0x08];
        // The number as in UTF-8.
        match number {
            0..0x80 => frame.push(number as u8),
            0x80..0x800 => frame.extend([0xc0 | (number >> 6) as u8, 0x80 | (number & 63) as u8]),
            _ => frame.extend([
                0xe0 | (number >> 12) as u8,
                0x80 | ((number >> 6) & 63) as u8,
                0x80 | (number & 63) as u8,
            ]),
        }
        frame.extend([0xff, 0xfe]);
        frame.push(sum(&frame, 8, 0x07) as u8);
        // One subframe: a constant, 0.
        frame.extend([0, 0, 0]);
        frame.extend((sum(&frame, 16, 0x8005) as u16).to_be_bytes());
        flac.extend(frame);
    }
    flac
}

#[test]
fn twelve_hours_in_a_small_file_take_no_gigabytes() {
    let flac = long_flac();
    assert!(flac.len() < 700_000, "{}", flac.len());
    let mut error = None;
    let limits = Limits { max_samples: 1 << 22 };
    let taken = allocation_counter::measure(|| error = decode(&flac, &limits).err()).bytes_max;
    assert!(matches!(error, Some(SoundError::TooLong { .. })), "{error:?}");
    // The samples, once more while their vector grows, and the decoder.
    assert!(taken < 3 * (4 << 22), "{taken}");

    let mut frames = 0;
    let taken = allocation_counter::measure(|| {
        let mut reader = SoundReader::new(&flac).unwrap();
        while let Some(block) = reader.next_block() {
            frames += block.len();
        }
    });
    assert_eq!(frames, 31_640 * 65_535);
    assert!(frames as f64 / 48_000.0 > 11.9 * 3_600.0);
    assert!(taken.bytes_max < 8 << 20, "{}", taken.bytes_max);
}

proptest! {
    /// Any damage in a file, and no file at all.
    #[test]
    fn no_bytes_make_it_panic(
        name in prop_oneof![
            Just("tone.wav"), Just("tonef.wav"), Just("tonea.wav"), Just("tone.flac"), Just("toneflac.ogg"),
            Just("tone.ogg"), Just("tone.mp3"), Just("bare.mp3"), Just("tone.opus"),
        ],
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..12),
        noise in proptest::collection::vec(any::<u8>(), 0..100),
    ) {
        let mut bytes = file(name);
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        for bytes in [bytes, noise] {
            if let Ok((sound, _)) = decode(&bytes, &Limits { max_samples: 1 << 20 }) {
                prop_assert!(sound.samples.iter().all(|sample| (-1.0..=1.0).contains(sample)));
                prop_assert_eq!(sound.samples.len() % usize::from(sound.channels), 0);
            }
        }
    }
}
