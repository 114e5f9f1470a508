//! A mouth laid over the values of a face.

use avatar_speech::{Amounts, Articulator, Means, Mouth, Speech, SpeechMap, Timeline, Viseme};
use pose_anim::ControlTable;
use proptest::prelude::*;

fn table(names: &[&str]) -> ControlTable {
    let text: String =
        names.iter().map(|name| format!("[[control]]\nname = {name:?}\nshape = {name:?}\n")).collect();
    ControlTable::from_toml(&text).unwrap_or_else(|error| panic!("{error}"))
}

fn arkit_names() -> Vec<&'static str> {
    Articulator::ALL
        .into_iter()
        .flat_map(|articulator| articulator.names())
        .copied()
        .chain(["browInnerUp"])
        .collect()
}

fn mouth_of(viseme: Viseme) -> Mouth {
    let mut weights = [0.0; 15];
    weights[viseme.index()] = 1.0;
    Mouth::of_visemes(&weights, 0.5)
}

#[test]
fn what_an_avatar_has_is_used() {
    let visemes: Vec<String> = Viseme::ALL.iter().map(|viseme| format!("viseme_{}", viseme.name())).collect();
    let visemes: Vec<&str> = visemes.iter().map(String::as_str).collect();
    let vrm = ["expression.aa", "expression.ih", "expression.ou", "expression.ee", "expression.oh"];
    for (names, means) in [
        (arkit_names(), Means::ArKit),
        (visemes.clone(), Means::Visemes),
        (vrm.to_vec(), Means::Vrm),
        (vec!["jawOpen", "something"], Means::Jaw),
        (vec!["something"], Means::Nothing),
        ([arkit_names(), visemes].concat(), Means::ArKit),
    ] {
        let controls = table(&names);
        let map = SpeechMap::new(&controls);
        assert_eq!(map.means(), means, "{names:?}");
        let mut values = controls.defaults();
        map.apply(&mouth_of(Viseme::Aa), Amounts::default(), &mut values);
        let moved = values.iter().any(|value| *value > 0.3);
        assert_eq!(moved, means != Means::Nothing, "{names:?}: {values:?}");
        // Lips that are closed leave the mouth of any avatar at rest, but for what presses it together.
        let mut values = controls.defaults();
        map.apply(&mouth_of(Viseme::PP), Amounts::default(), &mut values);
        for (name, value) in names.iter().zip(&values) {
            let is_pressing =
                ["mouthPress", "mouthRoll", "viseme_PP"].iter().any(|part| name.starts_with(part));
            assert!(*value == 0.0 || is_pressing, "{name}: {value}");
        }
    }
    // The default table has degrees: 0.46 of the jaw's 20.
    let controls = ControlTable::default_face();
    let map = SpeechMap::new(&controls);
    let mut values = controls.defaults();
    map.apply(&mouth_of(Viseme::Aa), Amounts::default(), &mut values);
    let jaw = controls.index("jaw.open").unwrap();
    let most = controls.controls()[jaw].max;
    assert!((values[jaw] / most - 0.46).abs() < 1e-5, "{}", values[jaw]);
}

