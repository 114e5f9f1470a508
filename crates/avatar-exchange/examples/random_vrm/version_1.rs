//! Extensions of VRM 1.

use crate::random::{Random, binds, vector};
use crate::{BONES, FACE};
use serde_json::{Map, Value, json};

const PRESETS_1: [&str; 10] =
    ["happy", "angry", "sad", "aa", "ih", "blink", "blinkLeft", "blinkRight", "lookLeft", "lookUp"];

/// Colours in the light of the material itself, with a cartoon's looks.
pub(crate) fn mtoon_1(random: &mut Random) -> Value {
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

/// For three nodes of the hair.
pub(crate) fn constraints(random: &mut Random) -> Vec<(usize, Value)> {
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
    // Planes and hollow shapes stand in an extension, beside a form for programs that do not know it.
    let mut extended = |node: usize, shape: Value| {
        let extension = json!({ "specVersion": "1.0", "shape": shape });
        json!({ "node": node, "shape": { "sphere": { "offset": vector(random), "radius": random.share() } },
            "extensions": { "VRMC_springBone_extended_collider": extension } })
    };
    let extended = [
        extended(1, json!({ "sphere": { "offset": [0.0, 0.25, 0.5], "radius": 0.75, "inside": true } })),
        extended(2, json!({ "capsule": { "radius": 0.5, "tail": [0.0, 0.5, 0.0], "inside": true } })),
        extended(0, json!({ "plane": { "offset": [0.0, -0.5, 0.0], "normal": [0.0, 1.0, 0.0] } })),
    ];
    let [hollow, tube, plane] = extended;
    json!({
        "specVersion": "1.0",
        "colliders": [
            { "node": 2, "shape": { "sphere": { "offset": vector(random), "radius": random.share() } } },
            { "node": 0, "shape": { "capsule": { "offset": vector(random), "tail": vector(random), "radius": random.share() } } },
            hollow, tube, plane
        ],
        "colliderGroups": [{ "name": "both", "colliders": [0, 1] }, { "colliders": [2, 3, 4] }],
        "springs": [{ "name": "hair", "joints": joints, "colliderGroups": [0, 1], "center": 2 }]
    })
}

pub(crate) fn version_1(random: &mut Random) -> Value {
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
