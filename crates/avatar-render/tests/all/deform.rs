//! The GPU deforms as the CPU does.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::{Random, gpu, random_mesh};
use avatar_mesh::{Mesh, Offsets, PartKind, Shape, deform};
use avatar_render::{
    AvatarModel, AvatarState, Deformer, DeformerError, PartBones, PartDesc, PartTextures, StateError,
};
use glam::{Affine3A, Vec3};

/// Coordinates are up to about 20; a fifth of what the domain asks for.
const TOLERANCE: f32 = 2e-5;

fn desc(mesh: &Mesh, bones: PartBones) -> PartDesc<'_> {
    PartDesc {
        label: "cloud",
        mesh,
        first_weight: 0,
        kind: PartKind::Skin,
        bones,
        textures: PartTextures::default(),
    }
}

fn largest(a: &[Vec3], b: &[Vec3]) -> f32 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max)
}

/// The largest differences of positions and normals between GPU and CPU on one random mesh.
fn difference(
    deformer: &Deformer,
    random: &mut Random,
    vertices: usize,
    shapes: usize,
    rigid: bool,
) -> Option<(f32, f32)> {
    let gpu = gpu()?;
    let palette_len = 1 + random.below(12);
    let mesh = random_mesh(random, vertices, shapes, (!rigid).then_some(palette_len));
    let rigid_bone = random.below(palette_len);
    let bones = if rigid { PartBones::Rigid(rigid_bone) } else { PartBones::PerVertex };
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &[desc(&mesh, bones)], palette_len).expect("valid");
    let mut state = AvatarState::new(&gpu.device, &model);
    let palette: Vec<Affine3A> = (0..palette_len).map(|_| random.rigid(5.0)).collect();
    // A third of the shapes at rest, one at exactly 1.
    let weights: Vec<f32> =
        (0..shapes).map(|k| if k == 0 { 1.0 } else { [0.0, random.signed(), 0.7][k % 3] }).collect();
    state.set(&gpu.queue, &palette, &weights).expect("lengths fit");
    let on_gpu = deformer.run(&gpu.device, &gpu.queue, &model, &state, 0).expect("deformed");
    let mut on_cpu = mesh.deformed();
    let cpu_palette = if rigid { &palette[rigid_bone..=rigid_bone] } else { &palette[..] };
    deform(&mesh, cpu_palette, &weights, &mut on_cpu).expect("deformed");
    // A blended normal that is short but not zero magnifies rounding; its direction means nothing.
    let blended_length = |v: usize| {
        let offset = |shape: &Shape| shape.normals.as_ref().and_then(|d| d.get(v)).unwrap_or_default();
        let shapes = mesh.shapes.iter().zip(&weights).map(|(shape, weight)| offset(shape) * *weight);
        (mesh.normals[v] + shapes.sum::<Vec3>()).length()
    };
    let long: Vec<usize> = (0..vertices).filter(|v| !(1e-7..0.05).contains(&blended_length(*v))).collect();
    let pick = |normals: &[Vec3]| long.iter().map(|v| normals[*v]).collect::<Vec<_>>();
    Some((
        largest(&on_gpu.positions, &on_cpu.positions),
        largest(&pick(&on_gpu.normals), &pick(&on_cpu.normals)),
    ))
}

#[test]
fn random_meshes_deform_on_the_gpu_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let deformer = Deformer::new(&gpu.device);
    let mut random = Random(7);
    let mut worst = (0.0f32, 0.0f32);
    for case in 0..60 {
        let vertices = [1, 2, 127, 128, 129, 5000, 1 + random.below(1000)][case % 7];
        let shapes = [0, 1, 2, 20, random.below(21)][case % 5];
        let rigid = case % 4 == 3;
        let Some((position, normal)) = difference(&deformer, &mut random, vertices, shapes, rigid) else {
            return;
        };
        assert!(
            position <= TOLERANCE && normal <= TOLERANCE,
            "case {case}: {vertices} vertices, {shapes} shapes, rigid {rigid}: positions {position}, normals {normal}"
        );
        worst = (worst.0.max(position), worst.1.max(normal));
    }
    println!("on {}: positions within {}, normals within {}", gpu.info.name, worst.0, worst.1);
}

