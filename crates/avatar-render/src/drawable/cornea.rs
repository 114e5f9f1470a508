use super::Drawable;
use crate::shaders;
use avatar_mesh::PartKind;

/// Corneas are blended over what is there, and hide nothing from one another.
pub(crate) const CORNEA: Drawable = Drawable {
    kind: PartKind::Cornea,
    label: "cornea",
    program: shaders::CORNEA,
    cull_mode: Some(wgpu::Face::Back),
    blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
    writes_depth: false,
};
