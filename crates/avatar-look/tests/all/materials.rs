//! `materials.toml`: what is read, and what is said about what cannot be.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use avatar_look::{LookError, Material, Materials};
use avatar_mesh::{FACE_PARTS, PartKind};
use proptest::prelude::*;

fn error(text: &str) -> LookError {
    Materials::from_toml(text).unwrap_err()
}

#[test]
fn nothing_means_the_defaults() {
    for text in ["", "\u{feff}", "# a remark\n", "[skin]\n", "[eyeball.iris]\n", Materials::EXAMPLE] {
        assert_eq!(Materials::from_toml(text), Ok(Materials::default()), "{text}");
    }
    for part in FACE_PARTS {
        assert_eq!(Materials::default().of(part.name, part.kind), Material::of(part.kind));
    }
    assert_eq!(Materials::default().of("hat", PartKind::Skin), Material::of(PartKind::Skin));
}

#[test]
fn the_example_and_the_defaults_have_the_same_keys() {
    let keys = |text: &str| -> Vec<String> {
        let line = |line: &str| line.split(['=', '#']).next().unwrap_or_default().trim().to_owned();
        text.lines().map(line).filter(|key| !key.is_empty()).collect()
    };
    assert_eq!(keys(Materials::EXAMPLE), keys(&Materials::default().to_toml()));
}

#[test]
fn parts_go_over_kinds_go_over_defaults() {
    // The part before its kind: the order in the text does not matter.
    let materials = Materials::from_toml(
        "[left-eyeball]\nwetness = 0\niris.pupil = 0.7\n[eyeball]\nwetness = 0.5\nreflectance = 0.03\n[skin]\nopacity = 0.5\n",
    )
    .expect("sound");
    let (left, right) =
        (materials.of("left-eyeball", PartKind::Eyeball), materials.of("right-eyeball", PartKind::Eyeball));
    assert_eq!((left.wetness, left.reflectance, left.iris.pupil), (0.0, 0.03, 0.7));
    assert_eq!((right.wetness, right.reflectance, right.iris.pupil), (0.5, 0.03, 0.38));
    assert_eq!(materials.of("skin", PartKind::Skin).opacity, 0.5);
    assert_eq!(materials.of("another", PartKind::Eyeball).wetness, 0.5);
    // A part of the right name but another kind is not the one that the file means.
    assert_eq!(materials.of("left-eyeball", PartKind::Surface), Material::of(PartKind::Surface));
}

#[test]
fn errors_name_the_place_and_both_sides() {
    for (text, message) in [
        (
            "[skin]\nreflectance = 1.5\n",
            "line 2, column 15: skin.reflectance: expected a number from 0 to 1, found 1.5",
        ),
        (
            "[eyeball.iris]\nrefractive_index = 0.9\n",
            "line 2, column 20: eyeball.iris.refractive_index: expected a number from 1 to 3, found 0.9",
        ),
        (
            "[teeth]\ncolor = [1, \"red\", 0]\n",
            "line 2, column 13: teeth.color: expected an array of three numbers from 0 to 1, found \"red\"",
        ),
        (
            "[teeth]\ncolor = [1, 1]\n",
            "line 2, column 9: teeth.color: expected an array of three numbers from 0 to 1, found an array of 2",
        ),
        (
            "[teeth]\nwrap = 0.5\n",
            "line 2, column 8: teeth.wrap: expected an array of three numbers from 0 to 1, found 0.5",
        ),
        ("skin = 3\n", "line 1, column 8: skin: expected a table, found 3"),
        (
            "[skin]\nwetness = nan\n",
            "line 2, column 11: skin.wetness: expected a number from 0 to 1, found nan",
        ),
        (
            "[skin]\nthickness = -0.1\n",
            "line 2, column 13: skin.thickness: expected a number from 0 to 1, found -0.1",
        ),
        (
            "[skin]\npore_density = inf\n",
            "line 2, column 16: skin.pore_density: expected a number from 0 to 10000, found inf",
        ),
        (
            "[skin]\nopacity = 1979-05-27\n",
            "line 2, column 11: skin.opacity: expected a number from 0 to 1, found 1979-05-27",
        ),
    ] {
        assert_eq!(error(text).to_string(), message);
    }
}

