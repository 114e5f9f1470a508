//! Drafts beside the whole picture: the same face in the same place.
#![allow(clippy::expect_used, reason = "a test may fail")]

mod common;

use avatar_stage::avatar_pack::FaceState;
use avatar_stage::avatar_render::avatar_groom::Hair;
use avatar_stage::avatar_render::headless::Gpu;
use avatar_stage::avatar_render::{
    AvatarState, HairDetail, Quality, Renderer, RendererConfig, Style, Targets,
};
use avatar_stage::{BACKGROUND, Drafts, Pace, SAMPLES, View, portrait, upload_with_hair, wgpu};
use common::{gpu, pack, textures};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const SIZE: (u32, u32) = (512, 288);

fn texture(gpu: &Gpu) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("test"),
        size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Submits, and returns the pixels; a row has 2048 bytes.
fn pixels(gpu: &Gpu, mut encoder: wgpu::CommandEncoder, texture: &wgpu::Texture) -> Vec<u8> {
    let readable = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("test"),
        size: u64::from(4 * SIZE.0 * SIZE.1),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.0), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &readable, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    gpu.queue.submit([encoder.finish()]);
    readable.map_async(wgpu::MapMode::Read, .., |result| result.expect("mapped"));
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("polled");
    readable.get_mapped_range(..).expect("mapped").to_vec()
}

/// The mean difference of colours, 0 to 255, over pixels of the picture that are not mere background.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        let is_background = [a, b].iter().all(|p| (0..3).all(|c| p[c].abs_diff(BACKGROUND[c]) < 3));
        if !is_background {
            sum += (0..3).map(|c| f64::from(a[c].abs_diff(b[c]))).sum::<f64>() / 3.0;
            count += 1.0;
        }
    }
    sum / f64::max(count, 1.0)
}

#[test]
fn drafts_show_the_same_face_in_the_same_place() {
    let Some(gpu) = gpu() else { return };
    let (pack, hair) = (pack(), Hair::default());
    let (device, queue) = (&gpu.device, &gpu.queue);
    let model = upload_with_hair(device, queue, pack, textures(), Some(&hair)).expect("a model");
    let mut avatar = AvatarState::new(device, &model);
    let shading = Quality::Low.shading(Style::Natural);
    let config = RendererConfig { color_format: FORMAT, samples: SAMPLES, shading };
    let renderer = Renderer::new(device, queue, config).expect("a renderer");
    let targets = Targets::new(device, &renderer, SIZE.0, SIZE.1).expect("targets");
    let texture = texture(&gpu);
    let view = texture.create_view(&Default::default());
    let encoder = || device.create_command_encoder(&Default::default());
    let aspect = SIZE.0 as f32 / SIZE.1 as f32;
    let scene = portrait(pack, aspect);
    let whole = |avatar: &AvatarState, scene| {
        let mut encoder = encoder();
        renderer.draw(&mut encoder, &view, &targets, queue, scene, &[(&model, avatar)]).expect("recorded");
        pixels(&gpu, encoder, &texture)
    };
    let front = whole(&avatar, &scene);
    let aside = View { yaw_degrees: 12.0, ..View::FRONT };
    let aside = whole(&avatar, &aside.scene(pack, aspect, BACKGROUND, scene.light));
    let elsewhere = difference(&front, &aside);

    let mut drafts = Drafts::new(device, FORMAT, shading);
    let mut differences = Vec::new();
    for step in Pace::STEPS {
        avatar.set_hair_detail(HairDetail { draft: Some(step.strands), ..HairDetail::default() });
        let mut draw = || {
            let mut encoder = encoder();
            let avatars = [(&model, &avatar)];
            let was_there = drafts.draw((device, queue), &mut encoder, step, SIZE, &scene, &avatars, None);
            drafts.show(device, &mut encoder, &view);
            (was_there.expect("recorded"), pixels(&gpu, encoder, &texture))
        };
        let (first, again) = (draw(), draw());
        assert!(again.0, "{step:?}: all of it was there");
        assert_eq!(first.1, again.1, "{step:?}: the same again");
        differences.push(difference(&front, &again.1));
    }
    println!("steps {differences:.2?}, turned by 12 degrees {elsewhere:.2}");
    for difference in &differences {
        assert!(*difference < 0.75 * elsewhere, "{differences:?} beside {elsewhere}");
    }
    assert_eq!(gpu.errors.take(), None);
}

#[test]
fn a_smile_waits_for_nothing_after_a_rehearsal() {
    let Some(gpu) = gpu() else { return };
    let pack = pack();
    let (device, queue) = (&gpu.device, &gpu.queue);
    let model = upload_with_hair(device, queue, pack, textures(), None).expect("a model");
    let [rest, mut smiling] = [(); 2].map(|()| AvatarState::new(device, &model));
    let mut weights = vec![0.0; pack.shapes().len()];
    let brow =
        pack.wrinkles().iter().flat_map(|place| &place.shapes).next().expect("a shape with wrinkles").0;
    weights[brow] = 1.0;
    let face = FaceState::new(pack);
    smiling.set(queue, face.bones(), &weights).expect("a pose");
    let (scene, step) = (portrait(pack, SIZE.0 as f32 / SIZE.1 as f32), Pace::STEPS[0]);
    for rehearses in [false, true] {
        let mut drafts = Drafts::new(device, FORMAT, Quality::Low.shading(Style::Natural));
        let mut encoder = device.create_command_encoder(&Default::default());
        let (at, encoder) = ((device, queue), &mut encoder);
        if rehearses {
            drafts.rehearse(at, encoder, step, SIZE, &scene, &[(&model, &rest)]).expect("recorded");
        } else {
            drafts.draw(at, encoder, step, SIZE, &scene, &[(&model, &rest)], None).expect("recorded");
        }
        for (avatar, is_known) in [(&rest, true), (&smiling, rehearses), (&smiling, true)] {
            let was_there = drafts.draw(at, encoder, step, SIZE, &scene, &[(&model, avatar)], None);
            assert_eq!(was_there.expect("recorded"), is_known, "{rehearses}");
        }
    }
    assert_eq!(gpu.errors.take(), None);
}
