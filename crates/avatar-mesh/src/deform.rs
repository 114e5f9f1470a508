use crate::skin_lanes::SkinLanes;
use crate::turning::{MIN_NORMAL_LENGTH, all_turn_evenly, blended, is_mirroring, normal_matrix, wide};
use crate::{Deformed, Mesh, Skinning, SmoothNormals};
use glam::{Affine3A, DMat3, Vec3, Vec3A};

/// What becomes of normals when shapes move positions.
#[derive(Debug, Default)]
pub enum ShapeNormals<'a> {
    /// Shapes add their own offsets, `n + Σ_k b_k · dn_k`; those without any leave normals alone.
    #[default]
    Given,
    /// Normals change as those computed from the blended positions do; offsets for normals are not used.
    /// Costs time per triangle while any weight is other than 0.
    Recomputed(&'a mut SmoothNormals),
    /// Normals stay those of the base shape, only bones turn them: folds of a shape are seen in its outline,
    /// not in its shading.
    Unblended,
}

/// Why a mesh could not be deformed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
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
/// `bones` are bone matrices `X` in the order that the mesh's bone indices mean; a mesh without skinning
/// follows `bones[0]`. `weights` has one blend weight per shape; a shape with weight 0 costs nothing, and one
/// that stores moved vertices only costs time for these.
///
/// Normals are turned by the bones' matrices where all bones that move the mesh are rotations with one scale
/// ([`crate::turns_evenly`]), and where any is not, by the inverse transpose of each vertex's blended matrix.
///
/// # Errors
/// Lengths that do not fit the mesh, or a bone beyond the palette; `out` may then be partly written.
pub fn deform(
    mesh: &Mesh,
    bones: &[Affine3A],
    weights: &[f32],
    out: &mut Deformed,
) -> Result<(), DeformError> {
    deform_with(mesh, bones, weights, ShapeNormals::Given, out)
}

/// [`deform()`] with a choice of what becomes of normals.
///
/// # Errors
/// As [`deform()`], and normals to be recomputed of another mesh.
pub fn deform_with(
    mesh: &Mesh,
    bones: &[Affine3A],
    weights: &[f32],
    normals: ShapeNormals<'_>,
    out: &mut Deformed,
) -> Result<(), DeformError> {
    if let Some(skinning) = &mesh.skinning {
        let check = count_check(mesh.positions.len());
        check("the bone indices", skinning.bones.len())?;
        check("the bone weights", skinning.weights.len())?;
        if !(skinning.more_bones.is_empty() && skinning.more_weights.is_empty()) {
            check("the further bone indices", skinning.more_bones.len())?;
            check("the further bone weights", skinning.more_weights.len())?;
        }
    }
    // Without shapes, bones take positions and normals from the mesh: a copy of them would be for nothing.
    let is_blended = mesh.skinning.is_none() || weights.iter().any(|weight| *weight != 0.0);
    if is_blended {
        blend(mesh, weights, normals, out)?;
    } else {
        check_lengths(mesh, weights, &normals, out)?;
        out.tangents.copy_from_slice(&mesh.tangents);
    }
    skin(mesh, bones, is_blended, out)
}

/// The part of [`deform()`] before the bones: `v + Σ_k b_k · d_k`, and the same for normals and tangents,
/// which are not made unit vectors yet.
///
/// # Errors
/// Lengths that do not fit the mesh.
pub fn blend(
    mesh: &Mesh,
    weights: &[f32],
    normals: ShapeNormals<'_>,
    out: &mut Deformed,
) -> Result<(), DeformError> {
    check_lengths(mesh, weights, &normals, out)?;
    out.positions.copy_from_slice(&mesh.positions);
    out.normals.copy_from_slice(&mesh.normals);
    out.tangents.copy_from_slice(&mesh.tangents);
    let mut any = false;
    for (shape, &weight) in mesh.shapes.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        any = true;
        shape.positions.add_scaled(weight, &mut out.positions);
        if let (Some(offsets), ShapeNormals::Given) = (&shape.normals, &normals) {
            offsets.add_scaled(weight, &mut out.normals);
        }
        if let (Some(offsets), false) = (&shape.tangents, out.tangents.is_empty()) {
            for (vertex, offset) in offsets.iter() {
                out.tangents[vertex] += (weight * offset).extend(0.0);
            }
        }
    }
    if let (ShapeNormals::Recomputed(smooth), true) = (normals, any) {
        smooth.add_change(&out.positions, &mut out.normals);
    }
    Ok(())
}

