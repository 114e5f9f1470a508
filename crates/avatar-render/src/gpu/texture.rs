//! Textures from pictures, with mip levels.

use crate::gpu::image::{Image, ImageSizeError};
use crate::gpu::mips::{Encoding, half};
use std::collections::HashMap;

/// What a texture is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum TextureUse {
    /// sRGB colour with alpha.
    Color,
    /// One linear channel, the red one.
    Value,
    /// Tangent-space normals.
    Normal,
}

impl TextureUse {
    fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Color => wgpu::TextureFormat::Rgba8UnormSrgb,
            Self::Value => wgpu::TextureFormat::R8Unorm,
            Self::Normal => wgpu::TextureFormat::Rgba8Unorm,
        }
    }

    fn encoding(self) -> Encoding {
        match self {
            Self::Color => Encoding::Srgb,
            Self::Value => Encoding::Red,
            Self::Normal => Encoding::Linear,
        }
    }
}

/// The textures of one model: parts that share a picture share its texture.
#[derive(Debug, Default)]
pub(crate) struct Textures {
    /// By the place of the picture in memory.
    known: HashMap<(usize, TextureUse), wgpu::TextureView>,
    /// By what lies beyond the edges, across and down.
    samplers: HashMap<[wgpu::AddressMode; 2], wgpu::Sampler>,
}

impl Textures {
    /// What samples a texture of a part; each is made once.
    pub(crate) fn sampler(&mut self, device: &wgpu::Device, modes: [wgpu::AddressMode; 2]) -> wgpu::Sampler {
        let made = || sampler(device, "texture of a part", modes, true);
        self.samplers.entry(modes).or_insert_with(made).clone()
    }

    /// The texture of a picture, which is uploaded once. All pictures have to stay where they are while
    /// `self` lives, but for those of one pixel.
    pub(crate) fn upload(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        label: &str,
        image: &Image,
        usage: TextureUse,
    ) -> Result<wgpu::TextureView, ImageSizeError> {
        let key = (std::ptr::from_ref(image).addr(), usage);
        if image.rgba.len() <= 4 {
            return upload(device, queue, label, image, usage);
        }
        if let Some(view) = self.known.get(&key) {
            return Ok(view.clone());
        }
        let view = upload(device, queue, label, image, usage)?;
        self.known.insert(key, view.clone());
        Ok(view)
    }
}

/// A trilinear sampler. `is_anisotropic` asks for sharpness on tilted surfaces, which is free in hardware; in
/// software it would take several samples, and is left out.
pub(crate) fn sampler(
    device: &wgpu::Device,
    label: &str,
    [u, v]: [wgpu::AddressMode; 2],
    is_anisotropic: bool,
) -> wgpu::Sampler {
    let is_software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some(label),
        address_mode_u: u,
        address_mode_v: v,
        address_mode_w: u,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        anisotropy_clamp: if is_anisotropic && !is_software { 8 } else { 1 },
        ..Default::default()
    })
}

/// Uploads a picture and its mip levels. One that is larger than the device allows is halved until it fits.
fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    image: &Image,
    usage: TextureUse,
) -> Result<wgpu::TextureView, ImageSizeError> {
    image.check()?;
    let limit = device.limits().max_texture_dimension_2d;
    let mut shrunk = None;
    while let level = shrunk.as_ref().unwrap_or(image)
        && level.width.max(level.height) > limit
    {
        shrunk = Some(half(level, usage.encoding()));
    }
    let base = shrunk.as_ref().unwrap_or(image);
    let levels = base.width.max(base.height).ilog2() + 1;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: base.width, height: base.height, depth_or_array_layers: 1 },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: usage.format(),
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    write_level(queue, &texture, 0, base, usage);
    let mut previous = None;
    for level in 1..levels {
        let smaller = half(previous.as_ref().unwrap_or(base), usage.encoding());
        write_level(queue, &texture, level, &smaller, usage);
        previous = Some(smaller);
    }
    Ok(texture.create_view(&wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() }))
}

fn write_level(queue: &wgpu::Queue, texture: &wgpu::Texture, level: u32, image: &Image, usage: TextureUse) {
    let reds: Vec<u8>;
    let (bytes, pixel_bytes) = match usage {
        TextureUse::Value => {
            reds = image.rgba.iter().copied().step_by(4).collect();
            (&reds, 1)
        }
        TextureUse::Color | TextureUse::Normal => (&image.rgba, 4),
    };
    queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: level,
            origin: wgpu::Origin3d::ZERO,
            aspect: wgpu::TextureAspect::All,
        },
        bytes,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(image.width * pixel_bytes),
            rows_per_image: Some(image.height),
        },
        wgpu::Extent3d { width: image.width, height: image.height, depth_or_array_layers: 1 },
    );
}
