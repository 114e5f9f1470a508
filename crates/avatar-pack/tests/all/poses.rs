//! Which of the default poses a face of ARKit can take that lacks some of the shapes.
#![allow(clippy::panic, reason = "a test may panic")]

use crate::faces::{face, values};
use avatar_pack::{Pack, ShapeSet};
use pose_anim::DEFAULT_POSES_TOML;

/// Whether a default pose names a shape of ARKit under `shapes`.
fn names_shape(pose: &str, shape: &str) -> bool {
    let name = format!("name = \"{pose}\"");
    let said = DEFAULT_POSES_TOML.split("[[pose]]").find(|said| said.contains(&name));
    said.unwrap_or_else(|| panic!("a default pose {pose}")).contains(&format!("\n{shape} ="))
}

/// Shapes by which what the nine-joint face does is shown.
fn is_of_plain_poses(shape: &str) -> bool {
    let stems = [
        "eyeBlink",
        "eyeLook",
        "jawOpen",
        "jawLeft",
        "jawRight",
        "mouthSmile",
        "mouthFrown",
        "eyeSquint",
        "eyeWide",
    ];
    stems.iter().any(|stem| shape.starts_with(stem))
}

/// What each shape of ARKit costs: the poses that are about it. By the numbers of the default poses, a glance
/// needs the eyes that glance, a closed eye its lid, a smile both corners of the mouth; no pose is about lids
/// that only narrow. A kiss, puffed cheeks and a tongue need all that they say. All other poses fall back to
/// what the nine-joint face shows.
#[test]
fn a_missing_shape_takes_away_only_what_needs_it() {
    let all = ShapeSet::ArKit.names();
    let of_shapes = |pack: &Pack| -> Vec<String> {
        let names = pack.poses().iter().map(|pose| pose.name.clone());
        names.filter(|name| !all.contains(&name.as_str())).collect()
    };
    let whole = face(all).pack;
    let complete = of_shapes(&whole);
    assert_eq!(complete.len(), 27, "{complete:?}");
    for missing in all {
        let without: Vec<&str> = all.iter().copied().filter(|name| name != missing).collect();
        let pack = face(&without).pack;
        let found = of_shapes(&pack);
        let lost: Vec<&str> =
            complete.iter().filter(|pose| !found.contains(pose)).map(String::as_str).collect();
        let expected: &[&str] = match *missing {
            "browInnerUp" | "mouthFunnel" | "mouthPucker" => &["kiss", "blow"],
            "browOuterUpLeft" | "browOuterUpRight" => &["kiss", "blow", "tongue-out"],
            "cheekPuff" => &["blow"],
            "cheekSquintLeft" | "cheekSquintRight" | "eyeSquintLeft" | "eyeSquintRight" => &["tongue-out"],
            "mouthLowerDownLeft" | "mouthLowerDownRight" => &["tongue-out"],
            "noseSneerLeft" | "noseSneerRight" | "tongueOut" => &["tongue-out"],
            "jawForward" | "mouthPressLeft" | "mouthPressRight" => &["kiss"],
            "eyeBlinkLeft" => &["wink-left", "sleep", "yawn", "joy", "kiss"],
            "eyeBlinkRight" => &["wink-right", "sleep", "yawn", "joy", "kiss"],
            "eyeLookDownLeft" | "eyeLookDownRight" => &["look-down"],
            "eyeLookUpLeft" | "eyeLookUpRight" => &["look-up", "thinking"],
            "eyeLookInLeft" => &["cross-eyed", "look-right", "thinking"],
            "eyeLookOutRight" => &["look-right", "thinking"],
            "eyeLookInRight" => &["cross-eyed", "look-left"],
            "eyeLookOutLeft" => &["look-left"],
            "eyeWideLeft" | "eyeWideRight" => &["surprise", "fear", "blow"],
            "jawOpen" => &["laugh", "surprise", "yawn", "oh"],
            "mouthFrownLeft" | "mouthFrownRight" => {
                &["frown", "anger", "sadness", "disgust", "skeptical", "fear"]
            }
            "mouthSmileLeft" => {
                &["smile", "laugh", "wink-left", "wink-right", "contempt", "joy", "tongue-out"]
            }
            "mouthSmileRight" => &["smile", "laugh", "wink-left", "wink-right", "joy", "tongue-out"],
            _ => &[],
        };
        assert_eq!(lost, expected, "without {missing}");
        for pose in &found {
            let (with_all, values) = (values(&whole, pose), values(&pack, pose));
            if !names_shape(pose, missing) {
                // What is left is as it was with all shapes.
                let left: Vec<_> = with_all.into_iter().filter(|(name, _)| name != missing).collect();
                assert_eq!(values, left, "{pose} without {missing}");
            } else {
                let further = values.iter().find(|(name, value)| *value != 0.0 && !is_of_plain_poses(name));
                assert_eq!(further, None, "{pose} without {missing}");
            }
        }
    }
}

/// Of several small things, all are no small share.
#[test]
fn what_accompanies_may_be_missing_in_part_only() {
    let lids = ["eyeBlinkLeft", "eyeBlinkRight", "eyeSquintLeft", "eyeSquintRight"];
    // One of the shapes that a laugh has beside the nine-joint face's is away, too: what follows is about
    // that.
    let laughs_without = |missing: &[&str]| {
        let names = ShapeSet::ArKit.names().iter().copied().filter(|name| *name != "browInnerUp");
        let without: Vec<&str> = names.filter(|name| !missing.contains(name)).collect();
        face(&without).pack.poses().get("laugh").is_some()
    };
    // Smile 1, jaw 0.75, upper lids 18 of 45 degrees, lower ones 17 of 25 where 0.6 of the eye is open.
    assert!(laughs_without(&lids[2..]), "2 · 0.41 of 3.37");
    assert!(laughs_without(&lids[..2]), "2 · 0.4 of 3.37");
    assert!(!laughs_without(&lids), "1.62 of 3.37 is nearly half");
}
