use crate::{Region, Style};
use avatar_mesh::Bounds;
use glam::Vec3;

/// Tells by the eyes what grows where: maps of hair do not say.
///
/// The numbers below are by the radius of an eyeball, measured on two heads: lashes start within 1.4 of an
/// eye's middle, brows between 0.9 and 2.0 above it, and the nearest hair of the scalp is farther out, up or
/// back than they are.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Regions {
    /// Middle and radius.
    eyes: Vec<(Vec3, f32)>,
    /// Middle and half width of the strip of the scalp that has hair.
    strip: (f32, f32),
    /// By the numbers of the regions.
    densities: [f32; 3],
}

const LASH_REACH: f32 = 1.5;
const LASH_HEIGHT: f32 = 0.75;
const BROW_HEIGHTS: std::ops::Range<f32> = 0.75..2.4;
const BROW_SIDE: f32 = 1.75;
const BROW_BACK: f32 = -0.3;

impl Regions {
    /// From the boxes of the eyeballs and of the skin at bind pose; without eyes there is only a scalp.
    pub(crate) fn new(eyes: &[Bounds], skin: Bounds, style: &Style) -> Self {
        let eye = |eye: &Bounds| (eye.center(), eye.size().max_element() * 0.5);
        let height = skin.size().y.max(1e-6);
        let all = style.scalp.strip >= 1.0;
        Self {
            eyes: eyes.iter().map(eye).filter(|(_, radius)| *radius > 0.0).collect(),
            strip: (skin.center().x, if all { f32::INFINITY } else { style.scalp.strip * height }),
            densities: [style.scalp, style.brows, style.lashes].map(|style| style.density.max(0.0)),
        }
    }

    /// What grows at a point at bind pose.
    pub(crate) fn at(&self, point: Vec3) -> Region {
        for (center, radius) in &self.eyes {
            let off = (point - center) / radius;
            if off.length_squared() < LASH_REACH * LASH_REACH && off.y.abs() < LASH_HEIGHT {
                return Region::Lashes;
            }
            if off.x.abs() < BROW_SIDE && BROW_HEIGHTS.contains(&off.y) && off.z > BROW_BACK {
                return Region::Brows;
            }
        }
        Region::Scalp
    }

    /// How dense that is, by what the map says.
    pub(crate) fn density(&self, point: Vec3) -> (Region, f32) {
        let region = self.at(point);
        let (middle, half) = self.strip;
        let is_bare = region == Region::Scalp && (point.x - middle).abs() >= half;
        (region, if is_bare { 0.0 } else { self.densities[region as usize] })
    }

    /// The density of the densest region, by what the map says.
    pub(crate) fn densest(&self) -> f32 {
        self.densities.iter().copied().fold(0.0, f32::max)
    }

    /// Whether nothing grows anywhere.
    pub(crate) fn is_bald(&self) -> bool {
        self.densities.iter().all(|density| *density <= 0.0)
    }
}
