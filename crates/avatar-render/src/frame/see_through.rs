//! A picture with a transparent background on its way to a window that lets one see through.

use crate::frame::programs::SEE_THROUGH;
use crate::gpu::bindings::texture_entry;
use crate::gpu::pipeline::{Recipe, color_target, pipeline_layout};
use crate::gpu::program::{Constant, Value};
use crate::model::effects::AGX;
use crate::view::config::encodes_in_shader;

/// Brings pictures whose background is transparent to a surface. What is drawn is weighted by its coverage
/// in linear light; compositors of desktops blend encoded values, and take them weighted by the coverage or
/// not, as the surface's alpha mode says.
///
/// Draw on [`Self::texture`], then [`Self::show`] it.
#[derive(Debug)]
pub struct SeeThrough {
    format: wgpu::TextureFormat,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    texture: wgpu::Texture,
    picture: wgpu::BindGroup,
}

impl SeeThrough {
    /// For pictures of this format and size, as a renderer with this target format draws them, and a surface
    /// whose views have the format `target`. `premultiplied` says that the compositor takes colours that are
    /// weighted by their coverage.
    pub fn new(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        size: (u32, u32),
        target: wgpu::TextureFormat,
        premultiplied: bool,
    ) -> Self {
        let entry = texture_entry(
            0,
            wgpu::ShaderStages::FRAGMENT,
            wgpu::TextureSampleType::Float { filterable: false },
            wgpu::TextureViewDimension::D2,
        );
        let label = SEE_THROUGH.label;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &[entry],
        });
        let recipe = Recipe {
            program: &SEE_THROUGH,
            layout: &pipeline_layout(device, label, &[&layout]),
            topology: wgpu::PrimitiveTopology::TriangleList,
            buffers: &[],
            cull_mode: None,
            depth: None,
            bias: wgpu::DepthBiasState::default(),
            samples: 1,
            target: color_target(target, None),
            beside: None,
        };
        let mut choices = see_through_choices(premultiplied, target.is_srgb()).to_vec();
        choices.extend([("ENCODE_SRGB", Value::Flag(encodes_in_shader(format))), (AGX, Value::Flag(false))]);
        let pipeline = recipe.build(device, &choices);
        let (texture, picture) = picture(device, &layout, format, size);
        Self { format, layout, pipeline, texture, picture }
    }

    /// Fits it to another size; what is on the texture is lost.
    pub fn resize(&mut self, device: &wgpu::Device, size: (u32, u32)) {
        (self.texture, self.picture) = picture(device, &self.layout, self.format, size);
    }

    /// What is drawn on, or copied to.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    /// Records that the picture is shown on a view of the surface, of the same size and the target's format.
    pub fn show(&self, encoder: &mut wgpu::CommandEncoder, target: &wgpu::TextureView) {
        let attachment = wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(SEE_THROUGH.label),
            color_attachments: &[Some(attachment)],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.picture, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// The constants that depend on the surface.
pub(crate) fn see_through_choices(premultiplied: bool, target_encodes: bool) -> [Constant; 2] {
    [
        ("IS_PREMULTIPLIED", Value::Flag(premultiplied)),
        // A target in sRGB encodes what it gets, so it gets decoded values.
        ("TARGET_ENCODES", Value::Flag(target_encodes)),
    ]
}

fn picture(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
    (width, height): (u32, u32),
) -> (wgpu::Texture, wgpu::BindGroup) {
    let label = Some(SEE_THROUGH.label);
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor { label, ..Default::default() });
    let entry = wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) };
    let picture = device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout, entries: &[entry] });
    (texture, picture)
}
