//! What pictures show: winding, blending, background, sizes, samples, several avatars, order.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

mod common;

use avatar_mesh::{Mesh, PartKind};
use avatar_render::headless::{Canvas, RenderImageError, render_image};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Image, Lamp, Material, PartBones, PartDesc, PartTextures, Renderer,
    RendererConfig, RendererError, Scene, Shading, Targets,
};
use common::{ball, flat_light, gpu, largest_difference, model, part, plain, scene, square};
use glam::{Affine3A, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

const SIZE: u32 = 64;

/// The mesh mirrored at x = 0 with the indices of the original: every triangle contradicts its normals.
fn mirrored(mesh: &Mesh) -> Mesh {
    let flip = |v: &Vec3| Vec3::new(-v.x, v.y, v.z);
    Mesh {
        positions: mesh.positions.iter().map(flip).collect(),
        normals: mesh.normals.iter().map(flip).collect(),
        ..mesh.clone()
    }
}

fn flipped(image: &Image) -> Image {
    let pixels = (0..image.height).flat_map(|y| (0..image.width).rev().map(move |x| (x, y)));
    Image { rgba: pixels.flat_map(|(x, y)| image.pixel(x, y)).collect(), ..image.clone() }
}

#[test]
fn a_mirrored_eye_with_the_indices_of_the_other_is_its_mirror_picture() {
    let Some(gpu) = gpu() else { return };
    let left = ball(Vec3::new(0.3, 0.1, 0.0), 0.9, 12);
    let right = mirrored(&left);
    let mut scene = scene(4.0);
    // Light that is its own mirror picture.
    for lamp in [&mut scene.light.key, &mut scene.light.fill, &mut scene.light.rim] {
        lamp.direction_world.x = 0.0;
    }
    for kind in [PartKind::Eyeball, PartKind::Cornea, PartKind::Skin] {
        let pictures = [&left, &right].map(|mesh| {
            let (model, state) = model(gpu, &[part(mesh, kind, PartTextures::default())]);
            render_image(gpu, SIZE, SIZE, 1, &scene, &[(&model, &state)]).expect("a picture")
        });
        assert!(pictures[0].rgba.iter().any(|v| *v > 20 && *v < 255), "{kind:?} is visible");
        let differing = flipped(&pictures[1]);
        let differing = differing.rgba.iter().zip(&pictures[0].rgba).filter(|(a, b)| a.abs_diff(**b) > 3);
        // Pixels on an edge may fall to either side.
        assert!(differing.count() < (SIZE * SIZE / 100) as usize, "{kind:?}");
    }
}

#[test]
fn every_view_shows_the_side_that_faces_it() {
    let Some(gpu) = gpu() else { return };
    // Six plates around the origin; each colour belongs to a direction.
    let red = plain([255, 0, 0, 255]);
    let green = plain([0, 255, 0, 255]);
    let blue = plain([0, 0, 255, 255]);
    let front = square(Vec3::new(0.0, 0.0, 1.0), 1.0);
    let turned = |turn: Affine3A| Mesh {
        positions: front.positions.iter().map(|p| turn.transform_point3(*p)).collect(),
        normals: front.normals.iter().map(|n| turn.transform_vector3(*n)).collect(),
        ..front.clone()
    };
    let left = turned(Affine3A::from_rotation_y(FRAC_PI_2));
    let top = turned(Affine3A::from_rotation_x(-FRAC_PI_2));
    let textured = |image| PartTextures { color: Some(image), ..PartTextures::default() };
    let parts = [
        part(&front, PartKind::Eyeball, textured(&red)),
        part(&left, PartKind::Eyeball, textured(&green)),
        part(&top, PartKind::Eyeball, textured(&blue)),
    ];
    let (model, state) = model(gpu, &parts);
    let views = [
        (0.0, 0.0, Some(0)),
        (FRAC_PI_2, 0.0, Some(1)),
        (0.0, FRAC_PI_2, Some(2)),
        // From behind, from the right and from below only backs are there, which eyeballs do not show; behind them
        // are the insides of the opposite plates, culled as well.
        (PI, 0.0, None),
        (-FRAC_PI_2, 0.0, None),
        (0.0, -FRAC_PI_2, None),
    ];
    for (yaw, pitch, expected) in views {
        let camera = Camera::orbit(Vec3::ZERO, 5.0, yaw, pitch, 0.6, 1.0);
        let scene = Scene { camera, light: flat_light(), ..scene(5.0) };
        let picture = render_image(gpu, SIZE, SIZE, 1, &scene, &[(&model, &state)]).expect("a picture");
        let pixel = picture.pixel(SIZE / 2, SIZE / 2);
        for channel in 0..3 {
            let bright = pixel[channel] > 100;
            assert_eq!(bright, expected == Some(channel), "yaw {yaw}, pitch {pitch}: {pixel:?}");
        }
    }
}

#[test]
fn skin_and_teeth_are_seen_from_behind_and_teeth_are_lit_there() {
    let Some(gpu) = gpu() else { return };
    let sheet = square(Vec3::ZERO, 1.0);
    let mut scene = scene(5.0);
    scene.light.key = Lamp { direction_world: Vec3::NEG_Z, radiance: [1.0; 3] };
    scene.camera = Camera::orbit(Vec3::ZERO, 5.0, PI, 0.0, 0.6, 1.0);
    let seen = |kind| {
        let (model, state) = model(gpu, &[part(&sheet, kind, PartTextures::default())]);
        let picture = render_image(gpu, SIZE, SIZE, 1, &scene, &[(&model, &state)]).expect("a picture");
        picture.pixel(SIZE / 2, SIZE / 2)[0]
    };
    assert!(seen(PartKind::Teeth) > 180);
    // The inside of the skin is a hollow: dark, but there.
    assert!((15..100).contains(&seen(PartKind::Skin)), "{}", seen(PartKind::Skin));
}

/// A checkered plate as an iris, and a cornea in front of it.
fn eye(gpu: &avatar_render::headless::Gpu, with_cornea: bool) -> (AvatarModel, AvatarState) {
    let iris = square(Vec3::new(0.0, 0.0, -0.2), 1.5);
    let cornea = ball(Vec3::new(0.0, 0.0, -0.9), 1.2, 24);
    let checker = Image {
        width: 2,
        height: 2,
        rgba: [[200, 30, 30, 255], [20, 40, 200, 255], [20, 40, 200, 255], [200, 30, 30, 255]].concat(),
    };
    let textures = PartTextures { color: Some(&checker), ..PartTextures::default() };
    let mut parts = vec![part(&iris, PartKind::Eyeball, textures)];
    if with_cornea {
        // Given first: the order of the parts does not decide about the order of drawing.
        parts.insert(0, part(&cornea, PartKind::Cornea, PartTextures::default()));
    }
    model(gpu, &parts)
}

#[test]
fn the_iris_is_seen_through_the_cornea_and_the_highlight_is_bright() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene(6.0);
    scene.light.key.direction_world = Vec3::new(0.2, 0.2, 1.0);
    let [bare, covered] = [false, true].map(|with_cornea| {
        let (model, state) = eye(gpu, with_cornea);
        render_image(gpu, 128, 128, 4, &scene, &[(&model, &state)]).expect("a picture")
    });
    let brightest = |image: &Image| {
        (0..128)
            .flat_map(|y| (0..128).map(move |x| (x, y)))
            .map(|(x, y)| image.pixel(x, y)[..3].iter().min().copied().unwrap_or(0))
            .max()
    };
    assert!(brightest(&bare) < Some(120), "{:?}", brightest(&bare));
    assert!(brightest(&covered) > Some(225), "{:?}", brightest(&covered));
    // Away from highlights the cornea changes the iris a little, and hides neither red nor blue.
    let (lower_left, lower_right) = ((50, 78), (78, 78));
    for (x, y) in [lower_left, lower_right] {
        let (behind, seen) = (bare.pixel(x, y), covered.pixel(x, y));
        assert_ne!(behind, seen, "the cornea covers the iris");
        for channel in 0..3 {
            assert!(behind[channel].abs_diff(seen[channel]) < 45, "{behind:?} {seen:?}");
        }
        assert_eq!(behind[0] > behind[2], seen[0] > seen[2]);
    }
}

