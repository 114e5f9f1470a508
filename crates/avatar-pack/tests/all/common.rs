//! Packs that tests read.
#![allow(
    clippy::expect_used,
    clippy::disallowed_methods,
    reason = "helpers of tests: they may panic and read files"
)]

use avatar_pack::{MemorySource, Pack};
use std::io::Write;
use std::path::{Path, PathBuf};

fn path(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder)
}

/// Those files of a folder of the repository whose names are wanted.
pub(crate) fn folder_of(folder: &str, wanted: impl Fn(&str) -> bool) -> MemorySource {
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(path(folder)).expect("the folder") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().into_string().expect("a name");
        if wanted(&name) {
            source.files.insert(name, std::fs::read(entry.path()).expect("a file"));
        }
    }
    source
}

/// All files of a folder of the repository.
pub(crate) fn folder(folder: &str) -> MemorySource {
    folder_of(folder, |_| true)
}

/// A folder beside the repository. Where it is missing this is printed, and is a failure under
/// `MIMIK_REQUIRE_DATA=1`.
pub(crate) fn shared(name: &str) -> Option<MemorySource> {
    let name = format!("../shared/data/{name}");
    if path(&name).is_dir() {
        return Some(folder(&name));
    }
    let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(!required, "expected the data {name} (MIMIK_REQUIRE_DATA=1), found no such folder");
    // Past the harness, which keeps the output of tests that pass to itself.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {name} is not there");
    None
}

/// The pack of the golden files.
pub(crate) fn golden() -> MemorySource {
    folder("tests/golden/pack")
}

/// The built-in avatar without its pictures.
pub(crate) fn marsienne() -> Pack {
    let source = folder_of("assets/marsienne", |name| !name.ends_with(".png"));
    Pack::load(&source).expect("a good pack")
}
