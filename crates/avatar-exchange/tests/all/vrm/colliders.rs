//! Planes and hollow colliders: `VRMC_springBone_extended_collider`.

use super::read;
use avatar_exchange::vrm::ColliderShape;
use glam::Vec3;
use serde_json::{Value, json};

/// The avatar of `body`, whose first collider also has a form of the extension.
fn with_extended(extension: Value) -> Value {
    let mut json = super::body::v1();
    json["extensions"]["VRMC_springBone"]["colliders"][0]["extensions"] =
        json!({ "VRMC_springBone_extended_collider": extension });
    json["extensionsUsed"].as_array_mut().expect("a list").push(json!("VRMC_springBone_extended_collider"));
    json
}

fn of_shape(shape: Value) -> Value {
    with_extended(json!({ "specVersion": "1.0", "shape": shape }))
}

#[test]
fn forms_of_the_extension_take_the_place_of_the_others() {
    let (at, up) = (Vec3::new(0.5, 0.25, -1.0), Vec3::new(0.0, 1.0, 0.0));
    for (shape, expected) in [
        (
            json!({ "sphere": { "offset": [0.5, 0.25, -1.0], "radius": 2.0, "inside": true } }),
            ColliderShape::Sphere { offset: at, radius: 2.0, inside: true },
        ),
        (
            json!({ "sphere": { "radius": 2.0 } }),
            ColliderShape::Sphere { offset: Vec3::ZERO, radius: 2.0, inside: false },
        ),
        (
            json!({ "capsule": { "radius": 2.0, "tail": [0.5, 0.25, -1.0], "inside": true } }),
            ColliderShape::Capsule { offset: Vec3::ZERO, tail: at, radius: 2.0, inside: true },
        ),
        (
            json!({ "plane": { "offset": [0.5, 0.25, -1.0], "normal": [0.0, 1.0, 0.0] } }),
            ColliderShape::Plane { offset: at, normal: up },
        ),
        // The standard's default.
        (json!({ "plane": {} }), ColliderShape::Plane { offset: Vec3::ZERO, normal: Vec3::Z }),
    ] {
        let model = read(&of_shape(shape.clone())).expect("a VRM");
        let found = model.vrm.springs.colliders[0];
        assert_eq!((found.node, found.shape), (1, expected), "{shape}");
        // Nothing of it is left out, so nothing is told.
        let told = model.scene.notes.iter().map(ToString::to_string).find(|note| note.contains("ollider"));
        assert_eq!(told, None);
    }
}

#[test]
fn hollow_shapes_are_no_part_of_the_plain_form() {
    let mut json = super::body::v1();
    json["extensions"]["VRMC_springBone"]["colliders"][0]["shape"]["sphere"]["inside"] = json!(true);
    let model = read(&json).expect("a VRM");
    let ColliderShape::Sphere { inside, .. } = model.vrm.springs.colliders[0].shape else {
        panic!("a sphere");
    };
    assert!(!inside);
}

#[test]
fn another_version_leaves_the_plain_form_with_a_note() {
    let model =
        read(&with_extended(json!({ "specVersion": "2.0", "shape": { "plane": {} } }))).expect("a VRM");
    let sphere = ColliderShape::Sphere { offset: Vec3::new(0.0, 0.1, 0.0), radius: 0.125, inside: false };
    assert_eq!(model.vrm.springs.colliders[0].shape, sphere);
    let expected = "extensions.VRMC_springBone.colliders[0]: expected version 1.0, found \"2.0\": its other form is taken";
    let notes: Vec<String> = model.scene.notes.iter().map(ToString::to_string).collect();
    assert!(notes.iter().any(|note| note == expected), "{notes:?}");
}

#[test]
fn mistakes_in_the_extension_are_told_with_their_place() {
    let place =
        "face.vrm: extensions.VRMC_springBone.colliders[0].extensions.VRMC_springBone_extended_collider";
    for (shape, expected) in [
        (json!({}), "shape: expected one of a sphere, a capsule and a plane, found {}"),
        (
            json!({ "sphere": {}, "plane": {} }),
            "shape: expected one of a sphere, a capsule and a plane, found",
        ),
        (json!({ "sphere": { "inside": 1 } }), "shape.sphere.inside: expected true or false, found 1"),
        (json!({ "plane": { "normal": [0, 1] } }), "shape.plane.normal: expected three numbers, found [0,1]"),
    ] {
        let told = read(&of_shape(shape)).expect_err(expected).to_string();
        assert!(told.starts_with(&format!("{place}.{expected}")), "{told}\n{expected}");
    }
}
