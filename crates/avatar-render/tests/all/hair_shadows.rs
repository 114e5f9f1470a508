//! Hair keeps off as much of the key's light as it covers, from what lies behind it and from nothing else.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common;
use crate::common::stage::{key_light, light_of, lit_scene};
use crate::common::{ball, flat_light, gpu, model, part, square};
use avatar_groom::{DensityMap, Groom, RegionStyle, Style};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::headless::Canvas;
use avatar_render::{
    AvatarModel, AvatarState, Camera, Deformer, Grower, HairDetail, Material, PartDesc, PartTextures,
    Quality, Scene, Shading, Shadows, Terms,
};
use glam::{Affine3A, Vec3};
use std::f32::consts::FRAC_PI_2;

const SIZE: u32 = 384;
/// Where on the plate light is measured: along the strands, and half the way across them.
const PLACES: [f32; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
const BAND: f32 = 0.3;
/// Half the width of the patch that hair grows on.
const HALF: f32 = 0.5;
const RADIUS: f32 = 0.000_1;
/// Up to 20,000 strands are this much wider than styles say.
const WIDENED: f32 = 5.0;

/// A sheet of parallel strands that fills z = 0.5…1.5, from a patch at the side, and other parts.
fn sheet(others: &[PartDesc<'_>], strands: f32, radius: f32) -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let turn = Affine3A::from_translation(Vec3::new(-3.0, 0.0, 1.0)) * Affine3A::from_rotation_y(FRAC_PI_2);
    let patch = square(Vec3::ZERO, HALF);
    let patch = Mesh {
        positions: patch.positions.iter().map(|p| turn.transform_point3(*p)).collect(),
        normals: patch.normals.iter().map(|n| turn.transform_vector3(*n)).collect(),
        ..patch
    };
    let skin = part(&patch, PartKind::Skin, PartTextures::default());
    let (mut model, _) = model(gpu, &[others, &[skin]].concat());
    let scalp = RegionStyle {
        length: 6.0,
        length_variation: 0.0,
        root_radius: radius,
        tip_radius: radius,
        bend: 0.0,
        gravity: 0.0,
        noise: 0.0,
        clump: 0.0,
        ..Style::SHORT.scalp
    };
    let white = DensityMap::new(1, 1, vec![255]).expect("a map");
    let groom = Groom::new(&patch, &white, &[], Style { scalp, ..Style::SHORT }, strands, 5);
    model.set_hair(&gpu.device, &gpu.queue, others.len(), Some(&groom)).expect("hair");
    let state = AvatarState::new(&gpu.device, &model);
    (model, state)
}

/// A plate behind the sheet, and a smaller one before it.
fn curtain(strands: f32) -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let (behind, before) = (square(Vec3::ZERO, 3.5), square(Vec3::new(2.5, 0.0, 2.0), 0.3));
    let plate = |mesh| part(mesh, PartKind::Surface, PartTextures::default());
    let avatar = sheet(&[plate(&behind), plate(&before)], strands, RADIUS);
    let matte = Material {
        color: [1.0; 3],
        wrap: [0.0; 3],
        reflectance: 0.0,
        wetness: 0.0,
        back_light: 1.0,
        ..Material::of(PartKind::Surface)
    };
    (0..2).for_each(|place| avatar.0.set_material(&gpu.queue, place, &matte).expect("a part"));
    avatar
}

/// What hair leaves of the key's light behind it and before it.
fn left(shadows: Shadows, avatar: &mut (AvatarModel, AvatarState)) -> [f32; 2] {
    // From so far below that no strand lies between the eye and these places.
    let camera = Camera::orbit(Vec3::ZERO, 14.0, 0.0, -1.15, 0.6, 1.0);
    let shading = Shading::Natural(Terms { shadows, ..Terms::NONE });
    let scene = lit_scene(camera, key_light(Vec3::Z));
    let mut picture = |share| {
        avatar.1.set_hair_detail(HairDetail { share, is_automatic: false, ..HairDetail::default() });
        light_of(shading, SIZE, &scene, avatar)
    };
    let (with, without) = (picture(1.0), picture(0.0));
    // So often that single strands in the map do not matter.
    let across = |x: f32| (-24..=24).map(move |i| Vec3::new(x, BAND * i as f32 / 24.5, 0.0));
    let behind: Vec<Vec3> = PLACES.into_iter().flat_map(across).collect();
    let before = vec![Vec3::new(2.5, 0.0, 2.0)];
    [behind, before].map(|points| {
        let sum = |picture: &common::stage::Picture| -> f32 {
            points.iter().map(|point| picture.at(&camera, *point).x).sum()
        };
        sum(&with) / sum(&without)
    })
}

/// What strands leave behind them at these places: those in random places leave e to the minus of what all of
/// them together cover (S. Poisson), and where they are, the buffer that is drawn says.
fn expected((model, state): &(AvatarModel, AvatarState)) -> f32 {
    let gpu = gpu().expect("asked before");
    let (deformer, grower) = (Deformer::new(&gpu.device), Grower::new(&gpu.device));
    let strands = grower.run(&gpu.device, &gpu.queue, &deformer, model, state).expect("strands");
    let left = PLACES.map(|x| {
        let crossings = strands.iter().filter(|points| {
            points.windows(2).any(|pair| {
                let share = (x - pair[0].x) / (pair[1].x - pair[0].x);
                (0.0..1.0).contains(&share) && pair[0].lerp(pair[1], share).y.abs() < BAND
            })
        });
        (-(crossings.count() as f32) * 2.0 * RADIUS * WIDENED / (2.0 * BAND)).exp()
    });
    left.iter().sum::<f32>() / left.len() as f32
}

#[test]
fn hair_keeps_off_what_it_covers_behind_it_alone() {
    let Some(_) = gpu() else { return };
    for strands in [600.0, 2400.0] {
        let mut avatar = curtain(strands);
        let (count, expected) = (avatar.0.strand_count(), expected(&avatar));
        for shadows in [Shadows::Hard, Shadows::Soft, Shadows::Softer] {
            let [behind, before] = left(shadows, &mut avatar);
            println!("{shadows:?}, {count} strands: {behind} behind, {before} before; expected {expected}");
            assert!((behind - expected).abs() < 0.02, "{shadows:?}, {count}: {behind}, not {expected}");
            assert!((before - 1.0).abs() < 0.01, "{shadows:?}, {count}: {before}");
        }
        let [behind, before] = left(Shadows::Off, &mut avatar);
        assert!((behind - 1.0).abs() < 1e-3 && (before - 1.0).abs() < 1e-3, "{behind} {before}");
    }
}

#[test]
fn what_is_clear_is_seen_before_hair_and_not_behind_it() {
    let Some(gpu) = gpu() else { return };
    let (far, near) = (Vec3::new(-0.6, 0.0, 0.0), Vec3::new(0.6, 0.0, 2.5));
    let [behind, before] = [far, near].map(|center| ball(center, 0.25, 16));
    let clear = |mesh| part(mesh, PartKind::Cornea, PartTextures::default());
    let (model, mut state) = sheet(&[clear(&behind), clear(&before)], 8000.0, 0.001);
    let red = Material { color: [1.0, 0.0, 0.0], opacity: 1.0, ..Material::of(PartKind::Cornea) };
    (0..2).for_each(|place| model.set_material(&gpu.queue, place, &red).expect("a part"));
    let camera = Camera::orbit(Vec3::Z, 10.0, 0.0, 0.0, 0.3, 1.0);
    let scene = Scene { camera, background: [0.0, 0.0, 0.0, 1.0], light: flat_light() };
    for quality in [Quality::Plain, Quality::Low] {
        for samples in [1, 4] {
            let shading = quality.shading(avatar_render::Style::Natural);
            let canvas = Canvas::new(gpu, 64, 64, samples, shading).expect("a canvas");
            let mut red_at = |share| {
                state.set_hair_detail(HairDetail { share, ..HairDetail::default() });
                let picture = canvas.render(gpu, &scene, &[(&model, &state)]).expect("a picture");
                [far, near].map(|center| {
                    let at = common::stage::pixel_of(&camera, 64, center);
                    let [r, g, ..] = picture.pixel(at.x as u32, at.y as u32);
                    r.saturating_sub(g)
                })
            };
            let ([far_bald, near_bald], [far_hair, near_hair]) = (red_at(0.0), red_at(1.0));
            let said =
                format!("{quality:?}, {samples} samples: {far_bald} {near_bald} {far_hair} {near_hair}");
            assert!(far_bald > 100 && near_bald > 100, "{said}");
            assert!(far_hair < far_bald / 2 && near_hair.abs_diff(near_bald) <= 2, "{said}");
        }
    }
}
