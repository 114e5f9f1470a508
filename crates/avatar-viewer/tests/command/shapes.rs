//! A pack with further shapes: every verb knows them as it knows any control.

use crate::common::{copy_of_golden_pack, finish, has_adapter, json, viewer};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const TOML: &str = r#"
[[shape]]
name = "browInnerUp"
group = "brows"
[[shape]]
name = "tongueOut"
parts = ["lower-jaw"]
[[shape]]
name = "open, brows up"
product = ["jaw.open", "browInnerUp"]
[[mixture]]
name = "eyeBlinkLeft"
group = "eyes"
of = { "lid.left.upper" = 45, "lid.left.lower" = 25 }
"#;

/// Each of three shapes moves vertex 2 of its part along one axis.
fn pack() -> TempDir {
    let pack = copy_of_golden_pack();
    let offsets = [[0.0f32, 0.5, 0.0], [0.0, 0.0, 1.5], [0.25, 0.0, 0.0]];
    let shape = |offset: [f32; 3]| {
        let words = [1u32, 2].map(u32::to_le_bytes).concat();
        let numbers = offset.into_iter().chain([0.0; 3]).flat_map(f32::to_le_bytes);
        words.into_iter().chain(numbers).collect::<Vec<u8>>()
    };
    fs::write(pack.path().join("shapes.toml"), TOML).expect("written");
    fs::write(pack.path().join("shapes.raw"), offsets.map(shape).concat()).expect("written");
    pack
}

fn said(verb: &str, pack: &Path, options: &[&str]) -> String {
    finish(viewer().arg(verb).arg(pack).args(options)).ok()
}

/// The face as an OBJ with one object for each part.
fn obj(pack: &Path, set: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("face.obj");
    finish(viewer().arg("convert").arg(pack).args(set).arg("--out").arg(&out)).ok();
    fs::read_to_string(out).expect("an OBJ")
}

/// Vertices of an object of an OBJ.
fn vertices(text: &str, object: &str) -> Vec<[f32; 3]> {
    let of_object = text.lines().skip_while(|line| *line != format!("o {object}")).skip(1);
    let lines =
        of_object.take_while(|line| !line.starts_with("o ")).filter_map(|line| line.strip_prefix("v "));
    lines
        .map(|line| {
            let mut numbers = line.split(' ').map(|number| number.parse().expect("a number"));
            std::array::from_fn(|_| numbers.next().expect("three numbers"))
        })
        .collect()
}

#[test]
fn shapes_and_mixtures_are_set_like_any_control() {
    let pack = pack();
    let rest = obj(pack.path(), &[]);
    for (set, object, expected) in
        [("browInnerUp=0.5", "skin", [0.0, 0.25, 0.0]), ("tongueOut=1", "lower-jaw", [0.0, 0.0, 1.5])]
    {
        let moved = obj(pack.path(), &["--set", set]);
        let (a, b) = (vertices(&rest, object), vertices(&moved, object));
        for (vertex, (a, b)) in a.iter().zip(&b).enumerate() {
            let expected = if vertex == 2 { expected } else { [0.0; 3] };
            let found: [f32; 3] = std::array::from_fn(|i| b[i] - a[i]);
            assert!(
                found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5),
                "{set}, {vertex}: {found:?}"
            );
        }
    }
    let blink = said("bones", pack.path(), &["--set", "eyeBlinkLeft=1"]);
    let lids = ["--set", "lid.left.upper=45", "--set", "lid.left.lower=25"];
    assert_eq!(blink, said("bones", pack.path(), &lids));
    assert_ne!(blink, said("bones", pack.path(), &[]));
    // Half open and half up: a quarter of the corrective.
    let both = ["--set", "jaw.open=10", "--set", "browInnerUp=0.5"];
    assert_eq!(json(&said("bones", pack.path(), &both))["weights"]["open, brows up"], 0.25);
    let wrong = finish(viewer().arg("bones").arg(pack.path()).args(["--set", "eyeBlinkLeftt=1"]));
    wrong.fails(2, &["eyeBlinkLeftt", "did you mean \"eyeBlinkLeft\"?"]);
}

