//! Nothing that a caller can pass makes the crate panic: every mistake is an error that names both numbers.
#![allow(clippy::panic, reason = "helpers of tests fail the test")]

use crate::common::{
    Random, ball, gpu, largest_difference, model, part, random_mesh, scene, shadings, square,
};
use avatar_mesh::{Mesh, PartKind, Shape};
use avatar_render::headless::{Canvas, Gpu, GpuOptions, NoAdapter, open_blocking};
use avatar_render::{
    AvatarModel, AvatarState, DrawError, Image, ModelError, PartBones, PartDesc, PartProblem, PartTextures,
    Renderer, RendererConfig, RendererError, Shading, Targets,
};
use glam::{Affine3A, Vec3};
use std::sync::OnceLock;
use wgpu::TextureFormat;

/// The GPU with the limits that every device has, whatever the adapter at hand allows.
#[allow(clippy::expect_used, reason = "a helper of tests may fail")]
fn promised() -> Option<&'static Gpu> {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    let gpu = gpu()?;
    Some(GPU.get_or_init(|| {
        let opened = pollster::block_on(gpu.adapter.request_device(&Default::default()));
        let (device, queue) = opened.expect("a device with WebGPU's limits");
        Gpu { device, queue, ..gpu.clone() }
    }))
}

/// What is wrong with a single part.
fn problem(mesh: &Mesh, bones: PartBones, textures: PartTextures<'_>) -> Option<PartProblem> {
    let gpu = promised()?;
    let desc = PartDesc { label: "ear", mesh, first_weight: 0, kind: PartKind::Skin, bones, textures };
    match AvatarModel::new(&gpu.device, &gpu.queue, &[desc], 2) {
        Err(ModelError::Part { label, problem }) => {
            assert_eq!(label, "ear");
            Some(problem)
        }
        other => panic!("expected a problem, found {other:?}"),
    }
}

#[test]
fn meshes_that_contradict_themselves_are_errors() {
    if gpu().is_none() {
        return;
    }
    let good = random_mesh(&mut Random(1), 5, 1, Some(2));
    let none = PartTextures::default();
    let per_vertex = |mesh: &Mesh| problem(mesh, PartBones::PerVertex, none).expect("a GPU");

    let mut bad = good.clone();
    bad.normals.pop();
    assert_eq!(per_vertex(&bad), PartProblem::Count { what: "normals", expected: 5, found: 4 });

    let mut bad = good.clone();
    bad.shapes[0].positions = vec![Vec3::X; 6].into();
    let what = "position offsets of a shape";
    assert_eq!(per_vertex(&bad), PartProblem::Count { what, expected: 5, found: 6 });

    let mut bad = good.clone();
    bad.triangles.push([0, 1, 5]);
    assert_eq!(per_vertex(&bad), PartProblem::Index { triangle: 0, found: 5, vertices: 5 });

    let mut bad = good.clone();
    bad.skinning.as_mut().expect("skinned").bones[3][2] = 2;
    assert_eq!(per_vertex(&bad), PartProblem::VertexBone { vertex: 3, found: 2, palette_len: 2 });

    let bad = Mesh { skinning: None, ..good.clone() };
    assert_eq!(per_vertex(&bad), PartProblem::NoVertexBones);
    let rigid = problem(&bad, PartBones::Rigid(7), none).expect("a GPU");
    assert_eq!(rigid, PartProblem::RigidBone { found: 7, palette_len: 2 });
}

#[test]
fn more_shapes_than_a_binding_holds_are_an_error_with_both_numbers() {
    if gpu().is_none() {
        return;
    }
    let mut mesh = random_mesh(&mut Random(2), 60_000, 1, None);
    mesh.shapes = vec![mesh.shapes[0].clone(); 100];
    let rigid = |mesh: &Mesh| problem(mesh, PartBones::Rigid(0), PartTextures::default()).expect("a GPU");
    let limit = 128 << 20;
    // All of 938 blocks of 64 vertices, for each shape.
    let (count, bytes) = (6_003_200, 144_076_800);
    let what = "shape offsets (in blocks that shapes move)";
    assert_eq!(rigid(&mesh), PartProblem::TooLarge { what, count, bytes, limit });
    assert!(rigid(&mesh).to_string().contains("134217728") && rigid(&mesh).to_string().contains("144076800"));

    // One vertex in ten is still one in every block.
    let tenth = (0..60_000).step_by(10).map(|vertex| (vertex, Vec3::X));
    mesh.shapes = vec![Shape::from_pairs("tenth", 60_000, tenth).expect("vertices of the mesh"); 100];
    assert_eq!(rigid(&mesh), PartProblem::TooLarge { what, count, bytes, limit });
}

