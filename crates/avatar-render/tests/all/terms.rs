//! Each term of natural shading does what it says: occlusion, reflections, the sharp lobe, pores.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{Picture, bare_light, key_light, light_of, lit_scene, meets_ball, ray_through};
use crate::common::{ball, gpu, model, part, square};
use avatar_look::irradiance_at;
use avatar_look::optics::{Cosines, Lobes, specular, two_lobe_specular};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Environment, Material, Panel, PartTextures, Scattering, Shading, Terms,
};
use glam::{Affine3A, Vec3};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

const SIZE: u32 = 128;

fn of_one(mesh: &Mesh, kind: PartKind, material: Material) -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let avatar = model(gpu, &[part(mesh, kind, PartTextures::default())]);
    avatar.0.set_material(&gpu.queue, 0, &material).expect("a part");
    avatar
}

/// Dark and matte: light does not bounce from it, and nothing is reflected.
fn dark(kind: PartKind) -> Material {
    Material {
        color: [0.05; 3],
        reflectance: 0.0,
        roughness_matte: 1.0,
        roughness_glossy: 1.0,
        wetness: 0.0,
        back_light: 1.0,
        pore_strength: 0.0,
        ..Material::of(kind)
    }
}

/// The share of the ambient light that is left where neighbours hide some of it.
fn left(avatar: &(AvatarModel, AvatarState), camera: Camera) -> Picture {
    let scene = lit_scene(camera, bare_light(Environment::uniform([1.0; 3])));
    let [with, without] = [true, false].map(|occlusion| {
        light_of(Shading::Natural(Terms { occlusion, ..Terms::NONE }), SIZE, &scene, avatar)
    });
    let share = |(with, without): (&Vec3, &Vec3)| if without.x > 0.0 { *with / *without } else { Vec3::ONE };
    Picture { size: SIZE, light: with.light.iter().zip(&without.light).map(share).collect() }
}

#[test]
fn a_crease_is_darker_the_nearer_and_only_as_far_as_the_renderer_looks() {
    let Some(_) = gpu() else { return };
    // A wall and a floor, 2 high and 2 deep.
    let mut mesh = square(Vec3::new(0.0, 1.0, 0.0), 1.0);
    let lay = Affine3A::from_translation(Vec3::Z) * Affine3A::from_rotation_x(-FRAC_PI_2);
    let floor = square(Vec3::ZERO, 1.0);
    mesh.positions.extend(floor.positions.iter().map(|p| lay.transform_point3(*p)));
    mesh.normals.extend([Vec3::Y; 4]);
    mesh.uvs.extend(floor.uvs);
    mesh.triangles.extend(floor.triangles.iter().map(|corners| corners.map(|i| i + 4)));
    // 5 % of the height of the skin.
    let radius = 0.05 * 2.0;
    for kind in [PartKind::Skin, PartKind::Surface] {
        let avatar = of_one(&mesh, kind, dark(kind));
        let camera = Camera::orbit(Vec3::new(0.0, 0.1, 0.1), 6.0, 0.0, FRAC_PI_4, 0.12, 1.0);
        let picture = left(&avatar, camera);
        // On the floor and on the wall, by distance from the crease.
        for along in [Vec3::Z, Vec3::Y] {
            let at = |distance: f32| picture.at(&camera, along * distance).x;
            let shares = [0.02, 0.05, 0.08, 0.15, 0.25].map(at);
            // An endless wall hides half of the light from all of the floor; one that is looked for only
            // nearby, less.
            assert!((0.5..0.9).contains(&shares[0]), "{kind:?}, {along}: {shares:?}");
            assert!(shares.is_sorted(), "{kind:?}, {along}: {shares:?}");
            assert!(at(1.2 * radius) > 0.97 && shares[4] > 0.99, "{kind:?}, {along}: {shares:?}");
        }
    }
}

#[test]
fn neither_a_flat_plate_nor_the_middle_of_a_ball_hides_anything() {
    let Some(_) = gpu() else { return };
    let (plate, round) = (square(Vec3::ZERO, 1.0), ball(Vec3::ZERO, 1.0, 48));
    for kind in [PartKind::Skin, PartKind::Surface] {
        let avatars = [&plate, &round].map(|mesh| of_one(mesh, kind, dark(kind)));
        for (yaw, pitch) in [(0.0, 0.0), (0.9, 0.3), (-1.2, -0.2)] {
            let camera = Camera::orbit(Vec3::ZERO, 8.0, yaw, pitch, 0.28, 1.0);
            let darkest = left(&avatars[0], camera).light.iter().map(|share| share.x).fold(1.0, f32::min);
            assert!(darkest > 0.99, "a plate, {kind:?} from {yaw}, {pitch}: {darkest}");
            for (at, share) in left(&avatars[1], camera).pixels() {
                let ray = ray_through(&camera, SIZE, at);
                let Some(point) = meets_ball(camera.eye(), ray, Vec3::ZERO, 1.0) else { continue };
                if -point.dot(ray) > 0.5 {
                    assert!(share.x > 0.98, "a ball, {kind:?}: {share} at {at}");
                }
            }
        }
    }
}

