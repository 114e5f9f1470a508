//! The textures that passes over hair draw into and read.

use crate::gpu::attachment::{Purpose, attachment};
use crate::gpu::bindings::texture_binding;
use crate::hair::layouts::{compose_layout, inputs_layout};
use crate::view::config::RendererConfig;
use crate::view::inputs::shadow_bindings;
use crate::view::resources::Resources;

/// Colours of strands, weighted, and their weights.
pub(crate) const HAIR_SUM_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// What strands leave clear.
pub(crate) const HAIR_CLEAR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Textures of one picture. With several samples per pixel they are single pixels, because strands cover
/// samples then.
#[derive(Debug)]
pub(crate) struct HairTargets {
    /// Where strands lie.
    pub(crate) layers: wgpu::TextureView,
    /// How much they cover at each depth, front and back.
    pub(crate) slices: [wgpu::TextureView; 2],
    /// Their colours, weighted.
    pub(crate) sum: wgpu::TextureView,
    /// What they leave clear.
    pub(crate) clear: wgpu::TextureView,
    /// The inputs of each pass. The shadow and the layers read nothing of hair.
    pub(crate) for_shadow: wgpu::BindGroup,
    pub(crate) for_slices: wgpu::BindGroup,
    pub(crate) for_strands: wgpu::BindGroup,
    pub(crate) for_composing: wgpu::BindGroup,
}

impl HairTargets {
    /// For pictures of this width and height.
    pub(crate) fn new(
        device: &wgpu::Device,
        resources: &Resources,
        config: RendererConfig,
        size: (u32, u32),
    ) -> Self {
        let size = if config.samples > 1 { (1, 1) } else { size };
        let texture = |label, format| attachment(device, label, format, 1, size, Purpose::DrawnAndRead);
        let layers = texture("layers of hair", HAIR_SUM_FORMAT);
        let slices =
            [texture("hair: front slices", HAIR_SUM_FORMAT), texture("hair: back slices", HAIR_SUM_FORMAT)];
        let sum = texture("hair", HAIR_SUM_FORMAT);
        let clear = texture("hair: what it leaves clear", HAIR_CLEAR_FORMAT);
        // Bound instead of textures that the pass itself writes, or that are not written yet.
        let nothing = attachment(device, "nothing", HAIR_SUM_FORMAT, 1, (1, 1), Purpose::DrawnAndRead);
        let layout = inputs_layout(device);
        let group = |label, hair_map, [layers, front, back]: [&wgpu::TextureView; 3]| {
            let [map, sampler, hair_map] = shadow_bindings(resources, hair_map);
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout: &layout,
                entries: &[
                    map,
                    sampler,
                    hair_map,
                    texture_binding(3, layers),
                    texture_binding(4, front),
                    texture_binding(5, back),
                ],
            })
        };
        let hair_map = &resources.hair_map;
        Self {
            for_shadow: group("strands: for their shadow", &nothing, [&nothing; 3]),
            for_slices: group("strands: for their slices", hair_map, [&layers, &nothing, &nothing]),
            for_strands: group("strands", hair_map, [&layers, &slices[0], &slices[1]]),
            for_composing: device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("hair over the picture"),
                layout: &compose_layout(device),
                entries: &[texture_binding(0, &layers), texture_binding(1, &clear), texture_binding(2, &sum)],
            }),
            layers,
            slices,
            sum,
            clear,
        }
    }
}
