use super::document::Document;
use crate::scene::quoted;
use crate::scene::{ImportError, Node, RawScene, Transform, Trs};
use glam::{DMat4, Quat, Vec3};

/// How far the last row of a matrix may be from 0, 0, 0, 1 before it is taken for a projection.
const MAX_PROJECTION: f32 = 1e-3;

impl Document<'_> {
    pub(super) fn read_nodes(&mut self, scene: &mut RawScene) -> Result<(), ImportError> {
        let nodes = &self.root.nodes;
        for (number, node) in nodes.iter().enumerate() {
            let place = || format!("node {number}");
            let local = match &node.matrix {
                Some(matrix) => Transform::from_matrix(affine(place, matrix)?),
                None => Transform::Trs(Trs {
                    translation: node.translation.map_or(Vec3::ZERO, Vec3::from_array),
                    rotation: node.rotation.map_or(Quat::IDENTITY, |rotation| Quat::from_array(rotation.0)),
                    scale: node.scale.map_or(Vec3::ONE, Vec3::from_array),
                }),
            };
            let name = node.name.clone().unwrap_or_default();
            scene.nodes.push(Node { name, parent: None, local, weights: Vec::new() });
        }
        for (parent, node) in nodes.iter().enumerate() {
            for child in node.children.iter().flatten() {
                let place = || format!("node {parent}, children");
                let length = scene.nodes.len();
                let Some(child) = scene.nodes.get_mut(child.value()) else {
                    let expected = format!("nodes below {length}");
                    return Err(ImportError::new(place(), expected, child.value().to_string()));
                };
                if let Some(other) = child.parent.replace(parent) {
                    let found = format!("{}, which is a child of node {other}, too", quoted(&child.name));
                    return Err(ImportError::new(place(), "nodes without another parent", found));
                }
            }
        }
        Ok(())
    }
}

/// A matrix in the order of the file, column by column, that has to be affine.
pub(super) fn affine(place: impl Fn() -> String, columns: &[f32; 16]) -> Result<DMat4, ImportError> {
    let last_row = [columns[3], columns[7], columns[11], columns[15] - 1.0];
    // A comparison that NaN fails, too.
    if !last_row.iter().all(|x| x.abs() <= MAX_PROJECTION) {
        let found = format!("{} {} {} {}", columns[3], columns[7], columns[11], columns[15]);
        return Err(ImportError::new(place(), "a matrix whose last row is 0 0 0 1", found));
    }
    Ok(DMat4::from_cols_array(&columns.map(f64::from)))
}
