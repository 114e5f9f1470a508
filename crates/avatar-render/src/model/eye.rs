//! The shape of cornea and iris, found from the meshes of an eye.

use avatar_mesh::Mesh;
use glam::{Vec2, Vec3};

/// Samples of the profile: distance in the texture over distance from the axis.
pub(crate) const PROFILE_LEN: usize = 16;

/// The shape of a cornea and of the iris behind it, at bind pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EyeShape {
    /// Center and radius of the sphere of which the cornea is a cap.
    pub(crate) center: Vec3,
    pub(crate) radius: f32,
    /// Radius of the edge of the cornea; that of a human cornea if the mesh covers the whole ball.
    pub(crate) edge_radius: f32,
    /// Depth (z) of the iris in the mesh.
    pub(crate) surface_z: f32,
    /// How the ball is painted around its axis: `uv = uv_center + (uv_from_x · x + uv_from_y · y) / r ·
    /// profile(r)`.
    pub(crate) uv_center: Vec2,
    pub(crate) uv_from_x: Vec2,
    pub(crate) uv_from_y: Vec2,
    /// Samples at equal steps of the square root of `r / profile_reach`, from 0 to 1.
    pub(crate) profile: [f32; PROFILE_LEN],
    pub(crate) profile_reach: f32,
}

/// A ball counts as painted around its axis if the root mean square error of its texture coordinates is at
/// most this share of their spread.
const LARGEST_UV_ERROR: f32 = 0.06;
/// Radius of a human cornea divided by that of the eyeball, with a little room: 5.9 mm of 12 mm.
const CORNEA_PER_BALL: f32 = 0.52;
/// Texture coordinates are examined up to this many radii of the cornea from the axis.
const PROFILE_REACH: f32 = 1.3;

/// Fits a sphere to the cornea and finds how the eyeball is painted around its axis. Returns `None` if the
/// cornea is not a cap that bulges forward, or if the eyeball is not painted around the axis: such eyes are
/// drawn without refraction.
pub(crate) fn eye_shape(cornea: &Mesh, ball: &Mesh) -> Option<EyeShape> {
    let (cap, whole) = (cornea.bounds()?, ball.bounds()?);
    let (half_width, bulge) = ((cap.size().x + cap.size().y) * 0.25, cap.size().z);
    if !(half_width > 0.0 && bulge > 0.02 * half_width && bulge < 3.0 * half_width) {
        return None;
    }
    // The sphere through the rim and the top of a cap.
    let radius = (half_width * half_width + bulge * bulge) / (2.0 * bulge);
    let center = Vec3::new(cap.center().x, cap.center().y, cap.max.z - radius);
    let edge_radius = half_width.min(CORNEA_PER_BALL * (whole.size().x + whole.size().y) * 0.25);
    let reach = PROFILE_REACH * edge_radius;
    let points: Vec<(Vec2, f32, Vec2)> = (ball.positions.iter().zip(&ball.uvs))
        .map(|(p, uv)| (p.truncate() - center.truncate(), p.z, *uv))
        .filter(|(d, z, _)| *z > center.z && d.length() < reach)
        .collect();
    let axis = points.iter().min_by(|(a, ..), (b, ..)| a.length().total_cmp(&b.length()))?;
    if axis.0.length() > 0.1 * edge_radius {
        return None;
    }
    let uv_center = axis.2;
    let turn = axes(points.iter().map(|(d, _, uv)| (*d, *uv - uv_center)))?;
    let profile = profile(points.iter().map(|(d, _, uv)| (d.length() / reach, (*uv - uv_center).length())))?;
    let shape = EyeShape {
        center,
        radius,
        edge_radius,
        surface_z: points.iter().map(|(_, z, _)| z).sum::<f32>() / points.len() as f32,
        uv_center,
        uv_from_x: turn[0],
        uv_from_y: turn[1],
        profile,
        profile_reach: reach,
    };
    let error: f32 = points.iter().map(|(d, _, uv)| (shape.uv(*d) - *uv).length_squared()).sum();
    let spread = profile[PROFILE_LEN - 1];
    let fits = (error / points.len() as f32).sqrt() <= LARGEST_UV_ERROR * spread && spread > 0.0;
    fits.then_some(shape)
}

impl EyeShape {
    /// Texture coordinates at this distance from the axis; the twin of `iris_uv` in WGSL.
    fn uv(&self, from_axis: Vec2) -> Vec2 {
        let r = from_axis.length();
        if r <= 0.0 {
            return self.uv_center;
        }
        let direction = (self.uv_from_x * from_axis.x + self.uv_from_y * from_axis.y) / r;
        self.uv_center + direction * self.painted(r)
    }

    /// Distance in the texture from its middle, at this distance from the axis.
    pub(crate) fn painted(&self, r: f32) -> f32 {
        let at = (r / self.profile_reach).sqrt().min(1.0) * (PROFILE_LEN - 1) as f32;
        let below = (at as usize).min(PROFILE_LEN - 2);
        self.profile[below] + (self.profile[below + 1] - self.profile[below]) * (at - below as f32)
    }
}

