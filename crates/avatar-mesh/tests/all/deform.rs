//! Deformation against the formulas of the crate documentation written out in f64, and the facts that follow
//! from them.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::{DeformError, Deformed, Mesh, Offsets, Shape, Skinning, deform};
use glam::{Affine3A, Quat, Vec3};
use proptest::prelude::*;

type V = [f64; 3];

fn wide(v: Vec3) -> V {
    v.to_array().map(f64::from)
}

/// `M · (v, w)` with rows read out of the matrix one by one.
fn apply(m: &Affine3A, v: V, w: f64) -> V {
    let (columns, t) = (m.matrix3.to_cols_array_2d(), m.translation.to_array());
    std::array::from_fn(|r| {
        (0..3).map(|c| f64::from(columns[c][r]) * v[c]).sum::<f64>() + w * f64::from(t[r])
    })
}

/// One vertex: `Σ_i w_i · X_i · (v + Σ_k b_k · d_k)`, for normals without translation and made a unit vector.
fn naive(mesh: &Mesh, bones: &[Affine3A], weights: &[f32], vertex: usize) -> (V, V) {
    let blend = |base: Vec3, offsets: &dyn Fn(&Shape) -> Vec3| -> V {
        let mut sum = wide(base);
        for (shape, &b) in mesh.shapes.iter().zip(weights) {
            (0..3).for_each(|k| sum[k] += f64::from(b) * wide(offsets(shape))[k]);
        }
        sum
    };
    let v = blend(mesh.positions[vertex], &|shape| shape.positions.get(vertex).unwrap());
    let n = blend(mesh.normals[vertex], &|shape| shape.normals.as_ref().unwrap().get(vertex).unwrap());
    let mut influences = vec![(0, 1.0)];
    if let Some(skinning) = &mesh.skinning {
        influences = skinning.bones[vertex].into_iter().zip(skinning.weights[vertex]).collect();
        for (bones, weights) in skinning.more_bones.iter().zip(&skinning.more_weights).skip(vertex).take(1) {
            influences.extend(bones.iter().copied().zip(weights.iter().copied()));
        }
    }
    let (mut position, mut normal) = ([0.0; 3], [0.0; 3]);
    for (bone, w) in influences {
        let x = &bones[usize::from(bone)];
        let (p, m) = (apply(x, v, 1.0), apply(x, n, 0.0));
        (0..3).for_each(|k| position[k] += f64::from(w) * p[k]);
        (0..3).for_each(|k| normal[k] += f64::from(w) * m[k]);
    }
    (position, normal)
}

fn length(v: V) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn distance(a: Vec3, b: V) -> f64 {
    let a = wide(a);
    length(std::array::from_fn(|k| a[k] - b[k]))
}

fn deformed(mesh: &Mesh, bones: &[Affine3A], weights: &[f32]) -> Deformed {
    let mut out = mesh.deformed();
    deform(mesh, bones, weights, &mut out).unwrap();
    out
}

