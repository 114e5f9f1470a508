use face_space::{Map, Route, Standard};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn values(standard: Standard, set: &[(&str, f32)]) -> Vec<f32> {
    let space = standard.space();
    let mut values = space.rest();
    for (name, value) in set {
        values[space.index(name).unwrap_or_else(|| panic!("{name}"))] = *value;
    }
    values
}

/// What is away from rest after a route, by name.
fn mapped(from: Standard, to: Standard, set: &[(&str, f32)]) -> Vec<(String, f32)> {
    let mut found = to.space().rest();
    Route::between(from, to).unwrap().apply(&values(from, set), &mut found);
    let names = to.space().names().iter().zip(found);
    names
        .filter(|(name, value)| *value != name.rest)
        .map(|(name, value)| (name.name.clone(), value))
        .collect()
}

#[test]
fn every_text_is_a_map() {
    let spaces = Standard::ALL.map(|standard| standard.space().clone());
    let texts: Vec<_> = Standard::map_tomls().collect();
    for text in &texts {
        let maps = Map::from_toml(text, &spaces);
        let maps = maps.unwrap_or_else(|error| panic!("{}: {error}", text.lines().next().unwrap()));
        for map in maps {
            let [from, to] = [map.from(), map.to()].map(|space| Standard::of_key(space.key()).unwrap());
            assert_eq!(from.map_to(to).map(|own| own.as_ref()), Some(&map));
        }
    }
    assert_eq!(texts.len(), 11);
}

/// Counted by hand here, not by the reader, which refuses a map otherwise.
#[test]
fn every_name_is_covered_or_listed_as_not_covered() {
    for from in Standard::ALL {
        for to in Standard::ALL {
            let Some(map) = from.map_to(to) else { continue };
            let targets: BTreeSet<_> = map.rules().iter().map(|rule| rule.to).collect();
            let sources: BTreeSet<_> = (map.rules().iter().flat_map(|rule| &rule.terms))
                .flat_map(|term| term.of.iter().chain(&term.less).copied())
                .collect();
            let unused: BTreeSet<_> = map.unused().iter().copied().collect();
            let unset: BTreeSet<_> = map.unset().iter().copied().collect();
            let way = format!("{} to {}", from.key(), to.key());
            assert!(sources.is_disjoint(&unused) && targets.is_disjoint(&unset), "{way}");
            assert_eq!(sources.len() + unused.len(), from.space().len(), "{way}");
            assert_eq!(targets.len() + unset.len(), to.space().len(), "{way}");
        }
    }
}

#[test]
fn there_is_a_way_between_any_two() {
    for from in Standard::ALL {
        for to in Standard::ALL {
            let route = Route::between(from, to).unwrap_or_else(|| panic!("{from:?} to {to:?}"));
            assert_eq!((route.from(), route.to()), (from.space(), to.space()));
            assert_eq!(route.maps().is_empty(), from == to);
        }
    }
    let hops = |from, to| Route::between(from, to).unwrap().maps().len();
    assert_eq!(hops(Standard::ArKit, Standard::Vrm0), 2);
    assert_eq!(hops(Standard::Oculus, Standard::Vrm1), 1, "not by way of ARKit");
}

/// Spaces with the same names, and ARKit's shapes in spaces that have them all.
#[test]
fn what_both_have_comes_back() {
    use Standard::{ArKit, Controls, LiveLink, MakeHumanPoses, MediaPipe, MetaHuman};
    for (name, other, tolerance) in ArKit.space().names().iter().flat_map(|name| {
        [(LiveLink, 0.0), (MediaPipe, 0.0), (MetaHuman, 0.0), (Controls, 1e-6)]
            .map(|(other, t)| (name, other, t))
    }) {
        if (name.name.as_str(), other) == ("tongueOut", MediaPipe) {
            assert_eq!(mapped(ArKit, MediaPipe, &[("tongueOut", 1.0)]), []);
            continue;
        }
        for value in [0.3, 1.0] {
            let face = values(ArKit, &[(&name.name, value)]);
            let (mut there, mut back) = (other.space().rest(), ArKit.space().rest());
            Route::between(ArKit, other).unwrap().apply(&face, &mut there);
            Route::between(other, ArKit).unwrap().apply(&there, &mut back);
            let error = face.iter().zip(&back).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(error <= tolerance, "{} by {other:?}: {error}", name.name);
        }
    }
    // Lips that are moved as a whole are moved by half from one side.
    let found = mapped(ArKit, MakeHumanPoses, &[("mouthUpperUpLeft", 1.0)]);
    assert_eq!(found, [("UpperLipUp".to_owned(), 0.5)]);
}