#[test]
fn the_bone_of_the_jaw_comes_before_its_shape_and_few_shapes_before_the_jaw() {
    let means = |names: &[&str]| SpeechMap::new(&table(names)).means();
    let jaw_and = |others: &[&'static str]| [&["jawOpen"], others].concat();
    let arkit = ["mouthFunnel", "mouthPucker", "mouthRollUpper", "tongueOut"];
    assert_eq!(means(&jaw_and(&arkit)), Means::ArKit);
    assert_eq!(means(&jaw_and(&arkit[1..])), Means::Jaw);
    let visemes = ["viseme_sil", "viseme_PP", "viseme_FF", "viseme_aa", "viseme_O", "viseme_U", "viseme_E"];
    assert_eq!(means(&jaw_and(&visemes[1..])), Means::Visemes);
    assert_eq!(means(&jaw_and(&visemes[2..])), Means::Jaw);
    let vrm = ["expression.aa", "expression.ou", "expression.oh"];
    assert_eq!(means(&jaw_and(&vrm)), Means::Vrm);
    assert_eq!(means(&jaw_and(&vrm[1..])), Means::Jaw);
    // Both jaws: the shape stays at rest.
    let text = "[[control]]\nname = \"jawOpen\"\nshape = \"jawOpen\"\n\
        [[control]]\nname = \"jaw.open\"\nshape = \"jaw\"\n";
    let controls = ControlTable::from_toml(text).unwrap();
    let mut values = controls.defaults();
    SpeechMap::new(&controls).apply(&mouth_of(Viseme::Aa), Amounts::default(), &mut values);
    assert_eq!(values[controls.index("jawOpen").unwrap()], 0.0);
    assert!(values[controls.index("jaw.open").unwrap()] > 0.3);
}

/// What an avatar's other mouths and expressions do is held back, too, whatever it speaks with.
#[test]
fn lips_close_over_mouths_and_expressions_that_speech_does_not_use() {
    let mouths = ["expression.aa", "expression.ih", "expression.ou", "expression.ee", "expression.oh"];
    let controls = table(&[&arkit_names()[..], &mouths, &["expression.happy", "expression.blink"]].concat());
    let map = SpeechMap::new(&controls);
    assert_eq!(map.means(), Means::ArKit);
    let mut values = vec![1.0; controls.len()];
    map.apply(&mouth_of(Viseme::PP), Amounts::default(), &mut values);
    let value = |name: &str| values[controls.index(name).unwrap()];
    mouths.iter().for_each(|name| assert_eq!(value(name), 0.0, "{name}"));
    assert!(value("expression.happy") < 0.5);
    assert_eq!(value("expression.blink"), 1.0);
}

#[test]
fn an_amount_of_nothing_changes_nothing() {
    let controls = table(&arkit_names());
    let map = SpeechMap::new(&controls);
    let mut values = vec![0.25; controls.len()];
    map.apply(&mouth_of(Viseme::Aa), Amounts { mouth: 0.0, brows: 0.0 }, &mut values);
    assert!(values.iter().all(|value| (value - 0.25).abs() < 1e-7), "{values:?}");
    // Shorter slices and amounts that are no numbers.
    map.apply(&mouth_of(Viseme::Aa), Amounts { mouth: f32::NAN, brows: 9.0 }, &mut [0.1; 2]);
}

proptest! {
    /// Any expression and any sound stay in range; while lips are closed, what parts them is at rest.
    #[test]
    fn expressions_and_speech_stay_in_range(
        expression in proptest::collection::vec(0.0_f32..=1.0, 22),
        secs in 0.0_f64..1.0,
        amount in 0.0_f32..=1.0,
    ) {
        let names = arkit_names();
        let controls = table(&names);
        let map = SpeechMap::new(&controls);
        let timeline = Timeline::read("_ 90\nm 80\na 120\nf 60\no 90\ns 50\np 70\ni 100\nS 90\nu 120", None).unwrap();
        let speech = Speech::new(&timeline);
        let mouth = speech.at(secs);
        let mut values: Vec<f32> = expression.iter().copied().cycle().take(controls.len()).collect();
        map.apply(&mouth, Amounts { mouth: amount, brows: amount }, &mut values);
        prop_assert!(values.iter().all(|value| (0.0..=1.0).contains(value)));
        if mouth.closed == 1.0 {
            for name in ["jawOpen", "mouthFunnel", "mouthUpperUpLeft", "mouthLowerDownRight", "tongueOut"] {
                let index = controls.index(name).unwrap();
                prop_assert!(values[index].abs() < 1e-6, "{name}: {}", values[index]);
            }
        }
    }
}

#[test]
fn no_frame_allocates() {
    let controls = table(&arkit_names());
    let map = SpeechMap::new(&controls);
    let speech = Speech::new(&Timeline::read("m 80\na 120\nf 60\no 90", None).unwrap());
    let mut values = controls.defaults();
    let used = allocation_counter::measure(|| {
        for frame in 0..100 {
            map.apply(&speech.at(f64::from(frame) / 200.0), Amounts::default(), &mut values);
        }
    });
    assert_eq!(used.count_total, 0);
}

/// Maps between spaces count visemes in the same order.
#[test]
fn visemes_are_those_of_the_space_of_oculus() {
    let names = face_space::Standard::Oculus.space().names().iter().map(|name| name.name.as_str());
    let own: Vec<String> = Viseme::ALL.iter().map(|viseme| format!("viseme_{}", viseme.name())).collect();
    assert!(names.eq(own.iter().map(String::as_str)), "{own:?}");
}