#[test]
fn a_cornea_behind_the_skin_is_hidden_and_hides_nothing_itself() {
    let Some(gpu) = gpu() else { return };
    let lid = square(Vec3::new(0.0, 0.0, 1.0), 1.0);
    let cornea = ball(Vec3::ZERO, 0.5, 8);
    let skin = part(&lid, PartKind::Skin, PartTextures::default());
    let (closed, closed_state) =
        model(gpu, &[part(&cornea, PartKind::Cornea, PartTextures::default()), skin]);
    let (alone, alone_state) = model(gpu, &[skin]);
    let draw =
        |model, state| render_image(gpu, SIZE, SIZE, 1, &scene(5.0), &[(model, state)]).expect("picture");
    assert_eq!(draw(&closed, &closed_state), draw(&alone, &alone_state));
}

#[test]
fn the_background_is_as_asked_and_may_be_transparent() {
    let Some(gpu) = gpu() else { return };
    let eye = ball(Vec3::ZERO, 0.6, 16);
    let (model, state) = model(gpu, &[part(&eye, PartKind::Eyeball, PartTextures::default())]);
    for samples in [1, 4] {
        let with = |background| Scene { background, ..scene(4.0) };
        let draw = |scene: &Scene| {
            render_image(gpu, SIZE, SIZE, samples, scene, &[(&model, &state)]).expect("a picture")
        };
        let clear = draw(&with([0.0; 4]));
        assert_eq!(clear.pixel(0, 0), [0; 4]);
        assert_eq!(clear.pixel(SIZE / 2, SIZE / 2)[3], 255);
        // Straight alpha: pixels on the edge have the colour of the ball, not a darker one.
        let partial = clear.rgba.chunks_exact(4).filter(|p| (1..255).contains(&p[3]));
        assert_eq!(partial.clone().count() > 0, samples == 4);
        assert!(partial.clone().all(|p| p[0].max(p[1]).max(p[2]) > 40));
        // sRGB 188 is half the light; half transparent, it stays that colour.
        let half = draw(&with([0.5, 0.5, 0.5, 0.5]));
        let [r, g, b, a] = half.pixel(0, 0);
        assert!(r.abs_diff(188) <= 1 && g == r && b == r && a.abs_diff(128) <= 1, "{:?}", half.pixel(0, 0));
        assert_eq!(draw(&with([0.0, 1.0, 0.0, 1.0])).pixel(0, 0), [0, 255, 0, 255]);
    }
}

