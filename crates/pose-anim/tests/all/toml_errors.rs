//! Every way in which `controls.toml` and `poses.toml` can be wrong, with the message that a user reads.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{ControlTable, PoseSet};
use proptest::prelude::*;

const START: &str = "[[control]]\nname = \"a\"\n";

fn controls_error(text: &str) -> String {
    ControlTable::from_toml(text).unwrap_err().to_string()
}

fn poses_error(text: &str) -> String {
    PoseSet::from_toml(text, &ControlTable::default_face()).unwrap_err().to_string()
}

#[test]
fn controls() {
    let axis = r#"an axis "+x", "-x", "+y", "-y", "+z", "-z" or three numbers [x, y, z] that are not all 0"#;
    let joint = "joint = \"J\"\naxis = \"+x\"\n";
    let rows = [
        ("joint = \"J\"\naxis = \"up\"\nmin = 0\nmax = 1", format!("line 4, column 8: control.axis: expected {axis}, found \"up\"")),
        ("joint = \"J\"\naxis = [0, 0, 0]\nmin = 0\nmax = 1", format!("line 4, column 8: control.axis: expected {axis}, found [0, 0, 0]")),
        ("joint = \"J\"\naxis = [1, 0]\nmin = 0\nmax = 1", format!("line 4, column 8: control.axis: expected {axis}, found an array of 2")),
        ("joint = \"J\"\naxis = [1, nan, 0]\nmin = 0\nmax = 1", format!("line 4, column 12: control.axis: expected {axis}, found nan")),
        ("joint = \"J\"\nmin = 0\nmax = 1", format!("line 1, column 1: control.axis: expected {axis}, found none")),
        ("", "line 1, column 1: control.joint: expected the name of a joint (or a key `shape`), found none".into()),
        ("shape = \"S\"\njoint = \"J\"", "line 4, column 9: control.joint: expected a control of either a joint or a shape, found joint beside shape".into()),
        ("shape = 3", "line 3, column 9: control.shape: expected the name of a blend shape, found 3".into()),
        ("shape = \"S\"\nmin = nan", "line 4, column 7: control.min: expected a finite number up to 1e9, found nan".into()),
        ("shape = \"S\"\nmax = inf", "line 4, column 7: control.max: expected a finite number up to 1e9, found inf".into()),
        ("shape = \"S\"\nmin = -1e40", "line 4, column 7: control.min: expected a finite number up to 1e9, found -1e40".into()),
        ("shape = \"S\"\nmin = \"0\"", "line 4, column 7: control.min: expected a finite number up to 1e9, found \"0\"".into()),
        ("shape = \"S\"\nmin = 0.5\nmax = 0.25", "line 5, column 7: control.max: expected a number that is not less than min = 0.5, found 0.25".into()),
        ("shape = \"S\"\nmin = 2", "line 1, column 1: control.max: expected a number that is not less than min = 2, found none".into()),
        ("shape = \"S\"\ndefault = 2", "line 4, column 11: control.default: expected a number from 0 to 1, found 2".into()),
        ("shape = \"S\"\nmin = 0.5", "line 1, column 1: control.default: expected a number from 0.5 to 1, found none (which means 0)".into()),
        ("shape = \"S\"\nmaximum = 1", "line 4, column 1: control.maximum: expected one of the keys name, joint, axis, kind, shape, min, max, default, seconds, group, found \"maximum\"".into()),
        ("shape = \"S\"\nmni = 1", "line 4, column 1: control.mni: expected one of the keys name, joint, axis, kind, shape, min, max, default, seconds, group, found \"mni\"; did you mean \"min\"?".into()),
        ("shape = \"S\"\nseconds = 1", "line 4, column 11: control.seconds: expected an array, found 1".into()),
        ("shape = \"S\"\nseconds = [2, 1]", "line 4, column 11: control.seconds: expected [shortest, longest]: two numbers of seconds, 0.001 to 3600, in this order, found [2, 1]".into()),
        ("shape = \"S\"\n[[control]]\nname = \"a\"\nshape = \"T\"", "line 5, column 8: control.name: expected unique names, found \"a\" again".into()),
        ("shape = \"S\"\n[[coupling]]\nfrom = \"a\"\nto = \"b\"\nfactor = 1", "line 6, column 6: coupling.to: expected one of the controls a, found \"b\"".into()),
        ("shape = \"S\"\n[[coupling]]\nfrom = \"a\"\nto = \"a\"\nfactor = 1", "line 6, column 6: coupling.to: expected another control than `from`, found \"a\"".into()),
        ("shape = \"S\"\n[control.x]\ny = 1", "line 4, column 10: control.x: expected one of the keys name, joint, axis, kind, shape, min, max, default, seconds, group, found \"x\"".into()),
        ("shape = \"S\"\n[[poses]]", "line 4, column 3: poses: expected one of the keys control, coupling, found \"poses\"".into()),
    ];
    for (rest, expected) in rows {
        assert_eq!(controls_error(&format!("{START}{rest}")), expected, "{rest}");
    }
    for (rest, expected) in [
        ("max = 1", "line 1, column 1: control.min: expected a finite number up to 1e9, found none"),
        (
            "min = 0",
            "line 1, column 1: control.max: expected a number that is not less than min = 0, found none",
        ),
        (
            "min = 0\nmax = 1\nkind = \"rotatoin\"",
            "line 7, column 8: control.kind: expected one of rotation, translation, found \"rotatoin\"; did you mean \"rotation\"?",
        ),
    ] {
        assert_eq!(controls_error(&format!("{START}{joint}{rest}")), expected, "{rest}");
    }
    assert_eq!(
        controls_error("[[control]]\nshape = \"S\""),
        "line 1, column 1: control.name: expected the name of a control, found none"
    );
    assert_eq!(
        controls_error("[[control]]\nname = \" \""),
        "line 2, column 8: control.name: expected the name of a control, found \" \""
    );
    assert_eq!(
        controls_error("control = 1"),
        "line 1, column 11: control: expected tables that begin with [[control]], found 1"
    );
    assert_eq!(controls_error("control = [1]"), "line 1, column 12: control: expected a table, found 1");
    assert!(
        controls_error("[[control]]\nname = ")
            .starts_with("line 2, column 8: expected valid TOML, found an error: ")
    );
}

