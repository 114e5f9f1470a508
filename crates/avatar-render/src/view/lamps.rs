//! The lamps of a frame.

use avatar_look::Lamp;
use bytemuck::Zeroable;
use glam::Vec3;

/// Lamps of a frame: key, fill, rim.
pub(crate) const LAMP_COUNT: usize = 3;
/// Index of the key lamp.
pub(crate) const KEY_LAMP: usize = 0;
/// Index of the rim lamp.
pub(crate) const RIM_LAMP: usize = 2;
/// Lamps that may cast shadows: key, rim.
pub(crate) const SHADOW_COUNT: usize = 2;
/// WGSL `Lamp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuLamp {
    pub(crate) direction_world: [f32; 3],
    pub(crate) pad_0: f32,
    pub(crate) radiance: [f32; 3],
    pub(crate) pad_1: f32,
}

impl GpuLamp {
    pub(crate) fn new(lamp: &Lamp) -> Self {
        Self { direction_world: direction(lamp).to_array(), radiance: lamp.radiance, ..Self::zeroed() }
    }
}

/// The direction toward a lamp, of length 1; +Y if the lamp has no direction.
pub(crate) fn direction(lamp: &Lamp) -> Vec3 {
    lamp.direction_world.normalize_or(Vec3::Y)
}
