//! The part of a channel that is only needed around interruptions, kept apart from what every tick reads.

use super::path::Path;
use super::{Channel, MoveSpec};
use crate::range::Range;

/// How many fades may run inside each other. More than five presses within one move that would all leave the
/// range are rare; then the innermost fades are folded (see [`Channel`]).
pub(crate) const MAX_FADES: usize = 4;

/// The part of a channel that is only needed around interruptions.
#[derive(Clone, Debug)]
pub(crate) struct Cold {
    /// The innermost path, if it is not a quintic.
    pub(crate) base: Path,
    pub(crate) fades: [Fade; MAX_FADES],
    pub(crate) waiting: Waiting,
    /// The channel before the direct move that began at this very moment.
    pub(crate) before: Channel,
}

#[derive(Clone, Debug)]
pub(crate) struct Fade {
    /// Age at the last start.
    pub(crate) age_secs: f64,
    pub(crate) duration_secs: f64,
    /// The path that is faded into. Its age is the age of the fade.
    pub(crate) towards: Path,
}

/// A move that starts when `elapsed_secs` reaches `at_secs`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waiting {
    pub(crate) at_secs: f64,
    pub(crate) spec: MoveSpec,
}

impl Cold {
    pub(crate) fn new() -> Self {
        let fade = || Fade { age_secs: 0.0, duration_secs: 0.0, towards: Path::rest(0.0) };
        Self {
            base: Path::rest(0.0),
            fades: std::array::from_fn(|_| fade()),
            waiting: Waiting { at_secs: 0.0, spec: MoveSpec::NONE },
            before: Channel::rest(Range { min: 0.0, max: 0.0 }, 0.0),
        }
    }

    /// Lets go of all paths: one may be the last owner of a clip.
    pub(crate) fn forget(&mut self) {
        self.base = Path::rest(0.0);
        self.fades.iter_mut().for_each(|fade| fade.towards = Path::rest(0.0));
    }
}

impl Fade {
    /// Whether the fade has finished `secs` after the last start, so that nothing inside it matters any more.
    pub(crate) fn is_over(&self, secs: f64) -> bool {
        self.age_secs + secs >= self.duration_secs
    }
}
