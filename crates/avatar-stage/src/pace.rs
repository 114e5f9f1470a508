//! How much care frames get while something moves, by the time that they take.

/// How a frame in motion is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The shorter side of the picture has at most this many pixels; it is shown larger.
    pub shorter_side: u32,
    /// Whether lamps cast shadows.
    pub has_shadows: bool,
    /// The most strands of hair ([`HairDetail::draft`](avatar_render::HairDetail::draft)).
    pub strands: u32,
    /// Whether the light on natural skin and eyes is simplified as well ([`Shading::Plain`]).
    ///
    /// [`Shading::Plain`]: avatar_render::Shading::Plain
    pub is_plain: bool,
}

const fn step(shorter_side: u32, has_shadows: bool, strands: u32) -> Step {
    Step { shorter_side, has_shadows, strands, is_plain: false }
}

/// Chooses how frames in motion are drawn, so that they follow each other smoothly where drawing is slow. It
/// is told what frames took, and has no clock.
///
/// ```
/// use avatar_stage::Pace;
///
/// let mut pace = Pace::default();
/// for _ in 0..20 {
///     pace.note(pace.level(), 0.2); // seconds: five frames a second
/// }
/// assert_eq!(pace.level(), Pace::STEPS.len(), "the cheapest");
/// ```
///
/// Levels count from 0, the whole picture as it is at rest, to the number of [`Pace::STEPS`], the cheapest
/// one. What each takes is estimated: first by what they took on the machine that they were chosen on, then
/// by what they take here. Right after a change of level it is the level that is learnt; later, time that
/// grows or falls is the machine's, and all levels' with it. A level is left for a cheaper one when its
/// frames take too long, and for a finer one only where that one's are expected to take much less than they
/// may, so that the level does not go to and fro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    level: usize,
    /// Seconds that a frame of each level is expected to take.
    expected: [f64; LEVELS],
    /// Whether a level has been seen on this machine.
    is_known: [bool; LEVELS],
    /// Whether the others are expected to take what fits this machine.
    is_scaled: bool,
    /// Frames of this level since it was chosen, and how many it takes until a finer one is.
    frames: u32,
    patience: u32,
    /// Frames of the level before.
    seen: u32,
}

const LEVELS: usize = Pace::STEPS.len() + 1;
/// Seconds that a frame of each level takes on two cores in software, with a bob, at 1280 × 720 pixels.
const SECONDS: [f64; LEVELS] = [0.65, 0.15, 0.095, 0.068, 0.05, 0.036, 0.031, 0.025, 0.02];
/// The level of the first frame in motion.
const START: usize = 5;
/// A frame that takes longer asks for a cheaper level: 22 frames a second.
const TOO_LONG: f64 = 0.045;
/// What a finer level may take, and what a cheaper one has to come to.
const WANTED: f64 = 0.034;
/// What the present level takes at most where a finer one is tried that has never been seen here.
const IDLE: f64 = 0.018;
/// Frames after a change of level that tell of the level, not of the machine.
const LEARNING: u32 = 6;
/// Frames that a level is drawn at least before a finer one is chosen: at first, and at most. Twice as many
/// each time that a level turned out to be too slow.
const PATIENCE: u32 = 8;
const MOST_PATIENCE: u32 = 256;
/// Weight of a frame in the mean of the frames before it.
const WEIGHT: f64 = 0.4;
/// A frame counts as at most this many times what was expected: a moment of other work is no slower machine.
const SURPRISE: f64 = 2.0;

impl Default for Pace {
    fn default() -> Self {
        Self {
            level: START,
            expected: SECONDS,
            is_known: [false; LEVELS],
            is_scaled: false,
            frames: 0,
            patience: PATIENCE,
            seen: 0,
        }
    }
}

impl Pace {
    /// How frames are drawn at the levels from 1 on. Below the last a face would no longer read as one.
    pub const STEPS: [Step; 8] = [
        step(720, true, 4000),
        step(510, true, 3000),
        step(360, true, 2400),
        step(510, false, 3000),
        step(360, false, 2400),
        step(288, false, 2000),
        step(232, false, 1600),
        step(180, false, 1200),
    ];

    /// How the very first frame is drawn where all of what draws is still to be compiled, which takes longer
    /// than drawing: with the least of it.
    pub const FIRST: Step = Step { is_plain: true, ..step(288, false, 2000) };

    /// The level of the next frame.
    pub fn level(&self) -> usize {
        self.level
    }

