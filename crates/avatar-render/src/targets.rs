use crate::Renderer;

/// The depth buffer's format; nothing beyond WebGPU's core.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Normals of the picture, 0…1.
pub(crate) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// How much ambient light arrives.
pub(crate) const OCCLUSION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;
/// Light under the skin, times the frame's pre-exposure.
pub(crate) const SKIN_LIGHT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Colours of strands, weighted, and their weights.
pub(crate) const HAIR_SUM_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// What strands leave clear.
pub(crate) const HAIR_CLEAR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Depth, multisampled colour where there are several samples, and what earlier passes of a frame leave for later ones,
/// for pictures of one size by one renderer.
#[derive(Debug)]
pub struct Targets {
    pub(crate) renderer: u64,
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
    /// Where strands lie, how much they cover at each depth, their colours, and what they leave clear, where pixels have one
    /// sample.
    pub(crate) hair_layers: wgpu::TextureView,
    pub(crate) hair_slices: [wgpu::TextureView; 2],
    pub(crate) hair_sum: wgpu::TextureView,
    pub(crate) hair_clear: wgpu::TextureView,
    /// What passes read, each without what it writes.
    pub(crate) for_prepass: wgpu::BindGroup,
    pub(crate) for_occlusion: wgpu::BindGroup,
    pub(crate) for_skin_light: wgpu::BindGroup,
    pub(crate) for_scattering: wgpu::BindGroup,
    pub(crate) for_picture: wgpu::BindGroup,
    pub(crate) for_hair_shadow: wgpu::BindGroup,
    pub(crate) for_hair_slices: wgpu::BindGroup,
    pub(crate) for_hair: wgpu::BindGroup,
    pub(crate) for_composing: wgpu::BindGroup,
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
        let attachment = |label, format, sample_count, needed: bool, is_read: bool| {
            let (width, height) = if needed { (width, height) } else { (1, 1) };
            let read =
                if is_read { wgpu::TextureUsages::TEXTURE_BINDING } else { wgpu::TextureUsages::empty() };
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
        };
        let several = config.samples > 1;
        let (prepass, separable) = (terms.prepass(), terms.separable());
        let single_depth = attachment("depth, one sample", DEPTH_FORMAT, 1, prepass, true);
        let normals = attachment("normals", NORMAL_FORMAT, 1, prepass, true);
        let occlusion = attachment("ambient occlusion", OCCLUSION_FORMAT, 1, terms.occlusion, true);
        let skin_light = attachment("light on skin", SKIN_LIGHT_FORMAT, 1, separable, true);
        let scattered = attachment("light on skin, scattered", SKIN_LIGHT_FORMAT, 1, separable, true);
        // Bound in the place of what the pass itself writes.
        let no_occlusion = attachment("nothing", OCCLUSION_FORMAT, 1, false, true);
        let no_light = attachment("nothing", SKIN_LIGHT_FORMAT, 1, false, true);
        let no_depth = attachment("nothing", DEPTH_FORMAT, 1, false, true);
        let hair_layers = attachment("layers of hair", HAIR_SUM_FORMAT, 1, !several, true);
        let hair_slices = ["hair: front slices", "hair: back slices"]
            .map(|label| attachment(label, HAIR_SUM_FORMAT, 1, !several, true));
        let hair_sum = attachment("hair", HAIR_SUM_FORMAT, 1, !several, true);
        let hair_clear = attachment("hair: what it leaves clear", HAIR_CLEAR_FORMAT, 1, !several, true);
        let hair_map = &renderer.resources.hair_map;
        let group = |label, occlusion, light| {
            renderer.view_group(device, label, [&single_depth, &normals, occlusion, light], hair_map)
        };
        let nothing = [&no_depth, &no_light, &no_occlusion, &no_light];
        Ok(Self {
            renderer: renderer.id(),
            width,
            height,
            depth: attachment("depth", DEPTH_FORMAT, config.samples, true, false),
            multisampled: several
                .then(|| attachment("multisampled color", config.color_format, config.samples, true, false)),
            for_prepass: renderer.view_group(device, "view: for depth and normals", nothing, hair_map),
            for_hair_shadow: renderer.view_group(device, "view: for shadows of hair", nothing, &no_light),
            for_hair_slices: renderer.view_group(
                device,
                "view: for slices of hair",
                [&no_depth, &no_light, &no_occlusion, &hair_layers],
                hair_map,
            ),
            for_hair: renderer.view_group(
                device,
                "view: for hair",
                [&no_depth, &hair_slices[0], &hair_slices[1], &hair_layers],
                hair_map,
            ),
            for_composing: renderer.view_group(
                device,
                "view: hair",
                [&no_depth, &hair_layers, &hair_clear, &hair_sum],
                hair_map,
            ),
            for_occlusion: group("view: for occlusion", &no_occlusion, &no_light),
            for_skin_light: group("view: for light on skin", &occlusion, &no_light),
            for_scattering: group("view: for scattering", &occlusion, &skin_light),
            for_picture: group("view: for the picture", &occlusion, &scattered),
            single_depth,
            normals,
            occlusion,
            skin_light,
            scattered,
            hair_layers,
            hair_slices,
            hair_sum,
            hair_clear,
        })
    }

    /// Pixels across and down.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }
}
