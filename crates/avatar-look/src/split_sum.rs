use crate::optics::{schlick_fresnel, smith_visibility};
use glam::Vec3;
use std::f32::consts::TAU;

/// Directions per entry: errors stay below 0.001.
const SAMPLES: u32 = 1024;

/// What a surface reflects of even light from all sides, without lamps: `[scale, bias]` with
/// `directional albedo = reflectance · scale + bias`.
///
/// The split sum of B. Karis, "Real Shading in Unreal Engine 4", 2013, over the terms of [`crate::optics`].
/// Rows are perceptual roughnesses, columns `n_dot_v`, both at the middle of their texel, `(i + 0.5) / size`;
/// row by row, `size · size` entries.
pub fn split_sum(size: usize) -> Vec<[f32; 2]> {
    let at = |i: usize| (i as f32 + 0.5) / size as f32;
    let points = hammersley();
    let mut table = Vec::with_capacity(size * size);
    for row in 0..size {
        table.extend((0..size).map(|column| integrate(at(column), at(row), &points)));
    }
    table
}

/// One entry of [`split_sum`], for any `n_dot_v` above 0 and up to 1 and any perceptual roughness from 0 to
/// 1.
pub fn directional_albedo(n_dot_v: f32, roughness: f32) -> [f32; 2] {
    integrate(n_dot_v, roughness, &hammersley())
}

/// Points `(height, cosine, sine)` of a cylinder, evenly spread.
fn hammersley() -> Vec<(f32, f32, f32)> {
    let point = |i| {
        let (sin, cos) = (TAU * radical_inverse(i)).sin_cos();
        ((i as f32 + 0.5) / SAMPLES as f32, cos, sin)
    };
    (0..SAMPLES).map(point).collect()
}

fn integrate(n_dot_v: f32, roughness: f32, points: &[(f32, f32, f32)]) -> [f32; 2] {
    let alpha = roughness * roughness;
    let to_eye = Vec3::new((1.0 - n_dot_v * n_dot_v).max(0.0).sqrt(), 0.0, n_dot_v);
    let masking = smith_masking(n_dot_v, alpha);
    let mut sum = [0.0f32; 2];
    for point in points {
        let half_way = visible_normal(to_eye, alpha, point);
        let v_dot_h = to_eye.dot(half_way).clamp(0.0, 1.0);
        let n_dot_l = 2.0 * v_dot_h * half_way.z - n_dot_v;
        if n_dot_l > 0.0 {
            // G₂ over G₁: what is left of the integrand where normals are drawn by their visibility (Heitz
            // 2018, eq. 19).
            let weight = 4.0 * n_dot_l * n_dot_v * smith_visibility(n_dot_v, n_dot_l, alpha) / masking;
            // Fresnel with reflectance 0 is what does not depend on the reflectance.
            let grazing = schlick_fresnel(0.0, v_dot_h);
            sum[0] += weight * (1.0 - grazing);
            sum[1] += weight * grazing;
        }
    }
    sum.map(|sum| sum / points.len() as f32)
}

/// Smith's masking G₁ of GGX: Walter et al. 2007, eq. 34.
fn smith_masking(n_dot_v: f32, alpha: f32) -> f32 {
    let alpha2 = alpha * alpha;
    2.0 * n_dot_v / (n_dot_v + (alpha2 + (1.0 - alpha2) * n_dot_v * n_dot_v).sqrt())
}

/// A normal of a microfacet, drawn among those that the eye sees: E. Heitz, "Sampling the GGX Distribution of
/// Visible Normals", 2018, by way of the cap of a sphere: J. Dupuy and A. Benyoub, "Sampling Visible GGX
/// Normals with Spherical Caps", 2023.
fn visible_normal(to_eye: Vec3, alpha: f32, &(u, cos, sin): &(f32, f32, f32)) -> Vec3 {
    let stretched = Vec3::new(alpha * to_eye.x, alpha * to_eye.y, to_eye.z).normalize_or(Vec3::Z);
    let z = (1.0 - u) * (1.0 + stretched.z) - stretched.z;
    let width = (1.0 - z * z).max(0.0).sqrt();
    let on_sphere = Vec3::new(width * cos, width * sin, z) + stretched;
    Vec3::new(alpha * on_sphere.x, alpha * on_sphere.y, on_sphere.z.max(0.0)).normalize_or(Vec3::Z)
}

/// The second coordinate of Hammersley's points, 0 to 1 (J. van der Corput, 1935): the bits of `i` mirrored
/// at the point.
pub(crate) fn radical_inverse(i: u32) -> f32 {
    // The upper 24 bits are all that single precision holds.
    (i.reverse_bits() >> 8) as f32 / (1u32 << 24) as f32
}
