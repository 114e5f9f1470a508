//! Pictures of light instead of bytes: a float target, read back, nothing clipped and nothing rounded to 8
//! bits.

use super::gpu;
use avatar_render::headless::Gpu;
use avatar_render::{
    AvatarCrowd, AvatarModel, AvatarState, Camera, Environment, Lamp, Light, Renderer, RendererConfig, Scene,
    Shading, Targets, ToneMap,
};
use glam::{Vec2, Vec3};
use half::f16;
use std::sync::{Mutex, PoisonError};

/// A renderer with targets of one size and what reads them back.
pub(crate) struct Stage {
    pub(crate) renderer: Renderer,
    pub(crate) targets: Targets,
    pub(crate) texture: wgpu::Texture,
    /// Locked while a frame is recorded, submitted and read: tests that run at once share stages, and frames
    /// that are submitted together share an environment.
    readable: Mutex<wgpu::Buffer>,
    size: u32,
}

/// The light that arrives at the pixels of a square picture, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture {
    pub(crate) size: u32,
    pub(crate) light: Vec<Vec3>,
}

const FLOAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A stage with a float target and one sample per pixel. Programs are compiled when they are first drawn
/// with, which takes software longer than the picture: tests of one program share their stages.
pub(crate) fn stage(shading: Shading, size: u32) -> Option<&'static Stage> {
    static STAGES: Mutex<Vec<(Shading, u32, &'static Stage)>> = Mutex::new(Vec::new());
    let gpu = gpu()?;
    let mut stages = STAGES.lock().unwrap_or_else(PoisonError::into_inner);
    let known = stages.iter().find(|(s, n, _)| (*s, *n) == (shading, size)).map(|(.., stage)| *stage);
    Some(known.unwrap_or_else(|| {
        let made = Box::leak(Box::new(Stage::new(gpu, shading, size, FLOAT)));
        stages.push((shading, size, made));
        made
    }))
}

impl Stage {
    pub(crate) fn new(gpu: &Gpu, shading: Shading, size: u32, format: wgpu::TextureFormat) -> Self {
        let config = RendererConfig { color_format: format, samples: 1, shading };
        let renderer = Renderer::new(&gpu.device, &gpu.queue, config).expect("a renderer");
        let targets = Targets::new(&gpu.device, &renderer, size, size).expect("targets");
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let readable = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row_bytes(format, size) * size),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { renderer, targets, texture, readable: Mutex::new(readable), size }
    }

    /// The bytes of the target after a frame, rows without padding.
    pub(crate) fn bytes(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Vec<u8> {
        self.bytes_after(gpu, |encoder| {
            let view = self.texture.create_view(&Default::default());
            self.renderer
                .draw(encoder, &view, &self.targets, &gpu.queue, scene, avatars)
                .expect("what belongs together");
        })
    }

    /// The same of a frame with crowds.
    pub(crate) fn bytes_of_crowds(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        crowds: &mut [(&AvatarModel, &mut AvatarCrowd)],
    ) -> Vec<u8> {
        self.bytes_after(gpu, |encoder| {
            let view = self.texture.create_view(&Default::default());
            self.renderer
                .draw_crowds(encoder, &view, &self.targets, &gpu.queue, scene, avatars, crowds, None)
                .expect("what belongs together");
        })
    }

    /// The bytes of the target after what is recorded, rows without padding.
    pub(crate) fn bytes_after(&self, gpu: &Gpu, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> Vec<u8> {
        let readable = self.readable.lock().unwrap_or_else(PoisonError::into_inner);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        record(&mut encoder);
        let row = row_bytes(self.texture.format(), self.size);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: Some(self.size),
        };
        let to = wgpu::TexelCopyBufferInfo { buffer: &readable, layout };
        encoder.copy_texture_to_buffer(self.texture.as_image_copy(), to, self.texture.size());
        gpu.queue.submit([encoder.finish()]);
        readable.map_async(wgpu::MapMode::Read, .., |result| result.expect("mapped"));
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("polled");
        let mapped = readable.get_mapped_range(..).expect("mapped");
        let used = (texel_bytes(self.texture.format()) * self.size) as usize;
        let bytes = mapped.chunks_exact(row as usize).flat_map(|row| row[..used].to_vec()).collect();
        drop(mapped);
        readable.unmap();
        assert_eq!(gpu.errors.take(), None, "the device has nothing to complain of");
        bytes
    }

    /// The light of a frame; the target must be a float one.
    pub(crate) fn draw(&self, gpu: &Gpu, scene: &Scene, avatars: &[(&AvatarModel, &AvatarState)]) -> Picture {
        let bytes = self.bytes(gpu, scene, avatars);
        let half = |b: &[u8]| f16::from_le_bytes([b[0], b[1]]).to_f32();
        let light = bytes.chunks_exact(8).map(|p| Vec3::new(half(&p[0..]), half(&p[2..]), half(&p[4..])));
        Picture { size: self.size, light: light.collect() }
    }
}

