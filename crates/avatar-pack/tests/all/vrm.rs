//! Avatars from VRM: bones by the file's own word, expressions as poses.
#![cfg(feature = "vrm")]
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_exchange::vrm::{Gaze, VrmModel, expression_weights, read};
use avatar_pack::{FaceState, Import, Pack, Role, gaze_values};
use glam::{DAffine3, DQuat, DVec3};

/// Two faces that share shapes of the same names, and bones whose names say nothing.
pub(crate) const VRM: &str = r#"{"asset": {"version": "2.0"}, "extensionsUsed": ["VRMC_vrm"],
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

pub(crate) fn glb(json: &str) -> Vec<u8> {
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
    // Each expression has a control, and a pose in which all else is at rest.
    let happy = pack.poses().get("happy").expect("a pose");
    let names = ["expression.happy", "expression.angry", "mouth", "brows"].map(control);
    assert_eq!(names.map(|control| happy.value(control)), [Some(1.0), Some(0.0), Some(0.0), Some(0.0)]);
    let weights = |values: &[(usize, f32)]| {
        let mut all = pack.controls().defaults();
        values.iter().for_each(|(control, value)| all[*control] = *value);
        let mut state = FaceState::new(&pack);
        state.pose(&pack, &all).expect("a pose");
        state.weights().to_vec()
    };
    assert_eq!(pack.shapes().join(" "), "mouth brows mouth brows");
    assert_eq!(weights(&happy.values), [1.0, 0.5, 0.0, 0.0], "the first node's shapes alone");
    assert_eq!(weights(&pack.poses().get("angry").expect("a pose").values), [0.0, 0.0, 0.0, 0.25]);
    // Shapes of one name have one control, which moves them at both nodes, and expressions add to that.
    assert_eq!(weights(&[(control("mouth"), 0.5), (names[0], 0.5)]), [1.0, 0.25, 0.5, 0.0]);
    let listed: Vec<&str> = pack.poses().iter().map(|pose| pose.name.as_str()).collect();
    assert!(!listed.contains(&"expression.happy"), "{listed:?}");
    let about = report.about.iter().map(|(what, text)| format!("{what}: {text}"));
    let about: Vec<String> = about.collect();
    assert_eq!(about, ["name: Nina", "licence: https://vrm.dev/licenses/1.0/", "authors: A"]);
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

/// Numbers from 0 to 1, the same ones each time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    fn one_of<'a>(&mut self, texts: &[&'a str]) -> &'a str {
        texts[(self.next() * texts.len() as f32) as usize]
    }
}

const EXPRESSIONS: [&str; 12] = [
    "happy",
    "angry",
    "sad",
    "aa",
    "oh",
    "blink",
    "blinkLeft",
    "blinkRight",
    "lookUp",
    "lookDown",
    "lookLeft",
    "lookRight",
];

