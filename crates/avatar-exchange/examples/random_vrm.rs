//! Writes VRM files of random expressions, ranges of eyes, springs, constraints and cartoon materials, and
//! beside each what is made of it here, for another program to compare: `random_vrm FOLDER COUNT`.
// More than 400 lines: a program in one file, which writes all parts of one file and reads them back.
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program: it has arguments and writes files"
)]

use avatar_exchange::vrm::{
    ColliderShape, ConstraintKind, Gaze, LookAtKind, SpringChain, Version, VrmModel, expression_weights, read,
};
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
/// The nodes of a lock of hair on the head, behind the face: each with the one that it hangs on.
const HAIR: [usize; 5] = [2, FACE + 1, FACE + 2, FACE + 2, FACE + 3];
const NODES: usize = FACE + 1 + HAIR.len();
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
            let constraints = if is_new { constraints(&mut random) } else { Vec::new() };
            let material = if is_new { mtoon_1(&mut random) } else { json!({}) };
            let bytes = glb(extensions, &constraints, material);
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

fn vector(random: &mut Random) -> [f32; 3] {
    [0; 3].map(|_| 2.0 * random.share() - 1.0)
}

/// Colours in the light of the material itself, with a cartoon's looks.
fn mtoon_1(random: &mut Random) -> Value {
    let mut color = || [0; 3].map(|_| random.share());
    let (shade, outline) = (color(), color());
    json!({ "VRMC_materials_mtoon": {
        "specVersion": "1.0",
        "shadeColorFactor": shade,
        "shadingShiftFactor": 2.0 * random.share() - 1.0,
        "shadingToonyFactor": random.share(),
        "outlineWidthMode": "worldCoordinates",
        "outlineWidthFactor": 0.01 * random.share(),
        "outlineColorFactor": outline,
    } })
}

fn mtoon_0(random: &mut Random) -> Value {
    let mut color = || [0; 4].map(|_| random.share());
    let (lit, shade, outline) = (color(), color(), color());
    json!([{
        "name": "toon", "shader": "VRM/MToon", "renderQueue": 2000, "keywordMap": {}, "tagMap": {},
        "textureProperties": {},
        "floatProperties": { "_ShadeShift": 2.0 * random.share() - 1.0, "_ShadeToony": random.share(),
            "_OutlineWidth": random.share(), "_OutlineWidthMode": 1, "_BlendMode": 0, "_CullMode": 2 },
        "vectorProperties": { "_Color": lit, "_ShadeColor": shade, "_OutlineColor": outline }
    }])
}

/// For three nodes of the hair.
fn constraints(random: &mut Random) -> Vec<(usize, Value)> {
    let mut constraint = |kind: &str, mut more: Value, source: usize| {
        more["source"] = json!(source);
        more["weight"] = json!(random.share());
        json!({ "VRMC_node_constraint": { "specVersion": "1.0", "constraint": { kind: more } } })
    };
    let roll = constraint("roll", json!({ "rollAxis": "Y" }), 2);
    let aim = constraint("aim", json!({ "aimAxis": "NegativeZ" }), 3);
    let rotation = constraint("rotation", json!({}), FACE + 3);
    vec![(FACE + 2, roll), (FACE + 3, aim), (FACE + 4, rotation)]
}

fn springs_1(random: &mut Random) -> Value {
    let mut joint = |hair: usize| {
        json!({ "node": FACE + 1 + hair, "hitRadius": random.share(), "stiffness": 4.0 * random.share(),
            "gravityPower": random.share(), "gravityDir": vector(random), "dragForce": random.share() })
    };
    let joints = [0, 1, 2, 4].map(&mut joint);
    json!({
        "specVersion": "1.0",
        "colliders": [
            { "node": 2, "shape": { "sphere": { "offset": vector(random), "radius": random.share() } } },
            { "node": 0, "shape": { "capsule": { "offset": vector(random), "tail": vector(random), "radius": random.share() } } }
        ],
        "colliderGroups": [{ "name": "both", "colliders": [0, 1] }],
        "springs": [{ "name": "hair", "joints": joints, "colliderGroups": [0], "center": 2 }]
    })
}

fn springs_0(random: &mut Random) -> Value {
    let xyz = |[x, y, z]: [f32; 3]| json!({ "x": x, "y": y, "z": z });
    // three-vrm takes the sideways direction of gravity as it is and does not mirror the one to the front.
    let gravity = [random.share(), -random.share(), 0.0];
    json!({
        "boneGroups": [{ "comment": "hair", "stiffiness": 4.0 * random.share(), "gravityPower": random.share(),
            "gravityDir": xyz(gravity), "dragForce": random.share(), "center": 2,
            "hitRadius": random.share(), "bones": [FACE + 1], "colliderGroups": [0] }],
        "colliderGroups": [{ "node": 2, "colliders": [{ "offset": xyz(vector(random)), "radius": random.share() }] }]
    })
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
    }, "VRMC_springBone": springs_1(random) })
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
        "blendShapeMaster": { "blendShapeGroups": groups },
        "secondaryAnimation": springs_0(random),
        "materialProperties": mtoon_0(random)
    } })
}

