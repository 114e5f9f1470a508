//! Lists of four numbers each, as textures: software adapters read textures seven times faster than storage.

/// Texels per row: a power of two, so that a row has as many bytes as copies need for their alignment.
pub(crate) const VEC4S_PER_ROW: u32 = 2048;
const VEC4_BYTES: u32 = size_of::<[f32; 4]>() as u32;

/// A texture that holds a list of vec4s, row by row.
#[derive(Debug)]
pub(crate) struct Vec4Texture {
    texture: wgpu::Texture,
    pub(crate) view: wgpu::TextureView,
    vec4s: u32,
}

impl Vec4Texture {
    /// The most vec4s that one texture of the device holds.
    pub(crate) fn most(limits: &wgpu::Limits) -> usize {
        VEC4S_PER_ROW as usize * limits.max_texture_dimension_2d as usize
    }

    /// A texture for the contents of a buffer. If the buffer is larger than [`Vec4Texture::most`], the
    /// texture holds its beginning.
    pub(crate) fn new(device: &wgpu::Device, label: &str, buffer: &wgpu::Buffer) -> Self {
        let vec4s = (buffer.size() / u64::from(VEC4_BYTES)).min(Self::most(&device.limits()) as u64) as u32;
        Self::of(device, label, vec4s, wgpu::TextureFormat::Rgba32Float)
    }

    /// A texture with a constant list; elements beyond [`Vec4Texture::most`] are left out.
    pub(crate) fn with(device: &wgpu::Device, queue: &wgpu::Queue, label: &str, list: &[[u32; 4]]) -> Self {
        let most = Self::most(&device.limits());
        let list = list.get(..most).unwrap_or(list);
        let new = Self::of(device, label, list.len() as u32, wgpu::TextureFormat::Rgba32Uint);
        for (layout, to, size) in new.pieces() {
            let bytes = list.get((layout.offset / u64::from(VEC4_BYTES)) as usize..).unwrap_or_default();
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, ..layout };
            queue.write_texture(to, bytemuck::cast_slice(bytes), layout, size);
        }
        new
    }

    fn of(device: &wgpu::Device, label: &str, vec4s: u32, format: wgpu::TextureFormat) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d {
                width: VEC4S_PER_ROW,
                height: vec4s.div_ceil(VEC4S_PER_ROW).max(1),
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let view =
            texture.create_view(&wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() });
        Self { texture, view, vec4s }
    }

    /// Records a copy of the buffer into the texture.
    pub(crate) fn fill(&self, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer) {
        for (layout, to, size) in self.pieces() {
            encoder.copy_buffer_to_texture(wgpu::TexelCopyBufferInfo { buffer, layout }, to, size);
        }
    }

    /// The copies that fill the texture: first all whole rows, then the rest of the last row.
    fn pieces(
        &self,
    ) -> impl Iterator<Item = (wgpu::TexelCopyBufferLayout, wgpu::TexelCopyTextureInfo<'_>, wgpu::Extent3d)>
    {
        let bytes_per_row = VEC4S_PER_ROW * VEC4_BYTES;
        let (rows, rest) = (self.vec4s / VEC4S_PER_ROW, self.vec4s % VEC4S_PER_ROW);
        let pieces = [(0, VEC4S_PER_ROW, rows), (rows, rest, 1)];
        pieces.into_iter().filter(|(_, width, height)| *width > 0 && *height > 0).map(
            move |(row, width, height)| {
                let layout = wgpu::TexelCopyBufferLayout {
                    offset: u64::from(row) * u64::from(bytes_per_row),
                    bytes_per_row: Some(bytes_per_row),
                    rows_per_image: None,
                };
                let to = wgpu::TexelCopyTextureInfo {
                    origin: wgpu::Origin3d { x: 0, y: row, z: 0 },
                    ..self.texture.as_image_copy()
                };
                (layout, to, wgpu::Extent3d { width, height, depth_or_array_layers: 1 })
            },
        )
    }
}
