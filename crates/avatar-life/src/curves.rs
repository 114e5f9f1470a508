//! Curves of time that are twice continuously differentiable: steps, saccades, and what follows a goal.

/// The minimum-jerk step (Flash & Hogan 1985): from 0 to 1, at rest at both ends.
pub(crate) fn step(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// The way of a saccade from 0 to 1 whose peak speed is `peak` times its mean one (1 to 2): speed rises along
/// `3u² − 2u³`, stays, and falls in the same way. Rise and fall together take `2 (1 − 1/peak)` of the time.
/// The rise is the shorter one, as in large saccades (Van Opstal & Van Gisbergen 1987).
pub(crate) fn saccade(s: f64, peak: f64) -> f64 {
    let both = 2.0 * (1.0 - 1.0 / peak);
    let (rise, fall) = (0.4 * both, 0.6 * both);
    // The integral of `3u² − 2u³`.
    let ramp = |u: f64| u * u * u * (1.0 - 0.5 * u);
    match s {
        s if s <= 0.0 => 0.0,
        s if s >= 1.0 => 1.0,
        s if s < rise => peak * rise * ramp(s / rise),
        s if s > 1.0 - fall => 1.0 - peak * fall * ramp((1.0 - s) / fall),
        s => peak * (s - 0.5 * rise),
    }
}

/// What is positive of x: 0 up to `-width`, x from `width` on, and between them a curve with continuous
/// second derivatives. What it gives for x and for −x differs by x.
pub(crate) fn positive(x: f64, width: f64) -> f64 {
    let s = 0.5 * (x / width + 1.0);
    match s {
        s if s <= 0.0 => 0.0,
        s if s >= 1.0 => x,
        s => 2.0 * width * s * s * s * (1.0 - 0.5 * s),
    }
}

/// The weights of a cubic B-spline's four neighbours, `u` of the way from the second to the third.
pub(crate) fn spline(u: f64) -> [f64; 4] {
    let v = 1.0 - u;
    let (u2, u3) = (u * u, u * u * u);
    [v * v * v / 6.0, (4.0 - 6.0 * u2 + 3.0 * u3) / 6.0, (1.0 + 3.0 * (u + u2 - u3)) / 6.0, u3 / 6.0]
}

/// What is left of a distance after so many time constants counts as nothing: `e⁻³⁶ · 36²` is 3e-13.
const SETTLED: f64 = 36.0;

/// Numbers that follow a goal as three equal low passes in a row do: `(d/dt + rate)³ (y − goal) = 0`.
///
/// The goal may jump at any time, and may move steadily; the numbers stay twice continuously differentiable,
/// and are given by a formula for every moment, so that the steps in which they are asked for do not matter.
/// From a still start they never leave the range of goals that stand still.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Follow<const N: usize> {
    rate: f64,
    since: f64,
    goal: [f64; N],
    speed: [f64; N],
    /// `y − goal = e^(−rate τ) (c₀ + c₁ τ + c₂ τ²)`, where τ is the time since `since`.
    rest: [[f64; 3]; N],
    is_exact: bool,
}

impl<const N: usize> Follow<N> {
    /// At its goal.
    pub(crate) fn at(goal: [f64; N], speed: [f64; N], rate: f64, now: f64) -> Self {
        Self { rate, since: now, goal, speed, rest: [[0.0; 3]; N], is_exact: true }
    }

    pub(crate) fn goal(&self, now: f64) -> [f64; N] {
        std::array::from_fn(|i| self.goal[i] + self.speed[i] * (now - self.since))
    }

    pub(crate) fn speed(&self) -> [f64; N] {
        self.speed
    }

    /// Whether it stands still at its goal.
    pub(crate) fn is_still(&self) -> bool {
        self.is_exact && self.speed == [0.0; N]
    }

    pub(crate) fn value(&self, now: f64) -> [f64; N] {
        let tau = now - self.since;
        if self.is_exact || self.rate * tau > SETTLED {
            return self.goal(now);
        }
        let fade = libm::exp(-self.rate * tau);
        std::array::from_fn(|i| {
            let [c0, c1, c2] = self.rest[i];
            self.goal[i] + self.speed[i] * tau + fade * (c0 + tau * (c1 + tau * c2))
        })
    }

    /// Takes another goal from now on.
    pub(crate) fn lead(&mut self, goal: [f64; N], speed: [f64; N], now: f64) {
        let tau = now - self.since;
        let k = self.rate;
        let fade = if self.is_exact || k * tau > SETTLED { 0.0 } else { libm::exp(-k * tau) };
        let before = self.goal(now);
        for i in 0..N {
            let [c0, c1, c2] = self.rest[i];
            let (f, df, ddf) = (c0 + tau * (c1 + tau * c2), c1 + 2.0 * tau * c2, 2.0 * c2);
            let distance = before[i] - goal[i] + fade * f;
            let velocity = self.speed[i] - speed[i] + fade * (df - k * f);
            let acceleration = fade * (ddf - 2.0 * k * df + k * k * f);
            self.rest[i] = [
                distance,
                velocity + k * distance,
                0.5 * (acceleration + 2.0 * k * velocity + k * k * distance),
            ];
        }
        (self.goal, self.speed, self.since) = (goal, speed, now);
        self.is_exact = self.rest == [[0.0; 3]; N];
    }

    /// Forgets what is left of the way where that is nothing. To be called now and then.
    pub(crate) fn settle(&mut self, now: f64) {
        if !self.is_exact && self.rate * (now - self.since) > SETTLED {
            self.rest = [[0.0; 3]; N];
            self.is_exact = true;
        }
    }
}

