//! Environments: what is looked up, summed over hemispheres, and blurred, against sums that share no code
//! with them.

use avatar_look::{CUBE_FACES, Environment, PANEL_COUNT, Panel, cube_direction, irradiance_at};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use std::f64::consts::TAU;

const PRESETS: [Environment; 3] = [Environment::STUDIO, Environment::DAYLIGHT, Environment::DARK_ROOM];

fn assert_near(left: Vec3, right: Vec3, epsilon: f32) {
    assert!(left.abs_diff_eq(right, epsilon), "{left} is not {right}");
}

/// Evenly spread directions, `2 · rings²`.
fn sphere(rings: i32) -> impl Iterator<Item = Vec3> {
    (0..rings).flat_map(move |i| {
        let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(rings);
        let width = (1.0 - y * y).sqrt();
        (0..2 * rings).map(move |j| {
            let (sin, cos) = (f64::from(j) * TAU / f64::from(2 * rings)).sin_cos();
            DVec3::new(width * cos, y, width * sin).as_vec3()
        })
    })
}

fn irradiance_by_sum(environment: &Environment, normal: Vec3) -> Vec3 {
    let rings = 120;
    let sum = sphere(rings).fold(DVec3::ZERO, |sum, direction| {
        sum + (environment.radiance(direction) * normal.dot(direction).max(0.0)).as_dvec3()
    });
    // 4π per direction, over π for a white matte surface.
    (sum * 4.0 / f64::from(2 * rings * rings)).as_vec3()
}

#[test]
fn radiance_is_a_gradient_with_soft_panels() {
    let panel =
        Panel { direction_world: Vec3::new(0.0, 0.0, 3.0), radius_rad: 0.4, radiance: [2.0, 1.0, 0.5] };
    let mut environment = Environment { sky: [0.4; 3], ground: [0.2; 3], panels: [Panel::OFF; PANEL_COUNT] };
    environment.panels[2] = panel;
    let at = |angle_rad: f32| environment.radiance(Vec3::new(angle_rad.sin(), 0.0, angle_rad.cos()));
    approx::assert_abs_diff_eq!(environment.radiance(5.0 * Vec3::Y).x, 0.4, epsilon = 1e-6);
    approx::assert_abs_diff_eq!(environment.radiance(-Vec3::Y).x, 0.2, epsilon = 1e-6);
    approx::assert_abs_diff_eq!(environment.radiance(Vec3::ZERO).x, 0.4, epsilon = 1e-6);
    approx::assert_abs_diff_eq!(at(0.0).x, 2.3, epsilon = 1e-6);
    approx::assert_abs_diff_eq!(at(0.3).x, 1.3, epsilon = 1e-4);
    approx::assert_abs_diff_eq!(at(0.4).x, 0.3, epsilon = 1e-4);
    approx::assert_abs_diff_eq!(at(2.0).x, 0.3, epsilon = 1e-6);
    // Nowhere steeper than a smooth step over half the radius: no jump.
    for i in 0..2000 {
        let angle_rad = i as f32 / 2000.0;
        assert!((at(angle_rad + 0.0005).x - at(angle_rad).x).abs() < 2.0 * 1.5 / 0.2 * 0.0006);
    }
}

#[test]
fn irradiance_of_an_even_environment_is_its_radiance() {
    let coefficients = Environment::uniform([1.0, 0.5, 0.25]).irradiance();
    for normal in sphere(10) {
        assert_near(irradiance_at(&coefficients, normal), Vec3::new(1.0, 0.5, 0.25), 1e-6);
    }
}

#[test]
fn irradiance_of_a_gradient_is_exact() {
    let mut environment = Environment::STUDIO;
    environment.panels = [Panel::OFF; PANEL_COUNT];
    let coefficients = environment.irradiance();
    for normal in sphere(4) {
        let sum = irradiance_by_sum(&environment, normal);
        assert_near(irradiance_at(&coefficients, normal), sum, 2e-4);
    }
}

#[test]
fn irradiance_of_the_presets_is_near_the_sum() {
    for environment in PRESETS {
        let coefficients = environment.irradiance();
        let (mut square, mut mean) = (0.0, 0.0);
        for normal in sphere(6) {
            let (light, sum) =
                (irradiance_at(&coefficients, normal), irradiance_by_sum(&environment, normal));
            square += (light - sum).length_squared();
            mean += sum.length_squared();
        }
        // Ramamoorthi and Hanrahan found 3 % at most for photographed surroundings; the panels of a dark room
        // are all there is, and get the window.
        let limit = if environment == Environment::DARK_ROOM { 0.08 } else { 0.03 };
        assert!((square / mean).sqrt() < limit, "{}", (square / mean).sqrt());
    }
}

#[test]
fn cube_directions_are_those_of_the_sampler() {
    // The major axis picks the face, s and t are the other two over it: the rules of WebGPU's texture
    // sampling.
    for face in 0..CUBE_FACES {
        for (column, row) in [(0, 0), (5, 2), (7, 7), (3, 6)] {
            let d = cube_direction(face, 8, column, row);
            assert!((d.length() - 1.0).abs() < 1e-6);
            let (s, t, major) = match face {
                0 => (-d.z, -d.y, d.x),
                1 => (d.z, -d.y, -d.x),
                2 => (d.x, d.z, d.y),
                3 => (d.x, -d.z, -d.y),
                4 => (d.x, -d.y, d.z),
                _ => (-d.x, -d.y, -d.z),
            };
            assert_eq!(d.abs().max_element(), major);
            approx::assert_abs_diff_eq!((s / major + 1.0) * 4.0, column as f32 + 0.5, epsilon = 1e-5);
            approx::assert_abs_diff_eq!((t / major + 1.0) * 4.0, row as f32 + 0.5, epsilon = 1e-5);
        }
    }
}

