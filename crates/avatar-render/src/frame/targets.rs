//! What a frame draws into beside the caller's view.

use crate::frame::part_pipelines::{NORMAL_FORMAT, OCCLUSION_FORMAT, SKIN_LIGHT_FORMAT};
use crate::frame::renderer::Renderer;
use crate::gpu::attachment::{Purpose, attachment};
use crate::gpu::identity::Identity;
use crate::gpu::pipeline::DEPTH_FORMAT;
use crate::hair::targets::HairTargets;
use crate::view::inputs::{PictureInputs, view_group};

/// Depth, multisampled colour where there are several samples, and what earlier passes of a frame leave for
/// later ones, for pictures of one size by one renderer.
#[derive(Debug)]
pub struct Targets {
    pub(crate) renderer: Identity,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) depth: wgpu::TextureView,
    pub(crate) multisampled: Option<wgpu::TextureView>,
    /// One sample a pixel; a single pixel where no pass needs them.
    pub(crate) single_depth: wgpu::TextureView,
    pub(crate) normals: wgpu::TextureView,
    pub(crate) occlusion: wgpu::TextureView,
    pub(crate) skin_light: wgpu::TextureView,
    pub(crate) scattered: wgpu::TextureView,
    pub(crate) hair: HairTargets,
    /// The inputs of each pass, without what it writes itself.
    pub(crate) for_prepass: wgpu::BindGroup,
    pub(crate) for_occlusion: wgpu::BindGroup,
    pub(crate) for_skin_light: wgpu::BindGroup,
    pub(crate) for_scattering: wgpu::BindGroup,
    pub(crate) for_picture: wgpu::BindGroup,
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
        let terms = config.shading.terms();
        let (size, one_pixel) = ((width, height), (1, 1));
        let several = config.samples > 1;
        // Drawn with as many samples as the picture has.
        let drawn = |label, format| attachment(device, label, format, config.samples, size, Purpose::Drawn);
        let read = |label, format, size| attachment(device, label, format, 1, size, Purpose::DrawnAndRead);
        let of_prepass = if terms.prepass() { size } else { one_pixel };
        let of_occlusion = if terms.occlusion { size } else { one_pixel };
        let of_scattering = if terms.separable() { size } else { one_pixel };
        let single_depth = read("depth, one sample", DEPTH_FORMAT, of_prepass);
        let normals = read("normals", NORMAL_FORMAT, of_prepass);
        let occlusion = read("ambient occlusion", OCCLUSION_FORMAT, of_occlusion);
        let skin_light = read("light on skin", SKIN_LIGHT_FORMAT, of_scattering);
        let scattered = read("light on skin, scattered", SKIN_LIGHT_FORMAT, of_scattering);
        // Bound instead of textures that the pass itself writes, or that are not written yet.
        let no_depth = read("nothing", DEPTH_FORMAT, one_pixel);
        let no_normals = read("nothing", NORMAL_FORMAT, one_pixel);
        let no_occlusion = read("nothing", OCCLUSION_FORMAT, one_pixel);
        let no_light = read("nothing", SKIN_LIGHT_FORMAT, one_pixel);
        let group =
            |label, inputs| view_group(device, &renderer.layouts.view, &renderer.resources, label, inputs);
        let nothing = PictureInputs {
            depth: &no_depth,
            normals: &no_normals,
            occlusion: &no_occlusion,
            skin_light: &no_light,
        };
        let seen = PictureInputs { depth: &single_depth, normals: &normals, ..nothing };
        let shaded = PictureInputs { occlusion: &occlusion, ..seen };
        let lit = PictureInputs { skin_light: &skin_light, ..shaded };
        let spread = PictureInputs { skin_light: &scattered, ..shaded };
        Ok(Self {
            renderer: renderer.id(),
            width,
            height,
            depth: drawn("depth", DEPTH_FORMAT),
            multisampled: several.then(|| drawn("multisampled color", config.color_format)),
            for_prepass: group("view: for depth and normals", nothing),
            for_occlusion: group("view: for occlusion", seen),
            for_skin_light: group("view: for light on skin", shaded),
            for_scattering: group("view: for scattering", lit),
            for_picture: group("view: for the picture", spread),
            hair: HairTargets::new(device, &renderer.resources, config, size),
            single_depth,
            normals,
            occlusion,
            skin_light,
            scattered,
        })
    }

    /// Pixels across and down.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }
}
