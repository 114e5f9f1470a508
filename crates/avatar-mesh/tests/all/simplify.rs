use avatar_mesh::{Mesh, Shape, Simplifier, Skinning, deform, weld};
use glam::{Affine3A, Vec2, Vec3};
use proptest::prelude::*;
use std::collections::HashMap;

/// `side` × `side` squares in the plane, one unit wide each.
fn grid(side: u32) -> Mesh {
    let row = side + 1;
    let places = (0..row * row).map(|i| Vec2::new((i % row) as f32, (i / row) as f32));
    let squares = (0..side * side).map(|i| i / side * row + i % side);
    Mesh {
        positions: places.clone().map(|place| place.extend(0.0)).collect(),
        uvs: places.map(|place| place / side as f32).collect(),
        normals: vec![Vec3::Z; (row * row) as usize],
        triangles: squares.flat_map(|i| [[i, i + 1, i + row + 1], [i, i + row + 1, i + row]]).collect(),
        ..Mesh::default()
    }
}

/// A unit sphere without coordinates of textures, closed.
fn sphere(rings: u32, columns: u32) -> Mesh {
    let mut positions = vec![Vec3::Y];
    for ring in 1..rings {
        let (up, along) = (std::f32::consts::PI * ring as f32 / rings as f32).sin_cos();
        for column in 0..columns {
            let (sin, cos) = (std::f32::consts::TAU * column as f32 / columns as f32).sin_cos();
            positions.push(Vec3::new(up * sin, along, up * cos));
        }
    }
    positions.push(Vec3::NEG_Y);
    let last = positions.len() as u32 - 1;
    let at = |ring: u32, column: u32| 1 + (ring - 1) * columns + column % columns;
    let mut triangles = Vec::new();
    for column in 0..columns {
        triangles.push([0, at(1, column), at(1, column + 1)]);
        triangles.push([last, at(rings - 1, column + 1), at(rings - 1, column)]);
        for ring in 1..rings - 1 {
            let [a, b] = [at(ring, column), at(ring, column + 1)];
            let [c, d] = [at(ring + 1, column), at(ring + 1, column + 1)];
            triangles.extend([[a, c, d], [a, d, b]]);
        }
    }
    let uvs = vec![Vec2::ZERO; positions.len()];
    Mesh { normals: positions.clone(), positions, uvs, triangles, ..Mesh::default() }
}

/// Edges by their ends' places, with how many triangles have them.
fn edges(mesh: &Mesh) -> HashMap<[[u32; 3]; 2], usize> {
    let mut edges = HashMap::new();
    let place = |vertex: u32| mesh.positions[vertex as usize].to_array().map(|x| (x + 0.0).to_bits());
    for [a, b, c] in &mesh.triangles {
        for (start, end) in [(a, b), (b, c), (c, a)] {
            let mut edge = [place(*start), place(*end)];
            edge.sort_unstable();
            *edges.entry(edge).or_insert(0) += 1;
        }
    }
    edges
}

/// Length of the edges that only one triangle has.
fn border(mesh: &Mesh) -> f32 {
    let length = |[a, b]: &[[u32; 3]; 2]| {
        let [a, b] = [a, b].map(|place| Vec3::from_array(place.map(f32::from_bits)));
        a.distance(b)
    };
    edges(mesh).iter().filter(|(_, count)| **count == 1).map(|(edge, _)| length(edge)).sum()
}

fn area(mesh: &Mesh) -> f32 {
    let corners = mesh.triangles.iter().map(|t| t.map(|vertex| mesh.positions[vertex as usize]));
    corners.map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum()
}

fn simplified(mesh: &Mesh, posed: &[&[Vec3]], error: f32) -> avatar_mesh::Simplified {
    let mut simplifier = Simplifier::new(mesh, posed, &[]);
    simplifier.run(error);
    simplifier.simplified()
}

