use crate::Environment;
use crate::environment::Prepared;
use crate::split_sum::radical_inverse;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

/// Faces of a cube map: +X, −X, +Y, −Y, +Z, −Z.
pub const CUBE_FACES: u32 = 6;

/// The direction, a unit vector, that texel (`column`, `row`) of a cube map shows, rows from the top.
///
/// The order and the axes of WebGPU, Vulkan and Direct3D, so that a sampler finds under a direction in the
/// world what was computed for it; with `s` to the right and `t` down, both −1 to 1 over the face:
///
/// ```text
///  +X  ( 1, −t, −s)    +Y  (s,  1,  t)    +Z  ( s, −t,  1)
///  −X  (−1, −t,  s)    −Y  (s, −1, −t)    −Z  (−s, −t, −1)
/// ```
///
/// Faces beyond the sixth count as −Z.
pub fn cube_direction(face: u32, size: u32, column: u32, row: u32) -> Vec3 {
    let at = |i: u32| (2.0 * i as f32 + 1.0) / size as f32 - 1.0;
    let (s, t) = (at(column), at(row));
    let direction = match face {
        0 => Vec3::new(1.0, -t, -s),
        1 => Vec3::new(-1.0, -t, s),
        2 => Vec3::new(s, 1.0, t),
        3 => Vec3::new(s, -1.0, -t),
        4 => Vec3::new(s, -t, 1.0),
        _ => Vec3::new(-s, -t, -1.0),
    };
    direction.normalize_or(Vec3::Y)
}

impl Environment {
    /// What smooth and rough things reflect of it: the levels of a cube map, RGBA with A = 1.
    ///
    /// Level `i` is blurred as GGX of the perceptual roughness `i / (levels − 1)` reflects; level 0 is a
    /// mirror. Each holds the [`CUBE_FACES`] one after the other, row by row ([`cube_direction`]), of
    /// `max(face_size >> i, 1)` texels a side.
    ///
    /// The eye is taken to look along the normal (B. Karis, "Real Shading in Unreal Engine 4", 2013). The
    /// same directions are looked up around every texel, each with its mirror images: a mirrored environment
    /// gives the mirrored map.
    ///
    /// `face_size` counts as 1 to 4096, `levels` as at most 13.
    pub fn reflections(&self, face_size: u32, levels: u32) -> Vec<Vec<[f32; 4]>> {
        let (face_size, levels) = (face_size.clamp(1, 4096), levels.min(13));
        let prepared = self.prepared();
        let level = |level: u32| {
            let size = (face_size >> level).max(1);
            let roughness = if levels > 1 { level as f32 / (levels - 1) as f32 } else { 0.0 };
            // Small levels have few texels and wide lobes: they can afford, and need, more directions.
            let lobe = Lobe::new(roughness, 32 << (2 * level.saturating_sub(1)).min(3));
            let texels = (0..CUBE_FACES * size * size).map(|i| {
                let direction = cube_direction(i / (size * size), size, i % size, i / size % size);
                lobe.reflected(&prepared, direction).extend(1.0).to_array()
            });
            texels.collect()
        };
        (0..levels).map(level).collect()
    }
}

/// Directions around +Z from which light is gathered, with weights that add up to 1; each stands for its four
/// images in the planes x = 0 and y = 0. None for a mirror.
struct Lobe {
    directions: Vec<(Vec3, f32)>,
}

impl Lobe {
    fn new(roughness: f32, count: u32) -> Self {
        if roughness <= 0.0 {
            return Self { directions: Vec::new() };
        }
        let alpha2 = roughness.powi(4);
        let direction = |i: u32| {
            // Normals of microfacets as GGX has them: Walter et al. 2007, eq. 35 and 36, over a quarter of a
            // turn.
            let u = (i as f32 + 0.5) / count as f32;
            let cos2 = (1.0 - u) / (1.0 + (alpha2 - 1.0) * u);
            let (sin_turn, cos_turn) = (FRAC_PI_2 * radical_inverse(i)).sin_cos();
            // Twice the angle of the normal: a mirror image of the eye.
            let (cos, sin) = (2.0 * cos2 - 1.0, 2.0 * (cos2 * (1.0 - cos2)).max(0.0).sqrt());
            (Vec3::new(sin * cos_turn, sin * sin_turn, cos), cos)
        };
        let mut directions: Vec<_> = (0..count).map(direction).filter(|(_, cos)| *cos > 0.0).collect();
        let total: f32 = directions.iter().map(|(_, weight)| weight).sum();
        directions.iter_mut().for_each(|(_, weight)| *weight /= total);
        Self { directions }
    }

    fn reflected(&self, environment: &Prepared, normal: Vec3) -> Vec3 {
        if self.directions.is_empty() {
            return environment.radiance(normal);
        }
        // Mirrored with the normal but for its signs, which the four images make up for.
        let pole = if normal.x == 0.0 && normal.z == 0.0 { Vec3::Z } else { Vec3::Y };
        let right = pole.cross(normal).normalize_or(Vec3::X);
        let up = normal.cross(right);
        let mut sum = Vec3::ZERO;
        for &(Vec3 { x, y, z }, weight) in &self.directions {
            let [across, along, ahead] = [right * x, up * y, normal * z];
            let at = |direction: Vec3| environment.radiance(direction + ahead);
            sum +=
                (at(across + along) + at(across - along) + at(along - across) + at(-across - along)) * weight;
        }
        0.25 * sum
    }
}
