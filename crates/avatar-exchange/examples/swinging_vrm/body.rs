//! A VRM 1.0 of spheres with chains of joints. Tests of the viewer use it, too.

use serde_json::{Value, json};
use std::f32::consts::{PI, TAU};

const HIPS: usize = 0;
const CHEST: usize = 1;
const HEAD: usize = 2;
/// Rings and segments of a sphere.
const RINGS: u16 = 12;
const SEGMENTS: u16 = 20;
/// Keys of the clip, in seconds from each to the next, and how far the head turns, in radians.
const KEYS: usize = 121;
const KEY_SECS: f32 = 1.0 / 60.0;
const TURN: f32 = 0.6;
/// How far the hips go, and how high they are, in metres.
const SWAY: f32 = 0.07;
const HEIGHT: f32 = 0.9;

/// Nodes, and the springs that move some of them.
#[derive(Default)]
struct Body {
    nodes: Vec<Value>,
    springs: Vec<Value>,
}

impl Body {
    fn add(&mut self, parent: Option<usize>, mut node: Value) -> usize {
        node["children"] = json!([]);
        self.nodes.push(node);
        let index = self.nodes.len() - 1;
        if let Some(Value::Array(children)) = parent.and_then(|parent| self.nodes[parent].get_mut("children"))
        {
            children.push(json!(index));
        }
        index
    }

    fn bone(&mut self, parent: Option<usize>, name: &str, place: [f32; 3]) -> usize {
        self.add(parent, json!({ "name": name, "translation": place }))
    }

    fn ball(&mut self, parent: usize, place: [f32; 3], size: [f32; 3], material: usize) {
        let name = format!("ball {}", self.nodes.len());
        self.add(
            Some(parent),
            json!({ "name": name, "translation": place, "scale": size, "mesh": material }),
        );
    }

    /// A chain of joints with a ball on each, each a step from the one before.
    fn chain(
        &mut self,
        name: &str,
        parent: usize,
        from: [f32; 3],
        step: [f32; 3],
        joints: usize,
        joint: &Value,
    ) {
        let (mut at, mut place, mut settings) = (parent, from, Vec::new());
        for number in 0..=joints {
            at = self.bone(Some(at), &format!("{name} {number}"), place);
            place = step;
            let mut own = joint.clone();
            own["node"] = json!(at);
            settings.push(own);
            if number < joints {
                let width = if name == "skirt" { 0.055 } else { 0.045 - 0.006 * number as f32 };
                let half = step.map(|x| 0.5 * x);
                let material = if name == "skirt" { 2 } else { 1 };
                self.ball(at, half, [width, 0.6 * step[1].abs(), width], material);
            }
        }
        let groups = if name == "skirt" { json!([1]) } else { json!([0]) };
        self.springs.push(json!({ "name": name, "joints": settings, "colliderGroups": groups }));
    }
}

/// The bytes of the file.
pub(crate) fn swinging() -> Vec<u8> {
    let mut body = Body::default();
    body.bone(None, "hips", [0.0, HEIGHT, 0.0]);
    body.bone(Some(HIPS), "chest", [0.0, 0.25, 0.0]);
    body.bone(Some(CHEST), "head", [0.0, 0.32, 0.0]);
    body.ball(HIPS, [0.0; 3], [0.14, 0.12, 0.11], 2);
    body.ball(CHEST, [0.0, -0.02, 0.0], [0.14, 0.2, 0.1], 2);
    body.ball(HEAD, [0.0, 0.1, 0.0], [0.11, 0.14, 0.12], 0);
    for side in [-1.0, 1.0] {
        body.ball(HEAD, [0.04 * side, 0.12, 0.105], [0.018, 0.018, 0.012], 3);
    }
    body.ball(HEAD, [0.0, 0.085, 0.12], [0.015, 0.015, 0.02], 0);
    body.ball(HEAD, [0.0, 0.14, -0.015], [0.118, 0.115, 0.12], 1);
    let hair = json!({ "stiffness": 0.35, "dragForce": 0.25, "gravityPower": 0.4, "hitRadius": 0.03 });
    for side in [-1.0, 1.0] {
        let name = if side < 0.0 { "plait right" } else { "plait left" };
        body.chain(name, HEAD, [0.13 * side, 0.12, -0.02], [0.01 * side, -0.075, 0.0], 4, &hair);
    }
    body.chain("tail", HEAD, [0.0, 0.17, -0.15], [0.0, -0.075, -0.015], 5, &hair);
    let cloth = json!({ "stiffness": 0.8, "dragForce": 0.4, "gravityPower": 0.3, "hitRadius": 0.03 });
    for number in 0..10u8 {
        let (x, z) = (TAU * f32::from(number) / 10.0).sin_cos();
        body.chain("skirt", HIPS, [0.12 * x, -0.02, 0.1 * z], [0.03 * x, -0.1, 0.03 * z], 3, &cloth);
    }
    file(body)
}

