//! Meshes from formats whose normals and texture coordinates belong to corners of faces, and whose weights and
//! shapes belong to points: corners that agree become one vertex.

use avatar_mesh::{Mesh, Offsets, Shape, Skinning, WEIGHT_SUM_TOLERANCE};
use glam::{DVec3, Vec2, Vec3, Vec4};
use std::collections::{BTreeMap, HashMap, HashSet};

/// How much all instances in a file may come to, counted in vertices and in moved vertices of shapes. A small file
/// can ask for the same mesh at thousands of nodes; this is some 1 GiB.
const MAX_VERTICES: usize = 1 << 24;

/// What is left of [`MAX_VERTICES`].
#[derive(Debug)]
pub(crate) struct Budget(usize);

impl Default for Budget {
    fn default() -> Self {
        Self(MAX_VERTICES)
    }
}

impl Budget {
    /// Takes so many, or tells what was expected and found instead.
    pub(crate) fn take(&mut self, count: usize) -> Result<(), (String, String)> {
        match self.0.checked_sub(count) {
            Some(left) => {
                self.0 = left;
                Ok(())
            }
            None => {
                Err((format!("at most {MAX_VERTICES} vertices in all parts and shapes"), "more".to_owned()))
            }
        }
    }
}

/// One corner of a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Corner {
    /// The point of the file's mesh.
    pub(crate) point: u32,
    /// Texture coordinates, origin top left.
    pub(crate) uv: Vec2,
    /// Without: as the triangles around the point say.
    pub(crate) normal: Option<Vec3>,
    /// Empty (w = 0) where the file has none.
    pub(crate) tangent: Vec4,
}

/// A mesh in the making.
#[derive(Debug, Default)]
pub(crate) struct Corners {
    known: HashMap<[u32; 10], u32>,
    /// The vertices, each a corner that stands for all like it.
    pub(crate) vertices: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
}

impl Corners {
    /// Adds a triangle.
    pub(crate) fn triangle(&mut self, corners: [Corner; 3]) {
        let triangle = corners.map(|corner| self.vertex(corner));
        self.triangles.push(triangle);
    }

    fn vertex(&mut self, corner: Corner) -> u32 {
        let normal = corner.normal.map_or([u32::MAX; 3], |normal| normal.to_array().map(f32::to_bits));
        let uv = corner.uv.to_array().map(f32::to_bits);
        let tangent = corner.tangent.to_array().map(f32::to_bits);
        let key = [
            corner.point,
            uv[0],
            uv[1],
            normal[0],
            normal[1],
            normal[2],
            tangent[0],
            tangent[1],
            tangent[2],
            tangent[3],
        ];
        let vertices = &mut self.vertices;
        *self.known.entry(key).or_insert_with(|| {
            vertices.push(corner);
            (vertices.len() - 1) as u32
        })
    }

    /// Whether some normals are to be computed.
    pub(crate) fn lacks_normals(&self) -> bool {
        self.vertices.iter().any(|vertex| vertex.normal.is_none())
    }

    /// Whether there is nothing to draw.
    pub(crate) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The mesh and its tangents. Points beyond `points` were checked before.
    pub(crate) fn mesh(&self, points: &[Vec3]) -> (Mesh, Vec<Vec4>) {
        let point = |corner: &Corner| points.get(corner.point as usize).copied().unwrap_or_default();
        let smooth = self.smooth_normals(points);
        let normal = |corner: &Corner| match corner.normal {
            Some(normal) => normal,
            None => smooth.get(&corner.point).copied().unwrap_or(Vec3::Z),
        };
        let mesh = Mesh {
            positions: self.vertices.iter().map(point).collect(),
            uvs: self.vertices.iter().map(|corner| corner.uv).collect(),
            normals: self.vertices.iter().map(normal).collect(),
            triangles: self.triangles.clone(),
            ..Mesh::default()
        };
        let complete = self.vertices.iter().all(|corner| corner.tangent.w != 0.0);
        let tangents =
            if complete { self.vertices.iter().map(|corner| corner.tangent).collect() } else { Vec::new() };
        (mesh, tangents)
    }

