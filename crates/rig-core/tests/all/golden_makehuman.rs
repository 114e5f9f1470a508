//! A real face: six poses that an independent float64 program computed.
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::shared_data;
use rig_core::{Axis, Elementary, RawRig, Rig};
use serde_json::Value;

/// `"JawJoint": [["z", -20.0]]`: axes and degrees, left to right.
fn factors(listed: &Value) -> Vec<Elementary> {
    let factor = |entry: &Value| {
        let axis = match entry[0].as_str().unwrap() {
            "x" => Axis::X,
            "y" => Axis::Y,
            "z" => Axis::Z,
            other => panic!("axis {other}"),
        };
        Elementary::rotation(axis, (entry[1].as_f64().unwrap() as f32).to_radians())
    };
    listed.as_array().unwrap().iter().map(factor).collect()
}

#[test]
fn six_poses_of_a_real_face_agree_to_a_ten_thousandth() {
    let Some(data) = shared_data() else { return };
    let xml = std::fs::read(data.join("avatar-course-format-makehuman/Transformationen.xml")).unwrap();
    let expected: Value =
        serde_json::from_slice(&std::fs::read(data.join("expected/makehuman.expected.json")).unwrap())
            .unwrap();
    let rig = Rig::from_xml(&xml).unwrap();
    assert_eq!(rig.len(), 9);
    // Through the writer as well: the same rig, so the same results.
    let rewritten = RawRig::from_xml(&xml).unwrap().to_xml().unwrap();
    let mut compared = 0;
    let cases = expected["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 6);
    for rig in [rig, Rig::from_xml(rewritten.as_bytes()).unwrap()] {
        for case in cases {
            let mut locals = rig.locals();
            for (joint, listed) in case["rotations"].as_object().unwrap() {
                locals.set_product(rig.joint(joint).unwrap(), &factors(listed)).unwrap();
            }
            let mut pose = rig.pose();
            rig.update(locals.as_slice(), &mut pose).unwrap();
            for joint in rig.joints() {
                let (i, name) = (joint.index(), &rig.names()[joint.index()]);
                let mut check = |found: f32, expected: &Value| {
                    let expected = expected.as_f64().unwrap();
                    let difference = (f64::from(found) - expected).abs();
                    assert!(
                        difference <= 1e-4,
                        "{} {name}: expected {expected}, found {found}",
                        case["pose"]
                    );
                    compared += 1;
                };
                let t = pose.world_from_joint()[i].translation.to_array();
                (0..3).for_each(|k| check(t[k], &case["joint_world_translation"][name][k]));
                let x = glam::Mat4::from(pose.posed_from_bind()[i]).transpose().to_cols_array();
                (0..16).for_each(|k| check(x[k], &case["skin_matrices_rowmajor"][name][k]));
            }
        }
    }
    assert_eq!(compared, 2 * 6 * 9 * 19);
}
