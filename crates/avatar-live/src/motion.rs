//! The motion of one sender's face: from frames at times to a smooth curve.

use crate::buffer::Buffer;
use crate::channel::{CHANNELS, channels};
use crate::lag::{Step, TwoLags};
use crate::{Calibration, Frame, OneEuro, Settings};

/// Weights that differ by less are the same, and the face rests.
const NEAR: f64 = 1e-5;
/// How fast the time of the frames may go by ours while it makes up for a change of the delay, as a share.
const HURRY: f64 = 0.1;
/// Seconds in which it would.
const CATCH_UP_SECS: f64 = 0.5;
/// A change larger than this is jumped.
const JUMP_SECS: f64 = 0.5;
/// The cutoff of the 1€ filter grows by this for each range that a channel passes in a second, in Hz.
const BETA: f64 = 4.0;
/// Angles of this many degrees count as much as a whole weight.
const DEGREES: f64 = 30.0;

/// A line from frame to frame, through a 1€ filter at each frame and two lags behind the line.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    /// Where the line comes from and goes to, and when, by the sender's clock.
    from: [f64; CHANNELS],
    to: [f64; CHANNELS],
    from_secs: f64,
    to_secs: f64,
    /// Where it is, by the sender's clock.
    play_secs: f64,
    filters: [OneEuro; CHANNELS],
    lags: [TwoLags; CHANNELS],
    has_begun: bool,
    pub(crate) calibration: Calibration,
}

impl Motion {
    pub(crate) fn new() -> Self {
        Self {
            from: [0.0; CHANNELS],
            to: [0.0; CHANNELS],
            from_secs: 0.0,
            to_secs: 0.0,
            play_secs: 0.0,
            filters: [OneEuro::default(); CHANNELS],
            lags: [TwoLags::default(); CHANNELS],
            has_begun: false,
            calibration: Calibration::default(),
        }
    }

    /// Forgets where it was: the next frame is taken as it is.
    pub(crate) fn restart(&mut self) {
        self.has_begun = false;
    }

    pub(crate) fn value(&self, channel: usize) -> f64 {
        self.lags.get(channel).map_or(0.0, TwoLags::value)
    }

    /// Whether it stays where it is until another frame comes: those that have come show the same face.
    pub(crate) fn rests(&self, buffer: &Buffer) -> bool {
        let is_over = self.play_secs >= self.to_secs;
        let mut line = self.from.iter().zip(&self.to).zip(&self.lags);
        line.all(|((from, to), lags)| lags.is_at(*to, NEAR) && (is_over || (from - to).abs() < NEAR))
            && buffer.all_after(self.to_secs).all(|frame| self.is_at(frame))
    }

    /// Whether the line ends at this frame.
    fn is_at(&self, frame: &Frame) -> bool {
        frame.iter().all(|(channel, value)| {
            let value = self.calibration.apply(channel, value);
            self.to.get(channel).is_some_and(|to| (value - to).abs() < NEAR)
        })
    }

    /// Goes on by some seconds, toward a time of the sender's clock.
    pub(crate) fn advance(&mut self, buffer: &Buffer, toward_secs: f64, dt_secs: f64, settings: &Settings) {
        if !self.has_begun {
            let Some((secs, frame)) = buffer.newest() else { return };
            self.begin(*secs, frame);
        }
        let behind = toward_secs - dt_secs - self.play_secs;
        if behind.abs() > JUMP_SECS {
            // The line goes on from where it is.
            self.from = self.now();
            self.to = self.from;
            self.play_secs = toward_secs - dt_secs;
            (self.from_secs, self.to_secs) = (self.play_secs, self.play_secs);
        }
        let pace = 1.0 + (behind / CATCH_UP_SECS).clamp(-HURRY, HURRY);
        let end_secs = self.play_secs + dt_secs * pace;
        let rate = 2.0 / settings.lag_secs.max(1e-4);
        // The buffer holds fewer frames than this, so the end is always reached.
        for _ in 0..256 {
            if self.play_secs >= self.to_secs {
                self.next_line(buffer, settings);
            }
            let until = if self.to_secs > self.play_secs { self.to_secs.min(end_secs) } else { end_secs };
            let step = Step::new(rate, (until - self.play_secs).max(0.0) / pace);
            let (start, end) = (self.share(self.play_secs), self.share(until));
            for ((lags, from), to) in self.lags.iter_mut().zip(&self.from).zip(&self.to) {
                lags.go(&step, from + (to - from) * start, from + (to - from) * end);
            }
            self.play_secs = until;
            if until >= end_secs {
                break;
            }
        }
    }

    fn begin(&mut self, secs: f64, frame: &Frame) {
        self.has_begun = true;
        for (channel, value) in frame.iter() {
            let value = self.calibration.apply(channel, value);
            if let (Some(to), Some(filter), Some(lags)) =
                (self.to.get_mut(channel), self.filters.get_mut(channel), self.lags.get_mut(channel))
            {
                *to = value;
                *lags = TwoLags::at(value);
                filter.rest_at(value);
            }
        }
        self.from = self.to;
        (self.from_secs, self.to_secs, self.play_secs) = (secs, secs, secs);
    }

    /// How much of the line has been gone through at a time.
    fn share(&self, secs: f64) -> f64 {
        match self.to_secs > self.from_secs {
            true => ((secs - self.from_secs) / (self.to_secs - self.from_secs)).clamp(0.0, 1.0),
            false => 1.0,
        }
    }

    /// Where the line is.
    fn now(&self) -> [f64; CHANNELS] {
        let share = self.share(self.play_secs);
        let mut now = self.from;
        for (now, to) in now.iter_mut().zip(&self.to) {
            *now += (to - *now) * share;
        }
        now
    }

    /// Begins the line to the next frame, if it has come.
    fn next_line(&mut self, buffer: &Buffer, settings: &Settings) {
        let Some((secs, frame)) = buffer.after(self.to_secs) else { return };
        let period = buffer.period_secs().unwrap_or(1.0 / 60.0).clamp(1e-3, 0.1);
        let dt_secs = secs - self.to_secs;
        self.from = self.now();
        self.from_secs = self.play_secs;
        // After a gap there is no time left until the frame; half of a step makes up for it in a few frames.
        self.to_secs = secs.max(self.play_secs + period / 2.0);
        let least = settings.smooth_secs.map(|secs| 1.0 / (std::f64::consts::TAU * secs.max(1e-4)));
        for (channel, value) in frame.iter() {
            let value = self.calibration.apply(channel, value);
            let is_angle = channels().get(channel).is_some_and(|channel| channel.min < 0.0);
            let beta = if is_angle { BETA / DEGREES } else { BETA };
            if let (Some(to), Some(filter)) = (self.to.get_mut(channel), self.filters.get_mut(channel)) {
                *to = match least {
                    Some(least) => filter.next(value, dt_secs, least, beta),
                    None => {
                        filter.rest_at(value);
                        value
                    }
                };
            }
        }
    }
}
