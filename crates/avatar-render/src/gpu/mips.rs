//! Smaller copies of pictures, averaged in linear light.

use crate::gpu::color::{linear_table, srgb8_from_linear, unorm8};
use crate::gpu::image::Image;

/// What the bytes of a picture mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// sRGB colour; colours are weighted by their alpha, which itself is linear.
    Srgb,
    /// Linear numbers.
    Linear,
}

/// The weights of source pixels along one axis in one target pixel. Halving `2n + 1` pixels to `n` takes up
/// to three.
struct Tap {
    first: usize,
    weights: [f32; 3],
}

fn taps(from: u32, to: u32) -> Vec<Tap> {
    let scale = f64::from(from) / f64::from(to);
    (0..to)
        .map(|i| {
            let (start, end) = (f64::from(i) * scale, f64::from(i + 1) * scale);
            let first = start.floor();
            let covered = |k: f64| ((first + k + 1.0).min(end) - (first + k).max(start)).max(0.0);
            let weights = [0.0, 1.0, 2.0].map(|k| (covered(k) / scale) as f32);
            Tap { first: first as usize, weights }
        })
        .collect()
}

/// The picture at half the size (rounded down, at least 1): each pixel is the mean of the area that it
/// covers.
pub(crate) fn half(image: &Image, encoding: Encoding) -> Image {
    let (width, height) = ((image.width / 2).max(1), (image.height / 2).max(1));
    let (columns, rows) = (taps(image.width, width), taps(image.height, height));
    let linear = linear_table();
    let mut rgba = Vec::with_capacity(4 * width as usize * height as usize);
    for row in &rows {
        for column in &columns {
            let mut sum = [0.0f32; 4];
            let mut plain = [0.0f32; 3];
            for (dy, wy) in row.weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
                for (dx, wx) in column.weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
                    let at = 4 * ((row.first + dy) * image.width as usize + column.first + dx);
                    // Rounding may give a tiny weight to a pixel beyond the last one.
                    let Some([r, g, b, a]) = image.rgba.get(at..at + 4) else { continue };
                    let decode = |byte: u8| match encoding {
                        Encoding::Srgb => linear[usize::from(byte)],
                        Encoding::Linear => f32::from(byte) / 255.0,
                    };
                    let weight = wx * wy;
                    let color = [*r, *g, *b].map(decode);
                    let alpha = f32::from(*a) / 255.0;
                    for (c, value) in color.iter().enumerate() {
                        sum[c] += weight * alpha * value;
                        plain[c] += weight * value;
                    }
                    sum[3] += weight * alpha;
                }
            }
            match encoding {
                Encoding::Srgb if sum[3] > 0.0 => {
                    rgba.extend([0, 1, 2].map(|c| srgb8_from_linear(sum[c] / sum[3])));
                }
                // Wholly transparent: keep the colour, it may be filtered against a visible neighbour.
                Encoding::Srgb => rgba.extend(plain.map(srgb8_from_linear)),
                Encoding::Linear => rgba.extend(plain.map(unorm8)),
            }
            rgba.push(unorm8(sum[3]));
        }
    }
    Image { width, height, rgba }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn image(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let rgba = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| pixel(x, y));
        Image { width, height, rgba: rgba.collect() }
    }

    #[test]
    fn black_and_white_average_in_linear_light() {
        let checker = image(2, 2, |x, y| if (x + y) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] });
        assert_eq!(half(&checker, Encoding::Srgb).rgba, [188, 188, 188, 255]);
        assert_eq!(half(&checker, Encoding::Linear).rgba, [128, 128, 128, 255]);
    }

    #[test]
    fn transparent_pixels_do_not_stain_visible_ones() {
        let edge = image(2, 1, |x, _| if x == 0 { [200, 10, 10, 255] } else { [0, 255, 0, 0] });
        assert_eq!(half(&edge, Encoding::Srgb).rgba, [200, 10, 10, 128]);
    }

    proptest! {
        #[test]
        fn one_colour_stays_that_colour_at_every_size(w in 1u32..40, h in 1u32..40, c: [u8; 4]) {
            let mut level = image(w, h, |_, _| c);
            while level.width > 1 || level.height > 1 {
                level = half(&level, Encoding::Linear);
                prop_assert!(level.check().is_ok());
                prop_assert!(level.rgba.iter().zip(c.iter().cycle()).all(|(a, b)| a.abs_diff(*b) <= 1));
            }
        }

        #[test]
        fn the_mean_survives(w in 1u32..30, h in 1u32..30, seed: u32) {
            let noisy = image(w, h, |x, y| {
                let v = (x.wrapping_mul(73) ^ y.wrapping_mul(151) ^ seed).wrapping_mul(2_654_435_761) >> 24;
                [v as u8; 4]
            });
            let mean = |i: &Image| i.rgba.iter().map(|v| f64::from(*v)).sum::<f64>() / i.rgba.len() as f64;
            prop_assert!((mean(&noisy) - mean(&half(&noisy, Encoding::Linear))).abs() <= 0.51);
        }
    }
}
