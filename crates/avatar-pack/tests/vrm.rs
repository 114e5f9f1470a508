//! Avatars from VRM: bones by the file's own word, expressions as poses.
#![cfg(feature = "vrm")]
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_pack::{FaceState, Import, Role};

/// Two faces that share shapes of the same names, and bones whose names say nothing.
const VRM: &str = r#"{"asset": {"version": "2.0"}, "extensionsUsed": ["VRMC_vrm"],
    "extensions": {"VRMC_vrm": {"specVersion": "1.0",
        "meta": {"name": "Nina", "authors": ["A"], "licenseUrl": "https://vrm.dev/licenses/1.0/"},
        "humanoid": {"humanBones": {"hips": {"node": 0}, "head": {"node": 1}, "leftEye": {"node": 2}}},
        "expressions": {"preset": {
            "happy": {"morphTargetBinds": [{"node": 1, "index": 0, "weight": 1.0}, {"node": 1, "index": 1, "weight": 0.5}]},
            "angry": {"morphTargetBinds": [{"node": 2, "index": 1, "weight": 0.25}]}}}}},
    "nodes": [{"name": "a", "children": [1]}, {"name": "b", "mesh": 0, "children": [2]}, {"name": "c", "mesh": 0}],
    "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}, {"POSITION": 0}]}],
        "extras": {"targetNames": ["mouth", "brows"]}}]}"#;

fn glb(json: &str) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let words = [2, 20 + json.len() as u32, json.len() as u32].map(u32::to_le_bytes);
    [b"glTF", &words[0][..], &words[1], &words[2], b"JSON", &json].concat()
}

#[test]
fn bones_and_expressions_are_those_of_the_file() {
    let model =
        avatar_exchange::vrm::read("nina.vrm", &glb(VRM), &mut |_| Err(String::new())).expect("a VRM");
    let Import { pack, report, .. } = Import::from_vrm(model).expect("an avatar");
    let named = |name: &str| name.to_owned();
    assert_eq!(report.joints, [(Role::Head, named("b")), (Role::LeftEye, named("c"))]);
    let control = |name: &str| pack.controls.index(name).expect(name);
    control("head.turn");
    control("eye.left.ud");
    let happy = pack.poses.get("happy").expect("a pose");
    assert_eq!((happy.value(control("mouth")), happy.value(control("brows"))), (Some(1.0), Some(0.5)));
    let angry = pack.poses.get("angry").expect("a pose");
    assert_eq!((angry.value(control("mouth")), angry.value(control("brows"))), (Some(0.0), Some(0.25)));
    // Shapes of one name move as one, at both nodes.
    let mut values = pack.controls.defaults();
    happy.values.iter().for_each(|(control, value)| values[*control] = *value);
    let mut state = FaceState::new(&pack);
    state.pose(&pack, &values).expect("a pose");
    assert_eq!(
        (pack.shapes.join(" ").as_str(), state.weights()),
        ("mouth brows mouth brows", &[1.0, 0.5, 1.0, 0.5][..])
    );
}