#[test]
fn errors_suggest_the_name_that_is_meant() {
    let of_key = error("# é\n[lower-jaw]\nroughnes_matte = 0.5\n");
    assert_eq!((of_key.line, of_key.column, of_key.key.as_str()), (3, 1, "lower-jaw.roughnes_matte"));
    assert_eq!(of_key.nearest.as_deref(), Some("roughness_matte"));
    assert!(of_key.to_string().ends_with("found \"roughnes_matte\"; did you mean \"roughness_matte\"?"));
    let of_table = error("[left_eyeball]\nwetness = 0.5\n");
    assert_eq!(of_table.nearest.as_deref(), Some("left-eyeball"));
    assert!(
        of_table.to_string().contains("expected one of the tables skin, teeth, eyeball, cornea, upper-jaw")
    );
    let of_iris = error("[right-eyeball.iris]\npupils = 0.5\n");
    assert_eq!(
        (of_iris.key.as_str(), of_iris.nearest.as_deref()),
        ("right-eyeball.iris.pupils", Some("pupil"))
    );
    // An iris on skin would never be looked at.
    assert_eq!(error("[skin.iris]\npupil = 0.5\n").key, "skin.iris");
    assert_eq!(error("[eyeball]\niris = 3\n").expected, "a table");
}

#[test]
fn what_is_no_toml_is_told_so() {
    for (text, line) in
        [("[skin\n", 1), ("[skin]\n[skin]\n", 2), ("[skin]\nwetness = 1\nwetness = 1\n", 3), ("\0", 1)]
    {
        let error = error(text);
        assert_eq!((error.line, error.expected.as_str()), (line, "valid TOML"), "{error}");
    }
    // Deep nesting and long names are refused, not followed.
    assert_eq!(error(&format!("skin = {}", "[".repeat(100_000))).expected, "valid TOML");
    assert!(error(&format!("{} = 1", "x".repeat(100_000))).to_string().len() < 500);
}

/// A sound file: some keys with values in their range.
fn files() -> impl Strategy<Value = String> {
    let table = prop::sample::select(vec!["skin", "teeth", "cornea", "upper-jaw", "left-cornea"]);
    let keys = prop::sample::subsequence(
        vec![
            "opacity",
            "reflectance",
            "roughness_matte",
            "wetness",
            "back_light",
            "thickness",
            "sharp_share",
        ],
        0..7,
    );
    let eye = ("(right-|left-)?eyeball", 0.0f32..=1.0, 1.0f32..=3.0);
    (table, keys, prop::array::uniform3(0.0f32..=1.0), eye).prop_map(|(table, keys, rgb, (eye, share, index))| {
        let lines: String = keys.iter().map(|key| format!("{key} = {:?}\n", rgb[0])).collect();
        format!(
            "[{table}]\ncolor = {rgb:?}\nscatter = {rgb:?}\n{lines}[{eye}.iris]\npupil = {share:?}\nrefractive_index = {index:?}\n"
        )
    })
}

/// Texts that are close to sound ones.
fn damaged() -> impl Strategy<Value = String> {
    (files(), any::<prop::sample::Index>(), any::<prop::sample::Index>(), "[\\PC\n\\[\\]=.\"']{0,6}")
        .prop_map(|(text, from, to, patch)| {
            let chars: Vec<char> = text.chars().collect();
            let (a, b) = (from.index(chars.len()), to.index(chars.len()));
            let (before, after) = (&chars[..a.min(b)], &chars[a.max(b)..]);
            before.iter().copied().chain(patch.chars()).chain(after.iter().copied()).collect()
        })
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(text in files()) {
        let materials = Materials::from_toml(&text).expect("sound");
        prop_assert_ne!(&materials, &Materials::default());
        prop_assert_eq!(Materials::from_toml(&materials.to_toml()), Ok(materials));
    }

    #[test]
    fn no_text_panics(text in "\\PC{0,200}", damaged in damaged(), bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        for text in [text, damaged, String::from_utf8_lossy(&bytes).into_owned()] {
            if let Err(error) = Materials::from_toml(&text) {
                prop_assert!(error.line >= 1 && error.line <= text.matches('\n').count() + 1);
                prop_assert!(error.column >= 1 && !error.to_string().is_empty());
            }
        }
    }
}