#[test]
fn poses_and_clips_say_them() {
    let pack = pack();
    let pose = "[[pose]]\nname = 'wonder'\nkey = 'w'\n[pose.controls]\nbrowInnerUp = 0.5\neyeBlinkLeft = 1\n";
    fs::write(pack.path().join("poses.toml"), pose).expect("written");
    let set = ["--set", "browInnerUp=0.5", "--set", "eyeBlinkLeft=1"];
    assert_eq!(said("bones", pack.path(), &["--pose", "wonder"]), said("bones", pack.path(), &set));
    let clip = "[[clip]]\nname = 'up'\n[clip.tracks]\nbrowInnerUp = [{ t = 0, v = 0 }, { t = 1, v = 1 }]\n";
    fs::write(pack.path().join("clips.toml"), clip).expect("written");
    let info = json(&said("info", pack.path(), &["--json"]));
    assert_eq!(info["clips"][0]["name"], "up");
    assert_eq!(info["further_shapes"].as_array().map(Vec::len), Some(3));
    let controls = info["controls"].as_array().expect("controls");
    let brow = controls.iter().find(|control| control["name"] == "browInnerUp").expect("a control");
    assert_eq!((&brow["group"], &brow["max"]), (&"brows".into(), &1.0.into()));
}

#[test]
fn they_go_through_other_formats_and_come_back() {
    let pack = pack();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (glb, again) = (folder.path().join("face.glb"), folder.path().join("again"));
    finish(viewer().arg("convert").arg(pack.path()).arg("--out").arg(&glb)).ok();
    finish(viewer().arg("convert").arg(&glb).arg("--out").arg(&again)).ok();
    let set = ["--set", "browInnerUp=0.5", "--set", "tongueOut=1"];
    let texts = [pack.path(), glb.as_path(), again.as_path()].map(|avatar: &Path| obj(avatar, &set));
    for object in ["skin", "lower-jaw"] {
        let [own, of_glb, of_folder] = texts.each_ref().map(|text| vertices(text, object));
        assert!(!own.is_empty());
        for other in [of_glb, of_folder] {
            assert_eq!(own.len(), other.len(), "{object}");
            let worst = own.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| (a - b).abs());
            assert!(worst.fold(0.0, f32::max) < 1e-4, "{object}");
        }
    }
    let copy = folder.path().join("copy");
    finish(viewer().arg("convert").arg(pack.path()).arg("--out").arg(&copy)).ok();
    let raw = |pack: &Path| fs::read(pack.join("shapes.raw")).expect("shapes");
    assert!(raw(&copy) == raw(pack.path()));
}

#[test]
fn they_show_in_pictures() {
    if !has_adapter() {
        return;
    }
    let pack = pack();
    let draw = |set: &[&str]| {
        let out = pack.path().join("face.png");
        let small = ["--size", "96x96", "--quality", "plain"];
        finish(viewer().arg("render").arg(pack.path()).args(small).args(set).arg("--out").arg(&out)).ok();
        // Without the text that says what was set.
        image::open(out).expect("a PNG").into_rgba8()
    };
    let rest = draw(&[]);
    assert!(rest == draw(&["--set", "browInnerUp=0"]));
    assert!(rest != draw(&["--set", "browInnerUp=1"]));
    assert!(
        draw(&["--set", "eyeBlinkLeft=1"])
            == draw(&["--set", "lid.left.upper=45", "--set", "lid.left.lower=25"])
    );
}

#[test]
fn damage_is_told_with_file_and_place() {
    let pack = pack();
    let raw = pack.path().join("shapes.raw");
    let whole = fs::read(&raw).expect("shapes");
    fs::write(&raw, &whole[..whole.len() - 1]).expect("written");
    let cut = finish(viewer().arg("info").arg(pack.path()));
    cut.fails(1, &["shapes.raw: byte 68, shape \"open, brows up\": expected 28 more bytes"]);
    fs::write(pack.path().join("shapes.toml"), TOML.replace("group", "grop")).expect("written");
    let misspelt = finish(viewer().arg("info").arg(pack.path()));
    misspelt.fails(1, &["shapes.toml: line 4, column 1: shape.grop", "did you mean \"group\"?"]);
}
