//! Eyes: the iris behind the cornea lies where Snell's law says, and the cornea shines without hiding it.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common;
use crate::common::stage::{Picture, bare_light, light_of, lit_scene, pixel_of, ray_through};
use crate::common::{ball, checkered_eye, gpu, model, part, scene, shadings, square};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Environment, Image, Iris, Lamp, Light, Material, PartTextures, Shading,
    Shadows, Terms,
};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};

const SIZE: u32 = 128;

/// Where the eye's flat front lies, how far the painting reaches on it, and the cornea's sphere in front of
/// it.
const FRONT_Z: f32 = 0.2;
const REACH: f32 = 2.0;
const CORNEA_RADIUS: f32 = 1.3;
const CORNEA_EDGE: f32 = 1.0;
/// Its edge lies on the front: √(1.3² − 1) behind it.
const CORNEA_CENTER: Vec3 = Vec3::new(0.0, 0.0, FRONT_Z - 0.830_662);
/// What of the texture a unit of the front covers.
const UV_PER_LENGTH: f32 = 0.4 / REACH;
/// Radius of the iris.
const IRIS_RADIUS: f32 = 0.8;

/// Rings around +Z at these radii, `z` by the radius, out to the last.
fn rings(radii: &[f32], z: impl Fn(f32) -> f32, normal: impl Fn(Vec3) -> Vec3) -> Mesh {
    const STEPS: u32 = 48;
    let mut mesh = Mesh::default();
    for radius in radii {
        for step in 0..STEPS {
            let angle = step as f32 * std::f32::consts::TAU / STEPS as f32;
            let p = Vec3::new(radius * angle.cos(), radius * angle.sin(), z(*radius));
            mesh.positions.push(p);
            mesh.normals.push(normal(p));
            // Rows of a texture run downward.
            mesh.uvs.push(Vec2::splat(0.5) + UV_PER_LENGTH * Vec2::new(p.x, -p.y));
        }
    }
    for ring in 0..radii.len() as u32 - 1 {
        for step in 0..STEPS {
            let [a, b] = [step, (step + 1) % STEPS].map(|step| ring * STEPS + step);
            mesh.triangles.push([a, a + STEPS, b]);
            mesh.triangles.push([b, a + STEPS, b + STEPS]);
        }
    }
    mesh
}

/// A flat disc as the front of an eyeball, so that the depth of the iris is exact, and a cap as its cornea.
fn eye_meshes() -> [Mesh; 2] {
    let radii: Vec<f32> = (0..=40).map(|i| REACH * i as f32 / 40.0).collect();
    let disc = rings(&radii, |_| FRONT_Z, |_| Vec3::Z);
    let radii: Vec<f32> = (0..=20).map(|i| CORNEA_EDGE * i as f32 / 20.0).collect();
    let cap = rings(
        &radii,
        |r| CORNEA_CENTER.z + (CORNEA_RADIUS * CORNEA_RADIUS - r * r).sqrt(),
        |p| (p - CORNEA_CENTER).normalize_or_zero(),
    );
    // A far back, so that the ball is deep and its front counts as such.
    let mut ball = disc;
    ball.positions.push(Vec3::new(0.0, 0.0, -2.2));
    ball.normals.push(Vec3::NEG_Z);
    ball.uvs.push(Vec2::ZERO);
    [ball, cap]
}

/// An eye that shows its painting as it is: nothing shines, nothing darkens.
fn eye(painting: &Image, iris: Iris, with_cornea: bool) -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let [ball, cap] = eye_meshes();
    let textures = PartTextures { color: Some(painting), ..PartTextures::default() };
    let mut parts = vec![part(&ball, PartKind::Eyeball, textures)];
    if with_cornea {
        parts.push(part(&cap, PartKind::Cornea, PartTextures::default()));
    }
    let avatar = model(gpu, &parts);
    let iris = Iris { radius: IRIS_RADIUS / CORNEA_EDGE, ..iris };
    let dry = Material { wetness: 0.0, reflectance: 0.0, back_light: 1.0, ..Material::of(PartKind::Eyeball) };
    avatar.0.set_material(&gpu.queue, 0, &Material { iris, ..dry }).expect("a part");
    if with_cornea {
        let clear = Material { wetness: 0.0, reflectance: 0.0, opacity: 0.0, color: [0.0; 3], ..dry };
        avatar.0.set_material(&gpu.queue, 1, &clear).expect("a part");
    }
    avatar
}

