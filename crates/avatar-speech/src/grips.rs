use crate::ease::ease_between;
use crate::params::{GRIP_FROM, GRIP_LEAST_SECS, GRIP_SECS, GRIP_SHARE, GRIP_TO};
use crate::timeline::Cue;
use crate::viseme::Viseme;

/// A time in which the lips are held: closed or bitten.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grip {
    is_bite: bool,
    /// Begins to close, is closed, is still closed, is open again.
    secs: [f64; 4],
}

impl Grip {
    /// From when on the lips are held.
    pub(crate) fn held_secs(&self) -> f64 {
        self.secs[1]
    }
}

/// The grips of these sounds, which follow each other without a gap.
pub(crate) fn grips(cues: &[Cue]) -> Vec<Grip> {
    let mut grips: Vec<Grip> = Vec::new();
    for (index, cue) in cues.iter().enumerate() {
        let is_bite = match cue.viseme {
            Viseme::PP => false,
            Viseme::FF => true,
            _ => continue,
        };
        let length = |cue: Option<&Cue>| cue.map_or(GRIP_SECS, |cue| cue.end_secs - cue.start_secs);
        let own = length(Some(cue));
        // It may use the sound beside it up to a share, and its own part that is not held.
        let ramp =
            |beside: f64, inside: f64| (GRIP_SHARE * beside + inside * own).clamp(GRIP_LEAST_SECS, GRIP_SECS);
        let [from, to] = [GRIP_FROM, GRIP_TO].map(|share| cue.start_secs + share * own);
        let before = index.checked_sub(1).and_then(|index| cues.get(index));
        let mut begin = from - ramp(length(before), GRIP_FROM);
        let end = to + ramp(length(cues.get(index + 1)), 1.0 - GRIP_TO);
        if let Some(last) = grips.last_mut() {
            // While one is held the other one is not: p f, and long rows of either.
            begin = begin.max(last.secs[2]);
            last.secs[3] = last.secs[3].min(from);
        }
        grips.push(Grip { is_bite, secs: [begin, from, to, end] });
    }
    grips
}

/// How far the lips are held closed, and bitten, at a time. At least `before` grips are held before it, and
/// about as many.
pub(crate) fn held(grips: &[Grip], before: usize, secs: f64) -> [f64; 2] {
    // Of those before the last one that is held already, none is still open.
    let mut next = before;
    while grips.get(next).is_some_and(|grip| grip.secs[1] <= secs) {
        next += 1;
    }
    let nearby = &grips[next.saturating_sub(1)..grips.len().min(next + 1)];
    let mut open = [1.0; 2];
    for Grip { is_bite, secs: [begin, from, to, end] } in nearby {
        let held = ease_between(*begin, *from, secs) * (1.0 - ease_between(*to, *end, secs));
        open[usize::from(*is_bite)] *= 1.0 - held;
    }
    open.map(|open| 1.0 - open)
}
