//! Shape spaces: weights as coordinates along named axes.
//!
//! The shapes of a mesh span a space; a face in it is a point. Axes may be expressions or variants of one
//! thing, the mathematics is the same: points add up and scale, so two faces mix by mixing their coordinates,
//! in any proportion.
//!
//! ```
//! use avatar_mesh::space::{Coordinates, ShapeSpace};
//!
//! let anna = Coordinates::from([("wide jaw", 1.0), ("long nose", 0.5)]);
//! let bert = Coordinates::from([("long nose", 1.0), ("beard", 1.0)]);
//! let child = Coordinates::mixed([(0.4, &anna), (0.9, &bert)]);
//!
//! let space = ShapeSpace::new(["long nose", "wide jaw", "smile"]);
//! let (mut weights, mut unknown) = ([0.0; 3], Vec::new());
//! space.weights(&child, &mut weights, |axis, _| unknown.push(axis.to_owned()))?;
//! assert_eq!(weights, [0.4 * 0.5 + 0.9, 0.4, 0.0]);
//! assert_eq!(unknown, ["beard"]);
//! # Ok::<(), avatar_mesh::drivers::LengthError>(())
//! ```

use crate::Mesh;
use crate::drivers::LengthError;
use std::collections::{BTreeMap, HashMap};

/// A point of a shape space: a weight for each axis that is not at 0. Axes that are not named are at 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coordinates {
    /// Weights by the names of axes.
    pub weights: BTreeMap<String, f32>,
}

impl Coordinates {
    /// `Σ share · point`: 0.4 of one and 0.9 of another. Shares need not sum to 1; those below 0 go away from
    /// a point.
    pub fn mixed<'a>(parts: impl IntoIterator<Item = (f32, &'a Self)>) -> Self {
        let mut weights: BTreeMap<String, f32> = BTreeMap::new();
        for (share, part) in parts {
            for (axis, weight) in &part.weights {
                // Names are copied once per axis, not once per part.
                match weights.get_mut(axis) {
                    Some(sum) => *sum += share * weight,
                    None => drop(weights.insert(axis.clone(), share * weight)),
                }
            }
        }
        Self { weights }
    }
}

/// If an axis has several weights, the last one counts.
impl<S: Into<String>, const N: usize> From<[(S, f32); N]> for Coordinates {
    fn from(weights: [(S, f32); N]) -> Self {
        weights.into_iter().collect()
    }
}

/// If an axis has several weights, the last one counts.
impl<S: Into<String>> FromIterator<(S, f32)> for Coordinates {
    fn from_iter<I: IntoIterator<Item = (S, f32)>>(weights: I) -> Self {
        Self { weights: weights.into_iter().map(|(axis, weight)| (axis.into(), weight)).collect() }
    }
}

/// The axes of a mesh: the names of its shapes, in their order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ShapeSpace {
    axes: Vec<String>,
    /// The shapes of each name.
    shapes_of: HashMap<String, Vec<usize>>,
}

impl ShapeSpace {
    /// A space with these axes. Shapes of one name move together.
    pub fn new<S: Into<String>>(axes: impl IntoIterator<Item = S>) -> Self {
        let axes: Vec<String> = axes.into_iter().map(Into::into).collect();
        let mut shapes_of: HashMap<String, Vec<usize>> = HashMap::with_capacity(axes.len());
        for (shape, axis) in axes.iter().enumerate() {
            shapes_of.entry(axis.clone()).or_default().push(shape);
        }
        Self { axes, shapes_of }
    }

    /// The space of a mesh's shapes.
    pub fn of(mesh: &Mesh) -> Self {
        Self::new(mesh.shapes.iter().map(|shape| &shape.name))
    }

    /// The names of the axes, in the order of the weights.
    pub fn axes(&self) -> &[String] {
        &self.axes
    }

    /// Writes the weight of each shape at a point, and tells `unknown` the name and weight of each of the
    /// point's axes that this space lacks, in alphabetical order: another avatar may have them. Allocates
    /// nothing.
    ///
    /// # Errors
    /// Another number of weights than there are axes; then nothing is written.
    pub fn weights(
        &self,
        point: &Coordinates,
        weights: &mut [f32],
        mut unknown: impl FnMut(&str, f32),
    ) -> Result<(), LengthError> {
        let (expected, found) = (self.axes.len(), weights.len());
        if expected != found {
            return Err(LengthError { what: "weights", expected, found });
        }
        weights.fill(0.0);
        for (axis, weight) in &point.weights {
            match self.shapes_of.get(axis) {
                Some(shapes) => shapes.iter().for_each(|shape| weights[*shape] = *weight),
                None => unknown(axis, *weight),
            }
        }
        Ok(())
    }

    /// The point at which the shapes have these weights, without the axes at 0. Of shapes of one name the
    /// last one other than 0 counts; missing weights are 0.
    pub fn point(&self, weights: &[f32]) -> Coordinates {
        let named = self.axes.iter().zip(weights).filter(|(_, weight)| **weight != 0.0);
        named.map(|(axis, weight)| (axis.as_str(), *weight)).collect()
    }
}
