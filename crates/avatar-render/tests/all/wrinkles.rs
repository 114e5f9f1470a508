//! Wrinkles: there where and when shapes bring them in, and lit as grooves are.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{Picture, Stage, key_light, light_of, lit_scene};
use crate::common::{gpu, model, part, shadings};
use avatar_mesh::{Mesh, PartKind, Shape};
use avatar_render::{
    AvatarCrowd, AvatarModel, AvatarState, Camera, Image, Light, Material, PartTextures, Scene, Shading,
    Terms, Tone, ToneMap, Wrinkle, Wrinkles,
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

/// Where the skin is smooth, the programs with grooves draw what those without them draw, to the bit.
#[test]
fn smooth_skin_is_the_same_beside_wrinkles() {
    let Some(gpu) = gpu() else { return };
    // The second shape wrinkles a place where the sheet has nothing.
    let mut avatar = wrinkled(Vec3::splat(1e4), 1.0);
    avatar.0.set_material(&gpu.queue, 0, &Material::of(PartKind::Skin)).expect("a part");
    let light = Light::studio();
    for (name, shading) in shadings() {
        let [rest, beside] = [0.0, 1.0].map(|weight| shown(&mut avatar, [0.0, weight], &light, shading));
        assert!(rest.middle().min_element() > 0.0, "{name}");
        assert!(rest.light == beside.light, "{name}");
    }
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// A crowd of which one has wrinkles looks as its avatars do one by one, and so does one that had some.
#[test]
fn one_of_a_crowd_may_be_wrinkled() {
    let Some(gpu) = gpu() else { return };
    let (model, _) = wrinkled(Vec3::new(0.4, 0.0, 0.0), 0.5);
    let place = |avatar: usize| Affine3A::from_translation(Vec3::X * (2.2 * avatar as f32 - 1.1));
    let camera = Camera::orbit(Vec3::ZERO, 12.0, 0.0, 0.0, 0.4, 1.0);
    let scene = lit_scene(camera, Light::studio());
    let mut crowd = AvatarCrowd::new(&gpu.device, &model, 2).expect("room");
    for (name, shading) in shadings() {
        let stage = Stage::new(gpu, shading, SIZE, FORMAT);
        let mut at_rest = None;
        for wrinkled in [[false; 2], [false, true], [true, true], [false; 2]] {
            // Boxes of usual weights are wider in crowds, and shadow maps are fitted around them: the first
            // weight, which moves nothing, is unusual.
            let weights = wrinkled.map(|wrinkled| [-0.5, if wrinkled { 1.0 } else { 0.0 }]);
            let mut states = [(); 2].map(|()| AvatarState::new(&gpu.device, &model));
            for (avatar, weights) in weights.iter().enumerate() {
                let bones = [place(avatar)];
                states[avatar].set(&gpu.queue, &bones, weights).expect("a bone and two weights");
                crowd.set(&model, avatar, &bones, weights).expect("a bone and two weights");
            }
            let one_by_one = stage.bytes(gpu, &scene, &states.each_ref().map(|state| (&model, state)));
            let together = stage.bytes_of_crowds(gpu, &scene, &[], &mut [(&model, &mut crowd)]);
            assert!(one_by_one == together, "{name}: {wrinkled:?}");
            let rest = at_rest.get_or_insert_with(|| together.clone());
            assert_eq!(*rest == together, wrinkled == [false; 2], "{name}: {wrinkled:?}");
        }
    }
}

#[test]
fn what_wrinkles_need_is_made_when_they_come_or_ahead() {
    let Some(gpu) = gpu() else { return };
    let scene = lit_scene(camera(), Light::studio());
    let set = |state: &mut AvatarState, weight: f32| {
        state.set(&gpu.queue, &[Affine3A::IDENTITY], &[0.0, weight]).expect("a bone and two weights");
    };
    for (name, shading) in shadings() {
        let (model, mut state) = wrinkled(Vec3::ZERO, 30.0);
        let stage = || Stage::new(gpu, shading, SIZE, FORMAT);
        let (by_drawing, ahead) = (stage(), stage());
        for weight in [0.0, 1.0] {
            set(&mut state, weight);
            let is_ready = by_drawing.renderer.is_ready(&scene, &[(&model, &state)]);
            assert_eq!(is_ready, weight == 0.0, "{name}");
            by_drawing.bytes(gpu, &scene, &[(&model, &state)]);
            assert!(by_drawing.renderer.is_ready(&scene, &[(&model, &state)]), "{name}, {weight}");
        }
        ahead.renderer.prepare(&scene, &model);
        set(&mut state, 0.0);
        let [drawn, rehearsed] = [false, true].map(|rehearses| {
            ahead.bytes_after(gpu, |encoder| {
                let view = ahead.texture.create_view(&wgpu::TextureViewDescriptor::default());
                let (renderer, targets, avatars) = (&ahead.renderer, &ahead.targets, [(&model, &state)]);
                let recorded = match rehearses {
                    true => renderer.rehearse(encoder, &view, targets, &gpu.queue, &scene, &avatars),
                    false => renderer.draw(encoder, &view, targets, &gpu.queue, &scene, &avatars),
                };
                recorded.expect("what belongs together");
            })
        });
        assert!(drawn == rehearsed, "{name}");
        for weight in [0.0, 1.0] {
            set(&mut state, weight);
            assert!(ahead.renderer.is_ready(&scene, &[(&model, &state)]), "{name}, {weight}");
        }
        // Another tone of the skin needs others.
        let tone = Tone { color: [0.2, 0.1, 0.05], ..matte().tone };
        model.set_material(&gpu.queue, 0, &Material { tone, ..matte() }).expect("a part");
        assert!(!ahead.renderer.is_ready(&scene, &[(&model, &state)]), "{name}");
        model.set_material(&gpu.queue, 0, &matte()).expect("a part");
        // So does another tone mapping.
        let light = Light { tone_map: ToneMap::AgX, ..scene.light };
        let in_agx = Scene { light, ..scene };
        assert!(!ahead.renderer.is_ready(&in_agx, &[(&model, &state)]), "{name}");
        ahead.renderer.prepare(&in_agx, &model);
        assert!(ahead.renderer.is_ready(&in_agx, &[(&model, &state)]), "{name}");
        assert!(ahead.renderer.is_ready(&scene, &[(&model, &state)]), "{name}");
    }
}
