//! What several readers need to make meshes: shapes, bones of vertices, normals that a file lacks.

use avatar_mesh::{Offsets, Shape, Skinning, WEIGHT_SUM_TOLERANCE};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// A shape from dense offsets, one for each of `vertices` vertices; what the file leaves out does not move.
/// Shapes are made here and nowhere else in this crate.
pub(crate) fn shape(
    name: String,
    vertices: usize,
    positions: Option<Vec<Vec3>>,
    normals: Option<Vec<Vec3>>,
) -> Shape {
    let still = || Offsets::from_pairs(vertices, []).unwrap_or_default();
    let mut shape = Shape::new(name, positions.map_or_else(still, Offsets::from_dense));
    shape.normals = normals.map(Offsets::from_dense);
    shape
}

/// Bytes that [`shape`] takes for so many vertices.
pub(crate) const SHAPE_BYTES_PER_VERTEX: usize = 2 * size_of::<Vec3>();

/// The same names, told apart: the second "smile" becomes "smile.2".
pub(crate) fn unique_names(names: Vec<String>) -> Vec<String> {
    let mut uses: BTreeMap<String, usize> = names.iter().map(|name| (name.clone(), 0)).collect();
    let mut unique = Vec::with_capacity(names.len());
    for name in names {
        let mut count = uses.get(&name).copied().unwrap_or(0) + 1;
        let mut candidate = name.clone();
        if count > 1 {
            candidate = format!("{name}.{count}");
            while uses.contains_key(&candidate) {
                count += 1;
                candidate = format!("{name}.{count}");
            }
            uses.insert(candidate.clone(), 1);
        }
        uses.insert(name, count);
        unique.push(candidate);
    }
    unique
}

/// Bones and weights of vertices, four at most.
#[derive(Debug, Default)]
pub(crate) struct Influences {
    skinning: Skinning,
    /// Vertices that had more than four bones.
    pub(crate) reduced: usize,
    /// Vertices without any weight, which follow the first joint.
    pub(crate) unweighted: usize,
}

impl Influences {
    /// Room for so many vertices.
    pub(crate) fn with_capacity(vertices: usize) -> Self {
        let skinning = Skinning {
            bones: Vec::with_capacity(vertices),
            weights: Vec::with_capacity(vertices),
            ..Skinning::default()
        };
        Self { skinning, ..Self::default() }
    }

    /// Adds a vertex: the four largest of its weights, which are finite and not negative, divided by their sum
    /// unless that is 1 already. Reorders `bones`. Bones without weight become 0, as they may be anything in files.
    pub(crate) fn push(&mut self, bones: &mut [(u16, f32)]) {
        if bones.len() > 4 {
            // Stable, so that among equals the file's order counts.
            bones.sort_by(|a, b| b.1.total_cmp(&a.1));
            self.reduced += usize::from(bones[4].1 > 0.0);
        }
        let (mut indices, mut weights) = ([0; 4], [0.0; 4]);
        for (slot, &(bone, weight)) in
            bones.iter().take(4).enumerate().filter(|(_, (_, weight))| *weight > 0.0)
        {
            (indices[slot], weights[slot]) = (bone, weight);
        }
        let sum: f64 = weights.iter().map(|&weight| f64::from(weight)).sum();
        if sum <= 0.0 {
            self.unweighted += 1;
            weights[0] = 1.0;
        } else if (sum - 1.0).abs() > WEIGHT_SUM_TOLERANCE {
            weights = weights.map(|weight| (f64::from(weight) / sum) as f32);
        }
        self.skinning.bones.push(indices);
        self.skinning.weights.push(weights);
    }

    /// All vertices.
    pub(crate) fn finish(self) -> Skinning {
        self.skinning
    }
}

/// Normals for a mesh whose file has none: the mean of a vertex's triangles, weighted by their areas. Where no
/// triangles share a vertex these are the flat normals that glTF 2.0 (section 3.7.2.1) asks for; where they do, the
/// surface is smooth instead, since vertices keep the numbers that the file gives them. Vertices without area
/// look along +Z. Corners are below the number of positions.
pub(crate) fn normals_of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| positions[corner as usize].as_dvec3());
        let twice_area = (b - a).cross(c - a);
        for corner in corners {
            sums[*corner as usize] += twice_area;
        }
    }
    sums.iter().map(|sum| sum.normalize_or(DVec3::Z).as_vec3()).collect()
}