const PLAIN_IRIS: Iris =
    Iris { limbal_darkness: 0.0, pupil: 0.4, painted_pupil: 0.4, depth: 0.15, ..Iris::DEFAULT };

/// A painting by the place on the front, −1 to 1 on it being the square around its circle.
fn painting(color: impl Fn(Vec2) -> [f32; 3]) -> Image {
    const PIXELS: u32 = 256;
    let pixels = (0..PIXELS * PIXELS).flat_map(|i| {
        let uv = (Vec2::new((i % PIXELS) as f32, (i / PIXELS) as f32) + 0.5) / PIXELS as f32;
        let at = (uv - 0.5) / UV_PER_LENGTH * Vec2::new(1.0, -1.0);
        let [r, g, b] = color(at);
        [r, g, b, 1.0].map(|value| (value * 255.0).round() as u8)
    });
    Image { width: PIXELS, height: PIXELS, rgba: pixels.collect() }
}

fn room() -> Light {
    bare_light(Environment::uniform([1.0; 3]))
}

fn optics(eye_optics: bool) -> Shading {
    Shading::Natural(Terms { eye_optics, ..Terms::NONE })
}

/// From the side, at the middle of the eye's front.
fn camera(yaw_degrees: f32) -> Camera {
    Camera::orbit(Vec3::new(0.0, 0.0, FRONT_Z), 20.0, yaw_degrees.to_radians(), 0.0, 0.14, 1.0)
}

/// Where a line of sight meets the plane of the iris, in double precision: in through the cornea's sphere,
/// bent toward its normal so that sin i = n sin t.
fn seen_on_iris(from: Vec3, direction: Vec3, index: f64, plane_z: f64) -> Option<DVec3> {
    let (from, direction) = (from.as_dvec3(), direction.as_dvec3().normalize_or_zero());
    let to = from - CORNEA_CENTER.as_dvec3();
    let b = to.dot(direction);
    let root = b * b - to.length_squared() + f64::from(CORNEA_RADIUS).powi(2);
    let entry = from + direction * (-b - (root >= 0.0).then(|| root.sqrt())?);
    let normal = (entry - CORNEA_CENTER.as_dvec3()).normalize_or_zero();
    // The part of the direction along the surface shrinks by the index; the rest follows from its length.
    let along = (direction - normal * direction.dot(normal)) / index;
    let inside = along - normal * (1.0 - along.length_squared()).sqrt();
    let reach = (plane_z - entry.z) / inside.z;
    Some(entry + inside * reach)
}

/// A soft red spot on blue, and how red it is at a place of the front.
fn spot(at: Vec2, middle: Vec2) -> f32 {
    (-(at - middle).length_squared() / (0.1f32 * 0.1)).exp()
}

