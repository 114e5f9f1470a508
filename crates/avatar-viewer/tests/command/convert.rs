//! Writing folders in the raw format: whole, in a new place, and read again by the program.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common;
use crate::common::{copy_of_golden_pack, finish, has_adapter, read_obj, viewer};
use std::fs;
use std::path::Path;

fn convert(pack: &Path, out: &Path) -> common::Run {
    finish(viewer().arg("convert").arg(pack).arg("--out").arg(out))
}

fn world(pack: &Path, out: &Path) -> Vec<Vec<f64>> {
    let pose = ["--world", "--set", "jaw.open=12", "--set", "head.turn=30", "--set", "smile=0.5", "--out"];
    finish(viewer().arg("deform").arg(pack).args(pose).arg(out)).ok();
    read_obj(out).0
}

#[test]
fn a_pack_goes_through_glb_into_a_folder() {
    let (pack, folder) = (copy_of_golden_pack(), tempfile::tempdir().expect("a temporary folder"));
    let at = |name: &str| folder.path().join(name);
    // The second name is what --out says, and both is one too many.
    finish(viewer().arg("convert").arg(pack.path()).arg(at("face.glb"))).ok();
    finish(viewer().arg("convert").arg(pack.path()).arg(at("face.glb")).args(["--out", "x.glb"]))
        .fails(2, &["cannot be used with"]);
    finish(viewer().arg("convert").arg(pack.path())).fails(2, &["expected the file to write"]);
    // A name without an end is that of a folder, and so is that of an empty folder.
    fs::create_dir(at("empty.d")).expect("a folder");
    for name in ["again", "slash/", "empty.d"] {
        let run = convert(&at("face.glb"), &at(name));
        assert!(run.stderr.contains("warning: clips are left out"), "{}", run.stderr);
        run.ok();
        let (a, b) = (world(pack.path(), &at("a.obj")), world(&at(name), &at("b.obj")));
        assert_eq!(a.len(), b.len());
        let size = a.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
        for (a, b) in a.iter().zip(&b) {
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-6 * size), "{a:?} {b:?}");
        }
    }
    let left: Vec<_> = fs::read_dir(folder.path()).expect("the folder").collect();
    assert_eq!(left.len(), 6, "nothing beside what was asked for: {left:?}");
}

#[test]
fn a_file_of_two_parts_becomes_a_face_that_is_drawn() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    let floats: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = floats.iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(at("two.bin"), bytes).expect("written");
    let text = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "Head", "mesh": 0, "children": [1]},
            {"name": "LeftEye", "mesh": 0, "translation": [0, 2, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"uri": "two.bin", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]}"#;
    fs::write(at("two.gltf"), text).expect("written");
    let run = convert(&at("two.gltf"), &at("face"));
    for warning in ["part \"LeftEye\" is vertices 0 and up of left-eyeball", "there is no lower-jaw"] {
        assert!(run.stderr.contains(warning), "{warning}: {}", run.stderr);
    }
    run.ok();
    let info = finish(viewer().arg("info").arg(at("face"))).ok();
    assert!(info.contains("left-eyeball") && info.contains("eye.left.lr"), "{info}");
    if has_adapter() {
        let mut render = viewer();
        render.arg("render").arg(at("face")).args(["--size", "64x64", "--out"]).arg(at("face.png"));
        finish(&mut render).ok();
    }
}