/// Offsets for some vertices of some blocks, or all, or none, by `kind`.
fn mixed_shape(random: &mut Random, vertices: usize, kind: usize) -> Shape {
    let share = [1.0, 0.2, 0.004, 0.0][kind % 4];
    let pairs = |random: &mut Random| {
        let moved: Vec<u32> =
            (0..vertices as u32).filter(|_| f64::from(random.signed().abs()) < share).collect();
        moved.into_iter().map(|vertex| (vertex, random.vec3(1.0))).collect::<Vec<_>>()
    };
    let shape = Shape::from_pairs(format!("mixed {kind}"), vertices, pairs(random)).expect("valid pairs");
    // Of three shapes one leaves normals alone, one turns those that it moves, and one turns others.
    let normals = match kind % 3 {
        0 => return shape,
        1 => shape.positions.iter().map(|(vertex, d)| (vertex as u32, d * 0.2)).collect(),
        _ => pairs(random).into_iter().map(|(vertex, d)| (vertex, d * 0.3)).collect::<Vec<_>>(),
    };
    Shape { normals: Some(Offsets::from_pairs(vertices, normals).expect("valid pairs")), ..shape }
}

/// The same mesh, pose and weights on both processors; the largest differences of positions and normals.
fn difference_of(mesh: &Mesh, weights: &[f32]) -> Option<(f32, f32)> {
    let gpu = gpu()?;
    let model =
        AvatarModel::new(&gpu.device, &gpu.queue, &[desc(mesh, PartBones::Rigid(0))], 1).expect("valid");
    let mut state = AvatarState::new(&gpu.device, &model);
    let pose = [Affine3A::from_rotation_y(0.5)];
    state.set(&gpu.queue, &pose, weights).expect("lengths fit");
    let deformer = Deformer::new(&gpu.device);
    let on_gpu = deformer.run(&gpu.device, &gpu.queue, &model, &state, 0).expect("deformed");
    let mut on_cpu = mesh.deformed();
    deform(mesh, &pose, weights, &mut on_cpu).expect("deformed");
    Some((
        largest(&on_gpu.positions, &on_cpu.positions),
        // As above: the direction of what is left of a normal that shapes all but cancelled means nothing.
        on_gpu
            .normals
            .iter()
            .zip(&on_cpu.normals)
            .zip(blended_lengths(mesh, weights))
            .filter(|(_, length)| *length > 0.05)
            .map(|((a, b), _)| (*a - *b).abs().max_element())
            .fold(0.0, f32::max),
    ))
}

fn blended_lengths(mesh: &Mesh, weights: &[f32]) -> Vec<f32> {
    let mut sums = mesh.normals.clone();
    for (shape, weight) in mesh.shapes.iter().zip(weights) {
        shape.normals.iter().for_each(|normals| normals.add_scaled(*weight, &mut sums));
    }
    sums.into_iter().map(Vec3::length).collect()
}

#[test]
fn dense_sparse_and_empty_shapes_deform_blocks_of_any_length() {
    let mut random = Random(19);
    for vertices in [1, 63, 64, 65, 128, 1000] {
        // From no shape to all twelve mixtures, and once only shapes that rest.
        for shapes in [0, 1, 2, 3, 4, 12] {
            let mut mesh = random_mesh(&mut random, vertices, 0, None);
            mesh.shapes = (0..shapes).map(|kind| mixed_shape(&mut random, vertices, kind)).collect();
            let weights: Vec<f32> = (0..shapes).map(|k| [0.7, random.signed(), 0.0][k % 3]).collect();
            let ones = vec![1.0; shapes];
            for weights in [&weights, &ones] {
                let Some((position, normal)) = difference_of(&mesh, weights) else { return };
                assert!(
                    position <= TOLERANCE && normal <= TOLERANCE,
                    "{vertices} vertices, {shapes} shapes: positions {position}, normals {normal}"
                );
            }
        }
        let mut mesh = random_mesh(&mut random, vertices, 0, None);
        mesh.shapes = vec![mixed_shape(&mut random, vertices, 3); 5];
        assert!(mesh.shapes.iter().all(|shape| shape.positions.moved_vertices() == 0));
        let Some((position, normal)) = difference_of(&mesh, &[1.0; 5]) else { return };
        assert!(position <= TOLERANCE && normal <= TOLERANCE, "{vertices} vertices at rest");
    }
}

