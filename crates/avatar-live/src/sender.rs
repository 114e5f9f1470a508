//! One sender: what it has sent, how well it arrives, and its face.

use crate::buffer::{Buffer, Kept};
use crate::channel::CHANNELS;
use crate::clock::Clock;
use crate::lag::{Step, ThreeLags};
use crate::motion::Motion;
use crate::{Frame, MediaPipeReader, Protocol, Settings, Vmc};
use core::net::SocketAddr;

/// So many latenesses are remembered.
const LATENESSES: usize = 64;
/// The delay is enough for all but so many of them.
const TOO_LATE: usize = 2;
/// A time that is so far from where it should be is one of another clock.
const OTHER_CLOCK_SECS: f64 = 5.0;
/// A share that cannot be seen, and one that is rounded away.
pub(crate) const UNSEEN: f64 = 1e-5;
const NOTHING: f64 = 1e-9;
/// Names are shown no longer than this, in characters.
const NAME_LENGTH: usize = 48;
/// Seconds over which the rate of frames is taken.
const RATE_SECS: f64 = 1.0;

/// How a sender is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Status<'a> {
    /// What it calls itself; without a name of its own, its protocol and address.
    pub name: &'a str,
    /// What it speaks.
    pub protocol: Protocol,
    /// Where its packets come from.
    pub origin: SocketAddr,
    /// Whether the face follows it.
    pub is_chosen: bool,
    /// Whether it sends, and sees a face.
    pub is_live: bool,
    /// Frames a second, of late.
    pub rate_hz: f64,
    /// Frames that came.
    pub received: u64,
    /// Frames that did not come, by the sender's times; 0 for senders without a clock.
    pub lost: u64,
    /// Frames that came behind newer ones.
    pub reordered: u64,
    /// Frames that came again.
    pub duplicates: u64,
    /// Frames that came when their time was over.
    pub late: u64,
    /// From a fast packet's arrival to its frame in the face, in seconds: what bridges jitter, the way from
    /// one frame to the next, and lags.
    pub delay_secs: f64,
    /// How much slower the sender's clock is than ours, in millionths; 0 without one.
    pub drift_ppm: f64,
}

#[derive(Debug)]
pub(crate) struct Sender {
    pub(crate) name: Box<str>,
    pub(crate) device: Box<str>,
    pub(crate) protocol: Protocol,
    pub(crate) origin: SocketAddr,
    pub(crate) vmc: Vmc,
    pub(crate) mediapipe: MediaPipeReader,
    clock: Option<Clock>,
    buffer: Buffer,
    pub(crate) motion: Motion,
    /// How much of the face is this sender's.
    share: ThreeLags,
    latenesses: [f32; LATENESSES],
    lateness_count: usize,
    jitter_secs: f64,
    /// When the last frame with a face came, by our clock.
    pub(crate) face_secs: f64,
    /// When the last packet came.
    pub(crate) seen_secs: f64,
    /// Frames since a time, and the rate before.
    counted: (u32, f64),
    rate_hz: f64,
    received: u64,
    lost: u64,
    reordered: u64,
    duplicates: u64,
    late: u64,
    /// The channels that it has had.
    pub(crate) has: Frame,
}

impl Sender {
    pub(crate) fn new(name: Box<str>, device: Box<str>, protocol: Protocol, origin: SocketAddr) -> Self {
        Self {
            name,
            device,
            protocol,
            origin,
            vmc: Vmc::default(),
            mediapipe: MediaPipeReader::default(),
            clock: None,
            buffer: Buffer::new(),
            motion: Motion::new(),
            share: ThreeLags::at(0.0),
            latenesses: [0.0; LATENESSES],
            lateness_count: 0,
            jitter_secs: 0.0,
            face_secs: f64::NEG_INFINITY,
            seen_secs: f64::NEG_INFINITY,
            counted: (0, f64::NEG_INFINITY),
            rate_hz: 0.0,
            received: 0,
            lost: 0,
            reordered: 0,
            duplicates: 0,
            late: 0,
            has: Frame::default(),
        }
    }

    /// Takes a frame that has come.
    pub(crate) fn accept(&mut self, now_secs: f64, frame: &Frame, settings: &Settings) {
        self.seen_secs = now_secs;
        self.received += 1;
        self.count(now_secs);
        let sent_secs = frame.time_secs.filter(|secs| secs.is_finite()).unwrap_or(now_secs);
        let expected = self.clock.as_ref().map(|clock| clock.theirs(now_secs));
        if expected.is_none_or(|expected| (sent_secs - expected).abs() > OTHER_CLOCK_SECS) {
            self.clock = Some(Clock::new(sent_secs, now_secs));
            self.buffer.clear();
            self.lateness_count = 0;
        }
        let lateness = self.clock.as_mut().map_or(0.0, |clock| clock.arrived(sent_secs, now_secs));
        if !frame.is_tracked || frame.is_empty() {
            return;
        }
        self.face_secs = now_secs;
        for (channel, _) in frame.iter() {
            self.has.set(channel, 1.0);
        }
        match self.buffer.keep(sent_secs, frame) {
            // Times of arrival tell nothing of what was sent.
            Kept::Newest { missing } if frame.time_secs.is_some_and(f64::is_finite) => {
                self.lost = self.lost.saturating_add(missing);
            }
            Kept::Newest { .. } => {}
            Kept::Between => {
                self.reordered += 1;
                self.lost = self.lost.saturating_sub(1);
            }
            Kept::Twice => {
                self.duplicates += 1;
                return;
            }
            Kept::TooOld => {
                self.late += 1;
                return;
            }
        }
        if let Some(slot) = self.latenesses.get_mut(self.lateness_count % LATENESSES) {
            *slot = lateness as f32;
        }
        self.lateness_count += 1;
        if self.lateness_count >= 2 * LATENESSES {
            self.lateness_count = LATENESSES;
        }
        if lateness > self.bridged_secs(settings) {
            self.late += 1;
        }
        let count = self.lateness_count.min(LATENESSES);
        let mut sorted = self.latenesses;
        if let Some(sorted) = sorted.get_mut(..count) {
            let place = count.saturating_sub(1 + TOO_LATE * count / LATENESSES);
            let (_, enough, _) = sorted.select_nth_unstable_by(place, f32::total_cmp);
            self.jitter_secs = f64::from(*enough).min(settings.jitter_limit_secs);
        }
    }