#[test]
fn pictures_that_are_not_what_they_claim_are_errors() {
    if gpu().is_none() {
        return;
    }
    let mesh = square(Vec3::ZERO, 1.0);
    for (image, expected, found) in [
        (Image { width: 2, height: 2, rgba: vec![0; 15] }, 16, 15),
        (Image { width: 0, height: 2, rgba: vec![] }, 0, 0),
        (Image { width: u32::MAX, height: u32::MAX, rgba: vec![0; 4] }, u64::MAX, 4),
    ] {
        let textures = PartTextures { gloss: Some(&image), ..PartTextures::default() };
        let problem = problem(&mesh, PartBones::Rigid(0), textures).expect("a GPU");
        let PartProblem::Texture { which: "gloss", error } = problem else { panic!("{problem:?}") };
        assert_eq!((error.expected, error.found), (expected, found));
    }
}

#[test]
fn a_texture_beyond_the_limit_is_shrunk() {
    let Some(gpu) = gpu() else { return };
    let (width, height) = (2 * 8192 + 3, 2);
    let wide = Image { width, height, rgba: [10, 200, 30, 255].repeat((width * height) as usize) };
    let mesh = square(Vec3::ZERO, 1.0);
    let textures = PartTextures { color: Some(&wide), ..PartTextures::default() };
    let parts = [part(&mesh, PartKind::Skin, textures)];
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &parts, 1).expect("a model");
    let state = AvatarState::new(&gpu.device, &model);
    let canvas = Canvas::new(gpu, 16, 16, 1, Shading::Plain).expect("a canvas");
    let [r, g, ..] = canvas.render(gpu, &scene(4.0), &[(&model, &state)]).expect("a picture").pixel(8, 8);
    assert!(g > 2 * r);
}

#[test]
fn a_palette_beyond_the_limit_is_an_error() {
    let Some(gpu) = promised() else { return };
    let found = 3_000_000;
    let refused = AvatarModel::new(&gpu.device, &gpu.queue, &[], found).map(|model| model.palette_len());
    assert_eq!(refused, Err(ModelError::PaletteTooLarge { found, limit: (128 << 20) / 48 }));
}

#[test]
fn a_model_without_parts_or_bones_draws_nothing() {
    let Some(gpu) = gpu() else { return };
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &[], 0).expect("a model");
    let mut state = AvatarState::new(&gpu.device, &model);
    state.set(&gpu.queue, &[], &[]).expect("lengths fit");
    let canvas = Canvas::new(gpu, 4, 4, 1, Shading::Plain).expect("a canvas");
    assert!(canvas.render(gpu, &scene(4.0), &[(&model, &state)]).is_ok());
}

#[test]
fn formats_that_cannot_be_drawn_are_errors() {
    let Some(gpu) = gpu() else { return };
    let build = |color_format, samples| {
        Renderer::new(
            &gpu.device,
            &gpu.queue,
            RendererConfig { color_format, samples, shading: Shading::Plain },
        )
        .map(|renderer| renderer.config().samples)
    };
    for format in [
        TextureFormat::Depth32Float,
        TextureFormat::Rgba8Uint,
        TextureFormat::Bc1RgbaUnorm,
        TextureFormat::Rgba8Snorm,
    ] {
        assert_eq!(build(format, 4), Err(RendererError::Format { found: format, samples: 4 }));
    }
    for format in [
        TextureFormat::Bgra8Unorm,
        TextureFormat::Bgra8UnormSrgb,
        TextureFormat::Rgba16Float,
        TextureFormat::Rgb10a2Unorm,
    ] {
        assert_eq!(build(format, 4), Ok(4), "{format:?}");
    }
}

