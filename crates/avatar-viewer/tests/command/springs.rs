//! Hair and clothes of a VRM hang in stills and swing in films.

use crate::common::{copy_of_golden_pack, finish, has_adapter, json, numbers, viewer};
use std::fs;
use std::path::{Path, PathBuf};

#[path = "../../../avatar-exchange/examples/swinging_vrm/body.rs"]
mod body;

fn avatar(folder: &Path) -> PathBuf {
    let file = folder.join("swing.vrm");
    fs::write(&file, body::swinging()).expect("written");
    file
}

/// Where a joint is, by `bones`.
fn place(file: &Path, joint: &str, options: &[&str]) -> [f64; 3] {
    let out = file.with_extension("json");
    finish(viewer().arg("bones").arg(file).args(options).arg("--out").arg(&out)).ok();
    let bones = json(&fs::read_to_string(out).expect("a file"));
    let bones = bones["joints"].as_array().expect("joints");
    let found = bones.iter().find(|one| one["name"] == joint).expect(joint);
    let world = numbers(&found["world"]);
    [world[3], world[7], world[11]]
}

#[test]
fn stills_hang_and_info_tells_what_swings() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = avatar(folder.path());
    let info = json(&finish(viewer().args(["info", "--json"]).arg(&file)).ok());
    let swinging = info["springs"]["swinging"].as_array().expect("joints");
    // Two plaits of four, a tail of five, ten strips of three.
    assert_eq!((swinging.len(), info["springs"]["colliders"].as_u64()), (2 * 4 + 5 + 10 * 3, Some(3)));
    // The plait's first joint is at (0.13, 0.12, -0.02) from the head, which is 1.47 above the ground. Its
    // four steps of (0.01, -0.075, 0) settle a little towards straight down, and keep their lengths.
    let end = place(&file, "plait left 4", &[]);
    let start = [0.13, 1.47 + 0.12, -0.02];
    let along = [0, 1, 2].map(|axis| end[axis] - start[axis]);
    let length = along.map(|x| x * x).iter().sum::<f64>().sqrt();
    assert!((length - 4.0 * 0.01f64.hypot(0.075)).abs() < 1e-3, "{end:?}");
    assert!(along[0] > 0.005 && along[0] < 0.035, "{end:?}: it would be 0.04 without gravity");
    // Where the head is turned, the plait hangs there as well: as far from the axis, and as low.
    let turned = place(&file, "plait left 4", &["--clip", "shake", "--time", "0.25"]);
    assert!((turned[1] - end[1]).abs() < 0.02 && turned[2] < end[2] - 0.03, "{turned:?} {end:?}");
}

#[test]
fn springs_beside_a_file_take_the_place_of_its_own() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = avatar(folder.path());
    let springs = folder.path().join("swing.vrm.springs.toml");
    fs::write(&springs, "[[chain]]\njoints = [\"tail 0\", \"tail 5\"]\n").expect("written");
    let info = json(&finish(viewer().args(["info", "--json"]).arg(&file)).ok());
    assert_eq!(info["springs"]["swinging"], serde_json::json!(["tail 0"]));
    fs::write(&springs, "[[chain]]\njoints = [\"tail 0\", \"tail 6\"]\n").expect("written");
    finish(viewer().arg("info").arg(&file)).fails(1, &["swing.vrm.springs.toml: line 2", "tail 6"]);

    let pack = copy_of_golden_pack();
    fs::write(pack.path().join("springs.toml"), "[[chain]]\njoints = [\"JawJoint\"]\n").expect("written");
    finish(viewer().arg("info").arg(pack.path())).fails(1, &["springs.toml: line 2", "two joints at least"]);
}

#[test]
fn films_swing() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = avatar(folder.path());
    let size = ["--size", "64x48", "--quality", "plain"];
    let out = folder.path().join("frames");
    let film = ["--clip", "shake", "--fps", "20", "--duration", "0.5"];
    finish(viewer().arg("record").arg(&file).args(film).args(size).arg("--out").arg(&out)).ok();
    let picture = |path: &Path| image::open(path).expect("a PNG").into_rgba8();
    let still = |secs: &str| {
        let out = folder.path().join("still.png");
        let at = ["--clip", "shake", "--time", secs];
        finish(viewer().arg("render").arg(&file).args(at).args(size).arg("--out").arg(&out)).ok();
        picture(&out)
    };
    // A film begins as its first moment hangs; later its hair is not where it would hang.
    assert!(picture(&out.join("0000.png")) == still("0"));
    assert!(picture(&out.join("0006.png")) != still("0.3"));
}
