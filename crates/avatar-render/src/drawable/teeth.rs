use super::Drawable;
use crate::shaders;
use avatar_mesh::PartKind;

/// Rows of teeth are often open sheets: they are drawn from both sides.
pub(crate) const TEETH: Drawable = Drawable {
    kind: PartKind::Teeth,
    label: "teeth",
    program: shaders::TEETH,
    cull_mode: None,
    blend: None,
    writes_depth: true,
};
