//! Uniforms that all avatars of a frame share.

use crate::view::camera::Camera;
use crate::view::environment::REFLECTION_LEVELS;
use crate::view::lamps::{GpuLamp, LAMP_COUNT, SHADOW_COUNT};
use crate::view::scene::Scene;
use crate::view::shadows::ShadowViews;
use avatar_look::ToneMap;
use avatar_mesh::Bounds;
use glam::Vec3;

/// [`ToneMap::Neutral`] in WGSL.
pub(crate) const TONE_NEUTRAL: u32 = 1;
/// [`ToneMap::AgX`] in WGSL.
pub(crate) const TONE_AGX: u32 = 2;

/// The reach of ambient occlusion, as a fraction of the height of the skin: from lids to eyes, from lips to
/// teeth.
const OCCLUSION_RADIUS: f32 = 0.05;
/// How far the edges of shadows are softened, as a fraction of the height of the skin.
const SHADOW_SOFTNESS: f32 = 0.007;

/// WGSL `Frame`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuFrame {
    pub(crate) clip_from_world: [[f32; 4]; 4],
    pub(crate) world_from_clip: [[f32; 4]; 4],
    pub(crate) eye_world: [f32; 3],
    pub(crate) exposure: f32,
    pub(crate) lamps: [GpuLamp; LAMP_COUNT],
    pub(crate) sky: [f32; 3],
    pub(crate) tone_map: u32,
    pub(crate) ground: [f32; 3],
    pub(crate) near: f32,
    pub(crate) irradiance: [[f32; 4]; 9],
    pub(crate) shadow_from_world: [[[f32; 4]; 4]; SHADOW_COUNT],
    pub(crate) shadow_depth: [f32; SHADOW_COUNT],
    pub(crate) shadow_texel: [f32; SHADOW_COUNT],
    pub(crate) pixels: [f32; 2],
    pub(crate) pixels_per_unit: f32,
    pub(crate) occlusion_radius: f32,
    pub(crate) shadow_softness: f32,
    pub(crate) reflection_levels: f32,
    pub(crate) hair_shadow: f32,
    pub(crate) hair_far: f32,
    pub(crate) hair_per_depth: f32,
    pub(crate) pre_exposure: f32,
    pub(crate) pad: [f32; 2],
}

/// The largest power of two that is not above the exposure. Light is stored between passes multiplied by it,
/// about as bright as it is shown: f16 then holds the light of any lamp, and a power of two adds no rounding
/// (S. Lagarde and C. de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, 5.1.2).
fn pre_exposure(exposure: f32) -> f32 {
    match exposure > 0.0 {
        true => f32::from_bits(exposure.clamp(1e-12, 1e12).to_bits() & f32::INFINITY.to_bits()),
        false => 1.0,
    }
}

/// Pixels that a unit of the world covers at distance 1 in a picture of this width and height.
pub(crate) fn pixels_per_unit(camera: &Camera, size: (u32, u32)) -> f32 {
    camera.zoom() * size.1 as f32 * 0.5
}

impl GpuFrame {
    /// `size` is that of the picture in pixels, `height` that of the skin of the avatar that looks largest.
    pub(crate) fn new(
        scene: &Scene,
        irradiance: &[Vec3; 9],
        shadows: &ShadowViews,
        size: (u32, u32),
        height: f32,
    ) -> Self {
        let (light, camera) = (&scene.light, &scene.camera);
        let clip_from_world = camera.clip_from_world();
        let pixels = [size.0 as f32, size.1 as f32];
        Self {
            clip_from_world: clip_from_world.to_cols_array_2d(),
            world_from_clip: camera.world_from_clip().to_cols_array_2d(),
            eye_world: camera.eye().to_array(),
            exposure: light.exposure,
            lamps: [&light.key, &light.fill, &light.rim].map(GpuLamp::new),
            sky: light.environment.sky,
            tone_map: match light.tone_map {
                ToneMap::Linear => 0,
                ToneMap::Neutral => TONE_NEUTRAL,
                ToneMap::AgX => TONE_AGX,
            },
            ground: light.environment.ground,
            near: camera.valid_near(),
            irradiance: irradiance.map(|c| c.extend(0.0).to_array()),
            shadow_from_world: shadows.0.map(|view| view.shadow_from_world.to_cols_array_2d()),
            shadow_depth: shadows.0.map(|view| view.depth),
            shadow_texel: shadows.0.map(|view| view.texel),
            pixels,
            pixels_per_unit: pixels_per_unit(camera, size),
            occlusion_radius: OCCLUSION_RADIUS * height,
            shadow_softness: SHADOW_SOFTNESS * height,
            reflection_levels: (REFLECTION_LEVELS - 1) as f32,
            hair_shadow: 0.0,
            hair_far: 0.0,
            hair_per_depth: 0.0,
            pre_exposure: pre_exposure(light.exposure),
            pad: [0.0; 2],
        }
    }

    /// Says where hair is, and whether it casts shadows.
    pub(crate) fn set_hair(&mut self, camera: &Camera, bounds: Option<Bounds>, has_shadow: bool) {
        let Some(bounds) = bounds else { return };
        let ahead = -Vec3::from(camera.world_from_camera.matrix3.z_axis);
        let middle = (bounds.center() - camera.eye()).dot(ahead);
        // Hair reaches beyond the skin.
        let half = (0.65 * bounds.size().length()).max(1e-6);
        self.hair_shadow = if has_shadow { 1.0 } else { 0.0 };
        self.hair_far = middle + half;
        self.hair_per_depth = 0.5 / half;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_kept_about_as_bright_as_it_is_shown_whatever_the_exposure() {
        for (exposure, expected) in [
            (1.0, 1.0),
            (0.8, 0.5),
            (3.9, 2.0),
            (1e-5, 2.0f32.powi(-17)),
            (0.0, 1.0),
            (-2.0, 1.0),
            (f32::NAN, 1.0),
        ] {
            assert_eq!(pre_exposure(exposure), expected, "{exposure}");
        }
        assert!(pre_exposure(f32::INFINITY).is_finite() && pre_exposure(f32::MIN_POSITIVE) > 0.0);
    }
}
