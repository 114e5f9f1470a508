//! How much memory a file of another program may take, and who may take which share of it.
//!
//! A few bytes can claim gigabytes: counts without data, pictures of one colour, meshes at a thousand nodes.
//! Whatever a file claims, reading it and making an avatar of it takes at most [`most`] bytes at a time.
//! Readers take a share for what a file unpacks to, whoever decodes its pictures another one; what is needed
//! only for a while, and what becomes of a scene, is the rest.

/// What any file may take, in bytes.
pub const BASE: u64 = 256 << 20;
/// And so many bytes for each byte of the file and of those that belong to it.
pub const PER_BYTE: u64 = 64;

/// The share of decoded pictures: of [`BASE`], and of [`PER_BYTE`] for each byte that the pictures have in
/// the file.
pub const PICTURES: (u64, u64) = (128 << 20, 24);

/// The share of the library that reads FBX, for what it has read. It is gone before pictures are decoded. As
/// much again may be taken while the file is parsed, when nothing is unpacked yet.
pub const FBX_LIBRARY: (u64, u64) = (64 << 20, 20);
const _: () = {
    assert!(2 * FBX_LIBRARY.0 <= BASE && 2 * FBX_LIBRARY.1 <= PER_BYTE);
};

/// The share of what a reader unpacks.
#[cfg(any(feature = "collada", feature = "fbx", feature = "obj", feature = "gltf"))]
pub(crate) const UNPACKED: (u64, u64) = (112 << 20, 32);
#[cfg(any(feature = "collada", feature = "fbx", feature = "obj", feature = "gltf"))]
const _: () = {
    assert!(UNPACKED.0 + PICTURES.0 <= BASE && UNPACKED.1 + PICTURES.1 <= PER_BYTE);
    assert!(UNPACKED.0 + FBX_LIBRARY.0 <= BASE && UNPACKED.1 + FBX_LIBRARY.1 <= PER_BYTE);
};

/// The most bytes that are held at a time, from files of so many bytes to the avatar, these files not
/// counted.
///
/// ```
/// assert_eq!(avatar_exchange::memory::most(1 << 20), (256 + 64) << 20);
/// ```
#[must_use]
pub const fn most(input_bytes: u64) -> u64 {
    share((BASE, PER_BYTE), input_bytes)
}

/// What a share is for so many bytes of input: its first number, and the second for each byte.
#[must_use]
pub const fn share((base, per_byte): (u64, u64), input_bytes: u64) -> u64 {
    base.saturating_add(input_bytes.saturating_mul(per_byte))
}
