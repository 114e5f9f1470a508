//! Other people made of a face: `--identity`.

use crate::common::{copy_of_golden_pack, finish, json, run, viewer};
use std::fs;
use tempfile::TempDir;

const TOML: &str = r#"
[[axis]]
name = "height"
less = "low"
more = "high"
[[axis.map]]
center = [0, 0, 0]
radii = [1e5, 1e5, 1e5]
full = 0.9
move = [0, 2, 0]
[[axis]]
name = "depth"
less = "back"
more = "front"
[[axis.map]]
center = [0, 0, 0]
radii = [1e5, 1e5, 1e5]
full = 0.9
move = [0, 0, 4]
"#;

fn pack() -> TempDir {
    let pack = copy_of_golden_pack();
    fs::write(pack.path().join("identity.toml"), TOML).expect("written");
    pack
}

/// The vertices of the skin, as `deform` writes them.
fn places(pack: &TempDir, options: &[&str]) -> Vec<[f32; 3]> {
    let text = finish(viewer().arg("deform").arg(pack.path()).args(options).args(["--out", "-"])).ok();
    let places = text.lines().filter_map(|line| line.strip_prefix("v "));
    let number = |text: &str| text.parse().expect("a number");
    places.map(|line| line.split(' ').map(number).collect::<Vec<_>>().try_into().expect("three")).collect()
}

#[test]
fn values_move_the_face_and_the_later_one_counts() {
    let pack = pack();
    let rest = places(&pack, &[]);
    let options = ["--identity", "height=1", "--identity", "depth=-0.25", "--identity", "height=-0.5"];
    for (p, q) in rest.iter().zip(places(&pack, &options)) {
        let off: f32 = (0..3).map(|k| (p[k] + [0.0, -1.0, -1.0][k] - q[k]).abs()).sum();
        assert!(off < 1e-4, "{p:?} goes to {q:?}");
    }
    let seven = places(&pack, &["--identity", "seed:7"]);
    assert_eq!(seven, places(&pack, &["--identity", "seed:7"]), "the same on every run");
    assert_ne!(seven, places(&pack, &["--identity", "seed:8"]));
    assert_ne!(seven, rest);
    let zero = ["--identity", "seed:7", "--identity", "height=0", "--identity", "depth=0"];
    assert_eq!(places(&pack, &zero), rest, "values behind a seed take its place");
}

#[test]
fn info_lists_the_axes_and_a_converted_person_has_none() {
    let pack = pack();
    let told = json(&finish(viewer().arg("info").arg("--json").arg(pack.path())).ok());
    let names: Vec<_> = told["identity"].as_array().expect("axes").iter().map(|axis| &axis["name"]).collect();
    assert_eq!(names, ["height", "depth"]);
    let text = finish(viewer().arg("info").arg(pack.path())).ok();
    assert!(text.contains("\nheight          low … high\n"), "{text}");
    let folder = tempfile::tempdir().expect("a folder");
    for (options, expected) in [(&[][..], true), (&["--identity", "height=1"], false)] {
        let out = folder.path().join(format!("as-{expected}"));
        finish(viewer().arg("convert").arg(pack.path()).args(options).arg("--out").arg(&out)).ok();
        assert_eq!(out.join("identity.toml").exists(), expected);
    }
}

#[test]
fn mistakes_are_told() {
    let pack = pack();
    let told = |option: &str| finish(viewer().arg("bones").arg(pack.path()).args(["--identity", option]));
    told("heigth=1").fails(2, &["face axis", "heigth", "did you mean \"height\"?", "height, depth"]);
    told("height=1.5").fails(2, &["--identity height: expected a number from -1 to 1, found 1.5"]);
    told("height=nan").fails(2, &["nan"]);
    told("seed:x").fails(2, &["expected a whole number after \"seed:\", found \"x\""]);
    told("height").fails(2, &["expected AXIS=VALUE or seed:NUMBER"]);
    let plain = copy_of_golden_pack();
    let none = finish(viewer().arg("bones").arg(plain.path()).args(["--identity", "seed:1"]));
    none.fails(2, &["expected an avatar with axes of identity (identity.toml), found one without"]);
}

#[test]
fn the_built_in_face_has_axes() {
    let told = json(&run(&["info", "--json"]).ok());
    assert!(told["identity"].as_array().expect("axes").len() >= 12);
    let bones = |option: &str| run(&["bones", "--identity", option]).ok();
    assert_ne!(bones("eye-distance=1"), bones("ears=1"), "joints of eyes go with them");
}
