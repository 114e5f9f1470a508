use glam::Vec3;

/// Soft boxes of an environment.
pub const PANEL_COUNT: usize = 4;

/// What surrounds the face: a gradient from the ground to the sky, and soft boxes on it. Made, not photographed: it needs
/// no file, and has no edge that it could flicker at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    /// Radiance straight above.
    pub sky: [f32; 3],
    /// Radiance straight below; between both it changes with the height.
    pub ground: [f32; 3],
    /// Bright patches; one with radiance 0 is off.
    pub panels: [Panel; PANEL_COUNT],
}

/// A round, soft-edged patch of light on the environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    /// Toward its middle, in the world, of any length; zero means from above.
    pub direction_world: Vec3,
    /// Its angular radius in radians, up to half a turn.
    pub radius_rad: f32,
    /// Radiance in its middle, added to the gradient.
    pub radiance: [f32; 3],
}

impl Panel {
    /// No panel.
    pub const OFF: Self = Self { direction_world: Vec3::Y, radius_rad: 0.0, radiance: [0.0; 3] };
}

impl Environment {
    /// A photographer's studio: two large soft boxes in front, a strip behind, grey walls.
    pub const STUDIO: Self = Self {
        sky: [0.27, 0.29, 0.33],
        ground: [0.11, 0.09, 0.085],
        panels: [
            Panel {
                direction_world: Vec3::new(0.62, 0.5, 0.75),
                radius_rad: 0.42,
                radiance: [2.6, 2.5, 2.35],
            },
            Panel {
                direction_world: Vec3::new(-0.95, 0.25, 0.45),
                radius_rad: 0.5,
                radiance: [0.5, 0.56, 0.64],
            },
            Panel {
                direction_world: Vec3::new(-0.5, 0.45, -0.9),
                radius_rad: 0.35,
                radiance: [0.8, 0.9, 1.05],
            },
            Panel::OFF,
        ],
    };

    /// Under a blue sky, over sand.
    pub const DAYLIGHT: Self = Self {
        sky: [0.33, 0.46, 0.72],
        ground: [0.26, 0.22, 0.17],
        panels: [
            Panel { direction_world: Vec3::new(-0.45, 0.8, 0.6), radius_rad: 0.3, radiance: [3.0, 2.8, 2.4] },
            Panel {
                direction_world: Vec3::new(0.0, 0.12, 1.0),
                radius_rad: 0.9,
                radiance: [0.12, 0.14, 0.16],
            },
            Panel::OFF,
            Panel::OFF,
        ],
    };

    /// A dark room with one warm window and a cold one behind.
    pub const DARK_ROOM: Self = Self {
        sky: [0.022, 0.024, 0.03],
        ground: [0.012, 0.011, 0.01],
        panels: [
            Panel {
                direction_world: Vec3::new(0.95, 0.4, 0.35),
                radius_rad: 0.3,
                radiance: [2.4, 2.0, 1.55],
            },
            Panel {
                direction_world: Vec3::new(-0.8, 0.35, -0.7),
                radius_rad: 0.3,
                radiance: [0.7, 0.95, 1.4],
            },
            Panel::OFF,
            Panel::OFF,
        ],
    };

    /// The same from everywhere.
    pub const fn uniform(radiance: [f32; 3]) -> Self {
        Self { sky: radiance, ground: radiance, panels: [Panel::OFF; PANEL_COUNT] }
    }
}