/// The part of [`deform()`] after the shapes. Lengths fit. Where nothing is blended, positions and normals
/// are not in `out` yet.
fn skin(mesh: &Mesh, bones: &[Affine3A], is_blended: bool, out: &mut Deformed) -> Result<(), DeformError> {
    let is_even = all_turn_evenly(mesh, bones);
    match &mesh.skinning {
        Some(skinning) => {
            let one_by_one = |positions: &mut [Vec3], normals: &mut [Vec3], first: usize| {
                if !is_blended {
                    positions.copy_from_slice(&mesh.positions[first..first + positions.len()]);
                    normals.copy_from_slice(&mesh.normals[first..first + normals.len()]);
                }
                skin_each(mesh, skinning, bones, is_even, first, positions, normals)
            };
            if is_even && skinning.more_bones.is_empty() && all_exist(skinning, bones) {
                let mut done = Ok(());
                lanes::run(SkinLanes {
                    skinning,
                    bones,
                    from: (!is_blended).then_some((&*mesh.positions, &*mesh.normals)),
                    positions: &mut out.positions,
                    normals: &mut out.normals,
                    left: |positions: &mut [Vec3], normals: &mut [Vec3], first| {
                        if done.is_ok() {
                            done = one_by_one(positions, normals, first);
                        }
                    },
                });
                done?;
            } else {
                one_by_one(&mut out.positions, &mut out.normals, 0)?;
            }
            for (vertex, (tangent, undeformed)) in out.tangents.iter_mut().zip(&mesh.tangents).enumerate() {
                let along = blended_normal(tangent.truncate(), undeformed.truncate());
                let posed = skinning
                    .influences(vertex)
                    .filter_map(|(bone, weight)| Some((bones.get(usize::from(bone))?, weight)))
                    .fold(Vec3A::ZERO, |sum, (x, weight)| sum + weight * x.transform_vector3a(along));
                let is_mirrored = !is_even && is_mirroring(&blended(skinning, bones, vertex));
                let handedness = if is_mirrored { -undeformed.w } else { undeformed.w };
                *tangent = unit(posed, undeformed.truncate()).extend(handedness);
            }
        }
        None => {
            let missing = DeformError::MissingBone { vertex: 0, found: 0, bones: 0 };
            let x = bones.first().ok_or(missing)?;
            let matrix = wide(x);
            for (vertex, undeformed) in mesh.normals.iter().enumerate() {
                let normal = blended_normal(out.normals[vertex], *undeformed);
                out.positions[vertex] = x.transform_point3a(out.positions[vertex].into()).into();
                let turned = unit(x.transform_vector3a(normal), *undeformed);
                let turned = if is_even { turned } else { standing(&matrix, normal, turned) };
                out.normals[vertex] = turned.into();
            }
            let is_mirrored = !is_even && is_mirroring(&matrix);
            for (tangent, undeformed) in out.tangents.iter_mut().zip(&mesh.tangents) {
                let along = blended_normal(tangent.truncate(), undeformed.truncate());
                let handedness = if is_mirrored { -undeformed.w } else { undeformed.w };
                *tangent = unit(x.transform_vector3a(along), undeformed.truncate()).extend(handedness);
            }
        }
    }
    Ok(())
}

/// Whether no bone is beyond the palette, also of those without weight.
fn all_exist(skinning: &Skinning, bones: &[Affine3A]) -> bool {
    let largest = skinning.bones.as_flattened().iter().fold(0, |most, bone| (*bone).max(most));
    usize::from(largest) < bones.len()
}