#[test]
fn odd_sizes_are_drawn_and_impossible_ones_are_errors() {
    let Some(gpu) = gpu() else { return };
    let eye = ball(Vec3::ZERO, 0.6, 8);
    let (model, state) = model(gpu, &[part(&eye, PartKind::Eyeball, PartTextures::default())]);
    for (width, height) in [(1, 1), (1, 77), (63, 1), (65, 33), (127, 3), (300, 200)] {
        for samples in [1, 4] {
            let picture = render_image(gpu, width, height, samples, &scene(4.0), &[(&model, &state)])
                .expect("a picture");
            assert_eq!((picture.width, picture.height), (width, height));
            assert!(picture.check().is_ok());
            if width > 2 && height > 2 {
                assert!(picture.pixel(width / 2, height / 2)[0] > 50, "{width}×{height}");
            }
        }
    }
    for (width, height) in [(0, 10), (10, 0), (100_000, 1)] {
        let refused = render_image(gpu, width, height, 1, &scene(4.0), &[]);
        assert!(matches!(refused, Err(RenderImageError::Size(_))), "{refused:?}");
    }
    for found in [0, 2, 3, 8] {
        let refused = render_image(gpu, 8, 8, found, &scene(4.0), &[]);
        assert_eq!(refused, Err(RenderImageError::Renderer(RendererError::Samples { found })));
    }
}

#[test]
fn four_samples_smooth_the_edge_and_nothing_else() {
    let Some(gpu) = gpu() else { return };
    let eye = ball(Vec3::ZERO, 1.0, 24);
    let (model, state) = model(gpu, &[part(&eye, PartKind::Eyeball, PartTextures::default())]);
    let [one, four] = [1, 4].map(|samples| {
        render_image(gpu, SIZE, SIZE, samples, &scene(4.0), &[(&model, &state)]).expect("a picture")
    });
    assert_ne!(one, four);
    let differing = one.rgba.iter().zip(&four.rgba).filter(|(a, b)| a.abs_diff(**b) > 12).count();
    assert!(differing < 4 * (SIZE * 4) as usize, "{differing} values differ");
}

