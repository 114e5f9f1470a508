//! Writes VRM files of random expressions, ranges of eyes, springs, constraints and cartoon materials, and
//! beside each what is made of it here, for another program to compare: `random_vrm FOLDER COUNT`.
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program: it has arguments and writes files"
)]

mod expected;
mod random;
mod version_0;
mod version_1;

use avatar_exchange::vrm::read;
use expected::expected;
use random::Random;
use serde_json::{Value, json};
use std::error::Error;
use std::path::Path;
use version_0::version_0;
use version_1::{constraints, mtoon_1, version_1};

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
