//! A crowd looks as its avatars do one by one, and does no more than it must.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::Stage;
use crate::common::{ball, gpu, scene, shadings, square};
use avatar_mesh::{Mesh, PartKind, Shape};
use avatar_render::headless::Gpu;
use avatar_render::{
    Alpha, AvatarCrowd, AvatarModel, AvatarState, Camera, Cartoon, CrowdError, CrowdWork, DrawError,
    Lighting, Material, PartBones, PartDesc, PartTextures, Scene, Shading, Standard, StateError,
};
use glam::{Affine3A, Quat, Vec3, Vec4};

const SIZE: u32 = 256;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const AVATARS: usize = 24;

/// A head of two bones and two shapes: a ball, an eye with its cornea, and surfaces of interchange files that
/// are opaque, have holes, and are blended.
fn model(gpu: &Gpu) -> AvatarModel {
    let mut head = ball(Vec3::ZERO, 0.5, 10);
    let offsets = |along: Vec3| head.positions.iter().map(|p| along * p.y.abs()).collect::<Vec<_>>();
    head.shapes = vec![Shape::new("tall", offsets(Vec3::Y)), Shape::new("crooked", offsets(Vec3::X))];
    let eye = ball(Vec3::new(0.0, 0.1, 0.45), 0.2, 8);
    let cornea = ball(Vec3::new(0.0, 0.1, 0.5), 0.17, 8);
    let cards = [-0.5, 0.5, 0.0].map(|x| square(Vec3::new(x, -0.4, 0.55), 0.2));
    // Colours of vertices take another way into the programs.
    let painted = Mesh { colors: vec![Vec4::new(1.0, 0.8, 0.6, 0.7); 4], ..cards[1].clone() };
    let part = |label, mesh, kind, bone| {
        let bones = PartBones::Rigid(bone);
        PartDesc { label, mesh, first_weight: 0, kind, bones, textures: PartTextures::default() }
    };
    let parts = [
        part("head", &head, PartKind::Skin, 0),
        part("eye", &eye, PartKind::Eyeball, 1),
        part("cornea", &cornea, PartKind::Cornea, 1),
        part("opaque", &cards[0], PartKind::Surface, 0),
        part("with holes", &painted, PartKind::Surface, 0),
        part("blended", &cards[2], PartKind::Surface, 0),
    ];
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &parts, 2).expect("a valid model");
    let looks = [Alpha::Opaque, Alpha::Mask(0.5), Alpha::Blend];
    for (place, alpha) in (3..).zip(looks) {
        let cartoon = Cartoon {
            shade_color: [0.3, 0.1, 0.1],
            shading_shift: 0.0,
            shading_toony: 0.9,
            outline_width: 0.02,
            outline_color: [0.1, 0.0, 0.2],
        };
        let lighting = if place == 3 { Lighting::Cartoon(cartoon) } else { Standard::default().lighting };
        let base_color = [0.9, 0.2, 0.1 * place as f32, 0.8];
        let standard =
            Standard { base_color, alpha, lighting, is_double_sided: place > 3, ..Standard::default() };
        let material = Material { standard: Some(standard), ..Material::of(PartKind::Surface) };
        model.set_material(&gpu.queue, place, &material).expect("a part");
    }
    model
}

/// The pose of an avatar: six in a row, each turned and shaped in its own way.
fn pose(avatar: usize) -> ([Affine3A; 2], [f32; 2]) {
    let (column, row) = ((avatar % 6) as f32, (avatar / 6) as f32);
    let place = 2.0 * Vec3::new(column - 2.5, 1.5 - row, 0.1 * column);
    let turned = Quat::from_rotation_y(0.2 * (column - 2.5)) * Quat::from_rotation_x(0.15 * (row - 1.5));
    let head = Affine3A::from_rotation_translation(turned, place);
    let look = Affine3A::from_rotation_y(0.05 * (avatar as f32 - 12.0));
    // Weights out of 0 to 1 have tight boxes, as avatars of their own have: shadow maps are fitted alike.
    ([head, head * look], [-0.1 - avatar as f32 / 64.0, 1.25 - (avatar * 5 % 24) as f32 / 12.0])
}

fn states(gpu: &Gpu, model: &AvatarModel) -> Vec<AvatarState> {
    let state = |avatar| {
        let mut state = AvatarState::new(&gpu.device, model);
        let (bones, weights) = pose(avatar);
        state.set(&gpu.queue, &bones, &weights).expect("two bones, two weights");
        state
    };
    (0..AVATARS).map(state).collect()
}

