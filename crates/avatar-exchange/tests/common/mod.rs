//! What the tests of readers share.
#![allow(dead_code, unreachable_pub, reason = "each test uses some of it")]
#![allow(clippy::expect_used, clippy::panic, clippy::disallowed_methods, reason = "helpers of tests")]

pub mod random;

use avatar_exchange::{ImportError, Scene, gltf};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Real data beside the workspace; where it is missing, that is said past the harness.
pub fn shared_data(folder: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(folder);
    if path.exists() {
        return Some(path);
    }
    let _ = writeln!(std::io::stderr(), "SKIPPED: {} is not there", path.display());
    None
}

/// Reads a file and what it refers to beside it.
pub fn read_file(path: &Path) -> Result<Scene, ImportError> {
    let bytes = std::fs::read(path).expect("a readable file");
    let folder = path.parent().expect("a folder");
    let name = path.file_name().expect("a name").to_string_lossy();
    let mut resolve = |uri: &str| std::fs::read(folder.join(uri)).map_err(|error| error.to_string());
    gltf::read(&name, &bytes, &mut resolve)
}

/// Reads bytes that refer to nothing else.
pub fn read(bytes: &[u8]) -> Result<Scene, ImportError> {
    gltf::read("test", bytes, &mut |_| Err("no other files".to_owned()))
}

/// A GLB of JSON and binary data.
pub fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, bin) = (padded(json.as_bytes(), b' '), padded(bin, 0));
    let mut glb = b"glTF".to_vec();
    let word = |glb: &mut Vec<u8>, word: usize| {
        glb.extend(u32::try_from(word).expect("a small file").to_le_bytes());
    };
    word(&mut glb, 2);
    word(&mut glb, 12 + 8 + json.len() + 8 + bin.len());
    for (kind, chunk) in [(0x4e4f_534a, &json), (0x004e_4942, &bin)] {
        word(&mut glb, chunk.len());
        word(&mut glb, kind);
        glb.extend_from_slice(chunk);
    }
    glb
}

/// Little-endian bytes of floats.
pub fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}
