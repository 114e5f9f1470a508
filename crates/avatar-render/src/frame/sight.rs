//! What one frame can show.

use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use crate::view::seen::Frustum;
use crate::view::shadows::ShadowView;
use avatar_mesh::Bounds;

/// What the camera and the lamps of one frame see.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight<'a> {
    pub(crate) frustum: Frustum,
    /// Of the lamps that cast shadows.
    pub(crate) lamps: &'a [ShadowView],
}

impl Sight<'_> {
    /// Whether the picture may show what is in a box.
    pub(crate) fn shows(&self, bounds: Bounds) -> bool {
        self.frustum.meets(bounds)
    }

    /// Whether a shadow of what is in a box may fall into the picture.
    pub(crate) fn casts(&self, bounds: Bounds) -> bool {
        self.lamps.iter().any(|lamp| lamp.meets(bounds))
    }

    /// Whether the picture may show an avatar, with its hair, or its shadow.
    pub(crate) fn concerns(&self, model: &AvatarModel, state: &AvatarState) -> bool {
        state.bounds_with_hair(model).is_some_and(|bounds| self.shows(bounds) || self.casts(bounds))
    }
}
