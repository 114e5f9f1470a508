//! Light that spreads below the skin: past the edge of light, red farthest, and through what is thin.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

mod common;

use avatar_look::optics::diffusion_distance;
use avatar_look::scatter_table;
use avatar_mesh::{Mesh, PartKind};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Material, PartTextures, Scattering, Shading, Shadows, Terms,
};
use common::stage::{key_light, light_of, lit_scene, meets_ball, ray_through};
use common::{ball, gpu, model, part, plain, square};
use glam::Vec3;

const SIZE: u32 = 128;

/// A large ball and a small one in one head, so that lengths are the same for both.
const BALLS: [(Vec3, f32); 2] = [(Vec3::new(0.0, 1.0, 0.0), 1.0), (Vec3::new(0.0, -0.6, 0.0), 0.25)];
/// From the top of the one to the bottom of the other.
const HEIGHT: f32 = 2.85;

fn terms(scattering: Scattering) -> Terms {
    Terms { scattering, ..Terms::NONE }
}

/// Skin that shows the light below it as it is.
fn white_skin() -> Material {
    Material {
        color: [1.0; 3],
        reflectance: 0.0,
        roughness_matte: 1.0,
        roughness_glossy: 1.0,
        scatter: [0.08, 0.03, 0.01],
        sharp_share: 0.0,
        pore_strength: 0.0,
        ..Material::of(PartKind::Skin)
    }
}

fn balls() -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let meshes = BALLS.map(|(center, radius)| ball(center, radius, 32));
    let none = PartTextures::default();
    let avatar = model(gpu, &meshes.each_ref().map(|mesh| part(mesh, PartKind::Skin, none)));
    for place in 0..2 {
        assert!(avatar.0.set_material(&gpu.queue, place, &white_skin()));
    }
    avatar
}

/// A ball lit from the right and seen from the front, so that the edge of light is in the middle, and where it is seen
/// head on: cosines with the lamp and light.
fn across_the_edge(terms: Terms, place: usize, avatar: &(AvatarModel, AvatarState)) -> Vec<(f32, Vec3)> {
    let (center, radius) = BALLS[place];
    let camera = Camera::orbit(center, 20.0 * radius, 0.0, 0.0, 0.11, 1.0);
    let scene = lit_scene(camera, key_light(Vec3::X));
    let picture = light_of(Shading::Natural(terms), SIZE, &scene, avatar);
    let points = picture.pixels().filter_map(|(at, light)| {
        let ray = ray_through(&camera, SIZE, at);
        let normal = (meets_ball(camera.eye(), ray, center, radius)? - center) / radius;
        // Not toward the silhouette: what the skin's surface reflects is not the matter here.
        (normal.z > 0.7 && normal.y.abs() < 0.1).then_some((normal.x, light))
    });
    points.collect()
}

#[test]
fn pre_integrated_light_is_that_of_the_table_at_the_curvature_of_the_ball() {
    let Some(_) = gpu() else { return };
    let avatar = balls();
    let (width, height) = (256, 128);
    let table = scatter_table(width, height);
    for (place, (_, radius)) in BALLS.into_iter().enumerate() {
        for (n_dot_l, light) in across_the_edge(terms(Scattering::PreIntegrated), place, &avatar) {
            for (channel, path) in white_skin().scatter.into_iter().enumerate() {
                // The albedo that the renderer takes skin to have.
                let distance = diffusion_distance(path * HEIGHT, 0.6);
                let row = ((distance / radius).min(1.0) * height as f32) as usize;
                let column = ((n_dot_l * 0.5 + 0.5) * width as f32) as usize;
                let expected = table[row.min(height - 1) * width + column];
                let error = (light[channel] - expected).abs();
                let said = format!("channel {channel} on radius {radius}, at {n_dot_l}");
                // Far beyond the edge of light the renderer lets it fade: that falls on insides.
                let fades = n_dot_l < -0.28 && light[channel] < expected;
                assert!(fades || error < 0.01, "{} for {expected}: {said}", light[channel]);
            }
        }
    }
}

/// The mean light a little beyond the edge of light.
fn past_the_edge(terms: Terms, place: usize, avatar: &(AvatarModel, AvatarState)) -> Vec3 {
    let points = across_the_edge(terms, place, avatar);
    let beyond: Vec<Vec3> =
        points.iter().filter(|(x, _)| (-0.12..-0.04).contains(x)).map(|(_, l)| *l).collect();
    assert!(beyond.len() > 10);
    beyond.iter().sum::<Vec3>() / beyond.len() as f32
}

#[test]
fn red_reaches_farthest_past_the_edge_and_farther_on_a_small_ball() {
    let Some(_) = gpu() else { return };
    let avatar = balls();
    for scattering in [Scattering::PreIntegrated, Scattering::Separable] {
        for shadows in [Shadows::Off, Shadows::Soft, Shadows::Softer] {
            let terms = Terms { shadows, ..terms(scattering) };
            let [large, small] = [0, 1].map(|place| past_the_edge(terms, place, &avatar));
            let said =
                format!("{scattering:?}, {shadows:?}: {large} on the large ball, {small} on the small one");
            assert!(small.x > 0.03, "{said}");
            assert!(small.x > 1.3 * small.y && small.y > 1.3 * small.z, "{said}");
            assert!(small.x > 1.5 * large.x, "{said}");
        }
    }
}

