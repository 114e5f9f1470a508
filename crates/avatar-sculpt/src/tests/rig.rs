use std::collections::BTreeMap;

use glam::{DMat3, DMat4, DVec3};

use super::file;
use crate::anatomy::{EYE, HEAD, JAW, NECK};

/// Local bind matrices by joint.
fn local() -> BTreeMap<String, DMat4> {
    let text = std::str::from_utf8(file("Transformations.xml")).unwrap();
    text.split("<Joint name=\"")
        .skip(1)
        .map(|part| {
            let name = part.split('"').next().unwrap().to_owned();
            let body = part.split("<Matrix transposed=\"true\">").nth(1).unwrap().split('<').next().unwrap();
            let n: Vec<f64> = body.split_whitespace().map(|s| f64::from(s.parse::<f32>().unwrap())).collect();
            (name, DMat4::from_cols_slice(&n))
        })
        .collect()
}

fn world(name: &str) -> DMat4 {
    let local = local();
    let neck = local["NeckJoint"];
    let head = neck * local["HeadJoint"];
    match name {
        "NeckJoint" => neck,
        "HeadJoint" => head,
        _ => head * local[name],
    }
}

#[test]
fn bind_matrices_are_rigid() {
    assert_eq!(local().len(), 9);
    for (name, m) in local() {
        let r = DMat3::from_mat4(m);
        assert!((r.transpose() * r).abs_diff_eq(DMat3::IDENTITY, 3e-7), "{name}");
        assert!((r.determinant() - 1.0).abs() < 3e-7, "{name}");
        assert_eq!(m.row(3), glam::DVec4::W, "{name}");
    }
}

#[test]
fn joints_stand_where_the_anatomy_says() {
    let right = DVec3::new(-EYE.x, EYE.y, EYE.z);
    let places = [
        ("NeckJoint", NECK),
        ("HeadJoint", HEAD),
        ("JawJoint", JAW),
        ("LtEyeJoint", EYE),
        ("RtEyeJoint", right),
        ("LtUpperLidJoint", EYE),
        ("RtUpperLidJoint", right),
        ("LtLowerLidJoint", EYE),
        ("RtLowerLidJoint", right),
    ];
    for (name, place) in places {
        assert!(world(name).w_axis.truncate().distance(place) < 1e-5, "{name}");
    }
}

/// Where a small turn about a local axis takes a point.
fn turned(name: &str, axis: DVec3, p: DVec3) -> DVec3 {
    let w = world(name);
    let turn = DMat4::from_axis_angle(axis, 0.1);
    (w * turn * w.inverse()).transform_point3(p) - p
}

#[test]
fn positive_angles_move_as_the_controls_say() {
    let nose = DVec3::new(0.0, -2.0, 6.0);
    let chin = DVec3::new(0.0, -9.0, 4.0);
    let top = DVec3::new(0.0, 12.0, -5.0);
    assert!(turned("HeadJoint", DVec3::X, nose).x > 0.5, "turn");
    assert!(turned("HeadJoint", DVec3::Y, nose).y < -0.5, "bow");
    assert!(turned("HeadJoint", DVec3::Z, top).x > 0.5, "bend");
    assert!(turned("JawJoint", -DVec3::Z, chin).y < -0.5, "open");
    assert!(turned("JawJoint", DVec3::Y, chin).x > 0.3, "jut");
    for (side, sign) in [("Lt", 1.0), ("Rt", -1.0)] {
        let pupil = DVec3::new(sign * EYE.x, EYE.y, EYE.z + 1.8);
        let at = |joint: &str, axis| turned(&format!("{side}{joint}Joint"), axis, pupil);
        assert!(at("Eye", DVec3::Z).y > 0.1, "{side} up");
        assert!(at("Eye", DVec3::Y).x > 0.1, "{side} left");
        assert!(at("UpperLid", -DVec3::Z).y < -0.1, "{side} upper closes");
        assert!(at("LowerLid", DVec3::Z).y > 0.1, "{side} lower closes");
    }
    let half_turn = DMat4::from_rotation_z(std::f64::consts::PI);
    for lid in ["UpperLid", "LowerLid"] {
        let (left, right) = (world(&format!("Lt{lid}Joint")), world(&format!("Rt{lid}Joint")));
        let (left, right) = (DMat3::from_mat4(left * half_turn), DMat3::from_mat4(right));
        assert!(left.abs_diff_eq(right, 1e-6), "{lid}");
    }
}