#[test]
fn things_that_do_not_belong_together_are_refused() {
    let Some(gpu) = gpu() else { return };
    let format = TextureFormat::Rgba8UnormSrgb;
    let renderer = |samples| {
        Renderer::new(
            &gpu.device,
            &gpu.queue,
            RendererConfig { color_format: format, samples, shading: Shading::Plain },
        )
        .expect("a renderer")
    };
    let (one, four) = (renderer(1), renderer(4));
    let targets = Targets::new(&gpu.device, &one, 8, 8).expect("targets");
    let texture = |width, format, usage| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height: 8, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    let draw = |renderer: &Renderer, texture: &wgpu::Texture, avatars: &[(&AvatarModel, &AvatarState)]| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let view = texture.create_view(&Default::default());
        renderer.draw(&mut encoder, &view, &targets, &gpu.queue, &scene(4.0), avatars)
    };
    let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let good = texture(8, format, attachment);
    assert_eq!(draw(&one, &good, &[]), Ok(()));
    assert_eq!(draw(&four, &good, &[]), Err(DrawError::TargetsOfAnotherRenderer));
    for bad in [
        texture(9, format, attachment),
        texture(8, TextureFormat::Rgba16Float, attachment),
        texture(8, format, wgpu::TextureUsages::TEXTURE_BINDING),
    ] {
        assert!(matches!(draw(&one, &bad, &[]), Err(DrawError::View { .. })));
    }
    let small = AvatarModel::new(&gpu.device, &gpu.queue, &[], 1).expect("a model");
    let large = AvatarModel::new(&gpu.device, &gpu.queue, &[], 2).expect("a model");
    let (small_state, large_state) =
        (AvatarState::new(&gpu.device, &small), AvatarState::new(&gpu.device, &large));
    let mixed = [(&small, &small_state), (&small, &large_state)];
    assert_eq!(draw(&one, &good, &mixed), Err(DrawError::StateOfAnotherModel { avatar: 1 }));
}

#[test]
fn numbers_that_are_not_finite_draw_something_or_nothing_but_never_fail() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 6);
    let parts = [PartKind::Skin, PartKind::Cornea].map(|kind| part(&mesh, kind, PartTextures::default()));
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &parts, 1).expect("a model");
    let mut state = AvatarState::new(&gpu.device, &model);
    for (name, shading) in shadings() {
        let canvas = Canvas::new(gpu, 8, 8, 1, shading).expect("a canvas");
        for bad in [f32::NAN, f32::INFINITY, 1e38] {
            state.set(&gpu.queue, &[Affine3A::from_translation(Vec3::splat(bad))], &[]).expect("lengths fit");
            let mut scene = scene(bad);
            scene.light.key.direction_world = Vec3::splat(bad);
            scene.light.environment.sky = [bad; 3];
            scene.background = [bad; 4];
            assert!(canvas.render(gpu, &scene, &[(&model, &state)]).is_ok(), "{name}, {bad}");
        }
    }
}

#[test]
fn an_avatar_that_is_nowhere_leaves_the_others_as_they_are() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 16);
    let (model, good) = model(gpu, &[part(&mesh, PartKind::Skin, PartTextures::default())]);
    let mut lost = AvatarState::new(&gpu.device, &model);
    for (name, shading) in shadings() {
        let canvas = Canvas::new(gpu, 48, 48, 1, shading).expect("a canvas");
        let scene = scene(4.0);
        let alone = canvas.render(gpu, &scene, &[(&model, &good)]).expect("a picture");
        for bad in [f32::NAN, f32::INFINITY] {
            lost.set(&gpu.queue, &[Affine3A::from_translation(Vec3::splat(bad))], &[]).expect("lengths fit");
            let both = canvas.render(gpu, &scene, &[(&model, &good), (&model, &lost)]).expect("a picture");
            assert!(largest_difference(&alone, &both) <= 1, "{name}, {bad}");
        }
    }
}

#[test]
fn without_a_backend_there_is_no_adapter_and_the_error_says_what_was_looked_for() {
    let nothing = GpuOptions { backends: wgpu::Backends::empty(), software: true };
    let error = open_blocking(nothing).expect_err("no backends, no adapter");
    assert!(matches!(error, NoAdapter::NotFound { .. }));
    assert!(error.to_string().contains("software"), "{error}");
}

#[test]
fn errors_of_the_device_are_kept_instead_of_panicking() {
    if gpu().is_none() {
        return;
    }
    // A device of its own: the errors of the shared one belong to other tests.
    let gpu = open_blocking(GpuOptions::default()).expect("opened before");
    // Storage without COPY_DST cannot be written to.
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 16,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, &[0; 4]);
    assert!(gpu.errors.take().is_some());
    assert!(gpu.errors.take().is_none());
}
