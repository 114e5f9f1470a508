use crate::Renderer;

/// The depth buffer's format; nothing beyond WebGPU's core.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Depth, and multisampled colour where there are several samples, for pictures of one size.
#[derive(Debug)]
pub struct Targets {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) format: wgpu::TextureFormat,
    pub(crate) depth: wgpu::TextureView,
    pub(crate) multisampled: Option<wgpu::TextureView>,
}

/// A picture size that the device cannot draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected a picture of 1×1 to {limit}×{limit} pixels, found {width}×{height}")]
pub struct SizeError {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Largest width and height.
    pub limit: u32,
}

impl Targets {
    /// Room to draw pictures of this size with this renderer.
    ///
    /// # Errors
    /// A width or height of 0, or beyond what the device allows.
    pub fn new(
        device: &wgpu::Device,
        renderer: &Renderer,
        width: u32,
        height: u32,
    ) -> Result<Self, SizeError> {
        let limit = device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(SizeError { width, height, limit });
        }
        let config = renderer.config();
        let attachment = |label, format, sample_count| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() })
        };
        let several = config.samples > 1;
        Ok(Self {
            width,
            height,
            format: config.color_format,
            depth: attachment("depth", DEPTH_FORMAT, config.samples),
            multisampled: several
                .then(|| attachment("multisampled color", config.color_format, config.samples)),
        })
    }

    /// Pixels across and down.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }
}