proptest! {
    #[test]
    fn random_meshes_agree_with_the_formulas_in_f64(
        seed in any::<u64>(), vertices in 1..60usize, bones in 1..12usize, skinned in any::<bool>(),
        weights in prop::collection::vec(prop_oneof![-1.5..2.5f32, Just(0.0f32)], 0..5),
    ) {
        let mut random = Random(seed);
        let mut mesh = random.mesh(vertices, weights.len(), bones);
        if !skinned {
            mesh.skinning = None;
        } else if seed % 2 == 0 {
            random.add_further_bones(&mut mesh, bones);
        }
        let palette: Vec<Affine3A> = (0..bones).map(|_| random.rigid()).collect();
        let out = deformed(&mesh, &palette, &weights);
        for vertex in 0..vertices {
            let (position, normal) = naive(&mesh, &palette, &weights, vertex);
            // Coordinates reach some 50 here, where f32 has steps of 4e-6; some of them add up.
            prop_assert!(distance(out.positions[vertex], position) < 5e-5);
            let l = length(normal);
            prop_assert!((out.normals[vertex].length() - 1.0).abs() < 1e-6);
            // A sum that nearly cancels has no precise direction.
            if l > 0.01 {
                prop_assert!(distance(out.normals[vertex], normal.map(|x| x / l)) < 5e-6 / l);
            }
        }
    }

    #[test]
    fn a_shape_of_weight_zero_changes_no_bit(seed in any::<u64>(), b in -1.0..2.0f32) {
        let mut random = Random(seed);
        let mesh = random.mesh(20, 3, 4);
        let palette: Vec<Affine3A> = (0..4).map(|_| random.rigid()).collect();
        let without = Mesh { shapes: vec![mesh.shapes[1].clone()], ..mesh.clone() };
        prop_assert_eq!(deformed(&mesh, &palette, &[0.0, b, -0.0]), deformed(&without, &palette, &[b]));
    }

    #[test]
    fn positions_are_linear_in_each_weight(seed in any::<u64>(), s in -1.0..2.0f32) {
        let mut random = Random(seed);
        let mesh = random.mesh(20, 2, 4);
        let palette: Vec<Affine3A> = (0..4).map(|_| random.rigid()).collect();
        let at = |a: f32, b: f32| deformed(&mesh, &palette, &[a, b]).positions;
        let (none, first, both) = (at(0.0, 0.5), at(1.0, 0.5), at(s, 0.5));
        let (second, third) = (at(0.0, 1.5), at(1.0, 1.5));
        for i in 0..20 {
            // f(s) = f(0) + s (f(1) − f(0)), below 0 and above 1 as well.
            prop_assert!((none[i] + s * (first[i] - none[i])).distance(both[i]) < 5e-5);
            // And the two shapes add up: each moves the vertex the same, whatever the other does.
            prop_assert!((first[i] - none[i]).distance(third[i] - second[i]) < 5e-5);
        }
    }

    #[test]
    fn one_motion_of_all_bones_moves_the_mesh_as_a_whole(seed in any::<u64>()) {
        let mut random = Random(seed);
        let mesh = random.mesh(30, 0, 3);
        let motion = random.rigid();
        let out = deformed(&mesh, &[motion; 3], &[]);
        for i in 0..30 {
            prop_assert!(out.positions[i].distance(motion.transform_point3(mesh.positions[i])) < 2e-5);
            prop_assert!(out.normals[i].distance(motion.transform_vector3(mesh.normals[i])) < 1e-6);
        }
        let still = deformed(&mesh, &[Affine3A::IDENTITY; 3], &[]);
        // Weights in eighths that sum to 1: at rest rounding may cost a step of f32, no more.
        for i in 0..30 {
            prop_assert!(still.positions[i].distance(mesh.positions[i]) < 4e-6);
        }
    }

    /// Sixteen vertices are computed at once; meshes of less than that are computed one by one.
    #[test]
    fn vertices_side_by_side_are_the_same_bits_as_alone(
        seed in any::<u64>(), vertices in 1..70usize, bones in 1..5usize, short in 0..100usize,
    ) {
        let mut random = Random(seed);
        let mut mesh = random.mesh(vertices, 2, bones);
        let skinning = mesh.skinning.as_mut().unwrap();
        // The vertices of some blocks follow one bone.
        let from = random.below(vertices);
        skinning.weights[from..].fill([1.0, 0.0, 0.0, 0.0]);
        skinning.bones[from..].fill([random.below(bones) as u16; 4]);
        // A normal that the shape takes away, and one that bones take away.
        if let Some(normal) = mesh.normals.get_mut(short) {
            *normal = -0.5 * mesh.shapes[0].normals.as_ref().unwrap().get(short).unwrap();
        }
        let mut palette: Vec<Affine3A> = (0..bones).map(|_| random.rigid()).collect();
        palette[0].matrix3 *= [0.0, 1.0][random.below(2)];
        let whole = deformed(&mesh, &palette, &[0.5, 0.0]);
        for vertex in 0..vertices {
            let mut single = Mesh {
                positions: vec![mesh.positions[vertex]],
                normals: vec![mesh.normals[vertex]],
                skinning: mesh.skinning.clone(),
                ..Mesh::default()
            };
            let skinning = single.skinning.as_mut().unwrap();
            skinning.bones = vec![skinning.bones[vertex]];
            skinning.weights = vec![skinning.weights[vertex]];
            single.shapes = mesh.shapes.iter().map(|shape| {
                let offset = |offsets: &Offsets| vec![offsets.get(vertex).unwrap()];
                Shape::new("s", offset(&shape.positions)).with_normals(offset(shape.normals.as_ref().unwrap()))
            }).collect();
            let single = deformed(&single, &palette, &[0.5, 0.0]);
            let bits = |v: Vec3| v.to_array().map(f32::to_bits);
            prop_assert_eq!(bits(whole.positions[vertex]), bits(single.positions[0]));
            prop_assert_eq!(bits(whole.normals[vertex]), bits(single.normals[0]));
        }
    }

    #[test]
    fn the_output_depends_on_nothing_that_was_in_it(seed in any::<u64>()) {
        let mut random = Random(seed);
        let mesh = random.mesh(10, 2, 3);
        let palette: Vec<Affine3A> = (0..3).map(|_| random.rigid()).collect();
        let mut out = Deformed { positions: vec![Vec3::NAN; 10], normals: vec![Vec3::INFINITY; 10], tangents: vec![] };
        let room = (out.positions.as_ptr(), out.normals.as_ptr());
        deform(&mesh, &palette, &[0.3, 0.9], &mut out).unwrap();
        prop_assert_eq!(room, (out.positions.as_ptr(), out.normals.as_ptr()));
        prop_assert_eq!(out, deformed(&mesh, &palette, &[0.3, 0.9]));
    }
}

