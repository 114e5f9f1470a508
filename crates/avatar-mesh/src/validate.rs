use crate::{Mesh, Offsets};
use std::fmt;

/// Weights whose sum is this close to 1 are taken as they are.
pub const WEIGHT_SUM_TOLERANCE: f64 = 1e-6;
/// Weights whose sum is further from 1 than this are an error; between the two they are renormalised.
pub const WEIGHT_SUM_LIMIT: f64 = 1e-3;

/// What is wrong with a mesh or its bytes, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A buffer whose length is not a multiple of an element's.
    #[error("expected a whole number of {element_bytes}-byte {element}, found {found} bytes")]
    PartialElement {
        /// `vertices` or `triangles`.
        element: &'static str,
        /// Bytes of one element.
        element_bytes: usize,
        /// Bytes of the buffer.
        found: usize,
    },
    /// A mesh without vertices.
    #[error("expected at least one vertex, found an empty buffer")]
    NoVertices,
    /// An array that is not as long as the mesh has vertices.
    #[error("expected {expected} elements in {what}, found {found}")]
    Count {
        /// Which array.
        what: String,
        /// Number of vertices.
        expected: usize,
        /// Its length.
        found: usize,
    },
    /// NaN or infinity.
    #[error("vertex {vertex}: expected a finite number in {field}, found {found}")]
    NotFinite {
        /// The vertex.
        vertex: usize,
        /// Which of its fields.
        field: String,
        /// The number.
        found: f32,
    },
    /// An index beyond the vertices.
    #[error("triangle {triangle}, corner {corner}: expected a vertex below {vertices}, found {found}")]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// 0, 1 or 2.
        corner: usize,
        /// The index.
        found: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A bone index that is not a whole number, is negative, or is beyond the palette.
    #[error("vertex {vertex}, bone {slot}: expected a whole number from 0 to {last}, found {found}")]
    BoneIndex {
        /// The vertex.
        vertex: usize,
        /// 0 to 7.
        slot: usize,
        /// The number.
        found: f32,
        /// The last valid index.
        last: usize,
    },
    /// Weights that do not sum to 1.
    #[error(
        "vertex {vertex}: expected bone weights that sum to 1 (within {WEIGHT_SUM_LIMIT}), found {found}"
    )]
    WeightSum {
        /// The vertex.
        vertex: usize,
        /// The sum.
        found: f64,
    },
}

/// Something that was mended, or that people should look at.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshWarning {
    /// Weights were divided by their sum.
    Renormalised {
        /// Number of vertices concerned.
        vertices: usize,
        /// The vertex furthest off.
        worst: usize,
        /// Its sum.
        sum: f64,
    },
    /// There is nothing to draw.
    NoTriangles,
}

impl fmt::Display for MeshWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Renormalised { vertices, worst, sum } => write!(
                f,
                "expected bone weights that sum to 1, renormalised {vertices} vertices (vertex {worst}: sum {sum})"
            ),
            Self::NoTriangles => write!(f, "expected triangles, found none: the part is invisible"),
        }
    }
}

impl Mesh {
    /// Checks everything that deformation and drawing rely on, for a palette of `bones` bones, and
    /// renormalises weights that are slightly off.
    ///
    /// # Errors
    /// The first thing that is wrong, with its vertex or triangle.
    pub fn validate(&mut self, bones: usize) -> Result<Vec<MeshWarning>, MeshError> {
        let vertices = self.positions.len();
        if vertices == 0 {
            return Err(MeshError::NoVertices);
        }
        self.check_counts(vertices)?;
        self.check_finite()?;
        self.check_indices(vertices)?;
        let mut warnings = Vec::new();
        if self.triangles.is_empty() {
            warnings.push(MeshWarning::NoTriangles);
        }
        warnings.extend(self.check_skinning(bones)?);
        Ok(warnings)
    }

    fn check_counts(&self, expected: usize) -> Result<(), MeshError> {
        let check = |what: &str, found| match found == expected {
            true => Ok(()),
            false => Err(MeshError::Count { what: what.to_owned(), expected, found }),
        };
        check("uvs", self.uvs.len())?;
        check("normals", self.normals.len())?;
        if !self.uvs_1.is_empty() {
            check("second uvs", self.uvs_1.len())?;
        }
        if !self.colors.is_empty() {
            check("vertex colours", self.colors.len())?;
        }
        if !self.tangents.is_empty() {
            check("tangents", self.tangents.len())?;
        }
        for shape in &self.shapes {
            for (what, offsets) in shape.arrays() {
                check(&format!("{what} offsets of shape {:?}", shape.name), offsets.len())?;
            }
        }
        if let Some(skinning) = &self.skinning {
            check("bone indices", skinning.bones.len())?;
            check("bone weights", skinning.weights.len())?;
            let further = [skinning.more_bones.len(), skinning.more_weights.len()];
            if further != [0, 0] {
                check("further bone indices", further[0])?;
                check("further bone weights", further[1])?;
            }
            if !skinning.blend_index.is_empty() {
                check("blend indices", skinning.blend_index.len())?;
            }
        }
        Ok(())
    }

