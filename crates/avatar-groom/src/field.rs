use crate::creases::fill;
use crate::grid::{Grid, OTHER_BONES, places, smooth};
use crate::pseudonormal::pseudonormals;
use crate::shoulders::with_shoulders;
use avatar_mesh::{Bounds, Mesh};
use glam::Vec3;
use std::collections::BTreeMap;

/// Cells along the longest side of the box.
const CELLS: f32 = 64.0;
/// Room around the skin, in cells.
const ROOM: f32 = 4.0;

/// How far every place around a skin is from it, at bind pose, on a grid: positive outside, negative inside
/// and in narrow creases; and which bones beside the head's move the skin there, so that hair lies on necks
/// and jaws in every pose.
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
    /// The directions in which the distances grow where they are smoothed, in 127ths; as many as distances.
    pub slopes: Vec<[i8; 3]>,
    /// The bones beside the head's that move most of the skin.
    pub bones: [u32; OTHER_BONES],
    /// The share of each of them in the nearest point of the skin, 255 for all of it; as many as distances.
    pub shares: Vec<[u8; OTHER_BONES]>,
}

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
/// Radius of a ball, in cells: creases in which it gets stuck (behind ears, in their bowls) are filled,
/// because hair lies over them, and because in them the direction away from the skin flips from wall to wall.
const BALL: f32 = 2.0;
/// How often the distances are averaged with their neighbours: strands would depend on the last bit of their
/// roots where the direction away from the skin changes from one place to the next.
const SMOOTHING: usize = 2;
/// Rims get thicker by this share of what smoothing would take away from them. Found by trial on the ears of
/// the built-in face.
const RIM: f32 = 0.7;
/// What lies deeper inside than this, in cells, is no rim.
const THICKEST: f32 = 3.0;

fn snorm(share: f32) -> i16 {
    (share.clamp(-1.0, 1.0) * 32767.0).round() as i16
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
        let mut grid = Grid::new(origin, cell, size.map(|n| n as usize));
        let bones = other_bones(skin, head_bone);
        for (corners, normals) in pseudonormals(skin) {
            let positions = corners.map(|i| skin.positions[i as usize]);
            grid.splat(positions, &normals, corners.map(|i| shares(skin, i, bones)));
        }
        grid.sweep_from_skin();
        for _ in 0..2 {
            grid.agree();
        }
        let far = cell * CELLS;
        let mut distances: Vec<f32> = (0..grid.nearest.len()).map(|i| grid.signed(i, far)).collect();
        fill(&grid, &mut distances, BALL * cell);
        let mut smoothed = distances.clone();
        for _ in 0..SMOOTHING {
            smooth(&mut smoothed, grid.size);
        }
        let mut slopes = Vec::with_capacity(smoothed.len());
        let ends = grid.size;
        places(ends).enumerate().for_each(|(index, at)| slopes.push(slope(&smoothed, ends, index, at)));
        let range = RANGE * cell;
        for (distance, smoothed) in distances.iter_mut().zip(smoothed) {
            // What is thin, as the rims of ears, would be smoothed away, and is missed between the places of
            // the grid: there it is thicker instead.
            let lost = smoothed - *distance;
            let is_rim = lost > 0.0 && *distance > -THICKEST * cell;
            let kept = if is_rim { *distance - RIM * lost } else { distance.min(smoothed) };
            *distance = f32::from(snorm(kept / range)) / 32767.0 * range;
        }
        let byte = |share: f32| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
        let shares = grid.nearest.iter().map(|nearest| nearest.shares.map(byte)).collect();
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
fn slope(distances: &[f32], size: [usize; 3], index: usize, at: [usize; 3]) -> [i8; 3] {
    let strides = [1, size[0], size[0] * size[1]];
    let slope = Vec3::from_array([0, 1, 2].map(|axis| {
        let along = at[axis];
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
