//! Files of other people that tests read where they are there.

use std::io::Write;
use std::path::{Path, PathBuf};

/// A file or folder of the data beside the workspace (`../shared/data`). Where it is missing, that is said on
/// the terminal, past the capturing of tests' output, or it is a failure under `MIMIK_REQUIRE_DATA=1`.
pub fn shared_data(path: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(path);
    there(path, std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1"))
}

/// A file of the small cases beside the workspace (`../shared/cases`); asked for as the data are.
pub fn shared_case(path: &str) -> Option<PathBuf> {
    shared_data("../cases").map(|folder| folder.join(path))
}

/// A folder of the Open Asset Import Library's test models, as Debian packages them: `assimp-testmodels`. Who
/// names a folder in `MIMIK_ASSIMP_MODELS` wants it read.
pub fn models(folder: &str) -> Option<PathBuf> {
    let named = std::env::var_os("MIMIK_ASSIMP_MODELS");
    let must_be_there = named.is_some();
    let root = named.unwrap_or_else(|| "/usr/share/assimp/models".into());
    there(Path::new(&root).join(folder), must_be_there)
}

fn there(path: PathBuf, must_be_there: bool) -> Option<PathBuf> {
    if path.exists() {
        return Some(path);
    }
    assert!(!must_be_there, "{} is not there", path.display());
    let _ = writeln!(std::io::stderr(), "SKIPPED: {} is not there", path.display());
    None
}
