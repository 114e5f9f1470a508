//! Which geometries can be shapes of one mesh.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::coherence::{CoherenceError, FaceMatch, Faces, Geometry, Mismatch, check};
use glam::Vec3;
use proptest::prelude::*;

fn geometry<'a>(positions: &'a [Vec3], triangles: &'a [[u32; 3]]) -> Geometry<'a> {
    Geometry { file: "grin.obj", shape: "grin", positions, faces: Faces::Triangles(triangles) }
}

fn shuffled<T>(random: &mut Random, list: &mut [T]) {
    for i in (1..list.len()).rev() {
        list.swap(i, random.below(i + 1));
    }
}

/// A grid of 5 × 5 vertices. Reordering it makes other faces, unlike a single triangle.
fn grid() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let positions = (0..25).map(|i| Vec3::new((i % 5) as f32, (i / 5) as f32, 0.0)).collect();
    let quads = (0..20u32).filter(|i| i % 5 != 4);
    (positions, quads.flat_map(|a| [[a, a + 1, a + 6], [a, a + 6, a + 5]]).collect())
}

proptest! {
    #[test]
    fn faces_in_another_order_are_matched(seed in any::<u64>()) {
        let mut random = Random(seed);
        let (positions, mut triangles) = grid();
        // Some twice, one without area.
        triangles.extend([triangles[3], triangles[3], [4, 4, 2]]);
        let mut other = triangles.clone();
        shuffled(&mut random, &mut other);
        other.iter_mut().for_each(|t| t.rotate_left(random.below(3)));
        let expected = other != triangles;
        let found = check(geometry(&positions, &triangles), geometry(&positions, &other)).unwrap();
        prop_assert_eq!(found.is_warning(), expected);
        if let FaceMatch::Reordered { candidate_from_base, moved, rotated } = found {
            let mut seen = candidate_from_base.clone();
            seen.sort_unstable();
            prop_assert_eq!(seen, (0..triangles.len() as u32).collect::<Vec<_>>());
            let (mut away, mut turned) = (0, 0);
            for (i, (base, place)) in triangles.iter().zip(&candidate_from_base).enumerate() {
                let mut there = other[*place as usize];
                turned += usize::from(there != *base);
                away += usize::from(*place as usize != i);
                let turns = (0..3).any(|_| { there.rotate_left(1); there == *base });
                prop_assert!(turns);
            }
            prop_assert_eq!((moved, rotated), (away, turned));
        }
    }

    /// Faces of any size, against comparing every turn of every face with every other.
    #[test]
    fn polygons_that_begin_elsewhere_are_matched(seed in any::<u64>(), names in 1usize..5, count in 1usize..9) {
        let mut random = Random(seed);
        let faces: Vec<Vec<u32>> = (0..count)
            .map(|_| (0..=random.below(6)).map(|_| random.below(names) as u32).collect())
            .collect();
        let mut others = faces.clone();
        shuffled(&mut random, &mut others);
        for face in &mut others {
            let turn = random.below(face.len());
            face.rotate_left(turn);
        }
        let damaged = random.below(3) == 0;
        if damaged {
            let face = random.below(count);
            let corner = random.below(others[face].len());
            others[face][corner] = random.below(names + 1) as u32;
        }
        let turns = |face: &[u32]| {
            let turn = |k| { let mut face = face.to_vec(); face.rotate_left(k); face };
            (0..face.len()).map(turn).min()
        };
        let sorted = |faces: &[Vec<u32>]| {
            let mut all: Vec<_> = faces.iter().map(|face| turns(face)).collect();
            all.sort();
            all
        };
        let flat = |faces: &[Vec<u32>]| {
            let ends = faces.iter().scan(0, |end, face| { *end += face.len() as u32; Some(*end) });
            (faces.concat(), ends.collect::<Vec<u32>>())
        };
        let ((corners, ends), (other_corners, other_ends)) = (flat(&faces), flat(&others));
        let of = |corners, ends| Geometry { faces: Faces::Polygons { corners, ends }, ..geometry(&[], &[]) };
        match check(of(&corners, &ends), of(&other_corners, &other_ends)) {
            Ok(FaceMatch::Same) => prop_assert_eq!(&faces, &others),
            Ok(FaceMatch::Reordered { candidate_from_base, .. }) => {
                prop_assert_eq!(sorted(&faces), sorted(&others));
                for (face, place) in faces.iter().zip(candidate_from_base) {
                    prop_assert_eq!(turns(face), turns(&others[place as usize]));
                }
            }
            Err(_) => prop_assert!(damaged && sorted(&faces) != sorted(&others)),
        }
    }

    /// Whatever an exporter does to the numbers of vertices, faces tell.
    #[test]
    fn vertices_in_another_order_are_found(seed in any::<u64>(), shuffle_faces in any::<bool>()) {
        let mut random = Random(seed);
        let (positions, triangles) = grid();
        let mut new_of: Vec<u32> = (0..25).collect();
        shuffled(&mut random, &mut new_of);
        prop_assume!(new_of.iter().enumerate().any(|(old, new)| old as u32 != *new));
        let mut other: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| new_of[v as usize])).collect();
        if shuffle_faces {
            shuffled(&mut random, &mut other);
        }
        let found = check(geometry(&positions, &triangles), geometry(&positions, &other));
        match found.map_err(|CoherenceError { mismatch, .. }| mismatch) {
            Err(Mismatch::VertexOrder { vertices: 25, reordered, vertex, found }) if !shuffle_faces => {
                let wrong: Vec<usize> = (0..25).filter(|old| new_of[*old] != *old as u32).collect();
                prop_assert_eq!((reordered, vertex as usize, found), (wrong.len(), wrong[0], new_of[wrong[0]]));
            }
            Err(Mismatch::Faces { faces: 32, missing, face, corners }) if shuffle_faces => {
                prop_assert!(missing > 0);
                prop_assert_eq!(&triangles[face][..], &corners);
            }
            // A shuffle may by chance be one in which the faces' corners correspond.
            Err(Mismatch::VertexOrder { .. }) if shuffle_faces => {}
            other => prop_assert!(false, "{:?}", other),
        }
    }
}

