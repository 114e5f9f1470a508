use crate::scene::ImportError;

const MAGIC: &[u8; 4] = b"glTF";
const JSON: u32 = 0x4e4f_534a;
const BIN: u32 = 0x004e_4942;
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The parts of a file: JSON alone, or the chunks of GLB (glTF 2.0, section 4.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Container<'a> {
    /// The JSON text.
    pub json: &'a [u8],
    /// The first buffer, in GLB.
    pub bin: Option<&'a [u8]>,
}

/// Splits GLB into its chunks; anything else is taken for JSON. Chunks of other types are skipped.
///
/// # Errors
/// A GLB header or chunk that does not fit the bytes.
pub fn split(bytes: &[u8]) -> Result<Container<'_>, ImportError> {
    if !bytes.starts_with(MAGIC) {
        return Ok(Container { json: bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes), bin: None });
    }
    let version = word(bytes, 4)?;
    if version != 2 {
        return Err(ImportError::new("byte 4", "GLB version 2, which has glTF 2.0", version.to_string()));
    }
    let length = word(bytes, 8)? as usize;
    let Some(bytes) = bytes.get(..length) else {
        return Err(ImportError::new("byte 8", format!("{length} bytes"), bytes.len().to_string()));
    };
    let (mut json, mut bin, mut at) = (None, None, 12);
    while at < bytes.len() {
        let (length, kind) = (word(bytes, at)? as usize, word(bytes, at + 4)?);
        let rest = &bytes[at + 8..];
        let Some(chunk) = rest.get(..length) else {
            let expected = format!("a chunk of {length} bytes");
            return Err(ImportError::new(format!("byte {at}"), expected, rest.len().to_string()));
        };
        match kind {
            JSON if json.is_none() => json = Some(chunk),
            BIN if bin.is_none() => bin = Some(chunk),
            _ => {}
        }
        at += 8 + length;
    }
    match json {
        Some(json) => Ok(Container { json, bin }),
        None => Err(ImportError::new("byte 12", "a chunk of JSON", "none")),
    }
}

fn word(bytes: &[u8], at: usize) -> Result<u32, ImportError> {
    match bytes.get(at..).and_then(|rest| rest.first_chunk()) {
        Some(word) => Ok(u32::from_le_bytes(*word)),
        None => Err(ImportError::new(
            format!("byte {at}"),
            "4 bytes",
            (bytes.len() - at.min(bytes.len())).to_string(),
        )),
    }
}