fn crowd(gpu: &Gpu, model: &AvatarModel) -> AvatarCrowd {
    let mut crowd = AvatarCrowd::new(&gpu.device, model, AVATARS).expect("room");
    for avatar in 0..AVATARS {
        let (bones, weights) = pose(avatar);
        crowd.set(model, avatar, &bones, &weights).expect("two bones, two weights");
    }
    crowd
}

fn wide() -> Scene {
    let distance = 40.0;
    let camera = Camera::orbit(Vec3::ZERO, distance, 0.2, 0.1, 2.0 * (6.5f32 / distance).atan(), 1.0);
    Scene { camera, ..scene(4.0) }
}

#[test]
fn in_every_style_it_looks_as_its_avatars_do_one_by_one() {
    let Some(gpu) = gpu() else { return };
    let model = model(gpu);
    let states = states(gpu, &model);
    let all: Vec<_> = states.iter().map(|state| (&model, state)).collect();
    for (name, shading) in shadings() {
        let stage = Stage::new(gpu, shading, SIZE, FORMAT);
        let one_by_one = stage.bytes(gpu, &wide(), &all);
        let drawn = one_by_one.chunks_exact(4).filter(|pixel| pixel[..3] != [0; 3]).count();
        assert!(drawn > 10_000, "{name}: {drawn} pixels");
        let mut crowd = crowd(gpu, &model);
        let together = stage.bytes_of_crowds(gpu, &wide(), &[], &mut [(&model, &mut crowd)]);
        let differing = one_by_one.iter().zip(&together).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "{name}: bytes that differ");
        // Half of them as avatars of their own, the others as a crowd.
        (0..AVATARS / 2).for_each(|avatar| crowd.set_hidden(avatar, true).expect("an avatar"));
        let (own, _) = all.split_at(AVATARS / 2);
        let mixed = stage.bytes_of_crowds(gpu, &wide(), own, &mut [(&model, &mut crowd)]);
        let differing = one_by_one.iter().zip(&mixed).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "{name}: bytes that differ beside avatars of their own");
    }
}

#[test]
fn what_did_not_move_or_is_out_of_view_is_not_deformed_and_what_is_hidden_not_drawn() {
    let Some(gpu) = gpu() else { return };
    let model = model(gpu);
    let mut crowd = crowd(gpu, &model);
    let (_, plain) = shadings()[0];
    let stage = Stage::new(gpu, plain, SIZE, FORMAT);
    let frame = |crowd: &mut AvatarCrowd, scene: &Scene| {
        let bytes = stage.bytes_of_crowds(gpu, scene, &[], &mut [(&model, crowd)]);
        (crowd.work(), bytes)
    };
    let all = CrowdWork { drawn: AVATARS, casting: AVATARS, deformed: AVATARS };
    let (work, first) = frame(&mut crowd, &wide());
    assert_eq!(work, all);
    let (work, again) = frame(&mut crowd, &wide());
    assert_eq!(work, CrowdWork { deformed: 0, ..all });
    assert!(first == again, "what stands still looks the same");
    // One moves far to the side.
    let (bones, weights) = pose(7);
    let aside = bones.map(|bone| Affine3A::from_translation(Vec3::X * 500.0) * bone);
    crowd.set(&model, 7, &aside, &weights).expect("two bones");
    let (work, without) = frame(&mut crowd, &wide());
    assert_eq!(work, CrowdWork { drawn: AVATARS - 1, casting: AVATARS - 1, deformed: 0 });
    assert!(without != first);
    // Hidden there, it looks as if it were away; back again, it is deformed again.
    crowd.set(&model, 7, &bones, &weights).expect("two bones");
    crowd.set_hidden(7, true).expect("an avatar");
    let (work, hidden) = frame(&mut crowd, &wide());
    assert_eq!((work.drawn, work.deformed), (AVATARS - 1, 0));
    assert!(hidden == without);
    crowd.set_hidden(7, false).expect("an avatar");
    let (work, back) = frame(&mut crowd, &wide());
    assert_eq!(work, CrowdWork { deformed: 1, ..all });
    assert!(back == first);
    // From near, one fills the picture: the others are out of it, whatever they do.
    let (bones, _) = pose(0);
    let near = Camera::orbit(bones[0].translation.into(), 3.0, 0.0, 0.0, 0.3, 1.0);
    for avatar in 0..AVATARS {
        // Another pose and back: that counts as moved.
        for (bones, weights) in [pose(avatar + 1), pose(avatar)] {
            crowd.set(&model, avatar, &bones, &weights).expect("two bones");
        }
    }
    let (work, _) = frame(&mut crowd, &Scene { camera: near, ..wide() });
    assert_eq!(work, CrowdWork { drawn: 1, casting: 1, deformed: 1 });
    let (work, last) = frame(&mut crowd, &wide());
    assert_eq!(work, CrowdWork { deformed: AVATARS - 1, ..all });
    assert!(last == first);
    // The pose that each has already costs nothing, unless the work of a frame is lost.
    for avatar in 0..AVATARS {
        let (bones, weights) = pose(avatar);
        crowd.set(&model, avatar, &bones, &weights).expect("two bones");
    }
    assert_eq!(frame(&mut crowd, &wide()).0, CrowdWork { deformed: 0, ..all });
    crowd.redo();
    let (work, last) = frame(&mut crowd, &wide());
    assert_eq!(work, all);
    assert!(last == first);
}

