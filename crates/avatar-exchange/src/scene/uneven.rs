use avatar_mesh::{DeformError, Deformed, Mesh, deform};
use glam::{Affine3A, DMat3};

/// How far axes may be from equal lengths and right angles before normals need a matrix of their own:
/// relative, and well below what is seen.
const MAX_UNEVENNESS: f32 = 1e-4;

/// As [`avatar_mesh::deform`], and right for bones that scale unevenly or shear, which nodes of files may do.
///
/// Positions are the same. Normals are turned by the inverse transpose of the blended matrix, computed as its
/// cofactors times the sign of the determinant, which exists for flat matrices, too; `avatar_mesh::deform`
/// and the GPU turn them by the matrix itself, which is the same for rotations and even scales, where this
/// function costs nothing more. Elsewhere it allocates room for one more result.
///
/// # Errors
/// As [`avatar_mesh::deform`].
pub fn deform_unevenly(
    mesh: &Mesh,
    bones: &[Affine3A],
    weights: &[f32],
    out: &mut Deformed,
) -> Result<(), DeformError> {
    deform(mesh, bones, weights, out)?;
    if bones.iter().all(is_even) {
        return Ok(());
    }
    // Blended and not yet turned.
    let mut blended = mesh.deformed();
    deform(mesh, &vec![Affine3A::IDENTITY; bones.len()], weights, &mut blended)?;
    let matrices: Vec<_> = bones.iter().map(|bone| bone.matrix3.as_dmat3()).collect();
    for (vertex, (turned, normal)) in out.normals.iter_mut().zip(&blended.normals).enumerate() {
        let matrix = match &mesh.skinning {
            None => matrices[0],
            Some(skinning) => {
                let weighted = skinning.bones[vertex].iter().zip(skinning.weights[vertex]);
                weighted.fold(DMat3::ZERO, |sum, (bone, w)| sum + matrices[usize::from(*bone)] * f64::from(w))
            }
        };
        if let Some(direction) = (normal_matrix(&matrix) * normal.as_dvec3()).try_normalize() {
            *turned = direction.as_vec3();
        }
    }
    Ok(())
}

/// The inverse transpose up to a positive factor.
fn normal_matrix(matrix: &DMat3) -> DMat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let sign = if x.dot(y.cross(z)) < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}

/// Whether a matrix is a rotation or mirroring with one scale for all directions.
fn is_even(bone: &Affine3A) -> bool {
    let [x, y, z] = [bone.matrix3.x_axis, bone.matrix3.y_axis, bone.matrix3.z_axis];
    let size = x.length_squared();
    let off = [x.dot(y), y.dot(z), z.dot(x), y.length_squared() - size, z.length_squared() - size];
    off.iter().all(|off| off.abs() <= MAX_UNEVENNESS * size)
}
