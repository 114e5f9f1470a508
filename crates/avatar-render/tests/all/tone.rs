//! Light becomes the colours that the tone mappers' definitions say, in every kind of target.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{Stage, bare_light, light_of, lit_scene};
use crate::common::{gpu, model, part, scene, square};
use avatar_mesh::PartKind;
use avatar_render::{Environment, Light, Material, PartTextures, Shading, Terms, ToneMap};
use glam::Vec3;

/// Nothing but diffuse light from the environment.
const SHADING: Shading = Shading::Natural(Terms::NONE);
const SIZE: u32 = 4;

/// Light, and what Neutral and AgX make of it: computed in double precision from the definitions, by a
/// program that knows none of these crates.
fn chart() -> impl Iterator<Item = [Vec3; 3]> {
    include_str!("../../../avatar-look/tests/tone_chart.csv").lines().skip(1).map(|line| {
        let numbers: Vec<f32> = line.split(',').map_while(|number| number.parse().ok()).collect();
        assert_eq!(numbers.len(), 9, "{line}");
        [0, 3, 6].map(|i| Vec3::new(numbers[i], numbers[i + 1], numbers[i + 2]))
    })
}

/// IEC 61966-2-1, 0 to 255.
fn srgb(light: Vec3) -> Vec3 {
    let encode = |c: f32| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    255.0 * Vec3::from_array(light.clamp(Vec3::ZERO, Vec3::ONE).to_array().map(encode))
}

/// A white plate in a room of this colour is of this colour, half of it by exposure.
fn room(color: Vec3, tone_map: ToneMap) -> Light {
    let light = bare_light(Environment::uniform((2.0 * color).to_array()));
    Light { exposure: 0.5, tone_map, ..light }
}

fn white() -> Material {
    Material {
        color: [1.0; 3],
        reflectance: 0.0,
        wetness: 0.0,
        // Out of any mouth.
        back_light: 1.0,
        ..Material::of(PartKind::Surface)
    }
}

#[test]
fn the_chart_comes_out_as_computed_elsewhere() {
    let Some(gpu) = gpu() else { return };
    let mesh = square(Vec3::ZERO, 9.0);
    let avatar = model(gpu, &[part(&mesh, PartKind::Surface, PartTextures::default())]);
    avatar.0.set_material(&gpu.queue, 0, &white()).expect("a part");
    assert!(chart().count() > 200);
    for [light, by_neutral, by_agx] in chart() {
        for (tone_map, expected) in [(ToneMap::Neutral, by_neutral), (ToneMap::AgX, by_agx)] {
            let scene = lit_scene(scene(4.0).camera, room(light, tone_map));
            let found = light_of(SHADING, SIZE, &scene, &avatar).middle();
            // In steps of 8 bits; half floats near 1 are a ninth of one apart.
            let error = (srgb(found) - srgb(expected)).abs().max_element();
            assert!(error < 0.15, "{tone_map:?}: {found} for {expected}, of {light}: {error} steps");
        }
        // Linear is what it says, beyond 1 too.
        let scene = lit_scene(scene(4.0).camera, room(light, ToneMap::Linear));
        let found = light_of(SHADING, SIZE, &scene, &avatar).middle();
        assert!(((found - light) / (light + 1e-5)).abs().max_element() < 2e-3, "{found} for {light}");
    }
}

#[test]
fn targets_of_8_bits_hold_the_chart_to_one_step_however_they_encode() {
    let Some(gpu) = gpu() else { return };
    let mesh = square(Vec3::ZERO, 9.0);
    let avatar = model(gpu, &[part(&mesh, PartKind::Surface, PartTextures::default())]);
    avatar.0.set_material(&gpu.queue, 0, &white()).expect("a part");
    let formats = [
        (wgpu::TextureFormat::Rgba8UnormSrgb, [0, 1, 2]),
        (wgpu::TextureFormat::Rgba8Unorm, [0, 1, 2]),
        (wgpu::TextureFormat::Bgra8UnormSrgb, [2, 1, 0]),
        (wgpu::TextureFormat::Bgra8Unorm, [2, 1, 0]),
    ];
    for (format, order) in formats {
        let stage = Stage::new(gpu, SHADING, SIZE, format);
        for [light, by_neutral, by_agx] in chart().step_by(7) {
            for (tone_map, expected) in [(ToneMap::Neutral, by_neutral), (ToneMap::AgX, by_agx)] {
                let scene = lit_scene(scene(4.0).camera, room(light, tone_map));
                let bytes = stage.bytes(gpu, &scene, &[(&avatar.0, &avatar.1)]);
                let expected = srgb(expected);
                for (channel, place) in order.into_iter().enumerate() {
                    let error = (f32::from(bytes[place]) - expected[channel]).abs();
                    assert!(error <= 1.0, "{format:?}, {tone_map:?}: {bytes:?} for {expected}");
                }
                assert_eq!(bytes[3], 255);
            }
        }
    }
}
