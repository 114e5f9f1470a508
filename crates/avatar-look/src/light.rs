use crate::Environment;
use glam::Vec3;

/// Three lamps and the surroundings. Colours are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The main lamp; it casts soft shadows.
    pub key: Lamp,
    /// Softens the shadows of the key; casts none.
    pub fill: Lamp,
    /// From behind: separates the head from the background; casts shadows, so that it does not shine through
    /// the nose.
    pub rim: Lamp,
    /// What shines from everywhere, and what shiny things reflect.
    pub environment: Environment,
    /// Factor on all light before tone mapping.
    pub exposure: f32,
    /// How light becomes colours of a screen.
    pub tone_map: ToneMap,
}

/// A distant lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Toward the lamp, in the world, of any length; zero means from above.
    pub direction_world: Vec3,
    /// 1 lights a white matte surface that faces the lamp to 1.
    pub radiance: [f32; 3],
}

/// How light becomes colours of a screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Khronos PBR Neutral: what is not bright keeps the colour of its texture.
    #[default]
    Neutral,
    /// AgX: filmic, bright colours turn pale.
    AgX,
    /// None: for targets that hold light, and for measuring.
    Linear,
}

/// A name for the command line, and what it stands for.
pub type LightPreset = (&'static str, fn() -> Light);

impl Default for Light {
    fn default() -> Self {
        Self::studio()
    }
}

impl Light {
    /// The presets by name, the default first.
    pub const PRESETS: [LightPreset; 4] = [
        ("studio", Self::studio),
        ("daylight", Self::daylight),
        ("dramatic", Self::dramatic),
        ("flat", Self::flat),
    ];

    /// Portrait light: the key from above at the character's left, a weak cool fill from the other side, a
    /// rim light from behind, soft boxes around.
    pub fn studio() -> Self {
        Self {
            key: Lamp { direction_world: Vec3::new(0.5, 0.42, 0.85), radiance: [1.0, 0.95, 0.88] },
            fill: Lamp { direction_world: Vec3::new(-0.9, 0.1, 0.6), radiance: [0.16, 0.18, 0.21] },
            rim: Lamp { direction_world: Vec3::new(-0.6, 0.5, -0.9), radiance: [0.2, 0.23, 0.27] },
            environment: Environment::STUDIO,
            exposure: 1.0,
            tone_map: ToneMap::Neutral,
        }
    }

    /// A clear day: the sun high at the character's right, a blue sky all around.
    pub fn daylight() -> Self {
        Self {
            key: Lamp { direction_world: Vec3::new(-0.45, 0.8, 0.6), radiance: [1.25, 1.15, 0.98] },
            fill: Lamp { direction_world: Vec3::new(0.8, 0.2, 0.5), radiance: [0.05, 0.06, 0.08] },
            rim: Lamp { direction_world: Vec3::new(0.5, 0.6, -0.8), radiance: [0.12, 0.15, 0.2] },
            environment: Environment::DAYLIGHT,
            exposure: 0.95,
            tone_map: ToneMap::Neutral,
        }
    }

    /// One warm lamp from the side, a cold edge from behind, darkness elsewhere.
    pub fn dramatic() -> Self {
        Self {
            key: Lamp { direction_world: Vec3::new(0.95, 0.4, 0.35), radiance: [1.5, 1.25, 0.98] },
            fill: Lamp { direction_world: Vec3::new(-0.9, 0.0, 0.5), radiance: [0.012, 0.016, 0.025] },
            rim: Lamp { direction_world: Vec3::new(-0.8, 0.35, -0.7), radiance: [0.45, 0.62, 0.9] },
            environment: Environment::DARK_ROOM,
            exposure: 1.0,
            tone_map: ToneMap::Neutral,
        }
    }

    /// Even light from all sides: for looking at textures, and for comparisons.
    pub fn flat() -> Self {
        let off = Lamp { direction_world: Vec3::Z, radiance: [0.0; 3] };
        Self {
            key: Lamp { direction_world: Vec3::new(0.0, 0.3, 1.0), radiance: [0.25; 3] },
            fill: off,
            rim: off,
            environment: Environment::uniform([0.75; 3]),
            exposure: 1.0,
            tone_map: ToneMap::Neutral,
        }
    }
}
