use crate::view::camera::Camera;
use avatar_look::Light;

/// Everything that a frame shows besides the avatars.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// Where it is seen from.
    pub camera: Camera,
    /// Linear colour with straight alpha behind everything; alpha 0 leaves the background transparent.
    pub background: [f32; 4],
    /// What lights it.
    pub light: Light,
}