    /// How long after a fast packet's arrival the line is at its frame: jitter is bridged, and there has to
    /// be a next frame to go to.
    fn bridged_secs(&self, settings: &Settings) -> f64 {
        let period_secs = self.period_secs();
        self.jitter_secs + period_secs - settings.lead_secs.min(period_secs / 2.0).max(0.0)
    }

    fn period_secs(&self) -> f64 {
        self.buffer.period_secs().unwrap_or(1.0 / 60.0).min(0.1)
    }

    fn count(&mut self, now_secs: f64) {
        let passed = now_secs - self.counted.1;
        if !(0.0..2.0 * RATE_SECS).contains(&passed) {
            self.rate_hz = 0.0;
            self.counted = (0, now_secs);
        } else if passed >= RATE_SECS {
            self.rate_hz = f64::from(self.counted.0 + 1) / passed;
            self.counted = (0, now_secs);
        } else {
            self.counted.0 += 1;
        }
    }

    pub(crate) fn is_live(&self, now_secs: f64, settings: &Settings) -> bool {
        now_secs - self.face_secs <= settings.hold_secs
    }

    /// How much of the face is this sender's, 0 to 1.
    pub(crate) fn share(&self) -> f64 {
        self.share.value()
    }

    pub(crate) fn advance(&mut self, now_secs: f64, dt_secs: f64, is_chosen: bool, settings: &Settings) {
        let Some(clock) = &self.clock else { return };
        let target = if is_chosen && self.is_live(now_secs, settings) { 1.0 } else { 0.0 };
        if target == 0.0 && self.share.is_at(0.0, NOTHING) {
            self.share = ThreeLags::at(0.0);
            self.motion.restart();
            return;
        }
        let toward_secs = clock.theirs(now_secs) - self.bridged_secs(settings);
        self.motion.advance(&self.buffer, toward_secs, dt_secs, settings);
        // Three lags of a third each.
        self.share.go(&Step::new(3.0 / settings.ease_secs.max(1e-3), dt_secs), target);
    }

    /// Until when the face stays as it is, should nothing arrive: `None` for ever, now or an earlier time if
    /// it is moving.
    pub(crate) fn rests_until(&self, now_secs: f64, is_chosen: bool, settings: &Settings) -> Option<f64> {
        let is_wanted = is_chosen && self.is_live(now_secs, settings);
        let target = if is_wanted { 1.0 } else { 0.0 };
        if !is_wanted && self.share.is_at(0.0, UNSEEN) {
            return None;
        }
        if !self.share.is_at(target, UNSEEN) || !self.motion.rests(&self.buffer) {
            return Some(now_secs);
        }
        Some(self.face_secs + settings.hold_secs)
    }

    /// Calls the mean of the last half second neutral. Whether there was anything.
    pub(crate) fn calibrate(&mut self) -> bool {
        let Some((newest, _)) = self.buffer.newest() else { return false };
        // Frames need not have every channel.
        let (mut sums, mut counts) = ([0.0f64; CHANNELS], [0.0f64; CHANNELS]);
        for frame in self.buffer.since(newest - 0.5) {
            for (channel, value) in frame.iter() {
                if let (Some(sum), Some(count)) = (sums.get_mut(channel), counts.get_mut(channel)) {
                    *sum += f64::from(value);
                    *count += 1.0;
                }
            }
        }
        let mut neutral = Frame::default();
        for (channel, (sum, count)) in sums.into_iter().zip(counts).enumerate() {
            if count > 0.0 {
                neutral.set(channel, (sum / count) as f32);
            }
        }
        self.motion.calibration = self.motion.calibration.with_neutral(&neutral);
        true
    }

    pub(crate) fn status(&self, now_secs: f64, is_chosen: bool, settings: &Settings) -> Status<'_> {
        let is_counting = now_secs - self.counted.1 < 2.0 * RATE_SECS;
        Status {
            name: &self.name,
            protocol: self.protocol,
            origin: self.origin,
            is_chosen,
            is_live: self.is_live(now_secs, settings),
            rate_hz: if is_counting { self.rate_hz } else { 0.0 },
            received: self.received,
            lost: self.lost,
            reordered: self.reordered,
            duplicates: self.duplicates,
            late: self.late,
            delay_secs: self.bridged_secs(settings) + settings.lag_secs,
            drift_ppm: self.clock.as_ref().map_or(0.0, |clock| clock.drift() * 1e6),
        }
    }
}

/// A name without what could move a terminal's cursor, and not too long.
pub(crate) fn shown(name: &str) -> impl Iterator<Item = char> {
    name.chars().take(NAME_LENGTH).map(|c| if c.is_control() { '?' } else { c })
}

pub(crate) fn is_shown_as(name: &str, other: &str) -> bool {
    shown(name).eq(other.chars())
}
