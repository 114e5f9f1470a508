//! `.md5mesh`: joints, and meshes whose vertices hang from them.

use super::words::Words;
use crate::build::influences::Influences;
use crate::build::normals::{NormalSums, Weighting};
use crate::build::text::at_line;
use crate::scene::{Finding, ImportError, Material, Note};
use avatar_mesh::Mesh;
use glam::{DAffine3, DQuat, DVec3, Vec2, Vec3};
use std::collections::HashMap;

/// Vertices may share weights, so that few bytes of a file could stand for a great many of them.
const MAX_WEIGHTS: usize = 256;

#[derive(Default)]
pub(super) struct Model {
    /// Where each shader is among the materials.
    shaders: HashMap<String, usize>,
    pub(super) joints: Vec<Joint>,
    pub(super) parts: Vec<Part>,
    pub(super) materials: Vec<Material>,
    pub(super) notes: Vec<Note>,
}

pub(super) struct Joint {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    position: DVec3,
    rotation: DQuat,
}

impl Joint {
    pub(super) fn model_from_joint(&self) -> DAffine3 {
        DAffine3::from_rotation_translation(self.rotation, self.position)
    }
}

pub(super) struct Part {
    pub(super) name: String,
    pub(super) material: usize,
    pub(super) mesh: Mesh,
}

struct Vertex {
    uv: Vec2,
    first: usize,
    count: usize,
    line: usize,
}

struct Weight {
    joint: usize,
    weight: f32,
    in_joint: DVec3,
}

/// The beginning that both kinds of file have in common.
pub(super) fn version(words: &mut Words<'_>) -> Result<(), ImportError> {
    words.expect("MD5Version")?;
    words.expect("10")
}

pub(super) fn read(words: &mut Words<'_>) -> Result<Model, ImportError> {
    version(words)?;
    let mut model = Model::default();
    let (mut joints, mut meshes) = (0, 0);
    while let Some(word) = words.next() {
        match word {
            "commandline" => {
                words.word("a command line")?;
            }
            "numJoints" => joints = words.count("a number of joints")?,
            "numMeshes" => meshes = words.count("a number of meshes")?,
            "joints" if model.joints.is_empty() => model.joints = read_joints(words, joints)?,
            "mesh" => {
                let part = read_mesh(words, &mut model)?;
                model.parts.push(part);
            }
            _ => return Err(words.error("numJoints, numMeshes, joints or mesh", Some(word))),
        }
    }
    if model.joints.is_empty() {
        return Err(words.error("joints", None));
    }
    if model.parts.len() != meshes {
        return Err(words.error(format!("{meshes} meshes, not {}", model.parts.len()), None));
    }
    Ok(model)
}

fn read_joints(words: &mut Words<'_>, count: usize) -> Result<Vec<Joint>, ImportError> {
    words.expect("{")?;
    let mut joints = Vec::new();
    for index in 0..count {
        let name = words.word("the name of a joint")?.to_owned();
        let parent = parent(words, index)?;
        let position = words.vector("a position")?;
        let rotation = words.rotation("a rotation")?;
        joints.push(Joint { name, parent, position, rotation });
    }
    words.expect("}")?;
    Ok(joints)
}

/// The joint that one hangs from: an earlier one, or -1.
pub(super) fn parent(words: &mut Words<'_>, index: usize) -> Result<Option<usize>, ImportError> {
    let word = words.next();
    let number = word.and_then(|word| word.parse::<i64>().ok());
    match number {
        Some(-1) => Ok(None),
        Some(number) if (0..index as i64).contains(&number) => Ok(Some(number as usize)),
        _ => Err(words.error(format!("a joint before {index}, or -1"), word)),
    }
}

