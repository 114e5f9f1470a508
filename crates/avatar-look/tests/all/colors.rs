//! Colours of people: names, numbers, and what they change.

use avatar_look::{Colors, Material, linear_from_hex};
use avatar_mesh::PartKind;

#[test]
fn hexadecimal_colors_are_srgb() {
    // 128 of 255 is 21.586 % of the light: IEC 61966-2-1.
    let gray = linear_from_hex("#808080").expect("a colour");
    assert!(gray.iter().all(|channel| (channel - 0.215_86).abs() < 1e-5), "{gray:?}");
    assert_eq!(linear_from_hex("#FF00ff"), Some([1.0, 0.0, 1.0]));
    for wrong in ["", "#", "808080", "#80808", "#8080800", "#80808g", "#+80808", "#ééé", "#8080 0"] {
        assert_eq!(linear_from_hex(wrong), None, "{wrong}");
    }
}

#[test]
fn names_are_colors_and_others_are_not() {
    for (name, melanin) in Colors::SKINS {
        assert_eq!(Colors::skin(name), Some(Colors::skin_with(melanin)), "{name}");
    }
    for (name, color) in Colors::IRISES {
        assert_eq!(Colors::iris(name), Some(color), "{name}");
    }
    assert_eq!(Colors::skin("#ffffff"), Some([1.0; 3]));
    for wrong in ["", "Pale", "blue ", "#12"] {
        assert_eq!((Colors::skin(wrong), Colors::iris(wrong)), (None, None), "{wrong}");
    }
}

/// More melanin takes light away, most of it blue, least of it red, as its absorption says.
#[test]
fn melanin_darkens_and_warms() {
    let tones: Vec<[f32; 3]> = (0..=30).map(|k| Colors::skin_with(k as f32 / 10.0)).collect();
    for pair in tones.windows(2) {
        assert!((0..3).all(|k| pair[1][k] < pair[0][k]), "{pair:?}");
    }
    for [red, green, blue] in &tones {
        assert!(red > green && green > blue && *blue > 0.0 && *red < 1.0);
    }
    for (few, many) in [(-1.0, 0.0), (f32::NAN, 0.0), (f32::INFINITY, 3.0), (9.0, 3.0)] {
        assert_eq!(Colors::skin_with(few), Colors::skin_with(many), "{few}");
    }
}

#[test]
fn colors_go_over_their_kind_only() {
    let colors = Colors { skin: Some([0.1, 0.2, 0.3]), iris: Some([0.4, 0.5, 0.6]) };
    for kind in [PartKind::Skin, PartKind::Surface, PartKind::Eyeball, PartKind::Cornea] {
        let before = Material::of(kind);
        let mut expected = before;
        match kind {
            PartKind::Skin => expected.tone.color = [0.1, 0.2, 0.3],
            PartKind::Eyeball => expected.iris.color = [0.4, 0.5, 0.6],
            PartKind::Surface | PartKind::Cornea => {}
        }
        assert_eq!(colors.over(kind, before), expected, "{kind:?}");
        assert_eq!(Colors::default().over(kind, before), before, "{kind:?}");
    }
}
