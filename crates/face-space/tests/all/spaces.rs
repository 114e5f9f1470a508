use face_space::{Side, Space, Standard, plain};
use std::collections::{BTreeMap, BTreeSet};

fn names(standard: Standard) -> Vec<&'static str> {
    standard.space().names().iter().map(|name| name.name.as_str()).collect()
}

#[test]
fn every_text_is_a_space() {
    let mut read: Vec<Space> = Vec::new();
    for standard in Standard::ALL {
        let others: Vec<&Space> = read.iter().collect();
        let space = Space::from_toml(standard.key(), standard.toml(), &others);
        let space = space.unwrap_or_else(|error| panic!("{}: {error}", standard.key()));
        assert_eq!(&space, standard.space().as_ref());
        assert_eq!(Standard::of_key(standard.key()), Some(standard));
        read.push(space);
    }
}

/// The counts are those of the sources that the texts name.
#[test]
fn every_space_has_all_its_names() {
    let counts = Standard::ALL.map(|standard| (standard.key(), standard.space().len()));
    let expected = [
        ("arkit", 52),
        ("live-link", 61),
        ("mediapipe", 52),
        ("vrm1", 18),
        ("vrm0", 17),
        ("oculus", 15),
        ("facs", 71),
        ("metahuman", 251),
        ("makehuman", 34),
        ("makehuman-poses", 59),
        ("controls", 54),
    ];
    assert_eq!(counts, expected);
}

/// One spelling leads to one name, and every name and alias is found.
#[test]
fn aliases_are_unique() {
    for standard in Standard::ALL {
        let space = standard.space();
        let mut seen: BTreeMap<String, &str> = BTreeMap::new();
        for (place, name) in space.names().iter().enumerate() {
            assert_eq!((space.index(&name.name), space.find(&name.name)), (Some(place), Some(place)));
            let aliases: BTreeSet<_> = name.aliases.iter().map(|alias| plain(alias)).collect();
            for spelling in aliases.into_iter().chain([plain(&name.name)]) {
                assert_eq!(space.find(&spelling), Some(place), "{spelling}");
                let other = seen.insert(spelling.clone(), &name.name);
                assert!(other.is_none_or(|other| other == name.name), "{spelling}: {other:?}, {}", name.name);
            }
        }
    }
}

#[test]
fn names_say_what_they_mean_in_a_sentence() {
    for standard in Standard::ALL {
        for name in standard.space().names() {
            assert!(name.means.ends_with('.') && !name.means.contains('*'), "{}: {}", name.name, name.means);
            assert!(name.min <= name.rest && name.rest <= name.max && name.min < name.max, "{}", name.name);
            assert!(!name.name.contains('*'), "{}", name.name);
        }
    }
}

/// A name for the left has one for the right, the mirror image of its sentence.
#[test]
fn sides_come_in_pairs() {
    for standard in Standard::ALL {
        let space = standard.space();
        let of = |side| space.names().iter().filter(move |name| name.side == Some(side));
        assert_eq!(of(Side::Left).count(), of(Side::Right).count(), "{}", standard.key());
        for name in of(Side::Left) {
            let mirrored = |other: &&face_space::Name| {
                other.means
                    == name.means.replace("left", "RIGHT").replace("right", "left").replace("RIGHT", "right")
                    || other.means == name.means.replacen("left", "right", 1)
            };
            assert!(of(Side::Right).any(|other| mirrored(&other)), "{}: {}", standard.key(), name.means);
        }
    }
}

#[test]
fn spellings_do_not_count() {
    let arkit = Standard::ArKit.space();
    let blink = arkit.index("eyeBlinkLeft");
    for spelling in ["EyeBlinkLeft", "eyeBlink_L", "eye-blink-left", "EYE BLINK L", "EyeClosedLeft"] {
        assert_eq!(arkit.find(spelling), blink, "{spelling}");
    }
    assert_eq!(arkit.find("eyeBlink"), None);
    let human = Standard::MetaHuman.space();
    let corner = human.index("CTRL_expressions_mouthCornerPullL");
    for spelling in
        ["CTRL_expressions.mouthCornerPullL", "ctrl_expressions_mouthcornerpulll", "CTRL_L_mouth_cornerPull"]
    {
        assert_eq!(human.find(spelling), corner, "{spelling}");
    }
}

