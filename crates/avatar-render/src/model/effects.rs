//! Wrinkles and other colours: what most faces do not show most of the time.

use crate::gpu::program::{Constant, Value};

/// What a program that draws a part has to show. Parts are drawn by programs that show no more: software
/// adapters pay for code that no pixel needs. Where there is nothing to show, all of them draw the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Effects {
    /// Grooves of wrinkles.
    pub(crate) has_grooves: bool,
    /// Skin in another tone than it is painted in, irises in another colour.
    pub(crate) is_recolored: bool,
}

impl Effects {
    /// How many there are.
    pub(crate) const COUNT: usize = 4;
    /// Everything.
    pub(crate) const ALL: Self = Self { has_grooves: true, is_recolored: true };
    /// Colours alone.
    pub(crate) const COLORS: Self = Self { has_grooves: false, is_recolored: true };
    /// Nothing.
    pub(crate) const NONE: Self = Self { has_grooves: false, is_recolored: false };

    /// Its place among all.
    pub(crate) fn place(self) -> usize {
        usize::from(self.has_grooves) + 2 * usize::from(self.is_recolored)
    }

    /// Those of these that `known` has as well.
    pub(crate) fn among(self, known: Self) -> Self {
        Self {
            has_grooves: self.has_grooves && known.has_grooves,
            is_recolored: self.is_recolored && known.is_recolored,
        }
    }

    /// The constants that programs get from it.
    pub(crate) fn choices(self) -> [Constant; 2] {
        [("GROOVES", Value::Flag(self.has_grooves)), ("RECOLORED", Value::Flag(self.is_recolored))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_has_a_place_of_its_own() {
        let grooves = Effects { is_recolored: false, ..Effects::ALL };
        let all = [Effects::NONE, grooves, Effects::COLORS, Effects::ALL];
        assert_eq!(all.map(Effects::place), [0, 1, 2, 3]);
        assert_eq!(all.len(), Effects::COUNT);
        for one in all {
            assert_eq!(one.among(Effects::ALL), one);
            assert_eq!(one.among(Effects::NONE), Effects::NONE);
            assert!(one.among(Effects::COLORS).place() <= one.place());
        }
    }
}
