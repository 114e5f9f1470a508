//! `hair.toml`: what is read, and what is said about what cannot be.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use avatar_groom::{Hair, Style, TomlError};
use proptest::prelude::*;

fn error(text: &str) -> TomlError {
    Hair::from_toml(text).unwrap_err()
}

#[test]
fn nothing_means_the_defaults_and_so_does_the_example() {
    for text in ["", "\u{feff}", "# a remark\n", "[scalp]\n", Hair::EXAMPLE] {
        assert_eq!(Hair::from_toml(text), Ok(Hair::default()), "{text}");
    }
}

#[test]
fn tables_go_over_the_preset_wherever_they_stand() {
    let text = "seed = 0xFF\n[lashes]\nlength = 0.02\n[scalp]\ntip_color = [1, 0, 0.5]\nstrip = 0.1\n[brows]\ndensity = 0\n";
    for (name, style) in Style::PRESETS {
        let hair = Hair::from_toml(&format!("preset = '{name}'\n{text}")).expect("sound");
        let mut expected = style;
        expected.lashes.length = 0.02;
        expected.scalp.tip_color = [1.0, 0.0, 0.5];
        expected.scalp.strip = 0.1;
        expected.brows.density = 0.0;
        assert_eq!(hair, Hair { style: expected, density: 1.0, seed: 255 }, "{name}");
        // Nothing but the preset.
        let hair = Hair::from_toml(&format!("density = 2.5\npreset = \"{name}\"")).expect("sound");
        assert_eq!(hair, Hair { style, density: 2.5, seed: 1 });
        assert_eq!(hair.strands(), 250_000.0);
    }
}

#[test]
fn mistakes_are_told_with_their_place_and_both_sides() {
    for (text, message) in [
        (
            "preset = \"mohwak\"",
            "line 1, column 10: preset: expected one of the presets short, bob, long, curly, mohawk, bald, \
             found \"mohwak\"; did you mean \"mohawk\"?",
        ),
        ("preset = 3", "line 1, column 10: preset: expected the name of a preset, found 3"),
        ("density = 7.5", "line 1, column 11: density: expected a number from 0 to 7, found 7.5"),
        ("density = nan", "line 1, column 11: density: expected a number from 0 to 7, found nan"),
        ("seed = -1", "line 1, column 8: seed: expected a whole number from 0, found -1"),
        ("seed = 1.5", "line 1, column 8: seed: expected a whole number from 0, found 1.5"),
        ("scalp = 1", "line 1, column 9: scalp: expected a table, found 1"),
        (
            "\n[scalp]\nlength = inf",
            "line 3, column 10: scalp.length: expected a number from 0 to 3, found inf",
        ),
        (
            "[brows]\ndensity = -0.5",
            "line 2, column 11: brows.density: expected a number from 0 to 100, found -0.5",
        ),
        (
            "[lashes]\ntip_color = [0, 0, 1.5]",
            "line 2, column 20: lashes.tip_color: expected an array of three numbers from 0 to 1, found 1.5",
        ),
        (
            "[lashes]\ncomb = [0, 0]",
            "line 2, column 8: lashes.comb: expected an array of three numbers from -10 to 10, found an array of 2",
        ),
        (
            "[brow]\nlength = 1",
            "line 1, column 2: brow: expected one of the keys preset, density, seed, scalp, brows, lashes, \
             found \"brow\"; did you mean \"brows\"?",
        ),
    ] {
        assert_eq!(error(text).to_string(), message);
    }
    let unknown = error("[scalp]\n\nlenght = 0.5");
    assert_eq!((unknown.line, unknown.column, unknown.nearest.as_deref()), (3, 1, Some("length")));
    assert!(unknown.expected.starts_with("one of the keys density, length, length_variation,"));
    assert_eq!(error("[scalp\n").expected, "valid TOML");
}

proptest! {
    #[test]
    fn no_text_panics_and_what_is_read_is_finite(
        key in "(density|length|comb|gravity|strip|tip_radius)",
        value in "(-?[0-9]{1,4}(\\.[0-9]{0,3})?(e[0-9]{1,3})?|nan|inf|\\[[-0-9., ]{0,12}\\]|\\PC{0,8})",
        table in "(scalp|brows|lashes|hat)",
    ) {
        if let Ok(hair) = Hair::from_toml(&format!("[{table}]\n{key} = {value}\n")) {
            for style in [hair.style.scalp, hair.style.brows, hair.style.lashes] {
                let numbers = [style.density, style.length, style.gravity, style.strip, style.tip_radius];
                prop_assert!(numbers.iter().chain(&style.comb).all(|number| number.abs() <= 100.0));
            }
        }
    }
}
