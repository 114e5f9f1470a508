//! Wrinkles: there where and when shapes bring them in, and lit as grooves are.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{Picture, key_light, light_of, lit_scene};
use crate::common::{gpu, model, part, shadings};
use avatar_mesh::{Mesh, PartKind, Shape};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Image, Light, Material, PartTextures, Shading, Terms, Wrinkle, Wrinkles,
};
use glam::{Affine3A, Vec2, Vec3};

const SIZE: u32 = 128;
/// How deep the groove is, in heights of the skin.
const DEPTH: f32 = 0.02;
/// Half its width on a skin of height 2.
const HALF_WIDTH: f32 = 0.2;

/// A sheet of 2 × 2 with many vertices and a shape that moves nothing to be seen.
fn sheet() -> Mesh {
    const CELLS: u32 = 32;
    let mut mesh = Mesh::default();
    for (row, column) in (0..=CELLS).flat_map(|row| (0..=CELLS).map(move |column| (row, column))) {
        let uv = Vec2::new(column as f32, row as f32) / CELLS as f32;
        mesh.positions.push(Vec3::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0));
        mesh.normals.push(Vec3::Z);
        mesh.uvs.push(uv);
    }
    for (row, column) in (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (row, column))) {
        let a = row * (CELLS + 1) + column;
        let [b, c, d] = [a + 1, a + CELLS + 1, a + CELLS + 2];
        mesh.triangles.extend([[a, c, b], [b, c, d]]);
    }
    let still = vec![Vec3::ZERO; mesh.positions.len()];
    mesh.shapes = ["first", "second"].map(|name| Shape::new(name, still.clone())).into();
    mesh
}

/// A level groove across the middle, whose walls are even.
fn groove() -> Image {
    const PIXELS: u32 = 128;
    let pixels = (0..PIXELS * PIXELS).flat_map(|i| {
        let y = 1.0 - 2.0 * ((i / PIXELS) as f32 + 0.5) / PIXELS as f32;
        let depth = (255.0 * (1.0 - y.abs() / HALF_WIDTH).max(0.0)).round() as u8;
        [depth, depth, depth, 255]
    });
    Image { width: PIXELS, height: PIXELS, rgba: pixels.collect() }
}

fn matte() -> Material {
    Material {
        color: [0.5; 3],
        reflectance: 0.0,
        pore_strength: 0.0,
        transmission: 0.0,
        wrap: [0.0; 3],
        wrinkle_depth: DEPTH,
        ..Material::of(PartKind::Skin)
    }
}

/// The sheet, whose second shape wrinkles what lies around `center`.
fn wrinkled(center: Vec3, radius: f32) -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let (mesh, depths) = (sheet(), groove());
    let places = [Wrinkle { center, radius, shapes: vec![(1, 1.0)] }];
    let wrinkles = Some(Wrinkles { depths: &depths, places: &places });
    let avatar =
        model(gpu, &[part(&mesh, PartKind::Skin, PartTextures { wrinkles, ..PartTextures::default() })]);
    avatar.0.set_material(&gpu.queue, 0, &matte()).expect("a part");
    avatar
}

fn shown(
    avatar: &mut (AvatarModel, AvatarState),
    weights: [f32; 2],
    light: &Light,
    shading: Shading,
) -> Picture {
    let queue = &gpu().expect("asked before").queue;
    avatar.1.set(queue, &[Affine3A::IDENTITY], &weights).expect("a bone and two weights");
    light_of(shading, SIZE, &lit_scene(camera(), *light), avatar)
}

fn camera() -> Camera {
    Camera::orbit(Vec3::ZERO, 12.0, 0.0, 0.0, 0.2, 1.0)
}

#[test]
fn walls_of_a_groove_are_lit_by_their_slope() {
    let Some(_) = gpu() else { return };
    let mut avatar = wrinkled(Vec3::ZERO, 30.0);
    let shading = Shading::Natural(Terms::NONE);
    for to_lamp in [Vec3::new(0.0, 1.0, 1.0), Vec3::new(0.0, -0.5, 1.0), Vec3::Z] {
        let light = key_light(to_lamp.normalize_or_zero());
        let [flat, grooved] = [0.0, 1.0].map(|weight| shown(&mut avatar, [0.0, weight], &light, shading));
        for side in [1.0, -1.0] {
            // The depth of 0.04 on the way of 0.2: walls that face the middle. The colour darkens toward the
            // bottom, so that a place near the edge tells most of the slope.
            let normal = Vec3::new(0.0, -side * 2.0 * DEPTH / HALF_WIDTH, 1.0).normalize_or_zero();
            let at = Vec3::new(0.1, side * 0.85 * HALF_WIDTH, 0.0);
            let cosine = |normal: Vec3| normal.dot(to_lamp.normalize_or_zero());
            // What is left of light in the groove, 15 % of the way down, whose colour is 0.76 at the bottom.
            let expected = cosine(normal) / cosine(Vec3::Z) * (1.0 - 0.15 * (1.0 - 0.76));
            let found = grooved.at(&camera(), at).x / flat.at(&camera(), at).x;
            assert!((found - expected).abs() < 0.05, "{to_lamp}, {side}: {found} for {expected}");
        }
    }
}

#[test]
fn wrinkles_are_there_only_where_and_when_their_shapes_bring_them_in() {
    let Some(gpu) = gpu() else { return };
    let (center, radius) = (Vec3::new(0.4, 0.0, 0.0), 0.5);
    let mut with = wrinkled(center, radius);
    let mesh = sheet();
    let mut without = model(gpu, &[part(&mesh, PartKind::Skin, PartTextures::default())]);
    without.0.set_material(&gpu.queue, 0, &matte()).expect("a part");
    let light = key_light(Vec3::new(0.0, 1.0, 1.0).normalize_or_zero());
    for (_, shading) in shadings() {
        let plain = shown(&mut without, [0.0, 0.0], &light, shading);
        // At rest, with another shape, with their own, and at rest again.
        for (weights, is_smooth) in
            [([0.0; 2], true), ([1.0, 0.0], true), ([0.0, 0.5], false), ([0.0; 2], true)]
        {
            let found = shown(&mut with, weights, &light, shading);
            assert_eq!(found.light == plain.light, is_smooth, "{shading:?}, {weights:?}");
        }
    }
    let shading = Shading::Natural(Terms::NONE);
    let plain = shown(&mut without, [0.0, 0.0], &light, shading);
    let [half, whole] = [0.5, 1.0].map(|weight| shown(&mut with, [0.0, weight], &light, shading));
    let change = |picture: &Picture, x: f32| {
        let at = Vec3::new(x, -0.7 * HALF_WIDTH, 0.0);
        (picture.at(&camera(), at) - plain.at(&camera(), at)).abs().max_element()
    };
    assert!(change(&whole, 0.4) > 1.3 * change(&half, 0.4) && change(&half, 0.4) > 0.01);
    for beyond in [-0.9, -0.3, -0.15, 0.95] {
        assert_eq!(change(&whole, beyond), 0.0, "{beyond}");
    }
}
