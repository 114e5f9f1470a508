//! Which shapes follow which drivers: in-between shapes and combinations of shapes.
//!
//! A *driver* is whatever an animator moves: a slider, a control, a channel of a file. Most shapes follow one
//! driver; two kinds do not.
//!
//! - *In-between* shapes show what a driver does on its way: each shape of a driver has the value at which it
//!   stands alone (FBX: full weight). Between two neighbours both fade linearly into each other, and the base
//!   shape stands at 0. Beyond the outermost the outermost span goes on as it is: extrapolation.
//! - *Combination* (corrective) shapes count as the product of others: mouth open times smile.
//!
//! [`ShapeDrivers`] is a small program made of such rules; running it allocates nothing.

mod crowd;
mod in_between;

use in_between::{Peak, peaks};
use std::collections::HashMap;

/// A number that a rule reads.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Input {
    /// The value of a driver.
    Driver(String),
    /// The weight of a shape.
    Shape(String),
}

/// How a shape gets its weight.
#[derive(Clone, Debug, PartialEq)]
pub enum Rule {
    /// 1 where the input is `full_weight`, 0 at 0 and where the next shape of the same input stands alone,
    /// linear between. A single shape with full weight 1 has the input's value as its weight.
    Follows {
        /// What it follows.
        input: Input,
        /// Where it stands alone: not 0, and unlike those of other shapes of this input. FBX counts in
        /// percent, divide by 100.
        full_weight: f32,
    },
    /// The product of these; 1 without any.
    Product(Vec<Input>),
}

/// The rule of one shape.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeRule {
    /// Name of the shape.
    pub shape: String,
    /// Its rule.
    pub rule: Rule,
}

/// Rules that cannot be followed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DriversError {
    /// A rule for, or an input from, a shape that the mesh lacks.
    #[error("rule of shape {rule:?}: expected a shape of the mesh, found {found:?}")]
    UnknownShape {
        /// Whose rule.
        rule: String,
        /// The unknown name.
        found: String,
    },
    /// An input from a driver that does not exist.
    #[error("rule of shape {rule:?}: expected a driver, found {found:?}")]
    UnknownDriver {
        /// Whose rule.
        rule: String,
        /// The unknown name.
        found: String,
    },
    /// A shape with two rules.
    #[error("expected one rule for shape {shape:?}, found two")]
    TwoRules {
        /// The shape.
        shape: String,
    },
    /// A full weight that is 0 or no finite number.
    #[error("shape {shape:?}: expected a full weight other than 0, found {found}")]
    FullWeight {
        /// The shape.
        shape: String,
        /// The number.
        found: f32,
    },
    /// Two shapes of one input that stand alone at the same value.
    #[error("shapes {first:?} and {second:?}: expected different full weights, found {found} twice")]
    SameFullWeight {
        /// One shape.
        first: String,
        /// The other.
        second: String,
        /// Their full weight.
        found: f32,
    },
    /// Shapes that depend on themselves: each on the next, the last on the first.
    #[error("expected shapes that do not depend on themselves, found {}", shapes.join(" → "))]
    Cycle {
        /// Their names.
        shapes: Vec<String>,
    },
}

/// Another number of values than there are drivers, or of weights than there are shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected} {what}, found {found}")]
pub struct LengthError {
    /// `driver values` or `weights`.
    pub what: &'static str,
    /// How many there are.
    pub expected: usize,
    /// How many were given.
    pub found: usize,
}

/// Weights of shapes from values of drivers.
///
/// ```
/// use avatar_mesh::drivers::{Input, Rule, ShapeDrivers, ShapeRule};
///
/// let blink = || Input::Driver("blink".to_owned());
/// let rule = |shape: &str, rule| ShapeRule { shape: shape.to_owned(), rule };
/// let rules = [
///     rule("half shut", Rule::Follows { input: blink(), full_weight: 0.5 }),
///     rule("shut", Rule::Follows { input: blink(), full_weight: 1.0 }),
///     rule("squint", Rule::Product(vec![Input::Shape("shut".into()), Input::Driver("smile".into())])),
/// ];
/// // A shape without a rule follows the driver of its name.
/// let shapes = ["smile", "half shut", "shut", "squint"];
/// let drivers = ShapeDrivers::new(&["blink", "smile"], &shapes, &rules)?;
/// let mut weights = [0.0; 4];
/// drivers.run(&[0.75, 0.5], &mut weights)?;
/// assert_eq!(weights, [0.5, 0.5, 0.5, 0.25]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeDrivers {
    driver_count: usize,
    shape_count: usize,
    /// In an order in which each reads only what is known.
    steps: Vec<Step>,
    /// Inputs of all products.
    factors: Vec<Source>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Driver(usize),
    Shape(usize),
}

#[derive(Clone, Debug, PartialEq)]
struct Step {
    shape: usize,
    weight: Weight,
}

#[derive(Clone, Debug, PartialEq)]
enum Weight {
    Peak { source: Source, peak: Peak },
    Product { first: usize, count: usize },
}

