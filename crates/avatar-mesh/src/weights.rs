//! Blend weights and the two forms of shapes.
//!
//! ```text
//!  relative    S_b + Σ w_i R_i              absolute    (1 − Σ w_i) S_b + Σ w_i S_i        R_i = S_i − S_b
//!  normalised  S_b + Σ w_i R_i / max(1, Σ w_i)
//! ```
//!
//! Relative and absolute weights are the same numbers: what differs is what a shape stores. Normalising is a
//! map on weights, so it works with whatever deforms the mesh. Weights below 0 and sums above 1 extrapolate.

use crate::{Offsets, Shape};
use glam::Vec3;

/// Two geometries of one connectivity that have different numbers of vertices.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("shape {shape:?}: expected {expected} vertices, found {found}")]
pub struct VertexCountError {
    /// Name of the shape.
    pub shape: String,
    /// Number of vertices of the base.
    pub expected: usize,
    /// Number of vertices of the shape.
    pub found: usize,
}

impl Shape {
    /// The shape that takes `base` to `absolute` at weight 1: `R = S − S_b`.
    ///
    /// # Errors
    /// Different numbers of vertices.
    pub fn from_absolute(
        name: impl Into<String>,
        base: &[Vec3],
        absolute: &[Vec3],
    ) -> Result<Self, VertexCountError> {
        let name = name.into();
        if base.len() != absolute.len() {
            return Err(VertexCountError { shape: name, expected: base.len(), found: absolute.len() });
        }
        // Vertices that do not move get offsets of +0, since x − x is +0.
        let offsets: Offsets = absolute.iter().zip(base).map(|(s, b)| *s - *b).collect();
        Ok(Self::new(name, offsets))
    }

    /// Where the shape takes `base` at weight 1: `S = S_b + R`.
    ///
    /// # Errors
    /// Different numbers of vertices.
    pub fn absolute(&self, base: &[Vec3]) -> Result<Vec<Vec3>, VertexCountError> {
        if base.len() != self.positions.len() {
            let (expected, found) = (base.len(), self.positions.len());
            return Err(VertexCountError { shape: self.name.clone(), expected, found });
        }
        let mut absolute = base.to_vec();
        self.positions.add_scaled(1.0, &mut absolute);
        Ok(absolute)
    }
}

/// What is left for the base in an absolute blend: `1 − Σ w_i`.
pub fn base_weight(weights: &[f32]) -> f32 {
    (1.0 - sum(weights)) as f32
}

/// Divides by `max(1, Σ w_i)`: shapes at full weight average. A sum of at most 1, below 0 too, leaves the
/// weights as they are to the bit, so nothing jumps as the sum passes 1 or 0; sums that are no finite number
/// leave them, too.
pub fn normalise(weights: &mut [f32]) {
    let sum = sum(weights);
    if sum > 1.0 && sum.is_finite() {
        weights.iter_mut().for_each(|weight| *weight = (f64::from(*weight) / sum) as f32);
    }
}

/// Brings weights to `least`…`most`, against extrapolation. NaN becomes one of the two; where `least` is
/// above `most`, all become `least`.
pub fn clamp(weights: &mut [f32], least: f32, most: f32) {
    // Not f32::clamp, which panics for a range without numbers; min and max prefer a number to NaN.
    weights.iter_mut().for_each(|weight| *weight = weight.min(most).max(least));
}

/// In f64, where a sum of any number of finite f32 is finite.
fn sum(weights: &[f32]) -> f64 {
    weights.iter().map(|weight| f64::from(*weight)).sum()
}
