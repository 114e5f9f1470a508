//! The views of lamps, for shadow maps.

use crate::view::lamps::{SHADOW_COUNT, direction};
use crate::view::shading::Shadows;
use avatar_look::Light;
use avatar_mesh::Bounds;
use glam::{Mat4, Quat, Vec3};

/// One lamp's view: an orthographic projection that is fitted around the avatars that the camera sees, and
/// deep enough for everything between them and the lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShadowView {
    /// Maps the world to −1…1 across and up, and to a depth of 0…1 away from the lamp.
    pub(crate) shadow_from_world: Mat4,
    /// Length in the world of depth 0…1.
    pub(crate) depth: f32,
    /// Length in the world of a texel.
    pub(crate) texel: f32,
}

/// WGSL `ShadowView`: what the shadow pass of one lamp needs.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuShadowView {
    pub(crate) shadow_from_world: [[f32; 4]; 4],
}

/// The views of the key and rim lamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShadowViews(pub(crate) [ShadowView; SHADOW_COUNT]);

impl ShadowView {
    /// Whether a box reaches into what the lamp sees.
    pub(crate) fn meets(&self, bounds: Bounds) -> bool {
        let center = self.shadow_from_world.transform_point3(bounds.center());
        let axes =
            [self.shadow_from_world.x_axis, self.shadow_from_world.y_axis, self.shadow_from_world.z_axis];
        let size = bounds.size() * 0.5;
        let half: Vec3 =
            (axes.iter().zip(size.to_array())).map(|(axis, half)| axis.truncate().abs() * half).sum();
        let nearest = center.abs() - half;
        nearest.x <= 1.0 && nearest.y <= 1.0 && center.z + half.z >= 0.0 && center.z - half.z <= 1.0
    }
}

/// Room around the avatars, as a share of their size: samples of soft edges stay inside the map.
const MARGIN: f32 = 1.06;
/// Avatars that are farther toward the lamp than this many half widths of the map cast no shadows: depths
/// would lose their precision.
const CASTER_REACH: f32 = 64.0;

impl ShadowViews {
    /// `bounds` is a box around what is shaded; `casters` are boxes around everything that may cast shadows
    /// on it.
    pub(crate) fn new(
        light: &Light,
        bounds: Option<Bounds>,
        casters: impl Iterator<Item = Bounds> + Clone,
        shadows: Shadows,
    ) -> Self {
        let bounds = bounds.unwrap_or(Bounds { min: Vec3::ZERO, max: Vec3::ZERO });
        Self(
            [&light.key, &light.rim]
                .map(|lamp| view(direction(lamp), bounds, casters.clone(), shadows.map_size())),
        )
    }
}

