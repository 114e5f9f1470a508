use crate::SpringError;
use glam::{Quat, Vec3};

/// Fails unless every parent stands before its children.
pub(crate) fn check(parents: &[Option<usize>]) -> Result<(), SpringError> {
    for (joint, parent) in parents.iter().enumerate() {
        if let Some(parent) = parent.filter(|parent| *parent >= joint) {
            return Err(SpringError::ParentAfter { joint, parent });
        }
    }
    Ok(())
}

/// Fails where a joint does not exist.
pub(crate) fn known(what: &'static str, found: usize, joints: usize) -> Result<usize, SpringError> {
    if found < joints { Ok(found) } else { Err(SpringError::UnknownJoint { what, found, joints }) }
}

/// Fails where the matrices are not those of the skeleton.
pub(crate) fn matches(expected: usize, found: usize) -> Result<(), SpringError> {
    if expected == found { Ok(()) } else { Err(SpringError::Length { expected, found }) }
}

/// The shortest rotation from one unit vector to another. That of glam is none for small angles.
pub(crate) fn arc(from: Vec3, to: Vec3) -> Quat {
    let cosine = from.dot(to);
    if cosine < -1.0 + 1e-6 {
        return Quat::from_axis_angle(from.any_orthonormal_vector(), std::f32::consts::PI);
    }
    let cross = from.cross(to);
    Quat::from_xyzw(cross.x, cross.y, cross.z, 1.0 + cosine).normalize()
}