#[test]
fn what_is_far_behind_is_not_darkened() {
    let Some(gpu) = gpu() else { return };
    // Half the plate's height in front of it, ten times as far as the renderer looks.
    let (plate, before) = (square(Vec3::ZERO, 1.0), square(Vec3::new(0.0, 0.0, 1.0), 0.2));
    let none = PartTextures::default();
    let avatar = model(gpu, &[part(&plate, PartKind::Skin, none), part(&before, PartKind::Surface, none)]);
    for (place, kind) in [PartKind::Skin, PartKind::Surface].into_iter().enumerate() {
        avatar.0.set_material(&gpu.queue, place, &dark(kind)).expect("a part");
    }
    for yaw in [0.0, 0.4] {
        let picture = left(&avatar, Camera::orbit(Vec3::ZERO, 8.0, yaw, 0.0, 0.2, 1.0));
        let darkest = picture.light.iter().map(|share| share.x).fold(1.0, f32::min);
        assert!(darkest > 0.99, "{darkest} from {yaw}");
    }
}

#[test]
fn matte_surfaces_take_their_light_from_where_they_look() {
    let Some(_) = gpu() else { return };
    let panel = |x, y, z, radiance| Panel { direction_world: Vec3::new(x, y, z), radius_rad: 0.6, radiance };
    // Each direction has a colour of its own.
    let environment = Environment {
        panels: [
            panel(1.0, 0.2, 0.3, [3.0, 0.0, 0.5]),
            panel(-0.4, 0.9, 0.3, [0.0, 2.0, 0.5]),
            panel(-0.3, -0.5, 0.8, [0.3, 0.3, 2.5]),
            panel(0.2, 0.3, -1.0, [1.0, 1.0, 0.0]),
        ],
        ..Environment::STUDIO
    };
    // Its twin on the CPU is held against a sum over all directions.
    let irradiance = environment.irradiance();
    let white = Material { color: [1.0; 3], ..dark(PartKind::Surface) };
    let avatar = of_one(&ball(Vec3::ZERO, 1.0, 64), PartKind::Surface, white);
    for (yaw, pitch) in [(0.0, 0.0), (2.0, 0.5), (-1.3, -0.9)] {
        let camera = Camera::orbit(Vec3::ZERO, 6.0, yaw, pitch, 0.36, 1.0);
        let scene = lit_scene(camera, bare_light(environment));
        for (at, light) in light_of(Shading::Natural(Terms::NONE), SIZE, &scene, &avatar).pixels() {
            let ray = ray_through(&camera, SIZE, at);
            let Some(normal) = meets_ball(camera.eye(), ray, Vec3::ZERO, 1.0) else { continue };
            // Toward the silhouette more and more is reflected instead.
            if -normal.dot(ray) > 0.7 {
                let expected = irradiance_at(&irradiance, normal);
                assert!((light - expected).abs().max_element() < 0.03, "{light} for {expected} at {normal}");
            }
        }
    }
}

/// A ball that only reflects, and what its pixels show: the normal, the direction to the eye, and the light.
fn shiny(
    kind: PartKind,
    material: Material,
    terms: Terms,
    light: avatar_render::Light,
) -> Vec<(Vec3, Vec3, Vec3)> {
    let mesh = ball(Vec3::ZERO, 1.0, 64);
    let avatar = of_one(&mesh, kind, Material { color: [0.0; 3], pore_strength: 0.0, ..material });
    let camera = Camera::orbit(Vec3::ZERO, 6.0, 0.0, 0.0, 0.36, 1.0);
    let picture = light_of(Shading::Natural(terms), SIZE, &lit_scene(camera, light), &avatar);
    let pixels = picture.pixels().filter_map(|(at, light)| {
        let ray = ray_through(&camera, SIZE, at);
        let normal = meets_ball(camera.eye(), ray, Vec3::ZERO, 1.0)?;
        (-normal.dot(ray) > 0.15).then_some((normal, -ray, light))
    });
    pixels.collect()
}

