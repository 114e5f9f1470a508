//! The mathematics of blend shapes: relative and absolute forms, normalised weights, extrapolation.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::weights::{VertexCountError, base_weight, clamp, normalise};
use avatar_mesh::{Mesh, Offsets, Shape, ShapeNormals, blend};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

const VERTICES: usize = 12;

/// A mesh and the absolute geometries that its shapes were made of. Coordinates reach 15.
fn set(random: &mut Random, shapes: usize) -> (Mesh, Vec<Vec<Vec3>>) {
    let mut mesh = random.mesh(VERTICES, 0, 1);
    let absolute: Vec<Vec<Vec3>> =
        (0..shapes).map(|_| mesh.positions.iter().map(|p| *p + random.vec3(3.0)).collect()).collect();
    let shape =
        |(k, s): (usize, &Vec<Vec3>)| Shape::from_absolute(k.to_string(), &mesh.positions, s).unwrap();
    mesh.shapes = absolute.iter().enumerate().map(shape).collect();
    (mesh, absolute)
}

fn blended(mesh: &Mesh, weights: &[f32]) -> Vec<Vec3> {
    let mut out = mesh.deformed();
    blend(mesh, weights, ShapeNormals::Given, &mut out).unwrap();
    out.positions
}

fn normalised(weights: &[f32]) -> Vec<f32> {
    let mut normalised = weights.to_vec();
    normalise(&mut normalised);
    normalised
}

fn weights(n: std::ops::Range<usize>) -> impl Strategy<Value = Vec<f32>> {
    prop::collection::vec(prop_oneof![-1.5..2.5f32, Just(0.0f32), Just(1.0f32)], n)
}

/// Of coordinates up to 64 a step of f32 is 4e-6; a sum of up to six products of three roundings each is
/// within twenty.
const ROUNDING: f32 = 20.0 * 4e-6;

proptest! {
    #[test]
    fn relative_shapes_blend_as_absolute_ones_do(seed in any::<u64>(), w in weights(0..6)) {
        let (mesh, absolute) = set(&mut Random(seed), w.len());
        let found = blended(&mesh, &w);
        for vertex in 0..VERTICES {
            // (1 − Σ w) S_b + Σ w S_i
            let rest: f64 = 1.0 - w.iter().copied().map(f64::from).sum::<f64>();
            let sum: DVec3 = absolute.iter().zip(&w).map(|(s, w)| f64::from(*w) * s[vertex].as_dvec3()).sum();
            let expected = rest * mesh.positions[vertex].as_dvec3() + sum;
            prop_assert!(found[vertex].as_dvec3().distance(expected) < f64::from(ROUNDING));
            prop_assert!((f64::from(base_weight(&w)) - rest).abs() <= rest.abs() * f64::from(f32::EPSILON));
        }
    }

    #[test]
    fn conversion_both_ways_is_exact_up_to_rounding(seed in any::<u64>()) {
        let (mesh, absolute) = set(&mut Random(seed), 3);
        for (shape, s) in mesh.shapes.iter().zip(&absolute) {
            let back = shape.absolute(&mesh.positions).unwrap();
            for (found, expected) in back.iter().zip(s) {
                // One rounding of a difference up to 6, one of a sum up to 18.
                prop_assert!((*found - *expected).abs().max_element() <= 0.5 * (4.8e-7 + 1.91e-6));
            }
            let again = Shape::from_absolute(shape.name.clone(), &mesh.positions, &back).unwrap();
            for (a, b) in again.positions.per_vertex().zip(shape.positions.per_vertex()) {
                prop_assert!((a - b).abs().max_element() <= 0.5 * (4.8e-7 + 1.91e-6));
            }
        }
    }

    /// The map is as steep as its formula at most: no jump where the sum passes 1, 0, or anything else.
    #[test]
    fn normalised_weights_never_jump(w in weights(1..6), step in prop::collection::vec(-1e-4..1e-4f32, 5), at in prop_oneof![Just(0.0f32), Just(1.0f32), -2.0..4.0f32]) {
        let mut before = w;
        // The last brings the sum to where it is to be looked at, and the steps go through it.
        let sum: f32 = before[1..].iter().sum();
        before[0] = at - sum;
        let after: Vec<f32> = before.iter().zip(&step).map(|(w, s)| w + s).collect();
        let (a, b) = (normalised(&before), normalised(&after));
        let taken: f32 = before.iter().zip(&after).map(|(a, b)| (a - b).abs()).sum();
        for (i, (a, b)) in a.iter().zip(&b).enumerate() {
            prop_assert!(a.is_finite() && b.is_finite());
            // d(w/S) = dw/S − w·dS/S², S ≥ 1, and a few roundings.
            let steepest = taken * (1.0 + before[i].abs() + taken) + 4.0 * f32::EPSILON * (before[i].abs() + 1.0);
            prop_assert!((a - b).abs() <= steepest, "{before:?} to {after:?}: {a} to {b}");
        }
    }

    #[test]
    fn weights_that_sum_to_one_or_less_stay_and_others_sum_to_one(w in weights(1..6)) {
        let sum: f64 = w.iter().copied().map(f64::from).sum();
        let n = normalised(&w);
        if sum <= 1.0 {
            prop_assert_eq!(n, w);
        } else {
            let total: f64 = n.iter().copied().map(f64::from).sum();
            let largest = n.iter().fold(1.0f32, |m, x| m.max(x.abs()));
            prop_assert!((total - 1.0).abs() <= f64::from(largest * f32::EPSILON) * n.len() as f64);
        }
    }

    #[test]
    fn shapes_at_full_weight_average(seed in any::<u64>(), shapes in 1..6usize) {
        let (mesh, absolute) = set(&mut Random(seed), shapes);
        let found = blended(&mesh, &normalised(&vec![1.0; shapes]));
        for vertex in 0..VERTICES {
            let sum: DVec3 = absolute.iter().map(|s| s[vertex].as_dvec3()).sum();
            prop_assert!(found[vertex].as_dvec3().distance(sum / shapes as f64) < f64::from(ROUNDING));
        }
    }

    #[test]
    fn half_and_half_is_the_average_and_a_third_at_zero_changes_no_bit(seed in any::<u64>()) {
        let (mesh, absolute) = set(&mut Random(seed), 3);
        let found = blended(&mesh, &normalised(&[0.5, 0.5, 0.0]));
        for vertex in 0..VERTICES {
            let average = (absolute[0][vertex] + absolute[1][vertex]) * 0.5;
            prop_assert!(found[vertex].distance(average) < ROUNDING);
        }
        let two = Mesh { shapes: mesh.shapes[..2].to_vec(), ..mesh.clone() };
        prop_assert_eq!(found, blended(&two, &[0.5, 0.5]));
        for w in [[0.3, -0.4, 0.0], [2.0, 0.5, -0.0]] {
            prop_assert_eq!(&normalised(&w)[..2], &normalised(&w[..2])[..]);
            prop_assert_eq!(blended(&mesh, &w), blended(&two, &w[..2]));
        }
    }

    #[test]
    fn weights_beyond_the_range_extrapolate(seed in any::<u64>(), w in -3.0..4.0f32) {
        let (mesh, absolute) = set(&mut Random(seed), 1);
        for (vertex, found) in blended(&mesh, &[w]).into_iter().enumerate() {
            let (base, shape) = (mesh.positions[vertex].as_dvec3(), absolute[0][vertex].as_dvec3());
            prop_assert!(found.as_dvec3().distance(base.lerp(shape, w.into())) < f64::from(ROUNDING));
        }
    }
}

