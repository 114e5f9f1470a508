use crate::{Place, XmlError, XmlProblem};
use std::borrow::Cow;

/// Bytes to text: UTF-8 with or without a byte-order mark, UTF-16 with one, and Latin-1 where the declaration
/// says so (older exporters on German systems write it).
pub(super) fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, XmlError> {
    match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => utf8(rest, 3),
        [0xFF, 0xFE, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ if declares_latin1(bytes) => {
            Ok(bytes.iter().map(|&byte| char::from(byte)).collect::<String>().into())
        }
        _ => utf8(bytes, 0),
    }
}

/// `skipped`: length of the byte-order mark before `bytes`.
fn utf8(bytes: &[u8], skipped: usize) -> Result<Cow<'_, str>, XmlError> {
    std::str::from_utf8(bytes).map(Cow::Borrowed).map_err(|error| {
        let valid = std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
        not_text(valid, format!("byte {} is no UTF-8", skipped + error.valid_up_to()))
    })
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<Cow<'_, str>, XmlError> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let mut text = String::with_capacity(pairs.len());
    for decoded in char::decode_utf16(pairs.iter().map(|&pair| unit(pair))) {
        match decoded {
            Ok(c) => text.push(c),
            Err(_) => return Err(not_text(&text, "half a surrogate pair in UTF-16".to_owned())),
        }
    }
    match rest {
        [] => Ok(text.into()),
        _ => Err(not_text(&text, "an odd number of bytes in UTF-16".to_owned())),
    }
}

/// `valid`: the text up to the damage.
fn not_text(valid: &str, what: String) -> XmlError {
    XmlError { place: Place::of(valid, valid.len()), problem: XmlProblem::NotText(what) }
}

fn declares_latin1(bytes: &[u8]) -> bool {
    let Some(rest) = bytes.strip_prefix(b"<?xml") else { return false };
    let declaration: String =
        rest.iter().take(200).take_while(|&&byte| byte != b'>').map(|&byte| char::from(byte)).collect();
    let declaration = declaration.to_ascii_lowercase();
    ["iso-8859-1", "latin1", "windows-1252"].iter().any(|name| declaration.contains(name))
}
