//! Expressions and looks of a VRM in the window, by real keys and the pointer. What is expected is drawn from
//! weights of single shapes, which were worked out by hand from the formulas of the format.

use crate::common;
use crate::desk::{Desk, can_run, difference, key_of, render};
use std::path::Path;

const SHAPES: [&str; 5] = ["mouthSmileLeft", "mouthSmileRight", "lids", "side", "up"];

/// A square whose corners are moved by shapes, below a head that turns nothing: only expressions look, and
/// that to the full from one degree on.
fn write_vrm(path: &Path) {
    let bind = |shape: usize| format!(r#"{{"node": 2, "index": {shape}, "weight": 1.0}}"#);
    let range = |scale: f32| format!(r#"{{"inputMaxValue": 1.0, "outputScale": {scale}}}"#);
    let target = |shape: usize| format!(r#"{{"POSITION": {}}}"#, shape + 1);
    let vrm = format!(
        r#"{{"specVersion": "1.0", "meta": {{"name": "N", "authors": ["A"], "licenseUrl": ""}},
        "humanoid": {{"humanBones": {{"hips": {{"node": 0}}, "head": {{"node": 1}}}}}},
        "lookAt": {{"type": "expression", "offsetFromHeadBone": [0, 0, 0], "rangeMapHorizontalInner": {0},
            "rangeMapHorizontalOuter": {1}, "rangeMapVerticalDown": {0}, "rangeMapVerticalUp": {2}}},
        "expressions": {{"preset": {{
            "blink": {{"morphTargetBinds": [{3}]}},
            "lookLeft": {{"morphTargetBinds": [{4}]}}, "lookUp": {{"morphTargetBinds": [{5}]}}}},
          "custom": {{"smile": {{"morphTargetBinds": [{6}, {7}], "overrideBlink": "blend",
            "overrideLookAt": "block"}}}}}}}}"#,
        range(1.0),
        range(0.75),
        range(0.5),
        bind(2),
        bind(3),
        bind(4),
        bind(0),
        bind(1)
    );
    let corners = [[0.0f32, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let mut bin: Vec<u8> = corners.iter().flat_map(|[x, y]| floats([*x, *y, 0.0])).collect();
    let moved =
        [(1, [0.5, -0.25]), (5, [-0.5, 0.5]), (0, [-0.75, -0.5]), (2, [0.25, 0.75]), (4, [-0.5, -0.25])];
    for (corner, [x, y]) in moved {
        bin.extend((0..6).flat_map(|at| if at == corner { floats([x, y, 0.0]) } else { floats([0.0; 3]) }));
    }
    let views: Vec<String> =
        (0..6).map(|at| format!(r#"{{"buffer": 0, "byteOffset": {}, "byteLength": 72}}"#, 72 * at)).collect();
    let accessors: Vec<String> = (0..6)
        .map(|at| format!(r#"{{"bufferView": {at}, "componentType": 5126, "type": "VEC3", "count": 6}}"#))
        .collect();
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsUsed": ["VRMC_vrm"], "extensions": {{"VRMC_vrm": {vrm}}},
        "buffers": [{{"byteLength": {}}}], "bufferViews": [{}], "accessors": [{}],
        "nodes": [{{"name": "hips", "children": [1, 2]}}, {{"name": "head", "translation": [1, 1, 0]}},
            {{"name": "face", "mesh": 0}}],
        "meshes": [{{"extras": {{"targetNames": {SHAPES:?}}},
            "primitives": [{{"attributes": {{"POSITION": 0}}, "targets": [{}]}}]}}]}}"#,
        bin.len(),
        views.join(", "),
        accessors.join(", "),
        [0, 1, 2, 3, 4].map(target).join(", ")
    );
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let word = |number: usize| u32::try_from(number).expect("a small file").to_le_bytes();
    let mut glb = [b"glTF".to_vec(), word(2).to_vec(), word(28 + json.len() + bin.len()).to_vec()].concat();
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &bin)] {
        glb.extend([&word(chunk.len())[..], kind, chunk].concat());
    }
    std::fs::write(path, glb).expect("written");
}

fn floats(values: [f32; 3]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

#[test]
fn expressions_hold_each_other_back_and_look_at_the_pointer() {
    if !can_run() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("face.vrm");
    write_vrm(&path);
    let options = [path.to_str().expect("a plain path"), "--size", "320x240", "--quality", "plain"];
    // The weights of the shapes in their order, as single controls that no expression touches.
    let shapes = |weights: [f32; 5]| {
        let settings = SHAPES.iter().zip(weights).map(|(shape, weight)| format!("--set={shape}={weight}"));
        let settings: Vec<String> = settings.collect();
        render(&options.into_iter().chain(settings.iter().map(String::as_str)).collect::<Vec<_>>())
    };
    let at_rest = shapes([0.0; 5]);
    // A smile of three quarters leaves a quarter of the blink.
    let mixed = shapes([0.75, 0.75, 0.25, 0.0, 0.0]);
    let looking = shapes([0.0, 0.0, 0.0, 0.75, 0.5]);
    let smiling = shapes([1.0, 1.0, 0.0, 0.0, 0.0]);
    let all = [&at_rest, &mixed, &looking, &smiling];
    for (at, one) in all.iter().enumerate() {
        assert!(
            all[..at].iter().all(|other| difference(one, other) != Some(0)),
            "picture {at} is like another"
        );
    }

    let pose = ["--pose", "smile:0.75 blink"];
    assert_eq!(difference(&render(&[&options[..], &pose].concat()), &mixed), Some(0), "in a picture");
    let set = ["--set", "expression.smile=0.75", "--set", "expression.blink=1"];
    assert_eq!(difference(&render(&[&options[..], &set].concat()), &mixed), Some(0), "by single controls");
    // `deform` moves the vertices as far: the corner of the lids is a quarter of its way from its place.
    let file = folder.path().join("face.obj");
    let deform = [&["deform"][..], &options[..1], &pose, &["--out", file.to_str().expect("a path")]].concat();
    common::run(&deform).ok();
    let text = std::fs::read_to_string(&file).expect("an OBJ");
    let first = text.lines().find_map(|line| line.strip_prefix("v ")).expect("a vertex");
    let first: Vec<f32> = first.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    assert_eq!(first, [-0.1875, -0.125, 0.0]);

    let mut desk = Desk::open(&[&options[..], &pose].concat());
    desk.shows(&mixed, "the mixture of the command line");
    desk.key(&key_of("neutral"));
    desk.shows(&at_rest, "at rest");
    // To the right and up, seen from outside: the character's left.
    desk.point(310, 10);
    desk.key("g");
    desk.shows(&looking, "eyes that follow the pointer by expressions");
    desk.key(&key_of("smile"));
    desk.shows(&smiling, "an expression that keeps the eyes from looking");
    desk.key(&key_of("neutral"));
    desk.shows(&looking, "looking again");
    desk.key("g");
    desk.shows(&at_rest, "ahead again");
    desk.key("Escape");
    desk.closes();
}
