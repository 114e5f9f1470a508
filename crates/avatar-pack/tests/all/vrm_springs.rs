//! Springs and constraints of VRM files, and what they do to the avatar.
#![cfg(feature = "vrm")]
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_pack::joint_springs::{ConstraintKind, Law, Shape, Spring};
use avatar_pack::{FaceState, Import, Pack};
use glam::{Affine3A, Quat, Vec3};

/// Hips, a head turned at rest, and a braid of three nodes on it.
const NODES: &str = r#"[{"name": "Hips", "translation": [0, 1, 0], "children": [1]},
    {"name": "Head", "translation": [0, 0.5, 0], "rotation": [0, 0.70710678, 0, 0.70710678], "children": [2, 5]},
    {"name": "Braid 1", "translation": [0, 0.125, -0.125], "children": [3]},
    {"name": "Braid 2", "translation": [0, -0.25, 0], "children": [4]},
    {"name": "Braid 3", "translation": [0, -0.25, -0.125]},
    {"name": "Follower", "translation": [0.25, 0, 0]}]"#;

fn import(extensions: &str, nodes: &str) -> Import {
    let used = if extensions.contains("VRMC_vrm") { "VRMC_vrm" } else { "VRM" };
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsUsed": ["{used}"], "extensions": {extensions}, "nodes": {nodes}}}"#
    );
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let words = [2, 20 + json.len() as u32, json.len() as u32].map(u32::to_le_bytes);
    let bytes = [b"glTF", &words[0][..], &words[1], &words[2], b"JSON", &json].concat();
    let model = avatar_exchange::vrm::read("braid.vrm", &bytes, &mut |_| Err(String::new())).expect("a VRM");
    Import::from_vrm(model).expect("an avatar")
}

fn version_1(nodes: &str) -> Import {
    let extensions = r#"{"VRMC_vrm": {"specVersion": "1.0", "humanoid": {"humanBones": {
            "hips": {"node": 0}, "head": {"node": 1}}}},
        "VRMC_springBone": {"specVersion": "1.0",
            "colliders": [{"node": 1, "shape": {"sphere": {"offset": [0, 0.5, 0], "radius": 0.125}}},
                {"node": 0, "shape": {"sphere": {}}, "extensions": {"VRMC_springBone_extended_collider":
                    {"specVersion": "1.0", "shape": {"plane": {"offset": [0, -1, 0], "normal": [0, 1, 0]}}}}}],
            "colliderGroups": [{"colliders": [1]}, {"colliders": [0]}],
            "springs": [{"name": "braid", "center": 0, "colliderGroups": [0, 1], "joints": [
                {"node": 2, "stiffness": 0.5, "dragForce": 0.25, "gravityPower": 2, "gravityDir": [0, -0.5, 0.25],
                 "hitRadius": 0.0625}, {"node": 3}, {"node": 4}]}]}}"#;
    import(extensions, nodes)
}

fn joint(pack: &Pack, name: &str) -> usize {
    pack.rig().joint(name).expect(name).index()
}

#[test]
fn chains_of_version_1_swing_up_to_their_last_node() {
    let Import { pack, report, .. } = version_1(NODES);
    let springs = pack.springs();
    let number = |name| joint(&pack, name);
    let first = Law::Vrm { stiffness: 0.5, drag: 0.25, gravity: Vec3::new(0.0, -1.0, 0.5) };
    let second = Law::Vrm { stiffness: 1.0, drag: 0.5, gravity: Vec3::ZERO };
    let expected = [
        ("Braid 1", Vec3::new(0.0, -0.25, 0.0), first, 0.0625),
        ("Braid 2", Vec3::new(0.0, -0.25, -0.125), second, 0.0),
    ];
    assert_eq!(springs.springs.len(), expected.len());
    for (found, (name, tail, law, hit_radius)) in springs.springs.iter().zip(expected) {
        assert!((found.tail - tail).length() < 1e-5, "{name}: {found:?}");
        let (center, colliders) = (Some(number("Hips")), vec![1, 0]);
        let expected = Spring { hit_radius, center, colliders, ..Spring::new(number(name), found.tail, law) };
        assert_eq!(found, &expected);
    }
    let colliders: Vec<_> =
        springs.colliders.iter().map(|collider| (collider.joint, collider.shape)).collect();
    let sphere = Shape::Sphere { offset: Vec3::Y * 0.5, radius: 0.125, inside: false };
    let plane = Shape::Plane { offset: Vec3::NEG_Y, normal: Vec3::Y };
    assert_eq!(colliders, [(number("Head"), sphere), (number("Hips"), plane)]);
    assert!(!report.notes.iter().any(|note| note.contains("spring") || note.contains("ollider")), "{report}");
}

