//! The environment: its reflections as a texture, and its diffuse light.

use crate::gpu::color::half_bits;
use crate::view::shading::Terms;
use avatar_look::{CUBE_FACES, Environment};
use glam::Vec3;
use std::sync::{Mutex, PoisonError};

/// Texels of a face of the reflections on a side.
const REFLECTION_SIZE: u32 = 64;
/// Levels of the reflections, from a mirror to fully rough.
pub(crate) const REFLECTION_LEVELS: u32 = 7;

/// The environment of the last frame.
#[derive(Debug)]
pub(crate) struct EnvironmentMap {
    reflections: wgpu::Texture,
    /// The same, for reading.
    pub(crate) cube: wgpu::TextureView,
    /// The environment that is uploaded, and its diffuse light.
    uploaded: Mutex<Option<(Environment, [Vec3; 9])>>,
}

impl EnvironmentMap {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let reflections = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("environment: reflections"),
            size: wgpu::Extent3d {
                width: REFLECTION_SIZE,
                height: REFLECTION_SIZE,
                depth_or_array_layers: CUBE_FACES,
            },
            mip_level_count: REFLECTION_LEVELS,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let cube = reflections.create_view(&wgpu::TextureViewDescriptor {
            label: Some("environment: reflections"),
            dimension: Some(wgpu::TextureViewDimension::Cube),
            ..Default::default()
        });
        Self { reflections, cube, uploaded: Mutex::new(None) }
    }

    /// The diffuse light of an environment. If it is another one than last time, its reflections are uploaded
    /// as well, which takes some milliseconds; shadings without reflections do not need that.
    pub(crate) fn irradiance(
        &self,
        queue: &wgpu::Queue,
        environment: &Environment,
        terms: Terms,
    ) -> [Vec3; 9] {
        let mut uploaded = self.uploaded.lock().unwrap_or_else(PoisonError::into_inner);
        match &*uploaded {
            Some((old, irradiance)) if old == environment => *irradiance,
            _ => {
                let irradiance = environment.irradiance();
                if terms.reflections {
                    self.upload(queue, environment);
                }
                *uploaded = Some((*environment, irradiance));
                irradiance
            }
        }
    }

    fn upload(&self, queue: &wgpu::Queue, environment: &Environment) {
        let levels = environment.reflections(REFLECTION_SIZE, REFLECTION_LEVELS);
        for (level, texels) in levels.iter().enumerate() {
            let size = (REFLECTION_SIZE >> level).max(1);
            let halves: Vec<u16> = texels.iter().flatten().copied().map(half_bits).collect();
            queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &self.reflections,
                    mip_level: level as u32,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                bytemuck::cast_slice(&halves),
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(size * 8),
                    rows_per_image: Some(size),
                },
                wgpu::Extent3d { width: size, height: size, depth_or_array_layers: CUBE_FACES },
            );
        }
    }
}
