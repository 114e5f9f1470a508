//! The pictures of the pack, painted as functions of the place on the face rather than of the pixel: the layout of
//! the texture may change without a single stroke moving.

pub mod canvas;
pub mod eye;
pub mod hair;
pub mod marks;
pub mod skin;
pub mod teeth;

use anyhow::Result;
use glam::DVec3;

use crate::skin::Skin;

/// Edge length of the skin's colour picture in pixels.
pub const SKIN_PIXELS: usize = 1024;
/// Edge length of all other pictures.
pub const OTHER_PIXELS: usize = 512;

/// A colour from bytes, each channel 0…1.
#[must_use]
pub fn rgb(r: u8, g: u8, b: u8) -> DVec3 {
    DVec3::new(f64::from(r), f64::from(g), f64::from(b)) / 255.0
}

/// All pictures by file name.
///
/// # Errors
///
/// If a picture cannot be encoded.
pub fn all(skin: &Skin) -> Result<Vec<(String, Vec<u8>)>> {
    let fine = canvas::Sites::of(skin, SKIN_PIXELS);
    let coarse = canvas::Sites::of(skin, OTHER_PIXELS);
    let mut files = vec![
        ("SkinTex_Decal.png".to_owned(), fine.paint(skin::colour).png()?),
        ("SkinTex_AO.png".to_owned(), coarse.paint(skin::occlusion).softened(6).png_grey()?),
        ("SkinTex_Gloss.png".to_owned(), coarse.paint(skin::gloss).png_grey()?),
        ("HairMap.png".to_owned(), coarse.paint(hair::density_colour).png_grey()?),
        ("TeethTex_Decal.png".to_owned(), teeth::picture(OTHER_PIXELS / 2).png()?),
    ];
    for (i, iris) in eye::IRISES.iter().enumerate() {
        files.push((format!("EyeTex_Decal{i:02}.png"), eye::picture(OTHER_PIXELS, iris).png()?));
    }
    Ok(files)
}
