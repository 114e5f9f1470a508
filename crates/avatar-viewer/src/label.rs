//! Text in pictures.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont};
use anyhow::{Context, Result};
use image::RgbaImage;

/// Draws one line of text, centred on `center_x`, with its baseline at `baseline_y`; what leaves the picture
/// is cut.
pub(crate) fn draw(
    picture: &mut RgbaImage,
    text: &str,
    center_x: f32,
    baseline_y: f32,
    pixels: f32,
    color: [u8; 3],
) -> Result<()> {
    let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).context("the built-in font")?;
    let scaled = font.as_scaled(PxScale::from(pixels));
    let width: f32 = text.chars().map(|c| scaled.h_advance(scaled.glyph_id(c))).sum();
    let mut x = center_x - width / 2.0;
    for c in text.chars() {
        let id = scaled.glyph_id(c);
        let glyph = id.with_scale_and_position(pixels, ab_glyph::point(x, baseline_y));
        x += scaled.h_advance(id);
        let Some(outline) = font.outline_glyph(glyph) else { continue };
        let origin = outline.px_bounds().min;
        outline.draw(|dx, dy, coverage| {
            let (px, py) = (origin.x + dx as f32, origin.y + dy as f32);
            if px >= 0.0
                && py >= 0.0
                && let Some(pixel) = picture.get_pixel_mut_checked(px as u32, py as u32)
            {
                for (under, over) in pixel.0.iter_mut().zip(color) {
                    let mixed = f32::from(*under) + (f32::from(over) - f32::from(*under)) * coverage.min(1.0);
                    *under = mixed.round() as u8;
                }
            }
        });
    }
    Ok(())
}
