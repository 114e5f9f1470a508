//! Files of interchange formats in the place of a pack: they give what another program computed, on the CPU
//! and on the GPU; broken files and unknown formats are refused.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{finish, has_adapter, json, numbers, read_obj, shared_data, viewer};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const TOLERANCE: f64 = 1e-4;

/// The options that bring about a case of the expected data.
fn options_of(case: &Value, info: &Value) -> Vec<String> {
    let mut options = Vec::new();
    if let Some(clip) = case["animation"].as_u64() {
        let name = info["clips"][clip as usize]["name"].as_str().expect("a clip");
        options.extend(["--clip".to_owned(), name.to_owned(), "--time".to_owned(), case["time"].to_string()]);
    }
    let weights = case["override_weights"].as_array().map_or(&[][..], Vec::as_slice);
    // Weights go from 0 to 1, angles do not.
    let is_of_shape = |control: &&Value| control["max"] == 1.0;
    let shapes = info["controls"].as_array().expect("controls").iter().filter(is_of_shape);
    for (control, weight) in shapes.zip(weights) {
        let name = control["name"].as_str().expect("a name");
        options.extend(["--set".to_owned(), format!("{name}={weight}")]);
    }
    options
}

/// Runs `deform --world` for every case.
fn agrees(name: &str, gpu: bool) {
    let Some(expected) = shared_data(&format!("expected/{name}.expected.json")) else { return };
    let expected = json(&fs::read_to_string(expected).expect("the expected data"));
    let Some(asset) = shared_data(expected["asset"].as_str().expect("a path")) else { return };
    let info = json(&finish(viewer().args(["info", "--json"]).arg(&asset)).ok());
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("all.obj");
    let mut compared = 0;
    for case in expected["cases"].as_array().expect("cases") {
        let mut deform = viewer();
        deform.arg("deform").arg(&asset).args(options_of(case, &info)).args(["--world", "--out"]).arg(&out);
        if gpu {
            deform.arg("--gpu");
        }
        finish(&mut deform).ok();
        let (positions, ..) = read_obj(&out);
        let mut rest = positions.as_slice();
        for part in case["primitives"].as_array().expect("primitives") {
            let what = format!("{name} at {}, {}", case["time"], part["node_name"]);
            let count = part["vertex_count"].as_u64().expect("a number") as usize;
            let (of_part, others) = rest.split_at(count);
            rest = others;
            for axis in 0..3 {
                let along = || of_part.iter().map(|position| position[axis]);
                let is = |found: f64, wanted: &Value, key: &str, tolerance: f64| {
                    let wanted = numbers(wanted)[axis];
                    assert!((found - wanted).abs() <= tolerance, "{what}, {key}: {found} for {wanted}");
                };
                is(along().fold(f64::INFINITY, f64::min), &part["min"], "min", TOLERANCE);
                is(along().fold(f64::NEG_INFINITY, f64::max), &part["max"], "max", TOLERANCE);
                is(along().sum(), &part["sum"], "sum", TOLERANCE * count as f64);
                for (vertex, sample) in part["samples"].as_object().expect("samples") {
                    let found = of_part[vertex.parse::<usize>().expect("a number")][axis];
                    is(found, sample, vertex, TOLERANCE);
                }
            }
            compared += count;
        }
        assert!(rest.is_empty(), "{name}: {} vertices too many", rest.len());
    }
    assert!(compared > 0, "{name}: nothing was compared");
}

const FILES: [&str; 6] = [
    "SimpleMorph",
    "AnimatedMorphCube",
    "MorphPrimitivesTest",
    "SimpleSkin",
    "RiggedSimple",
    "RobotExpressive",
];

#[test]
fn world_space_is_that_of_another_program() {
    FILES.iter().for_each(|name| agrees(name, false));
}

#[test]
fn world_space_is_that_of_another_program_on_the_gpu() {
    if has_adapter() {
        FILES.iter().for_each(|name| agrees(name, true));
    }
}

/// A triangle that a bone turns and a shape lifts: text, and numbers beside it.
fn small(folder: &Path) -> PathBuf {
    let floats: [f32; 18] = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, // positions
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, // a shape: the last corner rises
    ];
    let bytes: Vec<u8> = floats.iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(folder.join("tri.bin"), bytes).expect("written");
    let text = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "Head", "mesh": 0, "rotation": [0, 0.70710678, 0, 0.70710678]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}],
            "extras": {"targetNames": ["jawOpen"]}}],
        "buffers": [{"uri": "tri.bin", "byteLength": 72}],
        "bufferViews": [{"buffer": 0, "byteLength": 72}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC3"}]}"#;
    let path = folder.join("tri.gltf");
    fs::write(&path, text).expect("written");
    path
}

#[test]
fn joints_and_shapes_are_posed_by_the_controls_of_a_face() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (path, out) = (small(folder.path()), folder.path().join("out.obj"));
    let info = finish(viewer().arg("info").arg(&path)).ok();
    for line in ["joint \"Head\" is the head", "1 shapes of ARKit", "head.turn", "jawOpen"] {
        assert!(info.contains(line), "{line}: {info}");
    }
    let mut deform = viewer();
    // The node stands turned by 90° to its left, toward +X; 40° more, and the shape at a half.
    deform
        .arg("deform")
        .arg(&path)
        .args(["--set", "head.turn=40", "--set", "jawOpen=0.5", "--out"])
        .arg(&out);
    finish(&mut deform).ok();
    let (positions, ..) = read_obj(&out);
    let (sin, cos) = 130.0f64.to_radians().sin_cos();
    let wanted = [[0.0, 0.0, 0.0], [cos, 0.0, -sin], [0.0, 1.5, 0.0]];
    for (found, wanted) in positions.iter().zip(wanted) {
        let off = (0..3).map(|i| (found[i] - wanted[i]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-5, "{found:?} for {wanted:?}");
    }
}

#[test]
fn broken_files_and_unknown_formats_are_refused_with_their_place() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = small(folder.path());
    let text = fs::read_to_string(&path).expect("text");
    let with = |from: &str, to: &str| text.replace(from, to).into_bytes();
    for (name, bytes, parts) in [
        ("empty.glb", Vec::new(), ["empty.glb: ", "expected"]),
        ("cut.gltf", text.as_bytes()[..200].to_vec(), ["cut.gltf: ", "expected"]),
        ("lies.gltf", with("\"count\": 3", "\"count\": 3000000000"), ["accessor", "expected"]),
        ("lost.gltf", with("tri.bin", "none.bin"), ["none.bin", "expected"]),
        ("out.gltf", with("tri.bin", "../tri.bin"), ["../tri.bin", "expected"]),
        (
            "what.xyz",
            Vec::new(),
            ["what.xyz: expected the folder of an avatar, or a file that ends in .glb", "found"],
        ),
    ] {
        let bad = folder.path().join(name);
        fs::write(&bad, bytes).expect("written");
        for verb in ["info", "bones"] {
            finish(viewer().arg(verb).arg(&bad)).fails(1, &parts);
        }
    }
    let no_clip = ["expected the name of a clip", "Wave"];
    finish(viewer().arg("bones").arg(&path).args(["--clip", "Wave"])).fails(2, &no_clip);
    finish(viewer().args(["bones", "--clip", "Wave"])).fails(2, &no_clip);
}
