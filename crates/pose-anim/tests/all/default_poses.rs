//! The poses that come with the crate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{ControlTable, DEFAULT_POSES_TOML, PoseSet};
use std::collections::BTreeSet;

const NAMES: [&str; 16] = [
    "neutral",
    "smile",
    "frown",
    "laugh",
    "surprise",
    "anger",
    "sadness",
    "disgust",
    "wink-left",
    "wink-right",
    "sleep",
    "cross-eyed",
    "look-left",
    "look-up",
    "yawn",
    "skeptical",
];

#[test]
fn the_text_reads_and_every_pose_names_every_control() {
    let table = ControlTable::default_face();
    let set = PoseSet::from_toml(DEFAULT_POSES_TOML, &table).unwrap();
    assert_eq!(PoseSet::default_face(&table), set);
    for name in NAMES {
        assert!(set.get(name).is_some(), "{name}");
    }
    let mut keys = BTreeSet::new();
    for pose in &set {
        let controls: BTreeSet<_> = pose.values.iter().map(|(control, _)| *control).collect();
        assert_eq!(controls, (0..table.len()).collect(), "{}", pose.name);
        let key = pose.key.clone().unwrap();
        assert!(key.len() == 1 && keys.insert(key.clone()), "{key}");
        assert_eq!(set.by_key(&key), Some(pose));
    }
}

#[test]
fn poses_are_what_their_names_say() {
    let table = ControlTable::default_face();
    let set = PoseSet::default_face(&table);
    let value =
        |pose: &str, control: &str| set.get(pose).unwrap().value(table.index(control).unwrap()).unwrap();
    assert!(set.get("neutral").unwrap().values.iter().all(|(_, value)| *value == 0.0));
    for (pose, closed, open) in [("wink-left", "left", "right"), ("wink-right", "right", "left")] {
        assert_eq!(value(pose, &format!("lid.{closed}.upper")), 45.0);
        assert_eq!(value(pose, &format!("lid.{closed}.lower")), 25.0);
        assert!(value(pose, &format!("lid.{open}.upper")) < 10.0);
        assert_eq!(value(pose, "smile"), 0.5);
    }
    assert!(value("sleep", "lid.left.upper") == 45.0 && value("sleep", "head.bow") > 15.0);
    assert!(value("surprise", "jaw.open") > 10.0 && value("surprise", "lid.left.upper") < 0.0);
    assert!(value("look-left", "eye.left.lr") > 20.0 && value("look-left", "head.turn") > 0.0);
    assert!(value("look-up", "eye.right.ud") > 15.0);
    assert!(value("cross-eyed", "eye.left.lr") < 0.0 && value("cross-eyed", "eye.right.lr") > 0.0);
}

#[test]
fn a_face_with_other_controls_gets_what_it_can_show() {
    let text = "[[control]]\nname='smile'\nshape='S'\nmax=0.5\n[[control]]\nname='ears'\nshape='E'";
    let table = ControlTable::from_toml(text).unwrap();
    let set = PoseSet::default_face(&table);
    // What the poses do not know comes to rest: a pose is a whole face.
    assert_eq!(set.get("laugh").unwrap().values, [(0, 0.5), (1, 0.0)]);
    let more = format!(
        "{}\n[[control]]\nname='ears'\nshape='E'\nmin=0.25\ndefault=0.5",
        pose_anim::DEFAULT_CONTROLS_TOML
    );
    let table = ControlTable::from_toml(&more).unwrap();
    let set = PoseSet::default_face(&table);
    assert_eq!(set, PoseSet::from_toml(DEFAULT_POSES_TOML, &table).unwrap());
    assert_eq!(set.get("yawn").unwrap().value(15), Some(0.5));
}

#[test]
fn others_go_on_as_they_are_unless_the_pose_says_so() {
    let table = ControlTable::default_face();
    let read = |others: &str| {
        let text = format!("[[pose]]\nname = 'a'\n{others}\n[pose.controls]\nsmile = 1\n\"jaw.open\" = 3");
        PoseSet::from_toml(&text, &table).unwrap().poses[0].values.clone()
    };
    let [smile, jaw] = ["smile", "jaw.open"].map(|name| table.index(name).unwrap());
    assert_eq!(read(""), [(smile, 1.0), (jaw, 3.0)]);
    let whole = read("others = 'default'");
    assert_eq!(whole[..2], [(smile, 1.0), (jaw, 3.0)]);
    let mut controls: Vec<usize> = whole.iter().map(|(control, _)| *control).collect();
    controls.sort_unstable();
    assert_eq!(controls, (0..15).collect::<Vec<_>>());
    assert!(whole[2..].iter().all(|(_, value)| *value == 0.0));
}
