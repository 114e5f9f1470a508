//! Random numbers that are functions of a counter: any of them can be had without those before it, and they are the same
//! on every machine.

/// The numbers of one purpose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stream(u64);

/// The finaliser of SplitMix64: G. Steele et al., "Fast Splittable Pseudorandom Number Generators", 2014.
fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// 2⁶⁴ divided by the golden ratio, made odd.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

impl Stream {
    pub(crate) fn new(seed: u64) -> Self {
        Self(mixed(seed.wrapping_add(STEP)))
    }

    /// The numbers of one thing among many.
    pub(crate) fn of(self, index: u64) -> Self {
        Self(mixed(self.0 ^ mixed(index.wrapping_add(1).wrapping_mul(STEP))))
    }

    pub(crate) fn bits(self, counter: u64) -> u64 {
        mixed(self.0.wrapping_add(counter.wrapping_add(1).wrapping_mul(STEP)))
    }

    /// From 0 to below 1, in steps of 2⁻²⁴.
    pub(crate) fn unit(self, counter: u64) -> f32 {
        (self.bits(counter) >> 40) as f32 / (1u64 << 24) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::Stream;

    #[test]
    fn numbers_are_the_same_everywhere_and_fill_the_unit_interval_evenly() {
        let stream = Stream::new(7).of(3);
        assert_eq!(stream.bits(0), Stream::new(7).of(3).bits(0));
        assert_ne!(stream.bits(0), Stream::new(8).of(3).bits(0));
        assert_ne!(stream.bits(0), Stream::new(7).of(4).bits(0));
        let mut counts = [0u32; 64];
        for counter in 0..64_000 {
            counts[(stream.unit(counter) * 64.0) as usize] += 1;
        }
        let chi_square: f64 = counts.iter().map(|&n| (f64::from(n) - 1000.0).powi(2) / 1000.0).sum();
        // 63 degrees of freedom: beyond 103 once in a thousand.
        assert!(chi_square < 103.0, "{chi_square}");
    }
}
