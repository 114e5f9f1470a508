use crate::Mesh;
use glam::{Affine3A, Vec3, Vec3A};

/// A blended or skinned normal shorter than this has no direction: the undeformed normal takes its place.
pub const MIN_NORMAL_LENGTH: f32 = 1e-6;

/// Deformed positions and normals, one each per vertex of the mesh, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deformed {
    /// Positions in world space.
    pub positions: Vec<Vec3>,
    /// Unit normals in world space.
    pub normals: Vec<Vec3>,
}

/// Why a mesh could not be deformed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DeformError {
    /// Another number of weights than the mesh has shapes.
    #[error("expected {expected} blend weights, found {found}")]
    WeightCount {
        /// Number of shapes.
        expected: usize,
        /// Number of weights.
        found: usize,
    },
    /// A bone that the palette lacks.
    #[error("vertex {vertex}: expected a bone below {bones}, found {found}")]
    MissingBone {
        /// The vertex.
        vertex: usize,
        /// Its bone.
        found: usize,
        /// Length of the palette.
        bones: usize,
    },
    /// An array that is shorter or longer than the mesh has vertices.
    #[error("expected {expected} elements in {what}, found {found}")]
    VertexCount {
        /// Which array.
        what: &'static str,
        /// Number of vertices.
        expected: usize,
        /// Its length.
        found: usize,
    },
}

/// Blends and skins all vertices in f32: the reference for every other implementation. Allocates nothing.
///
/// `bones` are bone matrices `X` in the order that the mesh's bone indices mean; a mesh without skinning follows
/// `bones[0]`. `weights` has one blend weight per shape; a shape with weight 0 costs nothing.
///
/// # Errors
/// Lengths that do not fit the mesh, or a bone beyond the palette; `out` may then be partly written.
pub fn deform(
    mesh: &Mesh,
    bones: &[Affine3A],
    weights: &[f32],
    out: &mut Deformed,
) -> Result<(), DeformError> {
    check_lengths(mesh, weights, out)?;
    out.positions.copy_from_slice(&mesh.positions);
    out.normals.copy_from_slice(&mesh.normals);
    for (shape, &weight) in mesh.shapes.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        add_scaled(&mut out.positions, &shape.positions, weight);
        add_scaled(&mut out.normals, &shape.normals, weight);
    }
    match &mesh.skinning {
        Some(skinning) => {
            for (vertex, (bone, weight)) in skinning.bones.iter().zip(&skinning.weights).enumerate() {
                let position = Vec3A::from(out.positions[vertex]);
                let normal = blended_normal(out.normals[vertex], mesh.normals[vertex]);
                let mut posed_position = Vec3A::ZERO;
                let mut posed_normal = Vec3A::ZERO;
                for (&bone, &weight) in bone.iter().zip(weight) {
                    let x = bones.get(usize::from(bone)).ok_or(DeformError::MissingBone {
                        vertex,
                        found: bone.into(),
                        bones: bones.len(),
                    })?;
                    posed_position += weight * x.transform_point3a(position);
                    posed_normal += weight * x.transform_vector3a(normal);
                }
                out.positions[vertex] = posed_position.into();
                out.normals[vertex] = unit(posed_normal, mesh.normals[vertex]);
            }
        }
        None => {
            let missing = DeformError::MissingBone { vertex: 0, found: 0, bones: 0 };
            let x = bones.first().ok_or(missing)?;
            for (vertex, undeformed) in mesh.normals.iter().enumerate() {
                let normal = blended_normal(out.normals[vertex], *undeformed);
                out.positions[vertex] = x.transform_point3a(out.positions[vertex].into()).into();
                out.normals[vertex] = unit(x.transform_vector3a(normal), *undeformed);
            }
        }
    }
    Ok(())
}

fn add_scaled(sums: &mut [Vec3], offsets: &[Vec3], weight: f32) {
    for (sum, offset) in sums.iter_mut().zip(offsets) {
        *sum += weight * *offset;
    }
}

fn blended_normal(blended: Vec3, undeformed: Vec3) -> Vec3A {
    if blended.length() < MIN_NORMAL_LENGTH { undeformed.into() } else { blended.into() }
}

fn unit(posed: Vec3A, undeformed: Vec3) -> Vec3 {
    let length = posed.length();
    if length < MIN_NORMAL_LENGTH { undeformed } else { (posed / length).into() }
}

fn check_lengths(mesh: &Mesh, weights: &[f32], out: &Deformed) -> Result<(), DeformError> {
    if weights.len() != mesh.shapes.len() {
        return Err(DeformError::WeightCount { expected: mesh.shapes.len(), found: weights.len() });
    }
    let expected = mesh.positions.len();
    let check = |what, found| match found == expected {
        true => Ok(()),
        false => Err(DeformError::VertexCount { what, expected, found }),
    };
    check("the mesh's normals", mesh.normals.len())?;
    check("the output's positions", out.positions.len())?;
    check("the output's normals", out.normals.len())?;
    for shape in &mesh.shapes {
        check("a shape's positions", shape.positions.len())?;
        check("a shape's normals", shape.normals.len())?;
    }
    if let Some(skinning) = &mesh.skinning {
        check("the bone indices", skinning.bones.len())?;
        check("the bone weights", skinning.weights.len())?;
    }
    Ok(())
}
