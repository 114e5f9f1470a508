//! Morph targets: their number, names, weights and offsets.

use super::document::Document;
use super::vertex::same_count;
use crate::build::names::unique_names;
use crate::build::shape::{SHAPE_BYTES_PER_VERTEX, shape};
use crate::scene::{Finding, ImportError};
use avatar_mesh::{Offsets, Shape};
use glam::Vec3;
use gltf::json::accessor::Type;
use gltf::json::extras::Extras;
use gltf::json::mesh::{MorphTarget, Primitive};
use gltf::json::{self, Accessor, Index};
use serde_json::Value;
use std::collections::HashSet;

/// Bytes that a target without any data takes from the budget, half of it.
const TARGET_COST: usize = 256;

/// How many targets a mesh has. The standard wants as many in each primitive; there are files where only
/// some have any.
pub(super) fn targets_of(mesh: &json::Mesh) -> usize {
    mesh.primitives.iter().map(own_targets).max().unwrap_or(0)
}

fn own_targets(primitive: &Primitive) -> usize {
    primitive.targets.as_ref().map_or(0, Vec::len)
}

fn names_in(extras: &Extras) -> Option<Vec<Option<String>>> {
    let extras: Value = serde_json::from_str(extras.as_ref()?.get()).ok()?;
    let names = extras.get("targetNames")?.as_array()?;
    Some(names.iter().map(|name| name.as_str().map(str::to_owned)).collect())
}

impl Document<'_> {
    /// The weights of a node at rest: its own, or else its mesh's (section 3.7.2.2).
    pub(super) fn weights(
        &mut self,
        number: usize,
        node: &json::Node,
        mesh_number: usize,
        mesh: &json::Mesh,
        targets: usize,
    ) -> Result<Vec<f32>, ImportError> {
        let weights = node.weights.as_ref().or(mesh.weights.as_ref()).filter(|weights| !weights.is_empty());
        match weights {
            None => Ok(vec![0.0; targets]),
            Some(weights) if weights.len() == targets => Ok(weights.clone()),
            Some(weights) => {
                let place = format!("node {number} or mesh {mesh_number}, weights");
                let expected = format!("{targets} weights, one for each target");
                Err(ImportError::new(place, expected, weights.len().to_string()))
            }
        }
    }

    /// Names of morph targets: those of the mesh's `extras.targetNames`, on which most exporters agree; of a
    /// primitive's, as VRM 0.x has them; of the accessors of positions, where all have one and no two the
    /// same; or numbers.
    pub(super) fn target_names(
        &mut self,
        place: &str,
        mesh: &json::Mesh,
        targets: usize,
    ) -> Result<Vec<String>, ImportError> {
        let extras = mesh.primitives.iter().map(|primitive| &primitive.extras).chain([&mesh.extras]);
        let extras: usize = extras.flatten().map(|extras| extras.get().len()).sum();
        self.take(place, extras + TARGET_COST * targets, 2)?;
        if targets == 0 {
            return Ok(Vec::new());
        }
        let of_primitives = || mesh.primitives.iter().find_map(|primitive| names_in(&primitive.extras));
        let given =
            names_in(&mesh.extras).or_else(of_primitives).or_else(|| self.accessor_names(mesh, targets));
        let given = given.unwrap_or_default();
        let name = |number: usize| match given.get(number) {
            Some(Some(name)) => name.clone(),
            _ => format!("target {number}"),
        };
        Ok(unique_names((0..targets).map(name).collect()))
    }

    fn accessor_names(&self, mesh: &json::Mesh, targets: usize) -> Option<Vec<Option<String>>> {
        let primitive = mesh.primitives.iter().find(|primitive| own_targets(primitive) == targets)?;
        let name = |target: &MorphTarget| {
            let accessor = self.root.accessors.get(target.positions.or(target.normals)?.value())?;
            accessor.name.as_deref().filter(|name| !name.is_empty())
        };
        let names: Option<Vec<&str>> = primitive.targets.iter().flatten().map(name).collect();
        let names = names?;
        let distinct: HashSet<&str> = names.iter().copied().collect();
        (distinct.len() == names.len()).then(|| names.into_iter().map(|name| Some(name.to_owned())).collect())
    }

    /// The shapes of a primitive; those that it has no target for do not move.
    pub(super) fn shapes(
        &mut self,
        place: &str,
        primitive: &Primitive,
        names: &[String],
        vertices: usize,
    ) -> Result<Vec<Shape>, ImportError> {
        let mut shapes = Vec::with_capacity(names.len());
        let targets = primitive.targets.as_deref().unwrap_or(&[]);
        for (number, name) in names.iter().enumerate() {
            let Some(target) = targets.get(number) else {
                self.take(place, name.len() + size_of::<Shape>(), 1)?;
                shapes.push(shape(name.clone(), vertices, None, None));
                continue;
            };
            let further = if target.tangents.is_some() { size_of::<Vec3>() } else { 0 };
            let bytes = name.len() + vertices * (SHAPE_BYTES_PER_VERTEX + further);
            self.take(place, bytes, 1)?;
            shapes.push(self.shape(&format!("{place}, target {number}"), target, name.clone(), vertices)?);
        }
        if targets.len() < names.len() {
            let text =
                format!("has {} targets of {}: the others leave it at rest", targets.len(), names.len());
            self.note(place, Finding::Mended(text));
        }
        Ok(shapes)
    }

    fn shape(
        &mut self,
        place: &str,
        target: &MorphTarget,
        name: String,
        vertices: usize,
    ) -> Result<Shape, ImportError> {
        let mut offsets = |accessor: Option<Index<Accessor>>| {
            let Some(accessor) = accessor else { return Ok(None) };
            let offsets: Vec<Vec3> = self.floats::<3, _>(accessor, Type::Vec3)?;
            same_count(place, vertices, offsets.len())?;
            Ok(Some(offsets))
        };
        let (positions, normals) = (offsets(target.positions)?, offsets(target.normals)?);
        let tangents = offsets(target.tangents)?.filter(|offsets| offsets.iter().any(|o| *o != Vec3::ZERO));
        Ok(Shape { tangents: tangents.map(Offsets::from_dense), ..shape(name, vertices, positions, normals) })
    }
}
