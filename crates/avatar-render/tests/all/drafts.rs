//! Hair that is drawn coarsely, while something moves: as much of it and as light as fine hair.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::gpu;
use crate::common::head::{COMBED_BACK, CROPPED, Head, LONG_BACK, canvas, linear};
use avatar_render::headless::{Canvas, Gpu};
use avatar_render::{AvatarModel, AvatarState, HairDetail, Scene};
use glam::{Affine3A, Vec3};

const FINE: HairDetail = HairDetail { share: 1.0, is_automatic: false, least_pixels: 1.0, draft: None };
const DRAFT: HairDetail = HairDetail { draft: Some(2000), ..FINE };
const BALD: HairDetail = HairDetail { share: 0.0, ..FINE };

fn draw(
    gpu: &Gpu,
    canvas: &Canvas,
    scene: &Scene,
    avatars: &[(&AvatarModel, &AvatarState)],
) -> Vec<[f32; 4]> {
    linear(&canvas.render(gpu, scene, avatars).expect("a picture"))
}

#[test]
fn drafts_cover_as_much_as_fine_strands_and_are_as_light() {
    const SIZE: u32 = 128;
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    for (name, style) in [("bob", COMBED_BACK), ("short", CROPPED), ("long", LONG_BACK)] {
        let (model, mut state) = head.with_hair(gpu, style, 60_000.0);
        for (samples, yaw) in [(1, 0.0), (1, 1.3), (4, 0.0)] {
            let canvas = canvas(gpu, SIZE, samples);
            let scene = head.scene(yaw, 0.6);
            let mut picture = |detail| {
                state.set_hair_detail(detail);
                draw(gpu, &canvas, &scene, &[(&model, &state)])
            };
            let [bare, fine, draft] = [BALD, FINE, DRAFT].map(&mut picture);
            assert_eq!(picture(DRAFT), draft, "the same again");
            // Beside the head, where nothing but hair hides the background.
            let area = |with: &[[f32; 4]]| with.iter().zip(&bare).map(|(a, b)| a[3] - b[3]).sum::<f32>();
            let is_hair = |p: &(&[f32; 4], &[f32; 4])| (0..4).any(|c| (p.0[c] - p.1[c]).abs() > 0.02);
            let light = |with: &[[f32; 4]]| {
                let hair = with.iter().zip(fine.iter().zip(&bare)).filter(|(_, pair)| is_hair(pair));
                hair.map(|(p, _)| 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]).sum::<f32>()
            };
            let (area, light) = (area(&draft) / area(&fine), light(&draft) / light(&fine));
            println!("{name}, {samples} samples, yaw {yaw}: area {area}, light {light}");
            assert!((area - 1.0).abs() < 0.3, "{name}, {samples} samples, yaw {yaw}: area {area}");
            assert!((light - 1.0).abs() < 0.25, "{name}, {samples} samples, yaw {yaw}: light {light}");
        }
    }
}

#[test]
fn a_draft_and_a_fine_head_in_one_frame_are_drawn_as_among_their_like() {
    const SIZE: u32 = 96;
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let (model, mut left) = head.with_hair(gpu, CROPPED, 8000.0);
    let mut right = AvatarState::new(&gpu.device, &model);
    let scene = head.scene(0.0, 0.35);
    let across = head.pack.parts()[0].bounds.expect("a box").size().x;
    for (state, side) in [(&mut left, -1.0), (&mut right, 1.0)] {
        let aside = Affine3A::from_translation(Vec3::X * (side * 0.7 * across));
        let (bones, weights) = (vec![aside; model.palette_len()], vec![0.0; model.shape_count()]);
        state.set(&gpu.queue, &bones, &weights).expect("a place");
    }
    for samples in [1, 4] {
        let canvas = canvas(gpu, SIZE, samples);
        let mut picture = |details: [HairDetail; 2]| {
            left.set_hair_detail(details[0]);
            right.set_hair_detail(details[1]);
            draw(gpu, &canvas, &scene, &[(&model, &left), (&model, &right)])
        };
        let half = |picture: &[[f32; 4]], right: bool| -> Vec<[f32; 4]> {
            let columns = picture.iter().zip(0..).filter(|(_, i)| (i % SIZE >= SIZE / 2) == right);
            columns.map(|(pixel, _)| *pixel).collect()
        };
        let (fine, draft) = (picture([FINE, FINE]), picture([DRAFT, DRAFT]));
        let bald = picture([BALD, BALD]);
        for right in [false, true] {
            assert_ne!(half(&fine, right), half(&bald, right), "fine hair shows");
            assert_ne!(half(&draft, right), half(&bald, right), "hair of drafts shows");
            assert_ne!(half(&draft, right), half(&fine, right), "they differ");
        }
        let both = picture([DRAFT, FINE]);
        assert_eq!(half(&both, false), half(&draft, false), "{samples} samples: the draft");
        assert_eq!(half(&both, true), half(&fine, true), "{samples} samples: the fine one");
    }
}