    /// How the frames of a level are drawn; `None` for the whole picture.
    pub fn step(level: usize) -> Option<Step> {
        Some(*Self::STEPS.get(level.checked_sub(1)?)?)
    }

    /// Tells that a frame of a level took so many seconds from its beginning to its end, and chooses the
    /// level of the next. Times that are no positive numbers, and levels that do not exist, say nothing.
    pub fn note(&mut self, level: usize, secs: f64) {
        let (Some(expected), true) = (self.expected.get(level).copied(), secs > 0.0 && secs.is_finite())
        else {
            return;
        };
        if level != self.level {
            // A picture at rest, say.
            self.learn(level, secs);
        } else {
            self.frames = self.frames.saturating_add(1);
            if !self.is_known[level] || self.frames <= LEARNING {
                let is_new = !self.is_known[level];
                self.learn(level, secs);
                if !std::mem::replace(&mut self.is_scaled, true) {
                    let is_known = self.is_known;
                    self.scale(secs / expected, |level| !is_known[level]);
                } else if is_new && SURPRISE * secs < expected && self.seen < LEARNING {
                    // What was seen for a moment before was no slow machine, but other work.
                    self.scale(secs / expected, |other| other != level);
                }
            } else {
                let mean = expected + WEIGHT * (secs.min(SURPRISE * expected) - expected);
                self.scale(mean / expected, |_| true);
            }
        }
        self.choose();
    }

    /// A level takes as long as this, whatever the others take.
    fn learn(&mut self, level: usize, secs: f64) {
        let expected = &mut self.expected[level];
        *expected = match self.is_known[level] {
            true => *expected + WEIGHT * (secs.min(SURPRISE * *expected) - *expected),
            false => secs,
        };
        self.is_known[level] = true;
    }

    /// The machine is slower or faster than expected by this factor, as far as these levels go.
    fn scale(&mut self, factor: f64, concerns: impl Fn(usize) -> bool) {
        for (level, expected) in self.expected.iter_mut().enumerate() {
            if concerns(level) {
                *expected = (*expected * factor).clamp(1e-6, 1e3);
            }
        }
    }

