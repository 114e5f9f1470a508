mod move_spec;
mod clip_path;
mod path;
mod cold;
mod fades;
#[cfg(test)]
mod tests;

use crate::quintic::Quintic;
use crate::range::Range;
use crate::{Clip, Jet, Pace};
use clip_path::ClipPath;
use cold::{Fade, MAX_FADES, Waiting};
use move_spec::clamp_duration;
use path::{Eased, Path};
use std::sync::Arc;

pub(crate) use cold::Cold;
pub(crate) use move_spec::MoveSpec;

/// The motion of one control.
///
/// A move is a closed function of the age of its parts, so that its state at a time does not depend on the
/// steps that led there. Its innermost part is a path of its own, mostly a quintic. Where the quintic from
/// the present state to the new target would leave the range, the running motion goes on and is faded out
/// instead:
///
/// ```text
/// x(t) = (1 − r(t)) · x_old(t) + r(t) · target        r: minimum-jerk step
/// ```
///
/// At the start `r = r' = r'' = 0`, so value, velocity and acceleration go on; at the end `r = 1, r' = r'' =
/// 0`, so the target is reached at rest; and a convex combination of values in a range is in the range. The
/// target may itself move.
///
/// `x_old` may itself be such a fade. When [`MAX_FADES`] are running and another one is needed, the two
/// innermost parts (the path and the first fade) are *folded*: a single quintic takes over from their present
/// state. Where it comes to rest does not matter, because it is about to fade out anyway. So its place and
/// time can be chosen such that it stays in range: see [`brake`]. Its effect on the further course is scaled
/// by the product of all fades around it. This keeps C², the range, the arrival time and a fixed size, for
/// any number of presses.
///
/// What most moves do not need is kept apart, in [`Cold`], so that a tick of ten thousand faces reads less
/// memory.
#[derive(Clone, Debug)]
pub(crate) struct Channel {
    range: Range,
    /// Time since the last start of a move.
    elapsed_secs: f64,
    /// The innermost path, where it is a quintic.
    base: Quintic,
    /// Age of `base` at the last start.
    base_age_secs: f64,
    /// Whether the innermost path is the one in [`Cold`] instead.
    other_base: bool,
    /// Number of fades that run.
    fades: u8,
    /// Whether a move waits for its delay to pass.
    waits: bool,
    sleeps: bool,
    /// Whether a direct move has begun at this very moment (`elapsed_secs` = 0), so that another one replaces
    /// it.
    fresh: bool,
}

impl Channel {
    pub(crate) const fn rest(range: Range, value: f64) -> Self {
        Self {
            range,
            elapsed_secs: 0.0,
            base: Quintic::rest(value),
            base_age_secs: 0.0,
            other_base: false,
            fades: 0,
            waits: false,
            sleeps: false,
            fresh: false,
        }
    }

    pub(crate) const fn range(&self) -> Range {
        self.range
    }

    pub(crate) fn is_at_rest(&self, cold: &Cold) -> bool {
        self.remaining_secs(cold) == 0.0
    }

    /// Time until the target is reached.
    pub(crate) fn remaining_secs(&self, cold: &Cold) -> f64 {
        if self.waits {
            let Waiting { at_secs, spec } = cold.waiting;
            let start = self.state_after(at_secs - self.elapsed_secs, cold);
            return at_secs - self.elapsed_secs + spec.duration_from(start, self.range);
        }
        match self.running(cold).last() {
            Some(fade) => {
                let age_secs = fade.age_secs + self.elapsed_secs;
                (fade.duration_secs - age_secs).max(fade.towards.remaining_secs(age_secs))
            }
            None => {
                let age_secs = self.base_age_secs + self.elapsed_secs;
                if self.other_base {
                    cold.base.remaining_secs(age_secs)
                } else {
                    self.base.duration_secs() - age_secs
                }
            }
        }
        .max(0.0)
    }

