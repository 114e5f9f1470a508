//! Surfaces as interchange files describe them: glTF 2.0, section 3.9, its appendix B,
//! `KHR_materials_unlit`, and the light of VRM's MToon.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{bare_light, key_light, light_of, lit_scene};
use crate::common::{gpu, model, part, plain, scene, shadings, square};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::{
    Cartoon, Environment, Image, Light, Lighting, Material, PartTextures, Scene, SecondUvs, Shading,
    Standard, ToneMap,
};
use glam::{Vec2, Vec3, Vec4};

/// The light in the middle of a square with this look.
fn middle(shading: Shading, scene: &Scene, mesh: &Mesh, textures: PartTextures<'_>, look: Standard) -> Vec3 {
    let gpu = gpu().expect("asked before");
    let avatar = model(gpu, &[part(mesh, PartKind::Surface, textures)]);
    let material = Material { standard: Some(look), ..Material::of(PartKind::Surface) };
    avatar.0.set_material(&gpu.queue, 0, &material).expect("a part");
    light_of(shading, 32, scene, &avatar).middle()
}

fn facing() -> Mesh {
    square(Vec3::ZERO, 1.0)
}

fn with(light: Light) -> Scene {
    lit_scene(scene(4.0).camera, light)
}

fn dark() -> Scene {
    with(bare_light(Environment::uniform([0.0; 3])))
}

fn close(found: Vec3, expected: Vec3, tolerance: f32, what: &str) {
    assert!((found - expected).abs().max_element() < tolerance, "{what}: {found} for {expected}");
}

/// Linear light of an 8-bit sRGB value: IEC 61966-2-1.
fn linear(byte: u8) -> f32 {
    ((f32::from(byte) / 255.0 + 0.055) / 1.055).powf(2.4)
}

#[test]
fn an_unlit_colour_is_factor_times_texture_times_vertex_in_any_light() {
    let Some(_) = gpu() else { return };
    let mesh = Mesh { colors: vec![Vec4::new(0.5, 1.0, 0.25, 1.0); 4], ..facing() };
    let texture = plain([188, 120, 240, 255]);
    let textures = PartTextures { color: Some(&texture), ..PartTextures::default() };
    let look = Standard {
        base_color: [0.5, 0.8, 0.9, 1.0],
        lighting: Lighting::Unlit,
        // What is seen as it is has no metal.
        metallic: 1.0,
        ..Standard::default()
    };
    let expected = Vec3::new(0.5 * 0.5 * linear(188), 0.8 * linear(120), 0.9 * 0.25 * linear(240));
    for (name, shading) in shadings() {
        let bright = Light { exposure: 3.0, tone_map: ToneMap::AgX, ..Light::studio() };
        for light in [Light::studio(), bright, bare_light(Environment::uniform([0.0; 3]))] {
            close(middle(shading, &with(light), &mesh, textures, look), expected, 2e-3, name);
        }
    }
}

#[test]
fn emitted_light_is_factor_times_texture_and_needs_no_lamp() {
    let Some(_) = gpu() else { return };
    let texture = plain([188, 255, 90, 255]);
    let textures = PartTextures { emissive: Some(&texture), ..PartTextures::default() };
    let look =
        Standard { base_color: [0.0, 0.0, 0.0, 1.0], emissive: [0.5, 0.25, 2.0], ..Standard::default() };
    let expected = Vec3::new(0.5 * linear(188), 0.25, 2.0 * linear(90));
    for (name, shading) in shadings().into_iter().filter(|(name, _)| *name != "toon") {
        close(middle(shading, &dark(), &facing(), textures, look), expected, 2e-3, name);
        let without = middle(shading, &dark(), &facing(), PartTextures::default(), look);
        close(without, Vec3::from(look.emissive), 2e-3, name);
    }
}