/// No place of the simplified surface lies deeper below the sphere than the error and what the original has.
#[test]
fn a_sphere_stays_closed_and_within_the_error() {
    let mesh = sphere(48, 96);
    for error in [0.01f32, 0.04] {
        let level = simplified(&mesh, &[], error);
        assert!(level.mesh.triangles.len() * 4 < mesh.triangles.len(), "{}", level.mesh.triangles.len());
        assert!(edges(&level.mesh).values().all(|count| *count == 2));
        // Euler: V − E + F = 2.
        let counts = [level.mesh.positions.len(), level.mesh.triangles.len(), edges(&level.mesh).len()];
        assert_eq!(counts[0] + counts[1], counts[2] + 2);
        for t in &level.mesh.triangles {
            let [a, b, c] = t.map(|vertex| level.mesh.positions[vertex as usize]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            assert!(normal.dot(a) > 0.0, "a triangle is turned over");
            let places = (0..=20).flat_map(|i| (0..=20 - i).map(move |j| [i as f32 / 20.0, j as f32 / 20.0]));
            let lengths = places.map(|[u, v]| (a + (b - a) * u + (c - a) * v).length());
            let depth = 1.0 - lengths.fold(1.0, f32::min);
            // The original's own faces lie up to 0.0011 deep, (π/96)², and its vertices 0.065 apart.
            assert!(depth < error + 0.0025, "{depth} of {error}");
        }
        assert!(level.error(&mesh.positions) <= error);
    }
}

#[test]
fn borders_keep_their_outline() {
    let mut mesh = grid(16);
    // A notch: the outline has concave corners.
    mesh.triangles.retain(|t| {
        let middle = t.iter().map(|v| mesh.positions[*v as usize]).sum::<Vec3>() / 3.0;
        !(middle.x > 6.0 && middle.x < 10.0 && middle.y > 8.0)
    });
    let level = simplified(&mesh, &[], 1e-3);
    assert!(level.mesh.triangles.len() * 8 < mesh.triangles.len(), "{}", level.mesh.triangles.len());
    assert!((border(&level.mesh) - border(&mesh)).abs() < 1e-3);
    assert!((area(&level.mesh) - area(&mesh)).abs() < 1e-2);
}

/// Two halves of one plane, whose textures lie apart: along the cut each place has two vertices.
#[test]
fn cuts_of_textures_do_not_open() {
    let mut mesh = grid(16);
    let count = mesh.positions.len() as u32;
    let right = Mesh { uvs: mesh.uvs.iter().map(|uv| *uv + 3.0).collect(), ..mesh.clone() };
    mesh.positions.extend(right.positions);
    mesh.normals.extend(right.normals);
    mesh.uvs.extend(right.uvs);
    for triangle in &mut mesh.triangles {
        if triangle.iter().any(|vertex| vertex % 17 > 8) {
            *triangle = triangle.map(|vertex| vertex + count);
        }
    }
    let mesh = weld(&mesh).mesh;
    let level = simplified(&mesh, &[], 1e-3);
    assert!(level.mesh.triangles.len() * 8 < mesh.triangles.len(), "{}", level.mesh.triangles.len());
    assert!((border(&level.mesh) - 64.0).abs() < 1e-3, "the cut has opened: {}", border(&level.mesh));
    assert!((area(&level.mesh) - 256.0).abs() < 1e-2);
    // Each side keeps its own texture, unstretched.
    for t in &level.mesh.triangles {
        for vertex in t.map(|vertex| vertex as usize) {
            let [place, uv] = [level.mesh.positions[vertex].truncate() / 16.0, level.mesh.uvs[vertex]];
            assert!(uv == place && place.x <= 0.5 || uv == place + 3.0 && place.x >= 0.5);
        }
    }
}

/// A bump in one pose alone keeps its vertices; without that pose the plate is flat and they go.
#[test]
fn what_moves_in_a_pose_stays() {
    let flat = grid(24);
    let bump = |place: &Vec3| {
        let away = place.distance(Vec3::new(12.0, 12.0, 0.0));
        *place + Vec3::Z * (6.0 - away).max(0.0)
    };
    let bumped: Vec<Vec3> = flat.positions.iter().map(bump).collect();
    let with = simplified(&flat, &[&flat.positions, &bumped], 0.2);
    let without = simplified(&flat, &[], 0.2);
    assert!(with.error(&bumped) <= 0.2, "{}", with.error(&bumped));
    assert!(without.error(&bumped) > 1.0, "{}", without.error(&bumped));
    assert!(with.mesh.triangles.len() > 2 * without.mesh.triangles.len());
    assert!(with.mesh.triangles.len() * 2 < flat.triangles.len());
}

#[test]
fn shapes_and_bones_are_carried_along() {
    let mut mesh = sphere(24, 48);
    let count = mesh.positions.len();
    mesh.skinning = Some(Skinning {
        bones: vec![[0, 1, 0, 0]; count],
        weights: mesh.positions.iter().map(|p| [0.5 + p.y / 2.0, 0.5 - p.y / 2.0, 0.0, 0.0]).collect(),
        ..Skinning::default()
    });
    mesh.shapes = vec![
        Shape::new("long", mesh.positions.iter().map(|p| Vec3::Y * p.y).collect::<Vec<_>>()),
        Shape::from_pairs("dent", count, [(5, Vec3::X), (600, Vec3::Z)]).expect("within the mesh"),
    ];
    let level = simplified(&mesh, &[], 0.05);
    assert!(level.mesh.clone().validate(2).is_ok());
    let bones = [Affine3A::from_rotation_z(0.3), Affine3A::from_translation(Vec3::X)];
    let pose = |mesh: &Mesh| {
        let mut posed = mesh.deformed();
        deform(mesh, &bones, &[0.7, 0.4], &mut posed).expect("a valid mesh");
        posed
    };
    let (whole, few) = (pose(&mesh), pose(&level.mesh));
    assert!(few.positions.len() * 4 < whole.positions.len());
    for (new, original) in level.originals.iter().enumerate() {
        assert_eq!(few.positions[new], whole.positions[*original as usize]);
        assert_eq!(few.normals[new], whole.normals[*original as usize]);
    }
}

#[test]
fn a_larger_error_goes_on_from_a_smaller_one() {
    let mesh = sphere(24, 48);
    let mut simplifier = Simplifier::new(&mesh, &[], &[]);
    simplifier.run(0.01);
    let finer = simplifier.simplified();
    simplifier.run(0.05);
    assert_eq!(simplifier.simplified(), simplified(&mesh, &[], 0.05));
    assert!(simplifier.simplified().mesh.triangles.len() < finer.mesh.triangles.len());
    assert!(simplifier.simplified().originals.iter().all(|vertex| finer.originals.contains(vertex)));
}

#[test]
fn careful_vertices_have_a_quarter_of_the_error() {
    let mesh = sphere(24, 48);
    let mut careful = Simplifier::new(&mesh, &[], &vec![true; mesh.positions.len()]);
    careful.run(0.04);
    assert!(careful.simplified().error(&mesh.positions) <= 0.01);
}

/// One place that is no number stays with what is around it, and the rest collapses all the same.
#[test]
fn a_place_that_is_no_number_stays_alone() {
    for bad in [f32::NAN, -f32::NAN, f32::INFINITY] {
        let mut mesh = grid(16);
        mesh.positions[8 * 17 + 8].x = bad;
        let level = simplified(&mesh, &[], 1e-3);
        assert!(level.originals.contains(&(8 * 17 + 8)), "{bad}");
        assert!(
            level.mesh.triangles.len() * 4 < mesh.triangles.len(),
            "{bad}: {}",
            level.mesh.triangles.len()
        );
    }
}

/// Halves of a mirrored mesh meet at places that differ by the sign of zero alone.
#[test]
fn zeros_of_both_signs_are_one_place() {
    let mut mesh = grid(16);
    let count = mesh.positions.len() as u32;
    let seam = |vertex: u32| vertex % 17 == 8;
    mesh.positions.iter_mut().for_each(|place| place.x -= 8.0);
    let mirrored = mesh.positions.iter().map(|place| glam::Vec3::new(-0.0, place.y, 0.0)).collect::<Vec<_>>();
    mesh.positions.extend(mirrored);
    mesh.normals.extend_from_within(..);
    mesh.uvs.extend_from_within(..);
    for triangle in &mut mesh.triangles {
        if triangle.iter().any(|vertex| vertex % 17 > 8) {
            *triangle = triangle.map(|vertex| if seam(vertex) { vertex + count } else { vertex });
        }
    }
    let level = simplified(&mesh, &[], 1e-3);
    // The same places on both sides, so that nothing gapes.
    let at_seam = |sign: bool| {
        let mut ends: Vec<u32> = level
            .mesh
            .triangles
            .iter()
            .flatten()
            .map(|vertex| level.mesh.positions[*vertex as usize])
            .filter(|place| place.x == 0.0 && place.x.is_sign_negative() == sign)
            .map(|place| place.y.to_bits())
            .collect();
        ends.sort_unstable();
        ends.dedup();
        ends
    };
    assert!(!at_seam(true).is_empty());
    assert_eq!(at_seam(true), at_seam(false));
}

/// The second set of texture coordinates counts in lengths of its own, even where the first is empty.
#[test]
fn second_texture_coordinates_keep_their_places() {
    let mut mesh = grid(16);
    // Bent in the middle, and a thousandth as large.
    mesh.uvs_1 = mesh.positions.iter().map(|p| Vec2::new(p.x + (p.x - 8.0).max(0.0), p.y) * 1e-3).collect();
    mesh.uvs = vec![Vec2::ZERO; mesh.positions.len()];
    let level = simplified(&mesh, &[], 0.1);
    let bend = level.mesh.positions.iter().filter(|place| (place.x - 8.0).abs() < 0.1).count();
    assert!(bend >= 2, "the bend has {bend} vertices");
    assert!(level.mesh.triangles.len() * 4 < mesh.triangles.len(), "{}", level.mesh.triangles.len());
    mesh.uvs_1 = Vec::new();
    assert!(simplified(&mesh, &[], 0.1).mesh.triangles.len() < level.mesh.triangles.len());
}

/// A fan of very many triangles takes time in proportion to their number, about.
#[test]
fn a_large_fan_takes_bounded_time() {
    const BLADES: u32 = 200_000;
    let around = (0..BLADES).map(|i| (std::f32::consts::TAU * i as f32 / BLADES as f32).sin_cos());
    let positions: Vec<Vec3> =
        std::iter::once(Vec3::ZERO).chain(around.map(|(y, x)| Vec3::new(x, y, 0.0))).collect();
    let mesh = Mesh {
        normals: vec![Vec3::Z; positions.len()],
        uvs: positions.iter().map(|place| place.truncate()).collect(),
        triangles: (0..BLADES).map(|i| [0, 1 + i, 1 + (i + 1) % BLADES]).collect(),
        positions,
        ..Mesh::default()
    };
    // By squares of the number it would take hours.
    assert!(simplified(&mesh, &[], 0.01).mesh.triangles.len() <= mesh.triangles.len());
}

proptest! {
    /// Any triangles over any numbers: no panic, no index that leads nowhere, and it ends.
    #[test]
    fn anything_is_survived(
        positions in prop::collection::vec(prop::array::uniform3(prop_oneof![
            Just(0.0f32), Just(1.0), Just(f32::NAN), Just(f32::MAX), -2.0f32..2.0
        ]), 0..24),
        triangles in prop::collection::vec(prop::array::uniform3(0u32..26), 0..60),
        error in prop_oneof![Just(0.0f32), Just(1.0), Just(f32::INFINITY), Just(f32::NAN)],
    ) {
        let positions: Vec<Vec3> = positions.into_iter().map(Vec3::from_array).collect();
        let uvs = positions.iter().map(|place| place.truncate()).collect();
        let mesh = Mesh { normals: positions.clone(), positions, uvs, triangles, ..Mesh::default() };
        let level = simplified(&mesh, &[&[Vec3::ONE]], error);
        prop_assert!(level.mesh.triangles.len() <= mesh.triangles.len());
        let count = level.mesh.positions.len();
        prop_assert!(level.mesh.triangles.as_flattened().iter().all(|vertex| (*vertex as usize) < count));
    }
}
