//! Numbers that look like chance, the same in each run.

use crate::SHAPES;

/// xorshift64*.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % end
    }

    /// Of few digits, so that texts say it exactly.
    pub(crate) fn share(&mut self) -> f32 {
        self.below(65) as f32 / 64.0
    }

    pub(crate) fn one_of<'a>(&mut self, texts: &[&'a str]) -> &'a str {
        texts[self.below(texts.len() as u64) as usize]
    }
}

pub(crate) fn binds(random: &mut Random) -> Vec<(u64, f32)> {
    (0..random.below(4)).map(|_| (random.below(SHAPES as u64), random.share())).collect()
}

pub(crate) fn vector(random: &mut Random) -> [f32; 3] {
    [0; 3].map(|_| 2.0 * random.share() - 1.0)
}
