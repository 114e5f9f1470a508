//! VRM 0.x: the extension `VRM`, <https://github.com/vrm-c/vrm-specification/tree/master/specification/0.0>.

use super::meta::terms;
use super::place::Place;
use super::{Expression, LookAt, LookAtKind, Meta, MorphBind, RangeMap, Version, Vrm, note};
use super::{first_person, mtoon_v0, spring_v0};
use crate::scene::{Finding, ImportError, RawScene};
use glam::Vec3;
use std::collections::HashSet;

/// Presets of 0.x by what VRM 1.0 calls them.
const PRESETS: [(&str, &str); 17] = [
    ("neutral", "neutral"),
    ("joy", "happy"),
    ("angry", "angry"),
    ("sorrow", "sad"),
    ("fun", "relaxed"),
    ("a", "aa"),
    ("i", "ih"),
    ("u", "ou"),
    ("e", "ee"),
    ("o", "oh"),
    ("blink", "blink"),
    ("blink_l", "blinkLeft"),
    ("blink_r", "blinkRight"),
    ("lookup", "lookUp"),
    ("lookdown", "lookDown"),
    ("lookleft", "lookLeft"),
    ("lookright", "lookRight"),
];

/// A file names a bind once, and it counts at every node of its mesh; more than this is no face.
const MOST_BINDS: usize = 1 << 20;

/// Bones of 0.x whose names VRM 1.0 gave to the next bone.
const BONES: [(&str, &str); 4] = [
    ("leftThumbProximal", "leftThumbMetacarpal"),
    ("leftThumbIntermediate", "leftThumbProximal"),
    ("rightThumbProximal", "rightThumbMetacarpal"),
    ("rightThumbIntermediate", "rightThumbProximal"),
];

fn translated<'n>(names: &[(&str, &'n str)], name: &str) -> Option<&'n str> {
    names.iter().find(|(old, _)| *old == name).map(|(_, new)| *new)
}

/// `nodes_of_meshes` are per mesh of the file the nodes that show it: expressions of 0.x speak of meshes.
/// `textures` are the image of each texture.
pub(super) fn read(
    vrm: &Place<'_>,
    nodes_of_meshes: &[Vec<usize>],
    textures: &[Option<usize>],
    raw: &mut RawScene,
) -> Result<Vrm, ImportError> {
    let mut humanoid = Vec::new();
    for place in vrm.need("humanoid")?.list("humanBones")? {
        let bone = place.need("bone")?.str()?;
        let bone = translated(&BONES, bone).unwrap_or(bone);
        if let Some(node) = place.need("node")?.index_or_none("a node", raw.nodes.len())? {
            humanoid.push((bone.to_owned(), node));
        }
    }
    let mut expressions: Vec<Expression> = Vec::new();
    if let Some(master) = vrm.get("blendShapeMaster")? {
        let (mut names, mut binds_left) = (HashSet::new(), MOST_BINDS);
        for place in master.list("blendShapeGroups")? {
            let expression = expression(&place, nodes_of_meshes, &mut binds_left, raw)?;
            if !names.insert(expression.name.clone()) {
                let text = format!("a second expression '{}' is left out", expression.name);
                note(raw, place.path(), Finding::LeftOut(text));
                continue;
            }
            expressions.push(expression);
        }
    }
    let look_at = vrm.get("firstPerson")?.map(|place| look_at(&place, raw)).transpose()?;
    let first_person = vrm.get("firstPerson")?;
    let first_person = first_person.map(|place| first_person::read_v0(&place, nodes_of_meshes, raw));
    let springs = vrm.get("secondaryAnimation")?.map(|place| spring_v0::read(&place, raw)).transpose()?;
    mtoon_v0::read(vrm, textures, raw)?;
    Ok(Vrm {
        version: Version::V0,
        meta: meta(vrm)?,
        humanoid,
        expressions,
        look_at,
        first_person: first_person.transpose()?.unwrap_or_default(),
        springs: springs.unwrap_or_default(),
        constraints: Vec::new(),
    })
}

