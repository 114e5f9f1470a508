//! Smaller copies of pictures, averaged in linear light.

use crate::gpu::color::{linear_table, srgb8_from_linear, srgb8_in, srgb8_table, unorm8};
use crate::gpu::image::Image;
use glam::Vec4;

/// What the bytes of a picture mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// sRGB colour; colours are weighted by their alpha, which itself is linear.
    Srgb,
    /// Linear numbers.
    Linear,
    /// One linear number, the red one. Green and blue of smaller copies repeat it, and they are opaque.
    Red,
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
    let is_even = image.width.is_multiple_of(2) && image.height.is_multiple_of(2);
    let rgba = if is_even { even(image, encoding) } else { uneven(image, width, height, encoding) };
    Image { width, height, rgba }
}

/// [`half`] of a picture of even width and height: each pixel is the mean of four. Gives the very bytes that
/// [`uneven`] gives, faster: quarters are exact in floating point, and the sums are added up in the same
/// order.
fn even(image: &Image, encoding: Encoding) -> Vec<u8> {
    match encoding {
        Encoding::Srgb => {
            let (linear, encoded) = (linear_table(), srgb8_table());
            of_fours(image, |[a, b, c, d]| {
                if a[3] & b[3] & c[3] & d[3] < 255 {
                    return mean_of([a, b, c, d].into_iter().map(|pixel| (0.25, pixel)), encoding);
                }
                let light = |byte: u8| linear[usize::from(byte)];
                let mean = |a, b, c, d| srgb8_in(encoded, 0.25 * (light(a) + light(b) + light(c) + light(d)));
                [
                    mean(a[0], b[0], c[0], d[0]),
                    mean(a[1], b[1], c[1], d[1]),
                    mean(a[2], b[2], c[2], d[2]),
                    255,
                ]
            })
        }
        Encoding::Linear => of_fours(image, |[a, b, c, d]| {
            // As `unorm8` of each.
            let mean = 0.25 * (shares(a) + shares(b) + shares(c) + shares(d)) * 255.0 + 0.5;
            [mean.x as u8, mean.y as u8, mean.z as u8, mean.w as u8]
        }),
        Encoding::Red => of_fours(image, |[a, b, c, d]| {
            let share = |pixel: [u8; 4]| f32::from(pixel[0]) / 255.0;
            let red = unorm8(0.25 * (share(a) + share(b) + share(c) + share(d)));
            [red, red, red, 255]
        }),
    }
}

fn shares([red, green, blue, alpha]: [u8; 4]) -> Vec4 {
    Vec4::new(f32::from(red), f32::from(green), f32::from(blue), f32::from(alpha)) / 255.0
}

/// A pixel of each two by two. Plain loops: what adapters of iterators become is several times as slow in
/// WebAssembly.
fn of_fours(image: &Image, mean: impl Fn([[u8; 4]; 4]) -> [u8; 4]) -> Vec<u8> {
    let width = image.width as usize;
    let (pixels, _) = image.rgba.as_chunks::<4>();
    let mut means = vec![[0; 4]; pixels.len() / 4];
    for (rows, means) in pixels.chunks_exact(2 * width).zip(means.chunks_exact_mut(width / 2)) {
        let (upper, lower) = rows.split_at(width);
        let (upper, lower) = (upper.as_chunks::<2>().0, lower.as_chunks::<2>().0);
        for ((slot, [a, b]), [c, d]) in means.iter_mut().zip(upper).zip(lower) {
            *slot = mean([*a, *b, *c, *d]);
        }
    }
    means.into_flattened()
}

/// [`half`] of any picture.
fn uneven(image: &Image, width: u32, height: u32, encoding: Encoding) -> Vec<u8> {
    let (columns, rows) = (taps(image.width, width), taps(image.height, height));
    let mut rgba = Vec::with_capacity(4 * width as usize * height as usize);
    for row in &rows {
        for column in &columns {
            let weighted = row.weights.iter().enumerate().flat_map(|(dy, wy)| {
                column.weights.iter().enumerate().filter_map(move |(dx, wx)| {
                    let at = 4 * ((row.first + dy) * image.width as usize + column.first + dx);
                    // Rounding may give a tiny weight to a pixel beyond the last one.
                    let pixel = image.rgba.get(at..at + 4)?.try_into().ok()?;
                    (*wy > 0.0 && *wx > 0.0).then_some((wx * wy, pixel))
                })
            });
            rgba.extend(mean_of(weighted, encoding));
        }
    }
    rgba
}

/// The mean of pixels with these weights, which add up to 1.
fn mean_of(pixels: impl Iterator<Item = (f32, [u8; 4])>, encoding: Encoding) -> [u8; 4] {
    let linear = linear_table();
    let mut sum = [0.0f32; 4];
    let mut plain = [0.0f32; 3];
    for (weight, [r, g, b, a]) in pixels {
        let decode = |byte: u8| match encoding {
            Encoding::Srgb => linear[usize::from(byte)],
            Encoding::Linear | Encoding::Red => f32::from(byte) / 255.0,
        };
        let color = [r, g, b].map(decode);
        let alpha = f32::from(a) / 255.0;
        for (c, value) in color.iter().enumerate() {
            sum[c] += weight * alpha * value;
            plain[c] += weight * value;
        }
        sum[3] += weight * alpha;
    }
    let [r, g, b] = match encoding {
        Encoding::Srgb if sum[3] > 0.0 => [0, 1, 2].map(|c| srgb8_from_linear(sum[c] / sum[3])),
        // Wholly transparent: keep the colour, it may be filtered against a visible neighbour.
        Encoding::Srgb => plain.map(srgb8_from_linear),
        Encoding::Linear => plain.map(unorm8),
        Encoding::Red => return [unorm8(plain[0]), unorm8(plain[0]), unorm8(plain[0]), 255],
    };
    [r, g, b, unorm8(sum[3])]
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
        fn the_short_way_gives_the_bytes_of_the_long_one(
            w in 1u32..9,
            h in 1u32..9,
            bytes in proptest::collection::vec(any::<u8>(), 16 * 16 * 4),
            is_opaque: bool,
        ) {
            let picture = image(2 * w, 2 * h, |x, y| {
                let at = 4 * (y * 2 * w + x) as usize;
                let alpha = if is_opaque { 255 } else { bytes[at + 3] / 64 * 85 };
                [bytes[at], bytes[at + 1], bytes[at + 2], alpha]
            });
            for encoding in [Encoding::Srgb, Encoding::Linear, Encoding::Red] {
                prop_assert_eq!(even(&picture, encoding), uneven(&picture, w, h, encoding));
            }
            let reds = |encoding| half(&picture, encoding).rgba.into_iter().step_by(4).collect::<Vec<_>>();
            prop_assert_eq!(reds(Encoding::Red), reds(Encoding::Linear));
        }

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
