//! Several files in one input.

/// Stands between the files of an input: ASCII's own file separator.
pub const SEPARATOR: u8 = 0x1c;

/// A picture of one pixel, for whatever refers to a picture.
pub(crate) const PIXEL: &[u8] = b"BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x18\0\0\0\0\0\x04\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x30\x60\x90\0";

/// The files of an input.
pub(crate) fn files(data: &[u8]) -> impl Iterator<Item = &[u8]> {
    data.split(|byte| *byte == SEPARATOR)
}

/// The first file, and all that follows: bytes that may contain anything.
pub(crate) fn text_and_bytes(data: &[u8]) -> (&[u8], &[u8]) {
    match data.iter().position(|byte| *byte == SEPARATOR) {
        Some(at) => (&data[..at], &data[at + 1..]),
        None => (data, &[]),
    }
}

/// A GLB with these chunks and the right lengths.
pub fn glb_of(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let mut glb = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, bytes, fill) in [(b"JSON", json, b' '), (b"BIN\0", bin, 0)] {
        let length = bytes.len().next_multiple_of(4);
        glb.extend((length as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(bytes);
        glb.resize(glb.len() + length - bytes.len(), fill);
    }
    let length = glb.len() as u32;
    glb[8..12].copy_from_slice(&length.to_le_bytes());
    glb
}
