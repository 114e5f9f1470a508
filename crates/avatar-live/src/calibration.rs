//! What counts as a person's neutral face, and how much of the rest an avatar shows.

use crate::Frame;
use crate::channel::{CHANNELS, channels, find};
use placed_toml::{Document, TomlError};
use std::fmt::Write as _;

/// The largest gain that a file may ask for.
const MOST_GAIN: f32 = 10.0;

/// What a sender says of a person's face at rest, and factors for what is beyond that.
///
/// ```toml
/// [neutral]              # what the sender says of the face at rest; angles in degrees
/// jawOpen = 0.06
/// "head.bow" = -4.5
///
/// [gain]                 # 1 is as it comes
/// mouthSmileLeft = 1.3
/// ```
///
/// A weight becomes `gain · (value − neutral) / (1 − neutral)`, so that 1 stays 1 without a gain; an angle
/// `gain · (value − neutral)`. Both are kept within the channel's range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    neutral: [f32; CHANNELS],
    gain: [f32; CHANNELS],
}

impl Default for Calibration {
    /// One that changes nothing.
    fn default() -> Self {
        Self { neutral: [0.0; CHANNELS], gain: [1.0; CHANNELS] }
    }
}

impl Calibration {
    /// Reads a file's text. Names are those of [`channels`], in capitals or not.
    ///
    /// # Errors
    /// A name that is no channel's, a neutral value outside its channel's range, a gain outside 0 to 10.
    pub fn from_toml(text: &str) -> Result<Self, TomlError> {
        let mut new = Self::default();
        let document = Document::parse(text)?;
        let mut root = document.root();
        for (key, values) in [("neutral", &mut new.neutral), ("gain", &mut new.gain)] {
            let Some(table) = root.take(key) else { continue };
            for entry in table.table()?.rest() {
                let place = find(entry.name().as_bytes());
                let names = || channels().iter().map(|channel| channel.name);
                let place = place.ok_or_else(|| entry.unknown_name(entry.name(), "one of", names()))?;
                let range = match channels().get(place) {
                    Some(channel) if key == "neutral" => channel.min..=channel.max,
                    _ => 0.0..=MOST_GAIN,
                };
                let expected = format!("a number from {} to {}", range.start(), range.end());
                let value = entry.number_within(range, &expected)?;
                if let Some(slot) = values.get_mut(place) {
                    *slot = value;
                }
            }
        }
        root.finish(&["neutral", "gain"])?;
        Ok(new)
    }

    /// As a file's text, with what differs from [`Self::default`]; read again, it is the same.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        for (key, values, usual) in [("neutral", &self.neutral, 0.0), ("gain", &self.gain, 1.0)] {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{}[{key}]", if text.is_empty() { "" } else { "\n" });
            for (channel, value) in channels().iter().zip(values).filter(|(_, value)| **value != usual) {
                let _ = writeln!(text, "{} = {value:?}", placed_toml::string(channel.name));
            }
        }
        text
    }

    /// What the sender says of the face at rest; 0 for what it does not say.
    pub fn neutral(&self, channel: usize) -> f32 {
        self.neutral.get(channel).copied().unwrap_or_default()
    }

    /// The factor of a channel.
    pub fn gain(&self, channel: usize) -> f32 {
        self.gain.get(channel).copied().unwrap_or(1.0)
    }

    /// Whether another face than one of zeros counts as neutral.
    pub fn has_neutral(&self) -> bool {
        self.neutral.iter().any(|value| *value != 0.0)
    }

    /// Takes a frame for the face at rest. Gains stay.
    #[must_use]
    pub fn with_neutral(&self, neutral: &Frame) -> Self {
        Self { neutral: *neutral.values(), ..*self }
    }

    /// The channel's value as it is to be shown.
    pub(crate) fn apply(&self, channel: usize, value: f32) -> f64 {
        let (neutral, gain) = (f64::from(self.neutral(channel)), f64::from(self.gain(channel)));
        let value = f64::from(value);
        match channels().get(channel) {
            Some(channel) if channel.min < 0.0 => {
                (gain * (value - neutral)).clamp(channel.min.into(), channel.max.into())
            }
            // Little is left to be told apart by.
            _ if neutral >= 0.9 => (gain * value).clamp(0.0, 1.0),
            _ => (gain * (value - neutral) / (1.0 - neutral)).clamp(0.0, 1.0),
        }
    }
}
