//! Group 1 of passes that draw: the results of earlier passes.

use crate::gpu::bindings::{sampler_entry, texture_binding, texture_entry};
use crate::view::resources::Resources;

/// Strands are lit at their points, in the vertex stage.
const VISIBILITY: wgpu::ShaderStages = wgpu::ShaderStages::VERTEX_FRAGMENT;

/// A texture that is read texel by texel.
pub(crate) fn texel_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let read = wgpu::TextureSampleType::Float { filterable: false };
    texture_entry(binding, VISIBILITY, read, wgpu::TextureViewDimension::D2)
}

/// Entries for shadow maps, which all lit programs read: bindings 0, 1 and 2.
pub(crate) fn shadow_entries() -> [wgpu::BindGroupLayoutEntry; 3] {
    let depth = wgpu::TextureSampleType::Depth;
    [
        texture_entry(0, VISIBILITY, depth, wgpu::TextureViewDimension::D2Array),
        sampler_entry(1, VISIBILITY, wgpu::SamplerBindingType::Comparison),
        texel_entry(2),
    ]
}

/// The resources for [`shadow_entries`]. The pass that draws the map of hair cannot read it: it binds another
/// texture as `hair_map`.
pub(crate) fn shadow_bindings<'a>(
    resources: &'a Resources,
    hair_map: &'a wgpu::TextureView,
) -> [wgpu::BindGroupEntry<'a>; 3] {
    let sampler = wgpu::BindingResource::Sampler(&resources.shadow_sampler);
    [
        texture_binding(0, &resources.shadow_map),
        wgpu::BindGroupEntry { binding: 1, resource: sampler },
        texture_binding(2, hair_map),
    ]
}

/// The results of earlier passes of a picture, one sample per pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PictureInputs<'a> {
    pub(crate) depth: &'a wgpu::TextureView,
    pub(crate) normals: &'a wgpu::TextureView,
    pub(crate) occlusion: &'a wgpu::TextureView,
    pub(crate) skin_light: &'a wgpu::TextureView,
}

/// Layout of group 1 of passes that draw parts.
pub(crate) fn view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let flat = wgpu::TextureViewDimension::D2;
    let [map, sampler, hair_map] = shadow_entries();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("view"),
        entries: &[
            map,
            sampler,
            hair_map,
            texture_entry(3, VISIBILITY, wgpu::TextureSampleType::Depth, flat),
            texel_entry(4),
            texel_entry(5),
            texel_entry(6),
        ],
    })
}

/// A group of [`view_layout`].
pub(crate) fn view_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: &Resources,
    label: &str,
    inputs: PictureInputs<'_>,
) -> wgpu::BindGroup {
    let [map, sampler, hair_map] = shadow_bindings(resources, &resources.hair_map);
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &[
            map,
            sampler,
            hair_map,
            texture_binding(3, inputs.depth),
            texture_binding(4, inputs.normals),
            texture_binding(5, inputs.occlusion),
            texture_binding(6, inputs.skin_light),
        ],
    })
}
