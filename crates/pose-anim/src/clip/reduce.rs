use super::{Clip, Key, Track, Transition};
use crate::quadratic::roots;
use crate::range::Range;
use crate::{ClipError, Easing, Jet};

/// What [`Clip::reduced`] saved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduction {
    /// Keys before.
    pub keys_before: usize,
    /// Keys after.
    pub keys_after: usize,
    /// Bytes before; see [`Clip::byte_len`].
    pub bytes_before: usize,
    /// Bytes after.
    pub bytes_after: usize,
    /// By how much any control strays, at most.
    pub worst: f64,
}

impl Clip {
    /// The size of the clip in a compact form: for each key its time and value as 32-bit numbers, a byte for
    /// the kind of transition, and the transition's own numbers at 32 bits each.
    pub fn byte_len(&self) -> usize {
        let numbers = |key: &Key| match key.transition {
            Transition::Ease(Easing::Bezier(_)) => 4,
            Transition::Ease(_) => 0,
            Transition::Hermite { .. } => 2,
            Transition::Part { .. } => 3,
        };
        self.tracks.iter().flat_map(Track::keys).map(|key| 9 + 4 * numbers(key)).sum()
    }

    /// The same clip with as few keys as a greedy search finds, so that no control strays further than
    /// `bound(control)` at any time.
    ///
    /// From each key that is kept, the farthest later one is sought such that one span between them fits: a
    /// straight line, or else the cubic through both whose slopes fit best in the least-squares sense (as in
    /// Schneider 1990, *An Algorithm for Automatically Fitting Digitized Curves*, but over time, where the
    /// fit is linear). Spans with transition functions stay what they are (they say much with little), and so
    /// do jumps. The bound holds between the keys as well: it is checked at the extrema of the difference. No
    /// new span leaves the values between the track's lowest and its highest one, so a clip that stays in the
    /// ranges of its controls still does.
    ///
    /// # Errors
    /// A bound that is negative or NaN.
    pub fn reduced(&self, mut bound: impl FnMut(usize) -> f64) -> Result<(Self, Reduction), ClipError> {
        let mut reduced = Self { tracks: Vec::new(), ..self.clone() };
        let mut worst = 0.0f64;
        for track in &self.tracks {
            let bound = bound(track.control());
            if bound.is_nan() || bound < 0.0 {
                return Err(ClipError::Bound { bound });
            }
            let (keys, strays) = reduce(track, bound);
            worst = worst.max(strays);
            reduced.tracks.push(Track::new(track.control(), keys)?);
        }
        let keys = |clip: &Self| clip.tracks.iter().map(|track| track.keys().len()).sum();
        let report = Reduction {
            keys_before: keys(self),
            keys_after: keys(&reduced),
            bytes_before: self.byte_len(),
            bytes_after: reduced.byte_len(),
            worst,
        };
        Ok((reduced, report))
    }
}

