//! Names of the default face's controls, the ones of [`crate::ControlTable::default_face`].
//!
//! A table may bring any other controls. Code that can do more with a control that it knows, such as turning
//! the eyes to a point, looks it up by these names and copes with its absence.
//!
//! Left and right are the character's own. Signs and ranges are those of the default table.

/// Turns the head, to the character's left.
pub const HEAD_TURN: &str = "head.turn";
/// Nods, down.
pub const HEAD_BOW: &str = "head.bow";
/// Tilts the head, to the character's left shoulder.
pub const HEAD_BEND: &str = "head.bend";
/// Opens the jaw.
pub const JAW_OPEN: &str = "jaw.open";
/// Moves the jaw sideways, to the character's left.
pub const JAW_JUT: &str = "jaw.jut";
/// Turns the left eye up and down; up is positive.
pub const EYE_LEFT_UD: &str = "eye.left.ud";
/// Turns the right eye up and down; up is positive.
pub const EYE_RIGHT_UD: &str = "eye.right.ud";
/// Turns the left eye sideways, to the character's left.
pub const EYE_LEFT_LR: &str = "eye.left.lr";
/// Turns the right eye sideways, to the character's left.
pub const EYE_RIGHT_LR: &str = "eye.right.lr";
/// Closes the left upper lid.
pub const LID_LEFT_UPPER: &str = "lid.left.upper";
/// Closes the right upper lid.
pub const LID_RIGHT_UPPER: &str = "lid.right.upper";
/// Closes the left lower lid.
pub const LID_LEFT_LOWER: &str = "lid.left.lower";
/// Closes the right lower lid.
pub const LID_RIGHT_LOWER: &str = "lid.right.lower";
/// Weight of the smile.
pub const SMILE: &str = "smile";
/// Weight of the frown.
pub const FROWN: &str = "frown";

/// All of them, in the order of the default table.
pub const CONTROLS: [&str; 15] = [
    HEAD_TURN,
    HEAD_BOW,
    HEAD_BEND,
    JAW_OPEN,
    JAW_JUT,
    EYE_LEFT_UD,
    EYE_RIGHT_UD,
    EYE_LEFT_LR,
    EYE_RIGHT_LR,
    LID_LEFT_UPPER,
    LID_RIGHT_UPPER,
    LID_LEFT_LOWER,
    LID_RIGHT_LOWER,
    SMILE,
    FROWN,
];

/// Those that turn the left and the right eye: each up and down, then sideways.
pub const EYES: [[&str; 2]; 2] = [[EYE_LEFT_UD, EYE_LEFT_LR], [EYE_RIGHT_UD, EYE_RIGHT_LR]];

/// Those that turn the face toward a point: sideways, then up and down.
pub const FACING: [&str; 2] = [HEAD_TURN, HEAD_BOW];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ControlTable, DEFAULT_CONTROLS_TOML};

    #[test]
    fn they_are_the_names_of_the_default_table() {
        // Not by `default_face`, which is empty should the text have a mistake.
        let table = ControlTable::from_toml(DEFAULT_CONTROLS_TOML).unwrap();
        assert_eq!(table.names().collect::<Vec<_>>(), CONTROLS);
    }
}
