use crate::density::{Pieces, weighted};
use crate::random::Stream;
use crate::{DensityMap, REGION_COUNT, Region, Regions};
use avatar_mesh::Mesh;
use glam::{Vec2, Vec3};

/// Where a strand grows, for good: it stays at this place of this triangle however the skin deforms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Number of the triangle.
    pub triangle: u32,
    /// Its vertices.
    pub corners: [u32; 3],
    /// Weights of the corners, none negative; their sum is 1.
    pub barycentric: [f32; 3],
    /// Numbers from 0 to below 1 that tell this strand from others.
    pub random: [f32; 4],
    /// Which style it has.
    pub region: Region,
}

/// No region has more roots than this.
pub const MAX_STRANDS: u32 = 1 << 20;
/// Attempts to find a place on a piece of a triangle that its density accepts.
const ATTEMPTS: u64 = 8;

/// What hair grows on a triangle: the pieces of it that have any.
struct Field {
    triangle: u32,
    steps: u32,
    region: Region,
    /// First of its running sums in the list of all.
    sums: usize,
    /// The integral of density over area.
    amount: f64,
}

/// Scatters `counts` roots by region over a mesh at bind pose, proportionally to density × area.
///
/// The shares of triangles are laid end to end and roots taken at even steps (systematic sampling over prefix sums): with
/// `C` the running sum, scaled to the region's count, and `u` random, triangle `i` has `⌊C_{i+1}+u⌋ − ⌊C_i+u⌋` roots,
/// which is its share to within one. On a triangle they are stratified the same way over pieces about as large as values of
/// the map, jittered, and accepted by the density at the very place. A region without density has none; otherwise as many as
/// asked for, up to [`MAX_STRANDS`].
///
/// The same input gives the same roots on every machine. Their order is random but fixed: the first N are a fair sample of all
/// for every N, so that density at run time and level of detail are drawing the first N.
pub fn scatter(
    mesh: &Mesh,
    density: &DensityMap,
    regions: &Regions,
    counts: [u32; REGION_COUNT],
    seed: u64,
) -> Vec<Root> {
    let (fields, sums) = fields(mesh, density, regions, counts);
    let stream = Stream::new(seed);
    let mut keyed: Vec<(u64, Root)> = Vec::new();
    for region in Region::ALL {
        let of_region = || fields.iter().filter(|field| field.region == region);
        let total: f64 = of_region().map(|field| field.amount).sum();
        let wanted = f64::from(counts[region.index()].min(MAX_STRANDS));
        if !(total > 0.0) {
            continue;
        }
        let start = f64::from(stream.of(region as u64).unit(0));
        let (mut sum, mut before) = (0.0, start.floor());
        let mut left = of_region().count();
        for field in of_region() {
            sum += field.amount;
            left -= 1;
            // The last one takes what rounding would lose.
            let upto = if left == 0 { wanted } else { sum / total * wanted };
            let after = (upto + start).floor().max(before);
            plant(field, &sums, mesh, density, regions, (after - before) as u64, stream, &mut keyed);
            before = after;
        }
    }
    keyed.sort_unstable_by_key(|(key, root)| (*key, root.triangle));
    keyed.into_iter().map(|(_, root)| root).collect()
}

/// The integral of density over the area of a mesh at bind pose, by region: what [`scatter`] shares out.
pub fn density_area(mesh: &Mesh, density: &DensityMap, regions: &Regions) -> [f64; REGION_COUNT] {
    let (fields, _) = fields(mesh, density, regions, [1; REGION_COUNT]);
    let mut amounts = [0.0; REGION_COUNT];
    for field in fields {
        amounts[field.region.index()] += field.amount;
    }
    amounts
}