#[test]
fn errors_name_the_file_the_shape_and_both_numbers() {
    let (positions, triangles) = grid();
    let base = geometry(&positions, &triangles);
    assert_eq!(check(base, geometry(&positions[..], &triangles)), Ok(FaceMatch::Same));
    let text = |positions: &[Vec3], triangles: &[[u32; 3]]| {
        check(base, geometry(positions, triangles)).unwrap_err().to_string()
    };
    assert_eq!(
        text(&positions[..24], &triangles),
        "grin.obj, shape \"grin\": expected 25 vertices, found 24"
    );
    assert_eq!(text(&positions, &triangles[1..]), "grin.obj, shape \"grin\": expected 32 faces, found 31");
    let mut turned = triangles.clone();
    turned[7].swap(0, 1);
    turned[9].swap(0, 1);
    let t = triangles[7];
    assert_eq!(
        text(&positions, &turned),
        format!(
            "grin.obj, shape \"grin\": expected the base's 32 faces, found none for 2 of them (first 7: {t:?})"
        )
    );
    let swapped: Vec<[u32; 3]> =
        triangles.iter().map(|t| t.map(|v| [3, 1, 2, 0].get(v as usize).copied().unwrap_or(v))).collect();
    assert_eq!(
        text(&positions, &swapped),
        "grin.obj, shape \"grin\": expected the base's order of vertices, found 2 of 25 in another place (first vertex 0 as 3)"
    );
    let mut rotated = triangles.clone();
    rotated[0].rotate_left(1);
    rotated.swap(4, 6);
    let warning = check(base, geometry(&positions, &rotated)).unwrap();
    assert_eq!(
        warning.to_string(),
        "expected faces in the base's order, found 2 of 32 elsewhere and 1 that begin at another corner"
    );
    // Indices beyond the vertices are nothing special here.
    let far = [[u32::MAX, 0, 9]];
    assert_eq!(check(geometry(&[], &far), geometry(&[], &far)), Ok(FaceMatch::Same));
    assert!(check(geometry(&[], &far), geometry(&[], &[[0, 9, u32::MAX]])).unwrap().is_warning());
}
