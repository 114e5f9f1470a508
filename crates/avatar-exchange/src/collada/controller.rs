//! Skins and morphs.

use super::Reader;
use super::geometry::Geometry;
use super::node::Nodes;
use super::source::inputs;
use super::transform::row_major;
use super::xml::At;
use crate::build::influences::Influences;
use crate::build::names::unique_names;
use crate::scene::{Finding, ImportError, Skin, narrow};
use glam::{DAffine3, DMat4, Vec3};
use std::collections::HashMap;
use std::rc::Rc;

/// What an instance shows: a geometry, perhaps through a morph and a skin.
#[derive(Debug)]
pub(super) struct Chain<'a> {
    pub(super) geometry: At<'a>,
    pub(super) skin: Option<At<'a>>,
    pub(super) morph: Option<At<'a>>,
}

/// Shapes of a morph.
#[derive(Debug, Default)]
pub(super) struct Morph {
    /// Names and offsets of points.
    pub(super) shapes: Vec<(String, HashMap<u32, Vec3>)>,
    /// Weights at rest, one for each shape.
    pub(super) weights: Vec<f32>,
    /// The `<source>` of the weights, which animations move.
    pub(super) source: Option<usize>,
}

/// Follows an instance to its geometry.
pub(super) fn chain(instance: At<'_>) -> Result<Chain<'_>, ImportError> {
    let (mut skin, mut morph) = (None, None);
    let mut at = instance.target("url")?;
    // A skin of a morph, or the other way around; each once.
    for _ in 0..3 {
        if at.name() == "geometry" {
            return Ok(Chain { geometry: at, skin, morph });
        }
        let found = at.children().find(|child| ["skin", "morph"].contains(&child.name()));
        let slot = match found.map(|found| (found, found.name())) {
            Some((found, "skin")) if skin.is_none() => skin.insert(found),
            Some((found, "morph")) if morph.is_none() => morph.insert(found),
            _ => break,
        };
        at = slot.target("source")?;
    }
    Err(instance.error("a geometry, perhaps in a skin and a morph", at.place()))
}

impl<'a> Reader<'a> {
    /// Adds a skin to the scene. Returns its number and the bones of its points.
    pub(super) fn skin(
        &mut self,
        at: At<'a>,
        skeletons: &[usize],
        node: usize,
        points: usize,
        nodes: &Nodes<'a>,
    ) -> Result<(usize, Influences), ImportError> {
        let bind = match at.child("bind_shape_matrix") {
            Some(matrix) => row_major(&matrix.exactly::<16>()?),
            None => DMat4::IDENTITY,
        };
        let Some(joints) = at.child("joints") else { return Err(at.error("<joints>", "none")) };
        let (names, inverse) = (self.source_of(joints, "JOINT")?, self.source_of(joints, "INV_BIND_MATRIX")?);
        let Some(names) = names else { return Err(joints.error("an input JOINT", "none")) };
        let mut skin =
            Skin { name: at.parent().map_or("", |parent| parent.label()).to_owned(), ..Skin::default() };
        for (number, name) in names.names.iter().enumerate() {
            let Some(joint) = nodes.joint(name, skeletons, &self.scene.nodes, self.tree) else {
                return Err(joints.error("joints that are nodes", format!("'{name}'")));
            };
            let joint_from_bind = inverse.as_ref().and_then(|inverse| inverse.item(number));
            if inverse.is_some() && joint_from_bind.map(<[f64]>::len) != Some(16) {
                return Err(joints.error(format!("16 numbers of inverse bind matrix {number}"), "others"));
            }
            let joint_from_mesh = joint_from_bind.map_or(DMat4::IDENTITY, row_major) * bind;
            skin.joints.push(joint);
            skin.inverse_binds.push(narrow(DAffine3::from_mat4(joint_from_mesh)));
        }
        let Ok(own) = u16::try_from(skin.joints.len()) else {
            return Err(joints.error("at most 65535 joints", skin.joints.len().to_string()));
        };
        let influences = self.influences(at, points, own)?;
        if influences.unweighted > 0 {
            skin.joints.push(node);
            skin.inverse_binds.push(narrow(DAffine3::from_mat4(bind)));
            let text = format!("{} points without weights follow the mesh's own node", influences.unweighted);
            self.note(at, Finding::Mended(text));
        }
        if let Some(text) = influences.note("points") {
            self.note(at, Finding::Converted(text));
        }
        self.scene.skins.push(skin);
        Ok((self.scene.skins.len() - 1, influences))
    }

    fn influences(&mut self, at: At<'a>, points: usize, own: u16) -> Result<Influences, ImportError> {
        let Some(list) = at.child("vertex_weights") else { return Err(at.error("<vertex_weights>", "none")) };
        let inputs = inputs(list)?;
        let stride = inputs.iter().map(|input| input.offset + 1).max().unwrap_or(1);
        let find = |semantic| inputs.iter().find(|input| input.semantic == semantic);
        let (Some(joint), Some(weight)) = (find("JOINT"), find("WEIGHT")) else {
            return Err(list.error("inputs JOINT and WEIGHT", "others"));
        };
        let weights = self.source(weight.source)?;
        let counts: Vec<usize> =
            list.child("vcount").map(|counts| counts.numbers()).transpose()?.unwrap_or_default();
        let indices: Vec<i64> = list.child("v").map(|list| list.numbers()).transpose()?.unwrap_or_default();
        if counts.len() != points {
            return Err(list.error(format!("weights of {points} points"), counts.len().to_string()));
        }
        let mut groups = indices.chunks_exact(stride);
        let mut influences = Influences::default();
        let mut bones = Vec::new();
        for count in counts {
            bones.clear();
            for _ in 0..count {
                let Some(group) = groups.next() else {
                    return Err(list.error("indices for all counts", "fewer"));
                };
                let (bone, number) = (group[joint.offset], group[weight.offset]);
                let number = usize::try_from(number).unwrap_or(usize::MAX);
                let Some(&[value, ..]) = weights.item(number) else {
                    return Err(list.error(format!("a weight below {}", weights.count), number.to_string()));
                };
                match u16::try_from(bone) {
                    Ok(bone) if bone < own => bones.push((bone, value)),
                    // −1 is the shape at bind pose.
                    Err(_) if bone == -1 => {}
                    _ => return Err(list.error(format!("a joint below {own}"), bone.to_string())),
                }
            }
            influences.push(&mut bones, own);
        }
        Ok(influences)
    }

    /// Reads the shapes of a morph of a geometry.
    pub(super) fn morph(&mut self, at: At<'a>, base: &Rc<Geometry>) -> Result<Morph, ImportError> {
        let Some(targets) = at.child("targets") else { return Err(at.error("<targets>", "none")) };
        let Some(ids) = self.source_of(targets, "MORPH_TARGET")? else {
            return Err(targets.error("an input MORPH_TARGET", "none"));
        };
        let source = inputs(targets)?.into_iter().find(|input| input.semantic == "MORPH_WEIGHT");
        let weights = source.as_ref().map(|input| self.source(input.source)).transpose()?;
        let relative = at.attribute("method") == Some("RELATIVE");
        let mut morph = Morph { source: source.map(|input| input.source.number), ..Morph::default() };
        let mut labels = Vec::new();
        for (number, id) in ids.names.iter().enumerate() {
            let Some(target) = self.tree.by_id(id).filter(|target| target.name() == "geometry") else {
                return Err(targets.error("geometries", format!("'{id}'")));
            };
            let shape = self.geometry(target)?;
            if shape.points.len() != base.points.len() {
                let expected = format!("{} points, as the base has", base.points.len());
                return Err(target.error(expected, shape.points.len().to_string()));
            }
            self.take(at, shape.points.len())?;
            let offset = |(to, from): (&Vec3, &Vec3)| if relative { *to } else { *to - *from };
            let offsets = shape.points.iter().zip(&base.points).map(offset).enumerate();
            let moved = offsets.filter(|(_, offset)| *offset != Vec3::ZERO);
            labels.push(target.label().to_owned());
            morph.shapes.push((String::new(), moved.map(|(point, offset)| (point as u32, offset)).collect()));
            let weight = weights.as_ref().and_then(|weights| weights.item(number)?.first().copied());
            morph.weights.push(weight.unwrap_or(0.0) as f32);
        }
        for ((name, _), label) in morph.shapes.iter_mut().zip(unique_names(labels)) {
            *name = label;
        }
        if !morph.shapes.is_empty() {
            let text = "shapes move positions; the normals of their targets are left out";
            self.note(at, Finding::left_out(text));
        }
        Ok(morph)
    }
}