#[test]
fn highlights_are_those_of_one_lobe_or_two() {
    let Some(_) = gpu() else { return };
    let toward = Vec3::new(0.4, 0.3, 0.9).normalize_or_zero();
    let lobes = Lobes { roughness: 0.5, sharp_share: 0.4, sharp_roughness: 0.5 };
    let material = Material {
        reflectance: 0.2,
        roughness_matte: lobes.roughness,
        roughness_glossy: lobes.roughness,
        sharp_share: lobes.sharp_share,
        sharp_roughness: lobes.sharp_roughness,
        ..Material::of(PartKind::Skin)
    };
    for scattering in [Scattering::Wrapped, Scattering::PreIntegrated, Scattering::Separable] {
        let mut peaks = Vec::new();
        for sharp_lobe in [false, true] {
            let terms = Terms { sharp_lobe, scattering, ..Terms::NONE };
            let mut peak = 0.0f32;
            for (normal, view, light) in shiny(PartKind::Skin, material, terms, key_light(toward)) {
                let cosines = Cosines::between(normal, view, toward);
                let brdf = match sharp_lobe {
                    true => two_lobe_specular(cosines, 0.2, lobes),
                    false => specular(cosines, 0.2, lobes.roughness * lobes.roughness),
                };
                let expected = PI * brdf * cosines.n_dot_l.max(0.0);
                // A ball of triangles: its normals are off by up to a thousandth, as much as the sharp lobe's
                // slope makes 2 % of.
                let said = format!("{light} for {expected}, at {normal}: {scattering:?}, {sharp_lobe}");
                assert!((light.x - expected).abs() < 0.02 * expected + 0.01, "{said}");
                peak = peak.max(light.x);
            }
            peaks.push(peak);
        }
        assert!(peaks[1] > 2.0 * peaks[0], "{peaks:?}");
    }
}

#[test]
fn the_environment_is_reflected_where_a_mirror_would_show_it() {
    let Some(_) = gpu() else { return };
    let film = Material {
        wetness: 1.0,
        reflectance: 0.0,
        film_roughness: 0.05,
        back_light: 1.0,
        ..Material::of(PartKind::Surface)
    };
    for toward in [Vec3::new(0.9, 0.3, 0.6), Vec3::new(-0.5, -0.2, 0.9), Vec3::new(-0.8, 0.6, -0.2)] {
        let panel = Panel { direction_world: toward, radius_rad: 0.3, radiance: [4.0; 3] };
        let environment = Environment {
            panels: [panel, Panel::OFF, Panel::OFF, Panel::OFF],
            ..Environment::uniform([0.0; 3])
        };
        let draw = |reflections| {
            let terms = Terms { reflections, ..Terms::NONE };
            shiny(PartKind::Surface, film, terms, bare_light(environment))
        };
        // The normal at which most of the panel is seen, weighted by the light.
        let middle = |weights: &[(Vec3, f32)]| {
            weights.iter().map(|(normal, weight)| *normal * *weight).sum::<Vec3>().normalize_or_zero()
        };
        let mirrored = draw(true);
        let found = middle(&mirrored.iter().map(|(n, _, light)| (*n, light.x)).collect::<Vec<_>>());
        let by_mirror: Vec<_> = mirrored
            .iter()
            .map(|(n, view, _)| {
                let reflected = *n * 2.0 * n.dot(*view) - *view;
                // Of water, C. Schlick 1994.
                let fresnel = 0.02 + 0.98 * (1.0 - n.dot(*view)).powi(5);
                (*n, fresnel * environment.radiance(reflected).x)
            })
            .collect();
        let expected = middle(&by_mirror);
        assert!(found.distance(expected) < 0.03, "{found} for {expected}, toward {toward}");
        // As much light as the mirror shows, and as bright but for the blur of its roughness.
        let sums = [
            mirrored.iter().map(|(.., light)| light.x).sum::<f32>(),
            by_mirror.iter().map(|(_, light)| light).sum(),
        ];
        assert!((sums[0] / sums[1] - 1.0).abs() < 0.1, "{sums:?} toward {toward}");
        let brightest = |lights: &mut dyn Iterator<Item = f32>| lights.fold(0.0, f32::max);
        let on = brightest(&mut mirrored.iter().map(|(.., light)| light.x));
        let ideal = brightest(&mut by_mirror.iter().map(|(_, light)| *light));
        assert!((on / ideal - 1.0).abs() < 0.15, "{on} for {ideal}, toward {toward}");
        // Without, there is an even sheen.
        let off = brightest(
            &mut draw(false).iter().map(|(n, v, light)| if n.dot(*v) > 0.5 { light.x } else { 0.0 }),
        );
        assert!(off < 0.25 * on, "{off} {on}");
    }
}

