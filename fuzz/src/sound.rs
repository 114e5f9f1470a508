use crate::exercise::within_memory;
use avatar_sound::{Limits, decode};

/// Samples that are kept of an input: a small file can have hours of silence in it.
const MAX_SAMPLES: usize = 1 << 20;

/// A sound file of any kind. What is read is from -1 to 1, and the same after it was written as WAV and read
/// again, but for the rounding to 16 bits.
pub fn sound(data: &[u8]) {
    let read = within_memory(data.len(), "the reader", || decode(data, &Limits { max_samples: MAX_SAMPLES }));
    let (sound, notes) = match read {
        Ok(read) => read,
        Err(error) => return drop(error.to_string()),
    };
    notes.iter().for_each(|note| drop(note.to_string()));
    assert!(!sound.samples.is_empty() && sound.samples.len() <= MAX_SAMPLES);
    assert_eq!(sound.samples.len() % usize::from(sound.channels), 0);
    assert!(sound.samples.iter().all(|sample| (-1.0..=1.0).contains(sample)));
    assert_eq!(sound.mono().len(), sound.frames());
    let again = sound.to_wav().map(|wav| decode(&wav, &Limits::default()));
    let Ok(Ok((again, notes))) = again else { panic!("what was written cannot be read: {again:?}") };
    assert!(notes.is_empty(), "{notes:?}");
    assert_eq!((again.rate_hz, again.channels), (sound.rate_hz, sound.channels));
    let off = |(a, b): (&f32, &f32)| (a - b).abs() <= 1.0 / 32_768.0;
    assert_eq!(again.samples.len(), sound.samples.len());
    assert!(again.samples.iter().zip(&sound.samples).all(off));
}
