//! VRM of both generations, written by hand, with values worked out by hand.

mod body;
mod colliders;
mod toon;

use crate::support::gltf::glb;
use avatar_exchange::ImportError;
use avatar_exchange::vrm::{
    Gaze, LookAtKind, MorphBind, Override, RangeMap, Version, VrmModel, expression_weights, read as read_vrm,
};
use glam::{DAffine3, DVec3, Vec3};
use serde_json::{Value, json};

/// Hips, head, eyes, and a face of four shapes at two nodes.
fn scene(extensions: Value) -> Value {
    let target = json!({ "POSITION": 0 });
    json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": extensions.as_object().map(|all| all.keys().cloned().collect::<Vec<_>>()),
        "extensions": extensions,
        "nodes": [
            { "name": "Hips", "children": [1] },
            { "name": "Head", "translation": [0.0, 1.5, 0.0], "children": [2, 3] },
            { "name": "EyeL" },
            { "name": "EyeR" },
            { "name": "Face", "mesh": 0 },
            { "name": "Mirror image", "mesh": 0, "translation": [0.0, 0.0, 1.0] }
        ],
        "accessors": [{ "componentType": 5126, "type": "VEC3", "count": 3 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "targets": [target, target, target, target] }] }]
    })
}

fn read(json: &Value) -> Result<VrmModel, ImportError> {
    let bytes = glb(&json.to_string(), &[]);
    read_vrm("face.vrm", &bytes, &mut |_| Err("no other files".to_owned()))
}

fn v1() -> Value {
    let bind = |index: u32, weight: f32| json!({ "node": 4, "index": index, "weight": weight });
    scene(json!({ "VRMC_vrm": {
        "specVersion": "1.0",
        "meta": { "name": "Nina", "version": "2", "authors": ["A", "B"], "licenseUrl": "https://vrm.dev/licenses/1.0/" },
        "humanoid": { "humanBones": {
            "hips": { "node": 0 }, "head": { "node": 1 }, "leftEye": { "node": 2 }, "rightEye": { "node": 3 }
        } },
        "expressions": {
            "preset": {
                "happy": { "morphTargetBinds": [bind(0, 1.0), bind(1, 0.5)], "overrideBlink": "blend",
                           "overrideMouth": "block", "overrideLookAt": "none" },
                "angry": { "isBinary": true, "morphTargetBinds": [bind(0, 0.25)], "overrideBlink": "blend",
                           "materialColorBinds": [{ "material": 0, "type": "color", "targetValue": [1, 0, 0, 1] }] },
                "blink": { "morphTargetBinds": [bind(2, 1.0)], "overrideBlink": "block" },
                "blinkLeft": { "isBinary": true, "morphTargetBinds": [bind(3, 1.0)] },
                "aa": { "morphTargetBinds": [bind(1, 1.0)] }
            },
            "custom": { "pout": { "morphTargetBinds": [bind(3, 0.5)] } }
        },
        "lookAt": {
            "type": "bone",
            "offsetFromHeadBone": [0.0, 0.1, 0.02],
            "rangeMapHorizontalInner": { "inputMaxValue": 60.0, "outputScale": 12.0 },
            "rangeMapHorizontalOuter": { "inputMaxValue": 90.0, "outputScale": 9.0 },
            "rangeMapVerticalDown": { "inputMaxValue": 45.0, "outputScale": 15.0 },
            "rangeMapVerticalUp": { "inputMaxValue": 30.0, "outputScale": 6.0 }
        }
    } }))
}