#[test]
fn two_avatars_of_one_model_have_their_own_states() {
    let Some(gpu) = gpu() else { return };
    let mut mesh = ball(Vec3::ZERO, 0.6, 12);
    let swollen = mesh.normals.iter().map(|n| *n * 0.5).collect();
    let calm = vec![Vec3::ZERO; mesh.normals.len()];
    mesh.shapes.push(avatar_mesh::Shape { name: "swell".to_owned(), positions: swollen, normals: calm });
    let (model, mut small) = model(gpu, &[part(&mesh, PartKind::Skin, PartTextures::default())]);
    let mut large = AvatarState::new(&gpu.device, &model);
    let at = |x: f32| [Affine3A::from_translation(Vec3::new(x, 0.0, 0.0))];
    small.set(&gpu.queue, &at(-1.2), &[0.0]).expect("lengths fit");
    large.set(&gpu.queue, &at(1.2), &[1.0]).expect("lengths fit");
    let canvas = Canvas::new(gpu, 128, 64, 1, Shading::Plain).expect("a canvas");
    let scene = Scene { camera: Camera::orbit(Vec3::ZERO, 8.0, 0.0, 0.0, 0.5, 2.0), ..scene(8.0) };
    let both = canvas.render(gpu, &scene, &[(&model, &small), (&model, &large)]).expect("a picture");
    let covered = |columns: std::ops::Range<u32>| {
        columns.flat_map(|x| (0..64).map(move |y| (x, y))).filter(|(x, y)| both.pixel(*x, *y)[0] > 10).count()
    };
    let (left, right) = (covered(0..64), covered(64..128));
    // Radius 0.6 against 1.1.
    assert!(left > 100 && (2.8..4.0).contains(&(right as f32 / left as f32)), "{left} {right}");
    // Each alone is its half of the picture.
    let alone = canvas.render(gpu, &scene, &[(&model, &small)]).expect("a picture");
    assert!((0..64).all(|x| (0..64).all(|y| alone.pixel(x, y) == both.pixel(x, y))));
}

#[test]
fn the_order_of_avatars_and_parts_does_not_matter() {
    let Some(gpu) = gpu() else { return };
    let (first, mut near) = eye(gpu, true);
    let (second, mut far) = eye(gpu, true);
    let place = |x: f32, z: f32| [Affine3A::from_translation(Vec3::new(x, 0.0, z))];
    near.set(&gpu.queue, &place(-0.3, 1.0), &[]).expect("lengths fit");
    far.set(&gpu.queue, &place(0.4, -1.0), &[]).expect("lengths fit");
    let canvas = Canvas::new(gpu, SIZE, SIZE, 4, Shading::Plain).expect("a canvas");
    let draw = |avatars: &[(&AvatarModel, &AvatarState)]| {
        canvas.render(gpu, &scene(6.0), avatars).expect("a picture")
    };
    let one_way = draw(&[(&first, &near), (&second, &far)]);
    assert_eq!(one_way, draw(&[(&second, &far), (&first, &near)]));
    assert_ne!(one_way, draw(&[(&first, &near)]));
}

#[test]
fn the_same_call_gives_the_same_bytes() {
    let Some(gpu) = gpu() else { return };
    let (model, state) = eye(gpu, true);
    let draw = || render_image(gpu, 100, 75, 4, &scene(5.0), &[(&model, &state)]).expect("a picture");
    assert_eq!(draw(), draw());
}

#[test]
fn targets_without_srgb_get_encoded_colours() {
    let Some(gpu) = gpu() else { return };
    let eye = ball(Vec3::ZERO, 1.0, 16);
    let (model, state) = model(gpu, &[part(&eye, PartKind::Eyeball, PartTextures::default())]);
    let scene = Scene { background: [0.1, 0.3, 0.6, 1.0], ..scene(4.0) };
    let expected = render_image(gpu, SIZE, SIZE, 1, &scene, &[(&model, &state)]).expect("a picture");
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let config = RendererConfig { color_format: format, samples: 1, shading: Shading::Plain };
    let renderer = Renderer::new(&gpu.device, &gpu.queue, config).expect("a renderer");
    let targets = Targets::new(&gpu.device, &renderer, SIZE, SIZE).expect("targets");
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let readable = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIZE * SIZE * 4),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let view = texture.create_view(&Default::default());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer.draw(&mut encoder, &view, &targets, &gpu.queue, &scene, &[(&model, &state)]).expect("recorded");
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE * 4), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &readable, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    gpu.queue.submit([encoder.finish()]);
    readable.map_async(wgpu::MapMode::Read, .., |result| result.expect("mapped"));
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("polled");
    let rgba = readable.get_mapped_range(..).expect("mapped").to_vec();
    let found = Image { width: SIZE, height: SIZE, rgba };
    assert!(largest_difference(&found, &expected) <= 1);
}

