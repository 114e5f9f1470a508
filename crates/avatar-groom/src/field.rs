use crate::pseudonormal::{Pseudonormals, pseudonormals};
use crate::shoulders::with_shoulders;
use avatar_mesh::{Bounds, Mesh};
use glam::Vec3;
use std::collections::BTreeMap;

/// Cells along the longest side of the box.
const CELLS: f32 = 64.0;
/// Room around the skin, in cells.
const ROOM: f32 = 4.0;
/// How far around a triangle distances are exact, in cells; further away they are those to the neighbour's
/// nearest point.
const BAND: f32 = 2.0;

/// How far every place around a skin is from it, at bind pose, on a grid: positive outside, negative inside;
/// and which bones beside the head's move the skin there, so that hair lies on necks and jaws in every pose.
///
/// The pseudonormal at the nearest point of the skin decides which side a place is on, so that skins with
/// openings (neck, eyes) are allowed: J. Bærentzen, H. Aanæs, "Signed Distance Computation Using the Angle
/// Weighted Pseudonormal", 2005.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// The first corner of the grid.
    pub origin: Vec3,
    /// Distance between neighbours of the grid.
    pub cell: f32,
    /// Values across, up, and to the front; at least 2 each.
    pub size: [u32; 3],
    /// The distances, across first, then up: no more than [`Field::range`], and in steps of its 32,767th
    /// part.
    pub distances: Vec<f32>,
    /// The directions in which the distances grow, in 127ths; as many as distances.
    pub slopes: Vec<[i8; 3]>,
    /// The bones beside the head's that move most of the skin.
    pub bones: [u32; OTHER_BONES],
    /// The share of each of them in the nearest point of the skin, 255 for all of it; as many as distances.
    pub shares: Vec<[u8; OTHER_BONES]>,
}

/// Bones beside the head's that a field knows: a neck and a jaw.
pub const OTHER_BONES: usize = 2;

/// What a field says of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// Distance from the skin.
    pub distance: f32,
    /// The direction in which it grows, unit length.
    pub outward: Vec3,
    /// Shares of the other bones.
    pub shares: [f32; OTHER_BONES],
}

/// The largest distance, in cells.
const RANGE: f32 = 16.0;
/// How often the distances are averaged with their neighbours: in creases (behind ears, at the nape) the
/// direction away from the skin flips, and strands there would depend on the last bit of their roots.
const SMOOTHING: usize = 2;

fn snorm(share: f32) -> i16 {
    (share.clamp(-1.0, 1.0) * 32767.0).round() as i16
}

/// Weights 1 2 1 along each axis; the ends stay.
fn smooth(values: &mut [f32], size: [usize; 3]) {
    let strides = [1, size[0], size[0] * size[1]];
    for axis in 0..3 {
        let old = values.to_vec();
        let stride = strides[axis];
        for (i, value) in values.iter_mut().enumerate() {
            let along = i / stride % size[axis];
            if along > 0 && along + 1 < size[axis] {
                *value = 0.25 * old[i - stride] + 0.5 * old[i] + 0.25 * old[i + stride];
            }
        }
    }
}

/// A place's nearest point on the skin, the square of the distance, and which side the place is on.
#[derive(Clone, Copy)]
struct Nearest {
    point: Vec3,
    squared: f32,
    is_inside: bool,
    shares: [f32; OTHER_BONES],
}

impl Nearest {
    const NONE: Self =
        Self { point: Vec3::ZERO, squared: f32::INFINITY, is_inside: false, shares: [0.0; OTHER_BONES] };
}

impl Field {
    /// The field of a skin at bind pose, whose hair moves with a bone. Triangles with corners that do not
    /// exist or are NaN are ignored.
    pub fn new(skin: &Mesh, head_bone: u32) -> Self {
        Self::around(skin, skin.bounds().unwrap_or(Bounds { min: Vec3::NAN, max: Vec3::NAN }), head_bone)
    }

