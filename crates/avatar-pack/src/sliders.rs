use avatar_mesh::drivers::{LengthError, ShapeDrivers};
use avatar_mesh::expressions::{self, Expression};

/// What moves shapes where that is not simply one number for each: shapes that show how a slider is on its
/// way, and those that count as products of others.
#[derive(Clone, Debug, PartialEq)]
pub struct Sliders {
    /// Names of the sliders, in the order of their values; those of different nodes may be the same. Controls
    /// drive these.
    pub names: Vec<String>,
    /// Per shape of [`crate::Pack::shapes`] the sliders that it follows, as positions in `names`.
    pub of_shapes: Vec<Vec<usize>>,
    /// From values of sliders to weights of [`crate::Pack::shapes`].
    pub drivers: ShapeDrivers,
    /// Expressions, which add to the weights that the drivers make.
    pub expressions: Expressions,
}

/// Expressions of the face that hold each other back, as those of VRM.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expressions {
    /// The position of the first one's value in [`Sliders::names`]; the others follow.
    pub first_slider: usize,
    /// The expressions; their binds are positions in [`crate::Pack::shapes`].
    pub list: Vec<Expression>,
    /// Shapes that expressions bind and that are not 0 in the file, with their weights there. Expressions
    /// count from 0, so that this is taken off.
    pub rest: Vec<(usize, f32)>,
}

impl Sliders {
    /// Weights of all shapes from the values of the sliders. Allocates nothing.
    ///
    /// # Errors
    /// Another number of values than there are sliders, or of weights than there are shapes.
    pub fn run(&self, values: &[f32], weights: &mut [f32]) -> Result<(), LengthError> {
        self.drivers.run(values, weights)?;
        let Expressions { first_slider, list, rest } = &self.expressions;
        for (shape, weight) in rest {
            weights.get_mut(*shape).into_iter().for_each(|slot| *slot -= weight);
        }
        expressions::add(list, values.get(*first_slider..).unwrap_or_default(), weights);
        Ok(())
    }
}
