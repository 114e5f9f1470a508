//! The channels of a frame and the names that senders have for them.

use crate::channel::Kind::{Angle, Weight};
use pose_anim::face;

/// How many channels a frame has.
pub const CHANNELS: usize = 77;

/// A bit for each channel.
pub(crate) const ALL_CHANNELS_MASK: u128 = (1 << CHANNELS) - 1;

/// How many of them, the first ones, are shapes of ARKit.
pub(crate) const SHAPES: usize = 52;

/// Angles of the head and of the eyes, as channels.
pub(crate) const HEAD_TURN: usize = 52;
pub(crate) const HEAD_BOW: usize = 53;
pub(crate) const HEAD_BEND: usize = 54;
pub(crate) const EYE_LEFT_LR: usize = 55;
pub(crate) const EYE_LEFT_UD: usize = 56;
pub(crate) const EYE_RIGHT_LR: usize = 57;
pub(crate) const EYE_RIGHT_UD: usize = 58;
/// Expressions of VRM: from here on, one after the other.
pub(crate) const EXPRESSIONS: usize = 59;

/// One number of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Channel {
    /// Its name, which is also that of the control that it moves: a shape of ARKit, an angle of
    /// [`pose_anim::face`], or an expression of VRM 1.0.
    pub name: &'static str,
    /// Least value.
    pub min: f32,
    /// Greatest value.
    pub max: f32,
    /// The channel that it is in a mirror.
    pub mirrored: usize,
    /// What it is multiplied by there: −1 for angles to a side.
    pub mirror_sign: f32,
}

enum Kind {
    Weight,
    /// Degrees of head or eyes.
    Angle {
        changes_sign: bool,
    },
}

/// Names, and the channel of the other side as a step.
const TABLE: [(&str, isize, Kind); CHANNELS] = [
    ("eyeBlinkLeft", 7, Weight),
    ("eyeLookDownLeft", 7, Weight),
    ("eyeLookInLeft", 7, Weight),
    ("eyeLookOutLeft", 7, Weight),
    ("eyeLookUpLeft", 7, Weight),
    ("eyeSquintLeft", 7, Weight),
    ("eyeWideLeft", 7, Weight),
    ("eyeBlinkRight", -7, Weight),
    ("eyeLookDownRight", -7, Weight),
    ("eyeLookInRight", -7, Weight),
    ("eyeLookOutRight", -7, Weight),
    ("eyeLookUpRight", -7, Weight),
    ("eyeSquintRight", -7, Weight),
    ("eyeWideRight", -7, Weight),
    ("jawForward", 0, Weight),
    ("jawLeft", 1, Weight),
    ("jawRight", -1, Weight),
    ("jawOpen", 0, Weight),
    ("mouthClose", 0, Weight),
    ("mouthFunnel", 0, Weight),
    ("mouthPucker", 0, Weight),
    ("mouthLeft", 1, Weight),
    ("mouthRight", -1, Weight),
    ("mouthSmileLeft", 1, Weight),
    ("mouthSmileRight", -1, Weight),
    ("mouthFrownLeft", 1, Weight),
    ("mouthFrownRight", -1, Weight),
    ("mouthDimpleLeft", 1, Weight),
    ("mouthDimpleRight", -1, Weight),
    ("mouthStretchLeft", 1, Weight),
    ("mouthStretchRight", -1, Weight),
    ("mouthRollLower", 0, Weight),
    ("mouthRollUpper", 0, Weight),
    ("mouthShrugLower", 0, Weight),
    ("mouthShrugUpper", 0, Weight),
    ("mouthPressLeft", 1, Weight),
    ("mouthPressRight", -1, Weight),
    ("mouthLowerDownLeft", 1, Weight),
    ("mouthLowerDownRight", -1, Weight),
    ("mouthUpperUpLeft", 1, Weight),
    ("mouthUpperUpRight", -1, Weight),
    ("browDownLeft", 1, Weight),
    ("browDownRight", -1, Weight),
    ("browInnerUp", 0, Weight),
    ("browOuterUpLeft", 1, Weight),
    ("browOuterUpRight", -1, Weight),
    ("cheekPuff", 0, Weight),
    ("cheekSquintLeft", 1, Weight),
    ("cheekSquintRight", -1, Weight),
    ("noseSneerLeft", 1, Weight),
    ("noseSneerRight", -1, Weight),
    ("tongueOut", 0, Weight),
    (face::HEAD_TURN, 0, Angle { changes_sign: true }),
    (face::HEAD_BOW, 0, Angle { changes_sign: false }),
    (face::HEAD_BEND, 0, Angle { changes_sign: true }),
    (face::EYE_LEFT_LR, 2, Angle { changes_sign: true }),
    (face::EYE_LEFT_UD, 2, Angle { changes_sign: false }),
    (face::EYE_RIGHT_LR, -2, Angle { changes_sign: true }),
    (face::EYE_RIGHT_UD, -2, Angle { changes_sign: false }),
    ("happy", 0, Weight),
    ("angry", 0, Weight),
    ("sad", 0, Weight),
    ("relaxed", 0, Weight),
    ("surprised", 0, Weight),
    ("neutral", 0, Weight),
    ("aa", 0, Weight),
    ("ih", 0, Weight),
    ("ou", 0, Weight),
    ("ee", 0, Weight),
    ("oh", 0, Weight),
    ("blink", 0, Weight),
    ("blinkLeft", 1, Weight),
    ("blinkRight", -1, Weight),
    ("lookUp", 0, Weight),
    ("lookDown", 0, Weight),
    ("lookLeft", 1, Weight),
    ("lookRight", -1, Weight),
];

