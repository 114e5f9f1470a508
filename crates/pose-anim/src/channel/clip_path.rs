use crate::brake::brake;
use crate::quintic::Quintic;
use crate::range::Range;
use crate::{Clip, Jet, Pace, Wrap};
use std::sync::Arc;

/// One track of a clip as the motion of a control.
///
/// Keys and cubics may lie beyond the control's range. There the motion rests at the range's end, so that all
/// that is made of it stays in range: fades, layers, the way to rest. Only what a transition function
/// overshoots on purpose goes through, as in a pose.
#[derive(Clone, Debug)]
pub(crate) struct ClipPath {
    clip: Arc<Clip>,
    /// Index among the clip's tracks.
    track: u32,
    /// Whether the track is kept in the control's range.
    confined: bool,
    clip_secs: f64,
    /// From the last state to rest: a clip may end at speed.
    tail: Quintic,
}

impl ClipPath {
    /// `None` if there is no such track.
    pub(crate) fn new(clip: &Arc<Clip>, track: usize, pace: Pace, range: Range) -> Option<Self> {
        let keys = clip.tracks().get(track)?;
        let confined = !keys.overshoots();
        let (last, end) = (keys.just_before(keys.end_secs()), keys.at(keys.end_secs()).value);
        let (last, end) = if confined { (range.confine(last), range.clamp(end)) } else { (last, end) };
        let tail = if jumps_or_rests(last, end, pace.longest_secs, range.width()) {
            Quintic::rest(end)
        } else {
            brake(Jet { value: end, ..last }, end, pace.longest_secs, range)
        };
        let clip_secs = if clip.wrap == Wrap::Once { keys.end_secs() } else { clip.duration_secs() };
        Some(Self { clip: Arc::clone(clip), track: u32::try_from(track).ok()?, confined, clip_secs, tail })
    }

    /// The clip that the track is one of.
    pub(crate) fn clip(&self) -> &Arc<Clip> {
        &self.clip
    }

    /// Seconds after which the motion repeats itself; `None` if it does not.
    pub(crate) fn period_secs(&self) -> Option<f64> {
        let period_secs = match self.clip.wrap {
            Wrap::Once => return None,
            Wrap::Loop => self.clip_secs,
            Wrap::PingPong => 2.0 * self.clip_secs,
        };
        (period_secs > 0.0).then_some(period_secs)
    }

    pub(crate) fn at(&self, age_secs: f64, range: Range) -> Jet {
        let state = match self.clip.tracks().get(self.track as usize) {
            Some(track) if self.clip.wrap != Wrap::Once => self.clip.wrap.at(track, self.clip_secs, age_secs),
            Some(track) if age_secs < self.clip_secs => track.at(age_secs),
            _ => return self.tail.at(age_secs - self.clip_secs),
        };
        if self.confined { range.confine(state) } else { state }
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

/// Whether nothing is left to be braked at the end of a track: it jumps to its last value (two keys at one
/// time), or it rests. Both are decided up to rounding: a span ends at `a + (b − a)`, which is `b` to an ulp
/// only, and with slopes that cancel to about as much.
fn jumps_or_rests(last: Jet, end: f64, secs: f64, width: f64) -> bool {
    let none = 1e-9 * width;
    (last.value - end).abs() > none
        || ((last.velocity * secs).abs() <= none && (last.acceleration * secs * secs).abs() <= none)
}
