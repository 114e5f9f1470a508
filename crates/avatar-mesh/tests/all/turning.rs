//! Normals, tangents and triangles under bones that scale unevenly, shear and mirror.
//!
//! The reference knows no inverse transpose: a normal stands on what the matrix makes of two directions
//! across it, on the side that it makes of the normal itself.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::{Mesh, Skinning, deform, deformed_triangles, mirrors, turns_evenly};
use glam::{Affine3A, DMat3, DVec3, Mat3, Quat, Vec2, Vec3, Vec4};
use proptest::prelude::*;

/// The mean of a vertex's bones.
fn blended(mesh: &Mesh, bones: &[Affine3A], vertex: usize) -> DMat3 {
    let columns = |bone: &Affine3A| DMat3::from_cols_array(&bone.matrix3.to_cols_array().map(f64::from));
    let Some(skinning) = &mesh.skinning else { return columns(&bones[0]) };
    let mut sum = DMat3::ZERO;
    let more = skinning.more_bones.get(vertex).into_iter().flatten();
    let more_weights = skinning.more_weights.get(vertex).into_iter().flatten();
    let first = skinning.bones[vertex].iter().chain(more);
    for (bone, weight) in first.zip(skinning.weights[vertex].iter().chain(more_weights)) {
        sum += columns(&bones[usize::from(*bone)]) * f64::from(*weight);
    }
    sum
}

/// The normal of a moved surface, and how sure it is: the smaller, the flatter is what the matrix makes.
fn stood(matrix: DMat3, normal: Vec3) -> (DVec3, f64) {
    let n = normal.as_dvec3();
    let across = n.any_orthonormal_vector();
    let (one, other) = (matrix * across, matrix * n.cross(across));
    let standing = one.cross(other);
    let side = standing.dot(matrix * n);
    let direction = standing.normalize_or_zero() * side.signum();
    let largest = [one, other, matrix * n].iter().map(|v| v.length()).fold(0.0, f64::max);
    (direction, (side / largest.powi(3)).abs())
}

fn mesh(random: &mut Random, vertices: usize, bones: usize, skinned: bool, eight: bool) -> Mesh {
    let mut mesh = random.mesh(vertices, 1, bones);
    mesh.shapes[0].normals = None;
    mesh.tangents = mesh
        .normals
        .iter()
        .map(|normal| normal.any_orthonormal_vector().extend(if normal.x > 0.0 { 1.0 } else { -1.0 }))
        .collect();
    match (skinned, eight) {
        (false, _) => mesh.skinning = None,
        (true, true) => random.add_further_bones(&mut mesh, bones),
        (true, false) => {}
    }
    mesh
}

proptest! {
    #[test]
    fn normals_stand_on_what_uneven_bones_make_of_the_surface(
        seed in any::<u64>(), vertices in 1..40usize, bones in 1..6usize, skinned in any::<bool>(),
        eight in any::<bool>(),
    ) {
        let mut random = Random(seed);
        let mesh = mesh(&mut random, vertices, bones, skinned, eight);
        let palette: Vec<Affine3A> = (0..bones)
            .map(|k| if k == 0 || random.below(2) == 0 { random.uneven() } else { random.rigid() })
            .collect();
        let mut out = mesh.deformed();
        deform(&mesh, &palette, &[0.5], &mut out).unwrap();
        let is_uneven = mesh.skinning.as_ref().is_none_or(|s| s.used_bones().iter().any(
            |bone| !turns_evenly(&palette[usize::from(*bone)])));
        let any_mirrors = mesh.skinning.as_ref().map_or_else(|| mirrors(&palette[0]), |s| s.used_bones().iter().any(
            |bone| palette[usize::from(*bone)].matrix3.determinant() < 0.0));
        let triangles = deformed_triangles(&mesh, &palette);
        let mut is_mirrored = Vec::new();
        for vertex in 0..vertices {
            let matrix = blended(&mesh, &palette, vertex);
            is_mirrored.push(matrix.determinant() < 0.0);
            let (expected, sure) = stood(matrix, mesh.normals[vertex]);
            let found = out.normals[vertex].as_dvec3();
            if is_uneven && sure > 1e-4 {
                prop_assert!(found.distance(expected) < 1e-6 / sure, "{found} {expected} {sure}");
                // The right-handed frame of a surface that is mirrored is a left-handed one.
                let tangent = out.tangents[vertex];
                let along = (matrix * mesh.tangents[vertex].truncate().as_dvec3()).normalize_or_zero();
                prop_assert!(tangent.truncate().as_dvec3().distance(along) < 1e-5 / sure);
                prop_assert!(tangent.truncate().as_dvec3().dot(found).abs() < 1e-5 / sure);
                let across = mesh.normals[vertex].cross(mesh.tangents[vertex].truncate()) * mesh.tangents[vertex].w;
                let expected = matrix * across.as_dvec3();
                prop_assert!((found.cross(tangent.truncate().as_dvec3()) * f64::from(tangent.w)).dot(expected) > 0.0);
            }
        }
        for (found, corners) in triangles.iter().zip(&mesh.triangles) {
            let [a, b, c] = *corners;
            let votes = corners.iter().filter(|corner| is_mirrored[**corner as usize]).count();
            prop_assert_eq!(*found, if any_mirrors && votes > 1 { [a, c, b] } else { [a, b, c] });
        }
    }

    #[test]
    fn rotations_and_even_scales_give_the_bits_of_the_plain_formula(seed in any::<u64>(), bones in 1..6usize) {
        let mut random = Random(seed);
        let mesh = mesh(&mut random, 20, bones, true, false);
        let palette: Vec<Affine3A> = (0..bones)
            .map(|_| random.rigid() * Affine3A::from_scale(Vec3::splat(0.1 + random.signed().abs())))
            .collect();
        prop_assert!(palette.iter().all(turns_evenly));
        // A bone that moves nothing does not count, however uneven it is.
        let more = [&palette[..], &[random.uneven()]].concat();
        let (mut out, mut same) = (mesh.deformed(), mesh.deformed());
        deform(&mesh, &palette, &[0.5], &mut out).unwrap();
        deform(&mesh, &more, &[0.5], &mut same).unwrap();
        prop_assert_eq!(&out, &same);
        let skinning = mesh.skinning.as_ref().unwrap();
        for vertex in 0..20 {
            let mut sum = glam::Vec3A::ZERO;
            for (bone, weight) in skinning.bones[vertex].iter().zip(&skinning.weights[vertex]) {
                sum += *weight * palette[usize::from(*bone)].transform_vector3a(mesh.normals[vertex].into());
            }
            let length = sum.length();
            if length > 1e-6 {
                prop_assert_eq!(out.normals[vertex], Vec3::from(sum / length));
            }
        }
        prop_assert!(matches!(deformed_triangles(&mesh, &more), std::borrow::Cow::Borrowed(_)));
    }
}

