//! A scene as GLB.
//!
//! ```text
//!  Scene ──plan──▶ nodes and meshes ──▶ primitives, materials, animations ──buffer──▶ JSON, BIN ──▶ GLB
//! ```

mod animation;
mod buffer;
mod material;
mod mesh;
mod plan;

use crate::scene::{ImportError, RawScene, Scene, Skin, Transform};
use buffer::Buffer;
use glam::Affine3A;
use plan::{Plan, PlannedNode};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

const JSON_CHUNK: u32 = 0x4e4f_534a;
const BIN_CHUNK: u32 = 0x004e_4942;

/// Why a scene could not be written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The scene contradicts itself.
    #[error(transparent)]
    Scene(#[from] ImportError),
    /// A negative bone weight, which glTF cannot express.
    #[error("part {part} '{name}', vertex {vertex}: expected weights that are not negative, found {found}")]
    NegativeWeight {
        /// Position of the part.
        part: usize,
        /// Its name.
        name: String,
        /// The vertex.
        vertex: usize,
        /// The weight.
        found: f32,
    },
    /// The lengths in a GLB have 32 bits.
    #[error("expected a file below 4 GiB, found {bytes} bytes")]
    TooLarge {
        /// What the file would take.
        bytes: u64,
    },
}

/// Writes a scene as one GLB: glTF 2.0 with all its data inside. The same scene gives the same bytes.
///
/// Reading the bytes gives the scene again, to the bit, where glTF can express it. Elsewhere the file deforms
/// and looks the same, but
///
/// * parts of one node with different skins or shape names get nodes of their own below it; so does a joint
///   that is in a skin twice; and trees whose nodes share a skin hang from one new root;
/// * a mesh has one name, that of its node, and numbers its primitives without gaps;
/// * bones that are twice at a vertex are added up, those without weight become the first; weights whose sum
///   is off by more than glTF's validator grants are divided by it; normals, tangents and rotations are given
///   unit length;
/// * a part without triangles gets one without area;
/// * of channels for the same property the last stays; times that are equal move apart by the least step; a
///   clip that begins before 0 is moved to begin there; one whose channels move nothing that the file has is
///   left out;
/// * numbers of materials and colours of vertices outside of glTF's ranges are clamped; pictures without
///   bytes are left out, with their uses; second texture coordinates that a material needs and a part lacks
///   are 0;
/// * media types follow the bytes where these are known. WebP, KTX2 and AVIF are those of the extensions for
///   them, which the file then requires; other pictures than these, PNG and JPEG are embedded all the same,
///   though not all programs show them;
/// * notes, cartoon looks ([`crate::ToonMaterial`]), and the raw format's blend indices, are not written.
///
/// A matrix with shear stays a matrix, as glTF's own tools write it, though the standard wants it
/// decomposable.
///
/// # Errors
/// Negative bone weights, and what does not fit 4 GiB.
pub fn write(scene: &Scene) -> Result<Vec<u8>, ExportError> {
    let plan = Plan::of(scene);
    let mut buffer = Buffer::default();
    let mut root = Map::new();
    root.insert("asset".to_owned(), json!({ "version": "2.0", "generator": "avatar-exchange" }));
    if !plan.nodes.is_empty() {
        let roots = plan.nodes.iter().enumerate().filter(|(_, node)| node.parent.is_none());
        let roots: Vec<usize> = roots.map(|(number, _)| number).collect();
        root.insert("scene".to_owned(), json!(0));
        root.insert("scenes".to_owned(), json!([{ "nodes": roots }]));
    }
    let images = material::Images::of(scene);
    let (mut used, mut required) = (BTreeSet::new(), BTreeSet::new());
    material::extensions(scene, &mut used);
    images.extensions(scene, &mut required);
    used.extend(&required);
    let meshes = mesh::meshes(scene, &plan, &mut buffer)?;
    let skins = skins(scene, &plan, &mut buffer);
    let animations = animation::animations(scene, &plan, &mut buffer);
    let lists = [
        ("nodes", nodes(&plan)),
        ("meshes", meshes),
        ("skins", skins),
        ("materials", material::materials(scene, &images)),
        ("samplers", images.samplers()),
        ("textures", images.textures(scene)),
        ("images", images.images(scene, &mut buffer)),
        ("animations", animations),
        ("extensionsUsed", used.into_iter().map(Value::from).collect()),
        ("extensionsRequired", required.into_iter().map(Value::from).collect()),
    ];
    let (accessors, views, bytes) = buffer.finish();
    let length = bytes.len();
    let buffers = if length == 0 { Vec::new() } else { vec![json!({ "byteLength": length })] };
    let lists =
        lists.into_iter().chain([("accessors", accessors), ("bufferViews", views), ("buffers", buffers)]);
    // The standard has no empty arrays.
    for (name, list) in lists.filter(|(_, list)| !list.is_empty()) {
        root.insert(name.to_owned(), Value::Array(list));
    }
    container(Value::Object(root).to_string().into_bytes(), bytes)
}

