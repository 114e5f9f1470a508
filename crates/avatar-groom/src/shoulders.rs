//! How much of the shoulders hair can reach.

use avatar_mesh::Bounds;
use glam::Vec3;

/// How far around the head shoulders count, as shares of the head's size: beside, below and before it.
const REACH: Vec3 = Vec3::new(0.4, 0.35, 0.1);

/// The head's box, larger by these shares as far as there is skin.
pub(crate) fn with_shoulders(head: Bounds, skin: Bounds) -> Bounds {
    let reach = REACH * head.size();
    Bounds {
        min: skin.min.max(head.min - reach).min(head.min),
        max: skin.max.min(head.max + reach).max(head.max),
    }
}
