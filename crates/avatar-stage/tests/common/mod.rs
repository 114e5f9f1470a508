//! The default face, for all tests.
#![allow(dead_code, reason = "every test file uses its own share")]
#![allow(unreachable_pub, reason = "a module of several test programs")]
#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "helpers of tests: they read files and may fail"
)]

use avatar_stage::avatar_pack::{MemorySource, Pack, Textures};
use avatar_stage::avatar_render::headless::{Gpu, GpuOptions, open_blocking};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne")
}

fn source() -> MemorySource {
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        source.files.insert(name, std::fs::read(path).unwrap());
    }
    source
}

pub fn pack() -> &'static Pack {
    static PACK: OnceLock<Pack> = OnceLock::new();
    PACK.get_or_init(|| Pack::load(&source()).unwrap())
}

pub fn textures() -> &'static Textures {
    static TEXTURES: OnceLock<Textures> = OnceLock::new();
    TEXTURES.get_or_init(|| Textures::load(&source()))
}

/// A device; `None`, with a line that says so, where there is none and none is required.
pub fn gpu() -> Option<Gpu> {
    match open_blocking(GpuOptions::default()) {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            let required = std::env::var_os("MIMIK_REQUIRE_GPU").is_some_and(|value| value == "1");
            assert!(!required, "MIMIK_REQUIRE_GPU is 1, and there is no adapter: {error}");
            // Not eprintln: the test runner keeps that back where a test passes.
            let skipped = format_args!("SKIPPED: {error}\n");
            let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
            None
        }
    }
}
