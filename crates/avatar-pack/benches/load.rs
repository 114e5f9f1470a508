//! Loading a pack, beside copying the same bytes in memory.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a bench: it may panic and read files"
)]

use avatar_pack::{MemorySource, Pack};
use divan::Bencher;
use std::path::Path;

fn main() {
    divan::main();
}

/// The built-in avatar without its textures.
fn source() -> MemorySource {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder).expect("the built-in avatar") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        if !name.ends_with(".png") {
            source.files.insert(name, std::fs::read(path).expect("a file"));
        }
    }
    source
}

#[divan::bench]
fn load(bencher: Bencher<'_, '_>) {
    let source = source();
    bencher.bench(|| Pack::load(&source).expect("a good pack"));
}

#[divan::bench]
fn copy(bencher: Bencher<'_, '_>) {
    let source = source();
    bencher.bench(|| source.files.values().map(|bytes| divan::black_box(bytes.clone()).len()).sum::<usize>());
}