#[test]
fn sides_stay_on_their_side() {
    use Standard::{ArKit, Controls, Facs, MakeHuman, MakeHumanPoses, MetaHuman, Vrm0, Vrm1};
    for (to, expected) in [
        (Vrm1, "blinkLeft"),
        (Vrm0, "blink_l"),
        (Facs, "AU43L"),
        (MetaHuman, "CTRL_expressions_eyeBlinkL"),
        (MakeHuman, "eye-left-closure"),
        (MakeHumanPoses, "LeftUpperLidClosed"),
    ] {
        assert_eq!(mapped(ArKit, to, &[("eyeBlinkLeft", 1.0)]), [(expected.to_owned(), 1.0)]);
    }
    let lids = [("lid.left.upper".to_owned(), 45.0), ("lid.left.lower".to_owned(), 25.0)];
    assert_eq!(mapped(ArKit, Controls, &[("eyeBlinkLeft", 1.0)]), lids);
    // The left eye looks out, the right one in: both to the left.
    let left = [("eyeLookOutLeft", 1.0), ("eyeLookInRight", 1.0)];
    assert_eq!(mapped(ArKit, Vrm1, &left), [("lookLeft".to_owned(), 1.0)]);
    assert_eq!(mapped(ArKit, Facs, &left), [("AU61".to_owned(), 1.0)]);
    let eyes =
        ["CTRL_expressions_eyeLookLeftL", "CTRL_expressions_eyeLookLeftR"].map(|name| (name.to_owned(), 1.0));
    assert_eq!(mapped(ArKit, MetaHuman, &left), eyes);
    let eyes = ["LeftEyeturnLeft", "RightEyeturnLeft"].map(|name| (name.to_owned(), 1.0));
    assert_eq!(mapped(ArKit, MakeHumanPoses, &left), eyes);
    let eyes = ["eye.left.lr", "eye.right.lr"].map(|name| (name.to_owned(), 30.0));
    assert_eq!(mapped(ArKit, Controls, &left), eyes);
}

/// Sums, products of differences from 1, constants and clamps, computed by hand.
#[test]
fn rules_are_sums_of_products() {
    use Standard::{ArKit, Facs, Vrm1};
    let aa =
        |set: &[(&str, f32)]| mapped(ArKit, Vrm1, set).iter().find(|(name, _)| name == "aa").map(|(_, v)| *v);
    assert_eq!(aa(&[("jawOpen", 0.5)]), Some(1.1 * 0.5));
    assert_eq!(aa(&[("jawOpen", 0.5), ("mouthClose", 0.25)]), Some(1.1 * 0.5 * 0.75));
    assert_eq!(aa(&[("jawOpen", 1.0)]), Some(1.0), "clamped");
    let surprise = [("browInnerUp", 0.5), ("eyeWideLeft", 1.0), ("eyeWideRight", 0.5)];
    assert_eq!(mapped(ArKit, Vrm1, &surprise), [("surprised".to_owned(), 0.5 * 0.5 * 1.0 + 0.5 * 0.5 * 0.5)]);
    let jaw = |value| {
        let found = mapped(ArKit, Facs, &[("jawOpen", value)]);
        ["AU26", "AU27"].map(|name| found.iter().find(|(other, _)| other == name).map_or(0.0, |(_, v)| *v))
    };
    assert_eq!([jaw(0.25), jaw(0.5), jaw(0.75)], [[0.5, 0.0], [1.0, 0.0], [1.0, 0.5]]);
}

/// Surprise opens the mouth, too: a surprised face that speaks opens it once.
#[test]
fn a_mouth_that_two_expressions_open_is_as_open_as_it_was() {
    for (standard, jaw_open) in [Standard::Vrm1, Standard::Vrm0].into_iter().zip([0.3, 0.6]) {
        let face = [("jawOpen", jaw_open), ("browInnerUp", 1.0), ("eyeWideLeft", 1.0), ("eyeWideRight", 1.0)];
        let there = mapped(Standard::ArKit, standard, &face);
        let there: Vec<_> = there.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let back = mapped(standard, Standard::ArKit, &there);
        let back = back.iter().find(|(name, _)| name == "jawOpen").map_or(0.0, |(_, value)| *value);
        assert!((back - jaw_open).abs() < 0.06, "{standard:?}: {back} {jaw_open}");
    }
}

