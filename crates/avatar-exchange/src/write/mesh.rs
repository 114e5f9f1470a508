use super::ExportError;
use super::animation::is_unit;
use super::buffer::{Buffer, Target};
use super::plan::{Group, Plan};
use crate::scene::{Scene, ScenePart, UvSet};
use avatar_mesh::Skinning;
use glam::{Vec2, Vec3, Vec4};
use serde_json::{Map, Value, json};

/// What glTF's validator grants the sum of weights, for each weight that counts.
const WEIGHT_SUM_TOLERANCE: f64 = 2e-7;

pub(super) fn meshes(scene: &Scene, plan: &Plan, buffer: &mut Buffer) -> Result<Vec<Value>, ExportError> {
    plan.groups.iter().map(|group| mesh(scene, group, buffer)).collect()
}

fn mesh(scene: &Scene, group: &Group, buffer: &mut Buffer) -> Result<Value, ExportError> {
    let first = &scene.parts[group.parts[0]];
    let mut json = super::named(&first.name);
    let primitives = group.parts.iter().map(|part| primitive(scene, *part, buffer));
    json.insert("primitives".to_owned(), primitives.collect::<Result<Vec<_>, _>>()?.into());
    let weights = &scene.nodes[group.node].weights;
    if weights.iter().any(|weight| weight.to_bits() != 0) {
        json.insert("weights".to_owned(), super::numbers(weights));
    }
    let names: Vec<&str> = first.mesh.shapes.iter().map(|shape| shape.name.as_str()).collect();
    if !names.is_empty() {
        json.insert("extras".to_owned(), json!({ "targetNames": names }));
    }
    Ok(Value::Object(json))
}

fn primitive(scene: &Scene, number: usize, buffer: &mut Buffer) -> Result<Value, ExportError> {
    let part = &scene.parts[number];
    let mesh = &part.mesh;
    let vertices = Some(Target::Vertices);
    let mut attributes = Map::new();
    let mut attribute = |name: &str, accessor| attributes.insert(name.to_owned(), json!(accessor));
    let positions = mesh.positions.iter().map(|position| position.to_array());
    attribute("POSITION", buffer.vectors(positions, vertices, true));
    let normals = mesh.normals.iter().map(|normal| unit(*normal, Vec3::Z).to_array());
    attribute("NORMAL", buffer.vectors(normals, vertices, false));
    if !mesh.tangents.is_empty() {
        let tangents = mesh.tangents.iter().map(|tangent| with_handedness(*tangent).to_array());
        attribute("TANGENT", buffer.vectors(tangents, vertices, false));
    }
    let textures = || part.material.into_iter().flat_map(|material| scene.materials[material].textures());
    let needs_second = textures().any(|texture| texture.uvs == UvSet::Second) || !mesh.uvs_1.is_empty();
    let is_zero = |uv: &Vec2| uv.to_array().iter().all(|x| x.to_bits() == 0);
    let says_something = needs_second || textures().count() > 0 || !mesh.uvs.iter().all(is_zero);
    let uvs = mesh.uvs.iter().map(|uv| uv.to_array());
    if says_something {
        attribute("TEXCOORD_0", buffer.vectors(uvs, vertices, false));
    }
    if needs_second {
        // Without coordinates they are 0, as a reader takes them.
        let uvs = (0..mesh.positions.len()).map(|vertex| mesh.uvs_1.get(vertex).copied().unwrap_or_default());
        attribute("TEXCOORD_1", buffer.vectors(uvs.map(|uv| uv.to_array()), vertices, false));
    }
    if !mesh.colors.is_empty() {
        let colors = mesh.colors.iter().map(|color| color.clamp(Vec4::ZERO, Vec4::ONE).to_array());
        attribute("COLOR_0", buffer.vectors(colors, vertices, false));
    }
    if let Some(skinning) = &mesh.skinning {
        for (set, (joints, weights)) in influences(part, number, skinning)?.into_iter().enumerate() {
            attribute(&format!("JOINTS_{set}"), buffer.joints(&joints));
            attribute(&format!("WEIGHTS_{set}"), buffer.vectors(weights.into_iter(), vertices, false));
        }
    }
    let has_tangents = !mesh.tangents.is_empty();
    let mut json = Map::new();
    json.insert("attributes".to_owned(), Value::Object(attributes));
    // Without indices, all vertices would be corners.
    let corners = if mesh.triangles.is_empty() { &[0; 3][..] } else { mesh.triangles.as_flattened() };
    json.insert("indices".to_owned(), json!(buffer.corners(corners)));
    if let Some(material) = part.material {
        json.insert("material".to_owned(), json!(material));
    }
    let targets: Vec<Value> = mesh
        .shapes
        .iter()
        .map(|shape| {
            let mut target = Map::new();
            target.insert("POSITION".to_owned(), json!(buffer.offsets(&shape.positions, true)));
            if let Some(normals) = &shape.normals {
                target.insert("NORMAL".to_owned(), json!(buffer.offsets(normals, false)));
            }
            if let Some(tangents) = shape.tangents.as_ref().filter(|_| has_tangents) {
                target.insert("TANGENT".to_owned(), json!(buffer.offsets(tangents, false)));
            }
            Value::Object(target)
        })
        .collect();
    if !targets.is_empty() {
        json.insert("targets".to_owned(), targets.into());
    }
    Ok(Value::Object(json))
}