/// One triangle that looks along +Z.
fn triangle(skinning: Option<Skinning>) -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![Vec2::ZERO; 3],
        normals: vec![Vec3::Z; 3],
        tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 3],
        triangles: vec![[0, 1, 2]],
        skinning,
        ..Mesh::default()
    }
}

#[test]
fn a_mirrored_triangle_keeps_its_front() {
    for mirror in
        [Vec3::new(-1., 1., 1.), Vec3::new(2., -1., 1.), Vec3::new(-1., -1., -3.), Vec3::new(1., 1., -1.)]
    {
        let mesh = triangle(None);
        let bones =
            [Affine3A::from_scale_rotation_translation(mirror, Quat::from_rotation_x(0.4), Vec3::ONE)];
        let mut out = mesh.deformed();
        deform(&mesh, &bones, &[], &mut out).unwrap();
        let [a, b, c] = deformed_triangles(&mesh, &bones)[0].map(|corner| out.positions[corner as usize]);
        let front = (b - a).cross(c - a).normalize_or_zero();
        assert!(front.distance(out.normals[0]) < 1e-6, "{mirror}: {front} {}", out.normals[0]);
        assert_eq!(out.tangents[0].w, -1.0);
    }
}

#[test]
fn flat_and_broken_bones_do_not_panic_and_a_flat_one_has_a_normal() {
    let flat = Affine3A::from_scale(Vec3::new(1.0, 2.0, 0.0));
    let mesh = triangle(None);
    let mut out = mesh.deformed();
    deform(&mesh, &[flat], &[], &mut out).unwrap();
    assert_eq!(out.normals, [Vec3::Z; 3]);
    // A needle has no surface: the normal stays.
    for scale in [Vec3::new(1.0, 0.0, 0.0), Vec3::ZERO] {
        deform(&mesh, &[Affine3A::from_scale(scale)], &[], &mut out).unwrap();
        assert_eq!(out.normals, [Vec3::Z; 3]);
    }
    for scale in [Vec3::splat(f32::NAN), Vec3::new(f32::INFINITY, 1.0, 1.0), Vec3::new(1e-30, 1e30, 1.0)] {
        deform(&mesh, &[Affine3A::from_scale(scale)], &[], &mut out).unwrap();
        assert_eq!(deformed_triangles(&mesh, &[Affine3A::from_scale(scale)])[0], [0, 1, 2]);
    }
    // f32 alone would lose such factors.
    let tiny = Affine3A::from_mat3(Mat3::from_diagonal(Vec3::new(1e-25, 2e-25, -1e-25)));
    deform(&mesh, &[tiny], &[], &mut out).unwrap();
    assert_eq!(out.normals, [Vec3::NEG_Z; 3]);
    assert_eq!(deformed_triangles(&mesh, &[tiny])[0], [0, 2, 1]);
    assert_eq!(deformed_triangles(&mesh, &[])[0], [0, 1, 2]);
}