    fn choose(&mut self) {
        let now = self.expected[self.level];
        let next = if now > TOO_LONG {
            (self.level + 1..LEVELS).find(|level| self.expected[*level] <= WANTED).unwrap_or(LEVELS - 1)
        } else if self.frames >= self.patience {
            let is_cheap = |level: &usize| self.expected[*level] <= WANTED;
            let tried = self.level.checked_sub(1).filter(|level| !self.is_known[*level] && now <= IDLE);
            (0..self.level).find(is_cheap).or(tried).unwrap_or(self.level)
        } else {
            self.level
        };
        if next > self.level {
            self.patience = (2 * self.patience).min(MOST_PATIENCE);
        }
        if next != self.level {
            (self.seen, self.level, self.frames) = (self.frames, next, 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Levels of frames on a machine that takes these seconds for each level; `noise` comes from `-1..1`.
    fn run(
        pace: &mut Pace,
        costs: [f64; LEVELS],
        frames: usize,
        mut noise: impl FnMut() -> f64,
    ) -> Vec<usize> {
        let frame = |_| {
            let level = pace.level();
            pace.note(level, costs[level] * (1.0 + noise()));
            level
        };
        (0..frames).map(frame).collect()
    }

    /// Numerical Recipes' generator; its upper bits.
    fn noise(mut bits: u32, size: f64) -> impl FnMut() -> f64 {
        move || {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            size * (f64::from(bits >> 8) / f64::from(1u32 << 23) - 1.0)
        }
    }

    fn changes(levels: &[usize]) -> usize {
        levels.windows(2).filter(|pair| pair[0] != pair[1]).count()
    }

    #[test]
    fn few_frames_are_enough_on_machines_of_any_speed() {
        for slower in [0.05, 0.2, 0.5, 1.0, 1.5, 2.5, 10.0] {
            let costs = SECONDS.map(|secs| secs * slower);
            let levels = run(&mut Pace::default(), costs, 200, || 0.0);
            let first = |secs| (0..LEVELS).find(|level| costs[*level] <= secs).unwrap_or(LEVELS - 1);
            // Too fine is mended at once, too coarse after the frames that patience asks for.
            let settled = if costs[START] > TOO_LONG { 1 } else { PATIENCE as usize };
            let level = levels[settled];
            assert!((first(TOO_LONG)..=first(WANTED)).contains(&level), "{slower}: {levels:?}");
            assert!(levels[settled..].iter().all(|later| *later == level), "{slower}: {levels:?}");
        }
    }

    #[test]
    fn a_machine_that_gets_busy_is_followed_and_forgiven() {
        let mut pace = Pace::default();
        let costs = SECONDS.map(|secs| 0.9 * secs);
        let quiet = run(&mut pace, costs, 60, || 0.0);
        let busy = run(&mut pace, costs.map(|secs| 3.0 * secs), 60, || 0.0);
        let again = run(&mut pace, costs, 60, || 0.0);
        assert_eq!(busy[12..], [LEVELS - 1; 48], "{busy:?}");
        assert_eq!(again[40..], quiet[40..], "{again:?}");
    }

    #[test]
    fn one_slow_frame_changes_nothing() {
        let mut pace = Pace::default();
        let before = run(&mut pace, SECONDS.map(|secs| 0.7 * secs), 50, || 0.0);
        let level = pace.level();
        pace.note(level, 0.4);
        let after = run(&mut pace, SECONDS.map(|secs| 0.7 * secs), 50, || 0.0);
        assert_eq!((before[49], changes(&after)), (level, 0), "{after:?}");
    }

    #[test]
    fn a_slow_first_frame_is_forgiven() {
        for slow in [0.1, 0.4, 3.0] {
            for frames in [1, 5] {
                let mut pace = Pace::default();
                let costs = SECONDS.map(|secs| 0.7 * secs);
                let undisturbed = run(&mut Pace::default(), costs, 400, || 0.0)[399];
                run(&mut pace, [slow; LEVELS], frames, || 0.0);
                let after = run(&mut pace, costs, 400, || 0.0);
                assert!(after[399].abs_diff(undisturbed) <= 1, "{slow}, {frames}: {after:?}");
            }
        }
    }

    #[test]
    fn a_whole_picture_that_is_fast_enough_is_drawn_in_motion_too() {
        let mut pace = Pace::default();
        pace.note(0, 0.012);
        let levels = run(&mut pace, [0.012; LEVELS], 30, || 0.0);
        assert_eq!(levels[PATIENCE as usize..], [0; 30 - PATIENCE as usize], "{levels:?}");
    }

    #[test]
    fn what_is_no_time_or_no_level_says_nothing() {
        let mut pace = Pace::default();
        for (level, secs) in
            [(5, f64::NAN), (5, -1.0), (5, 0.0), (5, f64::INFINITY), (LEVELS, 1.0), (usize::MAX, 1.0)]
        {
            pace.note(level, secs);
        }
        assert_eq!(pace, Pace::default());
        assert_eq!((Pace::step(0), Pace::step(LEVELS), Pace::step(usize::MAX)), (None, None, None));
        assert_eq!(Pace::step(LEVELS - 1), Some(Pace::STEPS[LEVELS - 2]));
    }

    proptest! {
        /// Whatever levels cost, as long as coarser ones do not cost more.
        #[test]
        fn the_level_settles_and_no_smoother_one_is_missed(
            first in 0.001f64..2.0, falls in proptest::array::uniform9(0.3f64..1.0), seed in any::<u32>(),
        ) {
            let mut cost = first;
            let costs = falls.map(|fall| {
                cost *= fall;
                cost
            });
            let mut pace = Pace::default();
            run(&mut pace, costs, 150, noise(seed, 0.12));
            let levels = run(&mut pace, costs, 300, noise(!seed, 0.12));
            // Seldom a finer one is tried: each time after twice as much patience, so four times at most in
            // so many frames, there and back.
            prop_assert!(changes(&levels) <= 8, "{costs:?}: {levels:?}");
            // Where any level is fast enough with room to spare, all frames but those of such trials are.
            if costs[LEVELS - 1] < 0.9 * WANTED {
                let slow = levels.iter().filter(|level| costs[**level] > 1.15 * TOO_LONG).count();
                prop_assert!(slow <= 4, "{costs:?}: {levels:?}");
            }
        }

        #[test]
        fn no_times_break_it(notes in proptest::collection::vec((0usize..LEVELS + 1, any::<f64>()), 0..60)) {
            let mut pace = Pace::default();
            for (level, secs) in notes {
                pace.note(level, secs);
                prop_assert!(pace.level() < LEVELS);
                prop_assert!(pace.expected.iter().all(|secs| secs.is_finite() && *secs > 0.0), "{pace:?}");
            }
        }
    }
}
