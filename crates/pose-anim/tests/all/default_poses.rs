//! The poses that come with the crate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{Control, ControlTable, DEFAULT_POSES_TOML, Drive, Pace, Pose, PoseSet};
use std::collections::BTreeSet;

const NAMES: [&str; 27] = [
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
    "look-right",
    "look-up",
    "look-down",
    "yawn",
    "skeptical",
    "thinking",
    "doubt",
    "contempt",
    "fear",
    "joy",
    "kiss",
    "blow",
    "tongue-out",
    "oh",
];

/// Those that are nothing without further shapes.
const OF_SHAPES: [&str; 3] = ["kiss", "blow", "tongue-out"];

/// The nine-joint face, and behind its controls one for every shape that the poses know.
fn face_with_shapes() -> ControlTable {
    let stems = [
        "browDown",
        "browOuterUp",
        "cheekSquint",
        "eyeSquint",
        "eyeWide",
        "mouthDimple",
        "mouthFrown",
        "mouthLowerDown",
        "mouthPress",
        "mouthSmile",
        "mouthStretch",
        "mouthUpperUp",
        "noseSneer",
    ];
    let sides = stems.iter().flat_map(|stem| ["Left", "Right"].map(|side| format!("{stem}{side}")));
    let single = [
        "browInnerUp",
        "cheekPuff",
        "jawForward",
        "mouthFunnel",
        "mouthLeft",
        "mouthPucker",
        "mouthRight",
        "mouthRollUpper",
        "mouthShrugLower",
        "mouthShrugUpper",
        "tongueOut",
    ];
    let shapes = sides.chain(single.map(str::to_owned)).map(|name| {
        let drives = Drive::Shape { shape: name.clone() };
        let pace = Pace::named(&name, &drives);
        Control { name, drives, min: 0.0, max: 1.0, default: 0.0, pace, group: None }
    });
    let nine_joints = ControlTable::default_face();
    ControlTable::new(nine_joints.controls().iter().cloned().chain(shapes).collect()).unwrap()
}

fn names(set: &PoseSet) -> Vec<&str> {
    set.iter().map(|pose| pose.name.as_str()).collect()
}

#[test]
fn the_text_reads_and_every_pose_names_every_control() {
    let nine_joints: Vec<&str> = NAMES.into_iter().filter(|name| !OF_SHAPES.contains(name)).collect();
    for (table, expected) in
        [(ControlTable::default_face(), &nine_joints[..]), (face_with_shapes(), &NAMES[..])]
    {
        let set = PoseSet::from_toml(DEFAULT_POSES_TOML, &table).unwrap();
        assert_eq!(
            PoseSet::default_face(&table),
            set,
            "also that no pose has duration, transition or timing"
        );
        assert_eq!(names(&set), expected);
        let mut keys = BTreeSet::new();
        for pose in &set {
            let controls: BTreeSet<_> = pose.values.iter().map(|(control, _)| *control).collect();
            assert_eq!(controls, (0..table.len()).collect(), "{}", pose.name);
            assert_eq!(controls.len(), pose.values.len(), "{} says a control twice", pose.name);
            let key = pose.key.clone().unwrap();
            assert!(key.len() == 1 && keys.insert(key.clone()), "{key}");
            assert_eq!(set.by_key(&key), Some(pose));
        }
    }
}

#[test]
fn poses_are_what_their_names_say() {
    let plain = ControlTable::default_face();
    for table in [&plain, &face_with_shapes()] {
        let set = PoseSet::default_face(table);
        let value =
            |pose: &str, control: &str| set.get(pose).unwrap().value(table.index(control).unwrap()).unwrap();
        assert!(set.get("neutral").unwrap().values.iter().all(|(_, value)| *value == 0.0));
        for (pose, closed, open) in [("wink-left", "left", "right"), ("wink-right", "right", "left")] {
            assert_eq!(value(pose, &format!("lid.{closed}.upper")), 45.0);
            assert_eq!(value(pose, &format!("lid.{closed}.lower")), 25.0);
            assert!(value(pose, &format!("lid.{open}.upper")) < 10.0);
        }
        for pose in ["sleep", "joy"] {
            assert!(value(pose, "lid.left.upper") == 45.0 && value(pose, "lid.right.upper") == 45.0);
        }
        assert!(value("sleep", "head.bow") > 10.0);
        assert!(value("surprise", "jaw.open") > 10.0 && value("surprise", "lid.left.upper") < 0.0);
        assert!(value("look-left", "eye.left.lr") > 20.0 && value("look-left", "head.turn") > 0.0);
        assert!(value("look-up", "eye.right.ud") > 15.0 && value("thinking", "eye.right.ud") > 10.0);
        assert!(value("cross-eyed", "eye.left.lr") < 0.0 && value("cross-eyed", "eye.right.lr") > 0.0);
    }
    let set = PoseSet::default_face(&plain);
    let smile = plain.index("smile").unwrap();
    assert_eq!(set.get("wink-left").unwrap().value(smile), Some(0.5));
}

