use glam::Vec3;
use std::f32::consts::PI;

/// Soft boxes of an environment.
pub const PANEL_COUNT: usize = 4;

/// What surrounds the face: a gradient from the ground to the sky, and soft boxes on it. Made, not
/// photographed: it needs no file, and has no edge that it could flicker at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    /// Radiance straight above.
    pub sky: [f32; 3],
    /// Radiance straight below; between both it changes with the height.
    pub ground: [f32; 3],
    /// Bright patches; one with radiance 0 is off.
    pub panels: [Panel; PANEL_COUNT],
}

/// The share of a panel's radius that is as bright as its middle; from there the light fades to 0 at the
/// edge.
pub const PANEL_CORE: f32 = 0.5;

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

    /// The light that comes from `direction_world`, of any length; zero means from above.
    ///
    /// A gradient with the height, and the panels on it: the middle half of a panel is even, the rest fades
    /// with a smooth step of the angle, so that neither the light nor its slope jumps anywhere.
    pub fn radiance(&self, direction_world: Vec3) -> Vec3 {
        self.prepared().radiance(direction_world.normalize_or(Vec3::Y))
    }

    pub(crate) fn prepared(&self) -> Prepared {
        let (sky, ground) = (Vec3::from(self.sky), Vec3::from(self.ground));
        Prepared { mean: 0.5 * (sky + ground), slope: 0.5 * (sky - ground), spots: self.panels.map(Spot::of) }
    }
}

/// An [`Environment`] for many look-ups.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prepared {
    pub(crate) mean: Vec3,
    /// What half the height, from the middle to the top, adds.
    pub(crate) slope: Vec3,
    pub(crate) spots: [Spot; PANEL_COUNT],
}

/// A [`Panel`] with a unit direction and the cosines between which it fades.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    pub(crate) direction: Vec3,
    pub(crate) radius_rad: f32,
    pub(crate) radiance: Vec3,
    cos_edge: f32,
    cos_core: f32,
}

impl Prepared {
    /// As [`Environment::radiance`], for unit vectors.
    pub(crate) fn radiance(&self, direction: Vec3) -> Vec3 {
        let gradient = self.mean + self.slope * direction.y;
        self.spots.iter().fold(gradient, |sum, spot| sum + spot.radiance * spot.share(direction))
    }
}

impl Spot {
    fn of(panel: Panel) -> Self {
        let radius_rad = panel.radius_rad.clamp(0.0, PI);
        Self {
            direction: panel.direction_world.normalize_or(Vec3::Y),
            radius_rad,
            radiance: panel.radiance.into(),
            cos_edge: radius_rad.cos(),
            cos_core: (PANEL_CORE * radius_rad).cos(),
        }
    }

    fn share(&self, direction: Vec3) -> f32 {
        let cos = self.direction.dot(direction);
        // The cosines spare nearly all of the arc cosines.
        if cos <= self.cos_edge {
            0.0
        } else if cos >= self.cos_core {
            1.0
        } else {
            self.share_at(cos.acos())
        }
    }

    /// Share of the radiance at this angle from the middle.
    pub(crate) fn share_at(&self, angle_rad: f32) -> f32 {
        let fade = (1.0 - PANEL_CORE) * self.radius_rad;
        if fade <= 0.0 {
            return 0.0;
        }
        let t = ((self.radius_rad - angle_rad) / fade).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}