    /// For points with corners that have no normal: the mean of their triangles' normals, weighted by area.
    fn smooth_normals(&self, points: &[Vec3]) -> HashMap<u32, Vec3> {
        if !self.lacks_normals() {
            return HashMap::new();
        }
        let mut sums: HashMap<u32, DVec3> = HashMap::new();
        for triangle in &self.triangles {
            let at =
                triangle.map(|vertex| self.vertices.get(vertex as usize).map_or(0, |corner| corner.point));
            let [a, b, c] = at.map(|at| points.get(at as usize).copied().unwrap_or_default().as_dvec3());
            let twice_area = (b - a).cross(c - a);
            at.iter().for_each(|at| *sums.entry(*at).or_default() += twice_area);
        }
        sums.into_iter().map(|(point, sum)| (point, sum.normalize_or(DVec3::Z).as_vec3())).collect()
    }

    /// A shape that moves vertices as it moves their points. `normals` are those of vertices.
    pub(crate) fn shape(
        &self,
        name: String,
        offsets: &HashMap<u32, Vec3>,
        normals: Option<Vec<Vec3>>,
        budget: &mut Budget,
    ) -> Result<Shape, (String, String)> {
        let moved = self.vertices.iter().enumerate();
        let pairs: Vec<(u32, Vec3)> = moved
            .filter_map(|(vertex, corner)| Some((vertex as u32, *offsets.get(&corner.point)?)))
            .collect();
        budget.take(pairs.len() + normals.as_ref().map_or(0, Vec::len))?;
        // The vertices of pairs are in range and rise, so that this is an error for no input.
        let wrong = |error: avatar_mesh::OffsetsError| ("offsets of vertices".to_owned(), error.to_string());
        let positions = Offsets::from_pairs(self.vertices.len(), pairs).map_err(wrong)?;
        Ok(Shape { name, positions, normals: normals.map(Offsets::from_dense), tangents: None })
    }
}

/// The bones of points, four at most.
#[derive(Debug, Default)]
pub(crate) struct Influences {
    of_point: Vec<([u16; 4], [f32; 4])>,
    /// Points that had more than four bones.
    pub(crate) reduced: usize,
    /// Points without any weight; they got the bone that stands for the mesh itself.
    pub(crate) unweighted: usize,
}

impl Influences {
    /// Adds a point: the four largest of its weights divided by their sum. Weights that are not above 0 do not
    /// count. A point without any follows `own`.
    pub(crate) fn push(&mut self, bones: &mut Vec<(u16, f64)>, own: u16) {
        bones.retain(|(_, weight)| *weight > 0.0 && weight.is_finite());
        // Stable, so that among equals the file's order counts.
        bones.sort_by(|a, b| b.1.total_cmp(&a.1));
        self.reduced += usize::from(bones.len() > 4);
        bones.truncate(4);
        let sum: f64 = bones.iter().map(|(_, weight)| weight).sum();
        let scale = if (sum - 1.0).abs() > WEIGHT_SUM_TOLERANCE { 1.0 / sum } else { 1.0 };
        let (mut indices, mut weights) = ([0; 4], [0.0; 4]);
        if sum > 0.0 && sum.is_finite() && scale.is_finite() {
            for (slot, (bone, weight)) in bones.iter().enumerate() {
                (indices[slot], weights[slot]) = (*bone, (weight * scale) as f32);
            }
        } else {
            self.unweighted += 1;
            (indices[0], weights[0]) = (own, 1.0);
        }
        self.of_point.push((indices, weights));
    }

    /// The bones of vertices.
    pub(crate) fn skinning(&self, corners: &Corners) -> Skinning {
        let of = |corner: &Corner| {
            let none = ([0; 4], [1.0, 0.0, 0.0, 0.0]);
            self.of_point.get(corner.point as usize).copied().unwrap_or(none)
        };
        let (bones, weights) = corners.vertices.iter().map(of).unzip();
        Skinning { bones, weights, ..Skinning::default() }
    }
}

/// The same names, told apart: the second "smile" becomes "smile.2".
pub(crate) fn unique_names(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    let mut unique = Vec::new();
    for name in names {
        let count = uses.entry(name.clone()).or_insert(0);
        let mut candidate = name.clone();
        while !taken.insert(candidate.clone()) {
            *count = (*count).max(1) + 1;
            candidate = format!("{name}.{count}");
        }
        unique.push(candidate);
    }
    unique
}
