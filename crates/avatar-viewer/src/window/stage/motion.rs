//! How much care a frame gets, on adapters that draw in software: drafts while something moves, the whole
//! picture at rest.

use avatar_stage::wgpu;
use avatar_stage::{Drafts, Pace};
use std::time::{Duration, Instant};

/// A picture that stayed the same for so long rests: longer than from one event of a moving hand to the next.
const RESTS: Duration = Duration::from_millis(150);

/// Draws drafts, and knows when.
pub(super) struct Motion<D = Drafts> {
    pub(super) drafts: D,
    pace: Pace,
    /// The level of the picture that is shown; `None` before the first.
    shown: Option<usize>,
    /// When the picture last became another one.
    changed: Instant,
    /// When a frame was last begun.
    began: Instant,
    /// A frame whose time is not known yet: its level, and when it began.
    pending: Option<(usize, Instant)>,
    /// Whether drafts have been drawn, and so will not have to be compiled in the middle of a motion.
    is_warm: bool,
}

/// What a frame draws of the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Nothing: the picture that is there is shown again.
    Same,
    /// The picture of a level ([`Pace`]); 0 is the whole one.
    Level(usize),
    /// The whole picture is shown, and drawn anew in this rectangle: left, top, width and height in pixels.
    Part([u32; 4]),
    /// A draft that is not shown.
    WarmUp,
}

impl<D> Motion<D> {
    pub(super) fn new(drafts: D, now: Instant) -> Self {
        Self {
            drafts,
            pace: Pace::default(),
            shown: None,
            changed: now,
            began: now,
            pending: None,
            is_warm: false,
        }
    }

    /// What the next frame draws, where the picture that is shown still is the one to show or not, and where
    /// something moves or not.
    pub(super) fn next(&mut self, is_same: bool, moves: bool, now: Instant) -> Wanted {
        let rests = !moves && now.saturating_duration_since(self.changed) >= RESTS;
        match self.shown {
            // Nobody waits for anything smooth yet.
            None => Wanted::Level(0),
            Some(_) if !is_same => {
                self.changed = now;
                Wanted::Level(self.pace.level())
            }
            Some(1..) if rests => Wanted::Level(0),
            Some(0) if rests && !self.is_warm => Wanted::WarmUp,
            Some(_) => Wanted::Same,
        }
    }

    /// When another picture of the same is due, if nothing moves. A frame that began after that and drew
    /// nothing had no window to draw on: one that is seen again is drawn again.
    pub(super) fn due(&self) -> Option<Instant> {
        let is_due = self.shown.is_some_and(|shown| shown > 0 || !self.is_warm);
        is_due.then(|| self.changed + RESTS).filter(|due| *due > self.began)
    }

    /// What the next frame draws, where the whole picture is shown and nothing has changed but in a
    /// rectangle.
    pub(super) fn patch(&mut self, rect: [u32; 4]) -> Wanted {
        self.changed = self.began;
        Wanted::Part(rect)
    }

    /// The level of the next draft.
    pub(super) fn draft(&self) -> usize {
        self.pace.level().max(1)
    }

    /// Whether the whole picture is shown.
    pub(super) fn is_whole(&self) -> bool {
        self.shown == Some(0)
    }

    /// Whether what is shown is less than the whole picture.
    pub(super) fn is_draft(&self) -> bool {
        self.shown.is_some_and(|shown| shown > 0)
    }

    /// A frame begins: waits for the one before it.
    pub(super) fn begin(&mut self, device: &wgpu::Device) -> Instant {
        self.began = self.wait(device).unwrap_or_else(Instant::now);
        self.began
    }

    /// What became of the frame before is not known.
    pub(super) fn forget(&mut self) {
        self.pending = None;
    }

    /// A draft was drawn that is not shown.
    pub(super) fn warmed_up(&mut self) {
        self.is_warm = true;
    }

    /// A frame of this level that began then is shown. Its time counts unless something had to be made for
    /// it.
    pub(super) fn shows(&mut self, level: usize, began: Instant, counts: bool) {
        if self.shown.is_none() {
            self.changed = Instant::now();
        }
        self.shown = Some(level);
        self.is_warm |= level > 0;
        self.pending = counts.then_some((level, began));
    }

    /// Waits for the frame whose time is not known yet, and returns when it had been drawn, if there was one.
    /// Drawing in software takes all processors, so that nothing else would be done meanwhile.
    pub(super) fn wait(&mut self, device: &wgpu::Device) -> Option<Instant> {
        let (level, began) = self.pending.take()?;
        // A lost device is found out by the next frame.
        let has_ended = device.poll(wgpu::PollType::wait_indefinitely()).is_ok();
        let now = Instant::now();
        if has_ended {
            self.pace.note(level, now.saturating_duration_since(began).as_secs_f64());
        }
        Some(now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// A frame that begins then: what it draws; it is shown.
    fn frame(motion: &mut Motion<()>, is_same: bool, moves: bool, at: Instant) -> Wanted {
        motion.began = at;
        let wanted = motion.next(is_same, moves, at);
        match wanted {
            Wanted::Level(level) => motion.shows(level, at, false),
            Wanted::WarmUp => motion.warmed_up(),
            Wanted::Same | Wanted::Part(_) => {}
        }
        wanted
    }

    #[test]
    fn drafts_show_what_moves_and_the_whole_picture_comes_at_rest() {
        let start = Instant::now();
        let mut motion = Motion::new((), start);
        let draft = Wanted::Level(motion.draft());
        assert_eq!(motion.due(), None);
        assert_eq!(frame(&mut motion, false, true, start), Wanted::Level(0), "the first");
        assert!(motion.due().is_some(), "drafts are to be compiled");
        // From here on times are those of the test.
        motion.changed = start;
        assert_eq!(frame(&mut motion, true, false, start + 100 * MS), Wanted::Same);
        assert_eq!(frame(&mut motion, true, false, start + RESTS), Wanted::WarmUp);
        assert_eq!((motion.due(), motion.is_draft()), (None, false));
        for ms in [200, 240, 280] {
            assert_eq!(frame(&mut motion, false, true, start + ms * MS), draft);
        }
        // The face stands still in the middle of a clip.
        assert_eq!(frame(&mut motion, true, true, start + 900 * MS), Wanted::Same);
        assert!(motion.is_draft());
        assert_eq!(frame(&mut motion, false, false, start + 1000 * MS), draft, "the last one");
        assert_eq!(motion.due(), Some(start + 1000 * MS + RESTS));
        assert!(RESTS < 300 * MS);
        assert_eq!(frame(&mut motion, true, false, start + 1010 * MS), Wanted::Same, "the panel alone");
        assert_eq!(motion.due(), Some(start + 1000 * MS + RESTS));
        assert_eq!(frame(&mut motion, true, false, start + 1000 * MS + RESTS), Wanted::Level(0));
        assert_eq!((motion.due(), motion.is_draft()), (None, false));
        assert_eq!(frame(&mut motion, true, false, start + 5000 * MS), Wanted::Same);
    }

    #[test]
    fn a_hidden_window_is_not_asked_again_and_again() {
        let start = Instant::now();
        let mut motion = Motion::new((), start);
        frame(&mut motion, false, true, start);
        motion.changed = start;
        frame(&mut motion, false, true, start + 10 * MS);
        assert_eq!(motion.due(), Some(start + 10 * MS + RESTS));
        // A frame begins, and there is no surface to draw on.
        motion.began = start + 10 * MS + RESTS;
        assert_eq!(motion.due(), None);
        // Seen again.
        assert_eq!(frame(&mut motion, true, false, start + 9000 * MS), Wanted::Level(0));
    }
}
