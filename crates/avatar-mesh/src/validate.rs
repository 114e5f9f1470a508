use crate::{Mesh, Offsets, Skinning};
use bytemuck::NoUninit;
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
        finite("position", &self.positions)?;
        finite("uv", &self.uvs)?;
        finite("second uv", &self.uvs_1)?;
        finite("vertex colour", &self.colors)?;
        finite("normal", &self.normals)?;
        finite("tangent", &self.tangents)?;
        for shape in &self.shapes {
            for (what, offsets) in shape.arrays() {
                finite_offsets(&format!("{what} offset of {}", shape.name), offsets)?;
            }
        }
        match &self.skinning {
            Some(skinning) => {
                finite("bone weight", &skinning.weights)?;
                finite("further bone weight", &skinning.more_weights)?;
                finite("blend index", &skinning.blend_index)
            }
            None => Ok(()),
        }
    }

    fn check_indices(&self, vertices: usize) -> Result<(), MeshError> {
        if u32::try_from(vertices - 1).is_ok_and(|last| all_up_to(self.triangles.as_flattened(), last)) {
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
        if is_plain(skinning, bones) {
            return Ok(None);
        }
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
    match finite(field, offsets.stored()) {
        // The place among what is stored need not be the vertex.
        Err(MeshError::NotFinite { found, .. }) => {
            let vertex =
                offsets.iter().find(|(_, offset)| !offset.is_finite()).map_or(0, |(vertex, _)| vertex);
            Err(MeshError::NotFinite { vertex, field: field.to_owned(), found })
        }
        other => other,
    }
}

/// Arrays are looked at as numbers one after the other, in one vectorised pass without branches; only one
/// that fails is searched for the place.
fn finite<T: NoUninit>(field: &str, values: &[T]) -> Result<(), MeshError> {
    let numbers: &[f32] = bytemuck::cast_slice(values);
    if are_finite(numbers) {
        return Ok(());
    }
    match numbers.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(at) => {
            let vertex = at * size_of::<f32>() / size_of::<T>();
            Err(MeshError::NotFinite { vertex, field: field.to_owned(), found: numbers[at] })
        }
    }
}

/// A float is finite exactly where its exponent is not all ones: one more than that carries into the sign.
fn are_finite(numbers: &[f32]) -> bool {
    const EXPONENT: u32 = 0x7f80_0000;
    const ONE: u32 = 0x0080_0000;
    numbers.iter().fold(0, |carried, x| carried | ((x.to_bits() & EXPONENT) + ONE)) >> 31 == 0
}

/// Whether all of these are at most `last`: for numbers below 2³¹, `last - index` then has no sign.
fn all_up_to(indices: &[u32], last: u32) -> bool {
    if last >> 31 != 0 {
        return indices.iter().all(|index| *index <= last);
    }
    indices.iter().fold(0, |signs, index| signs | index | last.wrapping_sub(*index)) >> 31 == 0
}

/// Whether nothing is to be found or mended: four bones a vertex, all in the palette, and weights that sum
/// to 1 as they are.
fn is_plain(skinning: &Skinning, bones: usize) -> bool {
    let Skinning { bones: indices, weights, more_bones, more_weights, .. } = skinning;
    let largest = indices.as_flattened().iter().fold(0, |most, bone| (*bone).max(most));
    // As below, to the bit.
    let off = |w: &[f32; 4]| {
        let sum = f64::from(w[0]) + f64::from(w[1]) + f64::from(w[2]) + f64::from(w[3]);
        (sum - 1.0).abs()
    };
    more_bones.is_empty()
        && more_weights.is_empty()
        && usize::from(largest) < bones
        && weights.iter().fold(true, |all, w| all & (off(w) <= WEIGHT_SUM_TOLERANCE))
}
