//! Loading a pack, beside copying the same bytes in memory; planting its hair.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a bench: it may panic and read files"
)]

use avatar_groom::Hair;
use avatar_pack::{MemorySource, Pack, Texture, Textures};
use divan::Bencher;
use std::path::Path;

fn main() {
    divan::main();
}

/// The built-in avatar without its textures.
fn source() -> MemorySource {
    files(|name| !name.ends_with(".png"))
}

fn files(wanted: impl Fn(&str) -> bool) -> MemorySource {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder).expect("the built-in avatar") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        if wanted(&name) {
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

/// 150,000 strands on the built-in head.
#[divan::bench(sample_count = 5)]
fn groom(bencher: Bencher<'_, '_>) {
    let map = Texture::HairDensity.stem();
    let source = files(|name| !name.ends_with(".png") || name.starts_with(&map));
    let (pack, textures) = (Pack::load(&source).expect("a good pack"), Textures::load(&source));
    let hair = Hair { density: 1.9, ..Hair::default() };
    let strands = pack.groom(&textures, &hair).expect("hair").1.strands().len();
    assert!((145_000..160_000).contains(&strands), "{strands}");
    bencher.bench(|| pack.groom(&textures, &hair));
}
