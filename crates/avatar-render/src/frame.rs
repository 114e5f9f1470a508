//! What all avatars of a frame share, on its way to the GPU.

use crate::{Lamp, Scene};
use bytemuck::Zeroable;
use glam::Vec3;
use std::num::NonZeroU64;
use std::sync::atomic::{AtomicU32, Ordering};

/// Lamps of a frame: key, fill, rim.
pub(crate) const LAMP_COUNT: usize = 3;

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
    pub(crate) eye_world: [f32; 3],
    pub(crate) exposure: f32,
    pub(crate) lamps: [GpuLamp; LAMP_COUNT],
    pub(crate) sky: [f32; 3],
    pub(crate) pad_0: f32,
    pub(crate) ground: [f32; 3],
    pub(crate) pad_1: f32,
}

impl GpuLamp {
    fn new(lamp: &Lamp) -> Self {
        Self {
            direction_world: lamp.direction_world.normalize_or(Vec3::Y).to_array(),
            radiance: lamp.radiance,
            ..Self::zeroed()
        }
    }
}

impl GpuFrame {
    pub(crate) fn new(scene: &Scene) -> Self {
        let light = &scene.light;
        Self {
            clip_from_world: scene.camera.clip_from_world().to_cols_array_2d(),
            eye_world: scene.camera.eye().to_array(),
            exposure: light.exposure,
            lamps: [&light.key, &light.fill, &light.rim].map(GpuLamp::new),
            sky: light.sky,
            ground: light.ground,
            ..Self::zeroed()
        }
    }
}

/// Room for several frames in one buffer. A write to a buffer takes effect before the whole submission, so two draws that
/// are submitted together must not share a slot.
#[derive(Debug)]
pub(crate) struct FrameRing {
    buffer: wgpu::Buffer,
    pub(crate) bind_group: wgpu::BindGroup,
    next: AtomicU32,
}

/// Draws per submission that are told apart.
pub(crate) const FRAME_SLOTS: u32 = 256;
/// WebGPU's default alignment of dynamic offsets.
const SLOT_BYTES: u32 = (size_of::<GpuFrame>() as u32).next_multiple_of(256);
const FRAME_BYTES: Option<NonZeroU64> = NonZeroU64::new(size_of::<GpuFrame>() as u64);

impl FrameRing {
    pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("frame"),
            entries: &[
                wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: true,
                        min_binding_size: FRAME_BYTES,
                    },
                    count: None,
                },
                wgpu::BindGroupLayoutEntry {
                    binding: 1,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                    count: None,
                },
            ],
        })
    }

    pub(crate) fn new(device: &wgpu::Device, layout: &wgpu::BindGroupLayout) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frame: camera and light"),
            size: u64::from(SLOT_BYTES * FRAME_SLOTS),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("repeat, trilinear"),
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            address_mode_w: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            // Free in hardware, several samples per sample in software.
            anisotropy_clamp: if software { 1 } else { 8 },
            ..Default::default()
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &buffer,
                        offset: 0,
                        size: FRAME_BYTES,
                    }),
                },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        Self { buffer, bind_group, next: AtomicU32::new(0) }
    }

    /// Writes a frame into the next slot and returns its offset for the bind group.
    pub(crate) fn push(&self, queue: &wgpu::Queue, frame: &GpuFrame) -> u32 {
        let offset = self.next.fetch_add(1, Ordering::Relaxed) % FRAME_SLOTS * SLOT_BYTES;
        queue.write_buffer(&self.buffer, u64::from(offset), bytemuck::bytes_of(frame));
        offset
    }
}
