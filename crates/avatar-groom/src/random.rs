//! Random numbers that belong to a place instead of a sequence: the same for the same counter, in any order.

/// SplitMix64's finaliser: G. Steele et al., "Fast Splittable Pseudorandom Number Generators", 2014.
pub(crate) fn bits(seed: u64, counter: u64) -> u64 {
    let mut z = seed.wrapping_add(counter.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// From 0 to below 1.
pub(crate) fn unit(seed: u64, counter: u64) -> f32 {
    (bits(seed, counter) >> 40) as f32 / (1u64 << 24) as f32
}
