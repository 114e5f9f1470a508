//! Pictures as files: PNG, JPEG and WebP, each with what the face does in it.

use crate::ending::{Endings, listed};
use crate::output::OutputFile;
use crate::standard;
use crate::usage::usage;
use anyhow::{Context, Result};
use image::codecs::jpeg::JpegEncoder;
use image::codecs::webp::WebPEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbaImage};

/// A kind of file that holds one picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PictureFormat {
    Png,
    Jpeg,
    /// Without loss.
    WebP,
}

/// Quality of a JPEG, of 100: no blocks are seen, and a face has a fifth of the bytes of its PNG.
const JPEG_QUALITY: u8 = 92;
/// Keyword of the text in a PNG that says what the face does.
const KEYWORD: &str = "Mimik";
/// The program's name in a picture.
const SOFTWARE: &str = concat!("Mimik ", env!("CARGO_PKG_VERSION"));
/// A segment of a JPEG holds so many bytes, with a header in front of them.
const LARGEST_EXIF: usize = 65_000;

impl PictureFormat {
    /// What names of pictures end in.
    pub(crate) const ENDINGS: Endings<'static, Self> =
        &[("png", Self::Png), ("jpg", Self::Jpeg), ("jpeg", Self::Jpeg), ("webp", Self::WebP)];

    /// Whether pixels can be transparent.
    const fn keeps_alpha(self) -> bool {
        !matches!(self, Self::Jpeg)
    }

    /// The longest side.
    const fn largest(self) -> u32 {
        match self {
            Self::Png => i32::MAX as u32,
            Self::Jpeg => 65_535,
            Self::WebP => 16_384,
        }
    }

    /// Checks that the format holds such a picture.
    pub(crate) fn check(self, [width, height]: [u32; 2], background: [u8; 4]) -> Result<()> {
        if background[3] < 255 && !self.keeps_alpha() {
            let others = Self::ENDINGS.iter().filter(|(_, format)| format.keeps_alpha());
            let others = listed(others.map(|(ending, _)| *ending));
            return Err(no_alpha(self.name(), &others));
        }
        let largest = self.largest();
        if width.max(height) > largest {
            let name = self.name();
            return Err(usage(format!(
                "{name}: expected a picture of at most {largest} pixels a side, found {width}x{height}: a .png can hold it"
            )));
        }
        Ok(())
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::WebP => "WebP",
        }
    }

    /// A picture as the bytes of a file. `state` says what the face does
    /// ([`crate::face_args::FaceChoice::describe`]).
    pub(crate) fn encode(self, picture: &RgbaImage, state: &str) -> Result<Vec<u8>> {
        let (width, height) = picture.dimensions();
        let mut bytes = Vec::new();
        match self {
            Self::Png => {
                let texts = [("Software", SOFTWARE), (KEYWORD, state)];
                return Ok(avatar_film::png(width, height, picture.as_raw(), &texts)?);
            }
            Self::Jpeg => {
                let rgb: Vec<u8> =
                    picture.pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
                let mut encoder = JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY);
                describe(&mut encoder, state)?;
                encoder.write_image(&rgb, width, height, ExtendedColorType::Rgb8)
            }
            Self::WebP => {
                let mut encoder = WebPEncoder::new_lossless(&mut bytes);
                describe(&mut encoder, state)?;
                encoder.write_image(picture.as_raw(), width, height, ExtendedColorType::Rgba8)
            }
        }
        .with_context(|| format!("{}: expected a picture that can be encoded", self.name()))?;
        Ok(bytes)
    }
}

/// A transparent background is asked for, and the format knows none.
pub(crate) fn no_alpha(format: &str, others: &str) -> anyhow::Error {
    usage(format!(
        "--background transparent: expected a format with transparency ({others}), found {format}, which has none"
    ))
}

/// Writes a picture with what the face does in it.
pub(crate) fn still(out: &OutputFile, format: PictureFormat, picture: &RgbaImage, state: &str) -> Result<()> {
    out.write(&format.encode(picture, state)?)
}

/// Puts what the face does into a picture's EXIF, where JPEG and WebP have room for texts.
fn describe(encoder: &mut impl ImageEncoder, state: &str) -> Result<()> {
    let exif = exif(&format!("{KEYWORD}: {state}"));
    if exif.len() > LARGEST_EXIF {
        standard::warn(
            "expected a face that can be said in 65 KB, found a longer one: the picture does not say it",
        );
        return Ok(());
    }
    Ok(encoder.set_exif_metadata(exif)?)
}

/// EXIF with a description and the program's name: a TIFF of one directory (Exif 2.32, sections 4.5 and
/// 4.6.4). It has to be ASCII there; programs read UTF-8.
fn exif(description: &str) -> Vec<u8> {
    const IMAGE_DESCRIPTION: u16 = 0x010e;
    const SOFTWARE_TAG: u16 = 0x0131;
    const ASCII: u16 = 2;
    // The number of entries, two entries of twelve bytes, and that no directory follows.
    const DIRECTORY_BYTES: u32 = 2 + 2 * 12 + 4;
    let texts = [(IMAGE_DESCRIPTION, description), (SOFTWARE_TAG, SOFTWARE)];
    let mut bytes = b"II*\0".to_vec();
    let mut text_at = bytes.len() as u32 + 4 + DIRECTORY_BYTES;
    bytes.extend(8_u32.to_le_bytes());
    bytes.extend((texts.len() as u16).to_le_bytes());
    for (tag, text) in texts {
        // With the zero at its end. Up to four bytes would stand in the entry itself; both texts are longer.
        let length = text.len() as u32 + 1;
        bytes.extend([tag.to_le_bytes(), ASCII.to_le_bytes()].concat());
        bytes.extend([length.to_le_bytes(), text_at.to_le_bytes()].concat());
        text_at += length;
    }
    bytes.extend([0; 4]);
    for (_, text) in texts {
        bytes.extend(text.as_bytes());
        bytes.push(0);
    }
    bytes
}
