//! The microphone's voice becomes the face's.

use crate::sound::Microphone;
use anyhow::{Context, Result};
use avatar_hearing::Hearing;
use avatar_stage::Performer;

/// Seconds between what one microphone has heard and the next one hears: times only rise.
const APART_SECS: f64 = 1.0;

/// An open microphone, and what listens to it.
pub(super) struct Listening {
    microphone: Microphone,
    hearing: Hearing,
    /// What has just been heard.
    samples: Vec<f32>,
    /// The time of its beginning among all that the face has heard.
    from_secs: f64,
    latest_secs: f64,
    loudness: f32,
}

impl Listening {
    /// Opens the default microphone, after others that have heard up to this time. `failed` is told if it
    /// fails later on.
    pub(super) fn begin(after_secs: f64, failed: impl FnMut(String) + Send + 'static) -> Result<Self> {
        let microphone = Microphone::open(failed)?;
        let rate_hz = microphone.rate_hz();
        let hearing = Hearing::new(rate_hz).context("expected a microphone that can be listened to")?;
        let from_secs = after_secs + APART_SECS;
        let samples = Vec::new();
        Ok(Self { microphone, hearing, samples, from_secs, latest_secs: from_secs, loudness: 0.0 })
    }

    /// Up to when it has heard.
    pub(super) fn latest_secs(&self) -> f64 {
        self.latest_secs
    }

    /// How loud it is, 0 to 1.
    pub(super) fn loudness(&self) -> f32 {
        self.loudness
    }

    /// Lets the face say what was heard since it was asked last, unless it speaks by a script meanwhile.
    pub(super) fn hear(&mut self, performer: &mut Performer) {
        let is_free = performer.speech_secs().is_none();
        let Self { microphone, hearing, samples, from_secs, latest_secs, loudness } = self;
        samples.clear();
        microphone.take(samples);
        hearing.push(samples, |frame| {
            *latest_secs = *from_secs + frame.time_secs;
            *loudness = frame.loudness;
            if is_free {
                performer.hear(*latest_secs, &frame.weights, frame.loudness);
            }
        });
    }
}