fn unit(direction: Vec3, otherwise: Vec3) -> Vec3 {
    if is_unit(&direction.to_array()) {
        return direction;
    }
    direction.as_dvec3().normalize_or(otherwise.as_dvec3()).as_vec3()
}

fn with_handedness(tangent: Vec4) -> Vec4 {
    unit(tangent.truncate(), Vec3::X).extend(1f32.copysign(tangent.w))
}

/// Joints and weights of vertices: one of the sets of four that glTF knows.
type Set = (Vec<[u16; 4]>, Vec<[f32; 4]>);

/// Joints of the skin and weights, as the standard wants them: none twice, the first one where there is no
/// weight. One set, or two where vertices have more than four bones.
fn influences(part: &ScenePart, number: usize, skinning: &Skinning) -> Result<Vec<Set>, ExportError> {
    let count = if skinning.more_bones.is_empty() { 1 } else { 2 };
    let room = || (Vec::with_capacity(skinning.bones.len()), Vec::with_capacity(skinning.weights.len()));
    let mut sets: Vec<Set> = (0..count).map(|_| room()).collect();
    for vertex in 0..skinning.bones.len() {
        let (mut joints, mut shares) = ([0; 8], [0.0f32; 8]);
        for (slot, (joint, weight)) in skinning.influences(vertex).take(4 * count).enumerate() {
            if weight < 0.0 {
                let name = part.name.clone();
                return Err(ExportError::NegativeWeight { part: number, name, vertex, found: weight });
            }
            if weight > 0.0 {
                let earlier = (0..slot).find(|other| shares[*other] > 0.0 && joints[*other] == joint);
                let place = earlier.unwrap_or(slot);
                joints[place] = joint;
                shares[place] += weight;
            }
        }
        let sum: f64 = shares.iter().map(|share| f64::from(*share)).sum();
        let counting = shares.iter().filter(|share| **share > 0.0).count();
        if (sum - 1.0).abs() > WEIGHT_SUM_TOLERANCE * counting as f64 && sum > 0.0 {
            shares = shares.map(|share| (f64::from(share) / sum) as f32);
        }
        for (set, (joints, shares)) in
            sets.iter_mut().zip(joints.as_chunks::<4>().0.iter().zip(shares.as_chunks::<4>().0))
        {
            set.0.push(*joints);
            set.1.push(*shares);
        }
    }
    Ok(sets)
}