fn v0() -> Value {
    let range = |x: f32, y: f32| json!({ "curve": [0, 0, 0, 1, 1, 1, 1, 0], "xRange": x, "yRange": y });
    scene(json!({ "VRM": {
        "specVersion": "0.0",
        "meta": { "title": "Nina", "version": "1", "author": "A", "licenseName": "CC_BY" },
        "humanoid": { "humanBones": [
            { "bone": "hips", "node": 0 }, { "bone": "head", "node": 1 }, { "bone": "jaw", "node": -1 },
            { "bone": "leftThumbIntermediate", "node": 2 }
        ] },
        "firstPerson": {
            "firstPersonBone": 1,
            "firstPersonBoneOffset": { "x": 0.0, "y": 0.06, "z": 0.04 },
            "lookAtTypeName": "BlendShape",
            "lookAtHorizontalInner": range(90.0, 1.0),
            "lookAtHorizontalOuter": range(50.0, 1.0),
            "lookAtVerticalDown": range(20.0, 0.5),
            "lookAtVerticalUp": { "curve": [0, 0, 0, 0, 1, 1, 1, 0], "xRange": 10.0, "yRange": 1.0 }
        },
        "blendShapeMaster": { "blendShapeGroups": [
            { "name": "Joy", "presetName": "joy", "binds": [{ "mesh": 0, "index": 1, "weight": 80.0 }],
              "materialValues": [{ "materialName": "m", "propertyName": "_Color", "targetValue": [1, 1, 1, 1] }] },
            { "name": "Blink_L", "presetName": "blink_l", "binds": [{ "mesh": 0, "index": 2, "weight": 100.0 }] },
            { "name": "Grin", "presetName": "unknown", "isBinary": true, "binds": [] }
        ] }
    } }))
}

#[test]
fn version_1_is_read() {
    let VrmModel { scene, vrm } = read(&v1()).expect("a VRM");
    assert_eq!(vrm.version, Version::V1);
    assert_eq!((vrm.meta.title.as_str(), vrm.meta.version.as_str()), ("Nina", "2"));
    assert_eq!((vrm.meta.authors.len(), vrm.meta.licence.as_str()), (2, "https://vrm.dev/licenses/1.0/"));
    assert_eq!((vrm.bone("head"), vrm.bone("rightEye"), vrm.bone("jaw")), (Some(1), Some(3), None));
    let names: Vec<_> = vrm.expressions.iter().map(|e| (e.name.as_str(), e.is_preset)).collect();
    let presets = ["happy", "angry", "blink", "blinkLeft", "aa"].map(|name| (name, true));
    assert_eq!(names, [&presets[..], &[("pout", false)]].concat());
    let happy = vrm.expression("happy").expect("an expression");
    assert_eq!(
        (happy.override_blink, happy.override_look_at, happy.override_mouth),
        (Override::Blend, Override::None, Override::Block)
    );
    assert_eq!(happy.binds[1], MorphBind { node: 4, shape: 1, weight: 0.5 });
    let look_at = vrm.look_at.expect("eyes");
    assert_eq!((look_at.kind, look_at.offset_from_head), (LookAtKind::Bone, Vec3::new(0.0, 0.1, 0.02)));
    assert_eq!(look_at.vertical_up, RangeMap { input_max_deg: 30.0, output_scale: 6.0 });
    let notes: Vec<_> = scene.notes.iter().map(ToString::to_string).collect();
    let has = |text: &str| notes.iter().any(|note| note == text);
    assert!(
        has("extensions.VRMC_vrm.expressions.preset.angry: 1 changes of colours are not represented"),
        "{notes:?}"
    );
    assert!(has("humanoid: lacks the bone spine") && !has("humanoid: lacks the bone head"));
    assert!(!notes.iter().any(|note| note.contains("VRMC_vrm is not represented")));
    // It looks along +Z as it is.
    assert_eq!(scene.nodes.len(), 6);
}

/// As `(shape, weight)` of the face.
fn weights(values: &[(&str, f32)]) -> [f32; 4] {
    let model = read(&v1()).expect("a VRM");
    let mut pose = model.scene.rest();
    expression_weights(&model.vrm, values).apply(&mut pose);
    pose.weights[4].clone().try_into().expect("four shapes")
}