#[test]
fn nothing_is_written_over_or_left_half_and_all_shapes_are_kept() {
    let (pack, folder) = (copy_of_golden_pack(), tempfile::tempdir().expect("a temporary folder"));
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("full")).expect("a folder");
    fs::write(at("full/mine.txt"), "mine").expect("written");
    fs::write(at("file"), "mine").expect("written");
    let empty_or_none = "expected a new or an empty folder, found";
    convert(pack.path(), &at("full")).fails(1, &["full", empty_or_none]);
    convert(pack.path(), &at("file")).fails(1, &["file", empty_or_none]);
    convert(pack.path(), &at("none/face/")).fails(1, &["none", "expected a folder to write to, found none"]);
    convert(pack.path(), &at("face.fbx")).fails(2, &["face.fbx", ".glb or .obj", "folder"]);
    fs::write(at("base.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    fs::create_dir(at("targets")).expect("a folder");
    for name in ["A", "B", "C"] {
        fs::write(at(&format!("targets/{name}.target")), "0 1 0 0\n").expect("written");
    }
    let mut many = viewer();
    many.arg("convert").arg(at("base.obj")).arg("--with").arg(at("targets")).arg("--out").arg(at("many"));
    finish(&mut many).ok();
    let shapes = fs::read_to_string(at("many/shapes.toml")).expect("more shapes than the raw format holds");
    assert!(["A", "B", "C"].iter().all(|name| shapes.contains(&format!("name = \"{name}\""))), "{shapes}");
    assert!(finish(viewer().arg("info").arg(at("many"))).ok().contains("\nC               "), "controls");
    assert_eq!(fs::read_to_string(at("full/mine.txt")).expect("still there"), "mine");
    let hidden = fs::read_dir(folder.path())
        .expect("the folder")
        .filter(|entry| entry.as_ref().expect("an entry").file_name().to_string_lossy().starts_with('.'));
    assert_eq!(hidden.count(), 0);
}

#[test]
fn a_rig_is_not_written_in_a_pose() {
    let (pack, folder) = (copy_of_golden_pack(), tempfile::tempdir().expect("a temporary folder"));
    let at = |name: &str| folder.path().join(name);
    for out in ["face.glb", "face/"] {
        let mut posed = viewer();
        posed.arg("convert").arg(pack.path()).args(["--set", "jaw.open=3", "--out"]).arg(at(out));
        finish(&mut posed).fails(2, &["expected no pose", ".obj"]);
    }
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 0);
    fs::write(
        pack.path().join("clips.toml"),
        "[[clip]]\nname = 'a'\n[clip.tracks]\n'jaw.open' = [{ t = 0, v = 3 }]\n",
    )
    .expect("written");
    let run = convert(pack.path(), &at("face.glb"));
    assert!(run.stderr.contains("clips of controls are left out"), "{}", run.stderr);
    run.ok();
}

#[test]
fn names_of_parts_stay() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("body.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\ng skin\nf 1 2 3\ng coat\nf 1 3 2\n")
        .expect("written");
    convert(&at("body.obj"), &at("body.glb")).ok();
    for file in ["body.obj", "body.glb"] {
        let info = finish(viewer().arg("info").arg(at(file))).ok();
        assert!(info.contains("skin") && info.contains("coat"), "{file}: {info}");
    }
}

#[test]
fn a_folder_of_frames_or_targets_may_hold_the_first_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    let frame = |y: u32| format!("v 0 0 0\nv 1 0 0\nv 0 {y} 0\nf 1 2 3\n");
    fs::create_dir(at("frames")).expect("a folder");
    for number in 0..12 {
        fs::write(at(&format!("frames/f{number}.obj")), frame(number + 1)).expect("written");
    }
    let height = |time: &str| {
        let mut deform = viewer();
        deform.args(["deform", "--world"]).arg(at("frames/f0.obj")).arg("--with").arg(at("frames"));
        finish(deform.args(["--clip", "f0", "--time", time, "--out"]).arg(at("now.obj"))).ok();
        read_obj(&at("now.obj")).0[2][1]
    };
    let info = finish(viewer().arg("info").arg(at("frames/f0.obj")).arg("--with").arg(at("frames"))).ok();
    assert!(info.contains("0.458"), "eleven spans of 1/24 s: {info}");
    // Frame 10 is the eleventh.
    assert!((height("0.4166667") - 11.0).abs() < 1e-4, "{}", height("0.4166667"));
    fs::write(at("frames/up.target"), "2 0 1 0\n").expect("written");
    let info = finish(viewer().arg("info").arg(at("frames/f0.obj")).arg("--with").arg(at("frames"))).ok();
    assert!(info.contains("up"), "{info}");
}

/// The built-in face with VRM's names for its targets: those that a face can show, and no others.
#[test]
fn morph_targets_are_those_that_are_asked_for() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("face.glb");
    let run = finish(viewer().args(["convert", "--shapes", "vrm", "--out"]).arg(&out));
    assert!(run.stderr.contains("the file does not have: neutral\n"), "{}", run.stderr);
    let info = common::json(&finish(viewer().args(["info", "--json"]).arg(&out)).ok());
    let text = info.to_string();
    for name in ["aa", "blinkLeft", "lookUp", "surprised"] {
        assert!(text.contains(&format!("\"{name}\"")), "{name}: {text}");
    }
    assert!(!text.contains("mouthFunnel") && !text.contains("viseme_aa"), "{text}");
    finish(viewer().args(["convert", "--shapes", "arkti", "--out"]).arg(&out))
        .fails(2, &["did you mean \"arkit\"?"]);
    finish(viewer().args(["convert", "--shapes", "vrm", "--out"]).arg(folder.path().join("face.obj")))
        .fails(2, &["expected --shapes with a .glb"]);
}
