use crate::{Sound, SoundError};

/// Bytes of the file before its samples.
const HEAD: u32 = 44;
const SAMPLE_BYTES: u32 = 2;

impl Sound {
    /// The sound as a WAV file of 16 bits, which every program plays. Samples beyond -1 to 1 are cut off, and
    /// what is no number is 0.
    ///
    /// # Errors
    /// More than the 4 GiB that a WAV can be long, or a rate or channels that no sound has.
    pub fn to_wav(&self) -> Result<Vec<u8>, SoundError> {
        self.check()?;
        let samples = self.frames() * self.width();
        let too_long = || self.too_long(((u32::MAX - HEAD) / SAMPLE_BYTES) as usize);
        let bytes = u32::try_from(samples).ok().and_then(|count| count.checked_mul(SAMPLE_BYTES));
        let bytes = bytes.filter(|bytes| *bytes <= u32::MAX - HEAD).ok_or_else(too_long)?;
        let frame = u16::try_from(SAMPLE_BYTES).unwrap_or_default() * self.channels;
        let mut out = Vec::new();
        out.try_reserve_exact((HEAD + bytes) as usize).map_err(|_| too_long())?;
        out.extend(b"RIFF");
        out.extend((HEAD - 8 + bytes).to_le_bytes());
        out.extend(b"WAVEfmt ");
        out.extend(16_u32.to_le_bytes());
        // Whole numbers.
        out.extend(1_u16.to_le_bytes());
        out.extend(self.channels.to_le_bytes());
        out.extend(self.rate_hz.to_le_bytes());
        out.extend((self.rate_hz * u32::from(frame)).to_le_bytes());
        out.extend(frame.to_le_bytes());
        out.extend(16_u16.to_le_bytes());
        out.extend(b"data");
        out.extend(bytes.to_le_bytes());
        out.extend(self.samples.iter().take(samples).flat_map(|sample| to_16_bits(*sample).to_le_bytes()));
        Ok(out)
    }

    /// Whether the fields are those of a sound.
    pub(crate) fn check(&self) -> Result<(), SoundError> {
        check(self.rate_hz, self.channels.into())
    }

    pub(crate) fn too_long(&self, most: usize) -> SoundError {
        SoundError::TooLong { most, secs: most as f64 / self.width() as f64 / f64::from(self.rate_hz.max(1)) }
    }
}

pub(crate) fn check(rate_hz: u32, channels: usize) -> Result<(), SoundError> {
    if !SoundError::RATES.contains(&rate_hz) {
        return Err(SoundError::Rate { found: rate_hz });
    }
    if !(1..=usize::from(SoundError::MOST_CHANNELS)).contains(&channels) {
        return Err(SoundError::Channels { found: channels });
    }
    Ok(())
}

/// A sample as a whole number; the cast makes 0 of what is no number.
fn to_16_bits(sample: f32) -> i16 {
    (sample * 32_768.0).round() as i16
}