    /// As [`Field::new`], where only `head` of the skin is the head: cells are as small as for the head
    /// alone, and of the shoulders the field holds as much as hair can reach from above.
    pub fn around(skin: &Mesh, head: Bounds, head_bone: u32) -> Self {
        let finite = |bounds: &Bounds| bounds.min.is_finite() && bounds.max.is_finite();
        let head = Some(head).filter(finite).unwrap_or(Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE });
        let cell = (head.size().max_element() / CELLS).max(1e-9);
        let bounds = skin.bounds().filter(finite).map_or(head, |skin| with_shoulders(head, skin));
        let origin = bounds.min - ROOM * cell;
        let size = ((bounds.size() / cell).ceil() + 2.0 * ROOM + 1.0).to_array().map(|n| (n as u32).max(2));
        let mut grid = Grid { origin, cell, size: size.map(|n| n as usize), nearest: Vec::new() };
        grid.nearest = vec![Nearest::NONE; grid.size.iter().product()];
        let bones = other_bones(skin, head_bone);
        for (corners, normals) in pseudonormals(skin) {
            let positions = corners.map(|i| skin.positions[i as usize]);
            grid.splat(positions, &normals, corners.map(|i| shares(skin, i, bones)));
        }
        grid.sweep();
        for _ in 0..2 {
            grid.agree();
        }
        let far = cell * CELLS;
        let mut distances: Vec<f32> = (0..grid.nearest.len()).map(|i| grid.signed(i, far)).collect();
        for _ in 0..SMOOTHING {
            smooth(&mut distances, grid.size);
        }
        let range = RANGE * cell;
        for distance in &mut distances {
            *distance = f32::from(snorm(*distance / range)) / 32767.0 * range;
        }
        let byte = |share: f32| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
        let shares = grid.nearest.iter().map(|nearest| nearest.shares.map(byte)).collect();
        let slopes = (0..distances.len()).map(|i| slope(&distances, grid.size, i)).collect();
        Self { origin, cell, size, distances, slopes, bones, shares }
    }

    /// The largest distance that the field can hold.
    pub fn range(&self) -> f32 {
        RANGE * self.cell
    }

    /// The places as the GPU reads them: a distance as a share of the range in 16 bits and shares of the
    /// other bones in 8 bits each, then the direction in 8 bits each and 8 bits of nothing.
    pub fn texels(&self) -> Vec<[u32; 2]> {
        let range = self.range();
        let texel = |((distance, [first, second]), [x, y, z]): ((&f32, &[u8; OTHER_BONES]), &[i8; 3])| {
            let distance = u32::from(snorm(distance / range).cast_unsigned());
            let byte = |v: &i8, at: u32| u32::from(v.cast_unsigned()) << at;
            [
                distance | u32::from(*first) << 16 | u32::from(*second) << 24,
                byte(x, 0) | byte(y, 8) | byte(z, 16),
            ]
        };
        self.distances.iter().zip(&self.shares).zip(&self.slopes).map(texel).collect()
    }

    /// The field at a place; the twin of `field_at` in WGSL. A cell is cut into six tetrahedra along its
    /// diagonal, and the result is interpolated between the four corners of one of them. Outside the grid the
    /// distance from the grid is added.
    pub fn at(&self, place: Vec3) -> Near {
        let last = Vec3::from_array(self.size.map(|n| n as f32 - 1.0));
        let wanted = (place - self.origin) * (1.0 / self.cell);
        let inside = wanted.clamp(Vec3::ZERO, last);
        let low = inside.floor().min(last - 1.0);
        let share = inside - low;
        let [across, up, _] = self.size.map(|n| n as usize);
        let strides = [1, across, across * up];
        let first = (low.z as usize * up + low.y as usize) * across + low.x as usize;
        // From the lowest corner along the axis of the largest share, then of the next, then of the least.
        let (most, least) = (share.max_element(), share.min_element());
        let middle = share.x + share.y + share.z - most - least;
        let lead = match share {
            Vec3 { x, y, z } if x >= y && x >= z => 0,
            Vec3 { y, z, .. } if y >= z => 1,
            _ => 2,
        };
        let end = match share {
            Vec3 { x, y, z } if z <= x && z <= y => 2,
            Vec3 { x, y, .. } if y <= x => 1,
            _ => 0,
        };
        let opposite = first + strides.iter().sum::<usize>();
        let corners = [
            (first, 1.0 - most),
            (first + strides[lead], most - middle),
            (opposite - strides[end], middle - least),
            (opposite, least),
        ];
        let between =
            |of: &dyn Fn(usize) -> f32| corners.iter().map(|(i, weight)| of(*i) * weight).sum::<f32>();
        let distance = between(&|i| self.distances.get(i).copied().unwrap_or(0.0));
        let slope = [0, 1, 2]
            .map(|axis| between(&|i| self.slopes.get(i).map_or(0.0, |slope| f32::from(slope[axis]))));
        let shares = [0, 1].map(|bone| {
            between(&|i| self.shares.get(i).map_or(0.0, |shares| f32::from(shares[bone]) / 255.0))
        });
        let beyond = (wanted - inside).length() * self.cell;
        let outward = Vec3::from_array(slope).normalize_or(Vec3::Y);
        Near { distance: distance + beyond, outward, shares }
    }
}

