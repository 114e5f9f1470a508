//! Published glTF files against what an independent program in f64 computed from them.

use crate::support::data::shared_data;
use crate::support::gltf::read_file;
use avatar_exchange::{Scene, ScenePose};
use avatar_mesh::deform;
use glam::DVec3;
use serde_json::Value;

const TOLERANCE: f64 = 1e-4;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn close(found: DVec3, expected: &Value, tolerance: f64, what: &str) {
    let expected = DVec3::from_slice(&numbers(expected));
    let off = (found - expected).abs().max_element();
    assert!(off <= tolerance, "{what}: expected {expected}, found {found}");
}

/// The scene as a case of the expected data has it.
fn pose(scene: &Scene, case: &Value) -> ScenePose {
    let mut pose = match case["animation"].as_u64() {
        None => scene.rest(),
        Some(clip) => scene.at(clip as usize, case["time"].as_f64().expect("a time")).expect("a clip"),
    };
    if let Some(weights) = case["override_weights"].as_array() {
        for of_node in pose.weights.iter_mut().filter(|of_node| of_node.len() == weights.len()) {
            *of_node = numbers(&Value::Array(weights.clone())).iter().map(|x| *x as f32).collect();
        }
    }
    pose
}

/// Number of vertices that were compared.
fn agrees(name: &str) -> usize {
    let Some(expected) = shared_data(&format!("expected/{name}.expected.json")) else { return 0 };
    let expected: Value =
        serde_json::from_slice(&std::fs::read(&expected).expect("expected data")).expect("JSON");
    let Some(asset) = shared_data(expected["asset"].as_str().expect("a path")) else { return 0 };
    let scene = read_file(&asset).unwrap_or_else(|error| panic!("{error}"));
    let mut vertices = 0;
    for case in expected["cases"].as_array().expect("cases") {
        let what = format!("{name}, {} at {}", case["animation_name"], case["time"]);
        let pose = pose(&scene, case);
        let bones = scene.bones(&pose);
        let primitives = case["primitives"].as_array().expect("primitives");
        assert_eq!(primitives.len(), scene.parts.len(), "{what}");
        for (number, (part, expected)) in scene.parts.iter().zip(primitives).enumerate() {
            let what = format!("{what}, {} {}", part.name, part.primitive);
            assert_eq!(expected["node"], part.node, "{what}");
            assert_eq!(expected["primitive"], part.primitive, "{what}");
            if let Some(name) = expected["node_name"].as_str() {
                assert_eq!(name, scene.nodes[part.node].name, "{what}");
            }
            let weights = scene.weights_of(number, &pose);
            let expected_weights = numbers(&expected["morph_weights"]);
            assert_eq!(weights.len(), expected_weights.len(), "{what}");
            for (weight, expected) in weights.iter().zip(expected_weights) {
                assert!((f64::from(*weight) - expected).abs() <= TOLERANCE, "{what}: {weights:?}");
            }
            let mut deformed = part.mesh.deformed();
            deform(&part.mesh, scene.bones_of(number, &bones), weights, &mut deformed).expect("it fits");
            let positions: Vec<_> = deformed.positions.iter().map(|p| p.as_dvec3()).collect();
            assert_eq!(expected["vertex_count"], positions.len(), "{what}");
            close(
                positions.iter().sum(),
                &expected["sum"],
                TOLERANCE * positions.len() as f64,
                &format!("{what}, sum"),
            );
            let least = positions.iter().copied().reduce(DVec3::min).expect("vertices");
            let most = positions.iter().copied().reduce(DVec3::max).expect("vertices");
            close(least, &expected["min"], TOLERANCE, &format!("{what}, min"));
            close(most, &expected["max"], TOLERANCE, &format!("{what}, max"));
            for (vertex, sample) in expected["samples"].as_object().expect("samples") {
                let found = positions[vertex.parse::<usize>().expect("a number")];
                close(found, sample, TOLERANCE, &format!("{what}, vertex {vertex}"));
            }
            vertices += positions.len();
        }
    }
    assert!(vertices > 0, "{name}: nothing was compared");
    vertices
}

#[test]
fn simple_morph() {
    agrees("SimpleMorph");
}

#[test]
fn animated_morph_cube() {
    agrees("AnimatedMorphCube");
}

#[test]
fn morph_primitives() {
    agrees("MorphPrimitivesTest");
}

#[test]
fn simple_skin() {
    agrees("SimpleSkin");
}

#[test]
fn rigged_simple() {
    agrees("RiggedSimple");
}

#[test]
fn robot_expressive() {
    agrees("RobotExpressive");
}

/// What the files carry beside geometry.
#[test]
fn looks_and_names_arrive() {
    let Some(data) = shared_data("khronos-gltf") else { return };
    let scene = read_file(&data.join("MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf")).expect("a scene");
    assert!(scene.images[0].bytes.starts_with(&[0xff, 0xd8]), "a JPEG, not decoded");
    let textured = scene.materials.iter().filter(|material| material.base_color_texture == Some(0.into()));
    assert_eq!(textured.count(), 2, "{:?}", scene.materials);

    let Some(data) = shared_data("robot-expressive") else { return };
    let scene = read_file(&data.join("RobotExpressive.glb")).expect("a scene");
    let names: Vec<_> = scene.clips.iter().map(|clip| clip.name.as_str()).collect();
    assert!(names.contains(&"Wave") && names.len() == 14, "{names:?}");
    let head = scene.parts.iter().find(|part| !part.mesh.shapes.is_empty()).expect("a face");
    let shapes: Vec<_> = head.mesh.shapes.iter().map(|shape| shape.name.as_str()).collect();
    assert_eq!(shapes, ["Angry", "Surprised", "Sad"]);
    let grey = &scene.materials[0];
    assert_eq!((grey.name.as_str(), grey.metallic, grey.roughness), ("Grey", 0.1, 0.9));
}