#[test]
fn two_shapes_at_full_weight_are_not_half_of_the_first_and_all_of_the_second() {
    assert_eq!(normalised(&[1.0, 1.0]), [0.5, 0.5]);
    assert_eq!(normalised(&[1.0, 3.0]), [0.25, 0.75]);
    assert_eq!(normalised(&[2.0, -1.5]), [2.0, -1.5]);
    // Nothing is divided by 0, and sums beyond f32 are sums.
    assert_eq!(normalised(&[1.0, -1.0]), [1.0, -1.0]);
    assert_eq!(normalised(&[]), [] as [f32; 0]);
    assert_eq!(normalised(&[f32::MAX; 4]), [0.25; 4]);
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let left = normalised(&[odd, 3.0]);
        assert_eq!((left[0].to_bits(), left[1]), (odd.to_bits(), 3.0));
    }
}

#[test]
fn clamping_is_against_extrapolation() {
    let clamped = |least, most| {
        let mut w = [-0.5, 0.25, 1.5, f32::INFINITY, f32::NAN];
        clamp(&mut w, least, most);
        w
    };
    assert_eq!(clamped(0.0, 1.0)[..4], [0.0, 0.25, 1.0, 1.0]);
    assert!((0.0..=1.0).contains(&clamped(0.0, 1.0)[4]));
    assert_eq!(clamped(2.0, -2.0), [2.0; 5]);
    assert_eq!(clamped(-1.0, f32::INFINITY)[..4], [-0.5, 0.25, 1.5, f32::INFINITY]);
}

#[test]
fn another_number_of_vertices_is_an_error_with_the_shape_and_both_counts() {
    let error = Shape::from_absolute("grin", &[Vec3::ZERO; 4], &[Vec3::X; 3]).unwrap_err();
    assert_eq!(error, VertexCountError { shape: "grin".to_owned(), expected: 4, found: 3 });
    assert_eq!(error.to_string(), "shape \"grin\": expected 4 vertices, found 3");
    let endless = Shape::new("far", Offsets::from_pairs(usize::MAX, [(3, Vec3::X)]).unwrap());
    let error = endless.absolute(&[Vec3::ZERO; 4]).unwrap_err();
    assert_eq!((error.expected, error.found), (4, usize::MAX));
}

#[test]
fn what_does_not_move_is_not_stored() {
    let base: Vec<Vec3> = (0..20).map(|i| Vec3::splat(i as f32 * 0.3)).collect();
    let mut moved = base.clone();
    moved[11] += Vec3::Y;
    let shape = Shape::from_absolute("one", &base, &moved).unwrap();
    assert_eq!(shape.positions.iter().map(|(vertex, _)| vertex).collect::<Vec<_>>(), [11]);
    assert!(shape.positions.is_sparse());
}
