//! Light that spreads below the skin: past the edge of light, red farthest, and through what is thin.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{key_light, light_of, lit_scene, meets_ball, ray_through, stage};
use crate::common::{ball, gpu, model, part, plain, square};
use avatar_look::optics::diffusion_distance;
use avatar_look::scatter_table;
use avatar_mesh::{Mesh, PartKind};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Lamp, Light, Material, PartTextures, Scattering, Shading, Shadows,
    Terms,
};
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
        avatar.0.set_material(&gpu.queue, place, &white_skin()).expect("a part");
    }
    avatar
}

/// A ball lit from the right and seen from the front, so that the edge of light is in the middle, and where
/// it is seen head on: cosines with the lamp and light.
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

#[test]
fn lamps_brighter_than_halves_can_be_are_as_bright_as_their_exposure_shows_them() {
    let Some(gpu) = gpu() else { return };
    let avatar = balls();
    let camera = Camera::orbit(BALLS[0].0, 20.0, 0.0, 0.0, 0.11, 1.0);
    for scattering in [Scattering::PreIntegrated, Scattering::Separable] {
        let stage = stage(Shading::Natural(terms(scattering)), SIZE).expect("asked before");
        let [usual, bright] = [1.0, 1e6f32].map(|radiance| {
            let toward = Vec3::new(0.6, 0.0, 0.8);
            let key = Lamp { direction_world: toward, radiance: [radiance; 3] };
            let light = Light { key, exposure: radiance.recip(), ..key_light(toward) };
            stage.draw(gpu, &lit_scene(camera, light), &[(&avatar.0, &avatar.1)])
        });
        assert!(usual.middle().x > 0.5, "{}", usual.middle());
        assert_eq!(usual.difference_share(&bright, 0.004), 0.0, "{scattering:?}: {}", bright.middle());
    }
}

/// The share of light that arrives beside an edge, at `x` times Burley's parameter from it, toward the light
/// positive: the profile `(exp(−r) + exp(−r/3)) / (8π r)` summed over the half plane that is lit (P.
/// Christensen and B. Burley, 2015).
fn beside_an_edge(x: f64) -> f64 {
    // By rings: the share of each that lies in the light.
    const RINGS: i32 = 20_000;
    let width = 40.0 / f64::from(RINGS);
    let sum = (0..RINGS).map(|i| {
        let r = (f64::from(i) + 0.5) * width;
        let lit = (-x / r).clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
        0.25 * ((-r).exp() + (-r / 3.0).exp()) * width * lit
    });
    sum.sum()
}

