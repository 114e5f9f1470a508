//! Distances from triangles at the places of a grid.

use crate::pseudonormal::Pseudonormals;
use glam::Vec3;

/// Bones beside the head's that a field knows: a neck and a jaw.
pub const OTHER_BONES: usize = 2;

/// How far around a triangle distances are exact, in cells; further away they are those to the neighbour's
/// nearest point.
const BAND: f32 = 2.0;

/// Weights 1 2 1 along each axis; the ends stay.
pub(crate) fn smooth(values: &mut [f32], size: [usize; 3]) {
    let strides = [1, size[0], size[0] * size[1]];
    let mut old = vec![0.0; values.len()];
    for (stride, count) in strides.into_iter().zip(size) {
        old.copy_from_slice(values);
        let block = stride * count;
        for (new, old) in values.chunks_exact_mut(block).zip(old.chunks_exact(block)) {
            let Some(between) = new.get_mut(stride..block - stride) else { continue };
            let neighbours = old.iter().zip(&old[stride..]).zip(&old[2 * stride..]);
            for (value, ((before, here), after)) in between.iter_mut().zip(neighbours) {
                *value = 0.25 * before + 0.5 * here + 0.25 * after;
            }
        }
    }
}

/// The places of a grid of this size by their numbers: across first, then up.
pub(crate) fn places([nx, ny, nz]: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
}

/// A place's nearest point on the skin, the square of the distance, and which side the place is on.
#[derive(Clone, Copy)]
pub(crate) struct Nearest {
    pub(crate) point: Vec3,
    pub(crate) squared: f32,
    pub(crate) is_inside: bool,
    pub(crate) shares: [f32; OTHER_BONES],
}

impl Nearest {
    pub(crate) const NONE: Self =
        Self { point: Vec3::ZERO, squared: f32::INFINITY, is_inside: false, shares: [0.0; OTHER_BONES] };
}

/// Places at even distances, and what is nearest to each.
pub(crate) struct Grid {
    origin: Vec3,
    pub(crate) cell: f32,
    pub(crate) size: [usize; 3],
    pub(crate) nearest: Vec<Nearest>,
}

impl Grid {
    pub(crate) fn new(origin: Vec3, cell: f32, size: [usize; 3]) -> Self {
        Self { origin, cell, size, nearest: vec![Nearest::NONE; size.iter().product()] }
    }

    /// The same places, and nothing near them.
    pub(crate) fn emptied(&self) -> Self {
        Self::new(self.origin, self.cell, self.size)
    }

    pub(crate) fn place_of(&self, index: usize) -> Vec3 {
        let [nx, ny, _] = self.size;
        self.place([index % nx, index / nx % ny, index / nx / ny])
    }

