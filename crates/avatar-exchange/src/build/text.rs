//! What readers of text formats share: decoding, numbers, and errors that name their line.

#[cfg(any(feature = "obj", feature = "bvh", feature = "md5"))]
use crate::scene::ImportError;
use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};
use std::borrow::Cow;

/// The text of a file: what its byte-order mark says (UTF-8 or UTF-16), else UTF-8, else Windows-1252, of
/// which Latin-1 is a part. Never fails: sequences that the encoding lacks are replaced. Without the zero at
/// its end that programs in C leave there.
#[cfg(any(feature = "obj", feature = "bvh", feature = "md5"))]
pub(crate) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    decode_as(bytes, None)
}

/// As [`decode`], for a format that can say its encoding. Valid UTF-8 is taken as such whatever the file
/// says, since editors change the bytes and leave the statement.
pub(crate) fn decode_as<'a>(bytes: &'a [u8], stated: Option<&'static Encoding>) -> Cow<'a, str> {
    without_end_mark(decode_all(bytes, stated))
}

/// Leaves out zeros at the end, and Control-Z, the end of a text for CP/M and DOS, with blanks between them.
pub(crate) fn without_end_mark(mut text: Cow<'_, str>) -> Cow<'_, str> {
    const MARKS: [char; 2] = ['\0', '\u{1a}'];
    let is_end = |c: char| MARKS.contains(&c) || c.is_ascii_whitespace();
    let end = text.trim_end_matches(is_end).len();
    // Blanks alone stay: lines are counted.
    if let Some(mark) = text[end..].find(MARKS).map(|at| end + at) {
        match &mut text {
            Cow::Borrowed(text) => *text = &text[..mark],
            Cow::Owned(text) => text.truncate(mark),
        }
    }
    text
}

fn decode_all<'a>(bytes: &'a [u8], stated: Option<&'static Encoding>) -> Cow<'a, str> {
    if let Some((encoding, mark)) = Encoding::for_bom(bytes) {
        return encoding.decode_without_bom_handling(&bytes[mark..]).0;
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => {
            let stated = stated.filter(|encoding| *encoding != UTF_8);
            stated.unwrap_or(WINDOWS_1252).decode_without_bom_handling(bytes).0
        }
    }
}

/// An error at a line, counted from 1.
#[cfg(any(feature = "obj", feature = "bvh", feature = "md5"))]
pub(crate) fn at_line(line: usize, expected: impl Into<String>, found: impl Into<String>) -> ImportError {
    ImportError::new(format!("line {line}"), expected, found)
}

/// A word of a file for messages, quoted and cut after 40 characters.
#[cfg(any(feature = "obj", feature = "bvh", feature = "md5"))]
pub(crate) fn shown(word: &str) -> String {
    const LONGEST: usize = 40;
    match word.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{:?}…", &word[..end]),
        None => format!("{word:?}"),
    }
}

/// A finite number.
#[cfg(any(feature = "obj", feature = "bvh", feature = "md5"))]
pub(crate) fn number(line: usize, what: &str, word: Option<&str>) -> Result<f64, ImportError> {
    let Some(word) = word else { return Err(at_line(line, what, "nothing")) };
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(at_line(line, format!("{what}, a finite number"), shown(word))),
    }
}

/// The f32 nearest to a number, which must be finite, too.
#[cfg(any(feature = "obj", feature = "bvh", feature = "md5"))]
pub(crate) fn float(line: usize, what: &str, word: Option<&str>) -> Result<f32, ImportError> {
    let number = number(line, what, word)? as f32;
    match number.is_finite() {
        true => Ok(number),
        false => Err(at_line(line, format!("{what}, a number of 32 bits"), shown(word.unwrap_or_default()))),
    }
}

/// The name of a file without folders and extension.
#[cfg(any(feature = "obj", feature = "bvh", feature = "md5"))]
pub(crate) fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}
