//! Textures that passes draw into.

/// What becomes of a texture that passes draw into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// It is only drawn into.
    Drawn,
    /// Later passes read it.
    DrawnAndRead,
}

/// A texture that passes draw into; `size` is its width and height.
pub(crate) fn attachment(
    device: &wgpu::Device,
    label: &str,
    format: wgpu::TextureFormat,
    sample_count: u32,
    (width, height): (u32, u32),
    purpose: Purpose,
) -> wgpu::TextureView {
    let read = match purpose {
        Purpose::Drawn => wgpu::TextureUsages::empty(),
        Purpose::DrawnAndRead => wgpu::TextureUsages::TEXTURE_BINDING,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | read,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() })
}
