//! Eight bones a vertex, and bones that scale unevenly, shear and mirror: the GPU against f64 and against the
//! CPU.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::{Random, gpu, random_mesh};
use avatar_mesh::{Deformed, Mesh, PartKind, deform, turns_evenly};
use avatar_render::headless::Gpu;
use avatar_render::{AvatarModel, AvatarState, Deformer, PartBones, PartDesc, PartTextures};
use glam::{Affine3A, DMat3, DVec3, Quat, Vec3};
use proptest::prelude::*;

/// Coordinates are up to about 20.
const TOLERANCE: f64 = 2e-5;

/// A mesh whose vertices have eight bones, where `further`, else four.
fn mesh(random: &mut Random, vertices: usize, bones: usize, further: bool) -> Mesh {
    let mut mesh = random_mesh(random, vertices, 0, Some(bones));
    let skinning = mesh.skinning.as_mut().expect("a skinned mesh");
    for weights in skinning.weights.iter_mut().filter(|_| further) {
        skinning.more_bones.push(std::array::from_fn(|_| random.below(bones) as u16));
        let share = 0.5 * random.signed().abs();
        *weights = weights.map(|weight| weight * (1.0 - share));
        skinning.more_weights.push([0.4, 0.3, 0.2, 0.1].map(|weight| weight * share));
    }
    mesh
}

fn uneven(random: &mut Random) -> Affine3A {
    let scale = Vec3::from_array([(); 3].map(|()| {
        let size = 0.4 + 1.2 * random.signed().abs();
        if random.below(3) == 0 { -size } else { size }
    }));
    let turn = Quat::from_axis_angle(random.unit(), random.signed() * 3.0);
    Affine3A::from_scale_rotation_translation(scale, turn, random.vec3(5.0))
        * Affine3A::from_quat(Quat::from_axis_angle(random.unit(), random.signed()))
}

fn on_gpu(gpu: &Gpu, mesh: &Mesh, bones: PartBones, palette: &[Affine3A]) -> Deformed {
    let textures = PartTextures::default();
    let desc = PartDesc { label: "cloud", mesh, first_weight: 0, kind: PartKind::Skin, bones, textures };
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &[desc], palette.len()).expect("valid");
    let mut state = AvatarState::new(&gpu.device, &model);
    state.set(&gpu.queue, palette, &[]).expect("lengths fit");
    Deformer::new(&gpu.device).run(&gpu.device, &gpu.queue, &model, &state, 0).expect("deformed")
}