#[test]
fn three_hundred_shapes_of_sixty_thousand_vertices_fit_where_each_moves_one_in_a_hundred() {
    let (vertices, shapes, moved) = (60_000u32, 300u32, 600u32);
    let mut random = Random(23);
    let mut mesh = random_mesh(&mut random, vertices as usize, 0, None);
    for k in 0..shapes {
        // Overlapping neighbourhoods, from the first vertex to the last.
        let first = k * (vertices - moved) / (shapes - 1);
        let pairs = (first..first + moved).map(|vertex| (vertex, random.vec3(1.0))).collect::<Vec<_>>();
        let normals = pairs.iter().map(|(vertex, d)| (*vertex, *d * 0.1)).collect::<Vec<_>>();
        let shape = Shape::from_pairs(format!("shape {k}"), vertices as usize, pairs).expect("valid pairs");
        let normals = Offsets::from_pairs(vertices as usize, normals).expect("valid pairs");
        mesh.shapes.push(Shape { normals: Some(normals), ..shape });
    }
    let weights: Vec<f32> = (0..shapes).map(|_| random.signed()).collect();
    let Some((position, normal)) = difference_of(&mesh, &weights) else { return };
    assert!(position <= TOLERANCE && normal <= TOLERANCE, "positions {position}, normals {normal}");
}

#[test]
fn a_shape_without_normals_leaves_normals_alone() {
    let Some(gpu) = gpu() else { return };
    let mut mesh = random_mesh(&mut Random(29), 130, 0, None);
    mesh.shapes = vec![Shape::new("push", vec![Vec3::X; 130])];
    let model =
        AvatarModel::new(&gpu.device, &gpu.queue, &[desc(&mesh, PartBones::Rigid(0))], 1).expect("valid");
    let mut state = AvatarState::new(&gpu.device, &model);
    let deformer = Deformer::new(&gpu.device);
    let mut normals_at = |weight| {
        state.set(&gpu.queue, &[Affine3A::IDENTITY], &[weight]).expect("lengths fit");
        let deformed = deformer.run(&gpu.device, &gpu.queue, &model, &state, 0).expect("deformed");
        (deformed.positions[129], deformed.normals)
    };
    let (at_rest, pushed) = (normals_at(0.0), normals_at(3.0));
    assert_eq!(at_rest.1, pushed.1, "to the bit");
    assert!((pushed.0 - at_rest.0 - 3.0 * Vec3::X).length() < TOLERANCE);
}

#[test]
fn a_normal_without_length_stays_undeformed() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(3);
    let mut mesh = random_mesh(&mut random, 8, 1, None);
    mesh.shapes[0].normals = Some(mesh.normals.iter().map(|n| -*n).collect());
    let model =
        AvatarModel::new(&gpu.device, &gpu.queue, &[desc(&mesh, PartBones::Rigid(0))], 1).expect("valid");
    let mut state = AvatarState::new(&gpu.device, &model);
    state.set(&gpu.queue, &[Affine3A::IDENTITY], &[1.0]).expect("lengths fit");
    let deformer = Deformer::new(&gpu.device);
    let deformed = deformer.run(&gpu.device, &gpu.queue, &model, &state, 0).expect("deformed");
    assert!(largest(&deformed.normals, &mesh.normals) < 1e-6);
}

#[test]
fn parts_with_fewer_shapes_follow_the_first_weights() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(11);
    let many = random_mesh(&mut random, 50, 4, None);
    let few = random_mesh(&mut random, 30, 1, None);
    let parts = [desc(&many, PartBones::Rigid(0)), desc(&few, PartBones::Rigid(0))];
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &parts, 1).expect("valid");
    assert_eq!(model.shape_count(), 4);
    let mut state = AvatarState::new(&gpu.device, &model);
    state.set(&gpu.queue, &[Affine3A::IDENTITY], &[0.5, 0.0, -0.25, 1.0]).expect("lengths fit");
    let deformer = Deformer::new(&gpu.device);
    for (index, (mesh, weights)) in
        [(&many, &[0.5, 0.0, -0.25, 1.0][..]), (&few, &[0.5][..])].into_iter().enumerate()
    {
        let on_gpu = deformer.run(&gpu.device, &gpu.queue, &model, &state, index).expect("deformed");
        let mut on_cpu = mesh.deformed();
        deform(mesh, &[Affine3A::IDENTITY], weights, &mut on_cpu).expect("deformed");
        assert!(largest(&on_gpu.positions, &on_cpu.positions) < TOLERANCE);
    }
}