#[test]
fn expressions_add_up_and_override() {
    assert_eq!(weights(&[]), [0.0; 4]);
    assert_eq!(weights(&[("happy", 0.5), ("pout", 1.0)]), [0.5, 0.25, 0.0, 0.5]);
    assert_eq!(weights(&[("happy", 7.0), ("nobody", 1.0), ("aa", f32::NAN)]), [1.0, 0.5, 0.0, 0.0]);
    // happy takes its value from blinking, and mouths altogether.
    assert_eq!(weights(&[("happy", 0.25), ("blink", 1.0), ("aa", 1.0)]), [0.25, 0.125, 0.75, 0.0]);
    // A binary expression is 0 up to 0.5 and overrides only above.
    assert_eq!(weights(&[("angry", 0.5), ("blink", 0.5)]), [0.0, 0.0, 0.5, 0.0]);
    assert_eq!(weights(&[("angry", 0.51), ("blink", 0.5)]), [0.25, 0.0, 0.0, 0.0]);
    // What is taken adds up, to 1 at most.
    assert_eq!(weights(&[("angry", 1.0), ("happy", 0.5), ("blink", 1.0)]), [0.75, 0.25, 0.0, 0.0]);
    // blink does not override its own kind, and a binary blink is whole or nothing.
    assert_eq!(weights(&[("blink", 1.0), ("blinkLeft", 1.0)]), [0.0, 0.0, 1.0, 1.0]);
    assert_eq!(weights(&[("happy", 0.25), ("blinkLeft", 1.0)]), [0.25, 0.125, 0.0, 0.0]);
    // The later of two values counts.
    assert_eq!(weights(&[("pout", 1.0), ("pout", 0.5)]), [0.0, 0.0, 0.0, 0.25]);
}

fn near(a: Gaze, yaw_deg: f32, pitch_deg: f32) {
    let off = (a.yaw_deg - yaw_deg).abs().max((a.pitch_deg - pitch_deg).abs());
    assert!(off < 1e-4, "expected {yaw_deg} {pitch_deg}, found {a:?}");
}

#[test]
fn eyes_look_within_their_ranges() {
    let VrmModel { scene, vrm } = read(&v1()).expect("a VRM");
    let look_at = vrm.look_at.expect("eyes");
    let rest = scene.worlds(&scene.rest())[1];
    let from = DVec3::new(0.0, 1.6, 0.02);
    near(look_at.gaze(&rest, &rest, from + DVec3::Z), 0.0, 0.0);
    near(look_at.gaze(&rest, &rest, from + DVec3::new(1.0, 0.0, 1.0)), 45.0, 0.0);
    near(look_at.gaze(&rest, &rest, from + DVec3::new(0.0, 3.0, 3.0)), 0.0, -45.0);
    // A head turned by a quarter to its left sees +X in front.
    let turned = rest * DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_2);
    let eyes = turned.transform_point3(DVec3::new(0.0, 0.1, 0.02));
    near(look_at.gaze(&rest, &turned, eyes + DVec3::X), 0.0, 0.0);
    near(look_at.gaze(&rest, &turned, eyes + DVec3::new(1.0, 0.0, 1.0)), -45.0, 0.0);

    // To the left by 30°: the left eye outwards 30/90 · 9, the right one inwards 30/60 · 12; down 9/45 · 15.
    let eyes = look_at.eyes(Gaze { yaw_deg: 30.0, pitch_deg: 9.0 });
    near(eyes.left, 3.0, 3.0);
    near(eyes.right, 6.0, 3.0);
    // Beyond the ranges, to the right and up.
    let eyes = look_at.eyes(Gaze { yaw_deg: -120.0, pitch_deg: -80.0 });
    near(eyes.left, -12.0, -6.0);
    near(eyes.right, -9.0, -6.0);
    // A gaze to the left and down turns +Z to +X and −Y.
    let forward = Gaze { yaw_deg: 90.0, pitch_deg: 0.0 }.rotation() * Vec3::Z;
    assert!((forward - Vec3::X).length() < 1e-6, "{forward}");
    let forward = Gaze { yaw_deg: 0.0, pitch_deg: 90.0 }.rotation() * Vec3::Z;
    assert!((forward - Vec3::NEG_Y).length() < 1e-6, "{forward}");
    // No width, no direction, no numbers.
    let narrow = RangeMap { input_max_deg: 0.0, output_scale: 5.0 };
    assert_eq!([1.0, -1.0, 0.0, f32::NAN].map(|angle| narrow.map(angle)), [5.0, -5.0, 0.0, 0.0]);
    assert_eq!(look_at.gaze(&rest, &rest, DVec3::NAN), Gaze::default());
}

