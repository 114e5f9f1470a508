//! Recordings of face trackers.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{ControlTable, Recording};

const TIMES: &str = "FrameNumber,SubFrame,Numerator,Denominator";

/// The nine-joint face with two shapes of ARKit.
fn controls() -> ControlTable {
    let shape = |name: &str| format!("\n[[control]]\nname = '{name}'\nshape = '{name}'");
    let text = format!("{}{}{}", pose_anim::DEFAULT_CONTROLS_TOML, shape("jawOpen"), shape("eyeBlinkLeft"));
    ControlTable::from_toml(&text).unwrap()
}

fn read(text: &str) -> Result<Recording, String> {
    Recording::from_csv("talk", text, &controls()).map_err(|error| error.to_string())
}

#[test]
fn a_row_is_read_at_its_time_by_the_names_of_its_columns() {
    // 30000 frames in 1001 s, and one row lost; lines of Windows, a mark in front, blanks and an empty line.
    let text = format!(
        "\u{feff}{TIMES},BlendShapeCount,JawOpen,EyeBlinkLeft,TongueOut,HeadYaw,HeadPitch,HeadRoll,LeftEyeYaw\r\n\
         900,0.25,30000,1001,61,0, 1,0,0.5,0.25,-0.125,3\r\n\
         901,0.25,30000,1001,61,1,0,1,-0.5,0,0,3\r\n\r\n\
         903,0.75,30000,1001,61,2,-1,1,7,0,0,3"
    );
    let recording = read(&text).unwrap();
    assert_eq!(recording.passed_over, ["TongueOut"]);
    let clip = recording.clip;
    let table = controls();
    let keys = |name: &str| -> Vec<(f64, f64)> {
        let track = clip.track(table.index(name).unwrap()).expect(name);
        track.keys().iter().map(|key| (key.time_secs, key.value)).collect()
    };
    let secs = [0.0, 1001.0 / 30000.0, 3.5 * 1001.0 / 30000.0];
    // Weights and angles stay in their ranges: 0 to 1, -70 to 70 degrees.
    let degrees = 180.0 / std::f64::consts::PI;
    for (name, values) in [
        ("jawOpen", [0.0, 1.0, 1.0]),
        ("eyeBlinkLeft", [1.0, 0.0, 0.0]),
        ("head.turn", [0.5 * degrees, -0.5 * degrees, 70.0]),
        ("head.bow", [-0.25 * degrees, 0.0, 0.0]),
        ("head.bend", [-0.125 * degrees, 0.0, 0.0]),
    ] {
        for ((time, value), (expected_secs, expected)) in
            keys(name).into_iter().zip(secs.into_iter().zip(values))
        {
            assert!((time - expected_secs).abs() < 1e-9, "{name}: {time} and {expected_secs}");
            assert!((value - expected).abs() < 1e-12, "{name}: {value} and {expected}");
        }
        assert_eq!(keys(name).len(), 3);
    }
    assert_eq!(clip.tracks().len(), 5);
    assert_eq!((clip.name.as_str(), clip.wrap), ("talk", pose_anim::Wrap::Once));
}

#[test]
fn mistakes_are_told_with_their_line() {
    let row = |row: &str| format!("{TIMES},JawOpen\n1,0,60,1,0\n{row}\n");
    for (text, expected) in [
        (String::new(), "line 1: expected names of columns, found nothing"),
        (
            "FrameNumber,Subframe,JawOpen".to_owned(),
            "line 1: expected a column SubFrame, found 3 others; \"Subframe\" is like it",
        ),
        (
            format!("{TIMES},Wings\n"),
            "line 1: expected a column that the face has a control for, such as EyeBlinkLeft, found none",
        ),
        (format!("{TIMES},JawOpen,jawOpen\n"), "line 1: expected each column once, found jawOpen again"),
        (row("2,0,60,1"), "line 3: expected 5 values, found 4"),
        (row("2,0,60,1,wide"), "line 3: expected a number as JawOpen, found \"wide\""),
        (row("2,0,60,1,NaN"), "line 3: expected a number as JawOpen, found \"NaN\""),
        (
            row("1,0,60,1,0"),
            "line 3: expected a time after that of the row before, of a rate that is not 0, found 0 s after the first row",
        ),
        (
            row("2,0,0,1,0"),
            "line 3: expected a time after that of the row before, of a rate that is not 0, found inf s after the first row",
        ),
        (format!("{TIMES},JawOpen\n"), "line 1: expected rows of a clip, found "),
    ] {
        let error = read(&text).expect_err(&text);
        assert!(error.starts_with(expected), "{error}\ninstead of\n{expected}");
    }
}

/// Cut anywhere, or with a letter exchanged, a recording is an error or a clip within the bounds of its face.
#[test]
fn damaged_recordings_stay_in_bounds() {
    let text = format!("{TIMES},JawOpen,HeadYaw\n1,0,60,1,0.25,1e300\n2,0.5,60,1,-7,-0.5\n3,0,60,1,1e-9,0\n");
    let table = controls();
    let mut clips = 0;
    for at in 0..text.len() {
        for letter in ["", "-", ",", "\n", "e", "9", "ä"] {
            let damaged =
                format!("{}{letter}{}", &text[..at], &text[(at + letter.len().min(1)).min(text.len())..]);
            let cut = damaged[..at].to_owned();
            for text in [damaged, cut] {
                let Ok(Recording { clip, .. }) = Recording::from_csv("a", &text, &table) else { continue };
                clips += 1;
                for track in clip.tracks() {
                    let control = &table.controls()[track.control()];
                    let range = f64::from(control.min)..=f64::from(control.max);
                    assert!(track.keys().iter().all(|key| range.contains(&key.value)), "{text}");
                }
            }
        }
    }
    assert!(clips > 100, "{clips}");
}
