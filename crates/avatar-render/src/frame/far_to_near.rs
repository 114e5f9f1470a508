//! The order in which transparent parts are drawn.

use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use glam::Vec3;

/// Sorts parts of avatars by their distance. Keeps its list from frame to frame, so that a frame allocates
/// nothing.
#[derive(Debug, Default)]
pub(crate) struct FarToNear {
    parts: Vec<FarPart>,
}

#[derive(Clone, Copy, Debug)]
struct FarPart {
    distance_squared: f32,
    avatar: usize,
    part: usize,
    /// Parts at equal distances keep the order in which they were found.
    found: usize,
}

impl FarToNear {
    /// The parts that are blended, from far to near, as the indices of avatar and part.
    pub(crate) fn sort(
        &mut self,
        avatars: &[(&AvatarModel, &AvatarState)],
        eye: Vec3,
    ) -> impl Iterator<Item = (usize, usize)> {
        self.parts.clear();
        for (avatar, (model, state)) in avatars.iter().enumerate() {
            for (part, of_model) in model.parts_with_triangles().filter(|(_, part)| part.is_blended()) {
                let distance_squared = state.pose.center_of(&of_model.geometry).distance_squared(eye);
                self.parts.push(FarPart { distance_squared, avatar, part, found: self.parts.len() });
            }
        }
        self.parts.sort_unstable_by(|a, b| {
            b.distance_squared.total_cmp(&a.distance_squared).then(a.found.cmp(&b.found))
        });
        self.parts.iter().map(|part| (part.avatar, part.part))
    }
}
