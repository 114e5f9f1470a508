use pose_anim::Pose;
use std::time::{Duration, Instant};

/// The most seconds that one frame may add, to a motion and to a recording: after a pause (a suspended
/// laptop) the face must not jump, and a recording must not get hours of nothing.
const MAX_FRAME_SECS: f64 = 0.25;
const MAX_RECORDED_FRAME_SECS: f64 = 5.0;
/// How long hair swings on after the head has stopped.
const SWINGS_ON: Duration = Duration::from_millis(1800);
/// How often progress is shown.
const SOON: Duration = Duration::from_millis(150);
/// Frames whose times are kept.
const HISTORY: usize = 120;

/// The times of frames, their measurements, and the small pictures of poses.
#[derive(Default)]
pub(super) struct Frames {
    /// When the last frame of a running motion was drawn; `None` while nothing moves.
    last: Option<Instant>,
    /// When the last of frames that follow each other was drawn.
    drawn: Option<Instant>,
    /// When the last frame was drawn that hair moved in, and until when it does.
    swing: Option<(Instant, Instant)>,
    /// When the panel wants to be drawn again.
    again: Option<Instant>,
    /// When to look next whether a face that lives has changed.
    stir: Option<Instant>,
    /// Whether there is sound that has to be looked after, whatever the face does.
    pub(super) sounds: bool,
    /// Milliseconds from frame to frame.
    history: Vec<f32>,
    passes: Vec<(&'static str, f32)>,
    /// Small pictures of poses. Each is kept with the pose that it shows, to see whether it is up to date.
    miniatures: Vec<Miniature>,
}

/// A small picture of a pose, with the pose and the background that it shows.
struct Miniature {
    pose: Pose,
    background: [u8; 4],
    texture: egui::TextureHandle,
}

impl Frames {
    /// Seconds since the last frame or press, while something moves.
    pub(super) fn catch_up(&mut self, now: Instant, is_recorded: bool) -> f64 {
        // A recording has to last as long as it lasted for the user.
        let most = if is_recorded { MAX_RECORDED_FRAME_SECS } else { MAX_FRAME_SECS };
        let last = self.last.replace(now);
        last.map_or(0.0, |last| now.duration_since(last).as_secs_f64().min(most))
    }

    /// When the next frame is to be drawn that nothing else asks for.
    pub(super) fn next(&self) -> Option<Instant> {
        self.again
    }

    pub(super) fn is_due(&mut self) -> bool {
        self.again.take_if(|again| *again <= Instant::now()).is_some()
    }

    /// When to look next whether a face that lives has changed.
    pub(super) fn next_stir(&self) -> Option<Instant> {
        self.stir
    }

    /// Sets that time.
    pub(super) fn stir_at(&mut self, then: Option<Instant>) {
        self.stir = then;
    }

    /// Whether it has come.
    pub(super) fn is_stirring(&mut self) -> bool {
        self.stir.take_if(|stir| *stir <= Instant::now()).is_some()
    }

    /// A frame is to be drawn at that time, if none is before.
    pub(super) fn no_later(&mut self, then: Instant) {
        self.again = Some(self.again.map_or(then, |again| again.min(then)));
    }

    /// Something beside the face has to be shown, which need not be at once: the panel's own frames are few.
    pub(super) fn soon(&mut self) {
        self.no_later(Instant::now() + SOON);
    }

    pub(super) fn forget_miniatures(&mut self) {
        self.miniatures.clear();
    }

    /// Whether something moves, as far as frames were told.
    pub(super) fn runs(&self) -> bool {
        self.last.is_some()
    }

    /// A frame begins: notes how long it has been since the one before, where frames follow each other.
    pub(super) fn begin(&mut self, now: Instant) {
        if let Some(last) = self.drawn {
            let ms = now.duration_since(last).as_secs_f32() * 1e3;
            if self.history.len() == HISTORY {
                self.history.remove(0);
            }
            self.history.push(ms);
        }
    }

    /// A frame that began then has ended; whether others follow it at once, and whether time passes for the
    /// face. The panel wants to be drawn again after a while.
    pub(super) fn end(&mut self, began: Instant, is_followed: bool, runs: bool, again: Duration) {
        self.drawn = is_followed.then_some(began);
        if runs {
            self.last.get_or_insert_with(Instant::now);
        } else {
            self.last = None;
        }
        self.again = (again > Duration::ZERO).then(|| Instant::now().checked_add(again)).flatten();
    }

    /// Seconds by which hair moves in this frame; NaN where it hangs still. Hair goes on a little after the
    /// head; where nothing has moved for longer it hangs still.
    pub(super) fn swing(&mut self, is_at_rest: bool, has_swinging_hair: bool) -> f64 {
        let now = Instant::now();
        let until = match is_at_rest {
            false => Some(now + SWINGS_ON),
            true => self.swing.map(|(_, until)| until).filter(|until| now < *until),
        };
        let last = self.swing.filter(|_| until.is_some()).map(|(last, _)| last);
        self.swing = until.filter(|_| has_swinging_hair).map(|until| (now, until));
        last.map_or(f64::NAN, |last| now.duration_since(last).as_secs_f64())
    }

    /// Whether hair still moves.
    pub(super) fn swings(&self) -> bool {
        self.swing.is_some()
    }

    /// Milliseconds from frame to frame, of the latest ones.
    pub(super) fn history(&self) -> &[f32] {
        &self.history
    }

    /// Milliseconds of the passes of a frame.
    pub(super) fn passes(&self) -> &[(&'static str, f32)] {
        &self.passes
    }

    pub(super) fn set_passes(&mut self, passes: Vec<(&'static str, f32)>) {
        self.passes = passes;
    }

    /// The small picture of a pose, if there is one.
    pub(super) fn miniature(&self, pose: &Pose) -> Option<egui::TextureId> {
        let shown = self.miniatures.iter().find(|miniature| same_face(&miniature.pose, pose));
        shown.map(|miniature| miniature.texture.id())
    }

    /// Lets go of small pictures that are not needed any more, and returns a pose that has none yet.
    pub(super) fn missing_miniature<'p>(
        &mut self,
        poses: &'p [Pose],
        background: [u8; 4],
    ) -> Option<&'p Pose> {
        self.miniatures.retain(|miniature| {
            miniature.background == background && poses.iter().any(|pose| same_face(&miniature.pose, pose))
        });
        poses.iter().find(|pose| self.miniature(pose).is_none())
    }

    pub(super) fn add_miniature(&mut self, pose: &Pose, background: [u8; 4], texture: egui::TextureHandle) {
        self.miniatures.push(Miniature { pose: pose.clone(), background, texture });
    }
}

/// Whether two poses are the same face, whatever they are called.
fn same_face(a: &Pose, b: &Pose) -> bool {
    a.values == b.values
}
