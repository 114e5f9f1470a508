//! Which of the default poses a face of ARKit can take that lacks some of the shapes.
#![allow(clippy::panic, reason = "a test may panic")]

use crate::faces::{face, values};
use avatar_pack::{Pack, ShapeSet};

/// What each shape of ARKit costs: the poses that are about it. By the numbers of the default poses, a glance
/// needs the eyes that glance, a closed eye its lid, a smile both corners of the mouth; no pose is about lids
/// that only narrow.
#[test]
fn a_missing_shape_takes_away_only_what_needs_it() {
    let all = ShapeSet::ArKit.names();
    let of_shapes = |pack: &Pack| -> Vec<String> {
        let names = pack.poses().iter().map(|pose| pose.name.clone());
        names.filter(|name| !all.contains(&name.as_str())).collect()
    };
    let whole = face(all).pack;
    let complete = of_shapes(&whole);
    assert_eq!(complete.len(), 18, "{complete:?}");
    for missing in all {
        let without: Vec<&str> = all.iter().copied().filter(|name| name != missing).collect();
        let pack = face(&without).pack;
        let found = of_shapes(&pack);
        let lost: Vec<&str> =
            complete.iter().filter(|pose| !found.contains(pose)).map(String::as_str).collect();
        let expected: &[&str] = match *missing {
            "eyeBlinkLeft" => &["sadness", "wink-left", "sleep", "yawn", "skeptical"],
            "eyeBlinkRight" => &["sadness", "wink-right", "sleep", "yawn"],
            "eyeLookDownLeft" | "eyeLookDownRight" => &["sadness", "look-down"],
            "eyeLookUpLeft" | "eyeLookUpRight" => &["look-up"],
            "eyeLookInLeft" => &["cross-eyed", "look-right", "skeptical"],
            "eyeLookOutRight" => &["look-right", "skeptical"],
            "eyeLookInRight" => &["cross-eyed", "look-left"],
            "eyeLookOutLeft" => &["look-left"],
            "eyeWideLeft" | "eyeWideRight" => &["surprise"],
            "jawLeft" => &["disgust"],
            "jawOpen" => &["laugh", "surprise", "yawn"],
            "mouthFrownLeft" | "mouthFrownRight" => &["frown", "anger", "sadness", "disgust", "skeptical"],
            "mouthSmileLeft" | "mouthSmileRight" => &["smile", "laugh", "wink-left", "wink-right"],
            _ => &[],
        };
        assert_eq!(lost, expected, "without {missing}");
        // What is left is as it was with all shapes, but that half a smile or frown is at rest.
        let is_half = |name: &str| {
            let stem = name.trim_end_matches("Left").trim_end_matches("Right");
            ["mouthSmile", "mouthFrown"].contains(&stem) && missing.starts_with(stem)
        };
        for pose in &found {
            let mut with_all = values(&whole, pose);
            with_all.retain(|(name, _)| name != missing);
            with_all.iter_mut().filter(|(name, _)| is_half(name)).for_each(|(_, value)| *value = 0.0);
            assert_eq!(values(&pack, pose), with_all, "{pose} without {missing}");
        }
    }
}

/// Of several small things, all are no small share.
#[test]
fn what_accompanies_may_be_missing_in_part_only() {
    let lids = ["eyeBlinkLeft", "eyeBlinkRight", "eyeSquintLeft", "eyeSquintRight"];
    let laughs_without = |missing: &[&str]| {
        let names = ShapeSet::ArKit.names().iter().copied();
        let without: Vec<&str> = names.filter(|name| !missing.contains(name)).collect();
        face(&without).pack.poses().get("laugh").is_some()
    };
    // Smile 1, jaw 0.75, upper lids 18 of 45 degrees, lower ones 17 of 25 where 0.6 of the eye is open.
    assert!(laughs_without(&lids[2..]), "2 · 0.41 of 3.37");
    assert!(laughs_without(&lids[..2]), "2 · 0.4 of 3.37");
    assert!(!laughs_without(&lids), "1.62 of 3.37 is nearly half");
}