#[test]
fn one_that_moved_out_of_view_is_deformed_when_it_comes_into_view() {
    let Some(gpu) = gpu() else { return };
    let model = model(gpu);
    let (_, low) = shadings()[1];
    let stage = Stage::new(gpu, low, 64, FORMAT);
    let away = Scene { camera: Camera::orbit(Vec3::X * 900.0, 5.0, 0.0, 0.0, 0.4, 1.0), ..scene(4.0) };
    let (bones, weights) = pose(8);
    let near = Camera::orbit(bones[0].translation.into(), 5.0, 0.0, 0.0, 0.4, 1.0);
    let near = Scene { camera: near, ..scene(4.0) };
    let new = || {
        let mut state = AvatarState::new(&gpu.device, &model);
        state.set(&gpu.queue, &bones, &weights).expect("two bones, two weights");
        state
    };
    let expected = stage.bytes(gpu, &near, &[(&model, &new())]);
    let mut state = AvatarState::new(&gpu.device, &model);
    let empty = stage.bytes(gpu, &away, &[(&model, &state)]);
    assert!(empty.chunks_exact(4).all(|pixel| pixel == &empty[..4]), "nothing is in view");
    state.set(&gpu.queue, &bones, &weights).expect("two bones, two weights");
    assert!(stage.bytes(gpu, &away, &[(&model, &state)]) == empty);
    assert!(stage.bytes(gpu, &near, &[(&model, &state)]) == expected);
    assert!(expected != empty);
}

#[test]
fn who_is_out_of_view_still_casts_a_shadow_into_it() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 12);
    let desc = PartDesc {
        label: "ball",
        mesh: &mesh,
        first_weight: 0,
        kind: PartKind::Skin,
        bones: PartBones::Rigid(0),
        textures: PartTextures::default(),
    };
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &[desc], 1).expect("a model");
    let (_, low) = shadings()[1];
    let stage = Stage::new(gpu, low, 64, FORMAT);
    let scene = scene(8.0);
    // On the way to the key lamp, beyond the edge of the picture.
    let key = scene.light.key.direction_world.normalize_or_zero();
    for distance in [6.0, 12.0] {
        let place = |at: Vec3| [Affine3A::from_translation(at)];
        let mut states = [(); 2].map(|()| AvatarState::new(&gpu.device, &model));
        let mut crowd = AvatarCrowd::new(&gpu.device, &model, 2).expect("room");
        for (avatar, bones) in [place(Vec3::ZERO), place(key * distance)].iter().enumerate() {
            states[avatar].set(&gpu.queue, bones, &[]).expect("a bone");
            crowd.set(&model, avatar, bones, &[]).expect("a bone");
        }
        let all = [(&model, &states[0]), (&model, &states[1])];
        let expected = stage.bytes(gpu, &scene, &all);
        let alone = stage.bytes(gpu, &scene, &all[..1]);
        assert!(expected != alone, "it casts a shadow from {distance}");
        let together = stage.bytes_of_crowds(gpu, &scene, &[], &mut [(&model, &mut crowd)]);
        assert!(together == expected, "and so does one of a crowd from {distance}");
    }
}