    /// Whether nothing has happened since the control came to rest, so that there is nothing to do.
    pub(crate) const fn sleeps(&self) -> bool {
        self.sleeps
    }

    /// The state of a control that sleeps.
    pub(crate) const fn at_rest(&self) -> Jet {
        Jet::rest(self.base.target)
    }

    /// The quintic that is all of the motion, and its age; `None` if there is more to it.
    pub(crate) const fn quintic(&self) -> Option<(Quintic, f64)> {
        match self.fades == 0 && !self.waits && !self.other_base && !self.fresh {
            true => Some((self.base, self.base_age_secs + self.elapsed_secs)),
            false => None,
        }
    }

    /// The same motion at another age, if it is a quintic only ([`Self::quintic`]).
    pub(crate) fn at_age(&self, age_secs: f64) -> Self {
        let sleeps = age_secs >= self.base.duration_secs();
        Self { base_age_secs: age_secs, elapsed_secs: 0.0, sleeps, ..self.clone() }
    }

    /// Lets time pass, also past the start of a move that waits, and returns the state after it.
    pub(crate) fn advance(&mut self, dt_secs: f64, cold: &mut Cold) -> Jet {
        // The usual case: only a quintic.
        if self.fades == 0 && !self.waits && !self.other_base && !self.fresh {
            self.elapsed_secs += dt_secs;
            let age_secs = self.base_age_secs + self.elapsed_secs;
            self.sleeps = age_secs >= self.base.duration_secs();
            return self.base.at(age_secs);
        }
        self.advance_any(dt_secs, cold)
    }

    #[cold]
    fn advance_any(&mut self, dt_secs: f64, cold: &mut Cold) -> Jet {
        if std::mem::take(&mut self.fresh) {
            cold.forget();
        }
        let mut until_secs = self.elapsed_secs + dt_secs;
        if self.waits && until_secs >= cold.waiting.at_secs {
            let Waiting { at_secs, spec } = cold.waiting;
            until_secs -= at_secs;
            self.elapsed_secs = at_secs;
            self.start(spec, cold);
        }
        self.elapsed_secs = until_secs;
        self.drop_faded_out(cold);
        self.drop_repetitions(cold);
        if self.is_at_rest(cold) {
            *self = Self { sleeps: true, ..Self::rest(self.range, self.end(cold)) };
            cold.forget();
        }
        self.state(cold)
    }

    /// Where the control is heading: the target of a move, also of one that waits for its delay to pass. A
    /// control that a clip moves heads for no value of its own: then this is the value that it has now.
    pub(crate) fn target(&self, cold: &Cold) -> f64 {
        match self.outermost(cold) {
            _ if self.waits => cold.waiting.spec.target,
            Some((Path::Clip(_), _)) => self.range.clamp(self.state(cold).value),
            _ => self.end(cold),
        }
    }