#[test]
fn poses() {
    let rows = [
        ("key = \"1\"", "line 1, column 1: pose.name: expected the name of a pose, found none"),
        (
            "name = \"a\"\n[[pose]]\nname = \"a\"",
            "line 4, column 8: pose.name: expected unique names, found \"a\" again",
        ),
        (
            "name = \"a\"\nkey = \"1\"\n[[pose]]\nname = \"b\"\nkey = \"1\"",
            "line 6, column 7: pose.key: expected a key of its own, found \"1\", which calls pose \"a\"",
        ),
        (
            "name = \"a\"\nkey = \"Ctrl+A\"",
            "line 3, column 7: pose.key: expected the name of one key, such as \"1\", \"q\" or \"F5\", found \"Ctrl+A\"",
        ),
        (
            "name = \"a\"\nothers = \"defualt\"",
            "line 3, column 10: pose.others: expected only default, found \"defualt\"; did you mean \"default\"?",
        ),
        (
            "name = \"a\"\nkey = 1",
            "line 3, column 7: pose.key: expected the name of one key, such as \"1\", \"q\" or \"F5\", found 1",
        ),
        (
            "name = \"a\"\nduration = 0",
            "line 3, column 12: pose.duration: expected a number of seconds from 0.001 to 3600, found 0",
        ),
        (
            "name = \"a\"\nduration = \"fast\"",
            "line 3, column 12: pose.duration: expected a number of seconds from 0.001 to 3600, found \"fast\"",
        ),
        (
            "name = \"a\"\ntransition = \"cubic-inout\"",
            "line 3, column 14: pose.transition: NAMES, found \"cubic-inout\"; did you mean \"cubic-in-out\"?",
        ),
        (
            "name = \"a\"\ntransition = [0, 0, 1, 1001]",
            "line 3, column 14: pose.transition: expected the name of a transition, such as \"cubic-in-out\", or [x1, y1, x2, y2] with x from 0 to 1 and y from -1000 to 1000, found an array of 4 numbers",
        ),
        (
            "name = \"a\"\ntransition = [0, 0, 2, 1]",
            "line 3, column 14: pose.transition: expected the name of a transition, such as \"cubic-in-out\", or [x1, y1, x2, y2] with x from 0 to 1 and y from -1000 to 1000, found an array of 4 numbers",
        ),
        (
            "name = \"a\"\n[pose.timing]\nhead.turn = { delay = -1 }",
            "line 4, column 23: pose.timing.head.turn.delay: expected a number of seconds from 0 to 3600, found -1",
        ),
        (
            "name = \"a\"\n[pose.timing]\nhead.turn = { speed = 2 }",
            "line 4, column 15: pose.timing.head.turn.speed: expected one of the keys delay, factor, found \"speed\"",
        ),
        ("name = \"a\"\ncontrols = 3", "line 3, column 12: pose.controls: expected a table, found 3"),
        (
            "name = \"a\"\n[pose.controls]\n\"head.turn\" = 70.5",
            "line 4, column 15: pose.controls.\"head.turn\": expected a number from -70 to 70, found 70.5",
        ),
        (
            "name = \"a\"\n[pose.controls]\nhead.turn = nan",
            "line 4, column 13: pose.controls.head.turn: expected a number from -70 to 70, found nan",
        ),
        (
            "name = \"a\"\n[pose.controls]\nhead.turn = 1\n\"head.turn\" = 2",
            "line 5, column 1: pose.controls.\"head.turn\": expected each control once, found \"head.turn\" again",
        ),
    ];
    for (rest, expected) in rows {
        let found = poses_error(&format!("[[pose]]\n{rest}"));
        // Either of two spellings of one key may count as the second.
        if expected.contains("each control once") {
            assert!(found.contains("expected each control once, found \"head.turn\" again"), "{found}");
        } else {
            // The names of all transitions are no part of the expectation.
            let short = found
                .find("expected one of linear")
                .zip(found.find(", found"))
                .map(|(from, to)| format!("{}NAMES{}", &found[..from], &found[to..]));
            assert_eq!(short.unwrap_or(found), expected, "{rest}");
        }
    }
    for text in ["\"head.trun\" = 1", "head.trun = 1", "head.trun = {}"] {
        let found = poses_error(&format!("[[pose]]\nname = \"a\"\n[pose.controls]\nsmile = 0\n{text}"));
        assert!(found.starts_with("line 5, column "), "{found}");
        assert!(found.contains("expected one of the controls head.turn, head.bow, "), "{found}");
        assert!(found.ends_with("found \"head.trun\"; did you mean \"head.turn\"?"), "{found}");
    }
    let error = PoseSet::from_toml("[[pose]]\nnmae = \"ä\"", &ControlTable::default_face()).unwrap_err();
    assert_eq!(error.key, "pose.name");
}

