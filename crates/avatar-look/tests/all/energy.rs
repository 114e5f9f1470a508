//! White furnaces: no surface reflects more than it receives, whatever its looks.

use avatar_look::optics::{Cosines, Lobes, diffusion_distance, specular, two_lobe_specular, wrapped_diffuse};
use avatar_look::{directional_albedo, scatter_table, split_sum};
use glam::Vec3;
use std::f32::consts::TAU;

const ROUGHNESSES: [f32; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0];
const EYES: [f32; 8] = [0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0];
const REFLECTANCES: [f32; 3] = [0.02, 0.04, 1.0];

fn to_eye(n_dot_v: f32) -> Vec3 {
    Vec3::new((1.0 - n_dot_v * n_dot_v).sqrt(), 0.0, n_dot_v)
}

/// ∫ f(cosines) n·l dl over the hemisphere, in coordinates around the mirror direction of microfacets:
/// half-way vectors by polar angle, denser toward the peak of the narrower lobe. Uses none of the crate's
/// sampling.
fn reflected(n_dot_v: f32, alpha: f32, brdf: impl Fn(Cosines) -> f32) -> f64 {
    let (rings, spokes) = (600, 256);
    let to_eye = to_eye(n_dot_v);
    let mut sum = 0.0f64;
    for i in 0..rings {
        // tan θ = alpha √(x / (1 − x)) spreads x evenly over GGX's normals.
        // Smoothed at both ends: at grazing angles much light comes from the flanks of the peak.
        let t = (f64::from(i) + 0.5) / f64::from(rings);
        let x = t * t * (3.0 - 2.0 * t);
        let alpha2 = f64::from(alpha * alpha);
        let tan2 = alpha2 * x / (1.0 - x);
        let cos = 1.0 / (1.0 + tan2).sqrt();
        // d(solid angle)/dx = π d(sin²)/dx / cos.
        let dx = alpha2 / ((1.0 - x) * (1.0 - x));
        let solid = std::f64::consts::PI * dx * cos.powi(4) / cos * 6.0 * t * (1.0 - t) / f64::from(rings);
        for j in 0..spokes {
            let (sin_phi, cos_phi) = ((j as f32 + 0.5) / spokes as f32 * TAU).sin_cos();
            let sin = (tan2.sqrt() * cos) as f32;
            let half_way = Vec3::new(sin * cos_phi, sin * sin_phi, cos as f32);
            let v_dot_h = to_eye.dot(half_way);
            let n_dot_l = 2.0 * v_dot_h * half_way.z - n_dot_v;
            if v_dot_h > 0.0 && n_dot_l > 0.0 {
                let cosines = Cosines { n_dot_l, n_dot_v, n_dot_h: cos as f32, v_dot_h };
                // dl = 4 v·h dh.
                sum += f64::from(brdf(cosines) * n_dot_l * 4.0 * v_dot_h) * solid / f64::from(spokes);
            }
        }
    }
    sum
}

#[test]
fn one_lobe_reflects_at_most_what_it_receives_and_what_the_table_says() {
    let (mut most, mut worst) = (0.0f64, 0.0f64);
    for roughness in ROUGHNESSES {
        for n_dot_v in EYES {
            let [scale, bias] = directional_albedo(n_dot_v, roughness);
            for reflectance in REFLECTANCES {
                let alpha = roughness * roughness;
                let whole = reflected(n_dot_v, alpha, |cosines| specular(cosines, reflectance, alpha));
                assert!(whole <= 1.001, "{whole} at roughness {roughness}, n_dot_v {n_dot_v}");
                let table = f64::from(reflectance * scale + bias);
                most = most.max(whole);
                worst = worst.max((table - whole).abs());
                assert!((table - whole).abs() <= 0.003, "{table} for {whole}: {roughness}, {n_dot_v}");
                // A matte surface below the film gets what the film lets through: never more than 1 together.
                assert!(whole + (1.0 - table) <= 1.0 + 0.003);
            }
        }
    }
    println!("most {most}, worst error of the table {worst}");
}

#[test]
fn two_lobes_reflect_at_most_what_they_receive() {
    for roughness in ROUGHNESSES {
        for n_dot_v in EYES {
            for (sharp_share, sharp_roughness) in [(0.25, 0.55), (1.0, 0.5), (0.5, 0.8), (0.0, 0.5)] {
                let lobes = Lobes { roughness, sharp_share, sharp_roughness };
                // The narrower one decides where the integral has to look; 0.05² is the least that it
                // resolves.
                let alpha = (roughness * sharp_roughness).max(0.05).powi(2);
                let lobes = Lobes { sharp_roughness: alpha.sqrt() / roughness, ..lobes };
                let whole = reflected(n_dot_v, alpha, |cosines| two_lobe_specular(cosines, 1.0, lobes));
                assert!(whole <= 1.001, "{whole}: {lobes:?}, {n_dot_v}");
                let broad = reflected(n_dot_v, roughness * roughness, |cosines| {
                    specular(cosines, 1.0, roughness * roughness)
                });
                let sharp = reflected(n_dot_v, alpha, |cosines| specular(cosines, 1.0, alpha));
                let mixed = broad + (sharp - broad) * f64::from(sharp_share);
                assert!((whole - mixed).abs() < 0.01, "{whole} for {mixed}: {lobes:?}, {n_dot_v}");
            }
        }
    }
}

