//! What a channel needs only around interruptions, apart from what every tick reads.

use super::path::Path;
use super::{Channel, MoveSpec};
use crate::range::Range;

/// How many fades may run one inside the other. Five presses within one move that all would leave the range
/// are more than fingers do; what goes beyond is folded (see [`Channel`]).
pub(crate) const MAX_FADES: usize = 4;

/// What a channel needs only around interruptions.
#[derive(Clone, Debug)]
pub(crate) struct Cold {
    /// The innermost path, where it is no quintic.
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
    /// As old as the fade.
    pub(crate) towards: Path,
}

/// A move that is to start when `elapsed_secs` has come to a time.
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
    /// Whether nothing of what is inside is left, `secs` after the last start.
    pub(crate) fn is_over(&self, secs: f64) -> bool {
        self.age_secs + secs >= self.duration_secs
    }
}
