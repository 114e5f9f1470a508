use crate::exercise::within_memory;
use avatar_hearing::model::Model;
use avatar_hearing::{Frame, Hearing};
use std::sync::OnceLock;

/// A change of the shipped model: where, as three bytes, and the byte that stands there then.
const CHANGE: usize = 4;
/// The rate of the sound that a model listens to, and its samples.
const RATE: u32 = 16_000;
const SAMPLES: usize = 4_000;

/// The file of a model: the input itself, and the shipped model, which is larger than any input, with the changes
/// that the input says, and without its end where the input has some bytes over. What is read listens: its weights
/// are from 0 to 1.
pub fn hearing(data: &[u8]) {
    listen(data, data.len());
    static SHIPPED: OnceLock<Vec<u8>> = OnceLock::new();
    let shipped = || Model::shipped().map(|model| model.to_bytes());
    let mut bytes = SHIPPED.get_or_init(|| shipped().unwrap_or_else(|| panic!("no shipped model"))).clone();
    let (changes, over) = data.as_chunks::<CHANGE>();
    for [a, b, c, value] in changes {
        let place = u32::from_le_bytes([*a, *b, *c, 0]) as usize % bytes.len();
        bytes[place] = *value;
    }
    bytes.truncate(bytes.len() - over.len());
    listen(&bytes, bytes.len());
}

fn listen(bytes: &[u8], input: usize) {
    let Some(model) = within_memory(input, "the reader", || Model::from_bytes(bytes)) else { return };
    // What is written keeps its form; weights are rounded again.
    assert_eq!(model.to_bytes().len(), bytes.len());
    let Ok(mut hearing) = Hearing::with_model(RATE, model) else { panic!("a rate that is heard") };
    // A tone that rises, and then noise.
    let mut state = 1u32;
    let samples: Vec<f32> = (0..SAMPLES)
        .map(|at| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = (state >> 8) as f32 / (1 << 24) as f32 - 0.5;
            if at < SAMPLES / 2 { (at as f32 * at as f32 * 1e-4).sin() * 0.4 } else { noise }
        })
        .collect();
    let heard = |frame: &Frame| {
        let weights = frame.weights;
        assert!(weights.iter().all(|weight| (0.0..=1.0).contains(weight)), "{frame:?}");
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-3, "{frame:?}");
        assert!((0.0..=1.0).contains(&frame.loudness), "{frame:?}");
    };
    hearing.push(&samples, heard);
    hearing.finish(heard);
}
