//! When lids close, and how far they are closed.

use crate::Style;
use crate::chance::{Chance, Stream};
use crate::curves::step;
use crate::parameters as p;

/// How many blinks may be under way at once: the slowest take 1.84 s, wishes are 0.32 s apart, and one in
/// between may be a double.
const MOST: usize = 8;

#[derive(Clone, Copy, Debug)]
struct Blink {
    start: f64,
    close: f64,
    held: f64,
    open: f64,
    depth: f64,
}

impl Blink {
    const NONE: Self = Self { start: f64::NEG_INFINITY, close: 1.0, held: 0.0, open: 1.0, depth: 0.0 };

    fn end(&self) -> f64 {
        self.start + self.close + self.held + self.open
    }

    /// Share of the way to closed lids. Lids open fast at first and slowly at last.
    fn value(&self, now: f64) -> f64 {
        let since = now - self.start;
        if since <= 0.0 {
            return 0.0;
        }
        if since <= self.close {
            return self.depth * step(since / self.close);
        }
        let s = ((since - self.close - self.held) / self.open).clamp(0.0, 1.0);
        self.depth * (1.0 - step(s * (2.0 - s)))
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Blinks {
    seed: u64,
    /// Number of blinks so far, and of wishes to blink.
    count: u64,
    wishes: u64,
    pub(crate) next: f64,
    /// Whether the next one is the second of a double.
    is_double: bool,
    active: [Blink; MOST],
    latest: f64,
    /// When all of them have ended.
    quiet_from: f64,
}

impl Blinks {
    pub(crate) fn new(seed: u64, style: &Style) -> Self {
        let mut blinks = Self {
            seed,
            count: 0,
            wishes: 0,
            next: 0.0,
            is_double: false,
            active: [Blink::NONE; MOST],
            latest: f64::NEG_INFINITY,
            quiet_from: f64::NEG_INFINITY,
        };
        // A face does not begin with a blink, and a crowd not with blinks of all.
        let mut chance = Chance::of(seed, Stream::Trigger, u64::MAX);
        blinks.next = chance.between(0.3, 1.0) * mean_secs(style);
        blinks
    }

    /// The blink that is due at `next`.
    pub(crate) fn happen(&mut self, style: &Style) {
        let now = self.next;
        self.start(now, style, self.is_double);
    }

    /// A blink for another reason; not while one is under way.
    pub(crate) fn wish(&mut self, now: f64, probability: f64, style: &Style) {
        self.wishes += 1;
        let mut chance = Chance::of(self.seed, Stream::Trigger, self.wishes);
        if chance.happens(probability) && now > self.latest + p::DOUBLE_SECS[0] {
            self.start(now, style, true);
        }
    }

    fn start(&mut self, now: f64, style: &Style, is_single: bool) {
        self.count += 1;
        let mut chance = Chance::of(self.seed, Stream::Blink, self.count);
        let slow = style.blink_slowness;
        let depth = if chance.happens(p::INCOMPLETE) {
            chance.between(p::INCOMPLETE_DEPTH[0], p::INCOMPLETE_DEPTH[1])
        } else {
            1.0
        };
        let blink = Blink {
            start: now,
            close: slow * chance.between(p::CLOSE_SECS[0], p::CLOSE_SECS[1]),
            held: slow * chance.between(p::HELD_SECS[0], p::HELD_SECS[1]),
            open: slow * chance.between(p::OPEN_SECS[0], p::OPEN_SECS[1]),
            depth,
        };
        if let Some(slot) = self.active.iter_mut().find(|slot| slot.end() <= now) {
            *slot = blink;
        }
        self.latest = now;
        self.quiet_from = self.quiet_from.max(blink.end());
        self.is_double = !is_single && chance.happens(p::DOUBLE);
        let rest = if self.is_double {
            slow * chance.between(p::DOUBLE_SECS[0], p::DOUBLE_SECS[1])
        } else {
            let beyond = (mean_secs(style) - p::BLINK_REST_SECS).max(0.1);
            p::BLINK_REST_SECS + chance.log_normal(beyond, p::BLINK_SPREAD)
        };
        self.next = now + rest;
    }

    /// Share of the way to closed lids, all blinks together.
    pub(crate) fn value(&self, now: f64) -> f64 {
        if now >= self.quiet_from {
            return 0.0;
        }
        let open: f64 = self.active.iter().map(|blink| 1.0 - blink.value(now)).product();
        1.0 - open
    }

    /// Number of blinks so far.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }
}

/// Mean seconds from blink to blink, where a share of them has another at once.
fn mean_secs(style: &Style) -> f64 {
    60.0 / style.blinks_per_min * (1.0 + p::DOUBLE)
}
