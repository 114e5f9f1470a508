//! Blend shapes. A channel of FBX is a slider on which shapes stand at their full weights.

use super::{note, place_of, vec3};
use crate::build::budget::{Budget, Exceeded};
use crate::build::corners::Corners;
use crate::build::names::unique_names;
use crate::scene::{Finding, NodeDrivers, Note, RawScene};
use avatar_mesh::Shape;
use avatar_mesh::drivers::{Input, Rule, ShapeDrivers, ShapeRule};
use glam::Vec3;
use std::collections::{HashMap, HashSet};

/// The shapes of a node and the channels that drive them.
#[derive(Debug)]
pub(super) struct Blend<'a> {
    /// The node's number.
    pub(super) node: usize,
    /// Element number and weight at rest of each channel.
    pub(super) channels: Vec<(u32, f32)>,
    /// Full weights of each channel's shapes, and 0: where weights of shapes have kinks.
    pub(super) kinks: Vec<Vec<f64>>,
    /// From weights of channels to weights of shapes.
    pub(super) program: ShapeDrivers,
    drivers: NodeDrivers,
    in_betweens: bool,
    targets: Vec<Target<'a>>,
}

/// A shape as the file has it.
struct Target<'a>(&'a ufbx::BlendShape);

impl std::fmt::Debug for Target<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Target").field(&&*self.0.element.name).finish()
    }
}

impl<'a> Blend<'a> {
    /// The shapes of a mesh at a node; empty if the mesh has no shapes.
    pub(super) fn of(node: &ufbx::Node, mesh: &'a ufbx::Mesh, notes: &mut Vec<Note>) -> Option<Self> {
        let channels: Vec<_> = mesh.blend_deformers.iter().flat_map(|blend| &blend.channels).collect();
        let drivers = unique_names(channels.iter().map(|channel| channel.element.name.to_string()).collect());
        let (mut names, mut full_weights, mut targets) = (Vec::new(), Vec::new(), Vec::new());
        let mut kinks = vec![vec![0.0]; channels.len()];
        for (number, channel) in channels.iter().enumerate() {
            let mut seen = HashSet::new();
            let usable = |weight: f32| weight.is_finite() && weight != 0.0;
            let last = channel.keyframes.iter().map(|key| key.target_weight).fold(f64::MIN, f64::max);
            for key in &channel.keyframes {
                let full_weight = key.target_weight as f32;
                if !usable(full_weight) || !seen.insert(full_weight.to_bits()) {
                    let text =
                        format!("a shape of channel '{}' at {} is left out", drivers[number], full_weight);
                    note(notes, place_of(node), Finding::LeftOut(text));
                    continue;
                }
                names.push(match key.target_weight == last {
                    true => drivers[number].clone(),
                    false => format!("{}@{}", drivers[number], full_weight * 100.0),
                });
                full_weights.push((number, full_weight));
                kinks[number].push(f64::from(full_weight));
                targets.push(Target(key.shape.as_ref()));
            }
        }
        if targets.is_empty() {
            return None;
        }
        let names = unique_names(names);
        let follows = |(shape, (channel, full_weight)): (&String, &(usize, f32))| ShapeRule {
            shape: shape.clone(),
            rule: Rule::Follows {
                input: Input::Driver(drivers[*channel].clone()),
                full_weight: *full_weight,
            },
        };
        let rules: Vec<ShapeRule> = names.iter().zip(&full_weights).map(follows).collect();
        let program = match ShapeDrivers::new(&drivers, &names, &rules) {
            Ok(program) => program,
            Err(error) => {
                let text = format!("blend shapes are left out: {error}");
                note(notes, place_of(node), Finding::LeftOut(text));
                return None;
            }
        };
        let in_betweens =
            names.len() != drivers.len() || full_weights.iter().any(|(_, weight)| *weight != 1.0);
        let node = node.element.typed_id as usize;
        let channels = channels.iter().map(|channel| (channel.element.element_id, channel.weight as f32));
        let channels: Vec<(u32, f32)> = channels.collect();
        let rest =
            channels.iter().map(|(_, weight)| if weight.is_finite() { *weight } else { 0.0 }).collect();
        Some(Self {
            node,
            channels,
            kinks,
            program,
            drivers: NodeDrivers { node, drivers, rest, shapes: names, rules },
            in_betweens,
            targets,
        })
    }

    /// The weights of shapes for weights of channels; values that are not finite count as 0.
    pub(super) fn weights(&self, channels: &[f32]) -> Vec<f32> {
        let mut weights = vec![0.0; self.targets.len()];
        // There is a value for each driver and a weight for each shape, so that this cannot fail.
        if self.program.run(channels, &mut weights).is_err() {
            weights.fill(0.0);
        }
        weights.iter().map(|weight| if weight.is_finite() { *weight } else { 0.0 }).collect()
    }

    /// The shapes for a part's vertices.
    pub(super) fn shapes(&self, corners: &Corners, budget: &mut Budget) -> Result<Vec<Shape>, Exceeded> {
        let mut shapes = Vec::with_capacity(self.targets.len());
        for (Target(target), name) in self.targets.iter().zip(&self.drivers.shapes) {
            let offsets = offsets(target, &target.position_offsets);
            let normals = offsets_of_normals(target, corners);
            shapes.push(corners.shape(name.clone(), &offsets, normals, budget)?);
        }
        Ok(shapes)
    }

    /// Weights at rest, and rules where a slider is not simply a shape's weight.
    pub(super) fn write(&self, scene: &mut RawScene) {
        let rest: Vec<f32> = self.channels.iter().map(|(_, weight)| *weight).collect();
        scene.nodes[self.node].weights = self.weights(&rest);
        if self.in_betweens {
            scene.drivers.push(self.drivers.clone());
        }
    }
}

fn offsets(target: &ufbx::BlendShape, values: &ufbx::List<ufbx::Vec3>) -> HashMap<u32, Vec3> {
    let offset = |(number, (point, offset)): (usize, (&u32, &ufbx::Vec3))| {
        let weight = target.offset_weights.get(number).map_or(1.0, |weight| *weight as f32);
        (*point, vec3(*offset) * weight)
    };
    target.offset_vertices.iter().zip(values.iter()).enumerate().map(offset).collect()
}

/// Offsets of vertices' normals, where the file has some that are not 0.
fn offsets_of_normals(target: &ufbx::BlendShape, corners: &Corners) -> Option<Vec<Vec3>> {
    let offsets = offsets(target, &target.normal_offsets);
    if offsets.values().all(|offset| *offset == Vec3::ZERO) {
        return None;
    }
    let of =
        |point: &u32| offsets.get(point).copied().filter(|offset| offset.is_finite()).unwrap_or_default();
    Some(corners.vertices.iter().map(|corner| of(&corner.point)).collect())
}
