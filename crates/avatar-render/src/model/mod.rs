//! What all avatars of a model share, for each part: geometry, blend shapes, textures, materials.

pub(crate) mod bone;
pub(crate) mod curvature;
pub(crate) mod desc;
pub(crate) mod effects;
pub(crate) mod error;
pub(crate) mod extras;
pub(crate) mod eye;
pub(crate) mod finish;
pub(crate) mod geometry;
pub(crate) mod material;
pub(crate) mod part;
pub(crate) mod places;
pub(crate) mod shape_blocks;
pub(crate) mod weights;