#[test]
fn parts_with_shapes_of_their_own_follow_the_weights_from_their_first_on() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(12);
    let weights = [0.5, 0.0, -0.25, 1.0, 0.0, 0.75, 2.0];
    let meshes = [2, 3, 2].map(|shapes| random_mesh(&mut random, 130, shapes, None));
    let firsts = [0, 1, 5];
    let parts: Vec<_> = (meshes.iter().zip(firsts))
        .map(|(mesh, first_weight)| PartDesc { first_weight, ..desc(mesh, PartBones::Rigid(0)) })
        .collect();
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &parts, 1).expect("valid");
    assert_eq!(model.shape_count(), 7);
    let mut state = AvatarState::new(&gpu.device, &model);
    state.set(&gpu.queue, &[Affine3A::IDENTITY], &weights).expect("lengths fit");
    let deformer = Deformer::new(&gpu.device);
    for (index, (mesh, first)) in meshes.iter().zip(firsts).enumerate() {
        let on_gpu = deformer.run(&gpu.device, &gpu.queue, &model, &state, index).expect("deformed");
        let mut on_cpu = mesh.deformed();
        let weights = &weights[first..first + mesh.shapes.len()];
        deform(mesh, &[Affine3A::IDENTITY], weights, &mut on_cpu).expect("deformed");
        assert!(largest(&on_gpu.positions, &on_cpu.positions) < TOLERANCE);
    }
    // So many weights that no device has room for them; without shapes none are needed.
    let far = PartDesc { first_weight: usize::MAX, ..parts[0] };
    AvatarModel::new(&gpu.device, &gpu.queue, &[far], 1).expect_err("too many weights");
    let still = random_mesh(&mut random, 3, 0, None);
    let still = PartDesc { first_weight: usize::MAX, ..desc(&still, PartBones::Rigid(0)) };
    assert_eq!(AvatarModel::new(&gpu.device, &gpu.queue, &[still], 1).expect("valid").shape_count(), 0);
}

#[test]
fn a_new_state_is_at_bind_pose() {
    let Some(gpu) = gpu() else { return };
    let mesh = random_mesh(&mut Random(5), 20, 3, Some(4));
    let model =
        AvatarModel::new(&gpu.device, &gpu.queue, &[desc(&mesh, PartBones::PerVertex)], 4).expect("valid");
    let state = AvatarState::new(&gpu.device, &model);
    let deformer = Deformer::new(&gpu.device);
    let deformed = deformer.run(&gpu.device, &gpu.queue, &model, &state, 0).expect("deformed");
    assert!(largest(&deformed.positions, &mesh.positions) < TOLERANCE);
}

#[test]
fn wrong_lengths_parts_and_states_are_errors() {
    let Some(gpu) = gpu() else { return };
    let mesh = random_mesh(&mut Random(9), 3, 2, None);
    let part = desc(&mesh, PartBones::Rigid(0));
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &[part], 1).expect("valid");
    let other = AvatarModel::new(&gpu.device, &gpu.queue, &[part], 5).expect("valid");
    let mut state = AvatarState::new(&gpu.device, &model);
    let one = [Affine3A::IDENTITY];
    assert_eq!(state.set(&gpu.queue, &[], &[0.0; 2]), Err(StateError::BoneCount { expected: 1, found: 0 }));
    assert_eq!(state.set(&gpu.queue, &one, &[0.0]), Err(StateError::WeightCount { expected: 2, found: 1 }));
    let deformer = Deformer::new(&gpu.device);
    let run = |model, part| deformer.run(&gpu.device, &gpu.queue, model, &state, part);
    assert_eq!(run(&model, 1), Err(DeformerError::NoSuchPart { parts: 1, found: 1 }));
    assert_eq!(run(&other, 0), Err(DeformerError::StateOfAnotherModel));
}

#[test]
fn an_empty_part_deforms_to_nothing() {
    let Some(gpu) = gpu() else { return };
    let mesh = Mesh::default();
    let model =
        AvatarModel::new(&gpu.device, &gpu.queue, &[desc(&mesh, PartBones::Rigid(0))], 1).expect("valid");
    let state = AvatarState::new(&gpu.device, &model);
    let deformed =
        Deformer::new(&gpu.device).run(&gpu.device, &gpu.queue, &model, &state, 0).expect("nothing");
    assert!(deformed.positions.is_empty());
}
