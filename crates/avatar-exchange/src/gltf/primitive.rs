use super::document::{Document, in_range};
use super::shown::Shown;
use super::targets::targets_of;
use super::triangles;
use super::vertex::{attribute, extra_name, same_count};
use crate::build::influences::{Four, Influences};
use crate::build::normals::normals_of;
use crate::scene::{Finding, ImportError, RawScene, ScenePart};
use avatar_mesh::{Mesh, Skinning};
use glam::{Vec3, Vec4};
use gltf::json::accessor::Type;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{self, Accessor, Index};

/// Bytes that a primitive without any data takes from the budget.
const PRIMITIVE_COST: usize = 1024;
/// The same of one of its attributes.
const ATTRIBUTE_COST: usize = 128;

impl Document<'_> {
    /// All meshes at all nodes, and the blend weights of these nodes.
    pub(super) fn read_parts(&mut self, scene: &mut RawScene) -> Result<(), ImportError> {
        let nodes = std::mem::take(&mut self.root.nodes);
        let meshes = std::mem::take(&mut self.root.meshes);
        let shown = self.shown(&nodes, scene)?;
        for (number, node) in nodes.iter().enumerate() {
            let Some(mesh) = node.mesh else { continue };
            let (mesh_number, mesh) = (mesh.value(), in_range("meshes", &meshes, mesh.value())?);
            let targets = targets_of(mesh);
            scene.nodes[number].weights = self.weights(number, node, mesh_number, mesh, targets)?;
            let place = format!("node {number}");
            match shown[number] {
                Shown::Yes => {}
                Shown::Elsewhere => {
                    let text = "is not in the default scene: its mesh is left out";
                    self.note(place, Finding::left_out(text));
                    continue;
                }
                Shown::Hidden => {
                    let text = "is hidden, or below a hidden one: its mesh is left out";
                    self.note(place, Finding::left_out(text));
                    continue;
                }
            }
            let instances = self.read_instances(scene, number, node)?;
            let place = format!("mesh {mesh_number}");
            let names = self.target_names(&place, mesh, targets)?;
            for at in instances {
                let name = match &scene.nodes[at].name {
                    name if !name.is_empty() => name.clone(),
                    _ => mesh.name.clone().unwrap_or_else(|| format!("node {number}")),
                };
                let skin = node.skin.map(|skin| skin.value());
                self.read_mesh(scene, Shower { node: at, name, skin }, &place, mesh, &names)?;
            }
        }
        Ok(())
    }

    /// The parts of a mesh at one node.
    fn read_mesh(
        &mut self,
        scene: &mut RawScene,
        shower: Shower,
        place: &str,
        mesh: &json::Mesh,
        names: &[String],
    ) -> Result<(), ImportError> {
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("{place}, primitive {number}");
            // Looking at it costs, too: few bytes can put many primitives at many nodes.
            let attributes: usize =
                primitive.attributes.keys().map(|key| ATTRIBUTE_COST + extra_name(key).len()).sum();
            self.take(&place, PRIMITIVE_COST + shower.name.len() + attributes, 1)?;
            let Some(mut mesh) = self.mesh(&place, primitive, names)? else { continue };
            let skin = match shower.skin {
                None => None,
                Some(skin) => {
                    in_range("skins", &scene.skins, skin)?;
                    mesh.skinning = self.skinning(&place, primitive, mesh.positions.len())?;
                    mesh.skinning.as_ref().map(|_| skin)
                }
            };
            if shower.skin.is_some() && skin.is_none() {
                self.note(&place, Finding::mended("has a skin but no JOINTS_0: it follows its node"));
            }
            let material = primitive.material.map(|material| material.value());
            let (name, node) = (shower.name.clone(), shower.node);
            scene.parts.push(ScenePart { name, node, primitive: number, mesh, material, skin });
        }
        Ok(())
    }

    /// The mesh of a primitive without its bones; `None` where there is nothing to fill.
    fn mesh(
        &mut self,
        place: &str,
        primitive: &Primitive,
        names: &[String],
    ) -> Result<Option<Mesh>, ImportError> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(ImportError::new(place, "a mode from 0 to 6", "another one"));
        };
        let Some(positions) = attribute(primitive, Semantic::Positions) else {
            self.note(place, Finding::left_out("has no POSITION and is left out"));
            return Ok(None);
        };
        let positions: Vec<Vec3> = self.floats::<3, _>(positions, Type::Vec3)?;
        let vertices = positions.len();
        let corners = match primitive.indices {
            Some(indices) => self.corners(indices, vertices)?,
            None => {
                self.take(place, vertices, size_of::<u32>())?;
                (0..u32::try_from(vertices).unwrap_or(u32::MAX)).collect()
            }
        };
        // A strip has nearly as many triangles as corners.
        self.take(place, corners.len(), size_of::<[u32; 3]>())?;
        let Some((triangles, left_over)) = triangles::of(mode, &corners) else {
            self.note(place, Finding::LeftOut(format!("{mode:?} are left out")));
            return Ok(None);
        };
        if left_over > 0 {
            let text = format!("{left_over} vertices at the end make no triangle");
            self.note(place, Finding::LeftOut(text));
        }
        let looks = primitive.material.and_then(|material| self.looks.get(material.value()).copied());
        let (uvs, uvs_1) = self.coordinates(place, primitive, looks.unwrap_or_default(), vertices)?;
        let colors = self.colors(place, primitive, vertices)?;
        let tangents = self.per_vertex::<4, Vec4>(primitive, Semantic::Tangents, Type::Vec4, vertices)?;
        let normals = match self.per_vertex::<3, Vec3>(primitive, Semantic::Normals, Type::Vec3, vertices)? {
            Some(normals) => normals,
            None => {
                let text =
                    "has no normals: those of its triangles are taken, smooth where they share vertices";
                self.note(place, Finding::mended(text));
                self.take(place, vertices, 3 * size_of::<Vec3>())?;
                normals_of(&positions, &triangles)
            }
        };
        let shapes = self.shapes(place, primitive, names, vertices)?;
        let tangents = tangents.unwrap_or_default();
        let mesh =
            Mesh { positions, uvs, uvs_1, colors, normals, tangents, triangles, shapes, ..Mesh::default() };
        Ok(Some(mesh))
    }

    fn corners(&mut self, indices: Index<Accessor>, vertices: usize) -> Result<Vec<u32>, ImportError> {
        let corners = self.indices(indices)?;
        match corners.iter().position(|&corner| corner as usize >= vertices) {
            None => Ok(corners),
            Some(at) => {
                let place = format!("accessor {}, element {at}", indices.value());
                let expected = format!("a vertex below {vertices}");
                Err(ImportError::new(place, expected, corners[at].to_string()))
            }
        }
    }

    /// All sets of joints and weights of a primitive, reduced to eight bones a vertex; `None` without a first
    /// set.
    fn skinning(
        &mut self,
        place: &str,
        primitive: &Primitive,
        vertices: usize,
    ) -> Result<Option<Skinning>, ImportError> {
        let mut sets = Vec::new();
        while let Some(joints) = attribute(primitive, Semantic::Joints(sets.len() as u32)) {
            let set = sets.len();
            let Some(weights) = attribute(primitive, Semantic::Weights(set as u32)) else {
                return Err(ImportError::new(place, format!("WEIGHTS_{set} for JOINTS_{set}"), "none"));
            };
            let joints_place = format!("accessor {}", joints.value());
            let joints = self.wholes::<4>(joints, Type::Vec4)?;
            same_count(&joints_place, vertices, joints.len())?;
            let (number, weights) = (weights.value(), self.floats::<4, [f32; 4]>(weights, Type::Vec4)?);
            same_count(&format!("accessor {number}"), vertices, weights.len())?;
            // The comparison fails for NaN, too.
            let valid = |weights: &[f32; 4]| weights.iter().all(|&w| (0.0..f32::INFINITY).contains(&w));
            if let Some(vertex) = weights.iter().position(|weights| !valid(weights)) {
                let place = format!("accessor {number}, element {vertex}");
                let found = format!("{:?}", weights[vertex]);
                return Err(ImportError::new(place, "weights that are not negative", found));
            }
            sets.push((joints, weights));
        }
        if sets.is_empty() {
            return Ok(None);
        }
        self.take(place, vertices, sets.len().min(2) * size_of::<Four>())?;
        let mut influences = Influences::with_capacity(vertices);
        let mut bones = Vec::with_capacity(4 * sets.len());
        for vertex in 0..vertices {
            bones.clear();
            for (joints, weights) in &sets {
                // No skin has a joint beyond u16; the check of the scene finds it and names the part.
                let joint = |joint: u32| u16::try_from(joint).unwrap_or(u16::MAX);
                bones.extend(joints[vertex].map(joint).into_iter().zip(weights[vertex].map(f64::from)));
            }
            influences.push(&mut bones, 0);
        }
        if let Some(text) = influences.note("vertices") {
            self.note(place, Finding::Converted(text));
        }
        if influences.unweighted > 0 {
            let text = format!("{} vertices without weight follow the first joint", influences.unweighted);
            self.note(place, Finding::Mended(text));
        }
        Ok(Some(influences.into_skinning()))
    }
}

/// A node that shows a mesh.
struct Shower {
    node: usize,
    name: String,
    skin: Option<usize>,
}