/// The direction in which distances grow at a place of the grid. It is kept and not taken from the distances
/// around a place where it is needed: there it would jump from cell to cell.
fn slope(distances: &[f32], size: [usize; 3], index: usize) -> [i8; 3] {
    let strides = [1, size[0], size[0] * size[1]];
    let slope = Vec3::from_array([0, 1, 2].map(|axis| {
        let along = index / strides[axis] % size[axis];
        let (back, on) = (along.min(1), (size[axis] - 1 - along).min(1));
        (distances[index + on * strides[axis]] - distances[index - back * strides[axis]]) / (back + on) as f32
    }));
    (slope.normalize_or(Vec3::Y) * 127.0).round().to_array().map(|v| v as i8)
}

/// The bones that move most of the skin's area, without the head's.
fn other_bones(skin: &Mesh, head_bone: u32) -> [u32; OTHER_BONES] {
    let mut areas: BTreeMap<u32, f32> = BTreeMap::new();
    for corners in &skin.triangles {
        let [Some(a), Some(b), Some(c)] = corners.map(|i| skin.positions.get(i as usize)) else { continue };
        let area = (*b - *a).cross(*c - *a).length();
        for (bone, weight) in corners.iter().flat_map(|i| skinned(skin, *i)) {
            if bone != head_bone && area.is_finite() {
                *areas.entry(bone).or_default() += area * weight;
            }
        }
    }
    let mut bones: Vec<(u32, f32)> = areas.into_iter().collect();
    bones.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    // Where there are fewer bones, the head's own again: it changes nothing.
    std::array::from_fn(|i| bones.get(i).map_or(head_bone, |(bone, _)| *bone))
}

fn skinned(skin: &Mesh, vertex: u32) -> impl Iterator<Item = (u32, f32)> {
    let of = skin.skinning.iter().flat_map(move |skinning| skinning.influences(vertex as usize));
    of.map(|(bone, weight)| (bone.into(), weight))
}

fn shares(skin: &Mesh, vertex: u32, bones: [u32; OTHER_BONES]) -> [f32; OTHER_BONES] {
    bones.map(|bone| skinned(skin, vertex).filter(|(b, _)| *b == bone).map(|(_, weight)| weight).sum())
}

struct Grid {
    origin: Vec3,
    cell: f32,
    size: [usize; 3],
    nearest: Vec<Nearest>,
}