#[test]
fn pores_are_there_from_near_and_vanish_from_afar() {
    let Some(_) = gpu() else { return };
    let material =
        Material { color: [0.8; 3], pore_strength: 0.5, pore_density: 50.0, ..Material::of(PartKind::Skin) };
    let plate = square(Vec3::ZERO, 1.0);
    let avatar = of_one(&plate, PartKind::Skin, material);
    // One repetition of 50 over the height of 2 is 0.04 wide and has 12 bumps.
    let draw = |width: f32, pores| {
        let fov = 0.1f32;
        let distance = 0.5 * width / (0.5 * fov).tan();
        let camera = Camera::orbit(Vec3::new(0.11, 0.07, 0.0), distance, 0.0, 0.0, fov, 1.0);
        let scene = lit_scene(camera, key_light(Vec3::new(0.7, 0.0, 0.7)));
        light_of(Shading::Natural(Terms { pores, ..Terms::NONE }), SIZE, &scene, &avatar)
    };
    let spread = |picture: &Picture| {
        let values = || picture.light.iter().map(|light| light.y);
        let mean = values().sum::<f32>() / picture.light.len() as f32;
        let square = values().map(|y| (y - mean).powi(2)).sum::<f32>() / picture.light.len() as f32;
        (mean, square.sqrt() / mean)
    };
    let (near, flat) = (draw(0.04, true), draw(0.04, false));
    let (with, without) = (spread(&near), spread(&flat));
    assert!(with.1 > 0.03 && without.1 < 0.01, "{with:?} {without:?}");
    // They lean to all sides alike.
    assert!((with.0 / without.0 - 1.0).abs() < 0.05, "{with:?} {without:?}");
    // The same every 0.04.
    let column = |picture: &Picture, x: u32| (0..SIZE).map(|y| picture.pixel(x, y)).collect::<Vec<_>>();
    let wide = draw(0.08, true);
    let difference = |a: u32, b: u32| {
        let pairs = column(&wide, a).into_iter().zip(column(&wide, b));
        pairs.map(|(a, b)| (a - b).abs().max_element()).sum::<f32>() / SIZE as f32
    };
    assert!(difference(10, 10 + SIZE / 2) < 0.3 * difference(10, 10 + SIZE / 4), "{}", difference(10, 74));
    assert_eq!(draw(0.5, true), draw(0.5, false));
}

#[test]
fn the_mouth_is_warmer_than_the_room_and_darker_to_the_back_and_never_brighter() {
    let Some(_) = gpu() else { return };
    // Leans back: its upper edge is deep in the mouth.
    let mut mesh = square(Vec3::ZERO, 1.0);
    mesh.positions.iter_mut().for_each(|p| p.z -= 0.5 * p.y);
    let white = |back_light| Material { color: [1.0; 3], back_light, ..dark(PartKind::Surface) };
    let camera = Camera::orbit(Vec3::ZERO, 8.0, 0.0, 0.0, 0.24, 1.0);
    let scene = lit_scene(camera, bare_light(Environment::uniform([1.0; 3])));
    let [open, mouth] = [1.0, 0.3].map(|back_light| {
        let avatar = of_one(&mesh, PartKind::Surface, white(back_light));
        let picture = light_of(Shading::Natural(Terms::NONE), SIZE, &scene, &avatar);
        [-0.9, -0.3, 0.3, 0.9].map(|y| picture.at(&camera, Vec3::new(0.0, y, -0.5 * y)))
    });
    assert!(open.iter().all(|light| (*light - Vec3::ONE).abs().max_element() < 0.03), "{open:?}");
    assert!(mouth.iter().all(|light| light.x > 1.1 * light.y && light.y > 1.05 * light.z), "{mouth:?}");
    assert!(mouth.windows(2).all(|pair| pair[1].cmple(pair[0]).all()), "{mouth:?}");
    assert!(mouth[0].x > 0.9 && mouth[0].max_element() < 1.01, "{mouth:?}");
    // Once, not squared: 30 % of the light reaches the very back.
    assert!((mouth[3].x - 0.3).abs() < 0.1, "{mouth:?}");
}
