use super::Drawable;
use crate::shaders;
use avatar_mesh::PartKind;

/// Skin shows its back at the rim of the neck, at lids and lips: it is drawn from both sides.
pub(crate) const SKIN: Drawable = Drawable {
    kind: PartKind::Skin,
    label: "skin",
    program: shaders::SKIN,
    cull_mode: None,
    blend: None,
    writes_depth: true,
};