    /// The clip that moves the control, and the seconds since its start.
    pub(crate) fn clip<'c>(&self, cold: &'c Cold) -> Option<(&'c Arc<Clip>, f64)> {
        match self.outermost(cold)? {
            (Path::Clip(path), age_secs) => Some((path.clip(), age_secs)),
            _ => None,
        }
    }

    /// The path that everything else fades into, and its age; `None` where it is the quintic of the base.
    fn outermost<'c>(&self, cold: &'c Cold) -> Option<(&'c Path, f64)> {
        match self.running(cold).last() {
            Some(fade) => Some((&fade.towards, fade.age_secs + self.elapsed_secs)),
            None if self.other_base => Some((&cold.base, self.base_age_secs + self.elapsed_secs)),
            None => None,
        }
    }

    /// State at this moment. Only transition functions that overshoot on purpose take it out of the range,
    /// beyond rounding.
    pub(crate) fn state(&self, cold: &Cold) -> Jet {
        self.state_after(0.0, cold)
    }

    /// Starts a move from the state that the control has after a delay. Until then everything goes on as it
    /// is. A move that still waits is dropped.
    pub(crate) fn press(&mut self, spec: MoveSpec, delay_secs: f64, cold: &mut Cold) {
        self.sleeps = false;
        if delay_secs > 0.0 {
            cold.waiting = Waiting { at_secs: self.elapsed_secs + delay_secs, spec };
            self.waits = true;
        } else {
            self.start(spec, cold);
        }
    }

    /// Fades from the present motion into a track of a clip, which begins now.
    pub(crate) fn play(
        &mut self,
        clip: &Arc<Clip>,
        track: usize,
        pace: Pace,
        fade_secs: Option<f64>,
        cold: &mut Cold,
    ) {
        let Some(path) = ClipPath::new(clip, track, pace, self.range) else { return };
        self.waits = false;
        self.sleeps = false;
        self.take_back(cold);
        let distance = path.at(0.0, self.range).value - self.state(cold).value;
        let secs = fade_secs.unwrap_or_else(|| pace.duration_secs(distance, self.range.width()));
        self.fade_into(Path::Clip(path), clamp_duration(secs, pace.longest_secs), cold);
    }

    /// Brings the control to rest about where it would come to rest by itself with the least jerk.
    pub(crate) fn stop(&mut self, pace: Pace, cold: &mut Cold) {
        self.take_back(cold);
        if self.is_at_rest(cold) {
            return;
        }
        let state = self.state(cold);
        let secs = clamp_duration(pace.longest_secs, 0.5);
        let braked = state.value + secs * (state.velocity / 2.0 + state.acceleration * secs / 12.0);
        let target = self.range.clamp(braked);
        self.start(MoveSpec { target, duration_secs: Some(secs), pace, factor: 1.0, easing: None }, cold);
    }

    fn start(&mut self, spec: MoveSpec, cold: &mut Cold) {
        self.waits = false;
        self.take_back(cold);
        let state = self.state(cold);
        if state == Jet::rest(spec.target) && self.is_at_rest(cold) {
            *self = Self::rest(self.range, spec.target);
            cold.forget();
            return;
        }
        let duration_secs = spec.duration_from(state, self.range);
        if let Some(easing) = spec.easing {
            let eased = Eased { from: state.value, target: spec.target, duration_secs, easing };
            self.fade_into(Path::Eased(eased), Eased::BLEND * duration_secs, cold);
            return;
        }
        let direct = Quintic::new(state, spec.target, duration_secs);
        if self.range.holds(state.value) && direct.stays_within(self.range.min, self.range.max) {
            let begun = Self { base: direct, fresh: true, ..Self::rest(self.range, spec.target) };
            cold.before = std::mem::replace(self, begun);
            return;
        }
        self.fade_into(Path::rest(spec.target), duration_secs, cold);
    }

    /// Undoes a direct move that has begun at this very moment, so that the next move takes over from the
    /// motion before it. The fades of that motion are still there, because a direct move does not change
    /// [`Cold`] until time passes.
    fn take_back(&mut self, cold: &Cold) {
        if self.fresh && self.elapsed_secs == 0.0 {
            *self = Self { waits: false, sleeps: false, fresh: false, ..cold.before.clone() };
        }
    }

    /// Lets the present motion go on and fades from it into another one that begins now.
    fn fade_into(&mut self, towards: Path, duration_secs: f64, cold: &mut Cold) {
        self.base_age_secs += self.elapsed_secs;
        cold.fades[..usize::from(self.fades)].iter_mut().for_each(|fade| fade.age_secs += self.elapsed_secs);
        (self.elapsed_secs, self.fresh) = (0.0, false);
        self.drop_faded_out(cold);
        // A fade that has begun at this very moment is replaced.
        if self.running(cold).last().is_some_and(|fade| fade.age_secs == 0.0) {
            self.fades -= 1;
        }
        if usize::from(self.fades) == MAX_FADES {
            self.fold(cold);
        }
        cold.fades[usize::from(self.fades)] = Fade { age_secs: 0.0, duration_secs, towards };
        self.fades += 1;
    }
}