fn texel_bytes(format: wgpu::TextureFormat) -> u32 {
    format.block_copy_size(None).expect("a plain format")
}

fn row_bytes(format: wgpu::TextureFormat, size: u32) -> u32 {
    (texel_bytes(format) * size).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

/// One avatar as a float picture.
pub(crate) fn light_of(
    shading: Shading,
    size: u32,
    scene: &Scene,
    (model, state): &(AvatarModel, AvatarState),
) -> Picture {
    let gpu = gpu().expect("asked before");
    stage(shading, size).expect("asked before").draw(gpu, scene, &[(model, state)])
}

impl Picture {
    pub(crate) fn pixel(&self, x: u32, y: u32) -> Vec3 {
        self.light[(y * self.size + x) as usize]
    }

    pub(crate) fn middle(&self) -> Vec3 {
        self.pixel(self.size / 2, self.size / 2)
    }

    /// The pixel that a point of the world falls into.
    pub(crate) fn at(&self, camera: &Camera, point: Vec3) -> Vec3 {
        let at = pixel_of(camera, self.size, point);
        self.pixel(at.x as u32, at.y as u32)
    }

    /// All pixels with their middles.
    pub(crate) fn pixels(&self) -> impl Iterator<Item = (Vec2, Vec3)> {
        let size = self.size;
        let middle = move |i: u32| Vec2::new((i % size) as f32 + 0.5, (i / size) as f32 + 0.5);
        (0..size * size).map(middle).zip(self.light.iter().copied())
    }

    /// Left and right exchanged.
    pub(crate) fn flipped(&self) -> Self {
        let rows = self.light.chunks_exact(self.size as usize);
        Self { light: rows.flat_map(|row| row.iter().rev().copied()).collect(), ..*self }
    }

    /// The share of pixels that differ by more than this in a channel.
    pub(crate) fn difference_share(&self, other: &Self, tolerance: f32) -> f32 {
        assert_eq!(self.size, other.size);
        let pairs = self.light.iter().zip(&other.light);
        let differing = pairs.filter(|(a, b)| (**a - **b).abs().max_element() > tolerance).count();
        differing as f32 / self.light.len() as f32
    }

    /// The mean place of the light, weighted.
    pub(crate) fn centroid(&self, weight: impl Fn(Vec3) -> f32) -> Vec2 {
        let weighted = || self.pixels().map(|(at, light)| (at, weight(light)));
        let total: f32 = weighted().map(|(_, w)| w).sum();
        assert!(total > 0.0, "there is something to find");
        weighted().map(|(at, w)| at * w).sum::<Vec2>() / total
    }
}

/// Where a point of the world is in a square picture, in pixels from the upper left corner.
pub(crate) fn pixel_of(camera: &Camera, size: u32, point: Vec3) -> Vec2 {
    let clip = camera.clip_from_world().project_point3(point);
    Vec2::new(clip.x * 0.5 + 0.5, 0.5 - clip.y * 0.5) * size as f32
}

/// The direction from the eye through a place of a square picture.
pub(crate) fn ray_through(camera: &Camera, size: u32, pixel: Vec2) -> Vec3 {
    let slope = (camera.vertical_fov_rad * 0.5).tan();
    let across = (pixel / size as f32 * 2.0 - 1.0) * slope;
    let direction = Vec3::new(across.x * camera.aspect, -across.y, -1.0);
    camera.world_from_camera.transform_vector3(direction).normalize_or_zero()
}

/// Where a ray from `from` first meets a ball.
pub(crate) fn meets_ball(from: Vec3, direction: Vec3, center: Vec3, radius: f32) -> Option<Vec3> {
    let to = from - center;
    let b = to.dot(direction);
    let root = b * b - to.length_squared() + radius * radius;
    (root >= 0.0).then(|| from + direction * (-b - root.sqrt()))
}

pub(crate) const NO_LAMP: Lamp = Lamp { direction_world: Vec3::Z, radiance: [0.0; 3] };

/// Light for measuring: no lamps, `environment`, no tone mapping.
pub(crate) fn bare_light(environment: Environment) -> Light {
    Light { key: NO_LAMP, fill: NO_LAMP, rim: NO_LAMP, environment, exposure: 1.0, tone_map: ToneMap::Linear }
}

/// A white lamp alone, for measuring.
pub(crate) fn key_light(toward_lamp: Vec3) -> Light {
    let key = Lamp { direction_world: toward_lamp, radiance: [1.0; 3] };
    Light { key, ..bare_light(Environment::uniform([0.0; 3])) }
}

/// A scene on black.
pub(crate) fn lit_scene(camera: Camera, light: Light) -> Scene {
    Scene { camera, background: [0.0, 0.0, 0.0, 1.0], light }
}
