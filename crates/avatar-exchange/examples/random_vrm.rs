//! Writes VRM files of random expressions and ranges of eyes, and beside each what is made of it here, for
//! another program to compare: `random_vrm FOLDER COUNT`.
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program: it has arguments and writes files"
)]

use avatar_exchange::vrm::{Gaze, LookAtKind, VrmModel, expression_weights, read};
use serde_json::{Map, Value, json};
use std::error::Error;
use std::path::Path;

/// The bones that every VRM has to have, each with the one that it hangs on.
const BONES: [(&str, Option<usize>); 18] = [
    ("hips", None),
    ("spine", Some(0)),
    ("head", Some(1)),
    ("leftEye", Some(2)),
    ("rightEye", Some(2)),
    ("jaw", Some(2)),
    ("leftUpperLeg", Some(0)),
    ("leftLowerLeg", Some(6)),
    ("leftFoot", Some(7)),
    ("rightUpperLeg", Some(0)),
    ("rightLowerLeg", Some(9)),
    ("rightFoot", Some(10)),
    ("leftUpperArm", Some(1)),
    ("leftLowerArm", Some(12)),
    ("leftHand", Some(13)),
    ("rightUpperArm", Some(1)),
    ("rightLowerArm", Some(15)),
    ("rightHand", Some(16)),
];
/// The node with the shapes, behind the bones.
const FACE: usize = BONES.len();
const SHAPES: usize = 6;
const PRESETS_1: [&str; 10] =
    ["happy", "angry", "sad", "aa", "ih", "blink", "blinkLeft", "blinkRight", "lookLeft", "lookUp"];
/// With the names that the older ones have in the newer version, by which both programs know them.
const PRESETS_0: [(&str, &str); 8] = [
    ("joy", "happy"),
    ("angry", "angry"),
    ("sorrow", "sad"),
    ("a", "aa"),
    ("i", "ih"),
    ("blink", "blink"),
    ("blink_l", "blinkLeft"),
    ("lookleft", "lookLeft"),
];

/// xorshift64*.
struct Random(u64);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % end
    }

    /// Of few digits, so that texts say it exactly.
    fn share(&mut self) -> f32 {
        self.below(65) as f32 / 64.0
    }

    fn one_of<'a>(&mut self, texts: &[&'a str]) -> &'a str {
        texts[self.below(texts.len() as u64) as usize]
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, count] = &arguments[..] else { return Err("expected FOLDER COUNT".into()) };
    for seed in 0..count.parse()? {
        for is_new in [false, true] {
            let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ (seed + 1));
            let extensions = if is_new { version_1(&mut random) } else { version_0(&mut random) };
            let bytes = glb(extensions);
            let model = read("random.vrm", &bytes, &mut |_| Err("no other files".to_owned()))?;
            let path = Path::new(folder).join(format!("{}-{seed}.vrm", u8::from(is_new)));
            std::fs::write(path.with_extension("json"), expected(&model, &mut random).to_string())?;
            std::fs::write(path, bytes)?;
        }
    }
    Ok(())
}

fn binds(random: &mut Random) -> Vec<(u64, f32)> {
    (0..random.below(4)).map(|_| (random.below(SHAPES as u64), random.share())).collect()
}

fn version_1(random: &mut Random) -> Value {
    let expression = |random: &mut Random| {
        let binds = binds(random);
        let binds =
            binds.iter().map(|(shape, weight)| json!({ "node": FACE, "index": shape, "weight": weight }));
        let binds: Vec<Value> = binds.collect();
        let mut kind = || random.one_of(&["none", "none", "block", "blend"]);
        json!({ "morphTargetBinds": binds, "overrideBlink": kind(), "overrideLookAt": kind(), "overrideMouth": kind(),
                "isBinary": kind() == "block" })
    };
    // What an expression says of its own kind is invalid, and three-vrm follows it all the same.
    let without_own_kind = |name: &str, mut expression: Value| {
        let own = match name {
            _ if name.starts_with("blink") => "overrideBlink",
            _ if name.starts_with("look") => "overrideLookAt",
            "aa" | "ih" => "overrideMouth",
            _ => return expression,
        };
        expression[own] = json!("none");
        expression
    };
    let presets: Map<String, Value> = PRESETS_1
        .iter()
        .map(|name| ((*name).to_owned(), without_own_kind(name, expression(random))))
        .collect();
    let range = |random: &mut Random| json!({ "inputMaxValue": 10.0 + 80.0 * random.share(), "outputScale": 30.0 * random.share() });
    let bones: Map<String, Value> = BONES
        .iter()
        .enumerate()
        .map(|(node, (bone, _))| ((*bone).to_owned(), json!({ "node": node })))
        .collect();
    json!({ "VRMC_vrm": {
        "specVersion": "1.0",
        "meta": { "name": "random", "authors": ["chance"], "licenseUrl": "https://vrm.dev/licenses/1.0/" },
        "humanoid": { "humanBones": bones },
        "expressions": { "preset": presets, "custom": { "pout": expression(random) } },
        "lookAt": {
            "type": random.one_of(&["bone", "bone", "expression"]),
            "offsetFromHeadBone": [0.0, 0.06, 0.0],
            "rangeMapHorizontalInner": range(random),
            "rangeMapHorizontalOuter": range(random),
            "rangeMapVerticalDown": range(random),
            "rangeMapVerticalUp": range(random),
        }
    } })
}

