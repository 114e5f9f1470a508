//! Addresses of buffers and images: data in place, or a path beside the file.

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
    if decoded.is_empty() || decoded.contains('\0') {
        return Err("a path");
    }
    if decoded.starts_with(['/', '\\']) || decoded.split(['/', '\\']).next().is_some_and(|s| s.contains(':'))
    {
        return Err("data, or a relative path");
    }
    if decoded.split(['/', '\\']).any(|segment| segment == "..") {
        return Err("a path inside the file's folder");
    }
    let segments: Vec<_> = decoded.split(['/', '\\']).filter(|s| !(s.is_empty() || *s == ".")).collect();
    if segments.is_empty() { Err("a path to a file") } else { Ok(segments.join("/")) }
}

fn percent_decoded(text: &str) -> Result<Cow<'_, [u8]>, Mistake> {
    if !text.contains('%') {
        return Ok(Cow::Borrowed(text.as_bytes()));
    }
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes().iter();
    let digit = |byte: Option<&u8>| byte.and_then(|byte| char::from(*byte).to_digit(16));
    while let Some(&byte) = rest.next() {
        let decoded = match byte {
            b'%' => match (digit(rest.next()), digit(rest.next())) {
                (Some(high), Some(low)) => (16 * high + low) as u8,
                _ => return Err("two hexadecimal digits after each %"),
            },
            byte => byte,
        };
        bytes.push(decoded);
    }
    Ok(Cow::Owned(bytes))
}

/// RFC 4648, section 4; padding may be left out.
fn base64_decoded(text: &[u8]) -> Result<Vec<u8>, Mistake> {
    let mut digits = text;
    while let Some(rest) = digits.strip_suffix(b"=") {
        digits = rest;
    }
    if text.len() - digits.len() > 2 || digits.len() % 4 == 1 {
        return Err("base64 of a whole number of bytes");
    }
    let mut bytes = Vec::with_capacity(digits.len() / 4 * 3 + 2);
    for group in digits.chunks(4) {
        let mut bits = 0u32;
        for &digit in group {
            let value = match digit {
                b'A'..=b'Z' => digit - b'A',
                b'a'..=b'z' => digit - b'a' + 26,
                b'0'..=b'9' => digit - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return Err("base64"),
            };
            bits = bits << 6 | u32::from(value);
        }
        bits <<= 6 * (4 - group.len());
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Ok(bytes)
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
