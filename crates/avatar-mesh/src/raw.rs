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

/// Vertices are read in groups that the nearest cache holds, one column after the other: that is far faster
/// than all columns of each vertex, and than each column of the whole buffer.
const GROUP: usize = 64;

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
    let mut all_exist = true;
    for group in vertices.chunks(GROUP) {
        push_common(&mut mesh, group);
        skinning.bones.extend(group.iter().map(|vertex| {
            let (bones, exist) = bone_indices(floats_at::<8, 4, _>(vertex));
            all_exist &= exist;
            bones
        }));
        skinning.weights.extend(group.iter().map(floats_at::<12, 4, _>));
        skinning.blend_index.extend(group.iter().map(vec3_at::<16, _>));
        let [(_, smile_positions, smile_normals), (_, frown_positions, frown_normals)] = &mut offsets;
        smile_positions.extend(group.iter().map(vec3_at::<19, _>));
        smile_normals.extend(group.iter().map(vec3_at::<22, _>));
        frown_positions.extend(group.iter().map(vec3_at::<25, _>));
        frown_normals.extend(group.iter().map(vec3_at::<28, _>));
    }
    if !all_exist {
        (vertices.iter().enumerate())
            .try_for_each(|(vertex, bytes)| check_bones(vertex, floats_at::<8, 4, _>(bytes)))?;
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
    vertices.chunks(GROUP).for_each(|group| push_common(&mut mesh, group));
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

/// Floats of a vertex, from the float at `FIRST`.
fn floats_at<const FIRST: usize, const COUNT: usize, const BYTES: usize>(
    vertex: &[u8; BYTES],
) -> [f32; COUNT] {
    let (floats, _) = vertex.as_chunks::<4>();
    std::array::from_fn(|i| f32::from_le_bytes(floats[FIRST + i]))
}

fn vec3_at<const FIRST: usize, const BYTES: usize>(vertex: &[u8; BYTES]) -> Vec3 {
    Vec3::from_array(floats_at::<FIRST, 3, BYTES>(vertex))
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

fn push_common<const BYTES: usize>(mesh: &mut Mesh, group: &[[u8; BYTES]]) {
    mesh.positions.extend(group.iter().map(vec3_at::<0, BYTES>));
    mesh.uvs.extend(group.iter().map(|vertex| Vec2::from_array(floats_at::<3, 2, BYTES>(vertex))));
    mesh.normals.extend(group.iter().map(vec3_at::<5, BYTES>));
}

const LAST_BONE: i32 = FACE_BONES.len() as i32 - 1;

/// The indices that four floats mean, and whether all are whole numbers of bones that exist. Where one is
/// not, the indices mean nothing. Without branches and calls: this runs for each vertex.
fn bone_indices(found: [f32; 4]) -> ([u16; 4], bool) {
    // Behind 2²³, floats are whole numbers, one apart: the sum's bits count from those of 2²³.
    const WHOLE: f32 = 8_388_608.0;
    let whole = found.map(|x| (x + WHOLE).to_bits().wrapping_sub(WHOLE.to_bits()) as i32);
    let exist = whole.iter().zip(found).fold(true, |exist, (&whole, found)| {
        exist & (whole as f32 == found) & (0..=LAST_BONE).contains(&whole)
    });
    (whole.map(|bone| bone as u16), exist)
}

/// The error about the first bone of a vertex that does not exist.
fn check_bones(vertex: usize, found: [f32; 4]) -> Result<(), MeshError> {
    // Not `found < 0.0 || …`: NaN must fail as well.
    let exists = |found: f32| found >= 0.0 && found <= LAST_BONE as f32 && found.fract() == 0.0;
    match found.iter().position(|bone| !exists(*bone)) {
        None => Ok(()),
        Some(slot) => {
            Err(MeshError::BoneIndex { vertex, slot, found: found[slot], last: FACE_BONES.len() - 1 })
        }
    }
}
