use super::document::{Document, in_range};
use super::triangles;
use crate::build::influences::{Four, Influences};
use crate::build::names::unique_names;
use crate::build::normals::normals_of;
use crate::build::shape::{SHAPE_BYTES_PER_VERTEX, shape};
use crate::scene::{Finding, ImportError, RawScene, ScenePart};
use avatar_mesh::{Mesh, Offsets, Shape, Skinning};
use glam::{Vec2, Vec3, Vec4};
use gltf::json::accessor::Type;
use gltf::json::mesh::{MorphTarget, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{self, Accessor, Index};
use serde_json::Value;

/// Bytes that a primitive without any data takes from the budget.
const PRIMITIVE_COST: usize = 1024;
/// The same of one of its targets, half of it.
const TARGET_COST: usize = 256;
/// The same of one of its attributes.
const ATTRIBUTE_COST: usize = 128;

impl Document<'_> {
    /// All meshes at all nodes, and the blend weights of these nodes.
    pub(super) fn read_parts(&mut self, scene: &mut RawScene) -> Result<(), ImportError> {
        let nodes = std::mem::take(&mut self.root.nodes);
        let meshes = std::mem::take(&mut self.root.meshes);
        let is_shown = self.shown(&nodes)?;
        for (number, node) in nodes.iter().enumerate() {
            let Some(mesh) = node.mesh else { continue };
            let (mesh_number, mesh) = (mesh.value(), in_range("meshes", &meshes, mesh.value())?);
            let targets =
                mesh.primitives.first().and_then(|first| first.targets.as_ref()).map_or(0, Vec::len);
            let weights =
                node.weights.as_ref().or(mesh.weights.as_ref()).filter(|weights| !weights.is_empty());
            scene.nodes[number].weights = match weights {
                None => vec![0.0; targets],
                Some(weights) if weights.len() == targets => weights.clone(),
                Some(weights) => {
                    let place = format!("node {number} or mesh {mesh_number}, weights");
                    let expected = format!("{targets} weights, one for each target");
                    return Err(ImportError::new(place, expected, weights.len().to_string()));
                }
            };
            if !is_shown[number] {
                let text = "is not in the default scene: its mesh is left out";
                self.note(format!("node {number}"), Finding::left_out(text));
                continue;
            }
            let place = format!("mesh {mesh_number}");
            let names = self.target_names(&place, mesh, targets)?;
            let name = node.name.as_ref().or(mesh.name.as_ref()).cloned();
            let name = name.unwrap_or_else(|| format!("node {number}"));
            for (primitive_number, primitive) in mesh.primitives.iter().enumerate() {
                let place = format!("{place}, primitive {primitive_number}");
                let found = primitive.targets.as_ref().map_or(0, Vec::len);
                if found != targets {
                    let expected = format!("{targets} targets, as primitive 0 has");
                    return Err(ImportError::new(place, expected, found.to_string()));
                }
                // Looking at it costs, too: few bytes can put many primitives at many nodes.
                let attributes: usize =
                    primitive.attributes.keys().map(|key| ATTRIBUTE_COST + extra_name(key).len()).sum();
                self.take(&place, PRIMITIVE_COST + name.len() + attributes, 1)?;
                let Some(mut mesh) = self.mesh(&place, primitive, &names)? else { continue };
                let skin = match node.skin {
                    None => None,
                    Some(skin) => {
                        in_range("skins", &scene.skins, skin.value())?;
                        mesh.skinning = self.skinning(&place, primitive, mesh.positions.len())?;
                        mesh.skinning.as_ref().map(|_| skin.value())
                    }
                };
                if node.skin.is_some() && skin.is_none() {
                    self.note(&place, Finding::mended("has a skin but no JOINTS_0: it follows its node"));
                }
                let material = primitive.material.map(|material| material.value());
                scene.parts.push(ScenePart {
                    name: name.clone(),
                    node: number,
                    primitive: primitive_number,
                    mesh,
                    material,
                    skin,
                });
            }
        }
        Ok(())
    }

    /// For each node whether the default scene has it: the one that the file says, or else its first; all
    /// where there is none.
    fn shown(&mut self, nodes: &[json::Node]) -> Result<Vec<bool>, ImportError> {
        let number = self.root.scene.map_or(0, |scene| scene.value());
        let Some(scene) = self.root.scenes.get(number) else {
            if self.root.scene.is_some() {
                let text = format!("scene {number} is not there: all nodes are taken");
                self.note("scene", Finding::Mended(text));
            }
            return Ok(vec![true; nodes.len()]);
        };
        let mut below: Vec<usize> = scene.nodes.iter().map(|node| node.value()).collect();
        let mut is_shown = vec![false; nodes.len()];
        while let Some(number) = below.pop() {
            let node = in_range("nodes", nodes, number)?;
            if !std::mem::replace(&mut is_shown[number], true) {
                below.extend(node.children.iter().flatten().map(|child| child.value()));
            }
        }
        Ok(is_shown)
    }

    /// Names of morph targets: those of `extras.targetNames`, which exporters agree on, or numbers.
    fn target_names(
        &mut self,
        place: &str,
        mesh: &json::Mesh,
        targets: usize,
    ) -> Result<Vec<String>, ImportError> {
        let extras = mesh.extras.as_ref().map_or("", |extras| extras.get());
        self.take(place, extras.len() + TARGET_COST * targets, 2)?;
        let extras: Value = serde_json::from_str(extras).unwrap_or_default();
        let given = extras.get("targetNames").and_then(Value::as_array);
        let name = |number: usize| given.and_then(|names| names.get(number)?.as_str());
        let names =
            (0..targets).map(|number| name(number).map_or_else(|| format!("target {number}"), str::to_owned));
        Ok(unique_names(names.collect()))
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
        let uvs = self.per_vertex::<2, Vec2>(primitive, Semantic::TexCoords(0), Type::Vec2, vertices)?;
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
        self.note_attributes(place, primitive);
        let mut shapes = Vec::with_capacity(names.len());
        for (number, target) in primitive.targets.iter().flatten().enumerate() {
            let further = if target.tangents.is_some() { size_of::<Vec3>() } else { 0 };
            let bytes = names[number].len() + vertices * (SHAPE_BYTES_PER_VERTEX + further);
            self.take(place, bytes, 1)?;
            let place = format!("{place}, target {number}");
            shapes.push(self.shape(&place, target, names[number].clone(), vertices)?);
        }
        let uvs = uvs.unwrap_or_else(|| vec![Vec2::ZERO; vertices]);
        let tangents = tangents.unwrap_or_default();
        Ok(Some(Mesh { positions, uvs, normals, tangents, triangles, shapes, ..Mesh::default() }))
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

    fn per_vertex<const N: usize, T: From<[f32; N]> + bytemuck::Pod>(
        &mut self,
        primitive: &Primitive,
        semantic: Semantic,
        type_: Type,
        vertices: usize,
    ) -> Result<Option<Vec<T>>, ImportError> {
        let Some(accessor) = attribute(primitive, semantic) else { return Ok(None) };
        let values = self.floats::<N, T>(accessor, type_)?;
        same_count(&format!("accessor {}", accessor.value()), vertices, values.len())?;
        Ok(Some(values))
    }

    /// All sets of joints and weights of a primitive, reduced to four bones a vertex; `None` without a first
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
        self.take(place, vertices, size_of::<Four>())?;
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
        if influences.reduced > 0 {
            let text = format!(
                "{} vertices have more than four bones: the four largest are kept",
                influences.reduced
            );
            self.note(place, Finding::Converted(text));
        }
        if influences.unweighted > 0 {
            let text = format!("{} vertices without weight follow the first joint", influences.unweighted);
            self.note(place, Finding::Mended(text));
        }
        Ok(Some(influences.into_skinning()))
    }

    fn take(&mut self, place: &str, count: usize, size: usize) -> Result<(), ImportError> {
        self.budget.take(count, size).map_err(|exceeded| exceeded.at(place))
    }

    fn note_attributes(&mut self, place: &str, primitive: &Primitive) {
        for semantic in primitive.attributes.keys() {
            let name = match semantic {
                Checked::Valid(Semantic::Colors(set)) => format!("COLOR_{set}"),
                Checked::Valid(Semantic::TexCoords(set)) if *set > 0 => format!("TEXCOORD_{set}"),
                Checked::Valid(Semantic::Extras(_)) => format!("_{}", extra_name(semantic)),
                Checked::Invalid => "an unknown attribute".to_owned(),
                _ => continue,
            };
            self.note(place, Finding::LeftOut(format!("{name} is left out")));
        }
    }
}

/// The name of an attribute that the file made up, without its underscore; empty for others.
fn extra_name(semantic: &Checked<Semantic>) -> &str {
    match semantic {
        Checked::Valid(Semantic::Extras(name)) => name,
        _ => "",
    }
}

fn attribute(primitive: &Primitive, semantic: Semantic) -> Option<Index<Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}

fn same_count(place: &str, vertices: usize, found: usize) -> Result<(), ImportError> {
    if found == vertices {
        return Ok(());
    }
    Err(ImportError::new(place, format!("{vertices} elements, one for each vertex"), found.to_string()))
}