impl Grid {
    fn place(&self, [x, y, z]: [usize; 3]) -> Vec3 {
        self.origin + Vec3::new(x as f32, y as f32, z as f32) * self.cell
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Notes a triangle at all places around it.
    fn splat(&mut self, positions: [Vec3; 3], normals: &Pseudonormals, shares: [[f32; OTHER_BONES]; 3]) {
        let [a, b, c] = positions;
        let band = BAND * self.cell;
        let low = ((a.min(b).min(c) - band - self.origin) / self.cell).ceil().max(Vec3::ZERO);
        let high = ((a.max(b).max(c) + band - self.origin) / self.cell).floor();
        let (low, high) = (low.to_array(), high.to_array());
        let range = |i: usize| low[i] as usize..=(high[i] as usize).min(self.size[i] - 1);
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let place = self.place([x, y, z]);
                    let weights = nearest_on_triangle(place, positions);
                    let blend = |v: [Vec3; 3]| v[0] * weights[0] + v[1] * weights[1] + v[2] * weights[2];
                    let point = blend(positions);
                    let squared = point.distance_squared(place);
                    let index = self.index([x, y, z]);
                    if squared < self.nearest[index].squared {
                        let is_inside = (place - point).dot(normals.at(weights)) < 0.0;
                        let shares =
                            std::array::from_fn(|bone| (0..3).map(|k| shares[k][bone] * weights[k]).sum());
                        self.nearest[index] = Nearest { point, squared, is_inside, shares };
                    }
                }
            }
        }
    }

    /// Hands nearest points on from neighbour to neighbour until all places know one: P. Danielsson,
    /// "Euclidean Distance Mapping", 1980.
    fn sweep(&mut self) {
        let [nx, ny, nz] = self.size;
        let order = |n: usize, back: bool, i: usize| if back { n - 1 - i } else { i };
        for turn in 0..8u8 {
            let back = [0, 1, 2].map(|axis| turn >> axis & 1 == 1);
            for k in 0..nz {
                for j in 0..ny {
                    for i in 0..nx {
                        let at = [order(nx, back[0], i), order(ny, back[1], j), order(nz, back[2], k)];
                        self.take_from_neighbours(at, back);
                    }
                }
            }
        }
    }

    fn take_from_neighbours(&mut self, at: [usize; 3], back: [bool; 3]) {
        let (index, place) = (self.index(at), self.place(at));
        // Near the skin they are exact.
        if self.nearest[index].squared <= (BAND * self.cell).powi(2) {
            return;
        }
        for axis in 0..3 {
            let mut neighbour = at;
            match back[axis] {
                true if at[axis] + 1 < self.size[axis] => neighbour[axis] += 1,
                false if at[axis] > 0 => neighbour[axis] -= 1,
                _ => continue,
            }
            let other = self.nearest[self.index(neighbour)];
            let squared = other.point.distance_squared(place);
            if other.squared.is_finite() && squared < self.nearest[index].squared {
                self.nearest[index] = Nearest { squared, ..other };
            }
        }
    }

    /// Places further from the skin than from one another are on one side of it: where a normal in a crease
    /// says something else, most of the neighbours are right.
    fn agree(&mut self) {
        let clear = |nearest: &Nearest| nearest.squared > (1.01 * self.cell).powi(2);
        let [nx, ny, nz] = self.size;
        let strides = [1, nx, nx * ny];
        let flips = |index: usize| {
            let at = [index % nx, index / nx % ny, index / nx / ny];
            let mut others = 0i32;
            for axis in 0..3 {
                let below = (at[axis] > 0).then(|| index - strides[axis]);
                let above = (at[axis] + 1 < [nx, ny, nz][axis]).then(|| index + strides[axis]);
                for neighbour in [below, above].into_iter().flatten().map(|i| &self.nearest[i]) {
                    if clear(neighbour) {
                        others += if neighbour.is_inside == self.nearest[index].is_inside { -1 } else { 1 };
                    }
                }
            }
            others > 0
        };
        let wrong: Vec<usize> =
            (0..self.nearest.len()).filter(|i| clear(&self.nearest[*i]) && flips(*i)).collect();
        for index in wrong {
            self.nearest[index].is_inside ^= true;
        }
    }

    fn signed(&self, index: usize, far: f32) -> f32 {
        let nearest = &self.nearest[index];
        match (nearest.squared.is_finite(), nearest.is_inside) {
            (false, _) => far,
            (true, true) => -nearest.squared.sqrt(),
            (true, false) => nearest.squared.sqrt(),
        }
    }
}

/// Weights of the corners at a triangle's nearest point: C. Ericson, "Real-Time Collision Detection", 2005,
/// 5.1.5.
fn nearest_on_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> [f32; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return [1.0 - t, t, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return [1.0 - t, 0.0, t];
    }
    let va = d3 * d6 - d5 * d4;
    let (along_b, along_c) = (d4 - d3, d5 - d6);
    if va <= 0.0 && along_b >= 0.0 && along_c >= 0.0 {
        let t = along_b / (along_b + along_c);
        return [0.0, 1.0 - t, t];
    }
    let sum = va + vb + vc;
    if sum <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    [va / sum, vb / sum, vc / sum]
}
