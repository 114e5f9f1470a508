//! Files that other programs wrote are the tone that these were told to write.

use crate::{Tone, file, tone, tone_in};
use avatar_sound::{Limits, Note, Sound, SoundError, SoundReader, decode};

fn read(name: &str) -> (Sound, Vec<Note>) {
    decode(&file(name), &Limits::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Rate, channels and frames are those that the tone was made with; the last column is what a coding of so
/// many bits can be off by: half a step, and what SoX adds when it rounds (its dither is off at 16 bits or
/// less only with -R and a tone, so one step more). For A-law and µ-law it is half of the largest step of
/// G.711 at this level, 1/64 of full scale.
#[test]
fn files_without_loss_are_the_tone_to_their_last_bits() {
    for (name, channels, frames, off) in [
        ("tone.wav", 1, 480, 2.0 / 32_768.0),
        ("tone8.wav", 1, 160, 2.0 / 128.0),
        ("tone24.wav", 2, 160, 2.0 / 8_388_608.0),
        ("tonef.wav", 1, 160, 1e-6),
        ("tonea.wav", 1, 160, 1.0 / 64.0),
        ("toneu.wav", 1, 160, 1.0 / 64.0),
        ("tone.flac", 1, 480, 2.0 / 32_768.0),
        ("toneflac.ogg", 1, 480, 2.0 / 32_768.0),
    ] {
        let (sound, notes) = read(name);
        assert_eq!(notes, [], "{name}");
        assert_eq!((sound.rate_hz, sound.channels, sound.frames()), (8_000, channels, frames), "{name}");
        for (index, sample) in sound.samples.iter().enumerate() {
            let meant = tone(index / usize::from(channels), 8_000);
            assert!((f64::from(*sample) - meant).abs() <= off, "{name} {index}: {sample} {meant}");
        }
    }
}

/// Coders with loss keep the tone in its place: what they need before it is cut off.
#[test]
fn files_with_loss_are_the_tone_in_its_place() {
    for (name, rate_hz, frames) in [("tone.ogg", 16_000, 960), ("tone.mp3", 8_000, 480)] {
        let (sound, notes) = read(name);
        assert_eq!(notes, [], "{name}");
        assert_eq!((sound.rate_hz, sound.channels, sound.frames()), (rate_hz, 1, frames), "{name}");
        // Not at the ends, which a coder blurs.
        let cut = frames / 6;
        let Tone { share, late } = tone_in(&sound.samples[cut..frames - cut], cut, rate_hz);
        assert!(share > 0.97, "{name}: {share}");
        // A period is 18 or 36 frames: the beginning, which is quiet before the tone, says which one it is.
        assert!(late.abs() < 1.0, "{name}: {late}");
        let loud = sound.samples.iter().position(|sample| sample.abs() > 0.2).unwrap();
        assert!(loud <= rate_hz as usize / 440, "{name}: {loud}");
    }
    // Without a header nobody knows what the coder needed, and the tone is somewhere.
    let (sound, _) = read("bare.mp3");
    assert_eq!((sound.rate_hz, sound.channels), (8_000, 1));
    let window = |first: usize| tone_in(&sound.samples[first..first + 200], first, 8_000).share;
    let best = (0..sound.frames() - 200).map(window).fold(0.0, f64::max);
    assert!(best > 0.97, "{best}");
}

#[test]
fn what_is_not_read_is_named() {
    let told = |bytes: &[u8]| decode(bytes, &Limits::default()).unwrap_err().to_string();
    let expected = "expected a sound as WAV, FLAC, Ogg Vorbis or MP3, found";
    assert_eq!(told(&file("tone.opus")), format!("{expected} Opus, which is not read"));
    assert_eq!(told(b""), format!("{expected} an empty file"));
    assert_eq!(told(b"0.1 PP\n0.2 aa\n"), format!("{expected} a text"));
    let film = [&[0, 0, 0, 24][..], b"ftypisom", &[0; 12]].concat();
    assert_eq!(told(&film), format!("{expected} MP4 (AAC, ALAC or a film), which is not read"));
    let other = told(&[0x89, 0x50, 0x4e, 0x47, 0, 1, 2, 3]);
    assert_eq!(other, format!("{expected} something else, which begins with the bytes 89 50 4e 47"));
}

#[test]
fn a_sound_in_blocks_is_the_whole_sound() {
    for name in ["tone.wav", "tone.flac", "tone.ogg", "tone.mp3"] {
        let bytes = file(name);
        let mut reader = SoundReader::new(&bytes).unwrap();
        let mut samples = Vec::new();
        while let Some(block) = reader.next_block() {
            assert!(!block.is_empty());
            samples.extend_from_slice(block);
        }
        assert_eq!(samples, read(name).0.samples, "{name}");
        assert!(reader.next_block().is_none());
    }
}

#[test]
fn more_than_the_limit_is_an_error_and_the_limit_itself_is_none() {
    let bytes = file("tone.wav");
    assert_eq!(decode(&bytes, &Limits { max_samples: 480 }).unwrap().0.frames(), 480);
    let error = decode(&bytes, &Limits { max_samples: 479 }).unwrap_err();
    assert_eq!(error, SoundError::TooLong { most: 479, secs: 479.0 / 8_000.0 });
    assert!(error.to_string().contains("at most 479 samples"), "{error}");
}