#[test]
fn the_iris_is_seen_where_snells_law_says() {
    let Some(_) = gpu() else { return };
    for middle in [Vec2::new(0.35, 0.2), Vec2::new(-0.45, -0.1), Vec2::new(0.05, -0.5)] {
        let painted = painting(|at| [spot(at, middle), 0.0, 0.5]);
        let avatar = eye(&painted, PLAIN_IRIS, true);
        let (mut bent_by, mut shifted_by) = (0.0f32, 0.0f32);
        for yaw in [0.0, 30.0, 55.0, -55.0] {
            let camera = camera(yaw);
            let draw = |on| light_of(optics(on), SIZE, &lit_scene(camera, room()), &avatar);
            let picture = draw(true);
            // Reflections are white.
            let red = |light: Vec3| (light.x - light.y).max(0.0);
            let found = picture.centroid(red);
            // The same spot, looked for with rays.
            let plane_z = f64::from(FRONT_Z - PLAIN_IRIS.depth * CORNEA_EDGE);
            let by_rays = |index: f32, plane_z: f64| {
                let light = picture.pixels().map(|(at, _)| {
                    let ray = ray_through(&camera, SIZE, at);
                    let seen = seen_on_iris(camera.eye(), ray, index.into(), plane_z);
                    let red = seen.map_or(0.0, |p| spot(p.as_vec3().truncate(), middle));
                    Vec3::X * red
                });
                Picture { size: SIZE, light: light.collect() }.centroid(|light| light.x)
            };
            let expected = by_rays(PLAIN_IRIS.refractive_index, plane_z);
            // The painting's radii are known at 16 places, to 2 % (see `eye_shape`): 1 % of the iris' own
            // radius.
            let radius = pixel_of(&camera, SIZE, Vec3::new(0.0, IRIS_RADIUS, FRONT_Z));
            let tolerance = 0.015 * (radius.y - SIZE as f32 / 2.0).abs() + 0.25;
            let error = found.distance(expected);
            assert!(error < tolerance, "{middle} at {yaw}°: {found} for {expected}");
            // Without refraction, and without depth, it would be elsewhere: the test can tell.
            let flat = draw(false).centroid(red);
            let unbent = by_rays(1.0, plane_z);
            shifted_by = shifted_by.max(flat.distance(expected) / tolerance);
            bent_by = bent_by.max(unbent.distance(expected) / tolerance);
        }
        assert!(bent_by > 4.0 && shifted_by > 4.0, "{middle}: {bent_by}, {shifted_by}");
    }
}

#[test]
fn nothing_bends_light_that_enters_no_other_medium_or_has_no_cornea() {
    let Some(_) = gpu() else { return };
    let painted = painting(|at| [0.5 + 0.4 * (9.0 * at.x).sin(), 0.5 + 0.4 * (7.0 * at.y).sin(), 0.3]);
    let draw = |avatar: &(AvatarModel, AvatarState), on, yaw| {
        light_of(optics(on), SIZE, &lit_scene(camera(yaw), room()), avatar)
    };
    for yaw in [0.0, 30.0, 55.0] {
        // A cornea of air in front of an iris on the surface.
        let air = Iris { refractive_index: 1.0, depth: 0.0, ..PLAIN_IRIS };
        let through_air = eye(&painted, air, true);
        let (bent, straight) = (draw(&through_air, true, yaw), draw(&through_air, false, yaw));
        // The colours change by up to 3.6 per unit of the front; the painting's radii are known to 2 %.
        let share = bent.difference_share(&straight, 3.6 * 0.02 * IRIS_RADIUS);
        assert!(share < 0.002, "{share} at {yaw}°");
        let glass = eye(&painted, PLAIN_IRIS, true);
        let share = draw(&glass, true, yaw).difference_share(&straight, 3.6 * 0.02 * IRIS_RADIUS);
        assert!(share > 0.03, "{share} at {yaw}°: the comparison can tell");
        // Without a cornea there is nothing to look through.
        let bare = eye(&painted, PLAIN_IRIS, false);
        assert_eq!(draw(&bare, true, yaw), draw(&bare, false, yaw));
    }
}

#[test]
fn the_pupil_is_as_wide_as_it_is_told() {
    let Some(_) = gpu() else { return };
    let (painted_pupil, index) = (0.4, 1.0);
    let painted = painting(|at| {
        let is_dark = at.length() < painted_pupil * IRIS_RADIUS;
        if is_dark { [0.0; 3] } else { [1.0; 3] }
    });
    for shading in [optics(true), Shading::Natural(Terms::MEDIUM), Shading::Toon] {
        for pupil in [0.2, 0.4, 0.6, 0.8] {
            // On the surface and not bent: as large as it is.
            let iris = Iris { pupil, painted_pupil, depth: 0.0, refractive_index: index, ..PLAIN_IRIS };
            let scene = lit_scene(camera(0.0), room());
            let picture = light_of(shading, SIZE, &scene, &eye(&painted, iris, true));
            let edge = pixel_of(&camera(0.0), SIZE, Vec3::new(IRIS_RADIUS, 0.0, FRONT_Z)).x;
            let radius = pupil * (edge - SIZE as f32 / 2.0);
            // Toon draws a ring around the iris, dark as well: look inside of it.
            let inside = edge - SIZE as f32 / 2.0 - 4.0;
            let middle = Vec2::splat(SIZE as f32 / 2.0);
            let dark = picture.pixels().filter(|(at, light)| at.distance(middle) < inside && light.x < 0.35);
            let expected = std::f32::consts::PI * radius.min(inside).powi(2);
            let found = dark.count() as f32;
            // A pixel on the circle may fall to either side, and 2 % of the radius.
            let tolerance = std::f32::consts::TAU * radius * (0.5 + 0.03 * radius);
            assert!((found - expected).abs() < tolerance, "{shading:?}: {found} for {expected} at {pupil}");
        }
    }
}