#[test]
fn avatars_in_several_buffers_look_as_in_one() {
    let Some(gpu) = gpu() else { return };
    // So many vertices that a binding of 128 MiB holds two avatars: 32 bytes each.
    let mut mesh = ball(Vec3::ZERO, 0.8, 12);
    let filler = 1_900_000;
    let far = (0..filler).map(|i| Vec3::new(0.1 * (i % 10) as f32, 1e-7 * i as f32, 0.0));
    mesh.positions.extend(far);
    mesh.normals.resize(mesh.positions.len(), Vec3::Z);
    mesh.uvs.resize(mesh.positions.len(), glam::Vec2::ZERO);
    let desc = PartDesc {
        label: "ball",
        mesh: &mesh,
        first_weight: 0,
        kind: PartKind::Skin,
        bones: PartBones::Rigid(0),
        textures: PartTextures::default(),
    };
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &[desc], 1).expect("a model");
    let mut crowd = AvatarCrowd::new(&gpu.device, &model, 5).expect("room");
    let place = |avatar: usize| [Affine3A::from_translation(Vec3::X * (2.0 * avatar as f32 - 4.0))];
    let (_, plain) = shadings()[0];
    let stage = Stage::new(gpu, plain, 128, FORMAT);
    let mut states = Vec::new();
    for avatar in 0..5 {
        crowd.set(&model, avatar, &place(avatar), &[]).expect("a bone");
        let mut state = AvatarState::new(&gpu.device, &model);
        state.set(&gpu.queue, &place(avatar), &[]).expect("a bone");
        states.push(state);
    }
    let all: Vec<_> = states.iter().map(|state| (&model, state)).collect();
    let expected = stage.bytes(gpu, &wide(), &all);
    assert!(stage.bytes_of_crowds(gpu, &wide(), &[], &mut [(&model, &mut crowd)]) == expected);
}

#[test]
fn what_does_not_fit_is_an_error_and_changes_nothing() {
    let Some(gpu) = gpu() else { return };
    let [ours, other] = [(); 2].map(|()| model(gpu));
    let mut crowd = crowd(gpu, &ours);
    let (bones, weights) = pose(3);
    let stage = Stage::new(gpu, Shading::Plain, 64, FORMAT);
    let frame = |crowd: &mut AvatarCrowd| stage.bytes_of_crowds(gpu, &wide(), &[], &mut [(&ours, crowd)]);
    let before = frame(&mut crowd);
    let missing = CrowdError::NoSuchAvatar { avatars: AVATARS, found: AVATARS };
    assert_eq!(crowd.set(&ours, AVATARS, &bones, &weights), Err(missing));
    assert_eq!(crowd.set_hidden(AVATARS, true), Err(missing));
    assert_eq!(crowd.set(&other, 3, &bones, &weights), Err(CrowdError::OtherModel));
    let few = CrowdError::State(StateError::BoneCount { expected: 2, found: 1 });
    assert_eq!(crowd.set(&ours, 3, &bones[..1], &weights), Err(few));
    let few = CrowdError::State(StateError::WeightCount { expected: 2, found: 1 });
    assert_eq!(crowd.set(&ours, 3, &bones, &weights[..1]), Err(few));
    let mirror = [bones[0], bones[1] * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0))];
    assert_eq!(crowd.set(&ours, 3, &mirror, &weights), Err(CrowdError::Mirrored { bone: 1 }));
    assert!(frame(&mut crowd) == before);
    let too_many = AvatarCrowd::new(&gpu.device, &ours, 100_000_000).expect_err("more than any device binds");
    assert!(matches!(too_many, CrowdError::TooMany { found: 100_000_000, .. }), "{too_many}");
    let none = AvatarCrowd::new(&gpu.device, &ours, 0).expect("an empty crowd");
    assert!(none.is_empty());
    let view = stage.texture.create_view(&Default::default());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let drawn = stage.renderer.draw_crowds(
        &mut encoder,
        &view,
        &stage.targets,
        &gpu.queue,
        &wide(),
        &[],
        &mut [(&other, &mut crowd)],
        None,
    );
    assert_eq!(drawn, Err(DrawError::CrowdOfAnotherModel { crowd: 0 }));
    // Bones and numbers that are none leave the others in place.
    let nowhere = [Affine3A::from_scale(Vec3::splat(f32::NAN)); 2];
    crowd.set(&ours, 3, &nowhere, &[f32::NAN; 2]).expect("two bones, two weights");
    frame(&mut crowd);
    assert_eq!(crowd.work().drawn, AVATARS - 1);
}
