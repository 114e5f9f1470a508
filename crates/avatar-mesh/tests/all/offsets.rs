//! Shapes that store moved vertices only are those that store all; normals recomputed or left alone;
//! tangents.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{Random, edit_offset};
use avatar_mesh::{
    DeformError, Deformed, Mesh, Offsets, OffsetsError, Shape, ShapeNormals, SmoothNormals, blend, deform,
    deform_with,
};
use glam::{Affine3A, Quat, Vec2, Vec3, Vec3Swizzles, Vec4};
use proptest::prelude::*;

/// Offsets of which `moved` in ten are anything but 0.
fn some_offsets(random: &mut Random, vertices: usize, moved: usize) -> Vec<Vec3> {
    (0..vertices).map(|_| if random.below(10) < moved { random.vec3(2.0) } else { Vec3::ZERO }).collect()
}

fn bits(v: Vec3) -> [u32; 3] {
    v.to_array().map(f32::to_bits)
}

proptest! {
    #[test]
    fn all_ways_to_make_and_read_offsets_agree(seed in any::<u64>(), vertices in 0..80usize, moved in 0..=10usize) {
        let mut random = Random(seed);
        let mut all = some_offsets(&mut random, vertices, moved);
        // Nothing but +0 counts as rest: -0 and the rest of the bits come back.
        for (vertex, odd) in [(3, Vec3::new(0.0, -0.0, 0.0)), (5, Vec3::splat(f32::INFINITY))] {
            all.get_mut(vertex).into_iter().for_each(|d| *d = odd);
        }
        let offsets = Offsets::from_dense(all.clone());
        let mut pairs: Vec<(u32, Vec3)> = (0..).zip(all.iter().copied()).collect();
        // In any order.
        for i in (1..pairs.len()).rev() {
            pairs.swap(i, random.below(i + 1));
        }
        prop_assert_eq!(&Offsets::from_pairs(vertices, pairs).unwrap(), &offsets);
        prop_assert_eq!(&all.iter().copied().collect::<Offsets>(), &offsets);
        prop_assert_eq!(offsets.len(), vertices);
        prop_assert_eq!(offsets.per_vertex().map(bits).collect::<Vec<_>>(), all.iter().copied().map(bits).collect::<Vec<_>>());
        for (vertex, offset) in all.iter().enumerate() {
            prop_assert_eq!(bits(offsets.get(vertex).unwrap()), bits(*offset));
        }
        prop_assert_eq!(offsets.get(vertices), None);
        let still = |d: &Vec3| bits(*d) == [0; 3];
        let expected: Vec<(usize, Vec3)> = all.iter().copied().enumerate().filter(|(_, d)| !still(d)).collect();
        prop_assert_eq!(offsets.moved_vertices(), expected.len());
        prop_assert_eq!(offsets.iter().collect::<Vec<_>>(), expected.clone());
        // The smaller of the two.
        let (sparse, dense) = (16 * expected.len(), 12 * vertices);
        prop_assert_eq!(offsets.memory_bytes(), sparse.min(dense));
        prop_assert_eq!(offsets.is_sparse(), sparse < dense);
    }

    /// The same shape on a mesh that has more vertices, all moved, is stored whole there.
    #[test]
    fn sparse_and_dense_shapes_deform_to_the_same_bits(
        seed in any::<u64>(), vertices in 1..50usize, weights in prop::collection::vec(-1.5..2.5f32, 1..4), skinned in any::<bool>(),
    ) {
        let mut random = Random(seed);
        let mut mesh = random.mesh(4 * vertices, 0, 3);
        if !skinned {
            mesh.skinning = None;
        }
        mesh.tangents = (0..4 * vertices).map(|_| random.unit().extend(-1.0)).collect();
        let mut few = mesh.clone();
        few.positions.truncate(vertices);
        few.normals.truncate(vertices);
        few.tangents.truncate(vertices);
        few.skinning.iter_mut().for_each(|s| { s.bones.truncate(vertices); s.weights.truncate(vertices); });
        for k in 0..weights.len() {
            let arrays = [(); 3].map(|()| {
                let some = some_offsets(&mut random, vertices, 3);
                let more: Vec<Vec3> = some.iter().copied().chain(vec![Vec3::ONE; 3 * vertices]).collect();
                (Offsets::from_dense(some), Offsets::from_dense(more))
            });
            prop_assert!(arrays.iter().all(|(_, dense)| !dense.is_sparse()));
            let [(p, all_p), (n, all_n), (t, all_t)] = arrays;
            few.shapes.push(Shape::new(k.to_string(), p).with_normals(n).with_tangents(t));
            mesh.shapes.push(Shape::new(k.to_string(), all_p).with_normals(all_n).with_tangents(all_t));
        }
        let bones: Vec<Affine3A> = (0..3).map(|_| random.rigid()).collect();
        let (mut sparse, mut dense) = (few.deformed(), mesh.deformed());
        deform(&few, &bones, &weights, &mut sparse).unwrap();
        deform(&mesh, &bones, &weights, &mut dense).unwrap();
        prop_assert_eq!(&sparse.positions[..], &dense.positions[..vertices]);
        prop_assert_eq!(&sparse.normals[..], &dense.normals[..vertices]);
        prop_assert_eq!(&sparse.tangents[..], &dense.tangents[..vertices]);
        for (tangent, undeformed) in sparse.tangents.iter().zip(&few.tangents) {
            prop_assert!((tangent.truncate().length() - 1.0).abs() < 1e-6);
            prop_assert_eq!(tangent.w, undeformed.w);
        }
    }
}

