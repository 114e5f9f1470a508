use super::Drawable;
use crate::shaders;
use avatar_mesh::PartKind;

/// The outer side of the skin.
pub(crate) const SKIN: Drawable = Drawable {
    kind: PartKind::Skin,
    label: "skin",
    program: shaders::SKIN,
    cull_mode: Some(wgpu::Face::Back),
    blend: None,
    writes_depth: true,
};

/// Its inner side, which shows at the rim of the neck, at lids and lips. Drawn after everything that may hide it, and by a
/// program of its own: software renderers shade hidden pixels when there are several samples, and one full program
/// for both sides doubled the cost of a frame there.
pub(crate) const SKIN_BACK: Drawable =
    Drawable { label: "skin back", program: shaders::SKIN_BACK, cull_mode: Some(wgpu::Face::Front), ..SKIN };
