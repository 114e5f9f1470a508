//! Avatars from VRM: bones by the file's own word, expressions as poses.
#![cfg(feature = "vrm")]
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_exchange::vrm::Gaze;
use avatar_pack::{FaceState, Import, Role, gaze_values};

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
    let control = |name: &str| pack.controls().index(name).expect(name);
    control("head.turn");
    control("eye.left.ud");
    let happy = pack.poses().get("happy").expect("a pose");
    assert_eq!((happy.value(control("mouth")), happy.value(control("brows"))), (Some(1.0), Some(0.5)));
    let angry = pack.poses().get("angry").expect("a pose");
    assert_eq!((angry.value(control("mouth")), angry.value(control("brows"))), (Some(0.0), Some(0.25)));
    // Shapes of one name move as one, at both nodes.
    let mut values = pack.controls().defaults();
    happy.values.iter().for_each(|(control, value)| values[*control] = *value);
    let mut state = FaceState::new(&pack);
    state.pose(&pack, &values).expect("a pose");
    assert_eq!(
        (pack.shapes().join(" ").as_str(), state.weights()),
        ("mouth brows mouth brows", &[1.0, 0.5, 1.0, 0.5][..])
    );
}

#[test]
fn the_controls_of_the_eyes_look_as_far_as_the_file_says() {
    let looking = VRM.replace(
        r#""expressions""#,
        r#""lookAt": {"type": "bone", "offsetFromHeadBone": [0, 0, 0],
            "rangeMapHorizontalInner": {"inputMaxValue": 90, "outputScale": 9},
            "rangeMapHorizontalOuter": {"inputMaxValue": 40, "outputScale": 20},
            "rangeMapVerticalDown": {"inputMaxValue": 60, "outputScale": 6},
            "rangeMapVerticalUp": {"inputMaxValue": 50, "outputScale": 5}},
        "expressions""#,
    );
    let looking =
        looking.replace(r#""leftEye": {"node": 2}"#, r#""leftEye": {"node": 2}, "rightEye": {"node": 3}"#);
    let looking = looking.replace(
        r#"{"name": "c", "mesh": 0}]"#,
        r#"{"name": "c", "mesh": 0, "rotation": [0, 0, 0.70710678, 0.70710678]}, {"name": "d", "mesh": 0}]"#,
    );
    let model =
        avatar_exchange::vrm::read("nina.vrm", &glb(&looking), &mut |_| Err(String::new())).expect("a VRM");
    let look_at = model.vrm.look_at.expect("how it looks");
    let Import { pack, .. } = Import::from_vrm(model).expect("an avatar");
    let control = |name: &str| pack.controls().controls()[pack.controls().index(name).expect(name)].clone();
    let range = |name: &str| (control(name).min, control(name).max);
    assert_eq!((range("eye.left.lr"), range("eye.right.lr")), ((-9.0, 20.0), (-20.0, 9.0)));
    assert_eq!((range("eye.left.ud"), range("eye.right.ud")), ((-6.0, 5.0), (-6.0, 5.0)));
    // 30° to the character's left: three quarters of the outer range for the left eye, a third of the inner
    // one for the right.
    let gaze = |yaw_deg, pitch_deg| Gaze { yaw_deg, pitch_deg };
    let left = gaze_values(&look_at, gaze(30.0, 0.0));
    assert_eq!(
        left,
        [("eye.left.ud", 0.0), ("eye.left.lr", 15.0), ("eye.right.ud", 0.0), ("eye.right.lr", 3.0)]
    );
    let down = gaze_values(&look_at, gaze(0.0, 30.0)).map(|(_, value)| value);
    assert_eq!(down, [-3.0, 0.0, -3.0, 0.0]);
    for (gaze, towards) in [(gaze(30.0, 0.0), 0), (gaze(0.0, 30.0), 1)] {
        let mut values = pack.controls().defaults();
        for (name, value) in gaze_values(&look_at, gaze) {
            values[pack.controls().index(name).expect(name)] = value;
        }
        let mut state = FaceState::new(&pack);
        state.pose(&pack, &values).expect("a pose");
        let expected = [(15.0f32, 0.0f32), (0.0, 3.0)][towards];
        let (yaw, pitch) = (expected.0.to_radians(), expected.1.to_radians());
        // What the eye saw straight ahead, whatever way its own axes lie.
        let forward = glam::Vec3::new(yaw.sin() * pitch.cos(), -pitch.sin(), yaw.cos() * pitch.cos());
        let joint = pack.rig().joint("c").expect("the left eye").index();
        let (now, rest) = (state.rig_pose().world_from_joint()[joint], pack.rig().world_from_bind()[joint]);
        let seen = now.transform_vector3(rest.inverse().transform_vector3(glam::Vec3::Z));
        assert!(seen.abs_diff_eq(forward, 1e-6), "{seen} {forward}");
    }
}
