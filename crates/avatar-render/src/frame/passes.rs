//! The passes of a frame, as one list.

use crate::view::shading::Terms;

/// A pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// Compute: deforms all parts of avatars that moved.
    Deform,
    /// Compute: grows the strands of avatars in view that moved or whose hair swings, on the deformed skin.
    GrowHair,
    /// What the key and rim lamps see: depth.
    Shadows,
    /// How much of the key's light hair blocks.
    HairShadow,
    /// Depth and normals, one sample a pixel.
    Prepass,
    /// How much ambient light arrives at each pixel.
    Occlusion,
    /// Diffuse light that arrives at the skin.
    SkinLight,
    /// That light, spread sideways below the skin.
    ScatterAcross,
    /// The picture: opaque parts, and transparent ones unless hair lies between them.
    Picture,
    /// Strands, over opaque parts.
    Hair,
    /// Transparent parts, over hair.
    Clear,
}

/// The order of a frame's passes. Each reads only what those before it wrote.
pub(crate) const FRAME_PASSES: [Pass; 11] = [
    Pass::Deform,
    Pass::GrowHair,
    Pass::Shadows,
    Pass::HairShadow,
    Pass::Prepass,
    Pass::Occlusion,
    Pass::SkinLight,
    Pass::ScatterAcross,
    Pass::Picture,
    Pass::Hair,
    Pass::Clear,
];

impl Pass {
    /// Its name in graphics debuggers and timings.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Deform => "deform",
            Self::GrowHair => "grow hair",
            Self::Shadows => "shadows",
            Self::HairShadow => "shadow of hair",
            Self::Prepass => "depth and normals",
            Self::Occlusion => "ambient occlusion",
            Self::SkinLight => "light on skin",
            Self::ScatterAcross => "scatter across",
            Self::Picture => "avatars",
            Self::Hair => "hair",
            Self::Clear => "corneas",
        }
    }

    /// Whether a shading needs it.
    pub(crate) fn runs(self, terms: Terms, with_hair: bool) -> bool {
        match self {
            Self::GrowHair | Self::Hair | Self::Clear => with_hair,
            Self::Deform | Self::Picture => true,
            Self::Shadows => terms.shadows.lamps() > 0,
            Self::HairShadow => terms.shadows.lamps() > 0 && with_hair,
            Self::Prepass => terms.prepass(),
            Self::Occlusion => terms.occlusion,
            Self::SkinLight | Self::ScatterAcross => terms.separable(),
        }
    }
}

/// The position of a pass among those that draw into the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PictureStep {
    /// There is no other.
    Only,
    /// It clears the picture.
    First,
    /// It draws over what is there.
    Between,
    /// It leaves the picture in the caller's view.
    Last,
}

/// Depth is reversed: 0 is far.
pub(crate) fn depth_attachment(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}
