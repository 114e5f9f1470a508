use crate::pieces::{Piece, Pieces, weighted};
use crate::random::{bits, unit};
use crate::regions::Regions;
use crate::{DensityMap, Region, Style};
use avatar_mesh::{Bounds, Mesh};
use glam::{Vec2, Vec3};

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

/// The most roots that a head can have: enough for whole heads, and a limit for broken files.
pub const MAX_ROOTS: usize = 1 << 22;

/// Shares of all regions that are planted.
const MOST_SHARES: f64 = (MAX_ROOTS - 3) as f64;

/// Attempts to find a place in a piece that the density accepts; after that its middle is taken, where there
/// is some.
const ATTEMPTS: u64 = 8;

/// Pieces of all triangles together, beyond which they are made coarser: a fraction of a second.
const MAX_PIECES: u64 = 1 << 25;

/// Scatters roots. Their number is area × density: `strands` is the number on a square whose side is the
/// skin's height, where the densities of the map and of the style are both 1. Positions are those of the bind
/// pose. `eyes` are the boxes of the eyeballs; without eyes there are neither brows nor lashes. If there
/// would be more than [`MAX_ROOTS`], all densities are scaled down by one factor: a fair sample is left.
///
/// Triangles are cut into pieces about as large as values of the map. For each region the shares of all
/// pieces are laid end to end, and a strand is planted at a random place within every step of length 1
/// (stratified sampling over prefix sums), so that each stretch of the way gets its share to within one
/// strand; the exact place is found by the density in the piece. Where the density is 0 nothing grows. The
/// same input gives the same roots on every machine, in a shuffled but fixed order: the first N are a fair
/// sample of all.
pub fn scatter(
    mesh: &Mesh,
    density: &DensityMap,
    eyes: &[Bounds],
    style: &Style,
    strands: f32,
    seed: u64,
) -> Vec<Root> {
    let head = mesh.bounds();
    head.map_or_else(Vec::new, |head| scatter_on(mesh, head, density, eyes, style, strands, seed))
}

/// As [`scatter`], on a skin of which only `head` is the head: numbers and widths are measured by its height.
pub(crate) fn scatter_on(
    mesh: &Mesh,
    head: Bounds,
    density: &DensityMap,
    eyes: &[Bounds],
    style: &Style,
    strands: f32,
    seed: u64,
) -> Vec<Root> {
    let regions = Regions::new(eyes, head, style);
    let height = f64::from(head.size().y.max(1e-6));
    let per_area = f64::from(strands.max(0.0)) / (height * height);
    if regions.is_bald() || per_area <= 0.0 {
        return Vec::new();
    }
    let patches: Vec<(Patch, Pieces)> = (0..mesh.triangles.len())
        .filter_map(|triangle| Patch::new(mesh, triangle))
        .filter_map(|patch| density.pieces(patch.uvs).map(|pieces| (patch, pieces)))
        .collect();
    let count = |coarser: u32| patches.iter().map(|(_, pieces)| pieces.coarser(coarser).count()).sum::<u64>();
    let coarser = (0..16).find(|coarser| count(*coarser) <= MAX_PIECES).unwrap_or(16);

    let mut planter =
        Planter { density, regions, rows: [0, 1, 2].map(|region| Row::new(seed, region)), roots: Vec::new() };
    let total = total_shares(&patches, coarser, per_area, &planter);
    if !total.is_finite() {
        return Vec::new();
    }
    // A little less than the most: each region may have one strand more than its shares say.
    let scale = (MOST_SHARES / total.max(1e-9)).min(1.0);
    for (patch, pieces) in &patches {
        let pieces = pieces.coarser(coarser);
        let share = patch.area * per_area * scale / pieces.count() as f64;
        pieces.visit(&mut |piece| planter.plant(patch, piece, share));
    }
    let mut roots = planter.roots;
    roots.sort_unstable_by_key(|(order, root)| (*order, root.triangle));
    roots.into_iter().map(|(_, root)| root).collect()
}

/// Shares of all pieces together, or less where that is known to be no more than there may be.
fn total_shares(patches: &[(Patch, Pieces)], coarser: u32, per_area: f64, planter: &Planter<'_>) -> f64 {
    // No map is denser than 1: most heads are done with this.
    let most = patches.iter().map(|(patch, _)| patch.area).sum::<f64>() * per_area;
    let most = most * f64::from(planter.regions.densest());
    if most <= MOST_SHARES {
        return most;
    }
    let mut total = 0.0;
    for (patch, pieces) in patches {
        let pieces = pieces.coarser(coarser);
        let share = patch.area * per_area / pieces.count() as f64;
        pieces.visit(&mut |piece| {
            let wanted = share * f64::from(planter.density_at(patch, piece.middle()).1);
            total += if wanted > 0.0 { wanted } else { 0.0 };
        });
    }
    total
}