/// The last joint has an end seven centimetres further on, from the node above it; the whole looks the other
/// way than in its file.
#[test]
fn chains_of_version_0_swing_with_their_last_node() {
    let extensions = r#"{"VRM": {"specVersion": "0.0", "humanoid": {"humanBones": [{"bone": "hips", "node": 0},
            {"bone": "head", "node": 1}]},
        "secondaryAnimation": {"boneGroups": [{"stiffiness": 2, "dragForce": 0.25, "gravityPower": 0.5,
            "gravityDir": {"x": 0, "y": -1, "z": 0}, "hitRadius": 0.03125, "center": -1, "bones": [2],
            "colliderGroups": []}], "colliderGroups": []}}}"#;
    let Import { pack, .. } = import(extensions, NODES);
    let springs = &pack.springs().springs;
    let law = Law::Vrm { stiffness: 2.0, drag: 0.25, gravity: Vec3::NEG_Y * 0.5 };
    let straight_on = Vec3::new(0.0, -0.25, -0.125).normalize_or_zero() * 0.07;
    let expected = [
        ("Braid 1", Vec3::new(0.0, -0.25, 0.0)),
        ("Braid 2", Vec3::new(0.0, -0.25, -0.125)),
        ("Braid 3", straight_on),
    ];
    assert_eq!(springs.len(), expected.len());
    for (found, (name, tail)) in springs.iter().zip(expected) {
        assert!((found.tail - tail).length() < 1e-5, "{name}: {found:?}");
        let expected = Spring { hit_radius: 0.03125, ..Spring::new(joint(&pack, name), found.tail, law) };
        assert_eq!(found, &expected);
    }
}

/// Where forces pull, in the turned head's space; then the braid swings after the head.
#[test]
fn a_braid_hangs_by_its_forces_and_swings_after_the_head() {
    let Import { pack, .. } = version_1(NODES);
    let mut state = FaceState::new(&pack);
    let head = pack.rig().joint("Head").expect("a head");
    let values = pack.controls().defaults();
    let turned = |angle: f32| [(head, Affine3A::from_quat(Quat::from_rotation_y(angle)))];
    let braid = joint(&pack, "Braid 1");
    let direction =
        |state: &FaceState| state.rig_pose().world_from_joint()[braid].transform_vector3(Vec3::NEG_Y);
    state.pose_with(&pack, &values, |_| {}, &turned(0.0)).expect("a pose");
    assert!((direction(&state) - Vec3::NEG_Y).length() < 1e-5, "the pose alone");
    state.settle(&pack).expect("a pose");
    let hanging = (Vec3::NEG_Y * 0.5 + Vec3::new(0.0, -1.0, 0.5)).normalize_or_zero();
    assert!((direction(&state) - hanging).length() < 1e-3, "{} for {hanging}", direction(&state));
    // Stiffness pulls along the turned head, gravity as before; half a second later it is on its way.
    let mut most = 0.0f32;
    for _ in 0..30 {
        state.pose_with(&pack, &values, |_| {}, &turned(1.0)).expect("a pose");
        state.swing(&pack, 1.0 / 60.0).expect("a pose");
        most = most.max((direction(&state) - hanging).length());
    }
    assert!(most > 0.05, "it swings by {most}");
}

#[test]
fn nodes_turn_with_others_unless_they_wait_for_themselves() {
    let follower = |source: usize| {
        NODES.replace(
            r#"{"name": "Follower", "#,
            &format!(
                r#"{{"name": "Follower", "extensions": {{"VRMC_node_constraint": {{"specVersion": "1.0",
                "constraint": {{"roll": {{"source": {source}, "rollAxis": "Y", "weight": 0.5}}}}}}}}, "#
            ),
        )
    };
    let Import { pack, .. } = version_1(&follower(2));
    let [one] = &pack.springs().constraints[..] else { unreachable!("one constraint") };
    let numbers = (joint(&pack, "Follower"), joint(&pack, "Braid 1"));
    assert_eq!(((one.joint, one.source), one.weight), (numbers, 0.5));
    assert_eq!(one.kind, ConstraintKind::Roll { axis: Vec3::Y });

    // The head would follow a node on it.
    let circle = NODES.replace(
        r#"{"name": "Head", "#,
        r#"{"name": "Head", "extensions": {"VRMC_node_constraint": {"specVersion": "1.0",
        "constraint": {"rotation": {"source": 5}}}}, "#,
    );
    let Import { pack, report, .. } = version_1(&circle);
    assert!(pack.springs().constraints.is_empty());
    let expected = "VRM: node \"Head\" would follow itself by way of nodes above: its constraint is left out";
    assert!(report.notes.iter().any(|note| note == expected), "{report}");
    assert_eq!(pack.springs().springs.len(), 2, "springs go on");
}