#[test]
fn an_eye_turned_with_the_camera_and_the_lamps_is_the_same_picture() {
    let Some(gpu) = gpu() else { return };
    let painted = painting(|at| [0.5 + 0.4 * (9.0 * at.x).sin(), 0.5 + 0.4 * (7.0 * at.y).sin(), 0.3]);
    let (model, mut state) = eye(&painted, PLAIN_IRIS, true);
    let lamp = Vec3::new(0.3, 0.4, 1.0);
    for (name, shading) in shadings() {
        let mut draw = |turn: Affine3A| {
            state.set(&gpu.queue, &[turn], &[]).expect("one bone");
            let straight = camera(35.0);
            let camera = Camera { world_from_camera: turn * straight.world_from_camera, ..straight };
            let key = Lamp { direction_world: turn.transform_vector3(lamp), radiance: [0.5; 3] };
            let light = Light { key, ..bare_light(Environment::uniform([0.5; 3])) };
            let stage = common::stage::stage(shading, SIZE).expect("a GPU");
            stage.draw(gpu, &lit_scene(camera, light), &[(&model, &state)])
        };
        let straight = draw(Affine3A::IDENTITY);
        // Around the vertical: the brow's shade is one from above.
        for angle in [0.6, -1.1, 2.8] {
            let turn =
                Affine3A::from_rotation_translation(Quat::from_rotation_y(angle), Vec3::new(2.0, 1.0, -3.0));
            let share = draw(turn).difference_share(&straight, 0.012);
            assert!(share < 0.01, "{name}, {angle}: {share}");
        }
        // The eye alone turned is another picture.
        let turn = Affine3A::from_rotation_y(0.3);
        state.set(&gpu.queue, &[turn], &[]).expect("one bone");
        let light = Light { ..bare_light(Environment::uniform([0.5; 3])) };
        let stage = common::stage::stage(shading, SIZE).expect("a GPU");
        let other = stage.draw(gpu, &lit_scene(camera(35.0), light), &[(&model, &state)]);
        assert!(other.difference_share(&straight, 0.012) > 0.1, "{name}");
    }
}

#[test]
fn the_iris_is_seen_through_the_cornea_and_the_highlight_is_bright() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene(6.0);
    scene.light.key.direction_world = Vec3::new(0.2, 0.2, 1.0);
    for (name, shading) in shadings() {
        let [bare, covered] = [false, true].map(|with_cornea| {
            let avatar = checkered_eye(gpu, with_cornea);
            // What shines is to be the cornea.
            let dry = Material { wetness: 0.0, ..Material::of(PartKind::Eyeball) };
            avatar.0.set_material(&gpu.queue, usize::from(with_cornea), &dry).expect("a part");
            light_of(shading, SIZE, &scene, &avatar)
        });
        let brightest =
            |picture: &Picture| picture.light.iter().map(|light| light.min_element()).fold(0.0, f32::max);
        assert!(brightest(&bare) < 0.25, "{name}: {}", brightest(&bare));
        assert!(brightest(&covered) > 0.75, "{name}: {}", brightest(&covered));
        // Away from highlights the cornea changes the iris a little, and hides neither red nor blue.
        for (x, y) in [(50, 78), (78, 78)] {
            let (behind, seen) = (bare.pixel(x, y), covered.pixel(x, y));
            assert_ne!(behind, seen, "{name}: the cornea covers the iris");
            assert!((behind - seen).abs().max_element() < 0.12, "{name}: {behind} {seen}");
            let redder = |light: Vec3| light.x - light.z;
            assert!(redder(behind) * redder(seen) > 0.0, "{name}: {behind} {seen}");
            assert!(redder(seen).abs() > 0.5 * redder(behind).abs(), "{name}: {behind} {seen}");
        }
    }
}

