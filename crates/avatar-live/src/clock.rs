//! A sender's clock against ours.

/// Seconds of the sender that have one fastest packet.
const BUCKET_SECS: f64 = 2.0;
/// How many of them count: about a minute.
const BUCKETS: usize = 32;
/// So many of them tell how fast the clock goes.
const ENOUGH: usize = 6;
/// Clocks differ by less than this, as a share: a thousandth.
const DRIFT_LIMIT: f64 = 1e-3;

/// When a sender's times are, by our clock.
///
/// The fastest packets of each two seconds, over about a minute, lie near a line: its slope, the median of
/// all slopes between two of them (Theil 1950, Sen 1968), is how much the clocks drift apart; and no packet
/// came before the line. This is what a packet without a detour takes, so what comes later than the line is
/// jitter. The least delay itself cannot be known from one side.
#[derive(Clone, Debug)]
pub(crate) struct Clock {
    /// The first packet: its time by the sender's clock, and by ours.
    first: [f64; 2],
    /// Number of the bucket, and the sender's time and the offset of its fastest packet.
    buckets: [Option<(i64, f64, f64)>; BUCKETS],
    drift: f64,
    /// Offset of the line at the first packet.
    offset: f64,
    newest: i64,
}

impl Clock {
    pub(crate) fn new(sent_secs: f64, now_secs: f64) -> Self {
        let first = [sent_secs, now_secs];
        Self { first, buckets: [None; BUCKETS], drift: 0.0, offset: 0.0, newest: 0 }
    }

    /// Takes notice of a packet. Returns how many seconds later it came than a fast one would have.
    pub(crate) fn arrived(&mut self, sent_secs: f64, now_secs: f64) -> f64 {
        let sent = sent_secs - self.first[0];
        let offset = now_secs - self.first[1] - sent;
        let number = (sent / BUCKET_SECS).floor() as i64;
        let place = usize::try_from(number.rem_euclid(BUCKETS as i64)).unwrap_or_default();
        let Some(bucket) = self.buckets.get_mut(place) else { return 0.0 };
        let is_faster = match bucket {
            Some((of, _, least)) if *of == number => offset < *least,
            // An older one says nothing new.
            Some((of, ..)) if *of > number => false,
            _ => true,
        };
        if is_faster {
            *bucket = Some((number, sent, offset));
        }
        if number > self.newest {
            self.newest = number;
            self.drift = self.slope();
        }
        if is_faster {
            let kept = self.buckets.iter().flatten();
            let kept = kept.filter(|(of, ..)| number - of < BUCKETS as i64);
            self.offset =
                kept.map(|(_, sent, offset)| offset - self.drift * sent).fold(f64::INFINITY, f64::min);
        }
        (now_secs - self.ours(sent_secs)).max(0.0)
    }

    /// When, by our clock, a fast packet of this time comes.
    pub(crate) fn ours(&self, sent_secs: f64) -> f64 {
        let sent = sent_secs - self.first[0];
        self.first[1] + sent + self.offset + self.drift * sent
    }

    /// The time of the sender's clock of which a fast packet comes at a time of ours.
    pub(crate) fn theirs(&self, now_secs: f64) -> f64 {
        self.first[0] + (now_secs - self.first[1] - self.offset) / (1.0 + self.drift)
    }

    /// How much slower the sender's clock is than ours, as a share.
    pub(crate) fn drift(&self) -> f64 {
        self.drift
    }

    /// The median of all slopes; the newest bucket is not full yet.
    fn slope(&self) -> f64 {
        let is_full =
            |(number, ..): &&(i64, f64, f64)| *number < self.newest && self.newest - number < BUCKETS as i64;
        let mut slopes = [0.0; BUCKETS * (BUCKETS - 1) / 2];
        let mut count = 0;
        for (index, a) in self.buckets.iter().enumerate() {
            let Some(a) = a.as_ref().filter(is_full) else { continue };
            for b in self.buckets.iter().skip(index + 1).flatten().filter(is_full) {
                if let Some(slot) = slopes.get_mut(count).filter(|_| a.1 != b.1) {
                    *slot = (b.2 - a.2) / (b.1 - a.1);
                    count += 1;
                }
            }
        }
        if count < ENOUGH * (ENOUGH - 1) / 2 {
            return 0.0;
        }
        let slopes = slopes.get_mut(..count).unwrap_or_default();
        let middle = *slopes.select_nth_unstable_by(count / 2, f64::total_cmp).1;
        middle.clamp(-DRIFT_LIMIT, DRIFT_LIMIT)
    }
}
