//! No surface sends out more light than it receives, and white ones hardly less.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common;
use crate::common::stage::{bare_light, light_of, lit_scene, meets_ball, ray_through};
use crate::common::{ball, gpu, model, part, plain};
use avatar_mesh::PartKind;
use avatar_render::{
    AvatarModel, AvatarState, Camera, Environment, Lamp, Light, Material, PartTextures, Scattering, Shading,
    Shadows, Terms,
};
use glam::Vec3;
use std::f32::consts::PI;

const KINDS: [PartKind; 3] = [PartKind::Skin, PartKind::Surface, PartKind::Eyeball];

/// The levels, and each way of scattering with everything else at its best. Shadows matter to lamps only.
fn terms() -> [(&'static str, Terms); 6] {
    let with = |scattering| Terms { scattering, ..Terms::HIGH };
    [
        ("none", Terms::NONE),
        ("low", Terms::LOW),
        ("medium", Terms::MEDIUM),
        ("high", Terms::HIGH),
        ("high, wrapped", with(Scattering::Wrapped)),
        ("high, pre-integrated", with(Scattering::PreIntegrated)),
    ]
    .map(|(name, terms)| (name, Terms { shadows: Shadows::Off, ..terms }))
}

fn white(kind: PartKind) -> Material {
    Material { color: [1.0; 3], back_light: 1.0, ..Material::of(kind) }
}

fn with_material(avatar: &(AvatarModel, AvatarState), material: &Material) {
    let gpu = gpu().expect("asked before");
    avatar.0.set_material(&gpu.queue, 0, material).expect("a part");
}

fn camera() -> Camera {
    Camera::orbit(Vec3::ZERO, 8.0, 0.0, 0.0, 0.28, 1.0)
}

/// What a ball of radius 1 sends to the eye at the pixels that it covers, with the cosine of the view.
fn leaving(terms: Terms, size: u32, light: Light, avatar: &(AvatarModel, AvatarState)) -> Vec<(f32, Vec3)> {
    let camera = camera();
    let picture = light_of(Shading::Natural(terms), size, &lit_scene(camera, light), avatar);
    let on_ball = picture.pixels().filter_map(|(at, light)| {
        let direction = ray_through(&camera, size, at);
        let normal = meets_ball(camera.eye(), direction, Vec3::ZERO, 0.99)?.normalize_or_zero();
        Some((-normal.dot(direction), light))
    });
    on_ball.collect()
}

/// Films and lobes to try on a kind, with light that spreads a little and far.
fn materials(kind: PartKind) -> Vec<Material> {
    let mut all = Vec::new();
    for roughness in [0.1, 0.4, 1.0] {
        for (wetness, sharp_share) in [(0.0, 0.0), (0.0, 1.0), (0.6, 0.3)] {
            let (roughness_matte, roughness_glossy) = (roughness, roughness);
            let both = Material { roughness_matte, roughness_glossy, wetness, sharp_share, ..white(kind) };
            all.push(both);
            if kind == PartKind::Skin {
                all.push(Material { scatter: [0.15, 0.05, 0.02], ..both });
            }
        }
    }
    all
}

#[test]
fn a_white_ball_in_a_white_room_is_no_brighter_than_the_room() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 24);
    for kind in KINDS {
        let avatar = model(gpu, &[part(&mesh, kind, PartTextures::default())]);
        for (name, terms) in terms() {
            for material in materials(kind) {
                with_material(&avatar, &material);
                let white_room = bare_light(Environment::uniform([1.0; 3]));
                let pixels = leaving(terms, 32, white_room, &avatar);
                let said = || format!("{kind:?}, {name}: {material:?}");
                let most = pixels.iter().map(|(_, light)| light.max_element()).fold(0.0, f32::max);
                // The table of reflected shares has steps: its own test allows 0.003.
                assert!(most <= 1.006, "{most}: {}", said());
                for (n_dot_v, light) in pixels.iter().filter(|(n_dot_v, _)| *n_dot_v > 0.98) {
                    assert!(light.min_element() > 0.9, "{light} at {n_dot_v}: {}", said());
                }
            }
        }
    }
}

/// Evenly spread directions: Fibonacci's sphere.
fn directions(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |i| {
        let y = 1.0 - (2.0 * i as f32 + 1.0) / count as f32;
        let turn = i as f32 * PI * (3.0 - 5.0f32.sqrt());
        let across = (1.0 - y * y).sqrt();
        Vec3::new(across * turn.cos(), y, across * turn.sin())
    })
}

