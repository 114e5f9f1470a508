//! Nodes that mirror (glTF 2.0, section 3.7.4): fronts stay fronts in pictures and in what is written, for
//! rigid and skinned parts, at rest and where a clip turns a scale negative.

use crate::common::{finish, has_adapter, read_obj, viewer};
use std::fs;
use std::path::{Path, PathBuf};

/// What mirrors the square, if anything.
#[derive(Clone, Copy)]
enum By {
    Nothing,
    Node,
    Joint,
    Clip,
}

/// A file with a square of two units that looks along +Z, with its normals.
fn square(folder: &Path, by: By) -> PathBuf {
    let corners = [[-1.0f32, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut floats: Vec<f32> = corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]).collect();
    floats.extend([[0.0, 0.0, 1.0]; 4].concat());
    // Weights of one joint, then the times and scales of a clip.
    floats.extend([[1.0, 0.0, 0.0, 0.0]; 4].concat());
    floats.extend([0.0, 1.0, 1.0, 1.0, 1.0, -1.0, 1.0, 1.0]);
    let mut bytes: Vec<u8> = floats.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0, 1, 2, 0, 2, 3u16].iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend([0u8; 16]);
    fs::write(folder.join("square.bin"), &bytes).expect("written");
    let mirror = r#""scale": [-1, 1, 1]"#;
    let (nodes, more) = match by {
        By::Nothing => (r#"{"mesh": 0}"#.to_owned(), ""),
        By::Node => (format!(r#"{{"mesh": 0, {mirror}}}"#), ""),
        By::Joint => {
            (format!(r#"{{"mesh": 0, "skin": 0}}, {{{mirror}}}"#), r#", "skins": [{"joints": [1]}]"#)
        }
        By::Clip => (
            r#"{"mesh": 0}"#.to_owned(),
            r#", "animations": [{"name": "flip", "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}],
                "samplers": [{"input": 3, "output": 4, "interpolation": "STEP"}]}]"#,
        ),
    };
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{nodes}],
        "meshes": [{{"primitives": [{{"indices": 5,
            "attributes": {{"POSITION": 0, "NORMAL": 1, "WEIGHTS_0": 2, "JOINTS_0": 6}}}}]}}],
        "buffers": [{{"uri": "square.bin", "byteLength": {length}}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {length}}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}},
            {{"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC3"}},
            {{"bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 4, "type": "VEC4"}},
            {{"bufferView": 0, "byteOffset": 160, "componentType": 5126, "count": 2, "type": "SCALAR"}},
            {{"bufferView": 0, "byteOffset": 168, "componentType": 5126, "count": 2, "type": "VEC3"}},
            {{"bufferView": 0, "byteOffset": 192, "componentType": 5123, "count": 6, "type": "SCALAR"}},
            {{"bufferView": 0, "byteOffset": 204, "componentType": 5121, "count": 4, "type": "VEC4"}}]{more}}}"#,
        length = bytes.len(),
    );
    let path = folder.join("square.gltf");
    fs::write(&path, text).expect("written");
    path
}

fn options(by: By) -> &'static [&'static str] {
    match by {
        By::Clip => &["--clip", "flip", "--time", "1"],
        _ => &[],
    }
}

/// Every face of an OBJ runs counter-clockwise around its normals, and is as large as a half of the square.
fn fronts_are_outside(path: &Path, what: &str) {
    let (positions, normals, faces) = read_obj(path);
    assert_eq!(faces.len(), 2, "{what}");
    for face in faces {
        let corner = |text: &str| {
            let numbers: Vec<usize> =
                text.split('/').filter(|x| !x.is_empty()).map(|x| x.parse().expect("a number")).collect();
            (positions[numbers[0] - 1].clone(), normals[numbers[numbers.len() - 1] - 1].clone())
        };
        let corners: Vec<_> = face.split(' ').skip(1).map(corner).collect();
        let [(a, n), (b, _), (c, _)] = &corners[..] else { panic!("{what}: {face}") };
        let across = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert!((across * n[2] - 4.0).abs() < 1e-6 && n[2] > 0.999, "{what}: {face}: {across}, {n:?}");
    }
}

#[test]
fn what_is_written_has_its_fronts_outside() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (obj, glb) = (folder.path().join("out.obj"), folder.path().join("out.glb"));
    for (number, by) in [By::Nothing, By::Node, By::Joint, By::Clip].into_iter().enumerate() {
        let path = square(folder.path(), by);
        let mut ways = vec![vec!["--world"], vec![]];
        if has_adapter() {
            ways.push(vec!["--world", "--gpu"]);
        }
        for way in ways {
            let mut deform = viewer();
            deform.arg("deform").arg(&path).args(&way).args(options(by)).arg("--out").arg(&obj);
            finish(&mut deform).ok();
            fronts_are_outside(&obj, &format!("deform, {number} {way:?}"));
            fs::remove_file(&obj).expect("removed");
        }
        finish(viewer().arg("convert").arg(&path).args(options(by)).arg("--out").arg(&obj)).ok();
        fronts_are_outside(&obj, &format!("convert, {number}"));
        fs::remove_file(&obj).expect("removed");
        finish(viewer().arg("convert").arg(&path).arg("--out").arg(&glb)).ok();
        finish(viewer().arg("deform").arg(&glb).args(options(by)).args(["--world", "--out"]).arg(&obj)).ok();
        fronts_are_outside(&obj, &format!("through GLB, {number}"));
        fs::remove_file(&obj).expect("removed");
        fs::remove_file(&glb).expect("removed");
    }
}

#[test]
fn a_mirrored_square_looks_as_the_square_does() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let picture = |by: By, style: &str| {
        let (path, out) = (square(folder.path(), by), folder.path().join("out.png"));
        let mut render = viewer();
        render.arg("render").arg(&path).args(options(by));
        finish(render.args(["--size", "64x64", "--style", style, "--out"]).arg(&out)).ok();
        image::open(&out).expect("a PNG").into_rgba8()
    };
    for style in ["natural", "toon"] {
        let plain = picture(By::Nothing, style);
        for (number, by) in [By::Node, By::Joint, By::Clip].into_iter().enumerate() {
            let mirrored = picture(by, style);
            let worst = plain.iter().zip(mirrored.iter()).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(worst <= Some(1), "{style}, {number}: {worst:?}");
        }
    }
}
