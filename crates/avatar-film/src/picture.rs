use crate::{FilmError, Format};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError};

/// A picture as the bytes of a PNG, with texts as pairs of a keyword and any Unicode (`iTXt`). The keyword is
/// 1 to 79 printable Latin-1 characters; `Title`, `Description` and `Software` are among those that other
/// programs know.
///
/// # Errors
/// The number of bytes is not `width · height · 4`, the picture has no pixels, or a keyword is not allowed.
pub fn png(width: u32, height: u32, rgba: &[u8], texts: &[(&str, &str)]) -> Result<Vec<u8>, FilmError> {
    let expected = (width as usize).saturating_mul(height as usize).saturating_mul(4);
    if rgba.len() != expected {
        return Err(FilmError::Frame { expected, found: rgba.len() });
    }
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    for (keyword, text) in texts {
        let failed = |reason: &dyn ToString| FilmError::Text {
            keyword: (*keyword).to_owned(),
            reason: reason.to_string(),
        };
        let is_latin = |letter: char| matches!(letter, ' '..='~' | '\u{a1}'..='\u{ff}');
        let count = keyword.chars().count();
        if !(1..=79).contains(&count) || !keyword.chars().all(is_latin) {
            return Err(failed(&"no keyword"));
        }
        encoder.add_itxt_chunk((*keyword).to_owned(), (*text).to_owned()).map_err(|error| failed(&error))?;
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(rgba).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

pub(crate) fn failed(error: EncodingError) -> FilmError {
    match error {
        EncodingError::IoError(error) => error.into(),
        other => FilmError::encoder(Format::Apng, other),
    }
}

/// Name of a frame's file among `frames`, counted from 0: as many digits as the last one needs, at least
/// four, so that names sort as frames do.
pub fn frame_name(frame: u64, frames: u64) -> String {
    let digits = frames.saturating_sub(1).checked_ilog10().map_or(1, |log| log as usize + 1).max(4);
    format!("{frame:0digits$}.png")
}
