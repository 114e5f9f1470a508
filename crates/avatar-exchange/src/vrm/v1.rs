//! VRM 1.0: the extension `VRMC_vrm`, <https://github.com/vrm-c/vrm-specification>.

use super::first_person;
use super::meta::terms;
use super::place::Place;
use super::{Expression, LookAt, LookAtKind, Meta, MorphBind, Override, RangeMap, Version, Vrm, note};
use crate::scene::{Finding, ImportError, RawScene};
use glam::Vec3;
use std::collections::HashSet;

pub(super) fn read(vrm: &Place<'_>, raw: &mut RawScene) -> Result<Vrm, ImportError> {
    vrm.version_1("specVersion")?;
    let mut humanoid = Vec::new();
    for (bone, place) in vrm.need("humanoid")?.members("humanBones")? {
        let node = place.need("node")?.index("a node", raw.nodes.len())?;
        humanoid.push((bone.to_owned(), node));
    }
    let (mut expressions, mut names) = (Vec::new(), HashSet::new());
    if let Some(all) = vrm.get("expressions")? {
        for (kind, is_preset) in [("preset", true), ("custom", false)] {
            for (name, place) in all.members(kind)? {
                if !names.insert(name) {
                    return Err(ImportError::new(
                        place.path(),
                        "a name that no preset has",
                        format!("'{name}'"),
                    ));
                }
                expressions.push(expression(name, is_preset, &place, raw)?);
            }
        }
    }
    let look_at = vrm.get("lookAt")?.map(|place| look_at(&place)).transpose()?;
    let first_person = vrm.get("firstPerson")?.map(|place| first_person::read(&place, raw)).transpose()?;
    Ok(Vrm {
        version: Version::V1,
        meta: meta(vrm)?,
        humanoid,
        expressions,
        look_at,
        first_person: first_person.unwrap_or_default(),
        ..Vrm::default()
    })
}

fn meta(vrm: &Place<'_>) -> Result<Meta, ImportError> {
    let Some(meta) = vrm.get("meta")? else { return Ok(Meta::default()) };
    let authors = meta.list("authors")?;
    let authors = authors.iter().map(|author| author.str().map(str::to_owned));
    Ok(Meta {
        title: meta.text("name")?,
        version: meta.text("version")?,
        authors: authors.collect::<Result<_, _>>()?,
        licence: meta.text("licenseUrl")?,
        terms: terms(&meta, &["name", "version", "authors", "licenseUrl", "thumbnailImage"])?,
    })
}

fn expression(
    name: &str,
    is_preset: bool,
    place: &Place<'_>,
    raw: &mut RawScene,
) -> Result<Expression, ImportError> {
    let mut binds = Vec::new();
    for bind in place.list("morphTargetBinds")? {
        let node = bind.need("node")?.index("a node", raw.nodes.len())?;
        let shape = bind.need("index")?.index("a shape of the node", raw.nodes[node].weights.len())?;
        binds.push(MorphBind { node, shape, weight: bind.float_or("weight", 1.0)? });
    }
    for (key, what) in [("materialColorBinds", "colours"), ("textureTransformBinds", "textures")] {
        let count = place.list(key)?.len();
        if count > 0 {
            let text = format!("{count} changes of {what} are not represented");
            note(raw, place.path(), Finding::LeftOut(text));
        }
    }
    let overrides = |key: &str| match place.get(key)? {
        None => Ok(Override::None),
        Some(place) => match place.str()? {
            "none" => Ok(Override::None),
            "block" => Ok(Override::Block),
            "blend" => Ok(Override::Blend),
            _ => Err(place.wrong("none, block or blend")),
        },
    };
    Ok(Expression {
        name: name.to_owned(),
        is_preset,
        is_binary: place.flag("isBinary")?,
        override_blink: overrides("overrideBlink")?,
        override_look_at: overrides("overrideLookAt")?,
        override_mouth: overrides("overrideMouth")?,
        binds,
    })
}

fn look_at(place: &Place<'_>) -> Result<LookAt, ImportError> {
    let kind = match place.get("type")? {
        None => LookAtKind::Bone,
        Some(kind) => match kind.str()? {
            "bone" => LookAtKind::Bone,
            "expression" => LookAtKind::Expression,
            _ => return Err(kind.wrong("bone or expression")),
        },
    };
    let offset_from_head = match place.list("offsetFromHeadBone")?.is_empty() {
        true => LookAt::default().offset_from_head,
        false => place.vec3_or("offsetFromHeadBone", Vec3::ZERO)?,
    };
    let range = |key: &str| match place.get(key)? {
        None => Ok(RangeMap::default()),
        Some(map) => {
            let default = RangeMap::default();
            Ok::<_, ImportError>(RangeMap {
                input_max_deg: map.float_or("inputMaxValue", default.input_max_deg)?,
                output_scale: map.float_or("outputScale", default.output_scale)?,
            })
        }
    };
    Ok(LookAt {
        kind,
        offset_from_head,
        horizontal_inner: range("rangeMapHorizontalInner")?,
        horizontal_outer: range("rangeMapHorizontalOuter")?,
        vertical_down: range("rangeMapVerticalDown")?,
        vertical_up: range("rangeMapVerticalUp")?,
    })
}
