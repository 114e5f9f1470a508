use crate::Environment;
use crate::environment::Spot;
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// Rings per panel: its edge is smooth, so that these suffice for five digits.
const RINGS: u32 = 256;

/// Directions in which no light may become negative.
const PROBES: u32 = 1024;

/// What is left of the mean light in the darkest direction, at least; covers what lies between the probes.
const DARKEST: f32 = 0.01;

/// The clamped cosine over π in bands 0 to 2: R. Ramamoorthi and P. Hanrahan, "An Efficient Representation
/// for Irradiance Environment Maps", 2001, eq. 8.
const COSINE_BANDS: [f32; 3] = [1.0, 2.0 / 3.0, 0.25];

impl Environment {
    /// What it makes of white matte surfaces, as spherical harmonics `c` up to the second band, with the
    /// constants of the basis, the clamped cosine and 1/π in them (Ramamoorthi and Hanrahan 2001). For a unit
    /// normal:
    ///
    /// ```text
    ///  c0 + c1·y + c2·z + c3·x + c4·x·y + c5·y·z + c6·(3z² − 1) + c7·x·z + c8·(x² − y²)
    /// ```
    ///
    /// An environment that is 1 everywhere gives 1. Nine terms overshoot opposite to a small bright panel;
    /// where light would become negative there, the bands are damped as far as necessary (P.-P. Sloan,
    /// "Stupid Spherical Harmonics Tricks", 2008, windowing by the squared Laplacian). [`irradiance_at`]
    /// evaluates it.
    pub fn irradiance(&self) -> [Vec3; 9] {
        let prepared = self.prepared();
        let mut sum = [Vec3::ZERO; 9];
        sum[0] = prepared.mean;
        sum[1] = prepared.slope * COSINE_BANDS[1];
        for spot in &prepared.spots {
            for (sum, share) in sum.iter_mut().zip(spot_bands(spot)) {
                *sum += spot.radiance * share;
            }
        }
        without_ringing(&sum)
    }
}

/// Evaluates [`Environment::irradiance`] for a unit normal, as the shader does.
pub fn irradiance_at(coefficients: &[Vec3; 9], normal: Vec3) -> Vec3 {
    let basis = basis(normal);
    coefficients.iter().zip(basis).fold(Vec3::ZERO, |sum, (c, basis)| sum + *c * basis)
}

fn basis(n: Vec3) -> [f32; 9] {
    let Vec3 { x, y, z } = n;
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y]
}

/// The coefficients of a panel of radiance 1. It is round: what it gives a normal depends on one angle only,
/// as the sum of `band · (2l + 1)/4π · z_l · P_l(cos)` with Legendre's polynomials P_l and `z_l = ∫ share ·
/// P_l dω`.
fn spot_bands(spot: &Spot) -> [f32; 9] {
    let mut zonal = [0.0f32; 3];
    let step = spot.radius_rad / RINGS as f32;
    for i in 0..RINGS {
        let angle_rad = (i as f32 + 0.5) * step;
        let (sin, cos) = angle_rad.sin_cos();
        let weight = spot.share_at(angle_rad) * TAU * sin * step;
        zonal[0] += weight;
        zonal[1] += weight * cos;
        zonal[2] += weight * (1.5 * cos * cos - 0.5);
    }
    let band = |l: usize| COSINE_BANDS[l] * (2 * l + 1) as f32 / (4.0 * PI) * zonal[l];
    let (first, second) = (band(1), band(2));
    // P_2 of the cosine between the normal and the axis a, sorted by the polynomials of the basis.
    let a = spot.direction;
    [
        band(0),
        first * a.y,
        first * a.z,
        first * a.x,
        second * 3.0 * a.x * a.y,
        second * 3.0 * a.y * a.z,
        second * 0.25 * (3.0 * a.z * a.z - 1.0),
        second * 3.0 * a.x * a.z,
        second * 0.75 * (a.x * a.x - a.y * a.y),
    ]
}

/// One window for all channels, or dark sides would be tinted.
fn without_ringing(coefficients: &[Vec3; 9]) -> [Vec3; 9] {
    let probes: Vec<[f32; 9]> = (0..PROBES).map(|i| basis(spiral(i, PROBES))).collect();
    let floor = coefficients[0] * DARKEST;
    let is_sound = |c: &[Vec3; 9]| {
        let light = |basis: &[f32; 9]| c.iter().zip(basis).fold(Vec3::ZERO, |sum, (c, b)| sum + *c * *b);
        probes.iter().all(|basis| light(basis).cmpge(floor).all())
    };
    if is_sound(coefficients) {
        return *coefficients;
    }
    // At 1 even a panel of no size leaves light everywhere: 1 + (2 cos)/5 + (5/4 P_2)/37 is positive.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if is_sound(&windowed(coefficients, middle)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    windowed(coefficients, high)
}

fn windowed(coefficients: &[Vec3; 9], strength: f32) -> [Vec3; 9] {
    let factor = |laplacian: f32| 1.0 / (1.0 + strength * laplacian * laplacian);
    let mut out = *coefficients;
    out[1..4].iter_mut().for_each(|c| *c *= factor(2.0));
    out[4..].iter_mut().for_each(|c| *c *= factor(6.0));
    out
}

/// Point `i` of `count` evenly spread over the sphere: R. Swinbank and R. Purser, "Fibonacci grids", 2006.
fn spiral(i: u32, count: u32) -> Vec3 {
    let y = 1.0 - 2.0 * (i as f32 + 0.5) / count as f32;
    let golden_angle = PI * (3.0 - 5.0f32.sqrt());
    let (sin, cos) = (golden_angle * i as f32).sin_cos();
    let width = (1.0 - y * y).max(0.0).sqrt();
    Vec3::new(width * cos, y, width * sin)
}
