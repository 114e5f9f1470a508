//! Up to eight bones for each vertex.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::{DeformBounds, Mesh, MeshError, MeshWarning, Skinning, deform, raw, weld};
use glam::{Affine3A, Vec2, Vec3};
use proptest::prelude::*;

/// Two vertices: one with eight bones, one with the first alone.
fn two() -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO; 2],
        uvs: vec![Vec2::ZERO; 2],
        normals: vec![Vec3::Y; 2],
        triangles: vec![[0, 1, 0]],
        skinning: Some(Skinning {
            bones: vec![[0, 1, 2, 3], [0; 4]],
            weights: vec![[0.25, 0.125, 0.0625, 0.0625], [1.0, 0.0, 0.0, 0.0]],
            more_bones: vec![[4, 5, 6, 7], [0; 4]],
            more_weights: vec![[0.25, 0.125, 0.09375, 0.03125], [0.0; 4]],
            blend_index: Vec::new(),
        }),
        ..Mesh::default()
    }
}

fn skinning(mesh: &mut Mesh) -> &mut Skinning {
    mesh.skinning.as_mut().unwrap()
}

#[test]
fn all_eight_bones_move_a_vertex() {
    let mesh = two();
    let bones: Vec<Affine3A> =
        (0..8u8).map(|k| Affine3A::from_translation(Vec3::new(f32::from(1u8 << k), 0.0, 1.0))).collect();
    let mut out = mesh.deformed();
    deform(&mesh, &bones, &[], &mut out).unwrap();
    // 1/4 + 2/8 + 4/16 + 8/16 + 16/4 + 32/8 + 64 · 3/32 + 128/32, by hand.
    assert_eq!(out.positions, [Vec3::new(19.25, 0.0, 1.0), Vec3::new(1.0, 0.0, 1.0)]);
}

#[test]
fn what_knows_four_bones_gets_the_largest() {
    let mesh = two();
    let skinning = mesh.skinning.as_ref().unwrap();
    // The largest are 1/4, 1/4, 1/8, 1/8: three quarters of the whole.
    let (bones, weights) = skinning.largest_four(0);
    assert_eq!(bones, [0, 4, 1, 5]);
    let expected = [1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0];
    assert_eq!(weights, expected.map(|weight: f64| weight as f32));
    assert_eq!(skinning.largest_four(1), ([0; 4], [1.0, 0.0, 0.0, 0.0]));
    assert_eq!([0, 1, 2].map(|vertex| skinning.has_more_than_four(vertex)), [true, false, false]);
    assert_eq!(skinning.used_bones(), [0, 1, 2, 3, 4, 5, 6, 7]);
    let four = Skinning { more_bones: Vec::new(), more_weights: Vec::new(), ..skinning.clone() };
    assert_eq!(four.used_bones(), [0, 1, 2, 3]);
    assert_eq!(four.influences(0).count(), 4);
    assert_eq!((skinning.influences(0).last(), skinning.influences(2).count()), (Some((7, 0.03125)), 0));
    // The raw format holds four.
    let written = raw::write_vertices(&mesh);
    let floats: Vec<f32> =
        written.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    assert_eq!(floats[8..12], [0.0, 4.0, 1.0, 5.0]);
    assert_eq!(floats[12..16], weights);
}

#[test]
fn the_weights_of_all_eight_sum_to_one() {
    let mut mesh = two();
    assert_eq!(mesh.validate(8), Ok(vec![]));
    assert_eq!(mesh, two());
    skinning(&mut mesh).more_weights[0][0] += 1e-4;
    let warnings = mesh.validate(8).unwrap();
    assert!(
        matches!(warnings[..], [MeshWarning::Renormalised { vertices: 1, worst: 0, .. }]),
        "{warnings:?}"
    );
    let sum: f64 = mesh.skinning.as_ref().unwrap().influences(0).map(|(_, w)| f64::from(w)).sum();
    assert!((sum - 1.0).abs() < 1e-7, "{sum}");
    let found = |edit: &dyn Fn(&mut Skinning), bones| {
        let mut mesh = two();
        edit(skinning(&mut mesh));
        mesh.validate(bones).unwrap_err()
    };
    let error = found(&|s| s.more_weights[0] = [0.0; 4], 8);
    assert_eq!(error, MeshError::WeightSum { vertex: 0, found: 0.5 });
    let error = found(&|s| s.more_bones[1][2] = 9, 8);
    assert_eq!(error, MeshError::BoneIndex { vertex: 1, slot: 6, found: 9.0, last: 7 });
    let error = found(&|s| s.more_bones.truncate(1), 8);
    let what = "further bone indices".to_owned();
    assert_eq!(error, MeshError::Count { what, expected: 2, found: 1 });
}

#[test]
fn vertices_that_only_differ_in_further_bones_stay_apart() {
    let mut mesh = two();
    let s = skinning(&mut mesh);
    (s.bones[1], s.weights[1]) = (s.bones[0], s.weights[0]);
    (s.more_bones[1], s.more_weights[1]) = (s.more_bones[0], s.more_weights[0]);
    assert_eq!(weld(&mesh).welded_from_original, [0, 0]);
    skinning(&mut mesh).more_bones[1][3] = 0;
    let welded = weld(&mesh);
    assert_eq!((welded.welded_from_original, &welded.mesh), (vec![0, 1], &mesh));
    skinning(&mut mesh).more_bones[1][3] = 7;
    skinning(&mut mesh).more_weights[1] = [0.25, 0.125, 0.03125, 0.09375];
    assert_eq!(weld(&mesh).welded_from_original, [0, 1]);
}

proptest! {
    #[test]
    fn boxes_hold_what_further_bones_move(
        seed in any::<u64>(), vertices in 1..60usize, bones in 1..12usize, valid in any::<bool>(),
    ) {
        let mut random = Random(seed);
        let mut mesh = random.mesh(vertices, 0, bones);
        random.add_further_bones(&mut mesh, bones);
        if !valid {
            for weights in &mut skinning(&mut mesh).more_weights {
                *weights = [(); 4].map(|()| random.signed());
            }
        }
        let palette: Vec<Affine3A> = (0..bones).map(|_| random.rigid()).collect();
        let mut out = mesh.deformed();
        deform(&mesh, &palette, &[], &mut out).unwrap();
        let around = DeformBounds::new(&mesh).around(&palette, &[]).unwrap();
        for position in out.positions {
            prop_assert!(around.min.cmple(position).all() && around.max.cmpge(position).all());
        }
    }
}