/// Two faces with six shapes each, of which two weigh something at rest; eyes that lie crosswise.
fn random_vrm(random: &mut Random, looks_by: &str) -> VrmModel {
    let expression = |random: &mut Random, name: &str| {
        let binds: Vec<String> = (0..(random.next() * 5.0) as usize)
            .map(|_| {
                let (node, shape) = (4 + (random.next() * 2.0) as usize, (random.next() * 6.0) as usize);
                format!(r#"{{"node": {node}, "index": {shape}, "weight": {}}}"#, random.next())
            })
            .collect();
        let mut kind = || random.one_of(&["none", "none", "block", "blend"]);
        let overrides = ["overrideBlink", "overrideLookAt", "overrideMouth"]
            .map(|key| format!(r#""{key}": "{}""#, kind()));
        let is_binary = kind() == "block";
        format!(
            r#""{name}": {{"isBinary": {is_binary}, "morphTargetBinds": [{}], {}}}"#,
            binds.join(", "),
            overrides.join(", ")
        )
    };
    let presets: Vec<String> = EXPRESSIONS.iter().map(|name| expression(random, name)).collect();
    let custom = expression(random, "pout");
    let mut range = |most: f32| {
        let (input, output) = (20.0 + 70.0 * random.next(), most * (0.2 + random.next()));
        format!(r#"{{"inputMaxValue": {input}, "outputScale": {output}}}"#)
    };
    let most = if looks_by == "bone" { 30.0 } else { 1.0 };
    let ranges = ["HorizontalInner", "HorizontalOuter", "VerticalDown", "VerticalUp"]
        .map(|side| format!(r#""rangeMap{side}": {}"#, range(most)))
        .join(", ");
    let target = r#"{"POSITION": 0}"#;
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsUsed": ["VRMC_vrm"],
        "extensions": {{"VRMC_vrm": {{"specVersion": "1.0", "meta": {{"name": "N", "authors": [], "licenseUrl": ""}},
            "humanoid": {{"humanBones": {{"hips": {{"node": 0}}, "head": {{"node": 1}},
                "leftEye": {{"node": 2}}, "rightEye": {{"node": 3}}}}}},
            "expressions": {{"preset": {{{}}}, "custom": {{{custom}}}}},
            "lookAt": {{"type": "{looks_by}", "offsetFromHeadBone": [0.0, 0.06, 0.1], {ranges}}}}}}},
        "nodes": [{{"name": "hips", "children": [1, 5]}},
            {{"name": "head", "translation": [0.1, 1.5, 0.0], "rotation": [0.5, 0.5, 0.5, 0.5],
              "children": [2, 3, 4]}},
            {{"name": "l", "mesh": 1, "translation": [0.03, 0.06, 0.1], "rotation": [0, 0, 0.6, 0.8]}},
            {{"name": "r", "mesh": 1, "translation": [-0.03, 0.06, 0.1], "rotation": [0.6, 0, 0, 0.8]}},
            {{"name": "face", "mesh": 0}}, {{"name": "body", "mesh": 0}}],
        "accessors": [{{"componentType": 5126, "type": "VEC3", "count": 3}}],
        "meshes": [{{"weights": [0, 0.25, 0, 0, 0.5, 0], "extras": {{"targetNames": ["a", "b", "c", "d", "e", "f"]}},
            "primitives": [{{"attributes": {{"POSITION": 0}}, "targets": [{}]}}]}},
            {{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}]}}"#,
        presets.join(", "),
        [target; 6].join(", ")
    );
    read("random.vrm", &glb(&json), &mut |_| Err(String::new())).expect("a VRM")
}

fn values_of(pack: &Pack, named: &[(&str, f32)]) -> Vec<f32> {
    let mut values = pack.controls().defaults();
    for (name, value) in named {
        let control = format!("expression.{name}");
        values[pack.controls().index(&control).expect(name)] = *value;
    }
    values
}

#[test]
fn controls_of_expressions_weigh_shapes_as_the_formats_own_evaluation_does() {
    let mut random = Random(1);
    let (mut compared, mut above_rest) = (0, 0);
    for _ in 0..60 {
        let model = random_vrm(&mut random, "bone");
        let Import { pack, .. } = Import::from_vrm(model.clone()).expect("an avatar");
        let mut state = FaceState::new(&pack);
        for _ in 0..20 {
            let names: Vec<&str> = model.vrm.expressions.iter().map(|one| one.name.as_str()).collect();
            let mut chosen: Vec<(&str, f32)> = Vec::new();
            for name in names {
                if random.next() < 0.4 {
                    chosen.push((name, random.next()));
                }
            }
            let mut pose = model.scene.rest();
            expression_weights(&model.vrm, &chosen).apply(&mut pose);
            state.pose(&pack, &values_of(&pack, &chosen)).expect("values fit");
            let motion = pack.motion().expect("a scene");
            for node in [4, 5] {
                for (shape, expected) in pose.weights[node].iter().enumerate() {
                    let found = state.weights()[motion.shape(node, shape).expect("a shape")];
                    assert_eq!(found.to_bits(), expected.to_bits(), "{found} {expected} {chosen:?}");
                    compared += 1;
                    above_rest += usize::from(*expected > 0.5);
                }
            }
        }
    }
    assert!(compared == 60 * 20 * 12 && above_rest > 1000, "{compared} {above_rest}");
}

/// The head of the scene, turned to its left about the vertical.
fn turned_head(rest: &DAffine3, degrees: f64) -> DAffine3 {
    let turn = DAffine3::from_rotation_y(degrees.to_radians());
    let at = DAffine3::from_translation(rest.translation);
    at * turn * at.inverse() * *rest
}

fn rotation(affine: &DAffine3) -> DQuat {
    affine.to_scale_rotation_translation().1
}

#[test]
fn a_gaze_moves_bones_or_expressions_as_the_formats_own_evaluation_does() {
    let mut random = Random(2);
    for round in 0..200 {
        let looks_by = ["bone", "expression"][round % 2];
        let model = random_vrm(&mut random, looks_by);
        let (scene, vrm) = (model.scene.clone(), model.vrm.clone());
        let look_at = vrm.look_at.expect("how it looks");
        let Import { pack, .. } = Import::from_vrm(model).expect("an avatar");
        let mut gaze = avatar_pack::Gaze::new(&pack).expect("eyes");
        let control = |name: &str| pack.controls().index(name).expect(name);
        let mut values = pack.controls().defaults();
        let degrees = 60.0 * random.next() - 30.0;
        values[control("head.turn")] = degrees;
        let mut between = || f64::from(2.0 * random.next() - 1.0);
        let target = DVec3::new(3.0 * between(), 1.5 + 2.0 * between(), 0.5 + 2.0 * between());
        let mut out = Vec::new();
        gaze.look_at(&pack, &values, target.as_vec3(), &mut out).expect("values fit");

        let worlds = scene.worlds(&scene.rest());
        let head = turned_head(&worlds[1], f64::from(degrees));
        let angles = look_at.gaze(&worlds[1], &head, target.as_vec3().as_dvec3());
        let found = |name: &str| out.iter().find(|(index, _)| *index == control(name)).expect(name).1;
        if looks_by == "expression" {
            for (name, expected) in look_at.expressions(angles) {
                let found = found(&format!("expression.{name}"));
                // Values above 1 count as 1.
                assert!((found - expected.min(1.0)).abs() < 1e-5, "{name}: {found} {expected}");
            }
            assert_eq!(out.len(), 4);
            continue;
        }
        out.iter().for_each(|(control, value)| values[*control] = *value);
        let mut state = FaceState::new(&pack);
        state.pose(&pack, &values).expect("values fit");
        let turns = look_at.eyes(angles);
        for (node, name, turn) in [(2, "l", turns.left), (3, "r", turns.right)] {
            let rest = rotation(&worlds[node]);
            let own = rest.inverse() * turn.rotation().as_dquat() * rest;
            let expected = rotation(&(head * worlds[1].inverse() * worlds[node])) * own;
            let joint = pack.rig().joint(name).expect(name).index();
            let now = state.rig_pose().world_from_joint()[joint];
            let off = now.to_scale_rotation_translation().1.as_dquat().angle_between(expected);
            assert!(off < 1e-3, "{name}: {off} rad off at {angles:?}");
        }
    }
}

#[test]
fn an_expression_takes_from_others_in_a_mixture_of_poses() {
    let vrm = VRM.replace(r#""happy": {"#, r#""happy": {"overrideBlink": "blend", "#).replace(
        r#""angry": {"#,
        r#""blink": {"morphTargetBinds": [{"node": 2, "index": 0, "weight": 1.0}]}, "angry": {"#,
    );
    let model = read("nina.vrm", &glb(&vrm), &mut |_| Err(String::new())).expect("a VRM");
    let Import { pack, .. } = Import::from_vrm(model).expect("an avatar");
    let mixed = pack.poses().mix("happy:0.75 blink", pack.controls()).expect("a mixture");
    let mut values = pack.controls().defaults();
    mixed.values.iter().for_each(|(control, value)| values[*control] = *value);
    let mut state = FaceState::new(&pack);
    state.pose(&pack, &values).expect("a pose");
    assert_eq!(state.weights(), [0.75, 0.375, 0.25, 0.0]);
}

/// Exporters of VRM 0.x write the names of shapes into the primitives, others into the mesh.
#[test]
fn names_of_shapes_in_primitives_are_as_good_as_those_of_the_mesh() {
    let names = [
        "eyeBlinkLeft",
        "eyeBlinkRight",
        "eyeSquintLeft",
        "eyeSquintRight",
        "jawOpen",
        "mouthSmileLeft",
        "mouthSmileRight",
    ];
    let named = format!(r#""extras": {{"targetNames": {names:?}}}"#);
    let import = |in_primitive: bool| {
        let (of_primitive, of_mesh) = match in_primitive {
            true => (format!(", {named}"), String::new()),
            false => (String::new(), format!(", {named}")),
        };
        let target = r#"{"POSITION": 0}"#;
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "extensionsUsed": ["VRM"],
            "extensions": {{"VRM": {{"specVersion": "0.0", "meta": {{"title": "N"}},
                "humanoid": {{"humanBones": [{{"bone": "head", "node": 0}}]}},
                "blendShapeMaster": {{"blendShapeGroups": [{{"name": "A", "presetName": "a",
                    "binds": [{{"mesh": 0, "index": 4, "weight": 50}}]}}]}}}}}},
            "nodes": [{{"name": "a", "mesh": 0}}],
            "accessors": [{{"componentType": 5126, "type": "VEC3", "count": 3}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "targets": [{}]{of_primitive}}}]{of_mesh}}}]}}"#,
            [target; 7].join(", ")
        );
        let model = read("n.vrm", &glb(&json), &mut |_| Err(String::new())).expect("a VRM");
        Import::from_vrm(model).expect("an avatar")
    };
    let (in_primitive, in_mesh) = (import(true), import(false));
    assert_eq!(in_primitive.pack.shapes(), names);
    assert_eq!(in_primitive.report, in_mesh.report);
    assert_eq!(in_primitive.report.shape_sets, [(avatar_pack::ShapeSet::ArKit, 7)]);
    let poses = |import: &Import| import.pack.poses().iter().cloned().collect::<Vec<_>>();
    assert_eq!(poses(&in_primitive), poses(&in_mesh));
    for pose in ["smile", "laugh", "wink-left", "wink-right", "sleep", "yawn", "aa"] {
        assert!(in_primitive.pack.poses().get(pose).is_some(), "{pose}");
    }
}

#[test]
fn what_is_read_and_not_shown_is_noted() {
    let vrm = VRM.replace(
        r#""expressions""#,
        r#""firstPerson": {"meshAnnotations": [{"node": 1, "type": "both"},
        {"node": 2, "type": "firstPersonOnly"}]}, "expressions""#,
    );
    let model = read("nina.vrm", &glb(&vrm), &mut |_| Err(String::new())).expect("a VRM");
    let Import { pack, report, .. } = Import::from_vrm(model).expect("an avatar");
    let note = "VRM: 1 parts that only the character itself is to see are shown";
    assert!(report.notes.iter().any(|other| other == note), "{note}: {:?}", report.notes);
    assert!(pack.warnings().iter().any(|other| other.to_string().contains(note)), "{note}");
}