#[test]
fn cosines_of_vectors_match_those_of_the_integral() {
    let (eye, light) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.6, 0.8));
    let cosines = Cosines::between(Vec3::Z, eye, light);
    let half_way = (eye + light).normalize_or_zero();
    assert_eq!(cosines.n_dot_l, 0.8);
    assert_eq!(cosines.n_dot_v, 0.8);
    approx::assert_relative_eq!(cosines.n_dot_h, half_way.z, epsilon = 1e-6);
    approx::assert_relative_eq!(cosines.v_dot_h, eye.dot(half_way), epsilon = 1e-6);
    let opposite = Cosines::between(Vec3::Z, Vec3::Z, -Vec3::Z);
    assert_eq!(specular(opposite, 1.0, 0.5), 0.0);
    assert!(Cosines::between(Vec3::Z, Vec3::Y, -Vec3::Y).n_dot_h.is_finite());
}

#[test]
fn wrapped_diffuse_reflects_what_it_receives() {
    for wrap in [0.0f32, 0.05, 0.14, 0.28, 0.5, 0.75, 1.0] {
        // Light of radiance 1 from all sides: ∫ over the sphere of w(n·l) / π.
        let steps = 100_000;
        let cosine = |i: i32| 2.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0;
        let sum: f64 = (0..steps).map(|i| f64::from(wrapped_diffuse(cosine(i) as f32, wrap))).sum();
        let whole = sum * 2.0 / f64::from(steps) * 2.0;
        assert!((whole - 1.0).abs() < 1e-3, "{whole} at {wrap}");
    }
}

#[test]
fn scattering_reflects_what_it_receives() {
    let (width, height) = (128, 64);
    let table = scatter_table(width, height);
    for (row, values) in table.chunks(width).enumerate() {
        let whole = values.iter().sum::<f32>() * 2.0 / width as f32 * 2.0;
        assert!((whole - 1.0).abs() < 1e-3, "{whole} in row {row}");
        for pair in values.windows(2) {
            assert!(
                pair[1] >= pair[0] - 1e-6,
                "row {row} falls from {} to {} toward the light",
                pair[0],
                pair[1]
            );
        }
        assert!(values.iter().all(|value| (0.0..=1.0).contains(value)));
    }
}

#[test]
fn scattering_on_a_flat_surface_is_none() {
    // A texel near s = 0.0001.
    let (width, height) = (64, 5000);
    for (column, value) in scatter_table(width, height)[..width].iter().enumerate() {
        let n_dot_l = 2.0 * (column as f32 + 0.5) / width as f32 - 1.0;
        approx::assert_abs_diff_eq!(*value, n_dot_l.max(0.0), epsilon = 1e-3);
    }
}

#[test]
fn scattering_agrees_with_a_sum_over_the_sphere() {
    // Patches of a sphere around the lit point (the pole), weighted by the profile at their chord.
    let (width, height) = (16, 8);
    let table = scatter_table(width, height);
    for row in 0..height {
        let d = (row as f64 + 0.5) / height as f64;
        for column in 0..width {
            let cos = 2.0 * (column as f64 + 0.5) / width as f64 - 1.0;
            let sin = (1.0 - cos * cos).sqrt();
            let (mut sum, mut total) = (0.0, 0.0);
            for i in 0..1500 {
                let angle = (f64::from(i) + 0.5) / 1500.0 * std::f64::consts::PI;
                let r = 2.0 * (angle / 2.0).sin();
                let weight = ((-r / d).exp() + (-r / (3.0 * d)).exp()) / (8.0 * std::f64::consts::PI * d * r);
                for j in 0..200 {
                    let phi = (f64::from(j) + 0.5) / 200.0 * std::f64::consts::TAU;
                    let light = (cos * angle.cos() + sin * angle.sin() * phi.cos()).max(0.0);
                    sum += weight * angle.sin() * light;
                    total += weight * angle.sin();
                }
            }
            let value = f64::from(table[row * width + column]);
            assert!((value - sum / total).abs() < 1e-3, "{value} for {} at {row}, {column}", sum / total);
        }
    }
}

#[test]
fn diffusion_distances_are_in_the_range_of_the_fit() {
    approx::assert_relative_eq!(diffusion_distance(7.0, 0.33), 2.0);
    approx::assert_relative_eq!(diffusion_distance(1.0, 1.0), 1.0 / 23.651_12, max_relative = 1e-5);
    approx::assert_relative_eq!(diffusion_distance(1.0, 0.0), 1.0 / 4.685_921, max_relative = 1e-5);
}

#[test]
fn split_sum_is_the_directional_albedo_at_texel_centres() {
    let size = 8;
    let table = split_sum(size);
    assert_eq!(table.len(), size * size);
    for (i, [scale, bias]) in table.iter().enumerate() {
        let n_dot_v = ((i % size) as f32 + 0.5) / size as f32;
        let roughness = ((i / size) as f32 + 0.5) / size as f32;
        let alpha = roughness * roughness;
        let black = reflected(n_dot_v, alpha, |cosines| specular(cosines, 0.0, alpha)) as f32;
        let white = reflected(n_dot_v, alpha, |cosines| specular(cosines, 1.0, alpha)) as f32;
        approx::assert_abs_diff_eq!(*bias, black, epsilon = 0.002);
        approx::assert_abs_diff_eq!(scale + bias, white, epsilon = 0.002);
    }
}

#[test]
fn a_mirror_reflects_all_of_it() {
    let [scale, bias] = directional_albedo(0.7, 0.02);
    approx::assert_abs_diff_eq!(scale + bias, 1.0, epsilon = 1e-3);
    approx::assert_abs_diff_eq!(bias, 0.3f32.powi(5), epsilon = 1e-3);
}
