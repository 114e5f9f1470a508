use super::Drawable;
use crate::shaders;
use avatar_mesh::PartKind;

/// Eyeballs are closed: their back sides are never seen.
pub(crate) const EYEBALL: Drawable = Drawable {
    kind: PartKind::Eyeball,
    label: "eyeball",
    program: shaders::EYEBALL,
    cull_mode: Some(wgpu::Face::Back),
    blend: None,
    writes_depth: true,
};
