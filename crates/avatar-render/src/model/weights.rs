//! Weights of blend shapes and wrinkles of an avatar as the deform pass reads them.

use avatar_look::Wrinkle;

/// Weights that one word of bits stands for.
pub(crate) const WORD: usize = u32::BITS as usize;

/// Elements in front of the shapes: how many words of them there are up to the last that is not at rest; then
/// which places are wrinkled, one bit each, and how strongly each is.
pub(crate) const HEAD_ROOM: usize = 2 + Wrinkle::MOST;

/// Elements for each [`WORD`] shapes: which are not at rest, one bit each, and the weights of all.
pub(crate) const WORD_ROOM: usize = 1 + WORD;

const _: () = assert!(Wrinkle::MOST <= WORD);

/// Elements of an avatar with so many shapes.
pub(crate) fn room(shapes: usize) -> usize {
    shapes.div_ceil(WORD).saturating_mul(WORD_ROOM).saturating_add(HEAD_ROOM)
}

/// Writes the weights of an avatar, and what they wrinkle, into their [`room`].
pub(crate) fn write(room: &mut [u32], weights: &[f32], wrinkles: &[Wrinkle]) {
    let Some((head, words)) = room.split_at_mut_checked(HEAD_ROOM) else { return };
    let [used, places @ ..] = head else { return };
    write_word(places, wrinkles.iter().take(Wrinkle::MOST).map(|wrinkle| wrinkle.weight(weights)));
    *used = 0;
    for (number, (word, weights)) in (1..).zip(words.chunks_exact_mut(WORD_ROOM).zip(weights.chunks(WORD))) {
        if write_word(word, weights.iter().copied()) {
            *used = number;
        }
    }
}

/// The bits of those that are not 0, and behind them all. Returns whether there are any.
fn write_word(room: &mut [u32], values: impl Iterator<Item = f32>) -> bool {
    let Some((bits, room)) = room.split_first_mut() else { return false };
    *bits = 0;
    for (bit, (own, value)) in room.iter_mut().zip(values).enumerate() {
        *own = value.to_bits();
        *bits |= u32::from(value != 0.0) << bit;
    }
    *bits != 0
}

/// Whether these weights are written already, bit for bit.
pub(crate) fn are_written(room: &[u32], weights: &[f32]) -> bool {
    let words = room.get(HEAD_ROOM..).unwrap_or_default().chunks_exact(WORD_ROOM);
    words.flat_map(|word| &word[1..]).zip(weights).all(|(own, weight)| *own == weight.to_bits())
}

/// The weight of a shape; 0 where there is none of this number.
pub(crate) fn weight(room: &[u32], shape: usize) -> f32 {
    let at = HEAD_ROOM + shape / WORD * WORD_ROOM + 1 + shape % WORD;
    room.get(at).copied().map_or(0.0, f32::from_bits)
}

/// Whether shapes wrinkle the skin somewhere.
pub(crate) fn are_wrinkling(room: &[u32]) -> bool {
    room.get(1).is_some_and(|places| *places != 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn weights_are_kept_with_a_bit_for_each_that_moves_something() {
        let mut weights = vec![0.0; 70];
        (weights[0], weights[31], weights[32], weights[69]) = (0.5, -1.0, f32::NAN, 1e-30);
        let wrinkle = |shape, gain| Wrinkle { center: Vec3::ZERO, radius: 1.0, shapes: vec![(shape, gain)] };
        let wrinkles = [wrinkle(1, 1.0), wrinkle(0, 0.5), wrinkle(31, 1.0)];
        let mut own = vec![u32::MAX; room(70)];
        write(&mut own, &weights, &wrinkles);
        assert_eq!(own.len(), 18 + 3 * 33);
        assert_eq!(own[..5], [3, 0b010, 0, 0.25f32.to_bits(), 0]);
        assert_eq!([own[18], own[51], own[84]], [1 << 31 | 1, 1, 1 << 5]);
        assert!(are_wrinkling(&own) && are_written(&own, &weights));
        for (shape, expected) in weights.iter().enumerate() {
            assert_eq!(weight(&own, shape).to_bits(), expected.to_bits());
        }
        weights[40] = 1.0;
        assert!(!are_written(&own, &weights));
        assert_eq!(weight(&own, 1000), 0.0);
        weights[32..].fill(0.0);
        write(&mut own, &weights, &wrinkles);
        assert_eq!(own[0], 1);
        write(&mut own, &[0.0; 70], &wrinkles);
        assert_eq!(own[0], 0);
        assert!(!are_wrinkling(&own));
        // Too little room is no reason to stop.
        write(&mut [0; 3], &weights, &wrinkles);
        assert!(!are_wrinkling(&[]));
    }
}
