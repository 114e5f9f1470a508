//! Extensions of VRM 0.

use crate::random::{Random, binds, vector};
use crate::{BONES, FACE};
use serde_json::{Value, json};

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

pub(crate) fn version_0(random: &mut Random) -> Value {
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