#[test]
fn blurred_light_fades_beside_an_edge_as_the_profile_says() {
    let Some(gpu) = gpu() else { return };
    // A plate whose left half is turned away from the lamp, as far as its normals say.
    let half = |x: f32, normal: Vec3| {
        let mut mesh = square(Vec3::new(x, 0.0, 0.0), 1.0);
        mesh.normals = vec![normal; 4];
        mesh
    };
    let (mut plate, right) = (half(-1.0, Vec3::new(-0.6, 0.0, 0.8)), half(1.0, Vec3::Z));
    plate.positions.extend(right.positions);
    plate.normals.extend(right.normals);
    plate.uvs.extend(right.uvs);
    plate.triangles.extend(right.triangles.iter().map(|corners| corners.map(|i| i + 4)));
    let avatar = model(gpu, &[part(&plate, PartKind::Skin, PartTextures::default())]);
    // Height 2; all channels alike.
    let path = 0.04;
    let material = Material { scatter: [path; 3], ..white_skin() };
    avatar.0.set_material(&gpu.queue, 0, &material).expect("a part");
    let distance = diffusion_distance(2.0 * path, 0.6);
    // Thirty times the parameter across the picture; the lamp sees the left half from behind.
    let camera = Camera::orbit(Vec3::ZERO, 30.0 * distance / 0.1, 0.0, 0.0, 2.0 * 0.05f32.atan(), 1.0);
    let scene = lit_scene(camera, key_light(Vec3::new(0.8, 0.0, 0.6)));
    let picture = light_of(Shading::Natural(terms(Scattering::Separable)), SIZE, &scene, &avatar);
    let row: Vec<f32> = (0..SIZE).map(|x| picture.pixel(x, SIZE / 2).x).collect();
    let full = row[SIZE as usize - 1];
    // An edge that sharp shows the 17 samples as steps: what is between the same distances is compared as a
    // whole.
    for (from, to) in [(-14.0, -8.0), (-8.0, -3.0), (-3.0, 0.0), (0.0, 3.0), (3.0, 8.0), (8.0, 14.0)] {
        let within = row.iter().enumerate().filter_map(|(x, light)| {
            let at = (x as f64 + 0.5 - f64::from(SIZE) / 2.0) * 30.0 / f64::from(SIZE);
            (from..to).contains(&at).then(|| (f64::from(light / full), beside_an_edge(at)))
        });
        let (count, found, expected) = within.fold((0.0, 0.0, 0.0), |(n, sum, twin), (light, expected)| {
            (n + 1.0, sum + light, twin + expected)
        });
        let (found, expected) = (found / count, expected / count);
        // Two Gaussians stand for the profile: they have its width and its tail, not the point of its peak,
        // which leaves 3 % more of the light right beside the edge.
        let tolerance = if from == -3.0 || to == 3.0 { 0.035 } else { 0.01 };
        assert!((found - expected).abs() < tolerance, "{found} for {expected} from {from} to {to}");
    }
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

/// What comes through a slab from a lamp straight behind it, by its colour.
fn through(thickness: f32, texture: bool, terms: Terms) -> Vec3 {
    // Takes in as much as comes through at most.
    const COLOR: f32 = 0.6;
    leaving_slab(thickness, texture, terms, COLOR, Vec3::NEG_Z) / COLOR
}

/// What leaves a slab of this colour toward +Z, lit from one side.
fn leaving_slab(thickness: f32, texture: bool, terms: Terms, color: f32, toward_lamp: Vec3) -> Vec3 {
    let gpu = gpu().expect("asked before");
    let mesh = slab(thickness);
    // As thick as white means.
    let white = plain([255; 4]);
    let textures = PartTextures { thickness: texture.then_some(&white), ..PartTextures::default() };
    let avatar = model(gpu, &[part(&mesh, PartKind::Skin, textures)]);
    let material =
        Material { color: [color; 3], thickness: thickness / 2.0, transmission: 1.0, ..white_skin() };
    avatar.0.set_material(&gpu.queue, 0, &material).expect("a part");
    let camera = Camera::orbit(Vec3::ZERO, 12.0, 0.0, 0.0, 0.1, 1.0);
    light_of(Shading::Natural(terms), 32, &lit_scene(camera, key_light(toward_lamp)), &avatar).middle()
}

#[test]
fn a_thin_sheet_reflects_and_lets_through_no_more_than_arrives() {
    let Some(_) = gpu() else { return };
    for scattering in [Scattering::Wrapped, Scattering::PreIntegrated, Scattering::Separable] {
        let terms = Terms { shadows: Shadows::Soft, transmission: true, ..terms(scattering) };
        for (texture, color) in [(false, 1.0), (false, 0.8), (false, 0.3), (true, 1.0), (true, 0.5)] {
            let [reflected, passed] = [Vec3::Z, Vec3::NEG_Z]
                .map(|toward_lamp| leaving_slab(0.01, texture, terms, color, toward_lamp));
            let said = format!("{reflected} and {passed}: {scattering:?}, {texture}, {color}");
            assert!((reflected + passed).max_element() < 1.02, "{said}");
            // Light goes somewhere: thin sheets glow unless their colour sends all of it back.
            assert!(passed.x > 0.1 || (color == 1.0 && !texture), "{said}");
        }
    }
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
        // Beer and Lambert over the mean free path, which is measured by the height, 2. Half the light at
        // most comes through, spread around the far pole where a texture knows of thin parts: (1 + 0.3) /
        // 1.3².
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
