use avatar_mesh::Bounds;
use glam::Vec3;

/// Where on a head hair grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Region {
    /// Whatever is neither brow nor lash.
    Scalp = 0,
    /// Above the eyes.
    Brows = 1,
    /// At the edges of the lids.
    Lashes = 2,
}

/// Number of regions.
pub const REGION_COUNT: usize = 3;

impl Region {
    /// All regions, in the order of their numbers.
    pub const ALL: [Self; REGION_COUNT] = [Self::Scalp, Self::Brows, Self::Lashes];

    /// Its place in arrays by region.
    pub fn index(self) -> usize {
        self as usize
    }
}

/// Tells regions apart by where they are at bind pose.
///
/// Hair maps do not name what grows where; the eyes do. Fractions below are of an eyeball's radius, measured on
/// two heads: lashes start within 1.4 of the eye's middle, brows between 1.0 and 2.0 above it, and the nearest hair of the scalp
/// is farther out, farther up or farther back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Regions {
    eyes: Vec<Eye>,
    strip: Option<(f32, f32)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Eye {
    center: Vec3,
    radius: f32,
}

const LASH_REACH: f32 = 1.5;
const LASH_HEIGHT: f32 = 0.75;
const BROW_BOTTOM: f32 = 0.75;
const BROW_TOP: f32 = 2.4;
const BROW_SIDE: f32 = 1.75;
const BROW_BACK: f32 = 0.3;

impl Regions {
    /// From the boxes of the eyeballs at bind pose; without any there is only a scalp.
    pub fn new(eyes: &[Bounds]) -> Self {
        let eye =
            |bounds: &Bounds| Eye { center: bounds.center(), radius: bounds.size().max_element() * 0.5 };
        Self { eyes: eyes.iter().map(eye).filter(|eye| eye.radius > 0.0).collect(), strip: None }
    }

    /// The same, with hair of the scalp only within `half_width` of the plane at `middle_x`.
    #[must_use]
    pub fn with_strip(mut self, middle_x: f32, half_width: f32) -> Self {
        self.strip = Some((middle_x, half_width));
        self
    }

    /// What grows at a point of the skin at bind pose; `None` where a strip leaves the scalp bare.
    pub fn at(&self, point: Vec3) -> Option<Region> {
        for eye in &self.eyes {
            let off = (point - eye.center) / eye.radius;
            if off.length_squared() < LASH_REACH * LASH_REACH && off.y.abs() < LASH_HEIGHT {
                return Some(Region::Lashes);
            }
            if off.x.abs() < BROW_SIDE && (BROW_BOTTOM..BROW_TOP).contains(&off.y) && off.z > -BROW_BACK {
                return Some(Region::Brows);
            }
        }
        let is_bare = self.strip.is_some_and(|(middle, half)| (point.x - middle).abs() > half);
        (!is_bare).then_some(Region::Scalp)
    }

    /// The middle of the eye that is nearest to a point.
    pub fn nearest_eye(&self, point: Vec3) -> Option<Vec3> {
        let centers = self.eyes.iter().map(|eye| eye.center);
        centers.min_by(|a, b| a.distance_squared(point).total_cmp(&b.distance_squared(point)))
    }
}