#[test]
fn texts_may_have_a_byte_order_mark_and_windows_line_ends() {
    let text = "\u{feff}[[control]]\r\nname = 'a'\r\nshape = 'S'\r\nmaks = 1";
    assert!(controls_error(text).starts_with("line 4, column 1: control.maks: "));
    assert_eq!(ControlTable::from_toml(&text.replace("maks", "max")).unwrap().len(), 1);
}

#[test]
fn deep_nesting_is_an_error_and_no_overflow() {
    let nested = format!("[[pose]]\nname = 'a'\ncontrols = {}{}", "{a=".repeat(100_000), "}".repeat(100_000));
    assert!(!poses_error(&nested).is_empty());
    let dotted = format!("[[pose]]\nname = 'a'\n[pose.controls]\n{} = 1", vec!["a"; 100_000].join("."));
    assert!(!poses_error(&dotted).is_empty());
}

proptest! {
    #[test]
    fn no_text_panics(text in "\\PC{0,200}", cut in 0usize..3000) {
        let _ = ControlTable::from_toml(&text);
        let table = ControlTable::default_face();
        let _ = PoseSet::from_toml(&text, &table);
        // A real file that is cut off, or in which a byte is replaced.
        for file in [pose_anim::DEFAULT_POSES_TOML, pose_anim::DEFAULT_CONTROLS_TOML] {
            let cut = file.floor_char_boundary(cut);
            let _ = PoseSet::from_toml(&file[..cut], &table);
            let _ = ControlTable::from_toml(&file[..cut]);
            let mixed = format!("{}{text}{}", &file[..cut], &file[cut..]);
            let _ = PoseSet::from_toml(&mixed, &table);
            let _ = ControlTable::from_toml(&mixed);
        }
    }
}
