use crate::goal::Range;
use crate::quintic::Quintic;
use crate::settle::settle;
use crate::{Clip, Jet, Pace, Wrap};
use std::sync::Arc;

/// One track of a clip as the motion of a control.
#[derive(Clone, Debug)]
pub(crate) struct ClipPath {
    clip: Arc<Clip>,
    /// Index among the clip's tracks.
    track: usize,
    clip_secs: f64,
    /// From the last state to rest: a clip may end at speed.
    tail: Quintic,
}

impl ClipPath {
    /// `None` if there is no such track.
    pub(crate) fn new(clip: &Arc<Clip>, track: usize, pace: Pace, range: Range) -> Option<Self> {
        let keys = clip.tracks().get(track)?;
        let last = keys.just_before(keys.end_secs());
        // A last step arrives at its value without having moved.
        let end = keys.at(keys.end_secs()).value;
        let tail = if last.is_rest() || last.value != end {
            Quintic::rest(end)
        } else {
            settle(last, end, pace.longest_secs.into(), range)
        };
        let clip_secs = if clip.wrap == Wrap::Once { keys.end_secs() } else { clip.duration_secs() };
        Some(Self { clip: Arc::clone(clip), track, clip_secs, tail })
    }

    pub(crate) fn at(&self, age_secs: f64) -> Jet {
        match self.clip.tracks().get(self.track) {
            Some(track) if self.clip.wrap != Wrap::Once => self.clip.wrap.at(track, self.clip_secs, age_secs),
            Some(track) if age_secs < self.clip_secs => track.at(age_secs),
            _ => self.tail.at(age_secs - self.clip_secs),
        }
    }

    pub(crate) fn duration_secs(&self) -> f64 {
        match self.clip.wrap {
            Wrap::Once => self.clip_secs + self.tail.duration_secs(),
            // A clip without duration has nothing to repeat.
            _ if self.clip_secs == 0.0 => 0.0,
            _ => f64::INFINITY,
        }
    }

    pub(crate) fn end(&self) -> f64 {
        self.tail.target
    }
}
