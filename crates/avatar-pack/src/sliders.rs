use avatar_mesh::drivers::{LengthError, ShapeDrivers};
use avatar_mesh::expressions::{self, Expression};
use lanes::Lanes;
use pose_anim::{Control, ControlTable, Coupling};

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
    /// Sliders that show where a control of a joint is: shapes may correct what joints do.
    pub of_controls: Vec<ControlSlider>,
    /// Controls that move others: by `factor` times their value. None of these is moved
    /// itself.
    pub mixing: Vec<Coupling>,
}

/// A slider that shows where a control is: 0 at rest, 1 when it has gone its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlSlider {
    /// Its position in [`Sliders::names`].
    pub slider: usize,
    /// The control's position in [`crate::Pack::controls`].
    pub control: usize,
    /// The control's value where the slider is 0.
    pub rest: f32,
    /// How far from there the slider is 1; not 0.
    pub way: f32,
}

/// A control's value after a move, within its range.
fn moved(value: f32, way: f32, control: &Control) -> f32 {
    let sum = value + way;
    // A NaN goes through to where it is reported; max and min would hide it.
    if sum.is_nan() { sum } else { sum.min(control.max.max(value)).max(control.min.min(value)) }
}

impl ControlSlider {
    fn value(&self, control: f32) -> f32 {
        (control - self.rest) / self.way
    }
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
    /// Moves the controls that others move, in the values after the couplings: by `factor` times the other's
    /// value, within the range. What is beyond its range already stays there. Allocates nothing.
    pub fn mix(&self, controls: &ControlTable, values: &mut [f32]) {
        for one in &self.mixing {
            let Some((from, control)) = values.get(one.from).copied().zip(controls.controls().get(one.to))
            else {
                continue;
            };
            if let Some(slot) = values.get_mut(one.to) {
                *slot = moved(*slot, one.factor * from, control);
            }
        }
    }

    /// [`Self::mix`] for many faces, with the same bits: by block of [`lanes::LANES`] faces, `values` have
    /// one number per control. Allocates nothing.
    pub fn mix_crowd(&self, controls: &ControlTable, values: &mut [Lanes]) {
        if self.mixing.is_empty() {
            return;
        }
        for values in values.chunks_exact_mut(controls.len().max(1)) {
            for one in &self.mixing {
                let Some((from, control)) =
                    values.get(one.from).copied().zip(controls.controls().get(one.to))
                else {
                    continue;
                };
                let slots = values.get_mut(one.to).into_iter().flat_map(|lanes| lanes.iter_mut());
                slots
                    .zip(from.iter())
                    .for_each(|(slot, from)| *slot = moved(*slot, one.factor * from, control));
            }
        }
    }

    /// Sets the values of those sliders that show where controls are, from the controls' values after the
    /// couplings. Allocates nothing.
    pub fn follow_controls(&self, controls: &[f32], values: &mut [f32]) {
        for one in &self.of_controls {
            if let (Some(slot), Some(control)) = (values.get_mut(one.slider), controls.get(one.control)) {
                *slot = one.value(*control);
            }
        }
    }

    /// [`Self::follow_controls`] for many faces, with the same bits: by block of [`lanes::LANES`] faces,
    /// `controls` have `count` numbers and `values` one per slider. Allocates nothing.
    pub fn follow_controls_crowd(&self, count: usize, controls: &[Lanes], values: &mut [Lanes]) {
        let blocks = values.chunks_exact_mut(self.names.len().max(1));
        for (values, controls) in blocks.zip(controls.chunks_exact(count.max(1))) {
            for one in &self.of_controls {
                if let (Some(slots), Some(lanes)) = (values.get_mut(one.slider), controls.get(one.control)) {
                    for (slot, control) in slots.iter_mut().zip(lanes.iter()) {
                        *slot = one.value(*control);
                    }
                }
            }
        }
    }

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

    /// [`Self::run`] for many faces, with the same bits: by block of [`lanes::LANES`] faces, `values` have
    /// one number per slider and `weights` one per shape. Allocates nothing.
    ///
    /// # Errors
    /// Slices that are not so long for `blocks` blocks; then nothing has been changed.
    pub fn run_crowd(
        &self,
        blocks: usize,
        values: &[Lanes],
        weights: &mut [Lanes],
    ) -> Result<(), LengthError> {
        self.drivers.run_crowd(blocks, values, weights)?;
        let Expressions { first_slider, list, rest } = &self.expressions;
        if list.is_empty() && rest.is_empty() {
            return Ok(());
        }
        let (sliders, shapes) = (self.drivers.driver_count(), self.drivers.shape_count());
        for (block, weights) in weights.chunks_exact_mut(shapes.max(1)).enumerate() {
            for (shape, weight) in rest {
                let slots = weights.get_mut(*shape).into_iter().flat_map(|lanes| lanes.iter_mut());
                slots.for_each(|slot| *slot -= weight);
            }
            let values = values.get(block * sliders + first_slider..(block + 1) * sliders);
            expressions::add_lanes(list, values.unwrap_or_default(), weights);
        }
        Ok(())
    }
}