/// A triangle that hair may grow on.
struct Patch {
    triangle: u32,
    corners: [u32; 3],
    positions: [Vec3; 3],
    uvs: [Vec2; 3],
    area: f64,
}

impl Patch {
    /// `None` for what has no area, and for broken meshes.
    fn new(mesh: &Mesh, triangle: usize) -> Option<Self> {
        let corners = *mesh.triangles.get(triangle)?;
        let mut positions = [Vec3::ZERO; 3];
        let mut uvs = [Vec2::ZERO; 3];
        for (i, corner) in corners.into_iter().enumerate() {
            positions[i] = *mesh.positions.get(corner as usize)?;
            uvs[i] = *mesh.uvs.get(corner as usize)?;
        }
        let [a, b, c] = positions.map(Vec3::as_dvec3);
        let area = 0.5 * (b - a).cross(c - a).length();
        (area > 0.0 && area.is_finite()).then_some(Self {
            triangle: triangle as u32,
            corners,
            positions,
            uvs,
            area,
        })
    }
}

/// The shares of one region, laid end to end.
struct Row {
    seed: u64,
    sum: f64,
    /// Number of the next strand, and where it is planted.
    strand: u64,
    next: f64,
}

impl Row {
    fn new(seed: u64, region: u64) -> Self {
        let seed = bits(seed, region);
        Self { seed, sum: 0.0, strand: 0, next: f64::from(unit(seed, 0)) }
    }

    /// Moves on by a share; the numbers of the strands that are planted there.
    fn advance(&mut self, share: f64) -> std::ops::Range<u64> {
        let first = self.strand;
        self.sum += share;
        while self.next < self.sum && self.strand - first < MAX_ROOTS as u64 {
            self.strand += 1;
            self.next = self.strand as f64 + f64::from(unit(self.seed, self.strand * KEYS));
        }
        first..self.strand
    }
}

/// Random numbers that belong to one strand: where its step is planted, its order, its own ones, its
/// attempts.
const KEYS: u64 = 64;
const ORDER: u64 = 1;
const OWN: u64 = 2;
const ATTEMPT: u64 = 8;

struct Planter<'a> {
    density: &'a DensityMap,
    regions: Regions,
    rows: [Row; 3],
    roots: Vec<(u64, Root)>,
}

impl Planter<'_> {
    /// `share`: strands of this piece where the density is 1.
    fn plant(&mut self, patch: &Patch, piece: Piece, share: f64) {
        let middle = piece.middle();
        let (region, most) = self.density_at(patch, middle);
        let wanted = share * f64::from(most);
        // NaN comes from a broken mesh.
        if !(wanted > 0.0 && wanted.is_finite()) {
            return;
        }
        let row = &mut self.rows[region as usize];
        let seed = row.seed;
        let strands = row.advance(wanted);
        if strands.is_empty() {
            return;
        }
        let densities = piece.corners.map(|corner| self.density_at(patch, corner).1);
        let most = densities.into_iter().fold(most, f32::max);
        for strand in strands {
            if self.roots.len() >= MAX_ROOTS {
                return;
            }
            let number = |key: u64| unit(seed, strand * KEYS + key);
            let place = (0..ATTEMPTS).map(|attempt| ATTEMPT + 3 * attempt).find_map(|key| {
                let place = piece.place(number(key), number(key + 1));
                let (there, density) = self.density_at(patch, place);
                (there == region && number(key + 2) * most < density).then_some(place)
            });
            let root = Root {
                triangle: patch.triangle,
                corners: patch.corners,
                barycentric: place.unwrap_or(middle).to_array(),
                random: std::array::from_fn(|i| number(OWN + i as u64)),
                region,
            };
            self.roots.push((bits(seed, strand * KEYS + ORDER), root));
        }
    }

    /// What grows at a place of a triangle, and how dense.
    fn density_at(&self, patch: &Patch, barycentric: Vec3) -> (Region, f32) {
        let [a, b, c] = patch.positions;
        let point = a * barycentric.x + b * barycentric.y + c * barycentric.z;
        let (region, density) = self.regions.density(point);
        (region, density * self.density.at(weighted(patch.uvs, barycentric)))
    }
}
