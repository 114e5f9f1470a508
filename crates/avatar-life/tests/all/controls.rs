//! Life by the names of an avatar's controls.

use crate::common::shapes;
use crate::face::full;
use avatar_life::{Amounts, Life, Style};
use pose_anim::ControlTable;

/// The most that each control of a face comes to in two minutes.
fn most(controls: &ControlTable) -> Vec<f32> {
    let mut life = Life::new(controls, Style::preset("lively").unwrap(), 8);
    let below = controls.defaults();
    let (mut values, mut most) = (below.clone(), vec![0.0f32; below.len()]);
    for _ in 0..12_000 {
        life.advance(0.01).unwrap();
        life.apply(&below, &mut values).unwrap();
        for (most, (value, rest)) in most.iter_mut().zip(values.iter().zip(&below)) {
            *most = most.max((value - rest).abs());
        }
    }
    most
}

#[test]
fn each_kind_of_avatar_lives() {
    let arkit = [
        "eyeBlinkLeft",
        "eyeBlinkRight",
        "eyeLookInLeft",
        "eyeLookOutLeft",
        "eyeLookUpLeft",
        "eyeLookDownLeft",
        "eyeLookInRight",
        "eyeLookOutRight",
        "eyeLookUpRight",
        "eyeLookDownRight",
        "browInnerUp",
    ];
    let vrm = [
        "expression.blink",
        "expression.lookUp",
        "expression.lookDown",
        "expression.lookLeft",
        "expression.lookRight",
    ];
    for names in [&arkit[..], &vrm[..]] {
        let controls = shapes(names);
        for (name, most) in names.iter().zip(most(&controls)) {
            let least = if name.to_lowercase().contains("blink") { 0.99 } else { 0.03 };
            assert!(most >= least && most <= 1.0, "{name}: {most}");
        }
    }
    let controls = ControlTable::default_face();
    for (control, most) in controls.controls().iter().zip(most(&controls)) {
        let moves = ["head", "eye", "lid"].iter().any(|part| control.name.starts_with(part));
        assert_eq!(most > 0.2, moves, "{}: {most}", control.name);
    }
    // Both expressions that blink would close the lids twice.
    let controls = shapes(&["expression.blink", "expression.blinkLeft", "expression.blinkRight"]);
    assert_eq!(Life::new(&controls, Style::default(), 1).controls().collect::<Vec<_>>(), [0]);
    let nothing = shapes(&["smile"]);
    assert_eq!(most(&nothing), [0.0]);
}

/// A lid closes to its end from wherever the pose has it, and comes back there.
#[test]
fn blinks_close_lids_from_any_pose() {
    let controls = full();
    let lid = controls.index("lid.left.upper").unwrap();
    let still = Amounts { gaze: 0.0, ..Amounts::NONE };
    let style = Style { amounts: Amounts { blinks: 1.0, ..still }, ..Style::default() };
    let mut life = Life::new(&controls, style, 8);
    let (mut is_closed, mut is_open) = (false, false);
    for _ in 0..6000 {
        life.advance(0.01).unwrap();
        is_closed |= life.value(lid, 12.0) > 44.9;
        is_open |= life.value(lid, 12.0) == 12.0;
    }
    assert!(is_closed && is_open);
}

