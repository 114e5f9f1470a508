//! What is computed many numbers at a time is, for any bits, what its definition says, written here one
//! number after the other.
#![allow(clippy::unwrap_used, reason = "a test: it may panic")]

use crate::common::bytes;
use avatar_mesh::{
    Bounds, Deformed, Mesh, MeshError, Offsets, Shape, Skinning, WEIGHT_SUM_LIMIT, WEIGHT_SUM_TOLERANCE,
    Welded, Winding, deform, raw, weld,
};
use glam::{Affine3A, Quat, Vec2, Vec3, Vec3A};
use proptest::collection::vec;
use proptest::prelude::*;

/// Any float; often one that is a bone, or nearly.
fn any_bone() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => (0u8..9).prop_map(f32::from),
        1 => prop_oneof![Just(-0.0f32), Just(8.5), Just(9.0), Just(-1.0), Just(0.1), Just(-0.1), Just(1e-40)],
        1 => prop_oneof![Just(8_388_608.0f32), Just(-8_388_608.0), Just(4e9), Just(-4e9), Just(1e30), Just(f32::MAX)],
        1 => proptest::num::f32::ANY,
    ]
}

fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![6 => -10.0f32..10.0, 1 => proptest::num::f32::ANY, 1 => Just(0.0f32), 1 => Just(-0.0f32)]
}

fn small_mesh(vertices: usize) -> Mesh {
    Mesh {
        positions: (0..vertices).map(|i| Vec3::new(i as f32, 0.5, -1.0)).collect(),
        uvs: vec![Vec2::ZERO; vertices],
        normals: vec![Vec3::Z; vertices],
        ..Mesh::default()
    }
}

