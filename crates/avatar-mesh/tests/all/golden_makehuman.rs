//! A real face in six poses, with the bone matrices of an independent float64 program, against its vertices.
//! (Bone matrices from the rig and vertices together are compared in the tests across crates.)
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::shared_data;
use avatar_mesh::{Bounds, FACE_BONES, deform, raw};
use glam::{Affine3A, Mat4, Vec3};
use serde_json::Value;

const TOLERANCE: f64 = 1e-4;

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

#[track_caller]
fn close(what: &str, found: Vec3, expected: &Value, tolerance: f64) {
    let expected = numbers(expected);
    assert_eq!(expected.len(), 3);
    for (found, expected) in found.to_array().into_iter().zip(expected) {
        assert!(
            (f64::from(found) - expected).abs() <= tolerance,
            "{what}: expected {expected}, found {found}"
        );
    }
}

#[test]
fn six_poses_of_a_real_face_agree_to_a_ten_thousandth() {
    let Some(data) = shared_data() else { return };
    let read = |name: &str| std::fs::read(data.join(name)).unwrap();
    let skin = |kind: &str| read(&format!("avatar-course-format-makehuman/MarsienneSkin_{kind}.raw"));
    let mut mesh = raw::read_skin(&skin("VB"), &skin("IB")).unwrap();
    mesh.validate(FACE_BONES.len()).unwrap();
    let golden: Value = serde_json::from_slice(&read("expected/makehuman.expected.json")).unwrap();
    let cases = golden["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 6);
    let mut compared = 0;
    for case in cases {
        let bones = FACE_BONES.map(|name| {
            let rows = numbers(&case["skin_matrices_rowmajor"][name]);
            let rows: [f32; 16] = std::array::from_fn(|i| rows[i] as f32);
            Affine3A::from_mat4(Mat4::from_cols_array(&rows).transpose())
        });
        let weights = ["SSmile", "Frown"].map(|shape| case[shape].as_f64().unwrap() as f32);
        let mut out = mesh.deformed();
        deform(&mesh, &bones, &weights, &mut out).unwrap();

        let pose = case["pose"].as_str().unwrap();
        let bounds = Bounds::of(&out.positions).unwrap();
        close(&format!("{pose}: min"), bounds.min, &case["skin_min"], TOLERANCE);
        close(&format!("{pose}: max"), bounds.max, &case["skin_max"], TOLERANCE);
        let moved = out.positions.iter().zip(&mesh.positions).map(|(a, b)| a.distance(*b));
        let most = f64::from(moved.fold(0.0, f32::max));
        assert!((most - case["max_move"].as_f64().unwrap()).abs() <= TOLERANCE, "{pose}: max_move {most}");
        for (vertex, expected) in case["vertices"].as_object().unwrap() {
            let i: usize = vertex.parse().unwrap();
            close(&format!("{pose}: vertex {vertex}"), out.positions[i], &expected["p"], TOLERANCE);
            close(&format!("{pose}: normal {vertex}"), out.normals[i], &expected["n"], TOLERANCE);
            compared += 1;
        }
        // The sum tells of all vertices. Rounding goes both ways and the six printed digits of the matrices
        // weigh less; were every vertex off by 1e-6 in the same direction, one step of f32 at these
        // coordinates and a hundredth of what a single one may be, the sum would be off by this much.
        let sum: [f64; 3] = std::array::from_fn(|k| out.positions.iter().map(|p| f64::from(p[k])).sum());
        let tolerance = 1e-6 * mesh.positions.len() as f64;
        for (found, expected) in sum.into_iter().zip(numbers(&case["skin_sum"])) {
            assert!((found - expected).abs() <= tolerance, "{pose}: sum: expected {expected}, found {found}");
        }
    }
    assert_eq!(compared, 6 * 8);
}
