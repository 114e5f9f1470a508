//! Bytes that unpack to very many zeros, made by hand.

/// A stream of zlib (RFC 1950) of so many zeros: copies of 258 bytes, one back, of 13 bits each.
pub(crate) fn zlib_zeros(count: u64) -> Vec<u8> {
    let mut bits = Bits { bytes: vec![0x78, 0x01], used: 8 };
    // The last block, of fixed codes (RFC 1951, 3.2.6): from the lowest bit.
    bits.put(0b1, 1);
    bits.put(0b01, 2);
    let literal = |bits: &mut Bits| bits.put_code(0b0011_0000, 8);
    let mut left = count;
    if left > 0 {
        literal(&mut bits);
        left -= 1;
    }
    while left >= 258 {
        bits.put_code(0b1100_0101, 8);
        bits.put_code(0, 5);
        left -= 258;
    }
    (0..left).for_each(|_| literal(&mut bits));
    bits.put_code(0, 7);
    // Adler-32 of zeros: the first sum stays 1.
    let sum = ((count % 65_521) as u32) << 16 | 1;
    bits.bytes.extend(sum.to_be_bytes());
    bits.bytes
}

struct Bits {
    bytes: Vec<u8>,
    /// Bits of the last byte that are taken.
    used: u32,
}

impl Bits {
    /// Lowest bit first.
    fn put(&mut self, value: u32, count: u32) {
        for bit in 0..count {
            if self.used == 8 {
                self.bytes.push(0);
                self.used = 0;
            }
            if let Some(last) = self.bytes.last_mut() {
                *last |= u8::try_from(value >> bit & 1).unwrap_or(0) << self.used;
            }
            self.used += 1;
        }
    }

    /// Codes stand with their highest bit first.
    fn put_code(&mut self, code: u32, count: u32) {
        (0..count).rev().for_each(|bit| self.put(code >> bit & 1, 1));
    }
}

/// A PNG of one bit a pixel, all black.
pub(crate) fn black_png(side: u32) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = [side.to_be_bytes(), side.to_be_bytes()].concat();
    header.extend([1, 0, 0, 0, 0]);
    let row = 1 + u64::from(side).div_ceil(8);
    for (kind, data) in
        [(b"IHDR", header), (b"IDAT", zlib_zeros(row * u64::from(side))), (b"IEND", Vec::new())]
    {
        file.extend(u32::try_from(data.len()).unwrap_or(u32::MAX).to_be_bytes());
        let chunk = [&kind[..], &data].concat();
        file.extend(&chunk);
        file.extend(crc(&chunk).to_be_bytes());
    }
    file
}

/// A WebP of one colour: codes of one symbol each take no bits, so that pixels take none (RFC 9649, 3.7).
pub(crate) fn plain_webp(side: u32) -> Vec<u8> {
    let mut bits = Bits { bytes: vec![0x2f], used: 8 };
    for length in [side - 1, side - 1] {
        bits.put(length, 14);
    }
    // No alpha, version 0, no transform, no cache of colours, one group of codes for all.
    bits.put(0, 1 + 3 + 1 + 1 + 1);
    // Green, red, blue, alpha and distance: a simple code of one symbol of one bit, which is 0.
    (0..5).for_each(|_| bits.put(0b0001, 4));
    let mut data = bits.bytes;
    data.resize(data.len().next_multiple_of(2), 0);
    let length = |bytes: usize| u32::try_from(bytes).unwrap_or(u32::MAX).to_le_bytes();
    [&b"RIFF"[..], &length(12 + data.len()), b"WEBPVP8L", &length(data.len()), &data].concat()
}

/// Zeros of so many vertices, packed by the first version of meshoptimizer's codec for vertices: a header,
/// for each byte of each block of 256 vertices two bits for a group of 16 of them, and the first vertex.
pub(crate) fn meshopt_zeros(vertices: usize, stride: usize) -> Vec<u8> {
    assert!(vertices.is_multiple_of(256) && stride <= 32);
    let mut bytes = vec![0; 1 + vertices / 256 * stride * 4 + 32];
    bytes[0] = 0xa0;
    bytes
}

/// The cyclic redundancy check of PNG, annex D.
fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc)))
}

/// Base64 without a remainder: zeros, or any other bytes in threes.
pub(crate) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let value = (0..3).fold(0, |value, at| value << 8 | u32::from(group.get(at).copied().unwrap_or(0)));
        for at in 0..4 {
            let letter = LETTERS[(value >> (18 - 6 * at) & 63) as usize];
            text.push(if at <= group.len() { char::from(letter) } else { '=' });
        }
    }
    text
}