proptest! {
    #[test]
    fn a_bone_index_is_a_whole_number_of_a_bone(found in vec([any_bone(), any_bone(), any_bone(), any_bone()], 1..150)) {
        let floats: Vec<f32> = found.iter().flat_map(|bones| {
            let mut vertex = [0.5; raw::SKIN_FLOATS];
            vertex[8..12].copy_from_slice(bones);
            vertex
        }).collect();
        let exists = |bone: f32| (0..9).any(|whole| whole as f32 == bone);
        let first = found.as_flattened().iter().position(|bone| !exists(*bone));
        match (raw::read_skin(&bytes(&floats), &[]), first) {
            (Ok(mesh), None) => {
                let expected: Vec<[u16; 4]> = found.iter().map(|four| four.map(|bone| bone as u16)).collect();
                prop_assert_eq!(mesh.skinning.unwrap().bones, expected);
            }
            (Err(MeshError::BoneIndex { vertex, slot, found: bone, last }), Some(first)) => {
                prop_assert_eq!((vertex, slot, last), (first / 4, first % 4, 8));
                prop_assert_eq!(bone.to_bits(), found[vertex][slot].to_bits());
            }
            (result, first) => prop_assert!(false, "{:?}, the first wrong one is {:?}", result, first),
        }
    }

    #[test]
    fn the_first_number_that_is_not_finite_is_named(numbers in vec(any_number(), 1..120), which in 0usize..4) {
        let vertices = numbers.len().div_ceil(3);
        let mut mesh = small_mesh(vertices);
        let at = |i: usize| numbers.get(i).copied().unwrap_or(1.0);
        let threes: Vec<Vec3> = (0..vertices).map(|v| Vec3::new(at(3 * v), at(3 * v + 1), at(3 * v + 2))).collect();
        let field = match which {
            0 => { mesh.positions = threes; "position" }
            1 => { mesh.normals = threes; "normal" }
            2 => { mesh.shapes.push(Shape::new("a", threes)); "position offset of a" }
            _ => {
                let shape = Shape::new("a", vec![Vec3::ZERO; vertices]).with_normals(threes);
                mesh.shapes.push(shape);
                "normal offset of a"
            }
        };
        match (mesh.validate(1), numbers.iter().position(|x| !x.is_finite())) {
            (Ok(_), None) => {}
            (Err(MeshError::NotFinite { vertex, field: told, found }), Some(first)) => {
                prop_assert_eq!((vertex, told.as_str()), (first / 3, field));
                prop_assert_eq!(found.to_bits(), numbers[first].to_bits());
            }
            (result, first) => prop_assert!(false, "{:?}, the first is {:?}", result, first),
        }
    }

    #[test]
    fn the_first_corner_beyond_the_vertices_is_named(
        triangles in vec([0u32..9, 0u32..9, 0u32..9], 1..40),
        wrong in proptest::option::of((0usize..120, prop_oneof![Just(9u32), Just(1 << 31), Just(u32::MAX), 9u32..])),
    ) {
        let mut triangles = triangles;
        let corners = triangles.as_flattened_mut();
        if let Some((place, index)) = wrong {
            let place = place % corners.len();
            corners[place] = index;
        }
        let first = corners.iter().position(|corner| *corner >= 9);
        let mut mesh = Mesh { triangles, ..small_mesh(9) };
        match (mesh.validate(1), first) {
            (Ok(_), None) => {}
            (Err(MeshError::IndexOutOfRange { triangle, corner, .. }), Some(first)) => {
                prop_assert_eq!(3 * triangle + corner, first);
            }
            (result, first) => prop_assert!(false, "{:?}, the first is {:?}", result, first),
        }
    }

    #[test]
    fn weights_are_mended_as_far_as_they_are_off(off in vec(-2e-6f64..2e-6, 1..40), far in proptest::option::of(-2e-3f64..2e-3)) {
        let off: Vec<f64> = off.into_iter().chain(far).collect();
        let weights: Vec<[f32; 4]> = off.iter().map(|off| [0.5, 0.25, 0.125, (0.125 + off) as f32]).collect();
        let mut mesh = small_mesh(off.len());
        let skinning = Skinning { bones: vec![[0; 4]; off.len()], weights: weights.clone(), ..Skinning::default() };
        mesh.skinning = Some(skinning);
        let sum = |w: &[f32; 4]| w.iter().map(|w| f64::from(*w)).sum::<f64>();
        let is_far = weights.iter().any(|w| (sum(w) - 1.0).abs() > WEIGHT_SUM_LIMIT);
        let expected = weights.iter().map(|w| match (sum(w) - 1.0).abs() > WEIGHT_SUM_TOLERANCE {
            true => w.map(|one| (f64::from(one) / sum(w)) as f32),
            false => *w,
        });
        let expected: Vec<[f32; 4]> = expected.collect();
        let result = mesh.validate(1);
        prop_assert_eq!(result.is_err(), is_far);
        if let Ok(warnings) = result {
            prop_assert_eq!(&mesh.skinning.unwrap().weights, &expected);
            // All are told of, or none: a mesh without triangles has a warning of its own.
            prop_assert_eq!(warnings.len() == 2, weights.iter().any(|w| (sum(w) - 1.0).abs() > WEIGHT_SUM_TOLERANCE));
        }
    }

    #[test]
    fn a_box_is_around_all_points_and_touches_them(points in vec([-9.0f32..9.0, -9.0f32..9.0, -9.0f32..9.0], 1..30)) {
        let points: Vec<Vec3> = points.into_iter().map(Vec3::from_array).collect();
        let around = Bounds::of(&points).unwrap();
        for axis in 0..3 {
            let along = points.iter().map(|p| p[axis]);
            prop_assert_eq!(around.min[axis], along.clone().fold(f32::INFINITY, f32::min));
            prop_assert_eq!(around.max[axis], along.fold(f32::NEG_INFINITY, f32::max));
        }
    }

    #[test]
    fn what_is_inside_out_is_counted_to_the_end(flips in vec(0u8..3, 0..2500)) {
        let mut mesh = small_mesh(3);
        mesh.positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        mesh.triangles = flips.iter().map(|flip| [[0, 1, 2], [0, 2, 1], [0, 0, 1]][usize::from(*flip)]).collect();
        let count = |which| flips.iter().filter(|flip| **flip == which).count();
        let (agreeing, contradicting, undecided) = (count(0), count(1), count(2));
        prop_assert_eq!(Winding::of(&mesh), Winding { agreeing, contradicting, undecided });
        let expected = (contradicting > agreeing).then_some(Winding { agreeing, contradicting, undecided });
        prop_assert_eq!(Winding::of_inside_out(&mesh), expected);
    }

    #[test]
    fn welding_merges_what_is_alike_to_the_bit(
        picks in vec([0usize..3, 0usize..3, 0usize..2, 0usize..2, 0usize..8], 1..40),
        is_sparse: bool,
    ) {
        let value = [0.0f32, -0.0, 1.0];
        let mut mesh = small_mesh(picks.len());
        let mut skinning = Skinning::default();
        let mut offsets = Vec::new();
        for (vertex, [p, n, uv, bone, offset]) in picks.iter().enumerate() {
            mesh.positions[vertex] = Vec3::new(value[*p], 0.0, 2.0);
            mesh.normals[vertex] = Vec3::new(0.0, value[*n], 1.0);
            mesh.uvs[vertex] = Vec2::new(value[*uv], 0.0);
            skinning.bones.push([*bone as u16, 0, 0, 0]);
            skinning.weights.push([1.0, 0.0, 0.0, 0.0]);
            let moved = if is_sparse { (*offset == 0).into() } else { *offset as f32 + 1.0 };
            offsets.push(Vec3::new(0.0, moved, 0.0));
        }
        mesh.skinning = Some(skinning);
        mesh.shapes.push(Shape::new("a", Offsets::from(offsets.clone())));
        let bits = |v: usize| {
            let three = [mesh.positions[v], mesh.normals[v], offsets[v]].map(|p| p.to_array().map(f32::to_bits));
            (three, mesh.uvs[v].to_array().map(f32::to_bits), mesh.skinning.as_ref().unwrap().bones[v])
        };
        let mut kept: Vec<usize> = Vec::new();
        let expected: Vec<u32> = (0..picks.len()).map(|v| {
            let known = kept.iter().position(|other| bits(*other) == bits(v));
            known.unwrap_or_else(|| { kept.push(v); kept.len() - 1 }) as u32
        }).collect();
        let Welded { mesh: welded, welded_from_original } = weld(&mesh);
        prop_assert_eq!(welded_from_original, expected);
        prop_assert_eq!(welded.positions.len(), kept.len());
        for (v, original) in kept.iter().enumerate() {
            prop_assert_eq!(welded.positions[v].x.to_bits(), mesh.positions[*original].x.to_bits());
            prop_assert_eq!(welded.shapes[0].positions.get(v), Some(offsets[*original]));
        }
    }

    #[test]
    fn bones_without_weight_change_no_bit(weights in vec([0u8..3, 0u8..3, 0u8..3, 1u8..3], 1..30)) {
        let mut mesh = small_mesh(weights.len());
        let total = |w: &[u8; 4]| w.iter().map(|w| f32::from(*w)).sum::<f32>();
        let weights: Vec<[f32; 4]> = weights.iter().map(|w| w.map(|one| f32::from(one) / total(w))).collect();
        mesh.skinning =
            Some(Skinning { bones: vec![[0, 1, 2, 3]; weights.len()], weights, ..Skinning::default() });
        let bones: Vec<Affine3A> = (0..4)
            .map(|i| Affine3A::from_rotation_translation(Quat::from_rotation_y(i as f32), Vec3::splat(i as f32)))
            .collect();
        let mut out = mesh.deformed();
        deform(&mesh, &bones, &[], &mut out).unwrap();
        prop_assert_eq!(out, formula(&mesh, &bones));
    }
}

/// `Σ_i w_i · X_i · v` over all four bones, and the same for normals.
fn formula(mesh: &Mesh, bones: &[Affine3A]) -> Deformed {
    let mut out = mesh.deformed();
    let skinning = mesh.skinning.as_ref().unwrap();
    for vertex in 0..mesh.positions.len() {
        let (mut position, mut normal) = (Vec3A::ZERO, Vec3A::ZERO);
        for (bone, weight) in skinning.bones[vertex].iter().zip(skinning.weights[vertex]) {
            let x = &bones[usize::from(*bone)];
            position += weight * x.transform_point3a(mesh.positions[vertex].into());
            normal += weight * x.transform_vector3a(mesh.normals[vertex].into());
        }
        out.positions[vertex] = position.into();
        out.normals[vertex] = (normal / normal.length()).into();
    }
    out
}
