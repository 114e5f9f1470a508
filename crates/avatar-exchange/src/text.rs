//! What readers of text formats share: decoding, numbers, and errors that name their line.

use crate::ImportError;
use std::borrow::Cow;

/// Text of a file in UTF-8, or in UTF-16 with a byte-order mark. Other encodings spoil names only: what is no UTF-8
/// is replaced.
pub(crate) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    let wide = |unit: fn([u8; 2]) -> u16| {
        let units = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
        let chars = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER));
        Cow::Owned(chars.collect())
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        _ => String::from_utf8_lossy(bytes),
    }
}

/// An error at a line, counted from 1.
pub(crate) fn at_line(line: usize, expected: impl Into<String>, found: impl Into<String>) -> ImportError {
    ImportError::new(format!("line {line}"), expected, found)
}

/// A word of a file as messages show it: not more of it than one wants to read.
pub(crate) fn shown(word: &str) -> String {
    const LONGEST: usize = 40;
    match word.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{:?}…", &word[..end]),
        None => format!("{word:?}"),
    }
}

/// A finite number.
pub(crate) fn number(line: usize, what: &str, word: Option<&str>) -> Result<f64, ImportError> {
    let Some(word) = word else { return Err(at_line(line, what, "nothing")) };
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(at_line(line, format!("{what}, a finite number"), shown(word))),
    }
}

/// The f32 nearest to a number, which must be finite, too.
pub(crate) fn float(line: usize, what: &str, word: Option<&str>) -> Result<f32, ImportError> {
    let number = number(line, what, word)? as f32;
    match number.is_finite() {
        true => Ok(number),
        false => Err(at_line(line, format!("{what}, a number of 32 bits"), shown(word.unwrap_or_default()))),
    }
}

/// The name of a file without folders and extension.
pub(crate) fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}
