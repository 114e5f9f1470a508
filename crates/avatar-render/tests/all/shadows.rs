//! Shadows fall where geometry says, of the lamps that cast them, with edges as soft as designed.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{
    Picture, bare_light, key_light, light_of, lit_scene, meets_ball, pixel_of, ray_through, stage,
};
use crate::common::{ball, gpu, model, part, square};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Environment, Lamp, Light, Material, PartTextures, Shading, Shadows,
    Terms,
};
use glam::{Affine3A, Vec3};

const SIZE: u32 = 128;
const BALL: Vec3 = Vec3::new(0.2, 0.1, 1.2);
const RADIUS: f32 = 0.5;
/// Half the side of the plate in the plane z = 0; its height is what lengths of the renderer are measured by.
const PLATE: f32 = 2.0;

fn with(shadows: Shadows) -> Shading {
    Shading::Natural(Terms { shadows, ..Terms::NONE })
}

fn camera() -> Camera {
    Camera::orbit(Vec3::ZERO, 12.0, 0.0, 0.0, 0.34, 1.0)
}

/// A ball in front of a plate, matte and white.
fn avatar() -> (AvatarModel, AvatarState) {
    avatar_of(1.0)
}

/// The same, larger.
fn avatar_of(scale: f32) -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let (plate, above) = (square(Vec3::ZERO, PLATE * scale), ball(BALL * scale, RADIUS * scale, 32));
    let none = PartTextures::default();
    let avatar = model(gpu, &[part(&plate, PartKind::Surface, none), part(&above, PartKind::Surface, none)]);
    let matte = Material {
        color: [1.0; 3],
        wrap: [0.0; 3],
        reflectance: 0.0,
        wetness: 0.0,
        back_light: 1.0,
        ..Material::of(PartKind::Surface)
    };
    for place in 0..2 {
        avatar.0.set_material(&gpu.queue, place, &matte).expect("a part");
    }
    avatar
}

/// How far a point's way to the lamp passes the ball's middle, by its radius.
fn clearance(point: Vec3, toward_lamp: Vec3) -> f32 {
    let to = BALL - point;
    (to - toward_lamp * to.dot(toward_lamp)).length() / RADIUS
}

/// What a lamp leaves of its light at points of the plate: those that the eye sees, with their clearance.
fn on_plate(
    shadows: Shadows,
    light: Light,
    avatar: &(AvatarModel, AvatarState),
    toward: Vec3,
) -> Vec<(f32, f32)> {
    let picture = light_of(with(shadows), SIZE, &lit_scene(camera(), light), avatar);
    let open = light_of(with(Shadows::Off), SIZE, &lit_scene(camera(), light), avatar);
    let points = picture.pixels().zip(&open.light).filter_map(|((at, light), open)| {
        let (eye, ray) = (camera().eye(), ray_through(&camera(), SIZE, at));
        let point = eye - ray * (eye.z / ray.z);
        let on_plate = point.truncate().abs().max_element() < 0.97 * PLATE;
        // The ball hides some of the plate; a little more, for its edge is one of triangles.
        let hidden = meets_ball(eye, ray, BALL, 1.05 * RADIUS).is_some();
        (on_plate && !hidden).then(|| (clearance(point, toward), light.x / open.x))
    });
    points.collect()
}

const LAMPS: [Vec3; 4] = [
    Vec3::new(0.48, 0.36, 0.8),
    Vec3::new(-0.6, 0.0, 0.8),
    Vec3::new(0.0, -0.6, 0.8),
    Vec3::new(-0.36, 0.48, 0.8),
];

#[test]
fn the_shadow_of_a_ball_lies_where_its_way_to_the_lamp_is_barred() {
    let Some(_) = gpu() else { return };
    let avatar = avatar();
    for shadows in [Shadows::Hard, Shadows::Soft, Shadows::Softer] {
        for toward in LAMPS {
            let points = on_plate(shadows, key_light(toward), &avatar, toward);
            // Softness: 0.7 % of the plate's height to each side, and a ball of triangles.
            let soft =
                if shadows == Shadows::Hard { 0.05 } else { 0.05 + 1.5 * 0.007 * 2.0 * PLATE / RADIUS };
            let (mut lit, mut dark) = (0, 0);
            for (clearance, left) in points {
                let said = format!("{shadows:?} from {toward}: {left} at {clearance}");
                if clearance > 1.0 + soft {
                    assert!(left > 0.99, "{said}");
                    lit += 1;
                } else if clearance < 1.0 - soft {
                    assert!(left < 0.01, "{said}");
                    dark += 1;
                }
            }
            assert!(lit > 3000 && dark > 100, "{lit} {dark}");
        }
    }
}

