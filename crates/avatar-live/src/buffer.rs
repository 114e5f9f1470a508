//! Frames that have come and wait for their time.

use crate::Frame;
use std::collections::VecDeque;

/// So many frames are kept, those that are over among them: half a second at 120 a second.
const FRAMES: usize = 64;
/// So many steps between frames are remembered.
const STEPS: usize = 16;
/// Longer than this is an interruption, and no loss of frames.
const INTERRUPTION_SECS: f64 = 2.0;

/// What became of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kept {
    /// It is the newest; before it, so many are missing.
    Newest { missing: u64 },
    /// It came behind newer ones, which makes one less missing.
    Between,
    /// It had come already.
    Twice,
    /// It is older than all that are kept.
    TooOld,
}

/// Frames in the order of the sender's time.
#[derive(Clone, Debug)]
pub(crate) struct Buffer {
    frames: VecDeque<(f64, Frame)>,
    steps: [f32; STEPS],
    step_count: usize,
}

impl Buffer {
    pub(crate) fn new() -> Self {
        Self { frames: VecDeque::with_capacity(FRAMES + 1), steps: [0.0; STEPS], step_count: 0 }
    }

    pub(crate) fn clear(&mut self) {
        self.frames.clear();
    }

    /// Seconds from one frame to the next, by the lower quartile of the last ones: lost frames make steps
    /// longer. `None` until there are four.
    pub(crate) fn period_secs(&self) -> Option<f64> {
        let count = self.step_count.min(STEPS);
        if count < 4 {
            return None;
        }
        let mut steps = self.steps;
        let steps = steps.get_mut(..count)?;
        Some(f64::from(*steps.select_nth_unstable_by(count / 4, f32::total_cmp).1))
    }

    pub(crate) fn keep(&mut self, secs: f64, frame: &Frame) -> Kept {
        // Times of one frame may be rounded on their way.
        const SAME: f64 = 1e-5;
        let newest = self.frames.back().map(|(newest, _)| *newest);
        if newest.is_none_or(|newest| secs > newest + SAME) {
            let mut missing = 0;
            if let Some(newest) = newest {
                let step = secs - newest;
                if step < INTERRUPTION_SECS {
                    let period = self.period_secs();
                    missing = period.map_or(0, |period| ((step / period).round() as u64).saturating_sub(1));
                    if let Some(slot) = self.steps.get_mut(self.step_count % STEPS) {
                        *slot = step as f32;
                    }
                    // Beyond twice as many only the remainder matters.
                    self.step_count =
                        if self.step_count + 1 >= 2 * STEPS { STEPS } else { self.step_count + 1 };
                }
            }
            if self.frames.len() >= FRAMES {
                self.frames.pop_front();
            }
            self.frames.push_back((secs, *frame));
            return Kept::Newest { missing };
        }
        let place = self.frames.partition_point(|(other, _)| *other < secs - SAME);
        match self.frames.get(place) {
            Some((other, _)) if (*other - secs).abs() <= SAME => Kept::Twice,
            _ if place == 0 => Kept::TooOld,
            _ => {
                if self.frames.len() >= FRAMES {
                    self.frames.pop_front();
                    self.frames.insert(place - 1, (secs, *frame));
                } else {
                    self.frames.insert(place, (secs, *frame));
                }
                Kept::Between
            }
        }
    }

    /// The first frame after a time.
    pub(crate) fn after(&self, secs: f64) -> Option<&(f64, Frame)> {
        self.frames.get(self.place_after(secs))
    }

    /// All frames after a time.
    pub(crate) fn all_after(&self, secs: f64) -> impl Iterator<Item = &Frame> {
        self.frames.range(self.place_after(secs)..).map(|(_, frame)| frame)
    }

    fn place_after(&self, secs: f64) -> usize {
        self.frames.partition_point(|(other, _)| *other <= secs + 1e-9)
    }

    pub(crate) fn newest(&self) -> Option<&(f64, Frame)> {
        self.frames.back()
    }

    /// The frames since a time.
    pub(crate) fn since(&self, secs: f64) -> impl Iterator<Item = &Frame> {
        self.frames.iter().filter(move |(other, _)| *other >= secs).map(|(_, frame)| frame)
    }
}