/// All triangles with hair of the regions of which some is wanted, and the running sums of their pieces' densities.
fn fields(
    mesh: &Mesh,
    density: &DensityMap,
    regions: &Regions,
    counts: [u32; REGION_COUNT],
) -> (Vec<Field>, Vec<f32>) {
    let mut fields = Vec::new();
    let mut sums = Vec::new();
    let mut found: Vec<(f32, Option<Region>)> = Vec::new();
    for (triangle, &corners) in mesh.triangles.iter().enumerate() {
        let Some((positions, uvs)) = corners_of(mesh, corners) else { continue };
        let [a, b, c] = positions.map(Vec3::as_dvec3);
        let area = 0.5 * (b - a).cross(c - a).length();
        if !(area > 0.0 && area.is_finite()) {
            continue;
        }
        let steps = density.steps(uvs);
        let pieces = Pieces::new(steps);
        found.clear();
        found.extend(pieces.iter().map(|piece| {
            let middle = piece.middle();
            match density.at(weighted(uvs, middle)) {
                value if value > 0.0 => (value, regions.at(point(positions, middle))),
                _ => (0.0, None),
            }
        }));
        for region in Region::ALL {
            let has_any = found.iter().any(|(_, at)| *at == Some(region));
            if counts[region.index()] == 0 || !has_any {
                continue;
            }
            let first = sums.len();
            let mut sum = 0.0f32;
            sums.extend(found.iter().map(|(value, at)| {
                sum += if *at == Some(region) { *value } else { 0.0 };
                sum
            }));
            let amount = area * f64::from(sum) / pieces.len() as f64;
            fields.push(Field { triangle: triangle as u32, steps, region, sums: first, amount });
        }
    }
    (fields, sums)
}

/// Adds the roots of one triangle, each with the key that orders all.
#[allow(clippy::too_many_arguments, reason = "one step of a loop, with a name")]
fn plant(
    field: &Field,
    sums: &[f32],
    mesh: &Mesh,
    density: &DensityMap,
    regions: &Regions,
    count: u64,
    stream: Stream,
    out: &mut Vec<(u64, Root)>,
) {
    let corners = mesh.triangles[field.triangle as usize];
    let Some((positions, uvs)) = corners_of(mesh, corners) else { return };
    let pieces: Vec<_> = if count > 0 { Pieces::new(field.steps).iter().collect() } else { Vec::new() };
    let Some(sums) = sums.get(field.sums..field.sums + pieces.len()) else { return };
    let Some(&total) = sums.last() else { return };
    let stream = stream.of(3 + u64::from(field.triangle)).of(field.region as u64);
    for strand in 0..count {
        let numbers = stream.of(strand);
        let along = (strand as f32 + numbers.unit(0)) / count as f32 * total;
        // The first piece whose running sum is above: one without density never is.
        let piece = pieces[sums.partition_point(|sum| *sum <= along).min(first_full(sums, total))];
        let at = |weights: Vec3| match regions.at(point(positions, weights)) {
            Some(region) if region == field.region => density.at(weighted(uvs, weights)),
            _ => 0.0,
        };
        let most = piece.corners().map(at).into_iter().fold(at(piece.middle()), f32::max);
        let (mut best, mut best_density) = (piece.middle(), at(piece.middle()));
        for attempt in 0..ATTEMPTS {
            let (a, b) = (numbers.unit(8 + 3 * attempt), numbers.unit(9 + 3 * attempt));
            // Evenly over a triangle: the half of the square that is beyond it is folded back.
            let (right, up) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
            let weights = piece.place(right, up);
            let here = at(weights);
            if here > best_density {
                (best, best_density) = (weights, here);
            }
            if numbers.unit(10 + 3 * attempt) * most < here {
                best = weights;
                break;
            }
        }
        let root = Root {
            triangle: field.triangle,
            corners,
            barycentric: (best / best.element_sum()).to_array(),
            random: std::array::from_fn(|i| numbers.unit(1 + i as u64)),
            region: field.region,
        };
        out.push((numbers.bits(7), root));
    }
}

/// The last piece that has density: where rounding would step over the end.
fn first_full(sums: &[f32], total: f32) -> usize {
    sums.partition_point(|sum| *sum < total)
}

fn point(positions: [Vec3; 3], weights: Vec3) -> Vec3 {
    positions[0] * weights.x + positions[1] * weights.y + positions[2] * weights.z
}

fn corners_of(mesh: &Mesh, corners: [u32; 3]) -> Option<([Vec3; 3], [Vec2; 3])> {
    let mut found = ([Vec3::ZERO; 3], [Vec2::ZERO; 3]);
    for (i, corner) in corners.into_iter().enumerate() {
        found.0[i] = *mesh.positions.get(corner as usize)?;
        found.1[i] = *mesh.uvs.get(corner as usize)?;
    }
    Some(found)
}
