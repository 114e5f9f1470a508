/// From colours encoded as sRGB to linear ones (IEC 61966-2-1). What is out of range is brought into it.
pub(crate) fn linear(encoded: [f32; 3]) -> [f32; 3] {
    encoded.map(|x| {
        let x = x.clamp(0.0, 1.0);
        if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    })
}