/// As a packet of Live Link Face has them, of which the table that the app writes has the order.
#[test]
fn live_link_has_the_order_of_its_packets() {
    let expected = "EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft EyeWideLeft \
        EyeBlinkRight EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight EyeSquintRight EyeWideRight \
        JawForward JawLeft JawRight JawOpen MouthClose MouthFunnel MouthPucker MouthLeft MouthRight MouthSmileLeft \
        MouthSmileRight MouthFrownLeft MouthFrownRight MouthDimpleLeft MouthDimpleRight MouthStretchLeft \
        MouthStretchRight MouthRollLower MouthRollUpper MouthShrugLower MouthShrugUpper MouthPressLeft MouthPressRight \
        MouthLowerDownLeft MouthLowerDownRight MouthUpperUpLeft MouthUpperUpRight BrowDownLeft BrowDownRight \
        BrowInnerUp BrowOuterUpLeft BrowOuterUpRight CheekPuff CheekSquintLeft CheekSquintRight NoseSneerLeft \
        NoseSneerRight TongueOut HeadYaw HeadPitch HeadRoll LeftEyeYaw LeftEyePitch LeftEyeRoll RightEyeYaw \
        RightEyePitch RightEyeRoll";
    let found: Vec<_> = names(Standard::LiveLink).into_iter().map(str::to_lowercase).collect();
    let expected: Vec<_> = expected.split_whitespace().map(str::to_lowercase).collect();
    assert_eq!(found, expected);
    let space = Standard::LiveLink.space();
    assert_eq!(space.find("JawOpen"), space.index("jawOpen"));
}

/// MediaPipe's list is that of its model's card: ARKit's names in alphabetical order.
#[test]
fn mediapipe_is_arkit_without_the_tongue() {
    let arkit = names(Standard::ArKit).into_iter().filter(|name| *name != "tongueOut");
    let expected: Vec<_> = ["_neutral"].into_iter().chain(arkit).collect();
    assert_eq!(names(Standard::MediaPipe), expected);
    let mut sorted = names(Standard::ArKit);
    sorted.sort();
    assert_eq!(names(Standard::ArKit), sorted);
}

/// MakeHuman's own files, where the reference data is there.
#[test]
fn makehumans_names_are_those_of_its_files() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/makehuman-cc0");
    let Ok(files) = std::fs::read_dir(folder.join("expression-units-caucasian")) else {
        let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!required, "{} is missing", folder.display());
        let _ =
            std::io::Write::write_all(&mut std::io::stderr(), b"SKIPPED: no reference data of MakeHuman\n");
        return;
    };
    let targets: BTreeSet<_> =
        files.map(|file| file.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned()).collect();
    let own: BTreeSet<_> = names(Standard::MakeHuman).into_iter().map(str::to_owned).collect();
    assert_eq!(own, targets);
    let poses = std::fs::read_to_string(folder.join("poseunits/face-poseunits.json")).unwrap();
    let list = poses.split_once('[').unwrap().1.split_once(']').unwrap().0;
    let listed: BTreeSet<_> = list.split('"').skip(1).step_by(2).filter(|name| *name != "Rest").collect();
    assert_eq!(names(Standard::MakeHumanPoses).into_iter().collect::<BTreeSet<_>>(), listed);
}

#[test]
fn mistakes_are_told_with_their_place() {
    let read = |names: &str| {
        let text = format!("title = \"t\"\nsource = \"s\"\nsides = [\"L\", \"R\"]\nnames = [\n{names}]\n");
        Space::from_toml("t", &text, &[]).map(|space| space.len()).map_err(|error| error.to_string())
    };
    assert_eq!(read("{ name = \"a*\", means = \"m\" },\n{ name = \"b\", means = \"m\" }\n"), Ok(3));
    for (names, expected) in [
        ("{ name = \"a\" }\n", "line 5, column 1: names.means: expected a sentence, found none"),
        (
            "{ name = \"a\", means = \"m\", min = 2 }\n",
            "line 5, column 10: names.name: expected min below max",
        ),
        (
            "{ name = \"aR\", means = \"m\" },\n{ name = \"a*\", means = \"m\" }\n",
            "line 6, column 1: names: expected names and aliases that mean one thing each, found \"ar\" for \"aR\" and \"aR\"",
        ),
        ("{ name = \"a\", means = \"m\", sied = \"left\" }\n", "found \"sied\"; did you mean \"side\"?"),
    ] {
        let error = read(names).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
    let like = "title = \"t\"\nsource = \"s\"\nnames = []\nlike = \"arkti\"\n";
    let error = Space::from_toml("t", like, &[Standard::ArKit.space()]).unwrap_err();
    assert_eq!((error.line, error.nearest.as_deref()), (4, Some("arkit")));
}
