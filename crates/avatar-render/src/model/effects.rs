//! Wrinkles, other colours, another tone mapping: what most faces do not show most of the time.

use crate::gpu::program::{Constant, Value};

/// Whether a program can tone map by AgX.
pub(crate) const AGX: &str = "AGX";

/// What a program that draws a part has to show. Parts are drawn by programs that show no more: software
/// adapters pay for code that no pixel needs. Where there is nothing to show, all of them draw the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Effects {
    /// Grooves of wrinkles.
    pub(crate) has_grooves: bool,
    /// Skin in another tone than it is painted in, irises in another colour.
    pub(crate) is_recolored: bool,
    /// Tone mapping by AgX, whose curve costs about as much as a lamp.
    pub(crate) has_agx: bool,
}

impl Effects {
    /// How many there are.
    pub(crate) const COUNT: usize = 8;
    /// Everything.
    pub(crate) const ALL: Self = Self { has_agx: true, ..Self::LOOKS };
    /// All that concerns the light that a surface sends, before it becomes a colour of the target.
    pub(crate) const LOOKS: Self = Self { has_grooves: true, is_recolored: true, has_agx: false };
    /// Colours alone, in any tone.
    pub(crate) const COLORS: Self = Self { has_grooves: false, ..Self::ALL };
    /// Tones alone.
    pub(crate) const TONES: Self = Self { is_recolored: false, ..Self::COLORS };
    /// Nothing.
    pub(crate) const NONE: Self = Self { has_grooves: false, is_recolored: false, has_agx: false };

    /// Its place among all.
    pub(crate) fn place(self) -> usize {
        usize::from(self.has_grooves) + 2 * usize::from(self.is_recolored) + 4 * usize::from(self.has_agx)
    }

    /// Those of these that `known` has as well.
    pub(crate) fn among(self, known: Self) -> Self {
        Self {
            has_grooves: self.has_grooves && known.has_grooves,
            is_recolored: self.is_recolored && known.is_recolored,
            has_agx: self.has_agx && known.has_agx,
        }
    }

    /// The constants that programs get from it.
    pub(crate) fn choices(self) -> [Constant; 3] {
        [
            ("GROOVES", Value::Flag(self.has_grooves)),
            ("RECOLORED", Value::Flag(self.is_recolored)),
            (AGX, Value::Flag(self.has_agx)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_has_a_place_of_its_own() {
        let grooves = Effects { is_recolored: false, ..Effects::LOOKS };
        let colors = Effects { has_grooves: false, ..Effects::LOOKS };
        let dull = [Effects::NONE, grooves, colors, Effects::LOOKS];
        let all: Vec<Effects> = [false, true]
            .into_iter()
            .flat_map(|has_agx| dull.map(|one| Effects { has_agx, ..one }))
            .collect();
        assert!(all.iter().map(|one| one.place()).eq(0..Effects::COUNT));
        assert_eq!([all[4], all[6], all[7]], [Effects::TONES, Effects::COLORS, Effects::ALL]);
        for one in all {
            assert_eq!(one.among(Effects::ALL), one);
            assert_eq!(one.among(Effects::NONE), Effects::NONE);
            assert!(one.among(Effects::COLORS).place() <= one.place());
        }
    }
}
