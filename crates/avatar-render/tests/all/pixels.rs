//! What pictures show: several avatars, their order, textures and materials.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{bare_light, light_of, lit_scene};
use crate::common::{
    ball, checkered_eye, flat_light, gpu, largest_difference, model, part, plain, scene, shadings, square,
};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::headless::{Canvas, render_image};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Environment, Image, Material, NoSuchPart, PartBones, PartDesc,
    PartTextures, Scene, Shading,
};
use glam::{Affine3A, Vec3};

const SIZE: u32 = 64;

#[test]
fn two_avatars_of_one_model_have_their_own_states() {
    let Some(gpu) = gpu() else { return };
    let mut mesh = ball(Vec3::ZERO, 0.6, 12);
    let swollen: Vec<Vec3> = mesh.normals.iter().map(|n| *n * 0.5).collect();
    mesh.shapes.push(avatar_mesh::Shape::new("swell", swollen));
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
    let (first, mut near) = checkered_eye(gpu, true);
    let (second, mut far) = checkered_eye(gpu, true);
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
        let (model, state) = model(gpu, &[part(mesh, PartKind::Surface, textures)]);
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
fn a_transparent_texture_shows_the_material() {
    let Some(gpu) = gpu() else { return };
    let mesh = square(Vec3::ZERO, 1.0);
    let (clear, veil) = (plain([0, 255, 0, 0]), plain([0, 255, 0, 128]));
    for (name, shading) in shadings() {
        let draw = |color| {
            let textures = PartTextures { color, ..PartTextures::default() };
            let avatar = model(gpu, &[part(&mesh, PartKind::Skin, textures)]);
            light_of(shading, 32, &Scene { light: flat_light(), ..scene(4.0) }, &avatar).middle()
        };
        assert_eq!(draw(Some(&clear)), draw(None), "{name}");
        let half = draw(Some(&veil));
        assert!(half.y > draw(None).y + 0.1, "{name}: {half}");
    }
}

#[test]
fn occlusion_darkens_and_keeps_the_colour_of_light_that_bounces() {
    let Some(gpu) = gpu() else { return };
    let mesh = square(Vec3::ZERO, 1.0);
    let dark = plain([60, 60, 60, 255]);
    let avatars = [None, Some(&dark)].map(|occlusion| {
        let textures = PartTextures { occlusion, ..PartTextures::default() };
        model(gpu, &[part(&mesh, PartKind::Skin, textures)])
    });
    let albedo = [0.7, 0.4, 0.1];
    let matte = Material {
        color: albedo,
        reflectance: 0.0,
        roughness_matte: 1.0,
        roughness_glossy: 1.0,
        ..Material::of(PartKind::Skin)
    };
    let seen = 60.0 / 255.0f32;
    // J. Jimenez et al., "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016, eq. 10:
    // bounces between walls of the colour that they have.
    let bounced = albedo.map(|albedo| {
        let (a, b, c) = (2.0404 * albedo - 0.3324, -4.7951 * albedo + 0.6417, 2.7552 * albedo + 0.6903);
        seen.max(((seen * a + b) * seen + c) * seen)
    });
    for (name, shading) in shadings() {
        let [open, hidden] = avatars.each_ref().map(|avatar| {
            avatar.0.set_material(&gpu.queue, 0, &matte).expect("a part");
            let scene = lit_scene(scene(4.0).camera, bare_light(Environment::uniform([1.0; 3])));
            light_of(shading, 32, &scene, avatar).middle()
        });
        let left = (hidden / open).to_array();
        match shading {
            Shading::Natural(_) => {
                for (left, expected) in left.iter().zip(bounced) {
                    assert!((left - expected).abs() < 0.03, "{name}: {left:?} for {expected:?}");
                }
            }
            Shading::Plain => assert!(left.iter().all(|left| (left - seen).abs() < 0.03), "{name}: {left:?}"),
            // Tones, not shades: one of two.
            Shading::Toon => assert!(left.iter().all(|left| (0.4..0.9).contains(left)), "{name}: {left:?}"),
        }
    }
}

#[test]
fn a_material_can_be_replaced() {
    let Some(gpu) = gpu() else { return };
    let mesh = square(Vec3::ZERO, 1.0);
    let (model, state) = model(gpu, &[part(&mesh, PartKind::Skin, PartTextures::default())]);
    let green = Material { color: [0.0, 0.5, 0.0], ..Material::of(PartKind::Skin) };
    model.set_material(&gpu.queue, 0, &green).expect("a part");
    let refused = model.set_material(&gpu.queue, 1, &green);
    assert_eq!(refused, Err(NoSuchPart { parts: 1, found: 1 }));
    assert_eq!(NoSuchPart { parts: 1, found: 1 }.to_string(), "expected a part below 1, found 1");
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
        first_weight: 0,
        kind: PartKind::Skin,
        bones: PartBones::Rigid(0),
        textures: PartTextures::default(),
    };
    let (model, state) = model(gpu, &[part(&cloud, PartKind::Cornea, PartTextures::default()), skin]);
    let picture = render_image(gpu, 8, 8, 4, &scene(4.0), &[(&model, &state)]).expect("a picture");
    assert!(picture.rgba.chunks_exact(4).all(|p| p == [0, 0, 0, 255]));
}
