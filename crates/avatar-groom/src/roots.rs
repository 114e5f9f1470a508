use crate::random::{bits, unit};
use crate::{DensityMap, Style};
use avatar_mesh::{Bounds, Mesh};
use glam::{Vec2, Vec3};

/// Where on a head a strand grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Region {
    /// The head's own hair.
    Scalp = 0,
    /// Above the eyes.
    Brows = 1,
    /// At the edges of the lids.
    Lashes = 2,
}

/// Where a strand grows, for good.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Number of the triangle.
    pub triangle: u32,
    /// Its vertices.
    pub corners: [u32; 3],
    /// Weights of the corners; their sum is 1.
    pub barycentric: [f32; 3],
    /// Numbers from 0 to below 1 that tell this strand from others.
    pub random: [f32; 4],
    /// Which style it has.
    pub region: Region,
}

/// Attempts to find a place that the density accepts; after that the last one is taken.
const ATTEMPTS: u64 = 16;
/// Lashes grow within this distance of an eye's middle, brows within the other one, by the eye's radius.
const LASHES_REACH: f32 = 1.25;
const BROWS_REACH: f32 = 3.0;
/// Brows and lashes are painted darker than this.
const SCALP_DENSITY: f32 = 0.5;

/// Scatters roots: on each triangle as many as its area times its mean density asks for, `strands` of them over a square
/// of the skin's height where the density is 1 and the style's own density 1. Positions are those of the bind pose; `eyes`
/// are the boxes of the eyeballs, without which there are neither brows nor lashes.
///
/// Shares of triangles are laid end to end, and strands are taken at even steps along them (systematic sampling over
/// prefix sums): each triangle gets its share to within one strand. The order is a fixed shuffle.
pub fn scatter(
    mesh: &Mesh,
    density: &DensityMap,
    eyes: &[Bounds],
    style: &Style,
    strands: f32,
    seed: u64,
) -> Vec<Root> {
    let height = f64::from(mesh.bounds().map_or(1.0, |bounds| bounds.size().y).max(1e-6));
    let per_area = f64::from(strands.max(0.0)) / (height * height);
    let mut roots = Vec::new();
    let mut counted = 0u64;
    let mut share = f64::from(unit(seed, u64::MAX));
    for (triangle, &corners) in mesh.triangles.iter().enumerate() {
        let Some((positions, uvs)) = points(mesh, corners) else { continue };
        let area = 0.5 * f64::from((positions[1] - positions[0]).cross(positions[2] - positions[0]).length());
        let mean = f64::from(density.mean(uvs));
        let wanted = area * mean * per_area;
        // Also no number, from a broken mesh.
        if wanted <= 0.0 || !wanted.is_finite() {
            continue;
        }
        share += wanted;
        while (counted as f64) + 1.0 <= share {
            let barycentric = place(density, uvs, seed, counted);
            let at = |weights: [f32; 3]| (0..3).map(|i| positions[i] * weights[i]).sum::<Vec3>();
            let uv = (0..3).map(|i| uvs[i] * barycentric[i]).sum::<Vec2>();
            let region = region(at(barycentric), density.at(uv), eyes);
            let key = counted * 8;
            // A style without this region grows nothing there.
            if unit(seed ^ 0xB0B, key) < style.region(region).density {
                let random = std::array::from_fn(|i| unit(seed ^ 0xACE, key + i as u64));
                roots.push((
                    bits(seed ^ 0x5EED, key),
                    Root { triangle: triangle as u32, corners, barycentric, random, region },
                ));
            }
            counted += 1;
        }
    }
    roots.sort_unstable_by_key(|(order, root)| (*order, root.triangle));
    roots.into_iter().map(|(_, root)| root).collect()
}

fn points(mesh: &Mesh, corners: [u32; 3]) -> Option<([Vec3; 3], [Vec2; 3])> {
    let mut positions = [Vec3::ZERO; 3];
    let mut uvs = [Vec2::ZERO; 3];
    for (i, corner) in corners.into_iter().enumerate() {
        positions[i] = *mesh.positions.get(corner as usize)?;
        uvs[i] = *mesh.uvs.get(corner as usize)?;
    }
    Some((positions, uvs))
}

/// A place on a triangle, found with a chance that is proportional to the density there.
fn place(density: &DensityMap, uvs: [Vec2; 3], seed: u64, strand: u64) -> [f32; 3] {
    let mut weights = [1.0 / 3.0; 3];
    let most = uvs.map(|uv| density.at(uv)).into_iter().fold(density.mean(uvs), f32::max).max(1e-3);
    for attempt in 0..ATTEMPTS {
        let key = (strand * ATTEMPTS + attempt) * 4;
        let (a, b) = (unit(seed ^ 0xA11, key), unit(seed ^ 0xA11, key + 1));
        // Evenly over the triangle: the root spreads what would crowd at a corner (G. Turk, Graphics Gems, 1990).
        let root = a.sqrt();
        weights = [1.0 - root, root * (1.0 - b), root * b];
        let uv = (0..3).map(|i| uvs[i] * weights[i]).sum::<Vec2>();
        if unit(seed ^ 0xA11, key + 2) * most < density.at(uv) {
            break;
        }
    }
    weights
}

fn region(position: Vec3, density: f32, eyes: &[Bounds]) -> Region {
    let near = |reach: f32| {
        eyes.iter().any(|eye| {
            let radius = eye.size().max_element() * 0.5;
            position.distance(eye.center()) < reach * radius
        })
    };
    match density < SCALP_DENSITY {
        true if near(LASHES_REACH) => Region::Lashes,
        true if near(BROWS_REACH) => Region::Brows,
        _ => Region::Scalp,
    }
}
