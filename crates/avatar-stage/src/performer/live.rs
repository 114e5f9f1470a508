//! A voice that is heard while it speaks, as from a microphone.

use avatar_speech::{LiveMouth, Mouth, UTTERANCE_PAUSE_SECS, VISEMES, speaks};

/// The rate at which the mouth's time follows that up to which the voice is known, in three low passes: it
/// lags 50 ms behind, and as times come in pieces, it neither stops nor jumps.
const RATE: f64 = 60.0;
/// A mouth that has heard nothing for so long is at rest.
const RESTS_SECS: f64 = 1.0;

/// What has been heard, and how far the mouth is.
#[derive(Clone, Debug)]
pub(super) struct Live {
    heard: LiveMouth,
    /// Times after one, two and three low passes.
    passes: [f64; 3],
    has_begun: bool,
    /// When somebody spoke last, and when the newest frame was.
    spoke_secs: f64,
    newest_secs: f64,
    is_within_utterance: bool,
}

impl Live {
    pub(super) fn new() -> Self {
        Self {
            heard: LiveMouth::new(),
            passes: [0.0; 3],
            has_begun: false,
            spoke_secs: f64::NEG_INFINITY,
            newest_secs: 0.0,
            is_within_utterance: false,
        }
    }

    /// Takes a frame.
    pub(super) fn hear(&mut self, secs: f64, weights: &[f32; VISEMES], loudness: f32) {
        self.heard.push(secs, weights, loudness);
        if !secs.is_finite() {
            return;
        }
        if !self.has_begun {
            self.passes = [self.heard.until_secs(); 3];
            self.has_begun = true;
        }
        self.newest_secs = secs;
        let speaks = speaks(weights);
        if speaks {
            self.spoke_secs = secs;
        }
        let goes_on = self.is_within_utterance && secs - self.spoke_secs < UTTERANCE_PAUSE_SECS;
        self.is_within_utterance = speaks || goes_on;
    }

    /// Whether somebody speaks, or has just spoken.
    pub(super) fn is_within_utterance(&self) -> bool {
        self.is_within_utterance
    }

    /// Whether nothing has been said for a while.
    pub(super) fn rests(&self) -> bool {
        self.newest_secs - self.spoke_secs > RESTS_SECS
    }

    /// Lets time pass: the exact solution of the three low passes, whose input stands still meanwhile.
    pub(super) fn pass(&mut self, secs: f64) {
        let until = self.heard.until_secs();
        let [a, b, c] = self.passes.map(|pass| pass - until);
        let x = RATE * secs;
        let fade = (-x).exp();
        let behind = [a, b + x * a, c + x * (b + 0.5 * x * a)];
        self.passes = behind.map(|behind| until + if fade > 0.0 { fade * behind } else { 0.0 });
    }

    pub(super) fn mouth(&self) -> Mouth {
        self.heard.at(self.passes[2])
    }
}