#[test]
fn version_0_is_read_translated_and_turned() {
    let VrmModel { scene, vrm } = read(&v0()).expect("a VRM");
    assert_eq!(vrm.version, Version::V0);
    assert_eq!((vrm.meta.authors.as_slice(), vrm.meta.licence.as_str()), (&["A".to_owned()][..], "CC_BY"));
    assert_eq!((vrm.bone("head"), vrm.bone("jaw"), vrm.bone("leftThumbProximal")), (Some(1), None, Some(2)));
    let names: Vec<_> = vrm.expressions.iter().map(|e| (e.name.as_str(), e.is_preset)).collect();
    assert_eq!(names, [("happy", true), ("blinkLeft", true), ("Grin", false)]);
    // Both nodes show the mesh.
    let binds = &vrm.expressions[0].binds;
    assert_eq!(binds[..], [4, 5].map(|node| MorphBind { node, shape: 1, weight: 0.8 }));
    let look_at = vrm.look_at.expect("eyes");
    assert_eq!(
        (look_at.kind, look_at.offset_from_head),
        (LookAtKind::Expression, Vec3::new(0.0, 0.06, -0.04))
    );
    // 25 of 50 degrees to the left, 10 of 20 down at half strength.
    let values = look_at.expressions(Gaze { yaw_deg: 25.0, pitch_deg: 10.0 });
    assert_eq!(values, [("lookLeft", 0.5), ("lookRight", 0.0), ("lookDown", 0.25), ("lookUp", 0.0)]);
    let values = look_at.expressions(Gaze { yaw_deg: -100.0, pitch_deg: -5.0 });
    assert_eq!(values, [("lookLeft", 0.0), ("lookRight", 1.0), ("lookDown", 0.0), ("lookUp", 0.5)]);

    // The new root turns what was behind to the front, and the eyes' place with it.
    let worlds = scene.worlds(&scene.rest());
    assert_eq!((scene.nodes.len(), worlds[5].translation), (7, DVec3::NEG_Z));
    assert_eq!(worlds[1].transform_point3(look_at.offset_from_head.as_dvec3()).z, f64::from(0.04f32));
    near(look_at.gaze(&worlds[1], &worlds[1], DVec3::new(1.0, 1.56, 1.04)), 45.0, 0.0);
    let notes: Vec<_> = scene.notes.iter().map(ToString::to_string).collect();
    for text in [
        "VRM: looks along -Z: it is turned around by a root node",
        "extensions.VRM.firstPerson.lookAtVerticalUp: its curve is taken as a straight line",
        "extensions.VRM.blendShapeMaster.blendShapeGroups[0]: 1 changes of materials are not represented",
    ] {
        assert!(notes.iter().any(|note| note == text), "{text}: {notes:?}");
    }
}