/// The keys that are left, and by how much they stray.
fn reduce(track: &Track, bound: f64) -> (Vec<Key>, f64) {
    let keys = track.keys();
    let limits = limits(keys);
    let (mut kept, mut worst, mut from) = (Vec::new(), 0.0f64, 0);
    while from + 1 < keys.len() {
        // A single span fits itself.
        let mut best = (from + 1, keys[from].transition, 0.0);
        let mut fits = |to: usize| match fit(&keys[from..=to], bound, limits) {
            Some((transition, strays)) => {
                best = (to, transition, strays);
                true
            }
            None => false,
        };
        // Gallop until it fails, then halve between the last success and the failure.
        let (mut good, mut step) = (from + 1, 1);
        let mut bad = loop {
            let to = (good + step).min(keys.len() - 1);
            if to == good {
                break good + 1;
            }
            if !fits(to) {
                break to;
            }
            good = to;
            step *= 2;
        };
        while bad - good > 1 {
            let middle = good + (bad - good) / 2;
            if fits(middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        let (to, transition, strays) = best;
        kept.push(Key { transition, ..keys[from] });
        worst = worst.max(strays);
        from = to;
    }
    kept.extend(keys.last().map(|last| Key { transition: Transition::LINEAR, ..*last }));
    (kept, worst)
}

/// The lowest and the highest value of straight and cubic spans, and of all keys.
fn limits(keys: &[Key]) -> Range {
    let cubics = keys.windows(2).filter(|pair| {
        matches!(pair[0].transition, Transition::Hermite { .. }) && pair[0].time_secs < pair[1].time_secs
    });
    let values = cubics.flat_map(extrema_of).chain(keys.iter().map(|key| key.value));
    values.fold(Range { min: f64::MAX, max: f64::MIN }, |range, value| Range {
        min: range.min.min(value),
        max: range.max.max(value),
    })
}

/// One span from the first to the last of these keys that stays within the bound and the limits, with how far
/// it strays.
fn fit(keys: &[Key], bound: f64, limits: Range) -> Option<(Transition, f64)> {
    let cubic = |pair: &[Key]| match pair[0].transition {
        Transition::Ease(Easing::Linear) | Transition::Hermite { .. } => {
            pair[0].time_secs < pair[1].time_secs
        }
        Transition::Ease(_) => pair[0].value == pair[1].value && pair[0].time_secs < pair[1].time_secs,
        Transition::Part { .. } => false,
    };
    if !keys.windows(2).all(cubic) {
        return None;
    }
    let line = Transition::LINEAR;
    if let Some(strays) = strays(keys, line, bound) {
        return Some((line, strays));
    }
    let cubic = best_slopes(keys)?;
    let ends = [Key { transition: cubic, ..*keys.first()? }, *keys.last()?];
    if !extrema_of(&ends).all(|value| limits.holds(value)) {
        return None;
    }
    strays(keys, cubic, bound).map(|strays| (cubic, strays))
}

/// The values at those places inside the span between two keys where it turns; it is straight or cubic.
fn extrema_of(pair: &[Key]) -> impl Iterator<Item = f64> {
    let (start, length) = (pair[0].time_secs, pair[1].time_secs - pair[0].time_secs);
    extrema(move |share| state(pair, pair, start + share * length))
}

/// The values of a cubic at those places between 0 and 1 where it turns, from its states.
fn extrema(of: impl Fn(f64) -> Jet) -> impl Iterator<Item = f64> {
    let [first, middle, last] = [0.0, 0.5, 1.0].map(|share| of(share).velocity);
    // The slope is the quadratic through three of its values.
    let a = 2.0 * (first + last - 2.0 * middle);
    let b = last - first - a;
    let turns = roots(a, b, first).into_iter().filter(|share| (0.0..1.0).contains(share));
    turns.map(move |share| of(share).value)
}

/// The cubic through the end keys with the slopes that fit best at the keys and between them.
fn best_slopes(keys: &[Key]) -> Option<Transition> {
    let (first, last) = (keys.first()?, keys.last()?);
    let length = last.time_secs - first.time_secs;
    if length <= 0.0 {
        return None;
    }
    // Beyond the line, the cubic is l·u(1−u)² − r·u²(1−u): linear in l and r.
    let (mut ll, mut lr, mut rr, mut lx, mut rx) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for pair in keys.windows(2) {
        for step in 0..4 {
            let share = f64::from(step) / 4.0;
            let time_secs = pair[0].time_secs + share * (pair[1].time_secs - pair[0].time_secs);
            let u = (time_secs - first.time_secs) / length;
            let beyond = state(pair, pair, time_secs).value - (first.value + (last.value - first.value) * u);
            let (l, r) = (u * (1.0 - u) * (1.0 - u), -u * u * (1.0 - u));
            (ll, lr, rr) = (ll + l * l, lr + l * r, rr + r * r);
            (lx, rx) = (lx + l * beyond, rx + r * beyond);
        }
    }
    let determinant = ll * rr - lr * lr;
    if determinant.abs() < 1e-300 {
        return None;
    }
    let (l, r) = ((lx * rr - rx * lr) / determinant, (rx * ll - lx * lr) / determinant);
    let slope = (last.value - first.value) / length;
    Some(Transition::Hermite { leaving: slope + l / length, arriving: slope + r / length })
}

/// The state at a time of the first key's transition, spanned between the outer of these keys.
fn state(of: &[Key], ends: &[Key], time_secs: f64) -> Jet {
    let (first, last) = (ends[0], ends[ends.len() - 1]);
    let length = last.time_secs - first.time_secs;
    of[0].transition.at(time_secs - first.time_secs, length, first.value, last.value)
}

/// How far one span with this transition strays from the keys' curve, if not further than the bound.
fn strays(keys: &[Key], transition: Transition, bound: f64) -> Option<f64> {
    let whole = [Key { transition, ..keys[0] }];
    let mut worst = 0.0f64;
    for pair in keys.windows(2) {
        let (start, length) = (pair[0].time_secs, pair[1].time_secs - pair[0].time_secs);
        let off = |share: f64| {
            let time_secs = start + share * length;
            state(&whole, keys, time_secs) - state(pair, pair, time_secs)
        };
        // Two cubics differ by a cubic.
        let values = extrema(off).chain([0.0, 1.0].map(|share| off(share).value));
        worst = values.fold(worst, |worst, value| worst.max(value.abs()));
        if worst > bound {
            return None;
        }
    }
    Some(worst)
}
