use crate::Camera;
use glam::Vec3;

/// What a frame shows beside the avatars.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// Where it is seen from.
    pub camera: Camera,
    /// Linear colour with straight alpha behind everything; alpha 0 leaves the background transparent.
    pub background: [f32; 4],
    /// What lights it.
    pub light: Light,
}

/// Three lamps and ambient light. Colours are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The main lamp.
    pub key: Lamp,
    /// Softens the shadows of the key.
    pub fill: Lamp,
    /// From behind: separates the head from the background.
    pub rim: Lamp,
    /// Ambient light from above.
    pub sky: [f32; 3],
    /// Ambient light from below.
    pub ground: [f32; 3],
    /// Factor on all light before tone mapping.
    pub exposure: f32,
}

/// A distant lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Toward the lamp, in the world, of any length; zero means from above.
    pub direction_world: Vec3,
    /// 1 lights a white matte surface that faces the lamp to 1.
    pub radiance: [f32; 3],
}

impl Default for Light {
    /// Portrait light: the key from above at the character's left, a weak cool fill from the other side, a rim light
    /// from behind.
    fn default() -> Self {
        Self {
            key: Lamp { direction_world: Vec3::new(0.5, 0.42, 0.85), radiance: [1.0, 0.95, 0.88] },
            fill: Lamp { direction_world: Vec3::new(-0.9, 0.1, 0.6), radiance: [0.16, 0.18, 0.21] },
            rim: Lamp { direction_world: Vec3::new(-0.6, 0.5, -0.9), radiance: [0.2, 0.23, 0.27] },
            sky: [0.27, 0.29, 0.33],
            ground: [0.11, 0.09, 0.085],
            exposure: 1.0,
        }
    }
}
