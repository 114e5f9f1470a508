//! Plain meshes on their way into the raw format.

use glam::{DVec2, DVec3};

/// A rigid part: positions, texture coordinates, normals, triangles.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Places at rest.
    pub positions: Vec<DVec3>,
    /// Texture coordinates, v downward.
    pub uvs: Vec<DVec2>,
    /// Unit normals.
    pub normals: Vec<DVec3>,
    /// Counter-clockwise triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Part {
    /// Adds a vertex; its normal is computed later.
    pub fn add(&mut self, p: DVec3, uv: DVec2) -> u32 {
        self.positions.push(p);
        self.uvs.push(uv);
        (self.positions.len() - 1) as u32
    }

    /// Adds a grid of `rows` × `columns` vertices. Seen from outside, columns go left to right and rows from
    /// top to bottom.
    pub fn add_grid(
        &mut self,
        rows: usize,
        columns: usize,
        mut at: impl FnMut(usize, usize) -> (DVec3, DVec2),
    ) {
        let base = self.positions.len() as u32;
        for r in 0..rows {
            for c in 0..columns {
                let (p, uv) = at(r, c);
                self.add(p, uv);
            }
        }
        let number = |r: usize, c: usize| base + (r * columns + c) as u32;
        for r in 0..rows - 1 {
            for c in 0..columns - 1 {
                let (a, b, d, e) = (number(r, c), number(r, c + 1), number(r + 1, c), number(r + 1, c + 1));
                for t in [[a, d, e], [a, e, b]] {
                    let [p, q, s] = t.map(|i| self.positions[i as usize]);
                    // Poles collapse a side of their quadrangles; such slivers are left out.
                    if (q - p).cross(s - p).length() > 1e-9 {
                        self.triangles.push(t);
                    }
                }
            }
        }
    }

    /// Drops unused vertices and computes all normals; vertices at the same place share one.
    pub fn finish(&mut self) {
        self.drop_unused();
        let welded = weld(&self.positions);
        let triangles: Vec<[usize; 3]> =
            self.triangles.iter().map(|t| t.map(|i| welded[i as usize])).collect();
        let normals = normals(&self.positions, &triangles);
        self.normals = welded.iter().map(|&i| normals[i]).collect();
    }

    /// Poles leave vertices that no triangle uses.
    fn drop_unused(&mut self) {
        let mut number = vec![u32::MAX; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&i| number[i as usize] = 0);
        for (next, n) in (0..).zip(number.iter_mut().filter(|n| **n == 0)) {
            *n = next;
        }
        let mut keep = number.iter().map(|n| *n != u32::MAX);
        self.positions.retain(|_| keep.next().unwrap_or(false));
        let mut keep = number.iter().map(|n| *n != u32::MAX);
        self.uvs.retain(|_| keep.next().unwrap_or(false));
        for t in &mut self.triangles {
            *t = t.map(|i| number[i as usize]);
        }
    }

    /// The mirror image in x, with triangles turned so that they stay counter-clockwise.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let flip = |v: &DVec3| DVec3::new(-v.x, v.y, v.z);
        Self {
            positions: self.positions.iter().map(flip).collect(),
            uvs: self.uvs.iter().map(|uv| DVec2::new(1.0 - uv.x, uv.y)).collect(),
            normals: self.normals.iter().map(flip).collect(),
            triangles: self.triangles.iter().map(|t| [t[0], t[2], t[1]]).collect(),
        }
    }
}

/// For every position the number of the first vertex at the same place (after rounding to the file's
/// precision).
#[must_use]
pub fn weld(positions: &[DVec3]) -> Vec<usize> {
    let key = |p: &DVec3| [p.x, p.y, p.z].map(|c| (c as f32 + 0.0).to_bits());
    let mut first = std::collections::BTreeMap::new();
    positions.iter().enumerate().map(|(i, p)| *first.entry(key(p)).or_insert(i)).collect()
}

/// Vertex normals: the triangles' normals, weighted by their angle at the vertex, so that the way a surface
/// is cut into triangles does not show.
#[must_use]
pub fn normals(positions: &[DVec3], triangles: &[[usize; 3]]) -> Vec<DVec3> {
    let mut sum = vec![DVec3::ZERO; positions.len()];
    for t in triangles {
        let p = t.map(|i| positions[i]);
        let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        for k in 0..3 {
            let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            let angle = crate::math::atan2(a.cross(b).length(), a.dot(b));
            sum[t[k]] += face * angle;
        }
    }
    sum.iter().map(|n| n.normalize_or_zero()).collect()
}
