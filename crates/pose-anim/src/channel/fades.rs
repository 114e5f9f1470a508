//! Fades inside fades: their state, their end, and how they are folded when there are too many.

use super::Channel;
use super::cold::{Cold, Fade};
use super::path::Path;
#[cfg(test)]
use super::tests;
use crate::Jet;
use crate::brake::brake;

impl Channel {
    pub(super) fn running<'r>(&self, cold: &'r Cold) -> &'r [Fade] {
        &cold.fades[..usize::from(self.fades)]
    }

    /// Where the motion comes to rest.
    pub(super) fn end(&self, cold: &Cold) -> f64 {
        match self.running(cold).last() {
            Some(fade) => fade.towards.end(),
            None if self.other_base => cold.base.end(),
            None => self.base.target,
        }
    }

    pub(super) fn state_after(&self, secs: f64, cold: &Cold) -> Jet {
        self.inner_state(secs, usize::from(self.fades), cold)
    }

    /// State of the base within its innermost fades.
    pub(super) fn inner_state(&self, secs: f64, fades: usize, cold: &Cold) -> Jet {
        let now_secs = self.elapsed_secs + secs;
        let fades = &cold.fades[..fades];
        // What is inside a finished fade has no weight.
        let over = fades.iter().rposition(|fade| fade.is_over(now_secs));
        let (state, outer) = match over {
            Some(over) => {
                (fades[over].towards.at(fades[over].age_secs + now_secs, self.range), &fades[over + 1..])
            }
            None => {
                let age_secs = self.base_age_secs + now_secs;
                (
                    if self.other_base { cold.base.at(age_secs, self.range) } else { self.base.at(age_secs) },
                    fades,
                )
            }
        };
        outer.iter().fold(state, |state, fade| {
            let age_secs = fade.age_secs + now_secs;
            state.mix(fade.towards.at(age_secs, self.range), Jet::step(age_secs, fade.duration_secs))
        })
    }

    /// Removes everything inside a fade that has finished.
    pub(super) fn drop_faded_out(&mut self, cold: &mut Cold) {
        let over = self.running(cold).iter().rposition(|fade| fade.is_over(self.elapsed_secs));
        let Some(over) = over else { return };
        self.base_age_secs = cold.fades[over].age_secs;
        let towards = std::mem::replace(&mut cold.fades[over].towards, Path::rest(0.0));
        self.other_base = !matches!(towards, Path::Quintic(_));
        if let Path::Quintic(quintic) = towards {
            self.base = quintic;
        }
        cold.base = towards;
        cold.fades[..over].iter_mut().for_each(|fade| fade.towards = Path::rest(0.0));
        cold.fades.rotate_left(over + 1);
        self.fades -= over as u8 + 1;
    }

    /// Keeps the time of a repeating clip that runs alone within one repetition. Otherwise the sum would grow
    /// and lose digits: microseconds in a day of ticks. After an infinite time the clip is at its start.
    pub(super) fn drop_repetitions(&mut self, cold: &Cold) {
        if self.fades > 0 || self.waits || !self.other_base {
            return;
        }
        let Path::Clip(clip) = &cold.base else { return };
        let Some(period_secs) = clip.period_secs() else { return };
        let age_secs = self.base_age_secs + self.elapsed_secs;
        if age_secs >= period_secs {
            self.base_age_secs = 0.0;
            self.elapsed_secs = if age_secs.is_finite() { age_secs % period_secs } else { 0.0 };
        }
    }

    /// Replaces the base and the innermost fade by one quintic.
    pub(super) fn fold(&mut self, cold: &mut Cold) {
        #[cfg(test)]
        tests::FOLDS.set(tests::FOLDS.get() + 1);
        let inner = &cold.fades[0];
        let state = self.inner_state(0.0, 1, cold);
        let remaining_secs = inner.duration_secs - inner.age_secs;
        self.base = brake(state, inner.towards.end(), remaining_secs, self.range);
        self.other_base = false;
        self.base_age_secs = 0.0;
        cold.base = Path::rest(0.0);
        cold.fades[0].towards = Path::rest(0.0);
        cold.fades.rotate_left(1);
        self.fades -= 1;
    }
}