static ALL: [Channel; CHANNELS] = {
    let none = Channel { name: "", min: 0.0, max: 1.0, mirrored: 0, mirror_sign: 1.0 };
    let mut all = [none; CHANNELS];
    let mut index = 0;
    while index < CHANNELS {
        let (name, step, ref kind) = TABLE[index];
        let mirrored = index.wrapping_add_signed(step);
        all[index] = match kind {
            Weight => Channel { name, mirrored, ..none },
            Angle { changes_sign } => {
                let mirror_sign = if *changes_sign { -1.0 } else { 1.0 };
                Channel { name, min: -180.0, max: 180.0, mirrored, mirror_sign }
            }
        };
        index += 1;
    }
    all
};

/// All channels, in the order of a frame's values: the shapes in the order of Live Link Face, then the head's
/// angles, those of the left and the right eye, and the expressions of VRM.
pub fn channels() -> &'static [Channel; CHANNELS] {
    &ALL
}

/// Other names of some channels: expressions of VRM 0.x, by what VRM 1.0 calls them. `lookup` and the like
/// need no entry: capitals do not count.
const OTHERS: [(&str, usize); 12] = [
    ("joy", EXPRESSIONS),
    ("sorrow", EXPRESSIONS + 2),
    ("fun", EXPRESSIONS + 3),
    ("a", EXPRESSIONS + 6),
    ("i", EXPRESSIONS + 7),
    ("u", EXPRESSIONS + 8),
    ("e", EXPRESSIONS + 9),
    ("o", EXPRESSIONS + 10),
    ("blink_l", EXPRESSIONS + 12),
    ("blink_r", EXPRESSIONS + 13),
    ("blink.l", EXPRESSIONS + 12),
    ("blink.r", EXPRESSIONS + 13),
];

/// Slots of the table that finds a channel by its name; about a sixth of them is taken. (`face_space` would
/// allocate for each name.)
const SLOTS: usize = 512;

