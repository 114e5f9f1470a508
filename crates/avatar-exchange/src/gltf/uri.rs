//! Addresses of buffers and images: data in place, or a path beside the file.

use crate::build::path::{Outside, inside};
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode;
use std::borrow::Cow;

/// What an address means.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Uri {
    /// Data in the address itself.
    Data { mime: String, bytes: Vec<u8> },
    /// A relative path that stays inside the file's folder.
    Path(String),
}

/// What was expected instead.
pub(super) type Mistake = &'static str;

impl Uri {
    pub(super) fn parse(uri: &str) -> Result<Self, Mistake> {
        match uri.get(..5) {
            Some(scheme) if scheme.eq_ignore_ascii_case("data:") => data(&uri[5..]),
            _ => path(uri).map(Self::Path),
        }
    }
}

/// RFC 2397.
fn data(rest: &str) -> Result<Uri, Mistake> {
    let (head, body) = rest.split_once(',').ok_or("data with a comma after its type")?;
    let (mime, base64) = match head.strip_suffix(";base64") {
        Some(mime) => (mime, true),
        None => (head, false),
    };
    let body = percent_decoded(body)?;
    let bytes = if base64 { base64_decoded(&body)? } else { body.into_owned() };
    Ok(Uri::Data { mime: mime.to_owned(), bytes })
}

fn path(uri: &str) -> Result<String, Mistake> {
    let decoded = percent_decoded(uri)?.into_owned();
    let decoded = String::from_utf8(decoded).map_err(|_| "a path in UTF-8")?;
    inside(&decoded).map_err(|outside| match outside {
        Outside::Empty => "a path to a file",
        Outside::Absolute => "data, or a relative path",
        Outside::Upwards => "a path inside the file's folder",
    })
}

/// RFC 3986, section 2.1, where a `%` without its digits is a mistake.
fn percent_decoded(text: &str) -> Result<Cow<'_, [u8]>, Mistake> {
    let is_digit = |digit: Option<&u8>| digit.is_some_and(u8::is_ascii_hexdigit);
    let bytes = text.as_bytes();
    let whole = |(at, _): (usize, &u8)| is_digit(bytes.get(at + 1)) && is_digit(bytes.get(at + 2));
    match bytes.iter().enumerate().filter(|(_, byte)| **byte == b'%').all(whole) {
        true => Ok(percent_decode(bytes).into()),
        false => Err("two hexadecimal digits after each %"),
    }
}

/// RFC 4648, section 4; padding may be left out, and bits that stand for nothing do not matter.
fn base64_decoded(text: &[u8]) -> Result<Vec<u8>, Mistake> {
    const ENGINE: GeneralPurpose = GeneralPurpose::new(
        &STANDARD,
        GeneralPurposeConfig::new()
            .with_decode_allow_trailing_bits(true)
            .with_decode_padding_mode(DecodePaddingMode::Indifferent),
    );
    ENGINE.decode(text).map_err(|_| "base64 of a whole number of bytes")
}

#[cfg(test)]
mod tests {
    use super::{Uri, base64_decoded};

    #[test]
    fn base64_of_all_lengths() {
        for (text, bytes) in [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg", "foob")] {
            assert_eq!(base64_decoded(text.as_bytes()).as_deref(), Ok(bytes.as_bytes()));
        }
        for text in ["Z", "Zm9vY", "Zg===", "Z=g=", "Zm9\n"] {
            assert!(base64_decoded(text.as_bytes()).is_err(), "{text:?}");
        }
    }

    #[test]
    fn paths_stay_in_their_folder() {
        let path = |uri| Uri::parse(uri);
        assert_eq!(path("a%20b/./c.bin"), Ok(Uri::Path("a b/c.bin".to_owned())));
        let leading_out = [
            "/etc/x",
            "..",
            "a/../../b",
            "%2e%2e/b",
            "C:\\x",
            "http://x/y",
            "\\\\x",
            "a%00",
            "",
            "%zz",
            "%4",
            "./",
        ];
        for uri in leading_out {
            assert!(path(uri).is_err(), "{uri:?}");
        }
    }

    #[test]
    fn data_with_and_without_base64() {
        let data = |mime: &str, bytes: &[u8]| Ok(Uri::Data { mime: mime.to_owned(), bytes: bytes.to_vec() });
        assert_eq!(Uri::parse("data:image/png;base64,Zm9v"), data("image/png", b"foo"));
        assert_eq!(Uri::parse("DATA:,a%20b"), data("", b"a b"));
        assert!(Uri::parse("data:image/png;base64").is_err());
    }
}
