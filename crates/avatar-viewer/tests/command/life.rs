//! Faces that live: `--life`.

use crate::common::{finish, golden_pack, has_adapter, run, viewer};
use avatar_life::{Life, Style};
use pose_anim::ControlTable;
use std::path::PathBuf;

/// The values of each row of a trace by the names of its columns.
fn trace(options: &[&str]) -> Vec<Vec<(String, f32)>> {
    let text = finish(viewer().arg("trace").arg(golden_pack()).args(options)).ok();
    let mut lines = text.lines();
    let names: Vec<String> = lines.next().expect("names").split(',').map(str::to_owned).collect();
    let number = |text: &str| text.parse().expect("a number");
    lines.map(|line| names.iter().cloned().zip(line.split(',').map(number)).collect()).collect()
}

/// Rows of a trace are what the library says; stills and films show the same.
#[test]
fn a_life_is_the_same_in_every_verb() {
    let controls = ControlTable::default_face();
    let options = ["--life", "nervous", "--seed", "5"];
    let rows = trace(&[&options[..], &["--hz", "4", "--duration", "5"]].concat());
    assert_eq!(rows.len(), 21);
    let mut life = Life::new(&controls, Style::preset("nervous").expect("a preset"), 5);
    for (row, columns) in rows.iter().enumerate() {
        life.advance(if row == 0 { 0.0 } else { 0.25 }).expect("a step");
        for (index, control) in controls.controls().iter().enumerate() {
            let expected = life.value(index, control.default.into()) as f32;
            let (name, found) = &columns[index + 1];
            assert!(
                *name == control.name && (found - expected).abs() < 1e-4,
                "{row}: {name} {found} {expected}"
            );
        }
    }
    let bones = |options: &[&str]| finish(viewer().arg("bones").arg(golden_pack()).args(options)).ok();
    let still = bones(&["--life", "nervous", "--seed", "5", "--time", "3"]);
    let set: Vec<String> =
        (rows[12].iter().skip(1)).map(|(name, value)| format!("--set={name}={value}")).collect();
    // Lids follow the gaze after life; what --set sets is exact. This pack has no such coupling.
    let set: Vec<&str> = set.iter().map(String::as_str).collect();
    let numbers = |text: &str| -> Vec<f64> {
        let parts = text.split(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c)));
        parts.filter_map(|part| part.parse().ok()).collect()
    };
    let (found, expected) = (numbers(&still), numbers(&bones(&set)));
    assert!(found.len() > 100 && found.len() == expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-4, "{found} {expected}");
    }
    assert_ne!(still, bones(&["--life", "nervous", "--seed", "6", "--time", "3"]));
    assert_eq!(bones(&["--life", "off", "--time", "3"]), bones(&[]));
    // Over a pose, and under single settings.
    let smiling = bones(&["--life", "calm", "--time", "2", "--pose", "smile", "--set", "head.turn=20"]);
    assert_ne!(smiling, bones(&["--pose", "smile", "--set", "head.turn=20"]));
}

#[test]
fn a_film_of_a_life_shows_what_stills_show() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let frames = folder.path().join("frames");
    let options = ["--life", "lively", "--seed", "2", "--fps", "2", "--duration", "2", "--size", "48x36"];
    finish(viewer().arg("record").arg(golden_pack()).args(options).arg("--out").arg(&frames)).ok();
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(&frames).expect("a folder").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    assert_eq!(files.len(), 4);
    for (frame, file) in files.iter().enumerate() {
        let still = folder.path().join("still.png");
        let time = (frame as f64 / 2.0).to_string();
        let options = ["--life", "lively", "--seed", "2", "--time", &time, "--size", "48x36"];
        finish(viewer().arg("render").arg(golden_pack()).args(options).arg("--out").arg(&still)).ok();
        let [one, other] = [file, &still].map(|path| image::open(path).expect("a PNG").into_rgba8());
        assert!(one == other, "frame {frame}");
    }
}

#[test]
fn wrong_lives_are_wrong_usage() {
    run(&["bones", "--life", "clam"])
        .fails(2, &["calm, lively, tired, nervous, listening or off", "did you mean \"calm\""]);
    run(&["bones", "--life", "calm", "--seed", "-1"]).fails(2, &["a whole number from 0"]);
    run(&["bones", "--life", "calm", "--time", "1e6"]).fails(2, &["0 to 86,400 seconds", "1000000"]);
    run(&["bones", "--seed", "1"]).fails(2, &["--life <PRESET>"]);
    run(&["trace", "--life", "calm", "--derivatives"]).fails(2, &["--derivatives", "--life"]);
}
