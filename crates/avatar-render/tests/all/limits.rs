//! Where frames end: rings of uniforms, limits of the device, and what belongs to whom.

use crate::common::head::{CROPPED, Head};
use crate::common::stage::Stage;
use crate::common::{ball, gpu, model, part, scene, shadings};
use avatar_mesh::PartKind;
use avatar_render::{
    AvatarState, Deformer, DeformerError, DrawError, Grower, GrowerError, HairDetail, PartTextures, Quality,
    Renderer, RendererConfig, Scene, Shading, Targets,
};
use glam::{Affine3A, Vec3};
use wgpu::TextureFormat;

const FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;

#[test]
fn the_state_of_a_model_of_equal_size_is_refused() {
    let Some(gpu) = gpu() else { return };
    let (device, queue) = (&gpu.device, &gpu.queue);
    let mesh = ball(Vec3::ZERO, 1.0, 8);
    let parts = [part(&mesh, PartKind::Skin, PartTextures::default())];
    let ((one, state), (twin, of_twin)) = (model(gpu, &parts), model(gpu, &parts));
    let stage = Stage::new(gpu, Shading::Plain, 8, FORMAT);
    let draw = |avatars: &[_]| {
        let mut encoder = device.create_command_encoder(&Default::default());
        let view = stage.texture.create_view(&Default::default());
        stage.renderer.draw(&mut encoder, &view, &stage.targets, queue, &scene(4.0), avatars)
    };
    assert_eq!(draw(&[(&one, &state), (&twin, &of_twin)]), Ok(()));
    let refused = DrawError::StateOfAnotherModel { avatar: 1 };
    assert_eq!(draw(&[(&one, &state), (&twin, &state)]), Err(refused));
    let (deformer, grower) = (Deformer::new(device), Grower::new(device));
    assert!(deformer.run(device, queue, &one, &state, 0).is_ok());
    let deformed = deformer.run(device, queue, &one, &of_twin, 0);
    assert_eq!(deformed.err(), Some(DeformerError::StateOfAnotherModel));
    let grown = grower.run(device, queue, &deformer, &one, &of_twin);
    assert_eq!(grown.err(), Some(GrowerError::StateOfAnotherModel));
}

#[test]
fn as_many_frames_as_promised_keep_their_own_camera_until_they_are_submitted() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 8);
    let (model, state) = model(gpu, &[part(&mesh, PartKind::Skin, PartTextures::default())]);
    let avatars = [(&model, &state)];
    let shading = Quality::Low.shading(avatar_render::Style::Natural);
    let stage = Stage::new(gpu, shading, 16, FORMAT);
    let (first, other) = (scene(3.0), scene(6.0));
    let alone = stage.bytes(gpu, &first, &avatars);
    assert!(alone != stage.bytes(gpu, &other, &avatars), "the camera is seen");
    let elsewhere = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: stage.texture.size(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let together = stage.bytes_after(gpu, |encoder| {
        for frame in 0..256 {
            let (texture, scene) = if frame == 0 { (&stage.texture, &first) } else { (&elsewhere, &other) };
            let view = texture.create_view(&Default::default());
            let drawn = stage.renderer.draw(encoder, &view, &stage.targets, &gpu.queue, scene, &avatars);
            drawn.expect("what belongs together");
        }
    });
    assert!(together == alone);
}

#[test]
fn more_heads_of_hair_than_are_told_apart_are_an_error_with_both_numbers() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let (model, mut state) = head.with_hair(gpu, CROPPED, 500.0);
    let stage = Stage::new(gpu, Shading::Plain, 8, FORMAT);
    let draw = |state: &AvatarState, heads: usize| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let view = stage.texture.create_view(&Default::default());
        let scene = head.scene(0.0, 0.8);
        let avatars = vec![(&model, state); heads];
        stage.renderer.draw(&mut encoder, &view, &stage.targets, &gpu.queue, &scene, &avatars)
    };
    let refused = DrawError::TooManyHeads { found: 6145, limit: 6144 };
    assert_eq!(draw(&state, 6145), Err(refused));
    assert!(refused.to_string().contains("6144") && refused.to_string().contains("6145"));
    assert_eq!(draw(&state, 50), Ok(()));
    // The bald take no room.
    state.set_hair_detail(HairDetail { share: 0.0, ..HairDetail::default() });
    assert_eq!(draw(&state, 6145), Ok(()));
}

