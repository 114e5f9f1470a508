//! The sound of a script while it is played, and the mouth beside it.

use super::READY_SECS;
use super::script::Script;
use crate::sound::Speaker;
use anyhow::{Result, ensure};
use avatar_stage::Performer;
use std::time::Instant;

/// A mouth that is further from the sound than this, in seconds, begins anew where the sound is: before the
/// first sound, where that is not seen, and afterwards.
const OFF_SECS: [f64; 2] = [0.02, 0.06];
/// A sound that is so much further than the clock does not keep time: nothing follows it.
const AHEAD_SECS: f64 = 0.5;
/// A device that has not begun after so many seconds never will.
const PATIENCE_SECS: f64 = 3.0;

/// A device is kept for so many seconds behind the end: some are later than they say, and what a device still
/// holds is not heard once it is let go.
const LINGERS_SECS: f64 = 1.5;

/// A sound that is played.
pub(super) struct Playing {
    speaker: Speaker,
    began: Instant,
    end_secs: f64,
    is_over: bool,
}

impl Playing {
    /// Plays the sound of a script after so many seconds; nothing where it has none. `failed` is told if the
    /// device fails later on.
    pub(super) fn start(
        script: &mut Script,
        after_secs: f64,
        failed: impl FnMut(String) + Send + 'static,
    ) -> Result<Option<Self>> {
        if script.sound.is_none() {
            return Ok(None);
        }
        let rate_hz = Speaker::rate_hz()?;
        let Some(samples) = script.samples(rate_hz)? else { return Ok(None) };
        let speaker = Speaker::play(samples, rate_hz, after_secs, failed)?;
        let end_secs = script.end_secs();
        Ok(Some(Self { speaker, began: Instant::now(), end_secs, is_over: false }))
    }

    /// Brings the mouth to where the sound is; whether the sound goes on.
    ///
    /// # Errors
    /// A device that does not begin.
    pub(super) fn keep_together(&mut self, script: &Script, performer: &mut Performer) -> Result<bool> {
        let clock_secs = self.began.elapsed().as_secs_f64() - READY_SECS;
        let Some(heard_secs) = self.speaker.secs() else {
            ensure!(
                clock_secs < PATIENCE_SECS,
                "expected a device that plays, found one that does not begin"
            );
            return Ok(true);
        };
        self.is_over = heard_secs > self.end_secs;
        let is_held = clock_secs < self.end_secs + LINGERS_SECS;
        if heard_secs > clock_secs + AHEAD_SECS {
            return Ok(is_held);
        }
        if let Some(secs) = performer.speech_secs()
            && is_off(secs, heard_secs)
        {
            performer.speak(script.words.clone(), heard_secs);
        }
        Ok(!self.is_over || is_held)
    }

    /// Whether all of it has been heard.
    pub(super) fn is_over(&self) -> bool {
        self.is_over
    }
}

/// Whether a mouth at this time is too far from a sound at that time.
fn is_off(mouth_secs: f64, heard_secs: f64) -> bool {
    let [before, within] = OFF_SECS;
    (mouth_secs - heard_secs).abs() > if heard_secs < 0.0 { before } else { within }
}

#[cfg(test)]
mod tests {
    use super::is_off;

    #[test]
    fn small_differences_are_kept_once_the_sound_is_heard() {
        assert!(is_off(-0.2, -0.25) && !is_off(-0.24, -0.25));
        assert!(!is_off(1.05, 1.0) && is_off(1.07, 1.0) && is_off(0.5, 1.0));
    }
}
