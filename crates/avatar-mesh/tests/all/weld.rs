//! Welding: the welded mesh deforms to the same bits; points are merged as a comparison of all pairs says.
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test: it may panic and look at the clock"
)]

use crate::common::{Random, edit_offset};
use avatar_mesh::{Mesh, Offsets, Shape, Skinning, deform, raw, weld, weld_positions, weld_repeated};
use glam::{Affine3A, Vec3, Vec4};
use proptest::prelude::*;
use std::time::{Duration, Instant};

/// A mesh of `vertices` vertices that are copies of a few, in random order.
fn far_from_welded(random: &mut Random, distinct: usize, vertices: usize) -> (Mesh, Vec<usize>) {
    let source = random.mesh(distinct, 2, 9);
    let copies: Vec<usize> = (0..vertices).map(|_| random.below(distinct)).collect();
    let skinning = source.skinning.as_ref().unwrap();
    let offsets = |d: &Offsets| copies.iter().map(|&i| d.get(i).unwrap()).collect::<Offsets>();
    let vec3s = |values: &[Vec3]| copies.iter().map(|&i| values[i]).collect::<Vec<_>>();
    let mesh = Mesh {
        positions: vec3s(&source.positions),
        uvs: copies.iter().map(|&i| source.uvs[i]).collect(),
        normals: vec3s(&source.normals),
        triangles: (0..vertices).map(|_| std::array::from_fn(|_| random.below(vertices) as u32)).collect(),
        skinning: Some(Skinning {
            bones: copies.iter().map(|&i| skinning.bones[i]).collect(),
            weights: copies.iter().map(|&i| skinning.weights[i]).collect(),
            blend_index: vec3s(&skinning.blend_index),
            ..Skinning::default()
        }),
        shapes: (source.shapes.iter())
            .map(|shape| {
                let normals = offsets(shape.normals.as_ref().unwrap());
                Shape::new(shape.name.clone(), offsets(&shape.positions)).with_normals(normals)
            })
            .collect(),
        ..Mesh::default()
    };
    (mesh, copies)
}

proptest! {
    #[test]
    fn the_welded_mesh_deforms_to_the_same_bits(seed in any::<u64>(), distinct in 1..20usize, vertices in 1..60usize) {
        let mut random = Random(seed);
        let (mesh, copies) = far_from_welded(&mut random, distinct, vertices);
        let welded = weld(&mesh);
        let mut used = copies.clone();
        used.sort_unstable();
        used.dedup();
        prop_assert_eq!(welded.mesh.positions.len(), used.len());
        prop_assert_eq!(welded.welded_from_original.len(), vertices);
        prop_assert_eq!(welded.mesh.clone().validate(9), Ok(vec![]));

        let bones: Vec<Affine3A> = (0..9).map(|_| random.rigid()).collect();
        let (mut before, mut after) = (mesh.deformed(), welded.mesh.deformed());
        deform(&mesh, &bones, &[0.7, -0.2], &mut before).unwrap();
        deform(&welded.mesh, &bones, &[0.7, -0.2], &mut after).unwrap();
        let bits = |v: Vec3| v.to_array().map(f32::to_bits);
        for (original, &new) in welded.welded_from_original.iter().enumerate() {
            prop_assert_eq!(bits(before.positions[original]), bits(after.positions[new as usize]));
            prop_assert_eq!(bits(before.normals[original]), bits(after.normals[new as usize]));
            prop_assert_eq!(mesh.uvs[original], welded.mesh.uvs[new as usize]);
        }
        // The same triangles in the same order, and numbers in the order of first appearance.
        for (old, new) in mesh.triangles.iter().zip(&welded.mesh.triangles) {
            prop_assert_eq!(old.map(|corner| welded.welded_from_original[corner as usize]), *new);
        }
        let mut next = 0;
        for &number in &welded.welded_from_original {
            prop_assert!(number <= next);
            next = next.max(number + 1);
        }
        // Once welded there is nothing left to weld.
        prop_assert_eq!(&weld(&welded.mesh).mesh, &welded.mesh);
        prop_assert_eq!(weld_repeated(&welded.mesh), None);
        let repeats = used.len() < vertices;
        prop_assert_eq!(weld_repeated(&mesh), repeats.then_some(welded));
    }

    #[test]
    fn points_are_merged_as_all_pairs_say(seed in any::<u64>(), n in 0..80usize, tolerance in prop_oneof![0.0..0.6f32, Just(0.0f32), Just(1e-30f32), Just(100.0f32)]) {
        let mut random = Random(seed);
        let mut points: Vec<Vec3> = (0..n).map(|_| random.vec3(2.0)).collect();
        // Exact copies, and points on a grid whose distances are the tolerance to the bit.
        for _ in 0..n / 3 {
            let (from, to) = (random.below(n), random.below(n));
            points[to] = points[from];
        }
        for _ in 0..n / 3 {
            let to = random.below(n);
            points[to] = Vec3::new(random.below(4) as f32, random.below(2) as f32, 0.0) * tolerance.max(0.5);
        }
        prop_assert_eq!(weld_positions(&points, tolerance), all_pairs(&points, tolerance));
    }
}

