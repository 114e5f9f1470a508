use crate::{DensityMap, Hull, Region, Root, Style, scatter};
use avatar_mesh::{Bounds, Mesh};
use glam::Vec3;

/// The hair of one head: roots, how it falls, and what it stays outside of.
#[derive(Clone, Debug, PartialEq)]
pub struct Groom {
    /// One per strand, in the order of drawing.
    pub roots: Vec<Root>,
    /// Directions in which strands are combed, in the frame of their triangle at bind pose, one per root.
    pub combs: Vec<Vec3>,
    /// How it looks and falls.
    pub style: Style,
    /// What strands stay outside of.
    pub hull: Hull,
    /// Height of the skin: what lengths of the style are measured by.
    pub height: f32,
}

impl Groom {
    /// Plants hair on a skin; see [`scatter`] for the arguments.
    pub fn new(
        skin: &Mesh,
        density: &DensityMap,
        eyes: &[Bounds],
        style: Style,
        strands: f32,
        seed: u64,
    ) -> Self {
        let bounds = skin.bounds().unwrap_or(Bounds { min: Vec3::ZERO, max: Vec3::ONE });
        let height = bounds.size().y.max(1e-6);
        let middle = (bounds.min.x + bounds.max.x) * 0.5;
        let mut roots = scatter(skin, density, eyes, &style, strands, seed);
        roots.retain(|root| {
            let off = (position(skin, root).x - middle).abs() / height;
            root.region != Region::Scalp || off < style.scalp.strip
        });
        let scalp = roots.iter().filter(|root| root.region == Region::Scalp).map(|root| position(skin, root));
        let (sum, count) = scalp.fold((Vec3::ZERO, 0u32), |(sum, n), p| (sum + p, n + 1));
        // A little below the middle of the scalp is inside of every head.
        let center = match count {
            0 => bounds.center(),
            n => sum / n as f32 - Vec3::Y * 0.1 * height,
        };
        let combs = roots.iter().map(|root| comb(skin, root, &style, middle, height)).collect();
        Self { roots, combs, style, hull: Hull::new(skin, center), height }
    }
}

fn position(skin: &Mesh, root: &Root) -> Vec3 {
    let corner = |i: usize| skin.positions.get(root.corners[i] as usize).copied().unwrap_or(Vec3::ZERO);
    (0..3).map(|i| corner(i) * root.barycentric[i]).sum()
}

/// Where a strand is combed, in the frame of its triangle.
fn comb(skin: &Mesh, root: &Root, style: &Style, middle: f32, height: f32) -> Vec3 {
    let region = style.region(root.region);
    let x = position(skin, root).x
        - middle
        - if root.region == Region::Scalp { region.parting * height } else { 0.0 };
    // Away from the parting on both sides, without a jump at it.
    let side = (x / (0.02 * height)).clamp(-1.0, 1.0);
    let [away, up, forward] = region.comb;
    let bind = Vec3::new(away * side, up, forward).normalize_or_zero();
    let corner = |i: usize| skin.positions.get(root.corners[i] as usize).copied().unwrap_or(Vec3::ZERO);
    let [x, y, z] = crate::grow::axes([corner(0), corner(1), corner(2)]);
    Vec3::new(bind.dot(x), bind.dot(y), bind.dot(z))
}