/// The share of light from everywhere that reaches the eye from the middle of the part. A lamp of radiance 1
/// lights a white matte surface to `max(n · l, 0)`, whose mean over all directions is 1/4.
fn reflected_share(terms: Terms, avatar: &(AvatarModel, AvatarState)) -> Vec3 {
    const COUNT: u32 = 156;
    // Without shadows the three lamps are alike: each frame stands for three directions.
    let all: Vec<Vec3> = directions(COUNT).collect();
    let lamp = |direction_world| Lamp { direction_world, radiance: [1.0; 3] };
    let frames = all.chunks_exact(3).map(|three| {
        let [key, fill, rim] = [lamp(three[0]), lamp(three[1]), lamp(three[2])];
        let light = Light { key, fill, rim, ..bare_light(Environment::uniform([0.0; 3])) };
        light_of(Shading::Natural(terms), 8, &lit_scene(camera(), light), avatar).middle()
    });
    4.0 * frames.sum::<Vec3>() / COUNT as f32
}

#[test]
fn lamps_from_everywhere_are_reflected_once_at_most() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 24);
    for kind in KINDS {
        let avatar = model(gpu, &[part(&mesh, kind, PartTextures::default())]);
        for scattering in [Scattering::Wrapped, Scattering::PreIntegrated] {
            let terms = Terms { shadows: Shadows::Off, occlusion: false, scattering, ..Terms::HIGH };
            // Rough lobes: narrow ones would slip between the directions.
            for (wetness, sharp_share) in [(0.0, 0.0), (0.7, 0.0), (0.0, 0.6)] {
                let (roughness_matte, roughness_glossy) = (0.6, 0.6);
                let (film_roughness, sharp_roughness, pore_strength) = (0.5, 0.8, 0.0);
                let material = Material {
                    roughness_matte,
                    roughness_glossy,
                    film_roughness,
                    sharp_roughness,
                    pore_strength,
                    wetness,
                    sharp_share,
                    ..white(kind)
                };
                with_material(&avatar, &material);
                let share = reflected_share(terms, &avatar);
                let said = format!("{share} for {kind:?}, {scattering:?}: {wetness}, {sharp_share}");
                assert!(share.max_element() <= 1.01, "{said}");
                assert!(share.min_element() >= 0.95, "{said}");
            }
        }
    }
}

#[test]
fn what_a_thin_part_lets_through_it_does_not_reflect() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 24);
    for thin in [0u8, 20, 80, 255] {
        let thickness = plain([thin, thin, thin, 255]);
        let textures = PartTextures { thickness: Some(&thickness), ..PartTextures::default() };
        let avatar = model(gpu, &[part(&mesh, PartKind::Skin, textures)]);
        for scattering in [Scattering::Wrapped, Scattering::PreIntegrated] {
            let terms = Terms { shadows: Shadows::Off, occlusion: false, scattering, ..Terms::HIGH };
            for transmission in [0.0, 0.5, 1.0] {
                let material = Material { transmission, pore_strength: 0.0, ..white(PartKind::Skin) };
                with_material(&avatar, &material);
                let share = reflected_share(terms, &avatar);
                let said = format!("{share}: {transmission} of {thin}, {scattering:?}");
                assert!(share.max_element() <= 1.01, "{said}");
                // What comes through and what is reflected are the light that arrives, whichever way it goes.
                assert!(share.min_element() >= 0.95, "{said}");
            }
        }
    }
}

#[test]
fn a_lamp_of_radiance_one_lights_a_white_matte_surface_to_one() {
    let Some(gpu) = gpu() else { return };
    let mesh = common::square(Vec3::ZERO, 3.0);
    let avatar = model(gpu, &[part(&mesh, PartKind::Surface, PartTextures::default())]);
    let matte = Material {
        wetness: 0.0,
        reflectance: 0.0,
        wrap: [0.0; 3],
        roughness_matte: 1.0,
        roughness_glossy: 1.0,
        ..white(PartKind::Surface)
    };
    with_material(&avatar, &matte);
    for direction in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, -0.8, 0.6)] {
        let light = common::stage::key_light(direction);
        let picture = light_of(Shading::Natural(Terms::NONE), 8, &lit_scene(camera(), light), &avatar);
        let error = (picture.middle() - Vec3::splat(direction.z)).abs().max_element();
        assert!(error < 0.02, "{} for {}", picture.middle(), direction.z);
    }
}
