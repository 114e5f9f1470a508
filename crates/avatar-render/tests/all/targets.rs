//! What pictures are drawn into: backgrounds, sizes, samples, formats; and that equal calls give equal bytes.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::Stage;
use crate::common::{ball, checkered_eye, gpu, model, part, scene, shadings};
use avatar_mesh::PartKind;
use avatar_render::headless::{Canvas, Gpu, RenderImageError, render_image};
use avatar_render::{PartTextures, RendererError, Scene, SeeThrough, linear_from_srgb8, wgpu};
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

/// Bytes of a small texture.
fn bytes(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<u8> {
    let size = wgpu::BufferDescriptor {
        label: None,
        size: 256,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    };
    let buffer = gpu.device.create_buffer(&size);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    gpu.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.expect("mapped"));
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the copy ends");
    buffer.slice(..).get_mapped_range().expect("mapped").to_vec()
}

/// What is half covered has to look half covered once a compositor has blended encoded values, over any
/// background: its colour there is that of the whole, weighted by the coverage.
#[test]
fn a_compositor_gets_encoded_colours_with_or_without_their_weight() {
    use wgpu::TextureFormat::{Bgra8Unorm, Bgra8UnormSrgb, Rgba8Unorm, Rgba8UnormSrgb};
    let Some(gpu) = gpu() else { return };
    let device = &gpu.device;
    // Orange in sRGB, half covered: light weighted by the coverage, as the renderer writes it.
    let srgb = [240u8, 120, 30, 128];
    let [light @ .., coverage] = linear_from_srgb8(srgb);
    let weighted = light.map(|light| light * coverage);
    let encode = |light: f32| match light <= 0.003_130_8 {
        true => 12.92 * light,
        false => 1.055 * light.powf(1.0 / 2.4) - 0.055,
    };
    for (format, is_encoded) in [(Rgba8Unorm, true), (Rgba8UnormSrgb, false)] {
        for target in [Bgra8Unorm, Bgra8UnormSrgb] {
            for premultiplied in [true, false] {
                let mut through = SeeThrough::new(device, format, (3, 2), target, premultiplied);
                through.resize(device, (1, 1));
                let [r, g, b] =
                    weighted.map(|light| f64::from(if is_encoded { encode(light) } else { light }));
                let color = wgpu::Color { r, g, b, a: f64::from(coverage) };
                let shown = device.create_texture(&wgpu::TextureDescriptor {
                    label: None,
                    size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format: target,
                    usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                    view_formats: &[],
                });
                let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
                let mut encoder = device.create_command_encoder(&Default::default());
                clear(&mut encoder, &view(through.texture()), color);
                through.show(&mut encoder, &view(&shown));
                gpu.queue.submit([encoder.finish()]);
                let found = bytes(gpu, &shown);
                let weigh =
                    |byte: u8| if premultiplied { f32::from(byte) * coverage } else { f32::from(byte) };
                let [red, green, blue, alpha] = srgb;
                let expected = [weigh(blue), weigh(green), weigh(red), f32::from(alpha)];
                for (found, expected) in found.iter().zip(expected) {
                    // The picture has 8 bits, and half of its light is dark.
                    let off = (f32::from(*found) - expected).abs();
                    assert!(off <= 2.0, "{format:?} {target:?} {premultiplied}: {found} for {expected}");
                }
            }
        }
    }
}

/// Fills a view with a colour.
fn clear(encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView, color: wgpu::Color) {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(color), store: wgpu::StoreOp::Store };
    let attachment = wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
    let descriptor =
        wgpu::RenderPassDescriptor { color_attachments: &[Some(attachment)], ..Default::default() };
    drop(encoder.begin_render_pass(&descriptor));
}