fn file(body: Body) -> Vec<u8> {
    let (positions, triangles) = sphere();
    let times: Vec<f32> = (0..KEYS).map(|key| key as f32 * KEY_SECS).collect();
    let turns: Vec<f32> = times.iter().flat_map(|secs| turn(*secs)).collect();
    // The hips sway to the sides meanwhile.
    let sways: Vec<f32> = times.iter().flat_map(|secs| [SWAY * (TAU * secs).sin(), HEIGHT, 0.0]).collect();
    let mut bin: Vec<u8> = Vec::new();
    let mut views = Vec::new();
    let floats = [&positions, &times, &turns, &sways];
    let chunks = floats.map(|list| list.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>());
    let indices = triangles.iter().flat_map(|x| x.to_le_bytes()).collect();
    for chunk in chunks.into_iter().chain([indices]) {
        views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": chunk.len() }));
        bin.extend(chunk);
    }
    bin.resize(bin.len().next_multiple_of(4), 0);
    let corners = positions.len() / 3;
    let last = KEY_SECS * (KEYS - 1) as f32;
    let colors = [[0.9, 0.68, 0.55], [0.25, 0.1, 0.04], [0.1, 0.22, 0.5], [0.01, 0.01, 0.02]];
    let mesh = |material: usize| json!({ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 0 }, "indices": 4, "material": material }] });
    let json = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["VRMC_vrm", "VRMC_springBone"],
        "extensions": {
            "VRMC_vrm": {
                "specVersion": "1.0",
                "meta": { "name": "Swing", "authors": ["nobody"], "licenseUrl": "https://vrm.dev/licenses/1.0/" },
                "humanoid": { "humanBones": {
                    "hips": { "node": HIPS }, "spine": { "node": CHEST }, "head": { "node": HEAD }
                } },
            },
            "VRMC_springBone": {
                "specVersion": "1.0",
                "colliders": [
                    { "node": HEAD, "shape": { "sphere": { "offset": [0.0, 0.1, 0.0], "radius": 0.115 } } },
                    { "node": CHEST, "shape": { "capsule": { "offset": [0.0, 0.08, 0.0], "tail": [0.0, -0.1, 0.0], "radius": 0.13 } } },
                    { "node": HIPS, "shape": { "capsule": { "tail": [0.0, -0.5, 0.0], "radius": 0.09 } } }
                ],
                "colliderGroups": [{ "colliders": [0, 1] }, { "colliders": [2] }],
                "springs": body.springs
            }
        },
        "scene": 0,
        "scenes": [{ "nodes": [HIPS] }],
        "nodes": body.nodes.into_iter().map(without_empty_children).collect::<Vec<_>>(),
        "buffers": [{ "byteLength": bin.len() }],
        "bufferViews": views,
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": corners, "min": [-1, -1, -1], "max": [1, 1, 1] },
            { "bufferView": 1, "componentType": 5126, "type": "SCALAR", "count": KEYS, "min": [0.0], "max": [last] },
            { "bufferView": 2, "componentType": 5126, "type": "VEC4", "count": KEYS },
            { "bufferView": 3, "componentType": 5126, "type": "VEC3", "count": KEYS },
            { "bufferView": 4, "componentType": 5123, "type": "SCALAR", "count": triangles.len() }
        ],
        "meshes": (0..4).map(mesh).collect::<Vec<_>>(),
        "materials": colors.map(|[r, g, b]| json!({ "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7 } })),
        "animations": [{
            "name": "shake",
            "channels": [
                { "sampler": 0, "target": { "node": HEAD, "path": "rotation" } },
                { "sampler": 1, "target": { "node": HIPS, "path": "translation" } }
            ],
            "samplers": [{ "input": 1, "output": 2 }, { "input": 1, "output": 3 }]
        }]
    });
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(((12 + 8 + text.len() + 8 + bin.len()) as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", bin)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

/// Lists of glTF are not empty.
fn without_empty_children(mut node: Value) -> Value {
    if let Some(object) = node.as_object_mut()
        && object["children"].as_array().is_some_and(Vec::is_empty)
    {
        object.remove("children");
    }
    node
}

/// The head's rotation: to both sides and back, once a second, and still at the end.
fn turn(secs: f32) -> [f32; 4] {
    let angle = TURN * (TAU * secs).sin() * (1.0 - secs / 2.0).max(0.0).sqrt();
    [0.0, (angle / 2.0).sin(), 0.0, (angle / 2.0).cos()]
}

/// Places of a sphere of radius 1, which are its normals as well, and corners of its triangles.
fn sphere() -> (Vec<f32>, Vec<u16>) {
    let ring = |ring: u16| PI * f32::from(ring) / f32::from(RINGS);
    let place = |at: u16, segment: u16| {
        let (around, (out, up)) = (TAU * f32::from(segment) / f32::from(SEGMENTS), ring(at).sin_cos());
        [out * around.sin(), up, out * around.cos()]
    };
    let places = (0..=RINGS).flat_map(|at| (0..=SEGMENTS).flat_map(move |segment| place(at, segment)));
    let quad = |at: u16, segment: u16| {
        let corner = at * (SEGMENTS + 1) + segment;
        let below = corner + SEGMENTS + 1;
        [corner, below, corner + 1, corner + 1, below, below + 1]
    };
    let triangles = (0..RINGS).flat_map(|at| (0..SEGMENTS).flat_map(move |segment| quad(at, segment)));
    (places.collect(), triangles.collect())
}
