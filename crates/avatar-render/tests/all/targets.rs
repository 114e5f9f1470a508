//! What pictures are drawn into: backgrounds, sizes, samples, formats; and that equal calls give equal bytes.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::Stage;
use crate::common::{ball, checkered_eye, gpu, model, part, scene, shadings};
use avatar_mesh::PartKind;
use avatar_render::headless::{Canvas, RenderImageError, render_image};
use avatar_render::{PartTextures, RendererError, Scene};
use glam::Vec3;

const SIZE: u32 = 64;

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
    for (width, height) in [(1, 1), (63, 1), (65, 33)] {
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
fn the_same_call_gives_the_same_bytes() {
    let Some(gpu) = gpu() else { return };
    let (model, state) = checkered_eye(gpu, true);
    let draw = || render_image(gpu, 100, 75, 4, &scene(5.0), &[(&model, &state)]).expect("a picture");
    assert_eq!(draw(), draw());
}

#[test]
fn frames_of_every_shading_are_repeatable_on_one_renderer_and_on_another() {
    let Some(gpu) = gpu() else { return };
    let head = ball(Vec3::new(0.0, 0.0, -1.5), 1.2, 16);
    let (model, state) = {
        let skin = part(&head, PartKind::Skin, PartTextures::default());
        model(gpu, &[skin, part(&ball(Vec3::ZERO, 0.4, 12), PartKind::Eyeball, PartTextures::default())])
    };
    for (name, shading) in shadings() {
        let pictures = [0, 1].map(|_| {
            let canvas = Canvas::new(gpu, SIZE, SIZE, 4, shading).expect("a canvas");
            let draw = || canvas.render(gpu, &scene(6.0), &[(&model, &state)]).expect("a picture");
            let first = draw();
            assert_eq!(first, draw(), "{name}");
            first
        });
        assert_eq!(pictures[0], pictures[1], "{name}");
    }
}

#[test]
fn targets_without_srgb_get_encoded_colours() {
    let Some(gpu) = gpu() else { return };
    let eye = ball(Vec3::ZERO, 1.0, 16);
    let (model, state) = model(gpu, &[part(&eye, PartKind::Eyeball, PartTextures::default())]);
    let scene = Scene { background: [0.1, 0.3, 0.6, 1.0], ..scene(4.0) };
    for (name, shading) in shadings() {
        let draw = |format| Stage::new(gpu, shading, SIZE, format).bytes(gpu, &scene, &[(&model, &state)]);
        let by_hardware = draw(wgpu::TextureFormat::Rgba8UnormSrgb);
        let by_shader = draw(wgpu::TextureFormat::Rgba8Unorm);
        let largest = by_hardware.iter().zip(&by_shader).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(largest <= Some(1), "{name}: {largest:?}");
    }
}

#[test]
fn formats_with_fewer_channels_hold_the_same_values() {
    use wgpu::TextureFormat::{R8Unorm, Rg8Unorm, Rgba8Unorm};
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 16);
    let (model, state) = model(gpu, &[part(&mesh, PartKind::Surface, PartTextures::default())]);
    let scene = Scene { background: [0.2, 0.3, 0.4, 1.0], ..scene(4.0) };
    let [one, two, four] = [R8Unorm, Rg8Unorm, Rgba8Unorm].map(|format| {
        let stage = Stage::new(gpu, shadings()[0].1, 32, format);
        stage.bytes(gpu, &scene, &[(&model, &state)])
    });
    let of_four = |channels: usize| four.chunks_exact(4).flat_map(move |p| p[..channels].to_vec());
    assert!(one.iter().copied().eq(of_four(1)), "{:?}", &one[..4]);
    assert!(two.iter().copied().eq(of_four(2)), "{:?}", &two[..4]);
}
