use crate::{Place, XmlError, XmlProblem};
use std::borrow::Cow;

/// Bytes to text: UTF-8 with or without a byte-order mark, UTF-16 with one, and Latin-1 where the declaration says
/// so (older exporters on German systems write it).
pub(super) fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, XmlError> {
    match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => utf8(rest),
        [0xFF, 0xFE, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ if declares_latin1(bytes) => {
            Ok(bytes.iter().map(|&byte| char::from(byte)).collect::<String>().into())
        }
        _ => utf8(bytes),
    }
}

fn utf8(bytes: &[u8]) -> Result<Cow<'_, str>, XmlError> {
    std::str::from_utf8(bytes).map(Cow::Borrowed).map_err(|error| {
        let valid = std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
        not_text(Place::of(valid, valid.len()), format!("byte {} is no UTF-8", error.valid_up_to()))
    })
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<Cow<'_, str>, XmlError> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let text: Result<String, _> = char::decode_utf16(pairs.iter().map(|&pair| unit(pair))).collect();
    match text {
        Ok(text) if rest.is_empty() => Ok(text.into()),
        _ => Err(not_text(Place { line: 1, column: 1 }, "damaged UTF-16".to_owned())),
    }
}

fn not_text(place: Place, what: String) -> XmlError {
    XmlError { place, problem: XmlProblem::NotText(what) }
}

fn declares_latin1(bytes: &[u8]) -> bool {
    let Some(rest) = bytes.strip_prefix(b"<?xml") else { return false };
    let declaration: String =
        rest.iter().take(200).take_while(|&&byte| byte != b'>').map(|&byte| char::from(byte)).collect();
    let declaration = declaration.to_ascii_lowercase();
    ["iso-8859-1", "latin1", "windows-1252"].iter().any(|name| declaration.contains(name))
}