#[test]
fn the_key_casts_shadows_and_the_rim_soft_ones_and_the_fill_none() {
    let Some(_) = gpu() else { return };
    let avatar = avatar();
    let toward = LAMPS[0];
    let dark_room = bare_light(Environment::uniform([0.0; 3]));
    let lamp = Lamp { direction_world: toward, radiance: [1.0; 3] };
    let lights = [
        Light { key: lamp, ..dark_room },
        Light { fill: lamp, ..dark_room },
        Light { rim: lamp, ..dark_room },
    ];
    for (shadows, casting) in [
        (Shadows::Hard, [true, false, false]),
        (Shadows::Soft, [true, false, true]),
        (Shadows::Softer, [true, false, true]),
    ] {
        for (light, casts) in lights.into_iter().zip(casting) {
            let points = on_plate(shadows, light, &avatar, toward);
            let darkest = points.iter().map(|(_, left)| *left).fold(1.0, f32::min);
            assert_eq!(darkest < 0.01, casts, "{shadows:?}: {darkest}");
            assert_eq!(darkest > 0.99, !casts, "{shadows:?}: {darkest}");
        }
    }
}

#[test]
fn nothing_that_faces_a_lamp_alone_is_in_its_own_shadow() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 48);
    let avatar = model(gpu, &[part(&mesh, PartKind::Surface, PartTextures::default())]);
    let camera = Camera::orbit(Vec3::ZERO, 12.0, 0.0, 0.0, 0.2, 1.0);
    for toward in [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.8, 0.6, 0.0)] {
        let draw = |shadows| light_of(with(shadows), SIZE, &lit_scene(camera, key_light(toward)), &avatar);
        let open = draw(Shadows::Off);
        for shadows in [Shadows::Hard, Shadows::Soft, Shadows::Softer] {
            let picture = draw(shadows);
            for ((at, light), open) in picture.pixels().zip(&open.light) {
                let ray = ray_through(&camera, SIZE, at);
                let Some(normal) = meets_ball(camera.eye(), ray, Vec3::ZERO, 0.99) else { continue };
                let n_dot_l = normal.normalize_or_zero().dot(toward);
                // Kernels reach around the ball where the lamp grazes it.
                if n_dot_l > 0.3 {
                    assert!(
                        light.x > 0.97 * open.x,
                        "{shadows:?} from {toward}: {light} of {open} at {n_dot_l}"
                    );
                }
            }
        }
    }
}

/// The plate and its ball, seen together with a larger avatar whose bones are moved by this and which is
/// given first.
fn beside_another(shadows: Shadows, toward: Vec3, by: Option<Vec3>) -> Picture {
    let gpu = gpu().expect("asked before");
    let (one, mut other) = (avatar(), avatar_of(2.5));
    let mut avatars = vec![(&one.0, &one.1)];
    if let Some(by) = by {
        other.1.set(&gpu.queue, &[Affine3A::from_translation(by)], &[]).expect("one bone");
        avatars.insert(0, (&other.0, &other.1));
    }
    let stage = stage(with(shadows), SIZE).expect("asked before");
    stage.draw(gpu, &lit_scene(camera(), key_light(toward)), &avatars)
}

#[test]
fn an_avatar_far_away_leaves_the_shadows_of_the_one_that_is_seen_as_they_are() {
    let Some(_) = gpu() else { return };
    for shadows in [Shadows::Hard, Shadows::Softer] {
        let alone = beside_another(shadows, LAMPS[0], None);
        // Beside the picture, behind the camera.
        for by in [Vec3::X * 200.0, Vec3::Z * 300.0, Vec3::new(-90.0, 60.0, -50.0)] {
            let share = alone.difference_share(&beside_another(shadows, LAMPS[0], Some(by)), 0.0);
            assert_eq!(share, 0.0, "{shadows:?}, {by}");
        }
        // In the picture, but small: its own pixels differ.
        let small = beside_another(shadows, LAMPS[0], Some(Vec3::new(300.0, 0.0, -2000.0)));
        assert!(alone.difference_share(&small, 0.0) < 0.002, "{shadows:?}");
    }
}