#[test]
fn a_metal_reflects_its_colour_by_the_formula_of_the_standard() {
    let Some(_) = gpu() else { return };
    let color = Vec3::new(0.9, 0.6, 0.2);
    let scene = with(key_light(Vec3::Z));
    // Head on: F is the colour, D is 1 / (π α²) and V is 1/4 (appendix B.3); a lamp of radiance 1 lights a
    // white matte surface to 1, hence times π.
    let lobe = |roughness: f32| 0.25 / roughness.powi(4);
    let rough = |green: u8, blue: u8| plain([0, green, blue, 255]);
    for (name, shading) in shadings().into_iter().filter(|(name, _)| *name != "toon") {
        let draw = |roughness, metallic, texture: Option<&Image>| {
            let textures = PartTextures { metallic_roughness: texture, ..PartTextures::default() };
            let [r, g, b] = color.to_array();
            let look = Standard { base_color: [r, g, b, 1.0], roughness, metallic, ..Standard::default() };
            middle(shading, &scene, &facing(), textures, look)
        };
        for roughness in [0.4f32, 0.7, 1.0] {
            let expected = color * lobe(roughness);
            close(draw(roughness, 1.0, None), expected, 0.02 * expected.max_element(), name);
            // A dielectric: the diffuse colour below 4 % of reflection.
            let expected = color * 0.96 + Vec3::splat(0.04 * lobe(roughness));
            close(draw(roughness, 0.0, None), expected, 0.05, name);
        }
        // Green is a factor on roughness, blue on metalness; 204 is 0.8.
        let expected = color * lobe(0.8 * 0.75);
        close(draw(0.75, 1.0, Some(&rough(204, 255))), expected, 0.02 * expected.max_element(), name);
        let expected = color * 0.96 + Vec3::splat(0.04 * lobe(0.75));
        close(draw(0.75, 1.0, Some(&rough(255, 0))), expected, 0.05, name);
    }
}

#[test]
fn occlusion_counts_as_much_as_its_strength_says() {
    let Some(_) = gpu() else { return };
    let texture = plain([64, 255, 255, 255]);
    let textures = PartTextures { occlusion: Some(&texture), ..PartTextures::default() };
    let scene = with(bare_light(Environment::uniform([1.0; 3])));
    let (_, shading) = shadings()[0];
    let draw = |occlusion_strength| {
        let look = Standard { occlusion_strength, ..Standard::default() };
        middle(shading, &scene, &facing(), textures, look).x
    };
    let open = draw(0.0);
    // 1 + strength · (texture − 1): section 3.9.3.
    for strength in [0.25, 0.5, 1.0f32] {
        let expected = 1.0 + strength * (64.0 / 255.0 - 1.0);
        assert!((draw(strength) / open - expected).abs() < 5e-3, "{} for {expected}", draw(strength) / open);
    }
}

#[test]
fn each_texture_lies_by_the_coordinates_that_its_material_names() {
    let Some(_) = gpu() else { return };
    // Red, green: which of them shows tells which coordinates were used.
    let halves = Image { width: 2, height: 1, rgba: [[255, 0, 0, 255], [0, 255, 0, 255]].concat() };
    let at = |u: f32| vec![Vec2::new(u, 0.5); 4];
    let mesh = Mesh { uvs: at(0.25), uvs_1: at(0.75), ..facing() };
    let textures = PartTextures { color: Some(&halves), emissive: Some(&halves), ..PartTextures::default() };
    for (name, shading) in shadings() {
        let draw = |base_color, emissive, lighting, second_uvs| {
            let look = Standard { base_color, emissive, lighting, second_uvs, ..Standard::default() };
            middle(shading, &dark(), &mesh, textures, look)
        };
        let of_color = |color| SecondUvs { color, ..SecondUvs::default() };
        close(draw([1.0; 4], [0.0; 3], Lighting::Unlit, of_color(false)), Vec3::X, 2e-3, name);
        close(draw([1.0; 4], [0.0; 3], Lighting::Unlit, of_color(true)), Vec3::Y, 2e-3, name);
        let black = [0.0, 0.0, 0.0, 1.0];
        let of_light = |emissive| SecondUvs { emissive, color: true, ..SecondUvs::default() };
        close(draw(black, [1.0; 3], Lighting::Lit, of_light(false)), Vec3::X, 2e-3, name);
        close(draw(black, [1.0; 3], Lighting::Lit, of_light(true)), Vec3::Y, 2e-3, name);
    }
}

#[test]
fn a_surface_of_one_side_is_seen_from_its_front_only() {
    let Some(_) = gpu() else { return };
    let front = square(Vec3::ZERO, 1.0);
    let back = Mesh {
        triangles: front.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect(),
        normals: vec![-Vec3::Z; 4],
        ..front.clone()
    };
    let scene = with(key_light(Vec3::Z));
    for (name, shading) in shadings() {
        let draw = |mesh: &Mesh, is_double_sided| {
            let look = Standard { is_double_sided, ..Standard::default() };
            middle(shading, &scene, mesh, PartTextures::default(), look)
        };
        let seen = draw(&front, false);
        assert!(seen.min_element() > 0.5, "{name}: {seen}");
        assert_eq!(draw(&back, false), Vec3::ZERO, "{name}");
        // The normal of a back side is reversed: section 3.7.2.1.
        close(draw(&back, true), seen, 2e-3, name);
        close(draw(&front, true), seen, 0.0001, name);
    }
}