/// A vertex at x = 1 whose normal +y is cancelled by the shape at weight 1.
fn cancelled(skinning: Option<Skinning>) -> Mesh {
    Mesh {
        positions: vec![Vec3::X],
        uvs: vec![glam::Vec2::ZERO],
        normals: vec![Vec3::Y],
        triangles: vec![],
        skinning,
        shapes: vec![Shape::new("s", vec![Vec3::ZERO]).with_normals(vec![Vec3::NEG_Y])],
        ..Mesh::default()
    }
}

#[test]
fn a_blended_normal_without_length_gives_way_to_the_undeformed_one() {
    let quarter = Affine3A::from_quat(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2));
    let skinning = Skinning { bones: vec![[0; 4]], weights: vec![[1., 0., 0., 0.]], ..Skinning::default() };
    for mesh in [cancelled(None), cancelled(Some(skinning))] {
        // The undeformed normal turns with its bone: +y to −x.
        for weight in [0.0, 0.5, 0.999, 1.0] {
            let out = deformed(&mesh, &[quarter], &[weight]);
            assert!(out.normals[0].distance(Vec3::NEG_X) < 1e-6, "{weight}: {}", out.normals[0]);
        }
        // Beyond the blend turns it over, and that is a direction again.
        assert!(deformed(&mesh, &[quarter], &[1.5]).normals[0].distance(Vec3::X) < 1e-6);
    }
    // Two bones that turn a normal against itself leave no direction either.
    let skinning =
        Skinning { bones: vec![[0, 1, 0, 0]], weights: vec![[0.5, 0.5, 0., 0.]], ..Skinning::default() };
    let half = Affine3A::from_mat3(glam::Mat3::from_diagonal(Vec3::new(-1., -1., 1.)));
    assert_eq!(deformed(&cancelled(Some(skinning)), &[Affine3A::IDENTITY, half], &[0.0]).normals[0], Vec3::Y);
    // A mesh whose own normal has no length yields no NaN.
    let flat = Mesh { normals: vec![Vec3::ZERO], ..cancelled(None) };
    assert_eq!(deformed(&flat, &[half], &[0.0]).normals[0], Vec3::ZERO);
}

