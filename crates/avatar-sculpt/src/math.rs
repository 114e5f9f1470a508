//! Scalar mathematics whose bytes are the same on every machine.
//!
//! The standard library hands `sin`, `exp` and their like to the platform, and platforms differ in the last
//! bit. Every transcendental function of this crate goes through `libm`, which is plain code; square roots
//! are exact everywhere and stay with `std`.

use glam::{DVec2, DVec3};

/// Sine of an angle in radians.
#[must_use]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Cosine of an angle in radians.
#[must_use]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Angle in radians whose sine is `x`, which is held inside −1…1.
#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x.clamp(-1.0, 1.0))
}

/// Angle in radians of the point `(x, y)`.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `e` to the power of `x`.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// `x` to the power of `y`, with negative bases taken as zero.
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    if x <= 0.0 { 0.0 } else { libm::pow(x, y) }
}

/// Linear interpolation.
#[must_use]
pub fn lerp(a: f64, b: f64, s: f64) -> f64 {
    a + (b - a) * s
}

/// Where `x` lies between `a` (0) and `b` (1), held inside that range; `a > b` is allowed.
#[must_use]
pub fn ramp(a: f64, b: f64, x: f64) -> f64 {
    ((x - a) / (b - a)).clamp(0.0, 1.0)
}

/// The cubic ease of [`ramp`].
#[must_use]
pub fn smooth(a: f64, b: f64, x: f64) -> f64 {
    let s = ramp(a, b, x);
    s * s * (3.0 - 2.0 * s)
}

/// A bell of width `sigma` around zero: 1 at the centre, 0.37 at `sigma`.
#[must_use]
pub fn bell(x: f64, sigma: f64) -> f64 {
    let s = x / sigma;
    exp(-s * s)
}

/// A bell around a point with one width per axis.
#[must_use]
pub fn bell3(p: DVec3, centre: DVec3, sigma: DVec3) -> f64 {
    let d = (p - centre) / sigma;
    exp(-d.length_squared())
}

/// A bell that ends: like `exp(−d²)` near the centre, and zero from 2.45 on, so that a shape moves a bounded
/// region.
#[must_use]
pub fn dome(d2: f64) -> f64 {
    let s = (1.0 - d2 / 6.0).max(0.0);
    let s2 = s * s;
    s2 * s2 * s2
}

/// [`dome`] around a point with one width per axis.
#[must_use]
pub fn dome3(p: DVec3, centre: DVec3, sigma: DVec3) -> f64 {
    dome(((p - centre) / sigma).length_squared())
}

/// An absolute value without the kink: mirrored forms stay smooth where they meet the midline.
#[must_use]
pub fn soft_abs(x: f64, eps: f64) -> f64 {
    (x * x + eps * eps).sqrt() - eps
}

/// A smooth curve through `(x, y)` knots with rising `x`: monotone cubic (Fritsch and Carlson), so the curve
/// never swings beyond its knots. Outside the knots it stays constant.
#[must_use]
pub fn curve(knots: &[(f64, f64)], x: f64) -> f64 {
    let (Some(first), Some(last)) = (knots.first(), knots.last()) else { return 0.0 };
    if x <= first.0 {
        return first.1;
    }
    if x >= last.0 {
        return last.1;
    }
    let i = knots.iter().take_while(|k| k.0 <= x).count() - 1;
    let slope = |j: usize| (knots[j + 1].1 - knots[j].1) / (knots[j + 1].0 - knots[j].0);
    let tangent = |j: usize| {
        if j == 0 {
            return slope(0);
        }
        if j + 1 == knots.len() {
            return slope(j - 1);
        }
        let (a, b) = (slope(j - 1), slope(j));
        // The harmonic mean keeps the piece monotone and is zero at a turning point.
        if a * b <= 0.0 { 0.0 } else { 2.0 * a * b / (a + b) }
    };
    let h = knots[i + 1].0 - knots[i].0;
    let s = (x - knots[i].0) / h;
    let (s2, s3) = (s * s, s * s * s);
    knots[i].1 * (2.0 * s3 - 3.0 * s2 + 1.0)
        + h * tangent(i) * (s3 - 2.0 * s2 + s)
        + knots[i + 1].1 * (3.0 * s2 - 2.0 * s3)
        + h * tangent(i + 1) * (s3 - s2)
}

/// A repeatable number in 0…1 for a whole number: stands in for chance.
#[must_use]
pub fn hash01(n: u64) -> f64 {
    let mut x = n.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(0xD1B5_4A32_D192_ED03);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^= x >> 31;
    (x >> 11) as f64 / (1u64 << 53) as f64
}

/// Smooth noise over space in −1…1, made of [`hash01`] at the corners of a unit lattice.
#[must_use]
pub fn noise3(p: DVec3) -> f64 {
    let base = p.floor();
    let f = p - base;
    let w = f * f * (DVec3::splat(3.0) - 2.0 * f);
    let mut sum = 0.0;
    for corner in 0..8u32 {
        let offset =
            DVec3::new(f64::from(corner & 1), f64::from((corner >> 1) & 1), f64::from((corner >> 2) & 1));
        let cell = base + offset;
        let key = ((cell.x as i64 as u64) & 0xFFFF)
            | (((cell.y as i64 as u64) & 0xFFFF) << 16)
            | (((cell.z as i64 as u64) & 0xFFFF) << 32);
        let side = |o: f64, w: f64| if o > 0.5 { w } else { 1.0 - w };
        sum += hash01(key) * side(offset.x, w.x) * side(offset.y, w.y) * side(offset.z, w.z);
    }
    2.0 * sum - 1.0
}

/// Several octaves of [`noise3`], each half as strong and twice as fine.
#[must_use]
pub fn fbm(p: DVec3, octaves: u32) -> f64 {
    let (mut sum, mut gain, mut at) = (0.0, 0.5, p);
    for _ in 0..octaves {
        sum += gain * noise3(at);
        gain *= 0.5;
        at = at * 2.03 + DVec3::new(17.1, 5.3, 9.7);
    }
    sum
}

/// Distance from a point to a line segment in the plane, and the place along it (0…1).
#[must_use]
pub fn to_segment(p: DVec2, a: DVec2, b: DVec2) -> (f64, f64) {
    let ab = b - a;
    let s = ((p - a).dot(ab) / ab.length_squared().max(1e-12)).clamp(0.0, 1.0);
    ((p - a - ab * s).length(), s)
}
