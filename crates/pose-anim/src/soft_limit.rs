use crate::Jet;
use crate::jet::minimum_jerk;
use crate::range::Range;

/// Share of the range that counts as close to one of its ends.
const KNEE: f64 = 0.05;

/// `base + offset`, kept in the range smoothly: twice continuously differentiable in both, for a base in
/// range. Without an offset it is the base to the last bit.
///
/// A plain clamp would make velocities jump whenever a sum comes to an end of the range. Here, the room `up`
/// to the upper and `down` to the lower end shape the offset `δ`, where `r` is the minimum-jerk step, `k` the
/// knee (5 % of the range), and, for `δ > 0`,
///
/// ```text
/// result = base + up · f( r(up/k) · δ' / up )        δ' = δ · (1 − (1 − r(down/k)) · (1 − r(δ/k)))
/// f(u) = u                       for u ≤ ½           f' = 1
///        ½ + w − w³ + w⁴/2       for w = u − ½ ≤ 1   f' = 1 − 3w² + 2w³
///        1                       beyond
/// ```
///
/// and for `δ < 0` the mirror image. So the sum is plain where both ends are far: within half of the room, no
/// closer to an end than the knee. It reaches an end for offsets of 1½ times the room. With the base at an
/// end, say the lower one, an offset that points outward has no effect, so one that points inward must set in
/// gently (`δ'`), or the change between the two would be a corner.
///
/// Both sides have the slope `r(up/k) · r(down/k)` at `δ = 0` and no curvature there, as `δ · r(δ/k)` is of
/// fourth order; `f` is C² by its construction; and as `up → 0`, the argument of `f` tends to 0 like `up²`,
/// so that the result tends to `r(up/k) · δ'`.
///
/// A base that is out of range (a transition function that overshoots on purpose) is not pushed further out,
/// and an offset that points inward acts as at the end of the range: all of the above tends to that as the
/// base comes to the end, so this is C², too.
pub(crate) fn soft_limit(base: Jet, offset: Jet, range: Range) -> Jet {
    if offset == Jet::rest(0.0) || range.width() <= 0.0 {
        return base;
    }
    let (up, down) = (Jet::rest(range.max) - base, base - Jet::rest(range.min));
    let knee = KNEE * range.width();
    let (room, back, delta, sign) =
        if offset.value >= 0.0 { (up, down, offset, 1.0) } else { (down, up, Jet::rest(0.0) - offset, -1.0) };
    if room.value <= 1e-9 * range.width() {
        // The offset has no effect beyond rounding, and a division by 0 would make NaN of it.
        return base;
    }
    let one = Jet::rest(1.0);
    let gentle = one - (one - smooth(back, knee)) * (one - smooth(delta, knee));
    let wanted = smooth(room, knee) * delta * gentle;
    let kept = room * saturate(wanted * inverse(room));
    base + Jet::rest(sign) * kept
}

/// How layers add, for numbers without derivatives and layers of another kind than players: `base +
/// offset`, bent where it would leave `min` to `max`, twice continuously differentiable in both. An offset
/// of 0 leaves the base as it is, to the last bit. Where a number is NaN, so is the result.
///
/// ```
/// use pose_anim::soft_sum;
/// assert_eq!(soft_sum(0.5, 0.2, 0.0, 2.0), 0.7);
/// assert_eq!(soft_sum(1.5, 4.0, 0.0, 2.0), 2.0);
/// ```
pub fn soft_sum(base: f64, offset: f64, min: f64, max: f64) -> f64 {
    let width = max - min;
    if offset == 0.0 || width <= 0.0 {
        return base;
    }
    let (up, down) = (max - base, base - min);
    let (room, back) = if offset > 0.0 { (up, down) } else { (down, up) };
    let knee = KNEE * width;
    if back >= knee && room >= knee && 2.0 * offset.abs() <= room {
        return base + offset;
    }
    // As `soft_limit`, whose derivatives would cost three times as much.
    if room <= 1e-9 * width {
        return base;
    }
    let delta = offset.abs();
    let gentle = 1.0 - (1.0 - minimum_jerk(back / knee)) * (1.0 - minimum_jerk(delta / knee));
    let u = minimum_jerk(room / knee) * delta * gentle / room;
    let kept = match u - 0.5 {
        w if w <= 0.0 => u,
        w if w >= 1.0 => 1.0,
        w => 0.5 + w * (1.0 - w * w * (1.0 - 0.5 * w)),
    };
    base + (room * kept).copysign(offset)
}

/// `r(x / width)`.
fn smooth(x: Jet, width: f64) -> Jet {
    // The step as a function of x, by the chain rule with the derivatives of x in time.
    let step = Jet::step(x.value, width);
    x.through(step)
}

fn saturate(u: Jet) -> Jet {
    let w = u.value - 0.5;
    let f = match w {
        w if w <= 0.0 => return u,
        w if w >= 1.0 => Jet::rest(1.0),
        w => Jet {
            value: 0.5 + w * (1.0 - w * w * (1.0 - 0.5 * w)),
            velocity: 1.0 - w * w * (3.0 - 2.0 * w),
            acceleration: -6.0 * w * (1.0 - w),
        },
    };
    u.through(f)
}

