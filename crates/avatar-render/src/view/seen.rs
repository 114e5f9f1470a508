//! Which avatars the camera sees. The area of shadow maps and the sizes of effects in the picture depend on
//! it.

use crate::view::camera::Camera;
use avatar_mesh::Bounds;
use glam::Vec4;

/// Factor on boxes around the skin, because hair reaches beyond them.
const ROOM: f32 = 1.3;
/// Avatars whose apparent size is below this share of the largest one are ignored when shadow maps are
/// fitted.
const SMALL: f32 = 0.125;

/// The avatars that the camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    /// A box around the avatars in the picture, without those that look small beside another one.
    pub(crate) bounds: Option<Bounds>,
    /// Height of the skin of the avatar that looks largest; if none is seen, of the first one.
    pub(crate) height: f32,
}

impl Seen {
    /// `avatars` are the boxes around avatars and the heights of their skins. Sizes are those of whole
    /// avatars, not of what is visible of them: shadows must not change while a camera comes nearer.
    pub(crate) fn new(camera: &Camera, avatars: impl Iterator<Item = (Option<Bounds>, f32)> + Clone) -> Self {
        let frustum = Frustum::new(camera);
        let in_view = avatars.clone().filter_map(|(bounds, height)| {
            let bounds = bounds.filter(|bounds| frustum.meets(*bounds))?;
            Some((bounds, apparent_size(camera, bounds), height))
        });
        // Of several that look equally large, the first.
        let largest = in_view.clone().reduce(|a, b| if b.1 > a.1 { b } else { a });
        let size = largest.map_or(0.0, |(_, size, _)| size);
        Self {
            bounds: in_view
                .filter(|(_, of_one, _)| *of_one >= SMALL * size)
                .map(|(bounds, ..)| bounds)
                .reduce(Bounds::union),
            height: largest
                .map(|(.., height)| height)
                .or_else(|| avatars.clone().next().map(|(_, height)| height))
                .unwrap_or(1.0),
        }
    }
}

/// The size of a box divided by the distance of its nearest point.
fn apparent_size(camera: &Camera, bounds: Bounds) -> f32 {
    let eye = camera.eye();
    let distance = eye.clamp(bounds.min, bounds.max).distance(eye);
    bounds.size().length() / distance.max(camera.valid_near())
}

/// What the picture can show: the half spaces of its edges and the one before the camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frustum {
    planes: [Vec4; 5],
}

impl Frustum {
    pub(crate) fn new(camera: &Camera) -> Self {
        let clip_from_world = camera.clip_from_world();
        let [x, y, w] = [0, 1, 3].map(|row| clip_from_world.row(row));
        Self { planes: [w + x, w - x, w + y, w - y, w] }
    }

    /// Whether a box may be in the picture: it is not wholly beyond one of the picture's edges or behind the
    /// camera. Boxes near the corners may pass without being seen (U. Assarsson and T. Möller, "Optimized
    /// View Frustum Culling Algorithms for Bounding Boxes", 2000).
    pub(crate) fn meets(&self, bounds: Bounds) -> bool {
        let (center, half) = (bounds.center(), bounds.size() * 0.5 * ROOM);
        let is_inside =
            |plane: &Vec4| plane.truncate().dot(center) + plane.truncate().abs().dot(half) + plane.w >= 0.0;
        self.planes.iter().all(is_inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const NEAR: Bounds = Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE };

    fn moved(by: Vec3) -> Bounds {
        Bounds { min: NEAR.min + by, max: NEAR.max + by }
    }

    fn seen(others: &[Bounds]) -> Seen {
        let camera = Camera::orbit(Vec3::ZERO, 8.0, 0.3, 0.2, 0.5, 1.0);
        let all = [NEAR].iter().chain(others).zip([2.0, 5.0, 7.0]);
        Seen::new(&camera, all.map(|(bounds, height)| (Some(*bounds), height)))
    }

    #[test]
    fn only_what_is_in_the_picture_counts() {
        for beyond in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z] {
            assert_eq!(seen(&[moved(beyond * 30.0)]), Seen { bounds: Some(NEAR), height: 2.0 }, "{beyond}");
        }
        let beside = moved(Vec3::X * 2.0);
        assert_eq!(seen(&[beside]).bounds, Some(NEAR.union(beside)));
    }

    #[test]
    fn what_looks_small_beside_the_nearest_does_not_count() {
        assert_eq!(seen(&[moved(Vec3::NEG_Z * 90.0)]), Seen { bounds: Some(NEAR), height: 2.0 });
        // Not so small that its shadows would be missed.
        assert_ne!(seen(&[moved(Vec3::NEG_Z * 20.0)]).bounds, Some(NEAR));
    }

    #[test]
    fn the_height_is_that_of_the_avatar_that_looks_largest() {
        let nearer = moved(Vec3::new(0.5, 0.5, 3.5));
        assert_eq!(seen(&[nearer]).height, 5.0);
        assert_eq!(seen(&[moved(Vec3::NEG_Z * 20.0), nearer]).height, 7.0);
    }

    #[test]
    fn nothing_in_view_and_no_avatars_at_all_have_a_height_as_well() {
        let camera = Camera::orbit(Vec3::X * 90.0, 8.0, 0.0, 0.0, 0.5, 1.0);
        assert_eq!(Seen::new(&camera, [(Some(NEAR), 3.0)].into_iter()), Seen { bounds: None, height: 3.0 });
        assert_eq!(Seen::new(&camera, std::iter::empty()), Seen { bounds: None, height: 1.0 });
    }
}
