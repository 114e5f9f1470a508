use crate::Jet;
use crate::quintic::Quintic;
use crate::range::Range;

/// How often the wanted duration is halved: to about a ten-millionth.
const HALVINGS: i32 = 24;

/// A quintic from `state` to rest anywhere in the range, that never leaves the range, as slow as possible.
///
/// That one is found for the state of any motion that kept the range itself is tested, not proven. The reason
/// to expect it: as the duration `d` goes to 0, so do `v₀d` and `a₀d²`, and a quintic to an end nearby
/// overshoots by no more than a share of those. The longest duration that works depends on how close to an
/// end of the range, and how fast, the state is. The ends tried are the target that the motion had, the place
/// where the least braking would stop it (the free end of a minimum-jerk move, `x₀ + v₀d/2 + a₀d²/12`), and
/// points to both sides, because a state that is about to turn must be free to turn far; all the nearer, the
/// shorter the duration, or the way out would be a leap.
///
/// A transition function that overshoots on purpose may have taken the state out of the range. Then the range
/// is widened as far as needed, and a tenth of its width further.
///
/// Where none is found, the result rests at `state.value`, clamped to the range, so the velocity jumps. This
/// happens to a clip that ends at speed at the very end of its range; no test has found a motion in range to
/// which it happens.
pub(crate) fn brake(state: Jet, target: f64, duration_secs: f64, range: Range) -> Quintic {
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
    #[cfg(test)]
    tests::FALLBACKS.set(tests::FALLBACKS.get() + 1);
    Quintic::rest(range.clamp(state.value))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::cell::Cell;

    thread_local! {
        /// How often no quintic was found.
        pub(crate) static FALLBACKS: Cell<u32> = const { Cell::new(0) };
    }

    const RANGE: Range = Range { min: -2.0, max: 3.0 };

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5000))]

        /// From states of random motions in range a quintic is found that stays in range and begins with that
        /// state.
        #[test]
        fn a_motion_in_range_finds_a_way(
            from in -2.0f64..=3.0, to in prop_oneof![-2.0f64..=3.0, Just(-2.0), Just(3.0)],
            old_secs in 0.002f64..3.0, share in 0.001f64..0.999,
            target in -2.0f64..=3.0, secs in 0.001f64..10.0,
        ) {
            let state = Quintic::new(Jet::rest(from), to, old_secs).at(share * old_secs);
            let before = FALLBACKS.get();
            let found = brake(state, target, secs, RANGE);
            prop_assert_eq!(FALLBACKS.get(), before);
            let start = found.at(0.0);
            prop_assert!((start.value - state.value).abs() < 1e-12);
            // Rounding, of a way as long as the range in the time that the move takes.
            let rate = 1.0 / found.duration_secs();
            let (velocity, acceleration) = (state.velocity.abs(), state.acceleration.abs());
            let velocities = 1.0 + velocity + 5.0 * rate;
            let accelerations = 1.0 + acceleration + velocity * rate + 5.0 * rate * rate;
            prop_assert!((start.velocity - state.velocity).abs() < 1e-13 * velocities);
            prop_assert!((start.acceleration - state.acceleration).abs() < 1e-13 * accelerations);
            for step in 0..=400 {
                let value = found.at(f64::from(step) / 400.0 * found.duration_secs()).value;
                prop_assert!((-2.0 - 1e-11..=3.0 + 1e-11).contains(&value), "{}", value);
            }
        }
    }

    #[test]
    fn the_end_of_the_range_at_speed_is_held() {
        let before = FALLBACKS.get();
        let wall = Jet { value: 3.0, velocity: 1.0, acceleration: 0.0 };
        assert_eq!(brake(wall, 3.0, 0.4, RANGE).at(0.1), Jet::rest(3.0));
        assert_eq!(FALLBACKS.get(), before + 1);
    }
}