/// Positions and normals of the vertices from `first` on, one after the other.
fn skin_each(
    mesh: &Mesh,
    skinning: &Skinning,
    bones: &[Affine3A],
    is_even: bool,
    first: usize,
    positions: &mut [Vec3],
    normals: &mut [Vec3],
) -> Result<(), DeformError> {
    let rest = |length: usize| first.min(length)..;
    let undeformed = &mesh.normals[rest(mesh.normals.len())];
    let vertices = positions.iter_mut().zip(normals).zip(undeformed);
    let influences = skinning.bones[rest(skinning.bones.len())]
        .iter()
        .zip(&skinning.weights[rest(skinning.weights.len())]);
    for (place, (((position, normal), undeformed), (four, weights))) in vertices.zip(influences).enumerate() {
        let vertex = first + place;
        let along = blended_normal(*normal, *undeformed);
        let mut sums = Sums { position: (*position).into(), normal: along, posed: [Vec3A::ZERO; 2] };
        sums.add(vertex, bones, four, weights)?;
        if let (Some(four), Some(weights)) =
            (skinning.more_bones.get(vertex), skinning.more_weights.get(vertex))
        {
            sums.add(vertex, bones, four, weights)?;
        }
        *position = sums.posed[0].into();
        let mut turned = unit(sums.posed[1], *undeformed);
        if !is_even {
            turned = standing(&blended(skinning, bones, vertex), along, turned);
        }
        *normal = turned.into();
    }
    Ok(())
}

/// What bones make of one vertex: position and normal, and the sums of what each makes of them.
struct Sums {
    position: Vec3A,
    normal: Vec3A,
    posed: [Vec3A; 2],
}

impl Sums {
    /// A bone without weight has to exist, and adds nothing: of four bones, most vertices of a face follow
    /// one.
    fn add(
        &mut self,
        vertex: usize,
        bones: &[Affine3A],
        four: &[u16; 4],
        weights: &[f32; 4],
    ) -> Result<(), DeformError> {
        for (&bone, &weight) in four.iter().zip(weights) {
            let x = bones.get(usize::from(bone)).ok_or(DeformError::MissingBone {
                vertex,
                found: bone.into(),
                bones: bones.len(),
            })?;
            if weight == 0.0 {
                continue;
            }
            self.posed[0] += weight * x.transform_point3a(self.position);
            self.posed[1] += weight * x.transform_vector3a(self.normal);
        }
        Ok(())
    }
}

/// The unit normal that stands on what a matrix makes of the surface, or `otherwise` where it makes nothing.
fn standing(matrix: &DMat3, normal: Vec3A, otherwise: Vec3A) -> Vec3A {
    let standing = (normal_matrix(matrix) * normal.as_dvec3()).try_normalize();
    standing.map_or(otherwise, |normal| normal.as_vec3a())
}

fn blended_normal(blended: Vec3, undeformed: Vec3) -> Vec3A {
    // A root takes long, and only decides about what is nearly that short.
    let square = blended.length_squared();
    let is_short = square < 2.0 * MIN_NORMAL_LENGTH * MIN_NORMAL_LENGTH && square.sqrt() < MIN_NORMAL_LENGTH;
    if is_short { undeformed.into() } else { blended.into() }
}

fn unit(posed: Vec3A, undeformed: Vec3) -> Vec3A {
    let length = posed.length();
    if length < MIN_NORMAL_LENGTH { undeformed.into() } else { posed / length }
}

fn count_check(expected: usize) -> impl Fn(&'static str, usize) -> Result<(), DeformError> {
    move |what, found| match found == expected {
        true => Ok(()),
        false => Err(DeformError::VertexCount { what, expected, found }),
    }
}

fn check_lengths(
    mesh: &Mesh,
    weights: &[f32],
    normals: &ShapeNormals<'_>,
    out: &Deformed,
) -> Result<(), DeformError> {
    if weights.len() != mesh.shapes.len() {
        return Err(DeformError::WeightCount { expected: mesh.shapes.len(), found: weights.len() });
    }
    let check = count_check(mesh.positions.len());
    check("the mesh's normals", mesh.normals.len())?;
    check("the output's positions", out.positions.len())?;
    check("the output's normals", out.normals.len())?;
    for shape in &mesh.shapes {
        check("a shape's positions", shape.positions.len())?;
        let others = [("a shape's normals", &shape.normals), ("a shape's tangents", &shape.tangents)];
        for (what, offsets) in others {
            offsets.as_ref().map_or(Ok(()), |offsets| check(what, offsets.len()))?;
        }
    }
    if let ShapeNormals::Recomputed(smooth) = normals {
        check("the normals to be recomputed", smooth.vertex_count())?;
    }
    if !mesh.tangents.is_empty() {
        check("the mesh's tangents", mesh.tangents.len())?;
    }
    count_check(mesh.tangents.len())("the output's tangents", out.tangents.len())
}