/// Bones of one unit each and a triangle with shapes, in one file. `constraints` are extensions of nodes.
fn glb(extensions: Value, constraints: &[(usize, Value)], of_material: Value) -> Vec<u8> {
    let mut nodes: Vec<Value> = (BONES.iter().enumerate())
        .map(|(node, (bone, _))| {
            let children: Vec<usize> = (0..NODES).filter(|child| parent(*child) == Some(node)).collect();
            let mut json = json!({ "name": bone, "translation": [0.0, 1.0, 0.0] });
            if !children.is_empty() {
                json["children"] = json!(children);
            }
            json
        })
        .collect();
    nodes.push(json!({ "name": "face", "mesh": 0 }));
    for hair in 0..HAIR.len() {
        let children: Vec<usize> =
            (0..NODES).filter(|child| parent(*child) == Some(FACE + 1 + hair)).collect();
        let mut json = json!({ "name": format!("hair{hair}"), "translation": [0.0, -0.125, 0.0] });
        if !children.is_empty() {
            json["children"] = json!(children);
        }
        nodes.push(json);
    }
    for (node, extension) in constraints {
        nodes[*node]["extensions"] = extension.clone();
    }
    let mut used: Vec<String> =
        extensions.as_object().into_iter().flat_map(|all| all.keys().cloned()).collect();
    for extension in [&of_material].into_iter().chain(constraints.iter().map(|(_, extension)| extension)) {
        used.extend(extension.as_object().into_iter().flat_map(|all| all.keys().cloned()));
    }
    used.sort();
    used.dedup();
    let target = json!({ "POSITION": 0 });
    let json = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": used,
        "extensions": extensions,
        "scene": 0,
        "scenes": [{ "nodes": [0, FACE] }],
        "nodes": nodes,
        "buffers": [{ "byteLength": 36 }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "targets": vec![target; SHAPES], "material": 0 }] }],
        "materials": [{ "name": "toon", "extensions": of_material }]
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

/// What a node hangs on.
fn parent(node: usize) -> Option<usize> {
    match node.checked_sub(FACE + 1) {
        Some(hair) => HAIR.get(hair).copied(),
        None => BONES.get(node).and_then(|(_, parent)| *parent),
    }
}

/// Pairs of joints with what moves them: the last joint of version 0 has an end of its own.
fn springs(model: &VrmModel) -> Vec<Value> {
    let springs = &model.vrm.springs;
    let name = |node: usize| model.scene.nodes[node].name.clone();
    // Of version 0 the scene is turned around, three-vrm's is not.
    let turned =
        if model.vrm.version == Version::V0 { glam::Vec3::new(-1.0, 1.0, -1.0) } else { glam::Vec3::ONE };
    let of_chain = |chain: &SpringChain| {
        let mut found = Vec::new();
        for (at, joint) in chain.joints.iter().enumerate() {
            let next = chain.joints.get(at + 1);
            if next.is_none() && chain.tail.is_none() {
                continue;
            }
            let groups = chain.collider_groups.iter().map(|group| &springs.collider_groups[*group]);
            let colliders = groups.flat_map(|group| &group.colliders).map(|collider| {
                let collider = &springs.colliders[*collider];
                match collider.shape {
                    ColliderShape::Sphere { offset, radius } => {
                        json!({ "node": name(collider.node), "offset": offset.to_array(), "radius": radius })
                    }
                    ColliderShape::Capsule { offset, tail, radius } => {
                        json!({ "node": name(collider.node), "offset": offset.to_array(), "radius": radius, "tail": tail.to_array() })
                    }
                }
            });
            found.push(json!({
                "node": name(joint.node),
                "end": next.map(|next| name(next.node)),
                "center": chain.center.map(name),
                "numbers": [joint.hit_radius, joint.stiffness, joint.gravity_power, joint.drag_force],
                "gravityDir": (joint.gravity_dir * turned).to_array(),
                "colliders": colliders.collect::<Vec<_>>(),
            }));
        }
        found
    };
    springs.chains.iter().flat_map(of_chain).collect()
}

fn constraints_found(model: &VrmModel) -> Vec<Value> {
    let name = |node: usize| model.scene.nodes[node].name.clone();
    let axis = |kind: ConstraintKind| match kind {
        ConstraintKind::Roll { axis } => ("roll", Some(axis.to_array())),
        ConstraintKind::Aim { axis } => ("aim", Some(axis.to_array())),
        ConstraintKind::Rotation => ("rotation", None),
    };
    let found = model.vrm.constraints.iter().map(|one| {
        let (kind, axis) = axis(one.kind);
        json!({ "node": name(one.node), "source": name(one.source), "weight": one.weight, "kind": kind, "axis": axis })
    });
    found.collect()
}

fn toon(model: &VrmModel) -> Value {
    let material = &model.scene.materials[0];
    let toon = material.toon.clone().unwrap_or_default();
    json!({
        "base": material.base_color[..3],
        "shade": toon.shade_color,
        "outline": toon.outline_color,
        "numbers": [toon.shading_shift, toon.shading_toony, toon.outline_width],
    })
}

/// Weights for random values of expressions, what eyes do for random directions, and what stands in the file.
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
    json!({ "expressions": names, "weights": weights, "looks": looks, "springs": springs(model),
            "constraints": constraints_found(model), "toon": toon(model) })
}
