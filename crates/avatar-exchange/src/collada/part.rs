//! Instances of geometries and controllers become parts.

use super::Reader;
use super::controller::{Morph, chain};
use super::node::Nodes;
use super::xml::At;
use crate::scene::{Finding, ImportError, Node, ScenePart};
use std::collections::{HashMap, HashSet};

/// Nodes whose weights a `<source>` holds.
pub(super) type WeightNodes = HashMap<usize, Vec<usize>>;

/// Vertices that take as much as a part does without any, with the joint and the controls that become of its
/// node.
const PART_COST: usize = 32;

impl<'a> Reader<'a> {
    /// Reads all parts. `materials` are numbers by element.
    pub(super) fn read_parts(
        &mut self,
        nodes: &Nodes<'a>,
        materials: &HashMap<usize, usize>,
    ) -> Result<WeightNodes, ImportError> {
        let mut weights = WeightNodes::new();
        let mut taken = HashSet::new();
        for (number, element) in &nodes.elements {
            for instance in element.children() {
                if !["instance_geometry", "instance_controller"].contains(&instance.name()) {
                    continue;
                }
                let node = self.node_for(*number, instance, &mut taken)?;
                self.instance(node, instance, nodes, materials, &mut weights)?;
            }
        }
        Ok(weights)
    }

    /// The node itself, or one more below it: weights belong to nodes, and what else hangs there has other
    /// shapes.
    fn node_for(
        &mut self,
        node: usize,
        at: At<'a>,
        taken: &mut HashSet<usize>,
    ) -> Result<usize, ImportError> {
        if at.name() == "instance_geometry" && self.scene.nodes[node].weights.is_empty() {
            taken.insert(node);
            return Ok(node);
        }
        if at.name() == "instance_controller" && taken.insert(node) {
            return Ok(node);
        }
        self.take(at, 1)?;
        let name = self.scene.nodes[node].name.clone();
        self.scene.nodes.push(Node { name, parent: Some(node), ..Node::default() });
        Ok(self.scene.nodes.len() - 1)
    }

    fn has_geometries(&self) -> bool {
        let mut libraries = self.tree.root().all("library_geometries");
        libraries.any(|library| library.all("geometry").next().is_some())
    }

    fn instance(
        &mut self,
        node: usize,
        at: At<'a>,
        nodes: &Nodes<'a>,
        materials: &HashMap<usize, usize>,
        weights: &mut WeightNodes,
    ) -> Result<(), ImportError> {
        let chain = match chain(at) {
            Ok(chain) => chain,
            // Exporters of motion leave all meshes out, and let the instances of them stand.
            Err(error) if !self.has_geometries() => {
                let text =
                    format!("its mesh is left out: expected {}, found {}", error.expected, error.found);
                self.note(at, Finding::Missing(text));
                return Ok(());
            }
            Err(error) => return Err(error),
        };
        let geometry = self.geometry(chain.geometry)?;
        let morph = match chain.morph {
            Some(morph) => self.morph(morph, &geometry)?,
            None => Morph::default(),
        };
        let skin = match chain.skin {
            Some(skin) => {
                let skeletons = skeletons(at, nodes);
                Some(self.skin(skin, &skeletons, node, geometry.points.len(), nodes)?)
            }
            None => None,
        };
        let bound = bound(at);
        let before = self.scene.parts.len();
        for (number, primitive) in geometry.primitives.iter().enumerate() {
            if primitive.corners.is_empty() {
                continue;
            }
            // A part and its triangles, of which five take as much as a vertex.
            let corners = &primitive.corners;
            self.take(at, corners.vertices.len() + corners.triangles.len() / 5 + PART_COST)?;
            let mesh = primitive.corners.mesh(&geometry.points);
            let mut part = ScenePart::rigid(chain.geometry.label(), node, mesh);
            for (name, offsets) in &morph.shapes {
                let shape = primitive.corners.shape(name.clone(), offsets, None, &mut self.budget);
                part.mesh.shapes.push(shape.map_err(|exceeded| exceeded.at(at.place()))?);
            }
            if let Some((skin, influences)) = &skin {
                part.skin = Some(*skin);
                part.mesh.skinning = Some(primitive.corners.skinning(influences));
            }
            part.primitive = number;
            if let Some((target, at)) = bound.get(primitive.material.as_str()) {
                part.material = materials.get(target).copied();
                part.material.into_iter().for_each(|material| self.bind(*at, material, primitive));
            }
            self.scene.parts.push(part);
        }
        if self.scene.parts.len() > before {
            self.scene.nodes[node].weights = morph.weights;
            weights.entry(morph.source.unwrap_or(usize::MAX)).or_default().push(node);
        }
        Ok(())
    }
}

/// Nodes that an instance names as the roots of its joints.
fn skeletons(at: At<'_>, nodes: &Nodes<'_>) -> Vec<usize> {
    let mut found = Vec::new();
    for skeleton in at.all("skeleton").take(16) {
        let root = skeleton.text().strip_prefix('#').and_then(|id| skeleton.tree_by_id(id));
        found.extend(root.and_then(|root| nodes.of_element.get(&root.number)).into_iter().flatten().take(16));
    }
    found
}

/// By the names that primitives use: elements of materials, and what binds them.
fn bound(at: At<'_>) -> HashMap<&str, (usize, At<'_>)> {
    let technique = at.path(&["bind_material", "technique_common"]);
    let instances = technique.into_iter().flat_map(|technique| technique.all("instance_material"));
    instances
        .filter_map(|at| Some((at.attribute("symbol")?, (at.target("target").ok()?.number, at))))
        .collect()
}
