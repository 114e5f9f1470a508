use std::fmt;

/// Why bytes are no sound, or a sound cannot be made into something.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SoundError {
    /// Bytes of another kind.
    #[error("expected a sound as WAV, FLAC, Ogg Vorbis or MP3, found {found}")]
    Kind {
        /// What they are, as far as that can be told.
        found: String,
    },
    /// A file of a kind that is read, with a beginning that makes no sense.
    #[error("expected a sound, found a damaged file: {reason}")]
    Damaged {
        /// What the decoder says.
        reason: String,
    },
    /// A file with nothing to hear in it.
    #[error("expected a sound, found a file without a single sample{}", because(reason))]
    Empty {
        /// What went wrong with the last part of it that was tried; empty if there was none.
        reason: String,
    },
    /// A rate that no sound has.
    #[error("expected {least} to {most} samples a second, found {found}", least = Self::RATES.start(), most = Self::RATES.end())]
    Rate {
        /// What was found.
        found: u32,
    },
    /// A number of channels that no sound has.
    #[error("expected 1 to {most} channels, found {found}", most = Self::MOST_CHANNELS)]
    Channels {
        /// What was found.
        found: usize,
    },
    /// More samples than were allowed, or than memory holds.
    #[error(
        "expected a sound of at most {most} samples, {secs:.0} s at this rate and channels, found a longer one"
    )]
    TooLong {
        /// The most samples, those of all channels together.
        most: usize,
        /// How long they last, in seconds.
        secs: f64,
    },
}

impl SoundError {
    /// The rates of sounds, in frames a second.
    pub(crate) const RATES: std::ops::RangeInclusive<u32> = 1_000..=768_000;
    /// The most channels of a sound.
    pub(crate) const MOST_CHANNELS: u16 = 32;
}

fn because(reason: &str) -> String {
    if reason.is_empty() { String::new() } else { format!(": {reason}") }
}

/// Something in a file that was passed over or put right.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Note {
    /// Where: seconds from the beginning.
    pub secs: f64,
    /// What it is and what was done.
    pub text: String,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at {:.3} s: {}", self.secs, self.text)
    }
}