/// Where a name begins to be looked for, by its length, its first and its last eight bytes: a packet has
/// dozens of names, and one byte after the other would take longer than all the rest. A letter and its
/// capital have the same place: so have some other names, which comparing tells apart.
const fn slot(name: &[u8]) -> usize {
    const LOWER: u64 = u64::from_le_bytes([0x20; 8]);
    let (first, last) = match (name.first_chunk::<8>(), name.last_chunk::<8>()) {
        (Some(first), Some(last)) => (u64::from_le_bytes(*first), u64::from_le_bytes(*last)),
        _ => {
            let (mut short, mut at) = (0, 0);
            while at < name.len() {
                short = short << 8 | name[at] as u64;
                at += 1;
            }
            (short, 0)
        }
    };
    let both = (first | LOWER) ^ (last | LOWER).rotate_left(29) ^ name.len() as u64;
    // Fibonacci hashing: the highest bits of the product depend on all of the factor's.
    (both.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - SLOTS.ilog2())) as usize
}

/// For each slot the number of a name from 1, 0 for none.
static SLOT_NAMES: [u8; SLOTS] = {
    let mut slots = [0u8; SLOTS];
    let mut number = 0;
    while number < CHANNELS + OTHERS.len() {
        let name = if number < CHANNELS { TABLE[number].0 } else { OTHERS[number - CHANNELS].0 };
        let mut place = slot(name.as_bytes());
        while slots[place] != 0 {
            place = (place + 1) % SLOTS;
        }
        slots[place] = number as u8 + 1;
        number += 1;
    }
    slots
};

/// The channel of a name, in capitals or not: one of [`channels`], or an expression of VRM 0.x.
pub(crate) fn find(name: &[u8]) -> Option<usize> {
    // Longer names are not hashed, whoever sends them.
    if name.len() > 24 {
        return None;
    }
    let mut place = slot(name);
    loop {
        let number = usize::from(*SLOT_NAMES.get(place)?).checked_sub(1)?;
        let (other, channel) = match ALL.get(number) {
            Some(channel) => (channel.name, number),
            None => *OTHERS.get(number - CHANNELS)?,
        };
        // Most senders write names as they stand in the table, and comparing bytes is quicker.
        if other.as_bytes() == name || other.as_bytes().eq_ignore_ascii_case(name) {
            return Some(channel);
        }
        place = (place + 1) % SLOTS;
    }
}

/// The channel of a shape whose side is a letter at its end, such as `eyeBlink_L`.
pub(crate) fn find_sided(name: &[u8]) -> Option<usize> {
    let (stem, side): (&[u8], &[u8]) = match name {
        [stem @ .., b'_', b'L' | b'l'] => (stem, b"Left"),
        [stem @ .., b'_', b'R' | b'r'] => (stem, b"Right"),
        _ => return find(name),
    };
    let mut whole = [0u8; 32];
    whole.get_mut(..stem.len())?.copy_from_slice(stem);
    let len = stem.len() + side.len();
    whole.get_mut(stem.len()..len)?.copy_from_slice(side);
    find(whole.get(..len)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_found_and_mirrors_are_pairs() {
        for (index, channel) in channels().iter().enumerate() {
            assert_eq!(find(channel.name.as_bytes()), Some(index), "{}", channel.name);
            assert_eq!(find(channel.name.to_uppercase().as_bytes()), Some(index), "{}", channel.name);
            let other = channels()[channel.mirrored];
            assert_eq!(other.mirrored, index, "{}", channel.name);
            let swapped = channel.name.replace("Left", "*").replace("Right", "Left").replace('*', "Right");
            let swapped = swapped.replace(".left", ".*").replace(".right", ".left").replace(".*", ".right");
            assert_eq!(swapped, other.name);
        }
        for (name, index) in OTHERS {
            assert_eq!(find(name.as_bytes()), Some(index), "{name}");
        }
        assert_eq!(find_sided(b"mouthSmile_L"), find(b"mouthSmileLeft"));
        assert_eq!(find_sided(b"blink_R"), find(b"blinkRight"));
        assert_eq!(find_sided(b"browInnerUp"), find(b"browInnerUp"));
        for name in
            ["", "_", "_L", "_R", "jawOpe", "jawOpenn", "[aw_pen", "a_very_long_name_that_is_not_there_L"]
        {
            assert_eq!(find_sided(name.as_bytes()), None, "{name:?}");
        }
    }
}