#[test]
fn both_ways_of_scattering_agree_where_light_is_even() {
    let Some(_) = gpu() else { return };
    let avatar = balls();
    let [table, blurred] = [Scattering::PreIntegrated, Scattering::Separable]
        .map(|scattering| across_the_edge(terms(scattering), 0, &avatar));
    let mut compared = 0;
    for ((n_dot_l, table), (_, blurred)) in table.iter().zip(&blurred) {
        if *n_dot_l > 0.4 {
            assert!((*table - *blurred).abs().max_element() < 0.04, "{table} {blurred} at {n_dot_l}");
            compared += 1;
        }
    }
    assert!(compared > 50, "{compared}");
}

fn slab(thickness: f32) -> Mesh {
    let front = square(Vec3::new(0.0, 0.0, 0.5 * thickness), 1.0);
    let mut mesh = front.clone();
    for (p, uv) in front.positions.iter().zip(&front.uvs) {
        mesh.positions.push(*p - Vec3::Z * thickness);
        mesh.normals.push(Vec3::NEG_Z);
        mesh.uvs.push(*uv);
    }
    mesh.triangles.extend(front.triangles.iter().map(|[a, b, c]| [*a + 4, *c + 4, *b + 4]));
    mesh
}

/// What comes through a slab from a lamp straight behind it.
fn through(thickness: f32, texture: bool, terms: Terms) -> Vec3 {
    let gpu = gpu().expect("asked before");
    let mesh = slab(thickness);
    // As thick as white means.
    let white = plain([255; 4]);
    let textures = PartTextures { thickness: texture.then_some(&white), ..PartTextures::default() };
    let avatar = model(gpu, &[part(&mesh, PartKind::Skin, textures)]);
    let material = Material { thickness: thickness / 2.0, transmission: 1.0, ..white_skin() };
    assert!(avatar.0.set_material(&gpu.queue, 0, &material));
    let camera = Camera::orbit(Vec3::ZERO, 12.0, 0.0, 0.0, 0.1, 1.0);
    light_of(Shading::Natural(terms), 32, &lit_scene(camera, key_light(Vec3::NEG_Z)), &avatar).middle()
}

#[test]
fn thin_parts_glow_red_from_behind_and_thick_ones_do_not() {
    let Some(_) = gpu() else { return };
    for (scattering, texture) in [
        (Scattering::PreIntegrated, false),
        (Scattering::PreIntegrated, true),
        (Scattering::Separable, false),
        (Scattering::Separable, true),
    ] {
        let terms = Terms { shadows: Shadows::Soft, transmission: true, ..terms(scattering) };
        // Beer and Lambert over the mean free path, which is measured by the height, 2. Half the light at most comes
        // through, spread around the far pole where a texture knows of thin parts: (1 + 0.3) / 1.3².
        let wrap = if texture { 1.0 / 1.3 } else { 1.0 };
        let expected = |thickness: f32| {
            Vec3::from_array(white_skin().scatter.map(|path| 0.5 * wrap * (-thickness / (2.0 * path)).exp()))
        };
        for thickness in [0.05, 0.12, 0.3] {
            let light = through(thickness, texture, terms);
            let said = format!("{light} for {}: {scattering:?}, {texture}, {thickness}", expected(thickness));
            // Depths are known to some texels, 1.2 ‰ of the height each: of the way to the eighth at most.
            assert!((light - expected(thickness)).abs().max_element() < 0.06, "{said}");
            assert!(light.x > 1.5 * light.y && light.y > 1.5 * light.z, "{said}");
        }
        let thick = through(2.0, texture, terms);
        assert!(thick.max_element() < 0.002, "{thick}: {scattering:?}, {texture}");
        let off = through(0.05, texture, Terms { transmission: false, ..terms });
        assert!(off.max_element() < 0.002, "{off}: {scattering:?}, {texture}");
    }
}

#[test]
fn what_is_thick_is_as_bright_from_the_front_with_transmission_as_without() {
    let Some(_) = gpu() else { return };
    let avatar = balls();
    for scattering in [Scattering::PreIntegrated, Scattering::Separable] {
        let terms = Terms { shadows: Shadows::Soft, ..terms(scattering) };
        let [without, with] =
            [false, true].map(|transmission| across_the_edge(Terms { transmission, ..terms }, 0, &avatar));
        for ((n_dot_l, without), (_, with)) in without.iter().zip(&with) {
            if *n_dot_l > 0.3 {
                let said = format!("{scattering:?}: {with} for {without} at {n_dot_l}");
                assert!((*with - *without).abs().max_element() < 0.02, "{said}");
            }
        }
    }
}
