//! Random numbers that are the same in each run (SplitMix64; Steele, Lea & Flood 2014), and random frames.

use avatar_live::{Frame, channels};

pub(crate) struct Chance(u64);

impl Chance {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to 1.
    pub(crate) fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn within(&mut self, min: f64, max: f64) -> f64 {
        min + (max - min) * self.share()
    }

    /// A frame with the shapes of ARKit, some at their ends, and angles that stay in front.
    pub(crate) fn frame(&mut self) -> Frame {
        let mut frame = Frame::default();
        for (index, channel) in channels().iter().enumerate().take(59) {
            let value = match channel.min < 0.0 {
                true => self.within(-60.0, 60.0) as f32,
                false => (self.within(-0.1, 1.1) as f32).clamp(0.0, 1.0),
            };
            frame.set(index, value);
        }
        frame
    }
}
