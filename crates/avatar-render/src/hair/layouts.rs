//! Layouts of the bind groups of hair.

use crate::gpu::bindings::{
    dynamic_uniform_entry, storage_entry, texels_entry, texture_entry, uniform_entry,
};
use crate::gpu::ring::Ring;
use crate::hair::detail::GpuHairView;
use crate::view::inputs::{shadow_entries, texel_entry};

/// Of the texture with the distances from the skin.
pub(crate) const FIELD_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Uint;

/// Layouts of the growing pass: group 0 hair, group 2 the deformed skin.
pub(crate) fn grow_layouts(device: &wgpu::Device) -> [wgpu::BindGroupLayout; 2] {
    let compute = wgpu::ShaderStages::COMPUTE;
    let float = wgpu::TextureSampleType::Float { filterable: false };
    let (flat, deep) = (wgpu::TextureViewDimension::D2, wgpu::TextureViewDimension::D3);
    let (list, vectors) = (wgpu::TextureFormat::Rgba32Uint, wgpu::TextureFormat::Rgba32Float);
    // WebGPU promises four storage textures; the fifth, which is only read while hair swings, is another.
    [
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("grow hair"),
            entries: &[
                uniform_entry(0, compute),
                texels_entry(1, compute, list, flat),
                texels_entry(2, compute, FIELD_FORMAT, deep),
                storage_entry(3, compute, false),
                texels_entry(4, compute, vectors, flat),
                texture_entry(5, compute, float, flat),
            ],
        }),
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("deformed skin"),
            entries: &[texels_entry(0, compute, vectors, flat), uniform_entry(1, compute)],
        }),
    ]
}

/// Layout of group 2 of the drawing.
pub(crate) fn draw_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let vertex = wgpu::ShaderStages::VERTEX;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("draw hair"),
        entries: &[
            uniform_entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT),
            texture_entry(1, vertex, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2),
            storage_entry(2, vertex, true),
        ],
    })
}

/// Layout of group 1 of passes that draw strands: shadow maps, and what earlier passes over hair left.
pub(crate) fn inputs_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let [map, sampler, hair_map] = shadow_entries();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("strands: inputs"),
        entries: &[map, sampler, hair_map, texel_entry(3), texel_entry(4), texel_entry(5)],
    })
}

/// Layout of group 1 of the passes that lay strands over the picture.
pub(crate) fn compose_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("hair over the picture: inputs"),
        entries: &[texel_entry(0), texel_entry(1), texel_entry(2)],
    })
}

/// Layout of group 3 of passes that draw strands: which of them.
pub(crate) fn hair_view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("view of hair"),
        entries: &[dynamic_uniform_entry(visibility, Ring::<GpuHairView>::BYTES)],
    })
}