fn read_mesh(words: &mut Words<'_>, model: &mut Model) -> Result<Part, ImportError> {
    words.expect("{")?;
    let first_line = words.line;
    let (mut name, mut vertices, mut triangles, mut weights) =
        (String::new(), Vec::new(), Vec::new(), Vec::new());
    let joints = model.joints.len();
    loop {
        // Each list at most once: triangles refer to the vertices before them.
        match words.word("shader, numverts, numtris, numweights or }")? {
            "shader" => words.word("a shader")?.clone_into(&mut name),
            "numverts" if vertices.is_empty() && triangles.is_empty() => {
                for index in 0..words.count("a number of vertices")? {
                    words.entry("vert", index)?;
                    let [u, v] = words.tuple("a texture coordinate")?;
                    let first = words.count("the first weight")?;
                    let count = words.below("a number of weights", MAX_WEIGHTS + 1)?;
                    let uv = Vec2::new(u as f32, v as f32);
                    vertices.push(Vertex { uv, first, count, line: words.line });
                }
            }
            "numtris" => {
                for index in 0..words.count("a number of triangles")? {
                    words.entry("tri", index)?;
                    let mut corner = || words.below("a vertex", vertices.len().max(1));
                    let [a, b, c] = [corner()?, corner()?, corner()?].map(|corner| corner as u32);
                    triangles.push([a, c, b]);
                }
            }
            "numweights" => {
                for index in 0..words.count("a number of weights")? {
                    words.entry("weight", index)?;
                    let joint = words.below("a joint", joints.min(usize::from(u16::MAX) + 1))?;
                    let weight = words.float("a weight")?;
                    if weight < 0.0 {
                        return Err(words.error("a weight from 0 on", Some(&weight.to_string())));
                    }
                    weights.push(Weight { joint, weight, in_joint: words.vector("a position")? });
                }
            }
            "}" => break,
            other => return Err(words.error("shader, numverts, numtris, numweights or }", Some(other))),
        }
    }
    let mesh = assemble(model, first_line, &vertices, triangles, &weights)?;
    let Model { shaders, materials, .. } = model;
    let material = *shaders.entry(name.clone()).or_insert_with(|| {
        materials.push(Material {
            name: name.clone(),
            metallic: 0.0,
            double_sided: true,
            ..Material::default()
        });
        materials.len() - 1
    });
    Ok(Part { name, material, mesh })
}

/// The mesh as its joints hold it at bind pose.
fn assemble(
    model: &mut Model,
    first_line: usize,
    vertices: &[Vertex],
    triangles: Vec<[u32; 3]>,
    weights: &[Weight],
) -> Result<Mesh, ImportError> {
    let mut mesh = Mesh { triangles, ..Mesh::default() };
    let mut influences = Influences::default();
    let mut bones = Vec::new();
    for vertex in vertices {
        let wrong = |expected: String, found: String| at_line(vertex.line, expected, found);
        let range = vertex.first..vertex.first.saturating_add(vertex.count);
        let end = range.end;
        let Some(here) = weights.get(range) else {
            return Err(wrong(format!("weights below {}", weights.len()), format!("up to {end}")));
        };
        if here.iter().all(|weight| weight.weight <= 0.0) {
            return Err(wrong("a vertex with a weight".to_owned(), format!("{} weights of 0", vertex.count)));
        }
        let point = |weight: &Weight| {
            let joint = &model.joints[weight.joint];
            f64::from(weight.weight) * (joint.rotation * weight.in_joint + joint.position)
        };
        mesh.positions.push(here.iter().map(point).sum::<DVec3>().as_vec3());
        mesh.uvs.push(vertex.uv);
        bones.clear();
        bones.extend(here.iter().map(|weight| (weight.joint as u16, f64::from(weight.weight))));
        influences.push(&mut bones, 0);
    }
    if let Some(text) = influences.note("vertices") {
        model.notes.push(Note::new(format!("line {first_line}"), Finding::Converted(text)));
    }
    mesh.skinning = Some(influences.into_skinning());
    mesh.normals = normals(&mesh);
    Ok(mesh)
}

/// Smooth normals, across the seams of texture coordinates.
fn normals(mesh: &Mesh) -> Vec<Vec3> {
    let mut groups = HashMap::new();
    // Adding 0 makes one zero of two.
    let place = |position: &Vec3| position.to_array().map(|x| (x + 0.0).to_bits());
    let mut group = |position| {
        let next = groups.len() as u32;
        *groups.entry(place(position)).or_insert(next)
    };
    let places: Vec<u32> = mesh.positions.iter().map(&mut group).collect();
    let mut sums = NormalSums::new(groups.len(), Weighting::Angle);
    for corners in &mesh.triangles {
        let points = corners.map(|corner| mesh.positions[corner as usize]);
        sums.add(points, corners.map(|corner| places[corner as usize]));
    }
    places.iter().map(|place| sums.normal(*place)).collect()
}
