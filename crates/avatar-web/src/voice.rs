//! What is heard in samples, for the face to say.

use crate::WebError;
use avatar_speech::HeardSpeech;
#[cfg(feature = "hearing")]
use avatar_stage::Performer;

/// Seconds between what was heard at one microphone and what is heard at the next.
#[cfg(feature = "hearing")]
const APART_SECS: f64 = 1.0;

/// Somebody at a microphone.
#[cfg(feature = "hearing")]
#[derive(Debug)]
pub(crate) struct Microphone {
    hearing: avatar_hearing::Hearing,
    rate_hz: u32,
    from_secs: f64,
    latest_secs: f64,
}

#[cfg(feature = "hearing")]
impl Microphone {
    /// One of this rate. A face takes what it hears by times that rise, whichever microphone they come from:
    /// these begin after those of the one `before`.
    ///
    /// # Errors
    /// A rate that cannot be heard.
    pub(crate) fn new(rate_hz: u32, before: Option<&Self>) -> Result<Self, WebError> {
        let from_secs = before.map_or(0.0, |before| before.latest_secs + APART_SECS);
        Ok(Self { hearing: listener(rate_hz)?, rate_hz, from_secs, latest_secs: from_secs })
    }

    pub(crate) fn rate_hz(&self) -> u32 {
        self.rate_hz
    }

    /// Lets the face say the next samples.
    pub(crate) fn hear(&mut self, samples: &[f32], performer: &mut Performer) {
        let Self { hearing, from_secs, latest_secs, .. } = self;
        hearing.push(samples, |frame| {
            *latest_secs = *from_secs + frame.time_secs;
            performer.hear(*latest_secs, &frame.weights, frame.loudness);
        });
    }
}

/// What is heard in samples of one channel, −1 to 1.
///
/// # Errors
/// A rate that cannot be heard, or a build that hears nothing.
#[cfg(feature = "hearing")]
pub(crate) fn heard(samples: &[f32], rate_hz: u32) -> Result<HeardSpeech, WebError> {
    let mut hearing = listener(rate_hz)?;
    let (mut frames, mut first_secs) = (Vec::new(), None);
    let mut take = |frame: &avatar_hearing::Frame| {
        first_secs.get_or_insert(frame.time_secs);
        frames.push((frame.weights, frame.loudness));
    };
    hearing.push(samples, &mut take);
    hearing.finish(&mut take);
    Ok(HeardSpeech::new(frames, first_secs.unwrap_or_default()))
}

/// Something that listens to samples of this rate.
///
/// # Errors
/// A rate that cannot be heard.
#[cfg(feature = "hearing")]
fn listener(rate_hz: u32) -> Result<avatar_hearing::Hearing, WebError> {
    avatar_hearing::Hearing::new(rate_hz).map_err(|error| WebError::Sound(error.to_string()))
}

/// As above, in a build that hears nothing.
#[cfg(not(feature = "hearing"))]
pub(crate) fn heard(_samples: &[f32], _rate_hz: u32) -> Result<HeardSpeech, WebError> {
    Err(WebError::Sound("expected a build with the feature \"hearing\", found one without".to_owned()))
}
