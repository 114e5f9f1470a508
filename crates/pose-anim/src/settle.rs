use crate::Jet;
use crate::channel::{ROUNDING, Range};
use crate::quintic::Quintic;

/// A quintic from `state` to rest anywhere in the range, that never leaves the range, as slow as possible.
///
/// It always exists: as the duration goes to 0, `v₀D` and `a₀D²` vanish and the quintic becomes the monotone
/// minimum-jerk step from `x₀` to its end, which is in range. The longest duration that works depends on how close to
/// an end of the range, and how fast, the state is. The ends tried are the target that the motion had, the place where the
/// least braking would stop it (the free end of a minimum-jerk move, `x₀ + v₀D/2 + a₀D²/12`), and points
/// throughout the range, because a state that is about to turn must be free to turn far.
///
/// A transition function that overshoots on purpose may have taken the state out of the range. Then the range is widened as far as
/// needed, and a tenth of its width further.
///
/// Where a state is so close to the end of its range that no duration down to 2⁻⁴⁰ of the wanted one works, it is on the end
/// up to rounding, and then its velocity, which came from a motion in range, is as small; it is held there.
pub(crate) fn settle(state: Jet, target: f64, duration_secs: f64, range: Range) -> Quintic {
    let mut duration_secs = duration_secs;
    let range = if (range.clamp(state.value) - state.value).abs() > ROUNDING * range.width() {
        let margin = 0.1 * range.width();
        Range { min: range.min.min(state.value - margin), max: range.max.max(state.value + margin) }
    } else {
        range
    };
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