/// How many steps of a [`Steps`] may be on their way at once.
const MOST: usize = 8;

/// A number of each of N axes that changes by steps, which add up where they overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps<const N: usize> {
    base: [f64; N],
    steps: [Step<N>; MOST],
    count: usize,
}

#[derive(Clone, Copy, Debug)]
struct Step<const N: usize> {
    start: f64,
    secs: f64,
    by: [f64; N],
}

impl<const N: usize> Steps<N> {
    pub(crate) fn new() -> Self {
        let none = Step { start: 0.0, secs: 1.0, by: [0.0; N] };
        Self { base: [0.0; N], steps: [none; MOST], count: 0 }
    }

    fn active(&self) -> &[Step<N>] {
        &self.steps[..self.count]
    }

    pub(crate) fn value(&self, now: f64) -> [f64; N] {
        let mut sum = self.base;
        for Step { start, secs, by } in self.active() {
            let share = step((now - start) / secs);
            for (sum, by) in sum.iter_mut().zip(by) {
                *sum += share * by;
            }
        }
        sum
    }

    /// Where all steps end.
    pub(crate) fn target(&self) -> [f64; N] {
        let mut sum = self.base;
        for one in self.active() {
            for (sum, by) in sum.iter_mut().zip(&one.by) {
                *sum += by;
            }
        }
        sum
    }

    /// Starts a step; not where too many are on their way. Steps that have ended by `now` become one number.
    pub(crate) fn add(&mut self, now: f64, start: f64, secs: f64, by: [f64; N]) -> bool {
        let mut kept = 0;
        for at in 0..self.count {
            let one = self.steps[at];
            if now >= one.start + one.secs {
                for (base, by) in self.base.iter_mut().zip(&one.by) {
                    *base += by;
                }
            } else {
                self.steps[kept] = one;
                kept += 1;
            }
        }
        self.count = kept;
        let is_free = kept < MOST;
        if is_free {
            self.steps[kept] = Step { start, secs, by };
            self.count += 1;
        }
        is_free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Value, slope and curvature on both sides of every seam, by differences.
    fn jumps(f: impl Fn(f64) -> f64, seam: f64) -> [f64; 2] {
        let h = 1e-5;
        let slope = |at: f64| (f(at + h) - f(at - h)) / (2.0 * h);
        let curve = |at: f64| (f(at + h) - 2.0 * f(at) + f(at - h)) / (h * h);
        [
            (slope(seam + 2.0 * h) - slope(seam - 2.0 * h)).abs(),
            (curve(seam + 2.0 * h) - curve(seam - 2.0 * h)).abs(),
        ]
    }

    #[test]
    fn seams_are_smooth() {
        for seam in [0.0, 1.0] {
            let [slope, curve] = jumps(step, seam);
            assert!(slope < 1e-6 && curve < 1e-2, "step at {seam}: {slope} {curve}");
        }
        for peak in [1.3, 1.5, 1.8, 2.0] {
            let both = 2.0 * (1.0 - 1.0 / peak);
            for seam in [0.0, 0.4 * both, 1.0 - 0.6 * both, 1.0] {
                let [slope, curve] = jumps(|s| saccade(s, peak), seam);
                assert!(slope < 1e-3 && curve < 2e-2, "saccade {peak} at {seam}: {slope} {curve}");
            }
        }
        for seam in [-0.5, 0.5] {
            let [slope, curve] = jumps(|x| positive(x, 0.5), seam);
            assert!(slope < 1e-3 && curve < 1e-2, "positive at {seam}: {slope} {curve}");
        }
    }

    #[test]
    fn a_saccade_has_the_peak_that_is_asked_for() {
        for peak in [1.3, 1.5, 1.8, 2.0] {
            assert_eq!((saccade(0.0, peak), saccade(1.0, peak)), (0.0, 1.0));
            let speed = |at: f64| (saccade(at + 1e-4, peak) - saccade(at - 1e-4, peak)) / 2e-4;
            let fastest = (1..1000).map(|at| speed(f64::from(at) / 1000.0)).fold(0.0, f64::max);
            assert!((fastest - peak).abs() < 1e-6, "{fastest} {peak}");
        }
    }

    #[test]
    fn the_positive_part_and_that_of_the_opposite_differ_by_the_number() {
        for x in [-3.0, -0.7, -0.2, 0.0, 0.1, 0.5, 2.0] {
            let difference = positive(x, 0.8) - positive(-x, 0.8);
            assert!((difference - x).abs() < 1e-12, "{x} {difference}");
        }
    }

    /// The formula against the differential equation, by small steps of three low passes.
    #[test]
    fn following_is_three_low_passes() {
        let mut follow = Follow::at([1.0], [0.0], 5.0, 2.0);
        let mut low = [1.0f64; 3];
        let (h, mut now) = (1e-5, 2.0);
        for goal in [3.0, -1.0, 0.5] {
            follow.lead([goal], [0.0], now);
            for _ in 0..30_000 {
                let [a, b, c] = low;
                low = [a + h * 5.0 * (goal - a), b + h * 5.0 * (a - b), c + h * 5.0 * (b - c)];
                now += h;
            }
            let [value] = follow.value(now);
            assert!((value - low[2]).abs() < 1e-4, "{value} {}", low[2]);
        }
    }

    #[test]
    fn what_moves_steadily_is_followed_without_delay() {
        let mut follow = Follow::at([0.0], [0.0], 20.0, 0.0);
        follow.lead([1.0], [3.0], 0.5);
        let [value] = follow.value(2.5);
        assert!((value - 7.0).abs() < 1e-12, "{value}");
    }
}
