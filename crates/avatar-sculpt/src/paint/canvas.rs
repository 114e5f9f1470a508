//! From texture pixels to places on the face, and from colours to files.

use anyhow::{Context as _, Result};
use glam::{DVec2, DVec3};
use image::{ExtendedColorType, ImageEncoder as _, codecs::png};

use crate::{
    skin::Skin,
    surface::half::{Node, Patch},
};

/// What a pixel of a skin texture shows.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// Place at rest; on the character's right `x` is negative.
    pub p: DVec3,
    /// Normal at rest.
    pub normal: DVec3,
    /// The interpolated vertex of the left half.
    pub node: Node,
}

/// For every pixel the place it shows, if any.
#[derive(Debug)]
pub struct Sites {
    side: usize,
    sites: Vec<Option<Site>>,
}

impl Sites {
    /// Draws the skin's triangles into a square picture of texture coordinates.
    #[must_use]
    pub fn of(skin: &Skin, side: usize) -> Self {
        let mut sites = vec![None; side * side];
        for t in &skin.triangles {
            let v = t.map(|i| skin.vertices[i as usize]);
            let nodes = v.map(|v| skin.half.nodes[v.source]);
            let lead = nodes.iter().find(|n| n.patch != Patch::Sheet).copied().unwrap_or(nodes[0]);
            let lower = nodes.iter().filter(|n| n.lower).count() >= 2;
            let uv = v.map(|v| v.uv * side as f64);
            let area = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]);
            if area == 0.0 {
                continue;
            }
            let low = uv[0].min(uv[1]).min(uv[2]).floor().max(DVec2::ZERO);
            let high = uv[0].max(uv[1]).max(uv[2]).ceil().min(DVec2::splat(side as f64 - 1.0));
            for y in low.y as usize..=high.y as usize {
                for x in low.x as usize..=high.x as usize {
                    let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                    let b = (at - uv[0]).perp_dot(uv[2] - uv[0]) / area;
                    let c = (uv[1] - uv[0]).perp_dot(at - uv[0]) / area;
                    let share = [1.0 - b - c, b, c];
                    if share.iter().any(|s| *s < -1e-9) {
                        continue;
                    }
                    let mix = |f: &dyn Fn(usize) -> f64| (0..3).map(|k| share[k] * f(k)).sum::<f64>();
                    let mix3 =
                        |f: &dyn Fn(usize) -> DVec3| (0..3).fold(DVec3::ZERO, |sum, k| sum + share[k] * f(k));
                    let p = mix3(&|k| v[k].p);
                    let node = Node {
                        p: DVec3::new(p.x.abs(), p.y, p.z),
                        lower,
                        lip: mix(&|k| nodes[k].lip),
                        lid: mix(&|k| nodes[k].lid),
                        own: DVec2::new(mix(&|k| nodes[k].own.x), mix(&|k| nodes[k].own.y)),
                        ..lead
                    };
                    let normal = mix3(&|k| v[k].normal).normalize_or_zero();
                    sites[y * side + x] = Some(Site { p, normal, node });
                }
            }
        }
        Self { side, sites }
    }

    /// Paints every pixel that shows something and lets colours run over the borders of the islands.
    #[must_use]
    pub fn paint(&self, colour: impl Fn(&Site) -> DVec3) -> Picture {
        let mut known: Vec<Option<DVec3>> = self.sites.iter().map(|s| s.as_ref().map(&colour)).collect();
        for _ in 0..10 {
            let before = known.clone();
            for y in 0..self.side {
                for x in 0..self.side {
                    if before[y * self.side + x].is_some() {
                        continue;
                    }
                    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
                    for j in y.saturating_sub(1)..=(y + 1).min(self.side - 1) {
                        for i in x.saturating_sub(1)..=(x + 1).min(self.side - 1) {
                            if let Some(c) = before[j * self.side + i] {
                                sum += c;
                                count += 1.0;
                            }
                        }
                    }
                    if count > 0.0 {
                        known[y * self.side + x] = Some(sum / count);
                    }
                }
            }
        }
        let pixels = known.into_iter().map(|c| c.unwrap_or(DVec3::splat(0.5))).collect();
        Picture { width: self.side, pixels }
    }
}

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

    /// The picture with each pixel averaged with its neighbours, `times` times.
    #[must_use]
    pub fn softened(mut self, times: usize) -> Self {
        let side = self.width;
        for _ in 0..times {
            let before = self.pixels.clone();
            for y in 0..side {
                for x in 0..side {
                    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
                    for j in y.saturating_sub(1)..=(y + 1).min(side - 1) {
                        for i in x.saturating_sub(1)..=(x + 1).min(side - 1) {
                            sum += before[j * side + i];
                            count += 1.0;
                        }
                    }
                    self.pixels[y * side + x] = sum / count;
                }
            }
        }
        self
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
    png::PngEncoder::new_with_quality(&mut out, png::CompressionType::Best, png::FilterType::Adaptive)
        .write_image(bytes, width as u32, width as u32, colour)
        .context("cannot encode a picture")?;
    Ok(out)
}