/// The rotation, with or without a mirror, that takes directions around the axis to directions in the
/// texture: the orthogonal matrix nearest to the mean of their products.
fn axes(pairs: impl Iterator<Item = (Vec2, Vec2)>) -> Option<[Vec2; 2]> {
    let (mut from_x, mut from_y) = (Vec2::ZERO, Vec2::ZERO);
    for (d, uv) in pairs {
        let (d, uv) = (d.normalize_or_zero(), uv.normalize_or_zero());
        from_x += uv * d.x;
        from_y += uv * d.y;
    }
    // Mirrored textures have the other handedness; in the plane the nearest rotation is a sum of two vectors.
    let mirror = if from_x.perp_dot(from_y) < 0.0 { -1.0 } else { 1.0 };
    let x = (from_x + mirror * Vec2::new(from_y.y, -from_y.x)).try_normalize()?;
    Some([x, mirror * x.perp()])
}

/// The profile, from pairs of distance from the axis and distance in the texture.
fn profile(points: impl Iterator<Item = (f32, f32)>) -> Option<[f32; PROFILE_LEN]> {
    let mut sums = [(0.0f32, 0.0f32); PROFILE_LEN];
    // The axis itself.
    sums[0] = (0.0, 1.0);
    for (r, painted) in points {
        let at = r.sqrt() * (PROFILE_LEN - 1) as f32;
        let nearest = (at.round() as usize).min(PROFILE_LEN - 1);
        let weight = (1.0 - (at - nearest as f32).abs()).max(0.0).powi(4);
        if nearest > 0 {
            // As the radius between samples grows in proportion, to first order.
            let scaled = painted * (nearest as f32 / at.max(1e-3)).powi(2).clamp(0.5, 2.0).sqrt();
            sums[nearest] = (sums[nearest].0 + weight * scaled, sums[nearest].1 + weight);
        }
    }
    let known: Vec<(usize, f32)> =
        sums.iter().enumerate().filter(|(_, s)| s.1 > 0.0).map(|(i, s)| (i, s.0 / s.1)).collect();
    let (last, end) = *known.last()?;
    if known.len() < 4 || last + 2 < PROFILE_LEN {
        return None;
    }
    Some(std::array::from_fn(|i| {
        let above = known.iter().find(|(k, _)| *k >= i).copied().unwrap_or((last, end));
        let below = known.iter().rev().find(|(k, _)| *k <= i).copied().unwrap_or(above);
        let span = (above.0 - below.0).max(1) as f32;
        below.1 + (above.1 - below.1) * (i.saturating_sub(below.0)) as f32 / span
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use avatar_mesh::Mesh;

    /// A ball of rings around +Z, painted by `painted(r)` and turned by `turn`, and a cap in front of it.
    fn eye(painted: impl Fn(f32) -> f32, turn: [Vec2; 2]) -> (Mesh, Mesh) {
        let cap = |center: Vec3, radius: f32, widest: f32| {
            let mut mesh = Mesh::default();
            for ring in 0..40 {
                for step in 0..24 {
                    let (r, angle) = (widest * ring as f32 / 39.0, step as f32 * 0.2618);
                    let (x, y) = (r * angle.cos(), r * angle.sin());
                    let z = (radius * radius - r * r).max(0.0).sqrt();
                    mesh.positions.push(center + Vec3::new(x, y, z));
                    let direction = Vec2::new(x, y).normalize_or_zero();
                    let uv = turn[0] * direction.x + turn[1] * direction.y;
                    mesh.uvs.push(Vec2::new(0.3, 0.6) + uv * painted(r));
                }
            }
            mesh
        };
        let at = Vec3::new(3.0, 0.5, 1.0);
        (cap(at + Vec3::Z * 0.3, 1.6, 0.9), cap(at, 1.8, 1.79))
    }

    #[test]
    fn the_painting_around_the_axis_is_found() {
        let mirrored = [Vec2::X, -Vec2::Y];
        let turned = [Vec2::new(0.6, 0.8), Vec2::new(-0.8, 0.6)];
        let laws: [fn(f32) -> f32; 3] = [|r| 0.3 * r, |r| 0.16 * r.sqrt(), |r| 0.2 * r + 0.03 * r * r];
        for (law, turn) in laws.into_iter().flat_map(|law| [(law, mirrored), (law, turned)]) {
            let (cornea, ball) = eye(law, turn);
            let shape = eye_shape(&cornea, &ball).expect("an eye");
            for from_axis in [Vec2::new(0.2, 0.1), Vec2::new(-0.4, 0.3), Vec2::new(0.1, -0.8)] {
                let direction = from_axis.normalize_or_zero();
                let expected = Vec2::new(0.3, 0.6)
                    + (turn[0] * direction.x + turn[1] * direction.y) * law(from_axis.length());
                let error = (shape.uv(from_axis) - expected).length();
                assert!(error < 0.02 * law(1.0), "{error} at {from_axis}");
            }
            assert!((shape.radius - 1.6).abs() < 0.01, "{}", shape.radius);
            assert!((shape.center - Vec3::new(3.0, 0.5, 1.3)).length() < 0.02, "{}", shape.center);
        }
    }

    #[test]
    fn eyes_that_are_painted_otherwise_are_left_alone() {
        let (cornea, mut ball) = eye(|r| 0.3 * r, [Vec2::X, Vec2::Y]);
        for (uv, p) in ball.uvs.iter_mut().zip(&ball.positions) {
            *uv = Vec2::new((p.y * 9.0).sin(), (p.x * 7.0).cos());
        }
        assert_eq!(eye_shape(&cornea, &ball), None);
        let flat = Mesh { positions: cornea.positions.iter().map(|p| p.with_z(1.0)).collect(), ..cornea };
        assert_eq!(eye_shape(&flat, &ball), None);
        assert_eq!(eye_shape(&Mesh::default(), &ball), None);
    }
}
