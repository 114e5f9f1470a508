//! The raw format: vertex buffers (`*_VB.raw`) of little-endian f32 and index buffers (`*_IB.raw`) of u32.
//!
//! - A vertex of the skin has 124 bytes: position 3, uv 2, normal 3, bone index 4, weight 4, blend index 3,
//!   then position offset 3 and normal offset 3 of each of the two shapes.
//! - A vertex of the other parts has 32 bytes: position 3, uv 2, normal 3.

use crate::{FACE_BONES, FACE_SHAPES, Mesh, MeshError, Offsets, Shape, Skinning};
use glam::{Vec2, Vec3};

/// Floats of a skin vertex.
pub const SKIN_FLOATS: usize = 31;
/// Floats of a vertex of any other part.
pub const RIGID_FLOATS: usize = 8;

/// Reads a skin. Bone indices must be whole numbers below 9; everything else is left to [`Mesh::validate`].
///
/// # Errors
/// Buffers whose lengths are not multiples of an element's, an empty vertex buffer, an impossible bone index.
pub fn read_skin(vertices: &[u8], indices: &[u8]) -> Result<Mesh, MeshError> {
    let vertices = elements::<{ SKIN_FLOATS * 4 }>("vertices", vertices)?;
    let mut mesh = mesh_with_capacity(vertices.len(), triangles(indices)?);
    let mut skinning = Skinning {
        bones: Vec::with_capacity(vertices.len()),
        weights: Vec::with_capacity(vertices.len()),
        blend_index: Vec::with_capacity(vertices.len()),
        ..Skinning::default()
    };
    let room = || Vec::with_capacity(vertices.len());
    let mut offsets = FACE_SHAPES.map(|name| (name, room(), room()));
    for (vertex, bytes) in vertices.iter().enumerate() {
        let floats: [f32; SKIN_FLOATS] = floats(bytes);
        push_common(&mut mesh, &floats);
        skinning.bones.push(bone_indices(vertex, [floats[8], floats[9], floats[10], floats[11]])?);
        skinning.weights.push([floats[12], floats[13], floats[14], floats[15]]);
        skinning.blend_index.push(vec3(&floats, 16));
        for (k, (_, positions, normals)) in offsets.iter_mut().enumerate() {
            positions.push(vec3(&floats, 19 + 6 * k));
            normals.push(vec3(&floats, 22 + 6 * k));
        }
    }
    mesh.skinning = Some(skinning);
    mesh.shapes = offsets
        .into_iter()
        .map(|(name, positions, normals)| Shape::new(name, positions).with_normals(normals))
        .collect();
    Ok(mesh)
}

/// Reads any part but the skin.
///
/// # Errors
/// Buffers whose lengths are not multiples of an element's, an empty vertex buffer.
pub fn read_rigid(vertices: &[u8], indices: &[u8]) -> Result<Mesh, MeshError> {
    let vertices = elements::<{ RIGID_FLOATS * 4 }>("vertices", vertices)?;
    let mut mesh = mesh_with_capacity(vertices.len(), triangles(indices)?);
    for bytes in vertices {
        let floats: [f32; RIGID_FLOATS] = floats(bytes);
        push_common(&mut mesh, &floats);
    }
    Ok(mesh)
}

/// Writes a vertex buffer: of a skin if the mesh has skinning, else of a rigid part. Columns that the mesh
/// lacks (a third shape is beyond the format) are zero; of more than four bones, a vertex keeps those of the
/// largest weights ([`Skinning::largest_four`]).
pub fn write_vertices(mesh: &Mesh) -> Vec<u8> {
    let mut out = Vec::new();
    let mut push = |values: &[f32]| out.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    let at = |values: &[Vec3], vertex: usize| values.get(vertex).copied().unwrap_or_default().to_array();
    for (vertex, position) in mesh.positions.iter().enumerate() {
        push(&position.to_array());
        push(&mesh.uvs.get(vertex).copied().unwrap_or_default().to_array());
        push(&at(&mesh.normals, vertex));
        let Some(skinning) = &mesh.skinning else { continue };
        let (bones, weights) = skinning.largest_four(vertex);
        push(&bones.map(f32::from));
        push(&weights);
        push(&at(&skinning.blend_index, vertex));
        for k in 0..FACE_SHAPES.len() {
            let shape = mesh.shapes.get(k);
            let offset = |offsets: Option<&Offsets>| offsets.and_then(|d| d.get(vertex)).unwrap_or_default();
            push(&offset(shape.map(|shape| &shape.positions)).to_array());
            push(&offset(shape.and_then(|shape| shape.normals.as_ref())).to_array());
        }
    }
    out
}

/// Writes an index buffer.
pub fn write_triangles(mesh: &Mesh) -> Vec<u8> {
    mesh.triangles.iter().flatten().flat_map(|index| index.to_le_bytes()).collect()
}

fn triangles(bytes: &[u8]) -> Result<Vec<[u32; 3]>, MeshError> {
    let (whole, rest) = bytes.as_chunks::<12>();
    if !rest.is_empty() {
        return Err(MeshError::PartialElement {
            element: "triangles",
            element_bytes: 12,
            found: bytes.len(),
        });
    }
    let corner = |t: &[u8; 12], i: usize| u32::from_le_bytes([t[i], t[i + 1], t[i + 2], t[i + 3]]);
    Ok(whole.iter().map(|t| [corner(t, 0), corner(t, 4), corner(t, 8)]).collect())
}

fn elements<'a, const BYTES: usize>(
    element: &'static str,
    bytes: &'a [u8],
) -> Result<&'a [[u8; BYTES]], MeshError> {
    let (whole, rest) = bytes.as_chunks::<BYTES>();
    match (whole, rest) {
        ([], []) => Err(MeshError::NoVertices),
        (whole, []) => Ok(whole),
        _ => Err(MeshError::PartialElement { element, element_bytes: BYTES, found: bytes.len() }),
    }
}

fn floats<const FLOATS: usize>(bytes: &[u8]) -> [f32; FLOATS] {
    let (quads, _) = bytes.as_chunks::<4>();
    std::array::from_fn(|i| quads.get(i).map_or(0.0, |quad| f32::from_le_bytes(*quad)))
}

fn vec3(floats: &[f32], at: usize) -> Vec3 {
    Vec3::new(floats[at], floats[at + 1], floats[at + 2])
}

fn mesh_with_capacity(vertices: usize, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh {
        positions: Vec::with_capacity(vertices),
        uvs: Vec::with_capacity(vertices),
        normals: Vec::with_capacity(vertices),
        triangles,
        ..Mesh::default()
    }
}

fn push_common(mesh: &mut Mesh, floats: &[f32]) {
    mesh.positions.push(vec3(floats, 0));
    mesh.uvs.push(Vec2::new(floats[3], floats[4]));
    mesh.normals.push(vec3(floats, 5));
}

fn bone_indices(vertex: usize, found: [f32; 4]) -> Result<[u16; 4], MeshError> {
    let last = FACE_BONES.len() - 1;
    let mut bones = [0; 4];
    for (slot, (bone, found)) in bones.iter_mut().zip(found).enumerate() {
        // Not `found < 0.0 || …`: NaN must fail as well.
        if !(found >= 0.0 && found <= last as f32 && found.fract() == 0.0) {
            return Err(MeshError::BoneIndex { vertex, slot, found, last });
        }
        *bone = found as u16;
    }
    Ok(bones)
}