/// Without any amount the pose is what it was, to the last bit.
#[test]
fn amounts_of_nothing_show_nothing() {
    let controls = full();
    let style = Style { amounts: Amounts::NONE, ..Style::default() };
    let mut life = Life::new(&controls, style, 8);
    let below: Vec<f32> =
        controls.controls().iter().map(|control| control.min + 0.37 * (control.max - control.min)).collect();
    let mut values = below.clone();
    for _ in 0..2000 {
        life.advance(0.05).unwrap();
        life.apply(&below, &mut values).unwrap();
        assert_eq!(values, below);
    }
    // And with an amount of each part alone, its controls move and no others.
    let parts: [(&str, Amounts, &[&str]); 6] = [
        ("blinks", Amounts { blinks: 1.0, ..Amounts::NONE }, &["lid", "eye"]),
        ("gaze", Amounts { gaze: 1.0, ..Amounts::NONE }, &["eye", "lid"]),
        ("head", Amounts { head: 1.0, ..Amounts::NONE }, &["head"]),
        ("sway", Amounts { sway: 1.0, ..Amounts::NONE }, &["head"]),
        ("brows", Amounts { brows: 1.0, ..Amounts::NONE }, &["brow"]),
        ("breath", Amounts { breath: 1.0, ..Amounts::NONE }, &["head", "nose"]),
    ];
    for (part, amounts, expected) in parts {
        let mut life = Life::new(&controls, Style { amounts, ..Style::preset("lively").unwrap() }, 8);
        let mut moved = vec![false; controls.len()];
        for _ in 0..4000 {
            life.advance(0.05).unwrap();
            life.apply(&below, &mut values).unwrap();
            moved.iter_mut().zip(values.iter().zip(&below)).for_each(|(moved, (a, b))| *moved |= a != b);
        }
        for (control, moved) in controls.controls().iter().zip(&moved) {
            let may = expected.iter().any(|name| control.name.starts_with(name));
            assert!(may || !moved, "{part} moves {}", control.name);
        }
        for name in expected {
            let mut all = controls.controls().iter().zip(&moved);
            assert!(all.any(|(control, moved)| *moved && control.name.starts_with(name)), "{part}: {name}");
        }
    }
}

/// Where the avatar couples its lids to its eyes, life does not do it a second time.
#[test]
fn lids_follow_the_eyes_once() {
    let plain = ControlTable::default_face();
    let index = |name: &str| plain.index(name).unwrap();
    let coupling =
        pose_anim::Coupling { from: index("eye.left.ud"), to: index("lid.left.upper"), factor: -0.3 };
    let with = ControlTable::with_couplings(plain.controls().to_vec(), vec![coupling]).unwrap();
    let without = ControlTable::new(plain.controls().to_vec()).unwrap();
    let style = Style { amounts: Amounts { gaze: 1.0, ..Amounts::NONE }, ..Style::default() };
    let moved = |controls: &ControlTable| {
        let mut life = Life::new(controls, style, 3);
        life.attend(0, Some(avatar_life::Target::point([0.0, 0.3, 0.8])));
        life.advance(5.0).unwrap();
        (life.value(index("lid.left.upper"), 0.0), life.value(index("lid.right.upper"), 0.0))
    };
    let (left, right) = moved(&with);
    assert!(left == 0.0 && right < -1.0, "{left} {right}");
    let (left, right) = moved(&without);
    assert!(left < -1.0 && left == right, "{left} {right}");
}

/// Shoulders rise by half of their range with a breath, and pupils widen in the dark from 2.908 mm to
/// 6.892 mm (Moon & Spencer 1944), which is that share of 6 mm, the whole range.
#[test]
fn shoulders_and_pupils_move_where_there_are_some() {
    let names = ["breath", "chest.breath", "shoulders.up", "shoulder.left.up", "shoulder.right.up"];
    for (name, most) in names.iter().zip(most(&shapes(&names))) {
        assert!((0.4..0.75).contains(&most), "{name}: {most}");
    }
    let names = ["pupil", "pupils", "pupil.left", "pupil.right", "pupilDilateLeft", "pupilDilateRight"];
    let controls = shapes(&names);
    let mut life = Life::new(&controls, Style::default(), 1);
    life.set_light(0.01);
    life.advance(5.0).unwrap();
    for (control, name) in names.iter().enumerate() {
        // Pupils are never quite still: they go to and fro by 0.15 mm.
        let (found, expected) = (life.value(control, 0.0), (6.892 - 2.908) / 6.0);
        assert!((found - expected).abs() < 0.15 / 6.0 + 1e-3, "{name}: {found} for {expected}");
    }
}
