//! Faces that speak: `--visemes` and the verb `speak`.

use crate::common::{finish, golden_pack, has_adapter, run, viewer};

/// A word with the times of its phones; "m" lasts from 0.3 to 0.4 s, "a" from 0.4 to 0.7.
const MAMA: &str = "_ 300\nm 100\na 300\nm 100\na 300\n_ 300\n";

fn labels() -> tempfile::NamedTempFile {
    let file = tempfile::Builder::new().suffix(".pho").tempfile().expect("a file");
    std::fs::write(file.path(), MAMA).expect("written");
    file
}

/// The value of `jaw.open` in each row of a trace.
fn jaw(options: &[&str]) -> Vec<f32> {
    let text = finish(viewer().arg("trace").arg(golden_pack()).args(options)).ok();
    let mut lines = text.lines();
    let mut names = lines.next().expect("names").split(',');
    let column = names.position(|name| name == "jaw.open").expect("a jaw");
    lines.map(|line| line.split(',').nth(column).expect("a column").parse().expect("a number")).collect()
}

#[test]
fn a_speech_is_the_same_in_every_verb() {
    let file = labels();
    let path = file.path().to_str().expect("a path");
    let spoken = jaw(&["--visemes", path, "--hz", "20", "--duration", "1.5"]);
    assert_eq!(spoken.len(), 31);
    // Closed in the middle of each m, open in each a, at rest at both ends.
    assert_eq!([spoken[0], spoken[7], spoken[15], spoken[30]], [0.0; 4]);
    assert!(spoken[11] > 5.0 && spoken[19] > 5.0, "{spoken:?}");
    let bones = |options: &[&str]| finish(viewer().arg("bones").arg(golden_pack()).args(options)).ok();
    let still = bones(&["--visemes", path, "--time", "0.55"]);
    assert_eq!(still, bones(&[&format!("--set=jaw.open={}", spoken[11])]));
    // It adds to poses and to what is set, and lips close over an open jaw.
    let over = jaw(&["--visemes", path, "--script", "0 surprise", "--hz", "20", "--duration", "1"]);
    assert!(over[11] > spoken[11], "{over:?}");
    assert_eq!(over[15], 0.0);
    assert_eq!(bones(&["--visemes", path, "--time", "0.35", "--set", "jaw.open=15"]), bones(&[]));
    // What speech does not concern keeps its value exactly.
    let turned = ["--set", "head.turn=20"];
    assert_eq!(bones(&[&["--visemes", path, "--time", "0.35"][..], &turned].concat()), bones(&turned));
}

#[test]
fn a_film_of_a_speech_lasts_until_the_mouth_rests() {
    if !has_adapter() {
        return;
    }
    let (file, folder) = (labels(), tempfile::tempdir().expect("a folder"));
    let frames = folder.path().join("frames");
    let mut command = viewer();
    command.arg("speak").arg(golden_pack()).arg("--visemes").arg(file.path());
    command.args(["--expression", "smile:0.3", "--fps", "5", "--size", "32x32", "--out"]).arg(&frames);
    finish(&mut command).ok();
    // 1.4 s of labels and 0.4 s until all has come to rest, at 5 frames a second, the first at 0 s.
    assert_eq!(std::fs::read_dir(&frames).expect("a folder").count(), 10);
}

#[test]
fn mistakes_have_their_place() {
    let file = tempfile::Builder::new().suffix(".tsv").tempfile().expect("a file");
    std::fs::write(file.path(), "0.0\tX\n0.2\tQ\n").expect("written");
    let path = file.path().to_str().expect("a path");
    let told = format!("error: {path}: line 2, column 5: expected a mouth of Rhubarb (A to H, X)");
    run(&["bones", "--visemes", path]).fails(1, &[&told]);
    run(&["speak", "--visemes", path, "--out", "-"]).fails(1, &[&told]);
    run(&["bones", "--visemes", "/nowhere.tsv"]).fails(1, &["error: /nowhere.tsv: expected a readable file"]);
    run(&["speak", "--out", "-"]).fails(2, &["--visemes <FILE>"]);
    run(&["bones", "--time", "1"]).fails(2, &["--visemes"]);
    let derived = ["trace", "--visemes", path, "--derivatives"];
    run(&derived).fails(2, &["--derivatives"]);
}
