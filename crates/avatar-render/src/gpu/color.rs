//! Linear light and 8-bit sRGB: IEC 61966-2-1.

use half::f16;
use std::sync::OnceLock;

/// Linear light from an 8-bit sRGB colour with straight alpha, which is not encoded.
pub fn linear_from_srgb8(srgb: [u8; 4]) -> [f32; 4] {
    let [red, green, blue, alpha] = srgb.map(|byte| f32::from(byte) / 255.0);
    [linear_from_srgb(red), linear_from_srgb(green), linear_from_srgb(blue), alpha]
}

pub(crate) fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

pub(crate) fn srgb_from_linear(linear: f32) -> f32 {
    let c = linear.clamp(0.0, 1.0);
    if c <= 0.0031308 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// Linear light of each of the 256 values.
pub(crate) fn linear_table() -> &'static [f32; 256] {
    static TABLE: OnceLock<[f32; 256]> = OnceLock::new();
    TABLE.get_or_init(|| std::array::from_fn(|i| linear_from_srgb(i as f32 / 255.0)))
}

pub(crate) fn unorm8(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// `unorm8(srgb_from_linear(linear))` from a table: pictures have millions of values. 2¹⁶ steps are finer
/// than the steepest 8-bit step by a factor of 20.
pub(crate) fn srgb8_from_linear(linear: f32) -> u8 {
    srgb8_in(srgb8_table(), linear)
}

/// The table of [`srgb8_from_linear`], for loops that look it up once.
pub(crate) fn srgb8_table() -> &'static [u8] {
    static TABLE: OnceLock<Vec<u8>> = OnceLock::new();
    TABLE.get_or_init(|| (0..=65535).map(|i| unorm8(srgb_from_linear(i as f32 / 65535.0))).collect())
}

/// [`srgb8_from_linear`] with its table.
pub(crate) fn srgb8_in(table: &[u8], linear: f32) -> u8 {
    table.get((linear.clamp(0.0, 1.0) * 65535.0 + 0.5) as usize).copied().unwrap_or(255)
}

/// The bits of the nearest f16; numbers beyond its range become its largest finite one.
pub(crate) fn half_bits(value: f32) -> u16 {
    f16::from_f32(value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32())).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_8_bit_value_survives_the_round_trip() {
        for value in 0..=255u8 {
            assert_eq!(srgb8_from_linear(linear_table()[usize::from(value)]), value);
        }
    }
}