impl ShapeDrivers {
    /// A program for these drivers and shapes, in the orders that [`Self::run`] will use. A shape without a
    /// rule follows the driver of its name; if there is none it stays at 0.
    ///
    /// # Errors
    /// Unknown names, two rules for a shape, impossible full weights, shapes that depend on themselves.
    pub fn new<S: AsRef<str>>(
        drivers: &[S],
        shapes: &[S],
        rules: &[ShapeRule],
    ) -> Result<Self, DriversError> {
        let numbers = |names: &'_ [S]| -> HashMap<String, usize> {
            names.iter().enumerate().rev().map(|(i, name)| (name.as_ref().to_owned(), i)).collect()
        };
        let (driver_of, shape_of) = (numbers(drivers), numbers(shapes));
        let source =
            |rule: &ShapeRule, input: &Input| match input {
                Input::Driver(name) => driver_of.get(name).map(|i| Source::Driver(*i)).ok_or_else(|| {
                    DriversError::UnknownDriver { rule: rule.shape.clone(), found: name.clone() }
                }),
                Input::Shape(name) => shape_of.get(name).map(|i| Source::Shape(*i)).ok_or_else(|| {
                    DriversError::UnknownShape { rule: rule.shape.clone(), found: name.clone() }
                }),
            };
        let mut factors = Vec::new();
        let mut weights: Vec<Option<Weight>> = vec![None; shapes.len()];
        let peaks = peaks(rules)?;
        for (rule, peak) in rules.iter().zip(peaks) {
            let shape = shape_of.get(&rule.shape).copied();
            let Some(slot) = shape.and_then(|shape| weights.get_mut(shape)) else {
                let name = rule.shape.clone();
                return Err(DriversError::UnknownShape { rule: name.clone(), found: name });
            };
            let weight = match &rule.rule {
                Rule::Follows { input, .. } => Weight::Peak { source: source(rule, input)?, peak },
                Rule::Product(inputs) => {
                    let first = factors.len();
                    for input in inputs {
                        factors.push(source(rule, input)?);
                    }
                    Weight::Product { first, count: inputs.len() }
                }
            };
            if slot.replace(weight).is_some() {
                return Err(DriversError::TwoRules { shape: rule.shape.clone() });
            }
        }
        for (slot, name) in weights.iter_mut().zip(shapes).filter(|(slot, _)| slot.is_none()) {
            *slot = driver_of.get(name.as_ref()).map(|driver| {
                let factor = factors.len();
                factors.push(Source::Driver(*driver));
                Weight::Product { first: factor, count: 1 }
            });
        }
        let order = order(&weights, &factors).map_err(|cycle| named_cycle(&cycle, shapes))?;
        let steps = order
            .into_iter()
            .filter_map(|shape| Some(Step { shape, weight: weights.get_mut(shape)?.take()? }))
            .collect();
        Ok(Self { driver_count: drivers.len(), shape_count: shapes.len(), steps, factors })
    }

    /// Number of drivers, which is that of the values that [`Self::run`] takes.
    pub fn driver_count(&self) -> usize {
        self.driver_count
    }

    /// Number of shapes, which is that of the weights that [`Self::run`] writes.
    pub fn shape_count(&self) -> usize {
        self.shape_count
    }

    /// Writes the weight of each shape. Values may be any numbers.
    ///
    /// # Errors
    /// Slices of another length than there are drivers and shapes.
    pub fn run(&self, values: &[f32], weights: &mut [f32]) -> Result<(), LengthError> {
        let check = |what, expected, found| match found == expected {
            true => Ok(()),
            false => Err(LengthError { what, expected, found }),
        };
        check("driver values", self.driver_count, values.len())?;
        check("weights", self.shape_count, weights.len())?;
        weights.fill(0.0);
        for step in &self.steps {
            let read = |source: Source| match source {
                Source::Driver(driver) => values[driver],
                Source::Shape(shape) => weights[shape],
            };
            weights[step.shape] = match &step.weight {
                Weight::Peak { source, peak } => peak.weight(read(*source)),
                Weight::Product { first, count } => {
                    self.factors[*first..first + count].iter().map(|factor| read(*factor)).product()
                }
            };
        }
        Ok(())
    }
}

/// All shapes, each after those that it reads; or a cycle. Depth first, with a stack of its own.
fn order(weights: &[Option<Weight>], factors: &[Source]) -> Result<Vec<usize>, Vec<usize>> {
    let reads = |shape: usize, k: usize| match weights.get(shape)?.as_ref()? {
        Weight::Peak { source, .. } => (k == 0).then_some(*source),
        Weight::Product { first, count } => (k < *count).then(|| factors.get(first + k).copied())?,
    };
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let mut states = vec![State::New; weights.len()];
    let mut order = Vec::with_capacity(weights.len());
    for start in 0..weights.len() {
        // A shape and how many of its inputs were looked at.
        let mut open: Vec<(usize, usize)> = Vec::new();
        if states[start] == State::New {
            states[start] = State::Open;
            open.push((start, 0));
        }
        while let Some((shape, seen)) = open.last_mut() {
            let (shape, input) = (*shape, reads(*shape, *seen));
            *seen += 1;
            match input {
                None => {
                    states[shape] = State::Done;
                    order.push(shape);
                    open.pop();
                }
                Some(Source::Shape(next)) if states[next] == State::New => {
                    states[next] = State::Open;
                    open.push((next, 0));
                }
                Some(Source::Shape(next)) if states[next] == State::Open => {
                    return Err(open.iter().map(|(shape, _)| *shape).skip_while(|s| *s != next).collect());
                }
                Some(_) => {}
            }
        }
    }
    Ok(order)
}

fn named_cycle<S: AsRef<str>>(cycle: &[usize], shapes: &[S]) -> DriversError {
    DriversError::Cycle {
        shapes: cycle.iter().filter_map(|i| Some(shapes.get(*i)?.as_ref().to_owned())).collect(),
    }
}
