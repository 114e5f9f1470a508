//! `bones` and `deform`, on the CPU and on the GPU, against data that another program computed.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{close, finish, golden_pack, has_adapter, json, numbers, read_obj, real_face, viewer};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// The options that bring about a case of the expected data.
fn options_of(case: &Value) -> Vec<String> {
    let mut options = Vec::new();
    for (joint, rotations) in case["rotations"].as_object().expect("rotations") {
        let factor = |r: &Value| format!("{}:{}", r[0].as_str().expect("an axis"), r[1]);
        let factors: Vec<_> = rotations.as_array().expect("a list").iter().map(factor).collect();
        options.extend(["--rotate".to_owned(), format!("{joint}={}", factors.join(","))]);
    }
    options.extend(["--set".to_owned(), format!("smile={}", case["SSmile"])]);
    options.extend(["--set".to_owned(), format!("frown={}", case["Frown"])]);
    options
}

/// `bones` and `deform` against data that another program computed.
fn agrees_with_expected_data(pack: &Path, expected: &Path, gpu: bool) {
    let expected = json(&fs::read_to_string(expected).expect("the expected data"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("skin.obj");
    let mut compared = 0;
    for case in expected["cases"].as_array().expect("cases") {
        let name = case["pose"].as_str().expect("a name");
        // The library extrapolates (tests/tests/golden.rs); the command line keeps to the controls' ranges.
        if ["SSmile", "Frown"]
            .iter()
            .any(|shape| !(0.0..=1.0).contains(&case[shape].as_f64().expect("a weight")))
        {
            continue;
        }
        compared += 1;
        let options = options_of(case);
        let bones = json(&finish(viewer().arg("bones").arg(pack).args(&options)).ok());
        for joint in bones["joints"].as_array().expect("joints") {
            let joint_name = joint["name"].as_str().expect("a name");
            let what = format!("{name}, {joint_name}");
            close(&numbers(&joint["skin"]), &numbers(&case["skin_matrices_rowmajor"][joint_name]), &what);
            let world = numbers(&joint["world"]);
            close(
                &[world[3], world[7], world[11]],
                &numbers(&case["joint_world_translation"][joint_name]),
                &what,
            );
        }
        let mut deform = viewer();
        deform.arg("deform").arg(pack).args(&options).args(["--part", "skin", "--out"]).arg(&out);
        if gpu {
            deform.arg("--gpu");
        }
        finish(&mut deform).ok();
        let (positions, normals, _) = read_obj(&out);
        let extreme = |pick: fn(f64, f64) -> f64| -> Vec<f64> {
            (0..3).map(|axis| positions.iter().map(|p| p[axis]).reduce(pick).expect("vertices")).collect()
        };
        close(&extreme(f64::min), &numbers(&case["skin_min"]), name);
        close(&extreme(f64::max), &numbers(&case["skin_max"]), name);
        let mean: Vec<f64> = (0..3)
            .map(|axis| positions.iter().map(|p| p[axis]).sum::<f64>() / positions.len() as f64)
            .collect();
        let expected_mean: Vec<_> =
            numbers(&case["skin_sum"]).iter().map(|x| x / positions.len() as f64).collect();
        close(&mean, &expected_mean, name);
        for (vertex, expected) in case["vertices"].as_object().expect("vertices") {
            let vertex: usize = vertex.parse().expect("a number");
            close(&positions[vertex], &numbers(&expected["p"]), name);
            close(&normals[vertex], &numbers(&expected["n"]), name);
        }
    }
    assert!(compared >= 6, "only {compared} cases were compared");
}

fn golden_expected() -> PathBuf {
    golden_pack().join("../expected.json")
}

#[test]
fn bones_and_deform_agree_with_the_golden_pack() {
    agrees_with_expected_data(&golden_pack(), &golden_expected(), false);
}

#[test]
fn gpu_deform_agrees_with_the_golden_pack() {
    if has_adapter() {
        agrees_with_expected_data(&golden_pack(), &golden_expected(), true);
    }
}

#[test]
fn bones_and_deform_agree_with_the_real_face() {
    let Some(face) = real_face() else { return };
    let expected = face.join("../expected/makehuman.expected.json");
    agrees_with_expected_data(&face, &expected, false);
    if has_adapter() {
        agrees_with_expected_data(&face, &expected, true);
    }
}