#[test]
fn a_few_pairs_of_an_endless_mesh_take_no_room() {
    let pair = |vertex| (vertex, Vec3::X);
    let far = Shape::from_pairs("far", usize::MAX, [pair(u32::MAX), pair(7)]).unwrap();
    assert_eq!((far.moved_vertices(), far.memory_bytes()), (2, 32));
    assert_eq!(far.positions.get(u32::MAX as usize), Some(Vec3::X));
    assert_eq!(far.positions.get(usize::MAX - 1), Some(Vec3::ZERO));
    assert_eq!(far.positions.per_vertex().nth(7), Some(Vec3::X));
    let mut few = [Vec3::ZERO; 8];
    far.positions.add_scaled(2.0, &mut few);
    assert_eq!((few[7], few[6]), (Vec3::X * 2.0, Vec3::ZERO));
    let mut mesh = Mesh { shapes: vec![far], ..Random(1).mesh(4, 0, 1) };
    assert!(mesh.validate(1).is_err());
}

#[test]
fn pairs_name_each_vertex_once() {
    let pairs = |all: &[u32]| Offsets::from_pairs(5, all.iter().map(|v| (*v, Vec3::X)));
    assert_eq!(pairs(&[4, 5]), Err(OffsetsError::OutOfRange { pair: 1, vertices: 5, found: 5 }));
    let error = pairs(&[3, 0, 3]).unwrap_err();
    assert_eq!(error, OffsetsError::Repeated { pair: 2, vertex: 3 });
    assert_eq!(error.to_string(), "pair 2: expected each vertex once, found 3 again");
    assert_eq!(pairs(&[9]).unwrap_err().to_string(), "pair 0: expected a vertex below 5, found 9");
    assert_eq!(pairs(&[0, 1, 2, 3, 4]).unwrap(), vec![Vec3::X; 5].into());
    assert!(Offsets::from_pairs(0, []).unwrap().is_empty());
}

/// A cube of six quads with normals of their own: every edge is hard. The upper face is cut in two by a
/// texture seam.
fn cube() -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for side in [-1.0f32, 1.0] {
            let turn = |v: Vec3| [v, v.yzx(), v.zxy()][axis];
            let first = mesh.positions.len() as u32;
            for (y, z) in [(-1.0, -1.0), (side, -side), (1.0, 1.0), (-side, side)] {
                mesh.positions.push(turn(Vec3::new(side, y, z)));
                mesh.normals.push(turn(Vec3::X * side));
            }
            // Two of the corners once more: a seam along the diagonal.
            for corner in [0, 2] {
                mesh.positions.push(mesh.positions[first as usize + corner]);
                mesh.normals.push(mesh.normals[first as usize + corner]);
            }
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.triangles.push([first + 4, first + 5, first + 3]);
        }
    }
    mesh.uvs = vec![Vec2::ZERO; mesh.positions.len()];
    mesh
}

fn moved(mesh: &Mesh, name: &str, to: impl Fn(Vec3) -> Vec3) -> Shape {
    Shape::new(name, mesh.positions.iter().map(|p| to(*p) - *p).collect::<Offsets>())
}

fn run(mesh: &Mesh, weights: &[f32], normals: ShapeNormals<'_>) -> Deformed {
    let mut out = mesh.deformed();
    deform_with(mesh, &[Affine3A::IDENTITY], weights, normals, &mut out).unwrap();
    out
}