fn meta(vrm: &Place<'_>) -> Result<Meta, ImportError> {
    let Some(meta) = vrm.get("meta")? else { return Ok(Meta::default()) };
    let author = meta.text("author")?;
    let named = meta.text("licenseName")?;
    let licence = if named.is_empty() || named == "Other" { meta.text("otherLicenseUrl")? } else { named };
    Ok(Meta {
        title: meta.text("title")?,
        version: meta.text("version")?,
        authors: if author.is_empty() { Vec::new() } else { vec![author] },
        licence,
        terms: terms(&meta, &["title", "version", "author", "licenseName", "texture"])?,
    })
}

fn expression(
    place: &Place<'_>,
    nodes: &[Vec<usize>],
    binds_left: &mut usize,
    raw: &mut RawScene,
) -> Result<Expression, ImportError> {
    let preset = place.text("presetName")?.to_lowercase();
    let preset = translated(&PRESETS, &preset);
    let mut binds = Vec::new();
    for bind in place.list("binds")? {
        let (mesh, index) = (bind.need("mesh")?, bind.need("index")?);
        let Some(mesh) = mesh.index_or_none("a mesh", nodes.len())? else { continue };
        // From 0 to 100.
        let weight = bind.float_or("weight", 100.0)? / 100.0;
        *binds_left = binds_left
            .checked_sub(nodes[mesh].len())
            .ok_or_else(|| bind.wrong(format!("at most {MOST_BINDS} shapes at nodes in all expressions")))?;
        for &node in &nodes[mesh] {
            let shape = index.index("a shape of the mesh", raw.nodes[node].weights.len())?;
            binds.push(MorphBind { node, shape, weight });
        }
    }
    let changes = place.list("materialValues")?.len();
    if changes > 0 {
        let text = format!("{changes} changes of materials are not represented");
        note(raw, place.path(), Finding::LeftOut(text));
    }
    let name = match preset {
        Some(preset) => preset.to_owned(),
        None => place.text("name")?,
    };
    let is_binary = place.flag("isBinary")?;
    Ok(Expression { name, is_preset: preset.is_some(), is_binary, binds, ..Expression::default() })
}

fn look_at(place: &Place<'_>, raw: &mut RawScene) -> Result<LookAt, ImportError> {
    let kind = match place.text("lookAtTypeName")?.as_str() {
        "" | "Bone" => LookAtKind::Bone,
        "BlendShape" => LookAtKind::Expression,
        _ => return Err(place.need("lookAtTypeName")?.wrong("Bone or BlendShape")),
    };
    let offset_from_head = match place.get("firstPersonBoneOffset")? {
        None => LookAt::default().offset_from_head,
        // Of a left-handed space: forward is +z there and −z in the file.
        Some(offset) => {
            let [x, y, z] = ["x", "y", "z"].map(|axis| offset.float_or(axis, 0.0));
            Vec3::new(x?, y?, -z?)
        }
    };
    let mut range = |key: &str| {
        let default = RangeMap::default();
        let Some(map) = place.get(key)? else { return Ok(default) };
        // The straight line from 0, 0 to 1, 1 with slopes of 1.
        let curve: Result<Vec<f32>, _> = map.list("curve")?.iter().map(Place::float).collect();
        let is_straight =
            |curve: &[f32]| curve.is_empty() || curve == [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0];
        if !is_straight(&curve?) {
            note(raw, map.path(), Finding::converted("its curve is taken as a straight line"));
        }
        Ok::<_, ImportError>(RangeMap {
            input_max_deg: map.float_or("xRange", default.input_max_deg)?,
            output_scale: map.float_or("yRange", default.output_scale)?,
        })
    };
    Ok(LookAt {
        kind,
        offset_from_head,
        horizontal_inner: range("lookAtHorizontalInner")?,
        horizontal_outer: range("lookAtHorizontalOuter")?,
        vertical_down: range("lookAtVerticalDown")?,
        vertical_up: range("lookAtVerticalUp")?,
    })
}
