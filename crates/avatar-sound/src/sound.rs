use std::borrow::Cow;

/// How much of a file is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most samples, those of all channels together; four bytes each.
    pub max_samples: usize,
}

impl Default for Limits {
    /// 512 MiB: 46 minutes of one channel at 48 kHz, over two hours at 16 kHz.
    fn default() -> Self {
        Self { max_samples: 1 << 27 }
    }
}

/// A sound as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Sound {
    /// Frames a second.
    pub rate_hz: u32,
    /// Samples in a frame.
    pub channels: u16,
    /// Samples from -1 to 1, frame after frame.
    pub samples: Vec<f32>,
}

impl Sound {
    /// How many moments it has; a last one that lacks channels does not count.
    pub fn frames(&self) -> usize {
        self.samples.len() / self.width()
    }

    /// How long it lasts, in seconds.
    pub fn secs(&self) -> f64 {
        self.frames() as f64 / f64::from(self.rate_hz.max(1))
    }

    /// One channel: the mean of all.
    pub fn mono(&self) -> Cow<'_, [f32]> {
        if self.channels <= 1 {
            return Cow::Borrowed(&self.samples);
        }
        let share = 1.0 / self.width() as f32;
        let frames = self.samples.chunks_exact(self.width());
        Cow::Owned(frames.map(|frame| frame.iter().sum::<f32>() * share).collect())
    }

    /// Samples in a frame; at least one, whatever the field says.
    pub(crate) fn width(&self) -> usize {
        usize::from(self.channels.max(1))
    }
}
