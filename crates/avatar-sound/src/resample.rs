use crate::wav::check;
use crate::{Sound, SoundError};
use rubato::audioadapter_buffers::direct::InterleavedSlice;
use rubato::{Async, FixedAsync, Resampler, SincInterpolationParameters, WindowFunction};

/// Frames that are worked on at a time.
const CHUNK: usize = 1024;
/// Length of the filter, in frames.
const FILTER: usize = 128;

impl Sound {
    /// The same sound with so many frames a second, from 1,000 to 768,000: band-limited (a windowed sinc),
    /// and in time to within about one of its frames. Memory grows with the rate.
    ///
    /// # Errors
    /// Rates or channels that no sound has.
    pub fn resampled(&self, rate_hz: u32) -> Result<Self, SoundError> {
        self.check()?;
        check(rate_hz, 1)?;
        let (frames, channels) = (self.frames(), self.width());
        if rate_hz == self.rate_hz || frames == 0 {
            return Ok(Self { rate_hz, ..self.clone() });
        }
        let failed = |reason: &dyn std::fmt::Display| SoundError::Damaged { reason: reason.to_string() };
        let ratio = f64::from(rate_hz) / f64::from(self.rate_hz);
        let filter = SincInterpolationParameters::new(FILTER, WindowFunction::BlackmanHarris2);
        let mut resampler = Async::<f32>::new_sinc(ratio, 1.0, &filter, CHUNK, channels, FixedAsync::Input)
            .map_err(|error| failed(&error))?;
        let sound = InterleavedSlice::new(&self.samples, channels, frames).map_err(|error| failed(&error))?;
        let made = resampler.process_all(&sound, frames, None).map_err(|error| failed(&error))?;
        Ok(Self { rate_hz, channels: self.channels, samples: made.take_data() })
    }
}