    fn place(&self, [x, y, z]: [usize; 3]) -> Vec3 {
        self.origin + Vec3::new(x as f32, y as f32, z as f32) * self.cell
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Notes a triangle at all places around it.
    pub(crate) fn splat(
        &mut self,
        positions: [Vec3; 3],
        normals: &Pseudonormals,
        shares: [[f32; OTHER_BONES]; 3],
    ) {
        let [a, b, c] = positions;
        let band = BAND * self.cell;
        let low = ((a.min(b).min(c) - band - self.origin) / self.cell).ceil().max(Vec3::ZERO);
        let high = ((a.max(b).max(c) + band - self.origin) / self.cell).floor();
        let (low, high) = (low.to_array(), high.to_array());
        let range = |i: usize| low[i] as usize..=(high[i] as usize).min(self.size[i] - 1);
        // No point of the triangle is nearer to a place than its plane, but for rounding; that of a needle is
        // not known well enough.
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let is_needle = normal.length_squared() <= 1e-4 * ab.length_squared() * ac.length_squared();
        let plane = if is_needle { Vec3::ZERO } else { normal.normalize_or_zero() * (1.0 - 1e-3) };
        let slack = 1e-4 * (a.abs().max(b.abs()).max(c.abs()).max_element() + band);
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let place = self.place([x, y, z]);
                    let index = self.index([x, y, z]);
                    let above = (plane.dot(place - a).abs() - slack).max(0.0);
                    if above * above > self.nearest[index].squared {
                        continue;
                    }
                    let weights = nearest_on_triangle(place, positions);
                    let blend = |v: [Vec3; 3]| v[0] * weights[0] + v[1] * weights[1] + v[2] * weights[2];
                    let point = blend(positions);
                    let squared = point.distance_squared(place);
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

    /// Hands nearest points of the skin on: near it they are exact.
    pub(crate) fn sweep_from_skin(&mut self) {
        let band = (BAND * self.cell).powi(2);
        let is_open: Vec<bool> = self.nearest.iter().map(|nearest| nearest.squared > band).collect();
        self.sweep(&is_open);
    }

    /// Hands nearest points on from neighbour to neighbour until all open places know one: P. Danielsson,
    /// "Euclidean Distance Mapping", 1980.
    pub(crate) fn sweep(&mut self, is_open: &[bool]) {
        let [nx, ny, nz] = self.size;
        let order = |n: usize, back: bool, i: usize| if back { n - 1 - i } else { i };
        for turn in 0..8u8 {
            let back = [0, 1, 2].map(|axis| turn >> axis & 1 == 1);
            for k in 0..nz {
                for j in 0..ny {
                    let row = [0, order(ny, back[1], j), order(nz, back[2], k)];
                    let first = self.index(row);
                    for i in 0..nx {
                        let x = order(nx, back[0], i);
                        if is_open[first + x] {
                            self.take_from_neighbours([x, row[1], row[2]], back);
                        }
                    }
                }
            }
        }
    }

    fn take_from_neighbours(&mut self, at: [usize; 3], back: [bool; 3]) {
        let (index, place) = (self.index(at), self.place(at));
        let strides = [1, self.size[0], self.size[0] * self.size[1]];
        for axis in 0..3 {
            let neighbour = match back[axis] {
                true if at[axis] + 1 < self.size[axis] => index + strides[axis],
                false if at[axis] > 0 => index - strides[axis],
                _ => continue,
            };
            let other = &self.nearest[neighbour];
            let squared = other.point.distance_squared(place);
            if other.squared.is_finite() && squared < self.nearest[index].squared {
                self.nearest[index] = Nearest { squared, ..*other };
            }
        }
    }

    /// Places further from the skin than from one another are on one side of it: where a normal in a crease
    /// says something else, most of the neighbours are right.
    pub(crate) fn agree(&mut self) {
        let clear = |nearest: &Nearest| nearest.squared > (1.01 * self.cell).powi(2);
        let [nx, ny, nz] = self.size;
        let strides = [1, nx, nx * ny];
        let flips = |index: usize, at: [usize; 3]| {
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
        let mut wrong = Vec::new();
        places(self.size).enumerate().for_each(|(index, at)| {
            if clear(&self.nearest[index]) && flips(index, at) {
                wrong.push(index);
            }
        });
        for index in wrong {
            self.nearest[index].is_inside ^= true;
        }
    }

    pub(crate) fn signed(&self, index: usize, far: f32) -> f32 {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pseudonormal::pseudonormals;
    use crate::random::unit;
    use avatar_mesh::Mesh;

    /// What is nearest to each place, without passing any triangle over.
    fn slowly(grid: &mut Grid, triangles: &[[Vec3; 3]]) {
        let band = BAND * grid.cell;
        for positions in triangles {
            let [a, b, c] = *positions;
            let (low, high) = (a.min(b).min(c) - band, a.max(b).max(c) + band);
            for index in 0..grid.nearest.len() {
                let place = grid.place_of(index);
                let weights = nearest_on_triangle(place, *positions);
                let point = a * weights[0] + b * weights[1] + c * weights[2];
                let squared = point.distance_squared(place);
                // In cells, as `splat` has it.
                let [from, to] = [low, high].map(|edge| (edge - grid.origin) / grid.cell);
                let at = ((place - grid.origin) / grid.cell).round();
                let is_near = at.cmpge(from.ceil()).all() && at.cmple(to.floor()).all();
                if is_near && squared < grid.nearest[index].squared {
                    grid.nearest[index] = Nearest { point, squared, ..Nearest::NONE };
                }
            }
        }
    }

    #[test]
    fn far_triangles_are_passed_over_and_none_that_is_nearest() {
        for round in 0..40u64 {
            let vector = |number: u64| Vec3::from([0, 1, 2].map(|axis| unit(round, 3 * number + axis)));
            let triangle = |i: u64| {
                let number = 3 * i;
                let (a, along) = (2.0 * vector(number), vector(number + 1) - 0.5);
                // Some are needles, some have no area, some lie in one plane with the places.
                let aside = match i % 4 {
                    0 => along * 0.7 + 1e-3 * vector(number + 2),
                    1 => along * 0.5,
                    2 => Vec3::new(0.3, 0.0, vector(number + 2).x),
                    _ => vector(number + 2) - 0.5,
                };
                [a, a + along, a + aside]
            };
            let triangles: Vec<[Vec3; 3]> = (0..30).map(triangle).collect();
            let empty = || Grid::new(Vec3::splat(-0.5), 0.25, [12; 3]);
            let (mut fast, mut slow) = (empty(), empty());
            let mesh = Mesh {
                positions: triangles.as_flattened().to_vec(),
                triangles: (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
                ..Mesh::default()
            };
            for (triangle, (_, normals)) in triangles.iter().zip(&pseudonormals(&mesh)) {
                fast.splat(*triangle, normals, [[0.0; OTHER_BONES]; 3]);
            }
            slowly(&mut slow, &triangles);
            let found = |grid: &Grid| -> Vec<(Vec3, f32)> {
                grid.nearest.iter().map(|nearest| (nearest.point, nearest.squared)).collect()
            };
            assert!(found(&fast) == found(&slow), "{round}");
        }
    }
}