#[test]
fn lengths_that_do_not_fit_are_errors() {
    let mut random = Random(5);
    let mesh = random.mesh(6, 2, 3);
    let palette = [Affine3A::IDENTITY; 3];
    let run = |mesh: &Mesh, bones: &[Affine3A], weights: &[f32]| {
        deform(
            mesh,
            bones,
            weights,
            &mut Deformed { positions: vec![Vec3::ZERO; 6], normals: vec![Vec3::ZERO; 6], tangents: vec![] },
        )
    };
    for found in [0, 1, 3] {
        let weights = vec![0.0; found];
        assert_eq!(run(&mesh, &palette, &weights), Err(DeformError::WeightCount { expected: 2, found }));
    }
    let mut missing = mesh.clone();
    missing.skinning.as_mut().unwrap().bones[4] = [0, 3, 0, 0];
    let error = run(&missing, &palette, &[0.0; 2]).unwrap_err();
    assert_eq!(error, DeformError::MissingBone { vertex: 4, found: 3, bones: 3 });
    assert_eq!(error.to_string(), "vertex 4: expected a bone below 3, found 3");
    let rigid = Mesh { skinning: None, shapes: vec![], ..mesh.clone() };
    assert_eq!(run(&rigid, &[], &[]), Err(DeformError::MissingBone { vertex: 0, found: 0, bones: 0 }));

    missing = mesh.clone();
    random.add_further_bones(&mut missing, 3);
    missing.skinning.as_mut().unwrap().more_bones[5] = [0, 1, 2, 9];
    let error = run(&missing, &palette, &[0.0; 2]).unwrap_err();
    assert_eq!(error, DeformError::MissingBone { vertex: 5, found: 9, bones: 3 });
    let mut shorter: [(&str, Mesh); 7] = std::array::from_fn(|_| ("", mesh.clone()));
    let skinning = |mesh: &mut Mesh, edit: &dyn Fn(&mut Skinning)| edit(mesh.skinning.as_mut().unwrap());
    shorter[0].0 = "the mesh's normals";
    shorter[0].1.normals.pop();
    shorter[1].0 = "a shape's positions";
    shorter[1].1.shapes[1].positions = vec![Vec3::X; 5].into();
    shorter[2].0 = "a shape's normals";
    shorter[2].1.shapes[0].normals = Some(vec![Vec3::X; 5].into());
    shorter[3].0 = "the bone indices";
    skinning(&mut shorter[3].1, &|s| s.bones.truncate(5));
    shorter[4].0 = "the bone weights";
    skinning(&mut shorter[4].1, &|s| s.weights.truncate(5));
    let short = [vec![[0; 4]; 5], vec![[0; 4]; 6]];
    shorter[5].0 = "the further bone indices";
    skinning(&mut shorter[5].1, &|s| s.more_bones.clone_from(&short[0]));
    shorter[6].0 = "the further bone weights";
    skinning(&mut shorter[6].1, &|s| {
        s.more_bones.clone_from(&short[1]);
        s.more_weights = vec![[0.0; 4]; 5];
    });
    for (what, mesh) in &shorter {
        let expected = DeformError::VertexCount { what, expected: 6, found: 5 };
        assert_eq!(run(mesh, &palette, &[0.0; 2]), Err(expected));
    }
    let mut out = mesh.deformed();
    out.positions.pop();
    let expected = DeformError::VertexCount { what: "the output's positions", expected: 6, found: 5 };
    assert_eq!(deform(&mesh, &palette, &[0.0; 2], &mut out), Err(expected));
    out = mesh.deformed();
    out.normals.push(Vec3::X);
    let expected = DeformError::VertexCount { what: "the output's normals", expected: 6, found: 7 };
    assert_eq!(deform(&mesh, &palette, &[0.0; 2], &mut out), Err(expected));
}
