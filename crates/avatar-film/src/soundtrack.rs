use crate::{FilmError, Format};

/// The sound of a film, from its first frame on.
#[derive(Clone, Debug, PartialEq)]
pub struct Soundtrack {
    /// Frames of sound a second, one of [`Self::RATES`].
    pub rate_hz: u32,
    /// One or two.
    pub channels: u16,
    /// Samples from -1 to 1, those of two channels one after the other; what is beyond is cut off.
    pub samples: Vec<f32>,
}

impl Soundtrack {
    /// The rates that a film's sound can have, in frames a second (ISO/IEC 14496-3, table 1.18, as far as
    /// MP4's own field of the rate goes).
    pub const RATES: [u32; 9] = [8_000, 11_025, 12_000, 16_000, 22_050, 24_000, 32_000, 44_100, 48_000];

    /// The rate to which a sound of another rate should be brought: the next one above, or the highest.
    pub fn rate_for(rate_hz: u32) -> u32 {
        let [.., highest] = Self::RATES;
        Self::RATES.into_iter().find(|rate| *rate >= rate_hz).unwrap_or(highest)
    }

    /// Whether a film of this format can have this sound.
    pub(crate) fn check(&self, format: Format) -> Result<(), FilmError> {
        let error = |expected: String, found: String| FilmError::Sound { format, expected, found };
        if !format.keeps_sound() {
            return Err(error("no sound, which it cannot hold".to_owned(), "sound".to_owned()));
        }
        if !Self::RATES.contains(&self.rate_hz) {
            let rates = Self::RATES.map(|rate| rate.to_string()).join(", ");
            return Err(error(format!("one of {rates} samples a second"), self.rate_hz.to_string()));
        }
        if !(1..=2).contains(&self.channels) {
            return Err(error(
                "sound of one or two channels".to_owned(),
                format!("{} channels", self.channels),
            ));
        }
        Ok(())
    }
}
