//! The passes of a frame and what is drawn in the last of them, each as one list.

use crate::shaders::{NATURAL, OUTLINE, PLAIN, Program, Programs, TOON};
use crate::{Scattering, Shading, Terms};
use avatar_mesh::PartKind;

/// A pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// Compute: all parts of all avatars into their pose.
    Deform,
    /// Compute: every strand of hair anew on the deformed skin.
    GrowHair,
    /// What the key and rim lamps see: depth.
    Shadows,
    /// How much of the key's light hair keeps off.
    HairShadow,
    /// Depth and normals, one sample a pixel.
    Prepass,
    /// How much ambient light arrives at each pixel.
    Occlusion,
    /// Diffuse light that arrives at the skin.
    SkinLight,
    /// That light, spread sideways below the skin.
    ScatterAcross,
    /// The picture: what is opaque, and what is clear as well where no hair comes in between.
    Picture,
    /// Strands, over what is opaque.
    Hair,
    /// What is clear, over hair.
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

impl Terms {
    /// Whether passes need depth and normals ahead of the picture.
    pub(crate) fn prepass(self) -> bool {
        self.occlusion || self.separable()
    }

    /// Whether light under the skin is blurred in the picture.
    pub(crate) fn separable(self) -> bool {
        self.scattering == Scattering::Separable
    }
}

/// What of the picture is drawn with one pipeline.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawable {
    /// Which parts.
    pub(crate) kind: PartKind,
    /// Name of its group in graphics debuggers.
    pub(crate) label: &'static str,
    pub(crate) program: Program,
    pub(crate) cull_mode: Option<wgpu::Face>,
    /// Blended over what is there, and hiding nothing.
    pub(crate) is_transparent: bool,
}

/// The order in which the picture is drawn, all avatars step by step. The skin comes first because it hides most of the
/// rest; its back sides after everything that hides them, by a program of their own: software renderers shade hidden
/// pixels when there are several samples, and one full program for both sides doubled the cost of a frame there. What
/// is transparent comes last, from far to near.
pub(crate) fn draw_order(shading: Shading) -> Vec<Drawable> {
    let programs: Programs = match shading {
        Shading::Plain => PLAIN,
        Shading::Natural(_) => NATURAL,
        Shading::Toon => TOON,
    };
    let part =
        |kind, label, program, cull_mode| Drawable { kind, label, program, cull_mode, is_transparent: false };
    let (fronts, backs) = (Some(wgpu::Face::Back), Some(wgpu::Face::Front));
    let cornea = part(PartKind::Cornea, "cornea", programs.cornea, fronts);
    let mut order = vec![
        part(PartKind::Skin, "skin", programs.skin, fronts),
        // Rows of teeth are often open sheets: they are drawn from both sides.
        part(PartKind::Surface, "teeth", programs.teeth, None),
        // Eyeballs are closed: their back sides are never seen.
        part(PartKind::Eyeball, "eyeball", programs.eyeball, fronts),
        part(PartKind::Skin, "skin back", programs.skin_back, backs),
    ];
    if shading == Shading::Toon {
        order.push(part(PartKind::Skin, "outline of skin", OUTLINE, backs));
        order.push(part(PartKind::Eyeball, "outline of eyeball", OUTLINE, backs));
    }
    order.push(Drawable { is_transparent: true, ..cornea });
    order
}