/// Joins every pair of near points, then numbers the groups by first appearance.
fn all_pairs(points: &[Vec3], tolerance: f32) -> Vec<u32> {
    let mut group: Vec<usize> = (0..points.len()).collect();
    for i in 0..points.len() {
        for j in 0..i {
            if points[i].as_dvec3().distance(points[j].as_dvec3()) <= f64::from(tolerance) {
                let (from, to) = (group[i], group[j]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
        }
    }
    let mut numbers: Vec<usize> = Vec::new();
    let number = |g: &usize| {
        let found = numbers.iter().position(|seen| seen == g).unwrap_or(numbers.len());
        if found == numbers.len() {
            numbers.push(*g);
        }
        found as u32
    };
    group.iter().map(number).collect()
}

#[test]
fn equal_points_are_welded_in_linear_time() {
    let start = Instant::now();
    assert_eq!(weld_positions(&vec![Vec3::ONE; 300_000], 0.0), vec![0; 300_000]);
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    let odd = [Vec3::ZERO, Vec3::NAN, -Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::ZERO, Vec3::ONE];
    assert_eq!(weld_positions(&odd, 0.0), [0, 1, 0, 2, 3, 0, 4]);
}

#[test]
fn every_attribute_that_shows_keeps_vertices_apart() {
    let base = far_from_welded(&mut Random(1), 1, 2).0;
    assert_eq!(weld(&base).welded_from_original, [0, 0]);
    let edits: [&dyn Fn(&mut Mesh); 12] = [
        &|m| m.positions[1].x += 1e-5,
        &|m| m.uvs[1].y += 1.0,
        &|m| m.normals[1].z += 1e-5,
        &|m| edit_offset(&mut m.shapes[0].positions, 1, |d| d.x += 1e-5),
        &|m| edit_offset(m.shapes[0].normals.as_mut().unwrap(), 1, |d| d.x += 1e-5),
        &|m| edit_offset(&mut m.shapes[1].positions, 1, |d| d.y += 1e-5),
        &|m| edit_offset(m.shapes[1].normals.as_mut().unwrap(), 1, |d| d.y += 1e-5),
        &|m| m.shapes[1].tangents = Some(vec![Vec3::ZERO, Vec3::X * 1e-5].into()),
        &|m| m.shapes.push(Shape::from_pairs("s", 2, [(1, Vec3::X * 1e-5)]).unwrap()),
        &|m| m.tangents = vec![Vec4::W, -Vec4::W],
        &|m| m.skinning.as_mut().unwrap().bones[1][3] ^= 1,
        &|m| m.skinning.as_mut().unwrap().weights[1][2] += 1e-5,
    ];
    for (i, edit) in edits.iter().enumerate() {
        let mut mesh = base.clone();
        edit(&mut mesh);
        assert_eq!(weld(&mesh).welded_from_original, [0, 1], "attribute {i}");
    }
    // To the bit: −0 is not 0, although they compare equal.
    let mut zeros = base.clone();
    zeros.positions = vec![Vec3::ZERO, Vec3::new(0.0, -0.0, 0.0)];
    assert_eq!(weld(&zeros).welded_from_original, [0, 1]);
    // The column that nothing uses keeps nothing apart, and the first value stays.
    let mut unused = base.clone();
    unused.skinning.as_mut().unwrap().blend_index[1] = Vec3::ONE;
    let welded = weld(&unused);
    assert_eq!(welded.welded_from_original, [0, 0]);
    assert_eq!(welded.mesh.skinning.unwrap().blend_index, base.skinning.unwrap().blend_index[..1]);
}

#[test]
fn rigid_parts_and_empty_meshes_weld_as_well() {
    assert_eq!(weld(&Mesh::default()).mesh, Mesh::default());
    let one = crate::common::bytes(&[1., 2., 3., 0., 0., 0., 0., 1.]);
    let indices: Vec<u8> = [2u32, 1, 0].iter().flat_map(|i| i.to_le_bytes()).collect();
    let welded = weld(&raw::read_rigid(&one.repeat(3), &indices).unwrap());
    assert_eq!(welded.mesh.positions, [Vec3::new(1., 2., 3.)]);
    assert_eq!(welded.mesh.triangles, [[0, 0, 0]]);
}

#[test]
fn chains_merge_and_the_tolerance_is_a_distance() {
    let chain: Vec<Vec3> = (0..10).map(|i| Vec3::X * (i as f32 * 0.5)).collect();
    assert_eq!(weld_positions(&chain, 0.5), [0; 10]);
    assert_eq!(weld_positions(&chain, 0.499), (0..10).collect::<Vec<u32>>());
    assert_eq!(weld_positions(&[Vec3::ONE, Vec3::ZERO, Vec3::ONE], 0.0), [0, 1, 0]);
    assert_eq!(weld_positions(&[], 1.0), [] as [u32; 0]);
    // No distance is within less than nothing, not even that of a point to itself.
    assert_eq!(weld_positions(&[Vec3::ONE; 2], -1.0), [0, 1]);
    // Differences whose squares vanish in f32 are differences still.
    assert_eq!(weld_positions(&[Vec3::X * 1e-25, Vec3::X * 2e-25], 1e-26), [0, 1]);
    let far = [Vec3::splat(1e30), Vec3::splat(1e30), Vec3::splat(-1e30), Vec3::splat(f32::MAX)];
    assert_eq!(weld_positions(&far, 1e-6), [0, 0, 1, 2]);
}

/// A tolerance of nothing must not put all points into one cell and compare all pairs.
#[test]
fn a_large_mesh_welds_in_bounded_time() {
    let mut random = Random(3);
    let points: Vec<Vec3> = (0..200_000).map(|_| random.vec3(15.0)).collect();
    for tolerance in [0.0, 1e-30, 1e-6] {
        let start = Instant::now();
        let numbers = weld_positions(&points, tolerance);
        assert!(numbers.iter().max() > Some(&190_000));
        assert!(start.elapsed() < Duration::from_secs(20), "{tolerance}: {:?}", start.elapsed());
    }
}
