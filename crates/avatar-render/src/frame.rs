//! What all avatars of a frame share, on its way to the GPU.

use crate::resources::REFLECTION_LEVELS;
use crate::shadows::ShadowViews;
use crate::{Camera, Lamp, Scene, ToneMap};
use avatar_mesh::Bounds;
use bytemuck::Zeroable;
use glam::Vec3;
use std::num::NonZeroU64;
use std::sync::atomic::{AtomicU32, Ordering};

/// Lamps of a frame: key, fill, rim.
pub(crate) const LAMP_COUNT: usize = 3;
/// Place of the key lamp.
pub(crate) const KEY_LAMP: usize = 0;
/// Place of the rim lamp.
pub(crate) const RIM_LAMP: usize = 2;
/// Lamps that may cast shadows: key, rim.
pub(crate) const SHADOW_COUNT: usize = 2;
/// [`ToneMap::Neutral`] in WGSL.
pub(crate) const TONE_NEUTRAL: u32 = 1;
/// [`ToneMap::AgX`] in WGSL.
pub(crate) const TONE_AGX: u32 = 2;

/// How far away things darken one another, as a fraction of the height of the skin: lids and eyes, lips and teeth.
const OCCLUSION_RADIUS: f32 = 0.05;
/// How far the edges of shadows are softened, as a fraction of the height of the skin.
const SHADOW_SOFTNESS: f32 = 0.007;

/// WGSL `Lamp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuLamp {
    pub(crate) direction_world: [f32; 3],
    pub(crate) pad_0: f32,
    pub(crate) radiance: [f32; 3],
    pub(crate) pad_1: f32,
}

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

impl GpuLamp {
    fn new(lamp: &Lamp) -> Self {
        Self { direction_world: direction(lamp).to_array(), radiance: lamp.radiance, ..Self::zeroed() }
    }
}

/// Toward a lamp, unit length.
pub(crate) fn direction(lamp: &Lamp) -> Vec3 {
    lamp.direction_world.normalize_or(Vec3::Y)
}

/// The power of two below the exposure: light is kept between passes as bright as it is shown, so that halves hold that of
/// any lamp, and with no more rounding than before (S. Lagarde and C. de Rousiers, "Moving Frostbite to Physically Based
/// Rendering", 2014, 5.1.2).
fn pre_exposure(exposure: f32) -> f32 {
    match exposure > 0.0 {
        true => f32::from_bits(exposure.clamp(1e-12, 1e12).to_bits() & f32::INFINITY.to_bits()),
        false => 1.0,
    }
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
            pixels_per_unit: camera.zoom() * pixels[1] * 0.5,
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

    /// Tells that there is hair around these bounds, and whether it casts shadows.
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

/// Zeros to be written by the queue. wgpu would clear what was never written when a submission first binds it, and where another
/// thread writes in just that moment, it would clear what was written: this buffer is whole from the start.
pub(crate) fn written_buffer(
    device: &wgpu::Device,
    label: &str,
    size: u64,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: true,
    });
    buffer.unmap();
    buffer
}

/// Room for several values in one uniform buffer, bound with a dynamic offset. A write to a buffer takes effect before
/// the whole submission, so two draws that are submitted together must not share a slot.
#[derive(Debug)]
pub(crate) struct Ring<T> {
    pub(crate) buffer: wgpu::Buffer,
    next: AtomicU32,
    of: std::marker::PhantomData<fn(T)>,
}

/// Draws per submission that are told apart.
pub(crate) const FRAME_SLOTS: u32 = 256;

impl<T: bytemuck::Pod> Ring<T> {
    /// WebGPU's default alignment of dynamic offsets.
    const SLOT_BYTES: u32 = (size_of::<T>() as u32).next_multiple_of(256);
    const FOR_TESTS: wgpu::BufferUsages =
        if cfg!(test) { wgpu::BufferUsages::COPY_SRC } else { wgpu::BufferUsages::empty() };
    /// Size of the binding.
    pub(crate) const BYTES: Option<NonZeroU64> = NonZeroU64::new(size_of::<T>() as u64);

    pub(crate) fn new(device: &wgpu::Device, label: &str, slots_per_frame: u32) -> Self {
        let size = u64::from(Self::SLOT_BYTES * FRAME_SLOTS * slots_per_frame);
        let buffer = written_buffer(device, label, size, wgpu::BufferUsages::UNIFORM | Self::FOR_TESTS);
        Self { buffer, next: AtomicU32::new(0), of: std::marker::PhantomData }
    }

    /// The binding of one slot; which one, its dynamic offset says.
    pub(crate) fn binding(&self) -> wgpu::BindingResource<'_> {
        let buffer = &self.buffer;
        wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size: Self::BYTES })
    }

    /// Writes a value into the next slot and returns its offset for the bind group.
    pub(crate) fn push(&self, queue: &wgpu::Queue, value: &T) -> u32 {
        let slots = (self.buffer.size() / u64::from(Self::SLOT_BYTES)) as u32;
        let offset = self.next.fetch_add(1, Ordering::Relaxed) % slots * Self::SLOT_BYTES;
        queue.write_buffer(&self.buffer, u64::from(offset), bytemuck::bytes_of(value));
        offset
    }
}

/// A dynamic uniform at binding 0.
pub(crate) fn uniform_entry(
    visibility: wgpu::ShaderStages,
    bytes: Option<NonZeroU64>,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: bytes,
        },
        count: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::headless::{Gpu, GpuOptions, open_blocking};
    use std::io::Write as _;

    /// The first number in each slot, after `also` was submitted together with what reads them.
    fn slots(gpu: &Gpu, ring: &Ring<[u32; 4]>, also: usize) -> Vec<u8> {
        let size = ring.buffer.size();
        let buffer = || {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readable"),
                size,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let readable = buffer();
        let encoder =
            || gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("slots") });
        let mut commands = vec![encoder()];
        commands[0].copy_buffer_to_buffer(&ring.buffer, 0, &readable, 0, size);
        commands.extend((0..also).map(|_| {
            let mut encoder = encoder();
            encoder.clear_buffer(&buffer(), 0, Some(16));
            encoder
        }));
        gpu.queue.submit(commands.into_iter().map(wgpu::CommandEncoder::finish).collect::<Vec<_>>());
        let view =
            crate::readback::block_on(crate::readback::mapped(&gpu.device, &readable)).expect("mapped");
        view.chunks_exact(Ring::<[u32; 4]>::SLOT_BYTES as usize).map(|slot| slot[0]).collect()
    }

    #[allow(clippy::disallowed_methods, reason = "the test is about threads")]
    #[test]
    fn a_slot_keeps_its_value_while_another_thread_submits() {
        let gpu = match open_blocking(GpuOptions::default()) {
            Ok(gpu) => gpu,
            Err(reason) => {
                let _ = writeln!(std::io::stderr(), "SKIPPED: {reason}");
                return;
            }
        };
        for round in 0..100 {
            let ring = Ring::new(&gpu.device, "ring", 1);
            let start = std::sync::Barrier::new(2);
            std::thread::scope(|scope| {
                scope.spawn(|| {
                    start.wait();
                    // Long enough for the other to write meanwhile.
                    slots(&gpu, &ring, 100);
                });
                start.wait();
                for _ in 0..FRAME_SLOTS {
                    ring.push(&gpu.queue, &[7; 4]);
                }
            });
            let lost = slots(&gpu, &ring, 0).iter().filter(|value| **value != 7).count();
            assert_eq!(lost, 0, "round {round}");
        }
    }

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
