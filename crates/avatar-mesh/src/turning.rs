//! What bone matrices do to directions: to normals, and to the way that triangles run around.

use crate::{Mesh, Skinning};
use glam::{Affine3A, DMat3};
use std::borrow::Cow;

/// A blended or skinned normal shorter than this has no direction: the undeformed normal takes its place.
pub const MIN_NORMAL_LENGTH: f32 = 1e-6;

/// How far axes may be from equal lengths and right angles before normals need a matrix of their own:
/// relative, and well below what is seen.
const MAX_UNEVENNESS: f64 = 1e-4;

/// Whether a bone turns normals as it turns everything: a rotation with one scale for all directions, which
/// may be 0. Others scale unevenly, shear or mirror.
pub fn turns_evenly(bone: &Affine3A) -> bool {
    let matrix = wide(bone);
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = matrix;
    let size = x.length_squared();
    let off = [x.dot(y), y.dot(z), z.dot(x), y.length_squared() - size, z.length_squared() - size];
    off.iter().all(|off| off.abs() <= MAX_UNEVENNESS * size) && !is_mirroring(&matrix)
}

/// Whether a bone makes a left hand of a right one: its determinant is negative. A flat bone does not.
pub fn mirrors(bone: &Affine3A) -> bool {
    is_mirroring(&wide(bone))
}

/// The directions of a bone matrix.
pub(crate) fn wide(bone: &Affine3A) -> DMat3 {
    bone.matrix3.as_dmat3()
}

/// Whether a matrix makes a left hand of a right one. A flat one does not.
pub(crate) fn is_mirroring(matrix: &DMat3) -> bool {
    matrix.x_axis.dot(matrix.y_axis.cross(matrix.z_axis)) < 0.0
}

/// What turns normals where a matrix moves a surface, so that they stand on it again: the inverse transpose,
/// up to a positive factor. It is computed as the cofactors times the sign of the determinant, which exist
/// for flat matrices, too.
pub fn normal_matrix(matrix: &DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *matrix;
    let sign = if is_mirroring(matrix) { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}

/// The directions of the mean of a vertex's bones; bones beyond the palette count as nothing.
pub(crate) fn blended(skinning: &Skinning, bones: &[Affine3A], vertex: usize) -> DMat3 {
    let moving = skinning.influences(vertex).filter_map(|(bone, w)| Some((bones.get(usize::from(bone))?, w)));
    moving.fold(DMat3::ZERO, |sum, (bone, weight)| sum + wide(bone) * f64::from(weight))
}

/// Whether all bones that move a mesh turn evenly ([`turns_evenly`]).
pub(crate) fn all_turn_evenly(mesh: &Mesh, bones: &[Affine3A]) -> bool {
    !any_moving(mesh, bones, |bone| !turns_evenly(bone))
}

/// Whether a bone that moves a mesh is such. Cheap where none of the palette is, and else one look at all
/// weights.
fn any_moving(mesh: &Mesh, bones: &[Affine3A], is_such: impl Fn(&Affine3A) -> bool) -> bool {
    let Some(skinning) = &mesh.skinning else { return bones.first().is_some_and(is_such) };
    if !bones.iter().any(&is_such) {
        return false;
    }
    let sets = [(&skinning.bones, &skinning.weights), (&skinning.more_bones, &skinning.more_weights)];
    let mut moving = sets
        .into_iter()
        .flat_map(|(bones, weights)| bones.as_flattened().iter().zip(weights.as_flattened()))
        .filter(|(_, weight)| **weight != 0.0);
    let mut last = None;
    moving.any(|(bone, _)| {
        // Neighbours mostly have the same bones.
        let is_known = last.replace(*bone) == Some(*bone);
        !is_known && bones.get(usize::from(*bone)).is_some_and(&is_such)
    })
}

/// The triangles of a mesh as they run around what [`crate::deform()`] makes of it. Bones that mirror turn
/// fronts into backs: triangles most of whose corners they carry are reversed, so that all stay
/// counter-clockwise seen from outside (glTF 2.0, section 3.7.4, says the same of nodes with a negative
/// determinant). Borrowed where nothing is mirrored.
pub fn deformed_triangles<'a>(mesh: &'a Mesh, bones: &[Affine3A]) -> Cow<'a, [[u32; 3]]> {
    if !any_moving(mesh, bones, mirrors) {
        return Cow::Borrowed(&mesh.triangles);
    }
    let reversed = |[a, b, c]: [u32; 3]| [a, c, b];
    match &mesh.skinning {
        None => mesh.triangles.iter().map(|corners| reversed(*corners)).collect(),
        Some(skinning) => {
            let is_mirrored: Vec<bool> = (0..mesh.positions.len())
                .map(|vertex| is_mirroring(&blended(skinning, bones, vertex)))
                .collect();
            let is_corner = |corner: &&u32| is_mirrored.get(**corner as usize) == Some(&true);
            let run = |corners: &[u32; 3]| match corners.iter().filter(is_corner).count() {
                0 | 1 => *corners,
                _ => reversed(*corners),
            };
            mesh.triangles.iter().map(run).collect()
        }
    }
}