#[test]
fn recomputed_normals_follow_the_faces_and_edges_stay_hard() {
    let mut mesh = cube();
    let turn = Quat::from_axis_angle(Vec3::new(0.6, 0.8, 0.0), 0.7);
    mesh.shapes = vec![moved(&mesh, "turn", |p| turn * p), moved(&mesh, "lean", |p| p + 0.5 * p.y * Vec3::X)];
    let mut smooth = SmoothNormals::new(&mesh);
    let turned = run(&mesh, &[1.0, 0.0], ShapeNormals::Recomputed(&mut smooth));
    for (normal, authored) in turned.normals.iter().zip(&mesh.normals) {
        assert!(normal.distance(turn * *authored) < 1e-6, "{normal}");
    }
    // A shear by x += y/2: faces along x lean by atan(1/2), the others stay.
    let leaning = run(&mesh, &[0.0, 1.0], ShapeNormals::Recomputed(&mut smooth));
    for (normal, authored) in leaning.normals.iter().zip(&mesh.normals) {
        let expected = (*authored - 0.5 * authored.x * Vec3::Y).normalize_or_zero();
        assert!(normal.distance(expected) < 1e-6, "{authored}: {normal}");
    }
    // Both at half weight: one plane per face, whatever the blend is.
    let both = run(&mesh, &[0.5, 0.5], ShapeNormals::Recomputed(&mut smooth));
    for (face, of_face) in both.normals.chunks(6).enumerate() {
        let p = &both.positions[6 * face..];
        let expected = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        assert!(of_face.iter().all(|n| n.distance(expected) < 2e-6), "{face}: {of_face:?} {expected}");
    }
    // Unblended: as authored. Given, but nothing is: the same.
    assert_eq!(run(&mesh, &[1.0, 1.0], ShapeNormals::Unblended).normals, mesh.normals);
    assert_eq!(run(&mesh, &[1.0, 1.0], ShapeNormals::Given).normals, mesh.normals);
    // At rest not a bit changes.
    assert_eq!(run(&mesh, &[0.0, 0.0], ShapeNormals::Recomputed(&mut smooth)).normals, mesh.normals);
    // Triangles that run the other way do not turn the change around.
    let mut inside_out = mesh.clone();
    inside_out.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let mut smooth = SmoothNormals::new(&inside_out);
    assert_eq!(run(&inside_out, &[1.0, 0.0], ShapeNormals::Recomputed(&mut smooth)), turned);
}

/// However faces are cut into triangles: only weighting by angles makes the corners of a cube point outward
/// evenly.
#[test]
fn corners_of_a_smooth_cube_point_outward_evenly() {
    let sharp = cube();
    let corners: Vec<Vec3> =
        (0..8).map(|k| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) * 2.0 - 1.0).collect();
    let corner_of = |v: u32| corners.iter().position(|c| *c == sharp.positions[v as usize]).unwrap() as u32;
    let mut mesh = Mesh {
        uvs: vec![Vec2::ZERO; 8],
        normals: corners.iter().map(|c| c.normalize_or_zero()).collect(),
        triangles: sharp.triangles.iter().map(|t| t.map(corner_of)).collect(),
        positions: corners.clone(),
        ..Mesh::default()
    };
    let turn = Quat::from_axis_angle(Vec3::new(0.6, 0.8, 0.0), 0.7);
    mesh.shapes = vec![moved(&mesh, "turn", |p| turn * p)];
    let out = run(&mesh, &[1.0], ShapeNormals::Recomputed(&mut SmoothNormals::new(&mesh)));
    for (normal, authored) in out.normals.iter().zip(&mesh.normals) {
        assert!(normal.distance(turn * *authored) < 1e-6, "{authored}: {normal}");
    }
}

#[test]
fn offsets_of_recomputed_normals_are_exact_at_full_weight() {
    let mut mesh = cube();
    let turn = Quat::from_rotation_z(0.3);
    let up = Shape::from_pairs("up", mesh.positions.len(), [(0, Vec3::Y)])
        .unwrap()
        .with_normals(vec![Vec3::X; 36]);
    mesh.shapes = vec![moved(&mesh, "turn", |p| turn * p), up.clone()];
    mesh.add_shape_normals();
    // What was given stays.
    assert_eq!(mesh.shapes[1], up);
    let given = run(&mesh, &[1.0, 0.0], ShapeNormals::Given);
    let recomputed = run(&mesh, &[1.0, 0.0], ShapeNormals::Recomputed(&mut SmoothNormals::new(&mesh)));
    assert_eq!(given.normals, recomputed.normals);
    assert!(given.normals[0].distance(turn * mesh.normals[0]) < 1e-6);
    // Unblended means also those that are given.
    assert_eq!(run(&mesh, &[1.0, 0.0], ShapeNormals::Unblended).normals, mesh.normals);
}