#[test]
fn an_avatar_beside_the_picture_casts_its_shadow_into_it() {
    let Some(_) = gpu() else { return };
    let toward = Vec3::new(0.8, 0.0, 0.6);
    let alone = beside_another(Shadows::Hard, toward, None);
    let shaded = beside_another(Shadows::Hard, toward, Some(toward * 15.0));
    let sum = |picture: &Picture| picture.light.iter().map(|light| light.x).sum::<f32>();
    assert!(sum(&shaded) < 0.1 * sum(&alone), "{} of {}", sum(&shaded), sum(&alone));
}

#[test]
fn the_drawn_rim_is_hidden_by_what_stands_before_its_lamp() {
    let Some(gpu) = gpu() else { return };
    let (mesh, screen) = (ball(Vec3::ZERO, 1.0, 32), ball(Vec3::X * 4.0, 1.5, 16));
    let rim = Lamp { direction_world: Vec3::X, radiance: [1.0; 3] };
    let light = Light { rim, ..bare_light(Environment::uniform([0.0; 3])) };
    let camera = Camera::orbit(Vec3::ZERO, 12.0, 0.0, 0.0, 0.2, 1.0);
    let of = |meshes: &[&Mesh]| {
        let none = PartTextures::default();
        let parts: Vec<_> = meshes.iter().map(|mesh| part(mesh, PartKind::Surface, none)).collect();
        let picture = light_of(Shading::Toon, SIZE, &lit_scene(camera, light), &model(gpu, &parts));
        // Across the middle. Some ambient light is always there.
        (0..SIZE).map(|x| picture.pixel(x, SIZE / 2).x).fold(0.0, f32::max)
    };
    let (open, hidden) = (of(&[&mesh]), of(&[&mesh, &screen]));
    assert!(open > 0.45 && hidden < 0.1, "{hidden} of {open}");
}

/// The width over which a straight edge's shadow rises from 10 % to 90 %, in the world, and its largest step
/// from pixel to pixel.
fn edge(shadows: Shadows) -> (f32, f32) {
    const PIXELS: u32 = 256;
    let gpu = gpu().expect("asked before");
    let (plate, screen) = (square(Vec3::ZERO, PLATE), square(Vec3::new(-1.0, 0.0, 0.5), 1.0));
    let none = PartTextures::default();
    let avatar = model(gpu, &[part(&plate, PartKind::Surface, none), part(&screen, PartKind::Surface, none)]);
    // The lamp is opposite; the screen's edge x = 0 throws its shadow to x = 0.5 · 0.75.
    let toward = Vec3::new(-0.6, 0.0, 0.8);
    let at = Vec3::new(0.375, 0.0, 0.0);
    let camera = Camera::orbit(at, 4.0, 0.0, 0.0, 0.04, 1.0);
    let picture: Picture = light_of(with(shadows), PIXELS, &lit_scene(camera, key_light(toward)), &avatar);
    let row: Vec<f32> = (0..PIXELS).map(|x| picture.pixel(x, PIXELS / 2).x).collect();
    let full = row.iter().copied().fold(0.0, f32::max);
    let crossing = |share: f32| row.iter().position(|light| *light > share * full).expect("an edge") as f32;
    let per_pixel = {
        let [a, b] = [0.0, 0.01].map(|x| pixel_of(&camera, PIXELS, at + Vec3::X * x).x);
        0.01 / (b - a)
    };
    let middle = (crossing(0.5) - PIXELS as f32 / 2.0) * per_pixel;
    assert!(middle.abs() < 0.02, "{shadows:?}: the edge is off by {middle}");
    let step = row.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max) / full;
    ((crossing(0.9) - crossing(0.1)) * per_pixel, step)
}

#[test]
fn edges_are_as_soft_as_designed() {
    let Some(_) = gpu() else { return };
    let [hard, soft, softer] = [Shadows::Hard, Shadows::Soft, Shadows::Softer].map(edge);
    // Seen from the lamp, the box of the scene is as wide as the plate is high, with 6 % around it: what a
    // texel of the finest map, of 2048, covers. Softness is 0.7 % of the height to each side, but no more
    // than nine texels.
    let texel = 1.06 * 2.0 * PLATE / 2048.0;
    let reach = (0.007 * 2.0 * PLATE).min(9.0 * texel) / 0.8;
    // Of a sum of Gaussian weights exp(−1.5 x²), −1 to 1, the middle 80 % span 1.4.
    assert!((softer.0 / (1.4 * reach) - 1.0).abs() < 0.15, "{softer:?} {reach}");
    assert!(hard.0 < 0.4 * soft.0 && soft.0 < 0.8 * softer.0, "{hard:?} {soft:?} {softer:?}");
    // More samples: smaller steps.
    assert!(softer.1 < 0.6 * soft.1, "{soft:?} {softer:?}");
}
