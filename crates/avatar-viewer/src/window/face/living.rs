//! What the face does by itself in the window.

use super::Face;
use crate::life_args::Living;
use avatar_life::{Amounts, Life, Style};
use avatar_stage::Attention;
use glam::Vec3;

/// Where pictures are dear, eyes stay so many times as long where they are.
const SPARED_FIXATIONS: f64 = 3.0;

/// The place of what it attends to in its life's list.
const ATTENTION: usize = 0;

/// How a face lives in the window while it does.
#[derive(Clone, Copy, Debug)]
pub(in crate::window) struct Lively {
    style: Style,
    /// Which of all lives of that kind.
    seed: u64,
    /// Whether the whole picture is too dear to be drawn often: then nothing moves but eyes and lids.
    spares: bool,
    /// Whether it looks where it is told to, so that the head may take part.
    follows: bool,
}

impl Default for Lively {
    /// Calm, in full.
    fn default() -> Self {
        Self { style: Style::default(), seed: 0, spares: false, follows: false }
    }
}

impl Lively {
    /// As the command line says it.
    pub(super) fn with(self, life: &Living) -> Self {
        Self { style: life.style(), seed: life.seed(), ..self }
    }

    /// The style with what it shows here.
    fn shown(&self) -> Style {
        let own = self.style.amounts;
        if !self.spares {
            return self.style;
        }
        let head = if self.follows { own.head } else { 0.0 };
        Style {
            amounts: Amounts { blinks: own.blinks, gaze: own.gaze, head, ..Amounts::NONE },
            fixation_secs: SPARED_FIXATIONS * self.style.fixation_secs,
            ..self.style
        }
    }
}

impl Face {
    /// Whether it lives by itself.
    pub(in crate::window) fn lives(&self) -> bool {
        self.performer.life().is_some()
    }

    /// Whether it shows nothing but what its controls say.
    pub(super) fn is_still(&self) -> bool {
        !self.lives() && !self.performer.is_speaking()
    }

    /// How it lives while it does.
    pub(in crate::window) fn lively(&self) -> Lively {
        self.lively
    }

    /// Its life from the beginning and in full, as a film shows it; none where it is still.
    pub(in crate::window) fn life_anew(&self) -> Option<Living> {
        let Lively { style, seed, .. } = self.lively;
        self.lives().then(|| Living::new(self.pack(), style, seed))
    }

    /// Begins to live, or is still again.
    pub(in crate::window) fn set_life(&mut self, is_wanted: bool) {
        if is_wanted != self.lives() {
            let life = || Life::new(self.controls(), self.lively.shown(), self.lively.seed);
            let life = is_wanted.then(life);
            // Only the life of another avatar would be an error.
            let _ = self.performer.set_life(life);
        }
    }

    /// Whether pictures are dear here.
    pub(in crate::window) fn spare(&mut self, spares: bool) {
        self.lively.spares = spares;
        self.show_style();
    }

    fn show_style(&mut self) {
        let style = self.lively.shown();
        if let Some(life) = self.performer.life_mut().filter(|life| *life.style() != style) {
            life.set_style(style);
        }
    }

    /// Attends to somebody who stands there, or to a point.
    pub(in crate::window) fn attend(&mut self, point: Vec3, is_somebody: bool) {
        let face = Attention::face(point);
        let to = if is_somebody { face } else { Attention { size_metres: 0.0, ..face } };
        // Only a face of another pack would be an error.
        let _ = self.performer.attend(ATTENTION, Some(to));
        if self.lively.follows == is_somebody {
            self.lively.follows = !is_somebody;
            self.show_style();
        }
    }
}
