//! What a renderer holds for all its frames: tables, samplers, the environment, shadow maps.

use crate::gpu::bindings::{dynamic_uniform_entry, sampler_entry, texture_entry};
use crate::gpu::color::half_bits;
use crate::gpu::pipeline::DEPTH_FORMAT;
use crate::gpu::ring::Ring;
use crate::gpu::texture::sampler;
use crate::view::environment::EnvironmentMap;
use crate::view::lamps::SHADOW_COUNT;
use crate::view::pores::{PORE_SIZE, pore_tile};
use crate::view::shading::{Scattering, Terms};
use crate::view::uniforms::GpuFrame;
use avatar_look::{scatter_table, split_sum};
use wgpu::util::DeviceExt;

/// Texels of the split-sum table on a side.
const SPLIT_SUM_SIZE: u32 = 32;
/// Texels of the scattering table.
const SCATTER_SIZE: (u32, u32) = (128, 32);
/// Format of the map of hair that the key lamp sees.
pub(crate) const HAIR_MAP_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Tables, samplers, the environment and shadow maps of a renderer.
#[derive(Debug)]
pub(crate) struct Resources {
    pub(crate) frames: Ring<GpuFrame>,
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) bind_group: wgpu::BindGroup,
    /// A map per lamp, for reading.
    pub(crate) shadow_map: wgpu::TextureView,
    /// The same maps one by one, for drawing into.
    pub(crate) shadow_layers: Vec<wgpu::TextureView>,
    pub(crate) shadow_sampler: wgpu::Sampler,
    /// How much of the key lamp's light hair blocks; a single texel if no lamp casts shadows.
    pub(crate) hair_map: wgpu::TextureView,
    pub(crate) environment: EnvironmentMap,
}

impl Resources {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, terms: Terms) -> Self {
        let frames = Ring::new(device, "frame: camera and light", 1);
        let layout = layout(device);
        let tables = tables(device, queue, terms);
        let environment = EnvironmentMap::new(device);
        // Only textures that repeat on tilted surfaces need anisotropic filtering.
        let samplers = [
            sampler(device, "repeat, trilinear", [wgpu::AddressMode::Repeat; 2], true),
            sampler(device, "clamp, trilinear", [wgpu::AddressMode::ClampToEdge; 2], false),
        ];
        let texture = |binding, view| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        };
        let bound = |binding, sampler| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::Sampler(sampler),
        };
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: frames.binding() },
                bound(1, &samplers[0]),
                bound(2, &samplers[1]),
                texture(3, &tables[0]),
                texture(4, &tables[1]),
                texture(5, &environment.cube),
                texture(6, &tables[2]),
            ],
        });
        let (shadow_map, shadow_layers) = shadow_map(device, terms);
        let shadow_sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        Self {
            frames,
            layout,
            bind_group,
            shadow_map,
            shadow_layers,
            shadow_sampler,
            hair_map: hair_map(device, terms),
            environment,
        }
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let fragment = wgpu::ShaderStages::FRAGMENT;
    let filtered = wgpu::TextureSampleType::Float { filterable: true };
    let texture = |binding, dimension| texture_entry(binding, fragment, filtered, dimension);
    let sampler = |binding| sampler_entry(binding, fragment, wgpu::SamplerBindingType::Filtering);
    let flat = wgpu::TextureViewDimension::D2;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame"),
        entries: &[
            dynamic_uniform_entry(wgpu::ShaderStages::VERTEX_FRAGMENT, Ring::<GpuFrame>::BYTES),
            sampler(1),
            sampler(2),
            texture(3, flat),
            texture(4, flat),
            texture(5, wgpu::TextureViewDimension::Cube),
            texture(6, flat),
        ],
    })
}

/// The tables that shaders look up; of those that this shading never reads, a single texel.
fn tables(device: &wgpu::Device, queue: &wgpu::Queue, terms: Terms) -> [wgpu::TextureView; 3] {
    use wgpu::TextureFormat::{R16Float, Rg8Unorm, Rg16Float};
    let split_sums = || {
        let entries = split_sum(SPLIT_SUM_SIZE as usize).into_iter().flatten();
        entries.flat_map(|value| half_bits(value).to_ne_bytes()).collect()
    };
    let scatter = || {
        let entries = scatter_table(SCATTER_SIZE.0 as usize, SCATTER_SIZE.1 as usize).into_iter();
        entries.flat_map(|value| half_bits(value).to_ne_bytes()).collect()
    };
    let is_pre_integrated = terms.scattering == Scattering::PreIntegrated;
    let split_sums: (_, &dyn Fn() -> Vec<u8>) = ((SPLIT_SUM_SIZE, SPLIT_SUM_SIZE), &split_sums);
    let scatter: (_, &dyn Fn() -> Vec<u8>) = (SCATTER_SIZE, &scatter);
    let pores: (_, &dyn Fn() -> Vec<u8>) = ((PORE_SIZE, PORE_SIZE), &|| pore_tile().concat());
    [
        ("table: split sum", terms.reflections, Rg16Float, split_sums),
        ("table: scattering", is_pre_integrated, R16Float, scatter),
        ("pores", terms.pores, Rg8Unorm, pores),
    ]
    .map(|(label, is_read, format, (size, texels))| match is_read {
        true => table(device, queue, label, size, format, &texels()),
        // The largest texel of these formats.
        false => table(device, queue, label, (1, 1), format, &[0; 4]),
    })
}

fn table(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    (width, height): (u32, u32),
    format: wgpu::TextureFormat,
    bytes: &[u8],
) -> wgpu::TextureView {
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        bytes,
    );
    texture.create_view(&wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() })
}

fn hair_map(device: &wgpu::Device, terms: Terms) -> wgpu::TextureView {
    let size = terms.shadows.hair_map_size();
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow of hair"),
        size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: HAIR_MAP_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor { label: Some("shadow of hair"), ..Default::default() })
}

fn shadow_map(device: &wgpu::Device, terms: Terms) -> (wgpu::TextureView, Vec<wgpu::TextureView>) {
    let size = terms.shadows.map_size();
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow maps"),
        // Always two layers: a texture with one is not an array.
        size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: SHADOW_COUNT as u32 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let all = texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some("shadow maps"),
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let layer = |layer| {
        texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some("shadow map"),
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        })
    };
    (all, (0..terms.shadows.lamps()).map(layer).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::device::gpu_for_tests;

    #[test]
    fn tables_are_made_for_the_shading_that_reads_them() {
        let Some(gpu) = gpu_for_tests() else { return };
        let widths = |terms| tables(&gpu.device, &gpu.queue, terms).map(|table| table.texture().width());
        assert_eq!(widths(Terms::LOW), [1, 1, 1]);
        assert_eq!(widths(Terms::MEDIUM), [SPLIT_SUM_SIZE, SCATTER_SIZE.0, PORE_SIZE]);
        // Scattering in the picture needs no table.
        assert_eq!(widths(Terms::HIGH), [SPLIT_SUM_SIZE, 1, PORE_SIZE]);
        assert_eq!(gpu.errors.take(), None);
    }
}