#[test]
fn heads_of_one_frame_have_their_own_share_of_strands() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let (model, mut full) = head.with_hair(gpu, CROPPED, 3000.0);
    let mut thin = AvatarState::new(&gpu.device, &model);
    let bones = |x: f32| vec![Affine3A::from_translation(Vec3::X * x); model.palette_len()];
    let weights = vec![0.0; model.shape_count()];
    full.set(&gpu.queue, &bones(-14.0), &weights).expect("lengths fit");
    thin.set(&gpu.queue, &bones(14.0), &weights).expect("lengths fit");
    thin.set_hair_detail(HairDetail { share: 0.1, ..HairDetail::default() });
    let stage = Stage::new(gpu, Quality::Low.shading(avatar_render::Style::Natural), 64, FORMAT);
    // So far apart that their shoulders do not meet.
    let scene = head.scene(0.0, 0.2);
    let drawn = |avatars: &[_]| stage.bytes(gpu, &scene, avatars);
    let both = drawn(&[(&model, &full), (&model, &thin)]);
    assert!(both == drawn(&[(&model, &thin), (&model, &full)]), "the order does not matter");
    // A head that is drawn before does not decide how much hair the next one has.
    let (alike, fuller) = (drawn(&[(&model, &thin)]), drawn(&[(&model, &full)]));
    assert!(alike != fuller && both != alike && both != fuller);
}

#[test]
fn a_view_in_another_format_is_found_out_without_ending_the_program() {
    let Some(gpu) = gpu() else { return };
    let device = &gpu.device;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[FORMAT],
    });
    let in_format = |format| {
        texture.create_view(&wgpu::TextureViewDescriptor { format: Some(format), ..Default::default() })
    };
    for samples in [1, 4] {
        let config = RendererConfig { color_format: FORMAT, samples, shading: Shading::Plain };
        let renderer = Renderer::new(device, &gpu.queue, config).expect("a renderer");
        let targets = Targets::new(device, &renderer, 8, 8).expect("targets");
        let check = |view: &wgpu::TextureView| renderer.check_view(device, view, &targets);
        assert_eq!(check(&in_format(FORMAT)), Ok(()), "{samples}");
        let texture_format = TextureFormat::Rgba8Unorm;
        let refused = DrawError::ViewFormat { format: FORMAT, texture_format };
        assert_eq!(check(&in_format(texture_format)), Err(refused), "{samples}");
        let small = Targets::new(device, &renderer, 7, 8).expect("targets");
        let found = renderer.check_view(device, &in_format(FORMAT), &small);
        assert!(matches!(found, Err(DrawError::View { width: 7, found_width: 8, .. })), "{found:?}");
    }
    assert_eq!(gpu.errors.take(), None);
}

#[test]
fn buffers_may_be_as_large_as_the_adapter_allows() {
    let Some(gpu) = gpu() else { return };
    let (device, adapter) = (gpu.device.limits(), gpu.adapter.limits());
    assert_eq!(device.max_buffer_size, adapter.max_buffer_size);
    assert_eq!(device.max_storage_buffer_binding_size, adapter.max_storage_buffer_binding_size);
    // Sizes of pictures are the same everywhere.
    assert_eq!(device.max_texture_dimension_2d, wgpu::Limits::default().max_texture_dimension_2d);
}

/// A pass that read something before the passes of its own frame wrote it would find there what another frame
/// left.
#[test]
fn passes_read_nothing_that_another_frame_left() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let (haired, of_hair) = head.with_hair(gpu, CROPPED, 3000.0);
    let wide = ball(Vec3::ZERO, 12.0, 16);
    let eye = ball(Vec3::new(2.0, 3.0, 11.0), 4.0, 12);
    let none = PartTextures::default();
    let parts = [part(&wide, PartKind::Skin, none), part(&eye, PartKind::Cornea, none)];
    let (other, of_other) = model(gpu, &parts);
    let (left, right) = (head.scene(0.6, 0.9), head.scene(-0.4, 0.7));
    let lit_otherwise = |scene: Scene| {
        let mut scene = scene;
        scene.light.key.direction_world = Vec3::new(-1.0, 0.2, 0.4);
        scene
    };
    for (name, shading) in shadings() {
        let frames: [(Scene, &[_]); 3] = [
            (left, &[(&haired, &of_hair)]),
            (lit_otherwise(right), &[(&other, &of_other)]),
            (right, &[(&haired, &of_hair), (&other, &of_other)]),
        ];
        let [forward, backward] = [(); 2].map(|()| Stage::new(gpu, shading, 48, FORMAT));
        let draw = |stage: &Stage, (scene, avatars): &(Scene, &[_])| stage.bytes(gpu, scene, avatars);
        let first = [0, 1, 2].map(|frame| draw(&forward, &frames[frame]));
        let last = [2, 1, 0].map(|frame| draw(&backward, &frames[frame]));
        for frame in 0..3 {
            assert!(first[frame] == last[2 - frame], "{name}, frame {frame}");
        }
    }
}