fn version_0(random: &mut Random) -> Value {
    let mut group = |name: &str, preset: &str| {
        let binds = binds(random);
        let binds: Vec<Value> = binds
            .iter()
            .map(|(shape, weight)| json!({ "mesh": 0, "index": shape, "weight": 100.0 * weight }))
            .collect();
        json!({ "name": name, "presetName": preset, "isBinary": random.below(4) == 0, "binds": binds })
    };
    let mut groups: Vec<Value> = PRESETS_0.iter().map(|(preset, _)| group(preset, preset)).collect();
    groups.push(group("pout", "unknown"));
    let mut range = || json!({ "curve": [0, 0, 0, 1, 1, 1, 1, 0], "xRange": 10.0 + 80.0 * random.share(), "yRange": 30.0 * random.share() });
    let bones: Vec<Value> =
        BONES.iter().enumerate().map(|(node, (bone, _))| json!({ "bone": bone, "node": node })).collect();
    json!({ "VRM": {
        "specVersion": "0.0",
        "meta": { "title": "random" },
        "humanoid": { "humanBones": bones },
        "firstPerson": {
            "firstPersonBone": 2,
            "firstPersonBoneOffset": { "x": 0.0, "y": 0.06, "z": 0.0 },
            "lookAtTypeName": "Bone",
            "lookAtHorizontalInner": range(),
            "lookAtHorizontalOuter": range(),
            "lookAtVerticalDown": range(),
            "lookAtVerticalUp": range(),
        },
        "blendShapeMaster": { "blendShapeGroups": groups }
    } })
}

/// Bones of one unit each and a triangle with shapes, in one file.
fn glb(extensions: Value) -> Vec<u8> {
    let mut nodes: Vec<Value> = (BONES.iter().enumerate())
        .map(|(node, (bone, _))| {
            let children: Vec<usize> =
                (0..BONES.len()).filter(|child| BONES[*child].1 == Some(node)).collect();
            let mut json = json!({ "name": bone, "translation": [0.0, 1.0, 0.0] });
            if !children.is_empty() {
                json["children"] = json!(children);
            }
            json
        })
        .collect();
    nodes.push(json!({ "name": "face", "mesh": 0 }));
    let target = json!({ "POSITION": 0 });
    let json = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": extensions.as_object().map(|all| all.keys().cloned().collect::<Vec<_>>()),
        "extensions": extensions,
        "scene": 0,
        "scenes": [{ "nodes": [0, FACE] }],
        "nodes": nodes,
        "buffers": [{ "byteLength": 36 }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "targets": vec![target; SHAPES] }] }]
    });
    let mut text = json.to_string();
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let corners: Vec<u8> =
        [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    let length = 12 + 8 + text.len() + 8 + corners.len();
    bytes.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text.as_bytes()), (b"BIN\0", &corners)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

/// Weights for random values of expressions, and what eyes do for random directions.
fn expected(model: &VrmModel, random: &mut Random) -> Value {
    let names: Vec<&str> = model.vrm.expressions.iter().map(|expression| expression.name.as_str()).collect();
    let weights: Vec<Value> = (0..40)
        .map(|_| {
            let chosen: Vec<&str> = names.iter().copied().filter(|_| random.below(3) == 0).collect();
            let values: Vec<(&str, f32)> = chosen.iter().map(|name| (*name, random.share())).collect();
            let mut pose = model.scene.rest();
            expression_weights(&model.vrm, &values).apply(&mut pose);
            json!({ "values": values, "weights": pose.weights[FACE] })
        })
        .collect();
    let looks: Vec<Value> = (model.vrm.look_at.iter())
        .flat_map(|look_at| (0..20).map(move |k| (look_at, k)))
        .map(|(look_at, _)| {
            let gaze =
                Gaze { yaw_deg: 200.0 * (random.share() - 0.5), pitch_deg: 160.0 * (random.share() - 0.5) };
            let eyes = look_at.eyes(gaze);
            let bones = [eyes.left, eyes.right].map(|eye| [eye.yaw_deg, eye.pitch_deg]);
            let is_bone = look_at.kind == LookAtKind::Bone;
            let found = if is_bone { json!(bones) } else { json!(look_at.expressions(gaze)) };
            json!({ "yaw": gaze.yaw_deg, "pitch": gaze.pitch_deg, "bone": is_bone, "found": found })
        })
        .collect();
    json!({ "expressions": names, "weights": weights, "looks": looks })
}
