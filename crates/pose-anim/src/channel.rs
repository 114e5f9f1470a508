use crate::{Jet, quintic::Quintic};

/// How many fades may run one inside the other. Eight presses within one move of the head are more than fingers do;
/// what goes beyond is folded (see [`Channel`]).
const MAX_FADES: usize = 4;

/// The motion of one control.
///
/// A move is a closed function of the age of its parts, so that its state at a time does not depend on the steps that
/// led there. Its innermost part is a quintic `b(t)`. Where the quintic from the present state to the new target
/// would leave the range, the running motion goes on and is faded out instead:
///
/// ```text
/// x(t) = (1 − r(t)) · x_old(t) + r(t) · target        r: minimum-jerk step
/// ```
///
/// At the start `r = r' = r'' = 0`, so value, velocity and acceleration go on; at the end `r = 1, r' = r'' = 0`, so the
/// target is reached at rest; and a convex combination of values in a range is in the range.
///
/// `x_old` may itself be such a fade. When [`MAX_FADES`] are running and another one is needed, the two innermost parts
/// (the quintic and the first fade) are *folded*: a single quintic takes over from their present state. Where it comes to
/// rest does not matter, because it is about to fade out anyway; so place and time are free, and there always is a quintic that
/// stays in range: see [`settle`]. Whatever it changes in the further course is weighed down by the product of
/// all fades around it. That keeps C², the range, the arrival time and a fixed size, for any number of presses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    range: Range,
    /// Time since the last press of this control.
    elapsed_secs: f64,
    base: Quintic,
    /// Age of `base` at the last press.
    base_age_secs: f64,
    fades: [Fade; MAX_FADES],
    running: usize,
}

/// The values that a control may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) min: f64,
    pub(crate) max: f64,
}

impl Range {
    pub(crate) fn clamp(self, value: f64) -> f64 {
        value.max(self.min).min(self.max)
    }

    pub(crate) fn width(self) -> f64 {
        self.max - self.min
    }
}

#[derive(Clone, Copy, Debug)]
struct Fade {
    /// Age at the last press.
    age_secs: f64,
    duration_secs: f64,
    target: f64,
}

impl Fade {
    const NONE: Self = Self { age_secs: 0.0, duration_secs: 0.0, target: 0.0 };
}

impl Channel {
    pub(crate) fn rest(range: Range, value: f64) -> Self {
        Self {
            range,
            elapsed_secs: 0.0,
            base: Quintic::rest(value),
            base_age_secs: 0.0,
            fades: [Fade::NONE; MAX_FADES],
            running: 0,
        }
    }

    pub(crate) fn range(&self) -> Range {
        self.range
    }

    pub(crate) fn target(&self) -> f64 {
        match self.running.checked_sub(1) {
            Some(last) => self.fades[last].target,
            None => self.base.target,
        }
    }

    pub(crate) fn is_at_rest(&self) -> bool {
        self.remaining_secs() == 0.0
    }

    /// Time until the target is reached.
    pub(crate) fn remaining_secs(&self) -> f64 {
        match self.running.checked_sub(1) {
            Some(last) => {
                let fade = &self.fades[last];
                (fade.duration_secs - (fade.age_secs + self.elapsed_secs)).max(0.0)
            }
            None => self.base.remaining_secs(self.base_age_secs + self.elapsed_secs),
        }
    }

    pub(crate) fn advance(&mut self, dt_secs: f64) {
        self.elapsed_secs += dt_secs;
        if self.is_at_rest() {
            *self = Self::rest(self.range, self.target());
        }
    }

    /// State at this moment, in range.
    pub(crate) fn state(&self) -> Jet {
        let state = self.inner_state(self.running);
        Jet { value: self.range.clamp(state.value), ..state }
    }

    /// State of the base with its `fades` innermost fades.
    fn inner_state(&self, fades: usize) -> Jet {
        let mut state = self.base.at(self.base_age_secs + self.elapsed_secs);
        for fade in &self.fades[..fades] {
            let share = Jet::step(fade.age_secs + self.elapsed_secs, fade.duration_secs);
            state = state.mix(Jet::rest(fade.target), share);
        }
        state
    }

    /// Heads for `target` (in range) from the present state, to arrive after `duration_secs` (greater than 0).
    pub(crate) fn press(&mut self, target: f64, duration_secs: f64) {
        let state = self.state();
        if state == Jet::rest(target) && self.is_at_rest() {
            *self = Self::rest(self.range, target);
            return;
        }
        let direct = Quintic::new(state, target, duration_secs);
        if direct.stays_within(self.range.min, self.range.max) {
            *self = Self { base: direct, ..Self::rest(self.range, target) };
            return;
        }
        self.base_age_secs += self.elapsed_secs;
        self.fades[..self.running].iter_mut().for_each(|fade| fade.age_secs += self.elapsed_secs);
        self.elapsed_secs = 0.0;
        self.drop_faded_out();
        if self.running == MAX_FADES {
            self.fold();
        }
        self.fades[self.running] = Fade { age_secs: 0.0, duration_secs, target };
        self.running += 1;
    }

    /// Removes the parts that no longer have any weight: everything inside a fade that is over, and a fade that has
    /// just begun (another press at the same moment replaces it).
    fn drop_faded_out(&mut self) {
        let over = self.fades[..self.running].iter().rposition(|fade| fade.age_secs >= fade.duration_secs);
        if let Some(over) = over {
            self.base = Quintic::rest(self.fades[over].target);
            self.fades.copy_within(over + 1..self.running, 0);
            self.running -= over + 1;
        }
        if self.running > 0 && self.fades[self.running - 1].age_secs == 0.0 {
            self.running -= 1;
        }
    }

    /// Replaces the base and the innermost fade by one quintic.
    fn fold(&mut self) {
        let inner = self.fades[0];
        let remaining_secs = inner.duration_secs - inner.age_secs;
        self.base = settle(self.inner_state(1), inner.target, remaining_secs, self.range);
        self.base_age_secs = 0.0;
        self.fades.copy_within(1.., 0);
        self.running -= 1;
    }
}

/// A quintic from `state` to rest anywhere in the range, that never leaves the range, as slow as possible.
///
/// It always exists: as the duration goes to 0, `v₀D` and `a₀D²` vanish and the quintic becomes the monotone
/// minimum-jerk step from `x₀` to its end, which is in range. The longest duration that works depends on how close to
/// an end of the range, and how fast, the state is. The ends tried are the target that the motion had, the place where the
/// least braking would stop it (the free end of a minimum-jerk move, `x₀ + v₀D/2 + a₀D²/12`), and points
/// throughout the range, because a state that is about to turn must be free to turn far.
///
/// Where a state is so close to the end of its range that no duration down to 2⁻⁴⁰ of the wanted one works, it is on the end
/// up to rounding, and then its velocity, which came from a motion in range, is as small; it is held there.
fn settle(state: Jet, target: f64, duration_secs: f64, range: Range) -> Quintic {
    let mut duration_secs = duration_secs;
    for _ in 0..40 {
        let braked =
            state.value + duration_secs * (state.velocity / 2.0 + state.acceleration * duration_secs / 12.0);
        let share = |share: f64| range.min + share * range.width();
        let ends =
            [target, range.clamp(braked), share(0.5), share(0.25), share(0.75), share(0.0), share(1.0)];
        for end in ends {
            let quintic = Quintic::new(state, end, duration_secs);
            if quintic.stays_within(range.min, range.max) {
                return quintic;
            }
        }
        duration_secs *= 0.5;
    }
    Quintic::rest(range.clamp(state.value))
}