#[test]
fn both_sides_of_a_texture_seam_get_one_normal() {
    // A dome of rings around +y, whose first and last column are one line in space.
    let mut mesh = Mesh::default();
    for ring in 1..6 {
        for column in 0..=16 {
            let (yaw, polar) = (std::f32::consts::TAU * (column % 16) as f32 / 16.0, 0.3 * ring as f32);
            let normal = Vec3::new(polar.sin() * yaw.sin(), polar.cos(), polar.sin() * yaw.cos());
            mesh.positions.push(normal * 3.0);
            mesh.normals.push(normal);
        }
    }
    for ring in 0..4 {
        for column in 0..16 {
            let a = ring * 17 + column;
            mesh.triangles.extend([[a, a + 17, a + 1], [a + 1, a + 17, a + 18]]);
        }
    }
    mesh.uvs = vec![Vec2::ZERO; mesh.positions.len()];
    mesh.shapes =
        vec![moved(&mesh, "dent", |p| p * (1.0 - 0.3 * (-(p - Vec3::Z * 3.0).length_squared()).exp()))];
    let out = run(&mesh, &[1.0], ShapeNormals::Recomputed(&mut SmoothNormals::new(&mesh)));
    let mut changed = 0;
    for ring in 0..5 {
        let (first, last) = (ring * 17, ring * 17 + 16);
        assert_eq!(out.normals[first], out.normals[last]);
        changed += usize::from(out.normals[first].distance(mesh.normals[first]) > 0.02);
    }
    assert!(changed > 1, "the dent turns normals at the seam");
    // Normals of the two sides that differ by a degree, as files have them, change by the same.
    let tilt = Quat::from_rotation_x(1f32.to_radians());
    (0..5).for_each(|ring| mesh.normals[ring * 17] = tilt * mesh.normals[ring * 17]);
    let mut change = vec![Vec3::ZERO; mesh.positions.len()];
    SmoothNormals::new(&mesh).add_change(&out.positions, &mut change);
    for ring in 0..5 {
        assert_eq!(change[ring * 17], change[ring * 17 + 16]);
    }
}

#[test]
fn nothing_that_is_broken_makes_nan_of_recomputed_normals() {
    let mut mesh = cube();
    mesh.positions[3] = Vec3::splat(f32::MAX);
    mesh.positions[9] = Vec3::NAN;
    mesh.triangles.extend([[0, 0, 0], [0, 1, 9999], [u32::MAX; 3]]);
    let flat = vec![Vec3::splat(-1.0); mesh.positions.len()];
    mesh.shapes = vec![Shape::new("collapse", flat)];
    let mut smooth = SmoothNormals::new(&mesh);
    let out = run(&mesh, &[1.0], ShapeNormals::Recomputed(&mut smooth));
    assert!(out.normals.iter().all(|n| n.is_finite()), "{:?}", out.normals);
    // All vertices in one place: no face has a direction, and the authored normals stay.
    let mut point = cube();
    point.shapes = vec![moved(&point, "collapse", |_| Vec3::ZERO)];
    let out = run(&point, &[1.0], ShapeNormals::Recomputed(&mut SmoothNormals::new(&point)));
    assert_eq!(out.normals, point.normals);
    // Of another mesh.
    let mut of_point = SmoothNormals::new(&Mesh::default());
    let error = blend(&point, &[1.0], ShapeNormals::Recomputed(&mut of_point), &mut point.deformed());
    let what = "the normals to be recomputed";
    assert_eq!(error, Err(DeformError::VertexCount { what, expected: 36, found: 0 }));
}

#[test]
fn tangents_follow_shapes_and_bones() {
    let mut mesh = cube();
    let vertices = mesh.positions.len();
    mesh.tangents = vec![Vec4::new(0.0, 0.0, 1.0, -1.0); vertices];
    mesh.shapes = vec![Shape::new("s", vec![Vec3::ZERO; vertices]).with_tangents(vec![Vec3::Y; vertices])];
    edit_offset(mesh.shapes[0].tangents.as_mut().unwrap(), 7, |d| *d = Vec3::NEG_Z);
    assert_eq!(mesh.clone().validate(1).unwrap(), []);
    let quarter = Affine3A::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let mut out = mesh.deformed();
    deform(&mesh, &[quarter], &[1.0], &mut out).unwrap();
    // (0, 1, 1) / √2 turned about x; where the shape cancels the tangent, the undeformed one turns.
    let half = 0.5f32.sqrt();
    assert!((out.tangents[0] - Vec4::new(0.0, -half, half, -1.0)).length() < 1e-6, "{}", out.tangents[0]);
    assert!((out.tangents[7] - Vec4::new(0.0, -1.0, 0.0, -1.0)).length() < 1e-6, "{}", out.tangents[7]);
    out.tangents.pop();
    let short = DeformError::VertexCount { what: "the output's tangents", expected: 36, found: 35 };
    assert_eq!(deform(&mesh, &[quarter], &[1.0], &mut out), Err(short));
    let mut bad = mesh.clone();
    bad.shapes[0].tangents = Some(vec![Vec3::X; 3].into());
    let short = DeformError::VertexCount { what: "a shape's tangents", expected: 36, found: 3 };
    assert_eq!(deform(&bad, &[quarter], &[1.0], &mut mesh.deformed()), Err(short));
}