#[test]
fn mistakes_are_told_with_their_place() {
    let expressions = "/extensions/VRMC_vrm/expressions";
    let happy = format!("{expressions}/preset/happy");
    let groups = "/extensions/VRM/blendShapeMaster/blendShapeGroups";
    let cases = [
        (
            v1(),
            "/extensions/VRMC_vrm/specVersion".to_owned(),
            json!("2.0"),
            "extensions.VRMC_vrm.specVersion: expected version 1.0, found \"2.0\"",
        ),
        (
            v1(),
            "/extensions/VRMC_vrm/humanoid/humanBones/head/node".to_owned(),
            json!(6),
            "extensions.VRMC_vrm.humanoid.humanBones.head.node: expected a node below 6, found 6",
        ),
        (
            v1(),
            "/extensions/VRMC_vrm/humanoid".to_owned(),
            Value::Null,
            "extensions.VRMC_vrm: expected a member 'humanoid', found none",
        ),
        (
            v1(),
            format!("{happy}/morphTargetBinds/1/index"),
            json!(4),
            "extensions.VRMC_vrm.expressions.preset.happy.morphTargetBinds[1].index: expected a shape of the node below 4, found 4",
        ),
        (
            v1(),
            format!("{happy}/morphTargetBinds/0/node"),
            json!(-1),
            "extensions.VRMC_vrm.expressions.preset.happy.morphTargetBinds[0].node: expected a node below 6, found -1",
        ),
        (
            v1(),
            format!("{happy}/morphTargetBinds/0/weight"),
            json!(1e300),
            "extensions.VRMC_vrm.expressions.preset.happy.morphTargetBinds[0].weight: expected a finite number, found 1e+300",
        ),
        (
            v1(),
            format!("{happy}/overrideBlink"),
            json!("some"),
            "extensions.VRMC_vrm.expressions.preset.happy.overrideBlink: expected none, block or blend, found \"some\"",
        ),
        (
            v1(),
            format!("{expressions}/custom"),
            json!({ "happy": {} }),
            "extensions.VRMC_vrm.expressions.custom.happy: expected a name that no preset has, found 'happy'",
        ),
        (
            v1(),
            format!("{expressions}/preset/aa"),
            json!([]),
            "extensions.VRMC_vrm.expressions.preset.aa: expected an object, found []",
        ),
        (
            v1(),
            "/extensions/VRMC_vrm/lookAt/offsetFromHeadBone".to_owned(),
            json!([1, 2]),
            "extensions.VRMC_vrm.lookAt.offsetFromHeadBone: expected three numbers, found [1,2]",
        ),
        (
            v1(),
            "/extensions".to_owned(),
            json!({}),
            "extensions: expected VRMC_vrm (VRM 1.0) or VRM (0.x), found neither",
        ),
        (
            v0(),
            format!("{groups}/0/binds/0/mesh"),
            json!(1),
            "extensions.VRM.blendShapeMaster.blendShapeGroups[0].binds[0].mesh: expected a mesh below 1, found 1",
        ),
        (
            v0(),
            format!("{groups}/1/binds/0/index"),
            json!(9),
            "extensions.VRM.blendShapeMaster.blendShapeGroups[1].binds[0].index: expected a shape of the mesh below 4, found 9",
        ),
        (
            v0(),
            "/extensions/VRM/firstPerson/lookAtTypeName".to_owned(),
            json!("Nose"),
            "extensions.VRM.firstPerson.lookAtTypeName: expected Bone or BlendShape, found \"Nose\"",
        ),
        (
            v0(),
            "/extensions/VRM/firstPerson/lookAtVerticalUp/curve/3".to_owned(),
            json!("x"),
            "extensions.VRM.firstPerson.lookAtVerticalUp.curve[3]: expected a finite number, found \"x\"",
        ),
    ];
    for (mut json, pointer, value, expected) in cases {
        *json.pointer_mut(&pointer).expect("a place in the file") = value;
        let error = read(&json).expect_err(expected);
        assert_eq!(error.to_string(), format!("face.vrm: {expected}"));
    }
}

/// Whatever stands in the place of any value, reading ends with a model or an error.
#[test]
fn any_damage_ends_well() {
    let substitutes =
        [Value::Null, json!(-1), json!(1e9), json!("x"), json!([[]]), json!({ "node": 0 }), json!(true)];
    let (mut read_all, mut refused) = (0, 0);
    for whole in [v1(), v0(), body::v1(), body::v0(), toon::v1(), toon::v0()] {
        let mut places = Vec::new();
        for part in ["extensions", "nodes", "materials"] {
            if let Some(value) = whole.get(part) {
                all_places(value, format!("/{part}"), &mut places);
            }
        }
        for place in places {
            for substitute in &substitutes {
                let mut json = whole.clone();
                *json.pointer_mut(&place).expect("a place in the file") = substitute.clone();
                match read(&json) {
                    Ok(model) => {
                        read_all += 1;
                        let values: Vec<_> =
                            model.vrm.expressions.iter().map(|e| (e.name.as_str(), 1.0)).collect();
                        let weights = expression_weights(&model.vrm, &values);
                        assert!(
                            weights.by_shape.values().all(|weight| weight.is_finite()),
                            "{place} {substitute}"
                        );
                    }
                    Err(error) => {
                        refused += 1;
                        assert!(!error.place.is_empty(), "{place} {substitute}: {error}");
                    }
                }
            }
        }
    }
    assert!(read_all > 1000 && refused > 1000, "{read_all} {refused}");
}

fn all_places(value: &Value, at: String, places: &mut Vec<String>) {
    match value {
        Value::Object(members) => {
            members.iter().for_each(|(key, member)| all_places(member, format!("{at}/{key}"), places));
        }
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(k, item)| all_places(item, format!("{at}/{k}"), places));
        }
        _ => {}
    }
    places.push(at);
}