    fn check_finite(&self) -> Result<(), MeshError> {
        finite("position", self.positions.iter().map(|p| p.to_array()))?;
        finite("uv", self.uvs.iter().map(|uv| uv.to_array()))?;
        finite("second uv", self.uvs_1.iter().map(|uv| uv.to_array()))?;
        finite("vertex colour", self.colors.iter().map(|color| color.to_array()))?;
        finite("normal", self.normals.iter().map(|n| n.to_array()))?;
        finite("tangent", self.tangents.iter().map(|t| t.to_array()))?;
        for shape in &self.shapes {
            for (what, offsets) in shape.arrays() {
                finite_offsets(&format!("{what} offset of {}", shape.name), offsets)?;
            }
        }
        match &self.skinning {
            Some(skinning) => {
                finite("bone weight", skinning.weights.iter().copied())?;
                finite("further bone weight", skinning.more_weights.iter().copied())?;
                finite("blend index", skinning.blend_index.iter().map(|b| b.to_array()))
            }
            None => Ok(()),
        }
    }

    fn check_indices(&self, vertices: usize) -> Result<(), MeshError> {
        let largest = self.triangles.iter().fold(0, |most, [a, b, c]| most.max(*a).max(*b).max(*c));
        if (largest as usize) < vertices {
            return Ok(());
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            for (corner, &found) in corners.iter().enumerate() {
                if found as usize >= vertices {
                    return Err(MeshError::IndexOutOfRange { triangle, corner, found, vertices });
                }
            }
        }
        Ok(())
    }

    fn check_skinning(&mut self, bones: usize) -> Result<Option<MeshWarning>, MeshError> {
        let Some(skinning) = &mut self.skinning else { return Ok(None) };
        let (mut renormalised, mut worst, mut worst_sum) = (0, 0, 1.0f64);
        let beyond = |found: &u16| usize::from(*found) >= bones;
        for (vertex, (indices, weights)) in skinning.bones.iter().zip(&mut skinning.weights).enumerate() {
            let more = skinning.more_bones.get(vertex);
            if let Some(slot) = indices.iter().chain(more.into_iter().flatten()).position(beyond) {
                let found = if slot < 4 { indices[slot] } else { more.map_or(0, |more| more[slot - 4]) };
                let (found, last) = (f32::from(found), bones.saturating_sub(1));
                return Err(MeshError::BoneIndex { vertex, slot, found, last });
            }
            let more = skinning.more_weights.get_mut(vertex);
            let all = || weights.iter().chain(more.iter().flat_map(|more| more.iter()));
            let sum: f64 = all().map(|&weight| f64::from(weight)).sum();
            let off = (sum - 1.0).abs();
            if off > WEIGHT_SUM_LIMIT {
                return Err(MeshError::WeightSum { vertex, found: sum });
            }
            if off > WEIGHT_SUM_TOLERANCE {
                renormalised += 1;
                if off > (worst_sum - 1.0).abs() {
                    (worst, worst_sum) = (vertex, sum);
                }
                let all = weights.iter_mut().chain(more.into_iter().flatten());
                all.for_each(|weight| *weight = (f64::from(*weight) / sum) as f32);
            }
        }
        let warning = MeshWarning::Renormalised { vertices: renormalised, worst, sum: worst_sum };
        Ok((renormalised > 0).then_some(warning))
    }
}

fn finite_offsets(field: &str, offsets: &Offsets) -> Result<(), MeshError> {
    match finite(field, offsets.stored().iter().map(|d| d.to_array())) {
        // The place among what is stored need not be the vertex.
        Err(MeshError::NotFinite { found, .. }) => {
            let vertex =
                offsets.iter().find(|(_, offset)| !offset.is_finite()).map_or(0, |(vertex, _)| vertex);
            Err(MeshError::NotFinite { vertex, field: field.to_owned(), found })
        }
        other => other,
    }
}

/// A float is finite exactly where its exponent is not all ones. The largest exponent of an array is one
/// vectorised pass without branches; only an array that fails is searched for the place.
fn finite<const N: usize>(
    field: &str,
    values: impl Iterator<Item = [f32; N]> + Clone,
) -> Result<(), MeshError> {
    const EXPONENT: u32 = 0x7f80_0000;
    let largest =
        |most: u32, value: [f32; N]| value.iter().fold(most, |most, x| most.max(x.to_bits() & EXPONENT));
    if values.clone().fold(0, largest) < EXPONENT {
        return Ok(());
    }
    for (vertex, value) in values.enumerate() {
        if let Some(&found) = value.iter().find(|x| !x.is_finite()) {
            return Err(MeshError::NotFinite { vertex, field: field.to_owned(), found });
        }
    }
    Ok(())
}
