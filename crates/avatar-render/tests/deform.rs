//! The GPU deforms as the CPU does.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

mod common;

use avatar_mesh::{Mesh, PartKind, Shape, deform};
use avatar_render::{
    AvatarModel, AvatarState, Deformer, DeformerError, PartBones, PartDesc, PartTextures, StateError,
};
use common::{Random, gpu, random_mesh};
use glam::{Affine3A, Vec3};

/// Coordinates are up to about 20; a fifth of what the domain asks for.
const TOLERANCE: f32 = 2e-5;

fn desc(mesh: &Mesh, bones: PartBones) -> PartDesc<'_> {
    PartDesc { label: "cloud", mesh, kind: PartKind::Skin, bones, textures: PartTextures::default() }
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
