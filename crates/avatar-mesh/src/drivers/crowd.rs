//! Weights of many faces at once.

use super::{LengthError, ShapeDrivers, Source, Weight};
use lanes::{Lanes, Simd, Work};

impl ShapeDrivers {
    /// [`Self::run`] for many faces, with the same bits: by block of [`lanes::LANES`] faces, `values` have
    /// one number per driver and `weights` one per shape. Allocates nothing.
    ///
    /// # Errors
    /// Slices that are not so long for `blocks` blocks; then nothing has been changed.
    pub fn run_crowd(
        &self,
        blocks: usize,
        values: &[Lanes],
        weights: &mut [Lanes],
    ) -> Result<(), LengthError> {
        let check = |what, count: usize, found| match count.checked_mul(blocks) {
            Some(expected) if expected == found => Ok(()),
            expected => Err(LengthError { what, expected: expected.unwrap_or(usize::MAX), found }),
        };
        check("blocks of driver values", self.driver_count, values.len())?;
        check("blocks of weights", self.shape_count, weights.len())?;
        for (block, weights) in weights.chunks_exact_mut(self.shape_count.max(1)).enumerate() {
            let first = block * self.driver_count;
            let values = values.get(first..first + self.driver_count).unwrap_or_default();
            lanes::run(Run { drivers: self, values, weights });
        }
        Ok(())
    }
}

/// One block. What is done to each lane is what [`ShapeDrivers::run`] does, in its order; the compiler takes
/// the lanes of a loop together.
struct Run<'a> {
    drivers: &'a ShapeDrivers,
    values: &'a [Lanes],
    weights: &'a mut [Lanes],
}

impl Work for Run<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { drivers, values, weights } = self;
        weights.fill(Lanes::splat(0.0));
        for step in &drivers.steps {
            let read = |source: Source| match source {
                Source::Driver(driver) => values[driver],
                Source::Shape(shape) => weights[shape],
            };
            weights[step.shape] = match &step.weight {
                Weight::Peak { source, peak } => Lanes(read(*source).map(|value| peak.weight(value))),
                Weight::Product { first, count } => {
                    let factors = &drivers.factors[*first..first + count];
                    factors.iter().fold(Lanes::splat(1.0), |mut product, factor| {
                        let factor = read(*factor);
                        product.iter_mut().zip(factor.iter()).for_each(|(slot, value)| *slot *= value);
                        product
                    })
                }
            };
        }
    }
}
