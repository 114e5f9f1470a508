use crate::Jet;
use crate::goal::Range;
use crate::quintic::Quintic;

/// How often the wanted duration is halved: to about a ten-millionth.
const HALVINGS: i32 = 24;

/// A quintic from `state` to rest anywhere in the range, that never leaves the range, as slow as possible.
///
/// It always exists where there is room: as the duration `d` goes to 0, so do `v₀d` and `a₀d²`, and the quintic to an end
/// nearby overshoots by no more than a share of those. The longest duration that works depends on how close to an end of
/// the range, and how fast, the state is. The ends tried are the target that the motion had, the place where the least braking
/// would stop it (the free end of a minimum-jerk move, `x₀ + v₀d/2 + a₀d²/12`), and points to both sides, because a state
/// that is about to turn must be free to turn far; all the nearer, the shorter the duration, or the way out would
/// be a leap.
///
/// A transition function that overshoots on purpose may have taken the state out of the range. Then the range is widened as far as
/// needed, and a tenth of its width further.
///
/// What finds no way runs against the very end of its range. A motion in range never does; a clip may end so. It is held there.
pub(crate) fn settle(state: Jet, target: f64, duration_secs: f64, range: Range) -> Quintic {
    let range = if !range.holds(state.value) {
        let margin = 0.1 * range.width();
        Range { min: range.min.min(state.value - margin), max: range.max.max(state.value + margin) }
    } else {
        range
    };
    let fits = |end: f64, secs: f64| {
        let quintic = Quintic::new(state, range.clamp(end), secs);
        quintic.stays_within(range.min, range.max).then_some(quintic)
    };
    if let Some(quintic) = fits(target, duration_secs) {
        return quintic;
    }
    for halving in 0..HALVINGS {
        let share = 0.5f64.powi(halving);
        let secs = share * duration_secs;
        let braked = state.value + secs * (state.velocity / 2.0 + state.acceleration * secs / 12.0);
        let reach = share * range.width();
        let sides = [0.25, -0.25, 0.5, -0.5, 1.0, -1.0].map(|side| state.value + side * reach);
        let found = [braked].into_iter().chain(sides).find_map(|end| fits(end, secs));
        if let Some(quintic) = found {
            return quintic;
        }
    }
    Quintic::rest(range.clamp(state.value))
}
