//! The pictures of a scene, decoded once and within a budget.

use crate::Warning;
use crate::textures::{bytes_while_decoding, decoder, kept_bytes, rgba};
use avatar_exchange::{Scene, SceneImage, TextureRef, memory};
use image::{ImageDecoder, RgbaImage};
use std::collections::BTreeSet;

/// The pictures of a scene by their places there; those that nothing uses are not decoded.
pub(crate) struct Pictures {
    images: Vec<Option<RgbaImage>>,
    least_alpha: Vec<f32>,
    warnings: Vec<Warning>,
}

impl Pictures {
    /// Decodes these pictures. What cannot be decoded, or exceeds the budget, is one warning.
    pub(crate) fn decoded(scene: &Scene, used: impl Iterator<Item = TextureRef>) -> Self {
        let used: BTreeSet<usize> = used.map(|texture| texture.image).collect();
        let mut all = Self {
            images: vec![None; scene.images.len()],
            least_alpha: vec![1.0; scene.images.len()],
            warnings: Vec::new(),
        };
        let encoded: u64 = scene.images.iter().map(|image| image.bytes.len() as u64).sum();
        let mut room = memory::share(memory::PICTURES, encoded);
        for (place, image) in scene.images.iter().enumerate().filter(|(place, _)| used.contains(place)) {
            match decoded(image, &mut room) {
                Ok(picture) => {
                    let least = picture.pixels().map(|pixel| pixel.0[3]).min().unwrap_or(255);
                    all.least_alpha[place] = f32::from(least) / 255.0;
                    all.images[place] = Some(picture);
                }
                Err(problem) => {
                    let name = &image.name;
                    let file = if name.is_empty() { format!("image {place}") } else { name.clone() };
                    all.warnings.push(Warning::Texture { file, problem });
                }
            }
        }
        all
    }

    /// The place of a texture's picture, if it could be decoded.
    pub(crate) fn used(&self, texture: Option<TextureRef>) -> Option<usize> {
        let place = texture?.image;
        self.images.get(place)?.as_ref().map(|_| place)
    }

    /// The least opacity in a texture; 1 without one.
    pub(crate) fn least_alpha(&self, texture: Option<TextureRef>) -> f32 {
        texture.and_then(|texture| self.least_alpha.get(texture.image)).copied().unwrap_or(1.0)
    }

    /// The pictures by their places in the scene, and what is wrong with others.
    pub(crate) fn into_parts(self) -> (Vec<Option<RgbaImage>>, Vec<Warning>) {
        (self.images, self.warnings)
    }
}

/// `room` is what is left for pictures; the decoded one takes its bytes from it.
fn decoded(image: &SceneImage, room: &mut u64) -> Result<RgbaImage, String> {
    if image.bytes.is_empty() {
        return Err("expected a picture, found none; its plain colour shows".to_owned());
    }
    let is_ktx = image.bytes.starts_with(b"\xabKTX ") || image.mime == "image/ktx2";
    let expected = "expected a picture (PNG, JPEG, WebP, TGA or BMP)";
    if is_ktx {
        return Err(format!("{expected}, found KTX, which is not read; its plain colour shows"));
    }
    let not_read = |error: image::ImageError| format!("{expected}, found: {error}; its plain colour shows");
    let decoder = decoder(&image.name, &image.bytes).map_err(not_read)?;
    let ((width, height), kept) = (decoder.dimensions(), kept_bytes(&decoder));
    if bytes_while_decoding(&decoder) > *room {
        let (free, per_byte) = memory::PICTURES;
        return Err(format!(
            "expected pictures of at most {free} bytes and {per_byte} for each byte of the file, found one of {width}×{height} pixels beyond that; its plain colour shows"
        ));
    }
    let picture = rgba(decoder).map_err(not_read)?;
    *room -= kept;
    Ok(picture)
}