/// The muscles of emotions as Ekman and Friesen's EMFACS lists them (1983), in the shapes that show them:
/// inner brow AU 1, outer brow 2, brows down 4, upper lid 5, cheek 6, nose 9, upper lip 10, corners up 12,
/// dimple 14, corners down 15, lips stretched 20.
#[test]
fn emotions_move_the_muscles_that_show_them() {
    let table = face_with_shapes();
    let set = PoseSet::default_face(&table);
    let value =
        |pose: &str, control: &str| set.get(pose).unwrap().value(table.index(control).unwrap()).unwrap();
    for (pose, shapes) in [
        ("smile", &["cheekSquintLeft", "mouthSmileLeft"][..]),
        ("laugh", &["cheekSquintLeft", "mouthSmileLeft"]),
        ("joy", &["cheekSquintLeft", "mouthSmileLeft"]),
        ("sadness", &["browInnerUp", "mouthFrownLeft"]),
        ("surprise", &["browInnerUp", "browOuterUpLeft", "eyeWideLeft"]),
        ("fear", &["browInnerUp", "browDownLeft", "eyeWideLeft", "mouthStretchLeft"]),
        ("anger", &["browDownLeft", "eyeWideLeft"]),
        ("disgust", &["noseSneerLeft", "mouthUpperUpLeft"]),
    ] {
        for shape in shapes {
            assert!(value(pose, shape) >= 0.5, "{pose}: {shape}");
        }
    }
    // Of one side alone.
    assert!(value("contempt", "mouthDimpleLeft") >= 0.5 && value("contempt", "mouthDimpleRight") == 0.0);
    for (pose, shape) in [("kiss", "mouthPucker"), ("blow", "cheekPuff"), ("tongue-out", "tongueOut")] {
        assert!(value(pose, shape) >= 0.5, "{pose}");
    }
}

/// What `pose` says for the other side of the face.
fn mirrored(pose: &Pose, table: &ControlTable) -> Vec<(usize, f32)> {
    let other = |name: &str| match name {
        "head.turn" | "head.bend" | "jaw.jut" => (name.to_owned(), -1.0),
        _ => {
            let sign = if name.ends_with(".lr") { -1.0 } else { 1.0 };
            let swapped =
                [(".left.", ".right."), (".right.", ".left."), ("Left", "Right"), ("Right", "Left")];
            let swap = swapped.into_iter().find(|(from, _)| name.contains(from));
            (swap.map_or_else(|| name.to_owned(), |(from, to)| name.replace(from, to)), sign)
        }
    };
    let values = pose.values.iter().map(|(index, value)| {
        let (name, sign) = other(&table.controls()[*index].name);
        (table.index(&name).unwrap(), sign * value)
    });
    let mut values: Vec<(usize, f32)> = values.collect();
    values.sort_by_key(|(index, _)| *index);
    values
}

#[test]
fn both_sides_do_the_same() {
    let table = face_with_shapes();
    let set = PoseSet::default_face(&table);
    let sorted = |pose: &Pose| {
        let mut values = pose.values.clone();
        values.sort_by_key(|(index, _)| *index);
        values
    };
    for (one, other) in [("wink-left", "wink-right"), ("look-left", "look-right")] {
        let [one, other] = [one, other].map(|name| set.get(name).unwrap());
        assert_eq!(mirrored(one, &table), sorted(other), "{} and {}", one.name, other.name);
    }
    // With the head held straight; the others are made of one side.
    let one_sided = ["wink-left", "wink-right", "look-left", "look-right", "skeptical", "thinking"];
    let one_sided = [&one_sided[..], &["doubt", "contempt", "disgust"]].concat();
    for pose in set.iter().filter(|pose| !one_sided.contains(&pose.name.as_str())) {
        let mut straight = pose.clone();
        for (index, value) in &mut straight.values {
            if table.controls()[*index].name.starts_with("head.") {
                *value = 0.0;
            }
        }
        assert_eq!(mirrored(&straight, &table), sorted(&straight), "{}", pose.name);
    }
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

#[test]
fn shapes_count_where_the_face_has_all_of_them() {
    let read = |text: &str, table: &ControlTable| {
        let set = PoseSet::from_toml(text, table).map_err(|error| error.to_string())?;
        let named = |values: &[(usize, f32)]| -> Vec<String> {
            let said =
                values.iter().map(|(index, value)| format!("{} {value}", table.controls()[*index].name));
            said.collect()
        };
        Ok::<_, String>(
            set.iter()
                .map(|pose| format!("{}: {}", pose.name, named(&pose.values).join(", ")))
                .collect::<Vec<_>>(),
        )
    };
    let (plain, rich) = (ControlTable::default_face(), face_with_shapes());
    let text = "[[pose]]\nname = 'a'\n[pose.controls]\nsmile = 1\nfrown = 0.5\n[pose.shapes]\nhead.bow = 3\nsmile = 0\nbrowInnerUp = 1\n\
        [[pose]]\nname = 'b'\nkey = 'b'\n[pose.shapes]\nbrowInnerUp = 0.25\n[[pose]]\nname = 'c'\n[pose.controls]\n";
    assert_eq!(read(text, &plain), Ok(vec!["a: smile 1, frown 0.5".to_owned(), "c: ".to_owned()]));
    let all = ["a: frown 0.5, head.bow 3, smile 0, browInnerUp 1", "b: browInnerUp 0.25", "c: "];
    assert_eq!(read(text, &rich), Ok(all.map(str::to_owned).to_vec()));
    // One that is missing is enough, however the others are written.
    let text = "[[pose]]\nname = 'a'\n[pose.controls]\nsmile = 1\n[pose.shapes]\nbrowInnerUp = 1\nhead = { bow = 3, wag = 1 }";
    assert_eq!(read(text, &rich), Ok(vec!["a: smile 1".to_owned()]));
    // What the face has is held against its ranges, and what is left out keeps its name and key.
    let text = "[[pose]]\nname = 'a'\n[pose.shapes]\nbrowInnerUp = 1.5";
    let error = "line 4, column 15: pose.shapes.browInnerUp: expected a number from 0 to 1, found 1.5";
    assert_eq!(read(text, &rich), Err(error.to_owned()));
    let text = "[[pose]]\nname = 'a'\nkey = 'k'\n[pose.shapes]\nwings = 1\n[[pose]]\nname = 'b'\nkey = 'k'";
    assert!(read(text, &plain).unwrap_err().contains("expected a key of its own"));
}