/// As [`write()`], for a scene that was not checked yet.
///
/// # Errors
/// As [`write()`], and what [`Scene::from_raw`] finds.
pub fn write_raw(scene: &RawScene) -> Result<Vec<u8>, ExportError> {
    write(&Scene::from_raw(scene.clone())?)
}

/// The chunks of glTF 2.0, section 4.4.
fn container(mut json: Vec<u8>, mut bin: Vec<u8>) -> Result<Vec<u8>, ExportError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    bin.resize(bin.len().next_multiple_of(4), 0);
    let chunks: Vec<_> = [(JSON_CHUNK, json), (BIN_CHUNK, bin)]
        .into_iter()
        .filter(|(kind, bytes)| *kind == JSON_CHUNK || !bytes.is_empty())
        .collect();
    let total = chunks.iter().fold(12, |sum: u64, (_, chunk)| sum + 8 + chunk.len() as u64);
    let Ok(total) = u32::try_from(total) else { return Err(ExportError::TooLarge { bytes: total }) };
    let mut glb = Vec::with_capacity(total as usize);
    glb.extend_from_slice(b"glTF");
    glb.extend_from_slice(&2u32.to_le_bytes());
    glb.extend_from_slice(&total.to_le_bytes());
    for (kind, chunk) in chunks {
        // No longer than the total.
        glb.extend_from_slice(&(chunk.len() as u32).to_le_bytes());
        glb.extend_from_slice(&kind.to_le_bytes());
        glb.extend_from_slice(&chunk);
    }
    Ok(glb)
}

/// An object with a name, unless that is empty.
fn named(name: &str) -> Map<String, Value> {
    let mut object = Map::new();
    if !name.is_empty() {
        object.insert("name".to_owned(), json!(name));
    }
    object
}

/// Numbers that read as the same bits.
fn numbers(values: &[f32]) -> Value {
    values.iter().map(|value| Value::from(f64::from(*value))).collect()
}

fn nodes(plan: &Plan) -> Vec<Value> {
    let mut children = vec![Vec::new(); plan.nodes.len()];
    for (number, node) in plan.nodes.iter().enumerate() {
        if let Some(parent) = node.parent {
            children[parent].push(number);
        }
    }
    let mut nodes: Vec<Map<String, Value>> = plan
        .nodes
        .iter()
        .zip(children)
        .map(|(node, children)| {
            let mut json = named(node.name);
            transform(node, &mut json);
            if !children.is_empty() {
                json.insert("children".to_owned(), json!(children));
            }
            json
        })
        .collect();
    for (number, group) in plan.groups.iter().enumerate() {
        nodes[group.at].insert("mesh".to_owned(), json!(number));
        if let Some(skin) = group.skin {
            nodes[group.at].insert("skin".to_owned(), json!(skin));
        }
    }
    nodes.into_iter().map(Value::Object).collect()
}

fn transform(node: &PlannedNode, json: &mut Map<String, Value>) {
    match &node.local {
        Transform::Matrix(matrix) => {
            json.insert("matrix".to_owned(), numbers(&columns(matrix)));
        }
        Transform::Trs(trs) => {
            let rotation = animation::unit(trs.rotation.to_array());
            let mut insert = |key: &str, values: &[f32], rest: &[f32]| {
                let is_rest = values.iter().zip(rest).all(|(a, b)| a.to_bits() == b.to_bits());
                if !is_rest {
                    json.insert(key.to_owned(), numbers(values));
                }
            };
            insert("translation", &trs.translation.to_array(), &[0.0; 3]);
            insert("rotation", &rotation, &[0.0, 0.0, 0.0, 1.0]);
            insert("scale", &trs.scale.to_array(), &[1.0; 3]);
        }
    }
}

fn columns(matrix: &Affine3A) -> [f32; 16] {
    glam::Mat4::from(*matrix).to_cols_array()
}

fn skins(scene: &Scene, plan: &Plan, buffer: &mut Buffer) -> Vec<Value> {
    let skin = |(skin, joints): (&Skin, &Vec<usize>)| {
        let mut json = named(&skin.name);
        json.insert("joints".to_owned(), json!(joints));
        let binds = buffer.vectors(skin.inverse_binds.iter().map(columns), None, false);
        json.insert("inverseBindMatrices".to_owned(), json!(binds));
        Value::Object(json)
    };
    scene.skins.iter().zip(&plan.skins).map(skin).collect()
}