#[test]
fn a_relief_turns_the_surface_by_its_texture_and_scale() {
    let Some(_) = gpu() else { return };
    // Tilted toward +u, which is the right of the picture, and up.
    let tilted = plain([228, 160, 206, 255]);
    let textures = PartTextures { normal: Some(&tilted), ..PartTextures::default() };
    let (_, shading) = shadings()[0];
    let draw = |toward_lamp, normal_strength| {
        let gpu = gpu().expect("asked before");
        let mesh = facing();
        let avatar = model(gpu, &[part(&mesh, PartKind::Surface, textures)]);
        let standard = Some(Standard::default());
        let material = Material { standard, normal_strength, ..Material::of(PartKind::Surface) };
        avatar.0.set_material(&gpu.queue, 0, &material).expect("a part");
        light_of(shading, 32, &with(key_light(toward_lamp)), &avatar).middle().x
    };
    // ⟨normalize((sample · 2 − 1) · (scale, scale, 1)), lamp⟩: section 3.9.3. White, so nearly the cosine.
    let [x, y, z] = [228.0, 160.0, 206.0f32].map(|texel| 2.0 * texel / 255.0 - 1.0);
    for scale in [0.5, 1.0] {
        let normal = Vec3::new(x * scale, y * scale, z).normalize_or_zero();
        let lamps = [(0.6, 0.0), (-0.3, 0.0), (0.0, 0.7), (0.0, -0.7f32)];
        for toward_lamp in lamps.map(|(x, y)| Vec3::new(x, y, (1.0 - x * x - y * y).sqrt())) {
            let (found, expected) = (draw(toward_lamp, scale), normal.dot(toward_lamp));
            assert!((found - expected).abs() < 0.06, "{scale}, {toward_lamp}: {found} for {expected}");
        }
    }
}

#[test]
fn a_cartoon_goes_from_shade_to_light_by_the_ramp_of_mtoon() {
    let Some(_) = gpu() else { return };
    let (lit, shade) = (Vec3::new(0.8, 0.4, 0.2), Vec3::new(0.1, 0.2, 0.5));
    for (name, shading) in shadings() {
        for (shading_shift, shading_toony) in [(0.0, 0.0), (0.0, 0.5), (-0.4, 0.2), (0.3, 0.9)] {
            let draw = |cosine: f32| {
                let toward_lamp = Vec3::new(0.0, (1.0 - cosine * cosine).sqrt(), cosine);
                let [r, g, b] = lit.to_array();
                let cartoon = Cartoon {
                    shade_color: shade.to_array(),
                    shading_shift,
                    shading_toony,
                    outline_width: 0.0,
                    outline_color: [0.0; 3],
                };
                let look = Standard {
                    base_color: [r, g, b, 1.0],
                    lighting: Lighting::Cartoon(cartoon),
                    ..Standard::default()
                };
                middle(shading, &with(key_light(toward_lamp)), &facing(), PartTextures::default(), look)
            };
            // VRMC_materials_mtoon 1.0: linearstep(−1 + toony, 1 − toony, N·L + shift).
            let share = |cosine: f32| {
                let (from, to) = (-1.0 + shading_toony, 1.0 - shading_toony);
                ((cosine + shading_shift - from) / (to - from)).clamp(0.0, 1.0)
            };
            // Lamps show 85 % of a drawn colour, as in the style toon.
            for cosine in [0.2f32, 0.6, 1.0] {
                let expected = shade.lerp(lit, share(cosine)) * 0.85;
                close(draw(cosine), expected, 0.01, &format!("{name}, {shading_shift}, {shading_toony}"));
            }
        }
    }
}

#[test]
fn the_line_around_a_cartoon_is_as_wide_as_it_says() {
    let Some(gpu) = gpu() else { return };
    let mesh = crate::common::ball(Vec3::ZERO, 1.0, 32);
    let (_, shading) = shadings()[0];
    let scene = with(key_light(Vec3::Z));
    let covered = |outline_width| {
        let avatar = model(gpu, &[part(&mesh, PartKind::Surface, PartTextures::default())]);
        let cartoon = Cartoon {
            shade_color: [1.0; 3],
            shading_shift: 0.0,
            shading_toony: 0.9,
            outline_width,
            outline_color: [0.0, 0.0, 1.0],
        };
        let standard = Some(Standard { lighting: Lighting::Cartoon(cartoon), ..Standard::default() });
        let material = Material { standard, ..Material::of(PartKind::Surface) };
        avatar.0.set_material(&gpu.queue, 0, &material).expect("a part");
        let picture = light_of(shading, 128, &scene, &avatar);
        picture.light.iter().filter(|light| light.z > 0.5).count() as f32
    };
    // From far enough, areas are nearly as radii squared; the eye at distance 4 sees a little more.
    let ratio = covered(0.1) / covered(0.0);
    assert!((1.19..1.26).contains(&ratio), "{ratio}");
}