fn texels(size: u32) -> impl Iterator<Item = (u32, u32, u32)> {
    (0..CUBE_FACES * size * size).map(move |i| (i / (size * size), i % size, i / size % size))
}

#[test]
fn reflections_of_a_mirror_are_the_radiance() {
    let levels = Environment::STUDIO.reflections(16, 5);
    assert_eq!(levels.iter().map(Vec::len).collect::<Vec<_>>(), [1536, 384, 96, 24, 6]);
    for (texel, (face, column, row)) in levels[0].iter().zip(texels(16)) {
        let radiance = Environment::STUDIO.radiance(cube_direction(face, 16, column, row));
        assert_near(Vec3::from_slice(texel), radiance, 1e-5);
        assert_eq!(texel[3], 1.0);
    }
}

#[test]
fn reflections_of_an_even_environment_are_even() {
    for level in Environment::uniform([1.0, 0.5, 0.25]).reflections(16, 7) {
        for texel in level {
            approx::assert_abs_diff_eq!(texel[..], [1.0, 0.5, 0.25, 1.0][..], epsilon = 1e-5);
        }
    }
}

/// A mean over the sphere; texels at the corners of a face are smaller.
fn mean(level: &[[f32; 4]], size: u32) -> Vec3 {
    let (mut sum, mut total) = (Vec3::ZERO, 0.0);
    for (texel, (_, column, row)) in level.iter().zip(texels(size)) {
        let at = |i: u32| (2.0 * i as f32 + 1.0) / size as f32 - 1.0;
        let solid = (1.0 + at(column).powi(2) + at(row).powi(2)).powf(-1.5);
        sum += Vec3::from_slice(texel) * solid;
        total += solid;
    }
    sum / total
}

#[test]
fn blurring_keeps_the_mean() {
    for environment in PRESETS {
        let levels = environment.reflections(64, 6);
        let mirror = mean(&levels[0], 64);
        for (i, level) in levels.iter().enumerate() {
            let share = mean(level, 64 >> i) / mirror;
            assert!((share - 1.0).abs().max_element() < 0.03, "level {i}: {share}");
        }
    }
}

#[test]
fn a_rough_level_agrees_with_a_sum_over_the_sphere() {
    let (size, levels) = (4, 5);
    let alpha = 0.75f32 * 0.75;
    let level = &Environment::STUDIO.reflections(size << 3, levels)[3];
    for (texel, (face, column, row)) in level.iter().zip(texels(size)).step_by(7) {
        let normal = cube_direction(face, size, column, row);
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for light in sphere(120).filter(|light| normal.dot(*light) > 0.0) {
            let n_dot_h = normal.dot((light + normal).normalize_or_zero());
            let weight = avatar_look::optics::ggx_distribution(n_dot_h, alpha) * normal.dot(light);
            sum += (Environment::STUDIO.radiance(light) * weight).as_dvec3();
            total += f64::from(weight);
        }
        let expected = (sum / total).as_vec3();
        assert_near(Vec3::from_slice(texel) / expected, Vec3::ONE, 0.02);
    }
}

#[test]
fn a_mirrored_environment_gives_the_mirrored_map() {
    let size = 8u32;
    for mirror in [Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, 1.0, -1.0)] {
        let mut mirrored = Environment::STUDIO;
        mirrored.panels.iter_mut().for_each(|panel| panel.direction_world *= mirror);
        let (levels, others) = (Environment::STUDIO.reflections(size, 4), mirrored.reflections(size, 4));
        for (i, (level, other)) in levels.iter().zip(&others).enumerate() {
            let size = size >> i;
            for (texel, (face, column, row)) in level.iter().zip(texels(size)) {
                let wanted = cube_direction(face, size, column, row) * mirror;
                let found = texels(size).zip(other).find(|((face, column, row), _)| {
                    cube_direction(*face, size, *column, *row).abs_diff_eq(wanted, 1e-6)
                });
                let (_, other) = found.expect("a cube is symmetric");
                approx::assert_abs_diff_eq!(texel[..], other[..], epsilon = 2e-5);
            }
        }
    }
}

#[test]
fn sizes_out_of_range_do_no_harm() {
    assert_eq!(Environment::STUDIO.reflections(0, 1).len(), 1);
    assert!(Environment::STUDIO.reflections(8, 0).is_empty());
    assert_eq!(Environment::STUDIO.reflections(2, u32::MAX).len(), 13);
}

fn panels() -> impl Strategy<Value = [Panel; PANEL_COUNT]> {
    let panel = (prop::array::uniform3(-1.0f32..1.0), 0.0f32..3.2, prop::array::uniform3(0.0f32..5.0));
    prop::array::uniform4(panel.prop_map(|(direction, radius_rad, radiance)| Panel {
        direction_world: direction.into(),
        radius_rad,
        radiance,
    }))
}

proptest! {
    #[test]
    fn irradiance_is_never_negative(panels in panels(), sky in 0.0f32..0.2, ground in 0.0f32..0.2) {
        let environment = Environment { sky: [sky; 3], ground: [ground; 3], panels };
        let coefficients = environment.irradiance();
        for normal in sphere(24) {
            prop_assert!(irradiance_at(&coefficients, normal).min_element() >= 0.0);
        }
    }
}