#[test]
fn a_rule_is_told_in_words() {
    let map = Standard::ArKit.map_to(Standard::Vrm1).unwrap();
    let words: Vec<_> = map.rules().iter().map(|rule| map.describe(rule)).collect();
    assert!(words.contains(&"blinkLeft = eyeBlinkLeft".to_owned()), "{words:#?}");
    let ou = "ou = 0.9 mouthPucker × (1 - jawOpen) × (1 - mouthFunnel)";
    assert!(words.contains(&ou.to_owned()), "{words:#?}");
    let map = Standard::ArKit.map_to(Standard::Facs).unwrap();
    assert!(map.rules().iter().any(|rule| map.describe(rule) == "AU27 = -1 + 2 jawOpen"));
}

#[test]
fn mistakes_are_told_with_their_place() {
    let spaces = [Standard::ArKit, Standard::MediaPipe].map(|standard| standard.space().clone());
    let good = "[back]\nsame = true\nunused = [\"_neutral\"]\nunset = [\"tongueOut\"]\n";
    let read = |there: &str| {
        let text = format!("from = \"arkit\"\nto = \"mediapipe\"\n[there]\n{there}{good}");
        Map::from_toml(&text, &spaces).map(|_| ()).map_err(|error| error.to_string())
    };
    let lists = "unused = [\"tongueOut\"]\nunset = [\"_neutral\"]\n";
    assert_eq!(read(&format!("same = true\n{lists}")), Ok(()));
    for (there, expected) in [
        (
            "same = true\nunset = [\"_neutral\"]\n",
            "each name of arkit in a rule or under unused, found \"tongueOut\" in neither",
        ),
        (
            "same = true\nunused = [\"tongueOut\"]\nunset = [\"jawOpen\"]\n",
            "names that no rule has, found \"jawOpen\"",
        ),
        ("same = 1\n", "line 4, column 8: there.same: expected true or false, found 1"),
        ("rules = [{ to = \"jawOpne\" }]\n", "line 4, column 17: there.rules.to: expected one of the names"),
        (
            "rules = [{ to = \"jawOpen\", sum = { jawOpne = 1 } }]\n",
            "found \"jawOpne\"; did you mean \"jawOpen\"?",
        ),
        ("rules = [{ to = \"jawOpen\" }, { to = \"JawOpen\" }]\n", "one rule for each target"),
    ] {
        let error = read(there).unwrap_err();
        assert!(error.contains(expected), "{there}: {error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the numbers, what comes out is within its ranges; the way to the same space changes nothing.
    #[test]
    fn values_stay_in_range(seed in any::<u64>()) {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            match state >> 60 {
                0 => f32::NAN,
                1 => f32::INFINITY,
                2 => -f32::MAX,
                _ => ((state >> 40) as f32 / (1u64 << 24) as f32) * 1.4 - 0.2,
            }
        };
        for from in Standard::ALL {
            let values: Vec<f32> = from.space().names().iter().map(|name| {
                let value = next();
                if value.is_finite() { name.min + value * (name.max - name.min) } else { value }
            }).collect();
            for to in Standard::ALL {
                let mut found = vec![f32::NAN; to.space().len()];
                Route::between(from, to).unwrap().apply(&values, &mut found);
                for (value, name) in found.iter().zip(to.space().names()) {
                    prop_assert!((name.min..=name.max).contains(value), "{from:?} to {to:?}: {} is {value}", name.name);
                }
                if from == to {
                    let clean = values.iter().zip(from.space().names()).map(|(value, name)| name.clean(*value));
                    prop_assert_eq!(found, clean.collect::<Vec<_>>());
                }
            }
        }
    }
}

/// Lists of another length are no mistake: what is missing is at rest, what is too much is left alone.
#[test]
fn short_and_long_lists_are_taken() {
    let mut route = Route::between(Standard::ArKit, Standard::Vrm0).unwrap();
    let mut long = vec![7.0; 20];
    route.apply(&[1.0], &mut long);
    assert_eq!(&long[17..], [7.0; 3]);
    assert_eq!(long[..17].iter().filter(|value| **value != 0.0).count(), 1);
    route.apply(&[1.0; 99], &mut []);
}