fn view(
    toward_lamp: Vec3,
    bounds: Bounds,
    casters: impl Iterator<Item = Bounds>,
    map_size: u32,
) -> ShadowView {
    // "Up" of the map stays in the plane of the lamp and the vertical: a mirrored lamp has the mirrored map.
    let rotation = if toward_lamp.x.hypot(toward_lamp.z) > 1e-4 {
        let yaw = toward_lamp.x.atan2(toward_lamp.z);
        Quat::from_rotation_y(yaw) * Quat::from_rotation_x(-toward_lamp.y.clamp(-1.0, 1.0).asin())
    } else {
        Quat::from_rotation_x(-toward_lamp.y.signum() * std::f32::consts::FRAC_PI_2)
    };
    let to_lamp_space = rotation.inverse();
    // A box's extent along the axes of the lamp.
    let extents = |bounds: Bounds| {
        let half = bounds.size() * 0.5;
        [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (rotation * axis).abs().dot(half).max(1e-3) * MARGIN)
    };
    let [half_x, half_y, half_z] = extents(bounds);
    // Square texels: softness is the same across and up.
    let side = half_x.max(half_y);
    let mut toward = half_z;
    for caster in casters {
        let at = to_lamp_space * (caster.center() - bounds.center());
        let [x, y, z] = extents(caster);
        let is_in_the_way = at.x.abs() <= side + x && at.y.abs() <= side + y;
        if is_in_the_way && at.z + z <= CASTER_REACH * side {
            toward = toward.max(at.z + z);
        }
    }
    let depth = toward + half_z;
    let scale = Mat4::from_scale(Vec3::new(1.0 / side, 1.0 / side, -1.0 / depth));
    let toward_center = Mat4::from_translation(-bounds.center());
    let shadow_from_world = Mat4::from_translation(Vec3::Z * (toward / depth))
        * scale
        * Mat4::from_quat(to_lamp_space)
        * toward_center;
    ShadowView { shadow_from_world, depth, texel: 2.0 * side / map_size as f32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_point_of_the_box_is_in_the_view_and_nearer_ones_have_less_depth(
            x in -1.0f32..1.0, y in -1.0f32..1.0, z in -1.0f32..1.0,
            corner in 0u8..8, size in 0.1f32..50.0,
        ) {
            let toward_lamp = Vec3::new(x, y, z).normalize_or(Vec3::Y);
            let min = Vec3::new(-size, -2.0 * size, -0.5 * size) + Vec3::splat(3.0);
            let bounds = Bounds { min, max: Vec3::new(size, size, size) + Vec3::splat(3.0) };
            let view = view(toward_lamp, bounds, [bounds].into_iter(), 1024);
            let sign = |bit: u8| f32::from(corner >> bit & 1);
            let p = bounds.min + bounds.size() * Vec3::new(sign(0), sign(1), sign(2));
            let seen = view.shadow_from_world.project_point3(p);
            prop_assert!(seen.x.abs() <= 1.0 && seen.y.abs() <= 1.0 && (0.0..=1.0).contains(&seen.z), "{seen}");
            let nearer = view.shadow_from_world.project_point3(p + toward_lamp);
            prop_assert!(((seen.z - nearer.z) * view.depth - 1.0).abs() < 1e-2, "{} {}", seen.z, nearer.z);
            prop_assert!((seen.truncate() - nearer.truncate()).length() < 1e-3);
        }

        /// A box of which a point is in the view meets it; one aside, behind or beyond it does not.
        #[test]
        fn boxes_with_a_point_in_the_view_meet_it(
            at in prop::array::uniform3(-0.99f32..0.99), size in 0.01f32..40.0, corner in 0u8..8,
        ) {
            let bounds = Bounds { min: Vec3::splat(-3.0), max: Vec3::splat(3.0) };
            let toward = Vec3::new(0.3, 0.5, 0.8).normalize_or_zero();
            let view = view(toward, bounds, [bounds].into_iter(), 1024);
            let [x, y, z] = at;
            let p = view.shadow_from_world.inverse().project_point3(Vec3::new(x, y, (z + 1.0) / 2.0));
            let sign = |bit: u8| f32::from(corner >> bit & 1);
            let min = p - size * Vec3::new(sign(0), sign(1), sign(2));
            let around = Bounds { min, max: min + size };
            prop_assert!(view.meets(around));
            let aside = toward.cross(Vec3::Y).normalize_or_zero() * (100.0 + 2.0 * size);
            for off in [aside, -aside, toward * (100.0 + 2.0 * size), toward * -(100.0 + 2.0 * size)] {
                let away = Bounds { min: min + off, max: min + off + size };
                prop_assert!(!view.meets(away), "{}", off);
            }
        }

        #[test]
        fn a_mirrored_lamp_has_the_mirrored_view(x in 0.05f32..1.0, y in -1.0f32..1.0, z in -1.0f32..1.0) {
            let bounds = Bounds { min: Vec3::new(-2.0, -3.0, -1.0), max: Vec3::new(2.0, 1.0, 4.0) };
            let mirror = Vec3::new(-1.0, 1.0, 1.0);
            let toward = Vec3::new(x, y, z).normalize_or(Vec3::Y);
            let caster = Bounds { min: bounds.min + toward * 9.0, max: bounds.max + toward * 9.0 };
            let mirrored = Bounds { min: caster.max * mirror, max: caster.min * mirror };
            let mirrored = Bounds { min: mirrored.min.min(mirrored.max), max: mirrored.min.max(mirrored.max) };
            let one = view(toward, bounds, [caster].into_iter(), 64);
            let other = view(toward * mirror, bounds, [mirrored].into_iter(), 64);
            let p = Vec3::new(0.7, -1.2, 2.0);
            let (a, b) = (
                one.shadow_from_world.project_point3(p),
                other.shadow_from_world.project_point3(p * mirror),
            );
            prop_assert!((a * mirror - b).length() < 1e-5, "{a} {b}");
        }
    }
    #[test]
    fn what_stands_between_the_lamp_and_the_view_is_in_the_map_and_makes_it_no_coarser() {
        let bounds = Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE };
        let toward_lamp = Vec3::new(0.6, 0.0, 0.8);
        let alone = view(toward_lamp, bounds, [bounds].into_iter(), 64);
        let with = |by: Vec3| {
            let caster = Bounds { min: bounds.min + by, max: bounds.max + by };
            view(toward_lamp, bounds, [bounds, caster].into_iter(), 64)
        };
        let between = with(toward_lamp * 20.0);
        assert_eq!(between.texel, alone.texel);
        let seen = between.shadow_from_world.project_point3(toward_lamp * 21.0);
        assert!((0.0..=1.0).contains(&seen.z), "{seen}");
        // Beside the light's way, behind what is lit, and so far away that depths would be coarse.
        for by in [Vec3::Y * 20.0, toward_lamp * -20.0, toward_lamp * 1e6] {
            assert_eq!(with(by), alone, "{by}");
        }
    }
}
