//! Pictures and their files.

use anyhow::{Context as _, Result};
use glam::{DVec2, DVec3};
use image::{ExtendedColorType, ImageEncoder as _, codecs::png};

/// A square picture, each channel 0…1.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Edge length in pixels.
    pub width: usize,
    /// Rows from the top.
    pub pixels: Vec<DVec3>,
}

impl Picture {
    /// Paints a picture from texture coordinates.
    #[must_use]
    pub fn from_uv(width: usize, colour: impl Fn(DVec2) -> DVec3) -> Self {
        let at = |i: usize| (i as f64 + 0.5) / width as f64;
        let pixels = (0..width * width).map(|i| colour(DVec2::new(at(i % width), at(i / width)))).collect();
        Self { width, pixels }
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    ///
    /// If the encoder refuses.
    pub fn png(&self) -> Result<Vec<u8>> {
        let bytes: Vec<u8> = self.pixels.iter().flat_map(|c| c.to_array().map(byte)).collect();
        encode(&bytes, self.width, ExtendedColorType::Rgb8)
    }

    /// The first channel as a grey PNG file.
    ///
    /// # Errors
    ///
    /// If the encoder refuses.
    pub fn png_grey(&self) -> Result<Vec<u8>> {
        let bytes: Vec<u8> = self.pixels.iter().map(|c| byte(c.x)).collect();
        encode(&bytes, self.width, ExtendedColorType::L8)
    }
}

fn byte(channel: f64) -> u8 {
    (channel.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

fn encode(bytes: &[u8], width: usize, colour: ExtendedColorType) -> Result<Vec<u8>> {
    let mut out = Vec::new();
    png::PngEncoder::new_with_quality(&mut out, png::CompressionType::Best, png::FilterType::Up)
        .write_image(bytes, width as u32, width as u32, colour)
        .context("cannot encode a picture")?;
    Ok(out)
}