/// The formulas in f64: position, normal, and how sure the normal is. A normal stands on what the blended
/// matrix makes of two directions across it, on the side that it makes of the normal itself; where all bones
/// turn evenly, it is the mean of what they make of it.
fn reference(mesh: &Mesh, bones: &[Affine3A], vertex: usize, is_even: bool) -> (DVec3, DVec3, f64) {
    let skinning = mesh.skinning.as_ref().expect("a skinned mesh");
    let more = skinning.more_bones.get(vertex).into_iter().flatten();
    let more_weights = skinning.more_weights.get(vertex).into_iter().flatten();
    let all = skinning.bones[vertex].iter().chain(more);
    let (mut matrix, mut shift) = (DMat3::ZERO, DVec3::ZERO);
    for (bone, weight) in all.zip(skinning.weights[vertex].iter().chain(more_weights)) {
        let bone = &bones[usize::from(*bone)];
        matrix += bone.matrix3.as_dmat3() * f64::from(*weight);
        shift += bone.translation.as_dvec3() * f64::from(*weight);
    }
    let position = matrix * mesh.positions[vertex].as_dvec3() + shift;
    let n = mesh.normals[vertex].as_dvec3().normalize_or_zero();
    if is_even {
        return (position, (matrix * n).normalize_or_zero(), (matrix * n).length());
    }
    let across = n.any_orthonormal_vector();
    let moved = [matrix * across, matrix * n.cross(across), matrix * n];
    let standing = moved[0].cross(moved[1]);
    let side = standing.dot(moved[2]);
    let largest = moved.iter().map(|v| v.length()).fold(0.0, f64::max);
    (position, standing.normalize_or_zero() * side.signum(), (side / largest.powi(3)).abs())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]
    #[test]
    fn the_gpu_deforms_as_the_formulas_in_f64_and_as_the_cpu(
        seed in any::<u32>(), vertices in 1..300usize, bones in 1..12usize, further in any::<bool>(),
        with_uneven in any::<bool>(),
    ) {
        let Some(gpu) = gpu() else { return Ok(()) };
        let mut random = Random(seed.into());
        let mesh = mesh(&mut random, vertices, bones, further);
        let palette: Vec<Affine3A> = (0..bones)
            .map(|_| if with_uneven && random.below(2) == 0 { uneven(&mut random) } else { random.rigid(5.0) })
            .collect();
        let used = mesh.skinning.as_ref().expect("a skinned mesh").used_bones();
        let is_even = used.iter().all(|bone| turns_evenly(&palette[usize::from(*bone)]));
        let found = on_gpu(gpu, &mesh, PartBones::PerVertex, &palette);
        let mut on_cpu = mesh.deformed();
        deform(&mesh, &palette, &[], &mut on_cpu).expect("deformed");
        for vertex in 0..vertices {
            let (position, normal, sure) = reference(&mesh, &palette, vertex, is_even);
            prop_assert!(found.positions[vertex].as_dvec3().distance(position) < 2.0 * TOLERANCE);
            prop_assert!(found.positions[vertex].distance(on_cpu.positions[vertex]) < 2.0 * TOLERANCE as f32);
            // What is nearly flat has no precise direction.
            if sure > 0.01 {
                let off = found.normals[vertex].as_dvec3().distance(normal);
                prop_assert!(off < 1e-6 / sure, "{off} {sure}");
                prop_assert!(f64::from(found.normals[vertex].distance(on_cpu.normals[vertex])) < 2e-6 / sure);
            }
        }
    }
}

#[test]
fn rigid_parts_under_uneven_scales_of_any_size_have_exact_normals() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(4);
    let mesh = Mesh { skinning: None, ..random_mesh(&mut random, 200, 0, None) };
    for scale in [
        Vec3::new(1.0, 2.0, 0.5),
        Vec3::new(-1.0, 2.0, 0.5),
        Vec3::new(1e-12, 2e-12, -3e-12),
        Vec3::new(1e9, 2e9, -3e9),
        Vec3::new(1.0, 2.0, 0.0),
    ] {
        let turn = Quat::from_rotation_x(0.7);
        let bone = Affine3A::from_scale_rotation_translation(scale, turn, Vec3::ZERO);
        let found = on_gpu(gpu, &mesh, PartBones::Rigid(0), &[bone]);
        for (found, normal) in found.normals.iter().zip(&mesh.normals) {
            // Without an axis, everything lies in the plane across it.
            let by_scale = match scale.z == 0.0 {
                true => DVec3::Z * f64::from(normal.z.signum()),
                false => normal.as_dvec3() / scale.as_dvec3(),
            };
            let expected = turn.as_dquat() * by_scale.normalize_or_zero();
            assert!(found.as_dvec3().distance(expected) < 2e-6, "{scale}: {found} {expected}");
        }
    }
}

#[test]
fn bones_that_do_not_move_a_part_do_not_change_a_bit_of_it() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(8);
    let mesh = mesh(&mut random, 500, 4, false);
    let palette: Vec<Affine3A> = (0..4).map(|_| random.rigid(5.0)).collect();
    let more =
        [&palette[..], &[uneven(&mut random), Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0))]].concat();
    let (alone, beside) =
        (on_gpu(gpu, &mesh, PartBones::PerVertex, &palette), on_gpu(gpu, &mesh, PartBones::PerVertex, &more));
    assert_eq!(alone, beside);
    // Further bones of weight 0 change nothing that is seen, either.
    let mut with_zeros = mesh.clone();
    let skinning = with_zeros.skinning.as_mut().expect("a skinned mesh");
    skinning.more_bones = vec![[1; 4]; 500];
    skinning.more_weights = vec![[0.0; 4]; 500];
    assert_eq!(on_gpu(gpu, &with_zeros, PartBones::PerVertex, &palette), alone);
}
