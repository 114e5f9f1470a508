//! Which nodes a file shows, and how often.

use super::document::{Document, in_range};
use crate::scene::{Finding, ImportError, Node, RawScene, Transform, Trs, quoted};
use glam::{Quat, Vec3};
use gltf::json::accessor::Type;
use gltf::json::{self, Accessor, Index};
use serde_json::Value;
use std::ops::Range;

const INSTANCING: &str = "EXT_mesh_gpu_instancing";
const VISIBILITY: &str = "KHR_node_visibility";

/// Whether a node's mesh is to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shown {
    Yes,
    /// The default scene does not have it.
    Elsewhere,
    /// It, or a node above it, is hidden.
    Hidden,
}

fn extension<'n>(node: &'n json::Node, name: &str) -> Option<&'n Value> {
    node.extensions.as_ref()?.others.get(name)
}

impl Document<'_> {
    /// For each mesh the nodes that show it and have no weights of their own.
    pub(super) fn showers(&self) -> Vec<Vec<usize>> {
        let mut showers = vec![Vec::new(); self.root.meshes.len()];
        let nodes = self.root.nodes.iter().enumerate().filter(|(_, node)| node.weights.is_none());
        for (number, node) in nodes {
            let mesh = node.mesh.and_then(|mesh| showers.get_mut(mesh.value()));
            mesh.into_iter().for_each(|nodes| nodes.push(number));
        }
        showers
    }

    /// For each node whether it is shown: what the default scene has, the one that the file says, or else its
    /// first; all where there is none.
    pub(super) fn shown(
        &mut self,
        nodes: &[json::Node],
        scene: &RawScene,
    ) -> Result<Vec<Shown>, ImportError> {
        let number = self.root.scene.map_or(0, |scene| scene.value());
        let roots: Vec<usize> = match self.root.scenes.get(number) {
            Some(scene) => scene.nodes.iter().map(|node| node.value()).collect(),
            None => {
                if self.root.scene.is_some() {
                    let text = format!("scene {number} is not there: all nodes are taken");
                    self.note("scene", Finding::Mended(text));
                }
                (0..nodes.len()).filter(|node| scene.nodes[*node].parent.is_none()).collect()
            }
        };
        let mut below: Vec<(usize, bool)> = roots.into_iter().map(|root| (root, true)).collect();
        let mut shown = vec![Shown::Elsewhere; nodes.len()];
        while let Some((number, is_visible)) = below.pop() {
            let node = in_range("nodes", nodes, number)?;
            if shown[number] != Shown::Elsewhere {
                continue;
            }
            let own = extension(node, VISIBILITY).and_then(|own| own.get("visible")?.as_bool());
            let is_visible = is_visible && own.unwrap_or(true);
            shown[number] = if is_visible { Shown::Yes } else { Shown::Hidden };
            below.extend(node.children.iter().flatten().map(|child| (child.value(), is_visible)));
        }
        Ok(shown)
    }

    /// The nodes that show a node's mesh: itself, or one below it for each of its instances, which are added
    /// to the end of the scene's nodes.
    pub(super) fn read_instances(
        &mut self,
        scene: &mut RawScene,
        number: usize,
        node: &json::Node,
    ) -> Result<Range<usize>, ImportError> {
        let itself = number..number + 1;
        let Some(json) = extension(node, INSTANCING) else { return Ok(itself) };
        let place = format!("node {number}, {INSTANCING}");
        if node.skin.is_some() {
            // Joints alone move it, so that all would be at one place.
            self.note(&place, Finding::left_out("its mesh has a skin: instances are left out"));
            return Ok(itself);
        }
        let attributes = json.get("attributes").and_then(Value::as_object);
        let mut accessors: [Option<Index<Accessor>>; 3] = [None; 3];
        for (name, accessor) in attributes.into_iter().flatten() {
            let Some(slot) = ["TRANSLATION", "ROTATION", "SCALE"].iter().position(|known| known == name)
            else {
                let text = format!("{} of its instances is left out", quoted(name));
                self.note(&place, Finding::LeftOut(text));
                continue;
            };
            let accessor = accessor.as_u64().and_then(|accessor| u32::try_from(accessor).ok());
            let accessor = accessor
                .ok_or_else(|| ImportError::new(&place, format!("an accessor as {name}"), "another value"))?;
            accessors[slot] = Some(Index::new(accessor));
        }
        let [translation, rotation, scale] = accessors;
        let mut vectors = |accessor: Option<Index<Accessor>>| match accessor {
            Some(accessor) => self.floats::<3, Vec3>(accessor, Type::Vec3).map(Some),
            None => Ok(None),
        };
        let (translations, scales) = (vectors(translation)?, vectors(scale)?);
        let rotations: Option<Vec<[f32; 4]>> = match rotation {
            Some(accessor) => Some(self.floats(accessor, Type::Vec4)?),
            None => None,
        };
        let counts = [
            translations.as_ref().map(Vec::len),
            rotations.as_ref().map(Vec::len),
            scales.as_ref().map(Vec::len),
        ];
        let mut counts = counts.into_iter().flatten();
        // Without any attribute there is nothing to say how many there are.
        let Some(count) = counts.next() else { return Ok(itself) };
        if let Some(other) = counts.find(|other| *other != count) {
            let expected = format!("{count} instances in each attribute");
            return Err(ImportError::new(place, expected, other.to_string()));
        }
        let base = scene.nodes[number].clone();
        let bytes = size_of::<Node>() + base.name.len() + 8 + size_of::<f32>() * base.weights.len();
        self.take(&place, count, bytes)?;
        let first = scene.nodes.len();
        for instance in 0..count {
            let local = Trs {
                translation: translations.as_ref().map_or(Vec3::ZERO, |all| all[instance]),
                rotation: rotations.as_ref().map_or(Quat::IDENTITY, |all| Quat::from_array(all[instance])),
                scale: scales.as_ref().map_or(Vec3::ONE, |all| all[instance]),
            };
            scene.nodes.push(Node {
                name: if base.name.is_empty() {
                    String::new()
                } else {
                    format!("{}.{}", base.name, instance + 1)
                },
                parent: Some(number),
                local: Transform::Trs(local),
                weights: base.weights.clone(),
            });
        }
        self.instances.insert(number, first..first + count);
        Ok(first..first + count)
    }
}