/// `1 / x` for positive x.
fn inverse(x: Jet) -> Jet {
    let r = 1.0 / x.value;
    x.through(Jet { value: r, velocity: -r * r, acceleration: 2.0 * r * r * r })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RANGE: Range = Range { min: -2.0, max: 3.0 };

    fn plain(base: f64, offset: f64) -> f64 {
        soft_limit(Jet::rest(base), Jet::rest(offset), RANGE).value
    }

    #[test]
    fn plain_sums_and_ends() {
        assert_eq!(plain(0.5, 1.0), 1.5);
        assert_eq!(plain(0.5, -1.0), -0.5);
        assert_eq!(plain(3.0, 7.0), 3.0);
        assert_eq!(plain(-2.0, -7.0), -2.0);
        assert_eq!(plain(-2.0, 1.0), -1.0);
        assert_eq!(plain(0.5, 5.0), 3.0);
    }

    #[test]
    fn sums_of_numbers_are_those_of_states() {
        for base in [-2.5, -2.0, -1.9, -1.0, 0.5, 2.5, 2.9, 3.0, 3.5] {
            for offset in [-7.0, -1.0, -0.1, 0.0, 0.1, 0.6, 2.0, 9.0] {
                let sum = soft_sum(base, offset, RANGE.min, RANGE.max);
                assert!((sum - plain(base, offset)).abs() < 1e-12, "{base} {offset} {sum}");
            }
        }
    }

    #[test]
    fn a_base_out_of_range_is_not_pushed_further_out() {
        assert_eq!((plain(3.5, 1.0), plain(-2.5, -1.0)), (3.5, -2.5));
        assert_eq!((plain(3.5, -1.0), plain(-2.5, 1.0)), (2.5, -1.5));
    }

    proptest! {
        /// Through the ends of the range and beyond, along a line, the sum is twice continuously
        /// differentiable: no change of its jet that does not fall with the step.
        #[test]
        fn it_is_smooth_through_the_ends(
            end in prop_oneof![Just(-2.0f64), Just(3.0)],
            speed in prop_oneof![0.2f64..2.0, -2.0f64..-0.2],
            offset in prop_oneof![-3.0f64..3.0, -0.2f64..0.2],
        ) {
            let at = |t: f64| {
                let base = Jet { value: end + speed * t, velocity: speed, acceleration: 0.0 };
                let sum = soft_limit(base, Jet::rest(offset), RANGE);
                [sum.value, sum.velocity, sum.acceleration]
            };
            for part in 0..3 {
                let change = |h: f64| (at(h)[part] - at(-h)[part]).abs();
                // The third derivative of the step is 60 over the cubed knee at its start; there is one at
                // either side.
                let jerk = 60.0 / (KNEE * RANGE.width()).powi(3) * offset.abs() * speed.abs().powi(3);
                let slope = speed.abs() * [1.0, 0.0, 0.0][part] + jerk;
                prop_assert!(change(1e-6) < 3e-6 * slope + 1e-9, "{part}: {}", change(1e-6));
            }
        }

        /// An offset that goes through 0, with the base at an end of the range, near one and far from both.
        #[test]
        fn it_is_smooth_where_the_offset_turns(
            base in prop_oneof![Just(-2.0f64), Just(3.0), -2.0f64..-1.8, 2.8f64..3.0, -2.0f64..=3.0],
            speed in prop_oneof![0.2f64..2.0, -2.0f64..-0.2],
        ) {
            let at = |t: f64| {
                let offset = Jet { value: speed * t, velocity: speed, acceleration: 0.0 };
                let sum = soft_limit(Jet::rest(base), offset, RANGE);
                [sum.value, sum.velocity, sum.acceleration]
            };
            for part in 0..3 {
                let change = (at(1e-6)[part] - at(-1e-6)[part]).abs();
                // The gentle start is of fourth order, `10 δ⁴ / k³`: a fourth derivative of 240 / k³, and no
                // third.
                let snap = 240.0 / (KNEE * RANGE.width()).powi(3) * speed.abs().powi(4);
                let slope = [speed.abs(), 1e-6, 1e-6][part];
                prop_assert!(change < 2e-6 * slope + 1e-12 * snap + 1e-12, "{part}: {change}");
            }
        }

        #[test]
        fn stays_in_range_and_has_its_derivatives(
            base in prop_oneof![-2.0f64..=3.0, Just(-2.0), Just(3.0), -2.0f64..-1.95, 2.95f64..3.0],
            offset in prop_oneof![-8.0f64..8.0, -0.3f64..0.3, -1e-3f64..1e-3],
            rates in prop::array::uniform4(-1.0f64..1.0),
        ) {
            let slack = 1e-12 * RANGE.width();
            prop_assert!((RANGE.min - slack..=RANGE.max + slack).contains(&plain(base, offset)));
            // Along parabolas that stay in range near this moment.
            let inward = if base > 0.5 { -1.0 } else { 1.0 };
            let at = |t: f64| {
                let margin = 1e-4;
                let x = base + inward * (margin + rates[0].abs() * t * t + 0.01 * t * rates[0]);
                let x = Jet { value: x, velocity: inward * (2.0 * rates[0].abs() * t + 0.01 * rates[0]), acceleration: inward * 2.0 * rates[0].abs() };
                let d = Jet { value: offset + rates[1] * t + rates[2] * t * t, velocity: rates[1] + 2.0 * rates[2] * t, acceleration: 2.0 * rates[2] };
                soft_limit(x, d, RANGE)
            };
            let h = 1e-6;
            let (before, here, after) = (at(-h), at(0.0), at(h));
            let slope = (after.value - before.value) / (2.0 * h);
            let curve = (after.velocity - before.velocity) / (2.0 * h);
            prop_assert!((slope - here.velocity).abs() < 1e-4 * (1.0 + slope.abs()), "{slope} {here:?}");
            prop_assert!((curve - here.acceleration).abs() < 1e-2 * (1.0 + curve.abs()), "{curve} {here:?}");
        }
    }
}