#[test]
fn a_lamp_that_is_off_or_weak_does_not_darken_the_eye() {
    let Some(gpu) = gpu() else { return };
    let avatar = checkered_eye(gpu, true);
    for (name, shading) in shadings() {
        let draw = |toward, radiance: f32| {
            let key = Lamp { direction_world: toward, radiance: [radiance; 3] };
            let light = Light { key, ..bare_light(Environment::uniform([0.5; 3])) };
            light_of(shading, SIZE, &lit_scene(scene(6.0).camera, light), &avatar)
        };
        let (front, behind) = (Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
        assert!(draw(front, 0.0).difference_share(&draw(behind, 0.0), 0.003) < 0.0001, "{name}");
        let (weak, off) = (draw(front, 0.02), draw(front, 0.0));
        let darkened = weak.light.iter().zip(&off.light).map(|(w, o)| (*o - *w).max_element());
        assert!(darkened.fold(0.0, f32::max) < 0.01, "{name}");
    }
}

#[test]
fn a_cornea_behind_the_skin_is_hidden_and_hides_nothing_itself() {
    let Some(gpu) = gpu() else { return };
    let lid = square(Vec3::new(0.0, 0.0, 1.0), 1.0);
    let cornea = ball(Vec3::ZERO, 0.5, 8);
    let skin = part(&lid, PartKind::Skin, PartTextures::default());
    let closed = model(gpu, &[part(&cornea, PartKind::Cornea, PartTextures::default()), skin]);
    let alone = model(gpu, &[skin]);
    for (name, shading) in shadings() {
        // The box of the avatar is part of the view of the lamps: without shadows it is the same for both.
        let shading = match shading {
            Shading::Natural(terms) => Shading::Natural(Terms { shadows: Shadows::Off, ..terms }),
            other => other,
        };
        let [closed, alone] = [&closed, &alone].map(|avatar| light_of(shading, 64, &scene(5.0), avatar));
        assert!(closed.difference_share(&alone, 0.004) < 0.01, "{name}");
    }
}

/// An iris that is painted in one colour and shown in another looks as if it were painted in that other
/// one; the white around it stays.
#[test]
fn the_iris_takes_the_color_that_it_is_to_have() {
    let Some(_) = gpu() else { return };
    // sRGB of textures; 188 of 255 is half of the light.
    let linear = |value: f32| ((value + 0.055) / 1.055).powf(2.4);
    let (gray, brown) = ([0.5, 0.5, 0.5], [0.45, 0.3, 0.2]);
    let in_colors =
        |inside: [f32; 3]| painting(move |at| if at.length() < IRIS_RADIUS { inside } else { [0.9; 3] });
    let iris = Iris { color: brown.map(linear), painted_color: gray.map(linear), ..PLAIN_IRIS };
    let recolored = eye(&in_colors(gray), iris, true);
    let painted = eye(&in_colors(brown), PLAIN_IRIS, true);
    for shading in [Shading::Plain, optics(true), Shading::Toon] {
        let camera = camera(0.0);
        let [a, b] =
            [&recolored, &painted].map(|eye| light_of(shading, SIZE, &lit_scene(camera, room()), eye));
        for radius in [0.0, 0.3, 0.6, 1.2, 1.5] {
            let at = Vec3::new(radius, 0.0, FRONT_Z);
            let error = (a.at(&camera, at) - b.at(&camera, at)).abs().max_element();
            assert!(error < 3.0 / 255.0, "{shading:?} at {radius}: {error}");
        }
    }
}