#[test]
fn textures_repeat_and_the_origin_is_at_the_top_left() {
    let Some(gpu) = gpu() else { return };
    let mut mesh = square(Vec3::ZERO, 1.0);
    let texture = Image {
        width: 2,
        height: 2,
        rgba: [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [90, 90, 90, 255]].concat(),
    };
    let draw = |mesh: &Mesh| {
        let textures = PartTextures { color: Some(&texture), ..PartTextures::default() };
        let (model, state) = model(gpu, &[part(mesh, PartKind::Teeth, textures)]);
        let scene = Scene { light: flat_light(), ..scene(4.0) };
        render_image(gpu, SIZE, SIZE, 1, &scene, &[(&model, &state)]).expect("a picture")
    };
    let once = draw(&mesh);
    let largest = |p: [u8; 4]| (0..3).max_by_key(|c| p[*c]);
    assert_eq!(largest(once.pixel(20, 20)), Some(0), "red at the top left");
    assert_eq!(largest(once.pixel(44, 20)), Some(1), "green at the top right");
    assert_eq!(largest(once.pixel(20, 44)), Some(2), "blue at the bottom left");
    mesh.uvs.iter_mut().for_each(|uv| *uv += glam::Vec2::new(5.0, -3.0));
    assert!(largest_difference(&draw(&mesh), &once) <= 1);
}

#[test]
fn occlusion_darkens_and_a_transparent_texture_shows_the_material() {
    let Some(gpu) = gpu() else { return };
    let mesh = square(Vec3::ZERO, 1.0);
    let draw = |textures: PartTextures<'_>| {
        let (model, state) = model(gpu, &[part(&mesh, PartKind::Skin, textures)]);
        let scene = Scene { light: flat_light(), ..scene(4.0) };
        render_image(gpu, SIZE, SIZE, 1, &scene, &[(&model, &state)]).expect("a picture").pixel(32, 32)
    };
    let (dark, clear) = (plain([60, 60, 60, 255]), plain([0, 255, 0, 0]));
    let bare = draw(PartTextures::default());
    let occluded = draw(PartTextures { occlusion: Some(&dark), ..PartTextures::default() });
    assert!(occluded[0] < bare[0] / 2 + 20, "{occluded:?} {bare:?}");
    assert_eq!(draw(PartTextures { color: Some(&clear), ..PartTextures::default() }), bare);
}

#[test]
fn a_material_can_be_replaced() {
    let Some(gpu) = gpu() else { return };
    let mesh = square(Vec3::ZERO, 1.0);
    let (model, state) = model(gpu, &[part(&mesh, PartKind::Skin, PartTextures::default())]);
    let green = Material { color: [0.0, 0.5, 0.0], ..Material::of(PartKind::Skin) };
    assert!(model.set_material(&gpu.queue, 0, &green));
    assert!(!model.set_material(&gpu.queue, 1, &green));
    let picture = render_image(gpu, SIZE, SIZE, 1, &scene(4.0), &[(&model, &state)]).expect("a picture");
    let [r, g, ..] = picture.pixel(32, 32);
    assert!(g > 2 * r, "{:?}", picture.pixel(32, 32));
}

#[test]
fn a_part_without_triangles_is_invisible() {
    let Some(gpu) = gpu() else { return };
    let cloud = Mesh { triangles: Vec::new(), ..square(Vec3::ZERO, 1.0) };
    let empty = Mesh::default();
    let skin = PartDesc {
        label: "nothing",
        mesh: &empty,
        kind: PartKind::Skin,
        bones: PartBones::Rigid(0),
        textures: PartTextures::default(),
    };
    let (model, state) = model(gpu, &[part(&cloud, PartKind::Cornea, PartTextures::default()), skin]);
    let picture = render_image(gpu, 8, 8, 4, &scene(4.0), &[(&model, &state)]).expect("a picture");
    assert!(picture.rgba.chunks_exact(4).all(|p| p == [0, 0, 0, 255]));
}
