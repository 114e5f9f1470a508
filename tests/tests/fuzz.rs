//! Runs what fuzzing has kept, without libFuzzer: `fuzz/corpus`, inputs that reach much of the readers, and
//! `fuzz/regressions`, those that once made something fail.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use avatar_fuzz::{SEPARATOR, TARGETS, mutate_json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What one input may take on a busy machine, without optimisation.
const LIMIT: Duration = Duration::from_secs(20);

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz").join(name)
}

/// The files of a folder, in order; none where there is no folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn kept_inputs_harm_nothing() {
    let mut failed = Vec::new();
    for (target, run) in TARGETS {
        let inputs = ["corpus", "regressions"].map(|kind| files(&folder(kind).join(target))).concat();
        assert!(!inputs.is_empty(), "{target} has no inputs");
        for path in inputs {
            let bytes = std::fs::read(&path).unwrap();
            let start = Instant::now();
            if std::panic::catch_unwind(|| run(&bytes)).is_err() || start.elapsed() > LIMIT {
                failed.push(format!("{} after {:?}", path.display(), start.elapsed()));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn every_target_is_a_program_and_has_a_place_for_its_inputs() {
    let named: BTreeSet<String> = TARGETS.iter().map(|(name, _)| (*name).to_owned()).collect();
    let stems = |name: &str| -> BTreeSet<String> {
        let stem = |path: PathBuf| path.file_stem().unwrap().to_string_lossy().into_owned();
        files(&folder(name)).into_iter().map(stem).collect()
    };
    assert_eq!(stems("fuzz_targets"), named);
    assert_eq!(stems("corpus"), named);
    assert!(stems("regressions").is_subset(&named));
    let manifest = std::fs::read_to_string(folder("Cargo.toml")).unwrap();
    for name in named {
        assert!(
            manifest.contains(&format!("\nname = \"{name}\"\npath = \"fuzz_targets/{name}.rs\"\n")),
            "{name}"
        );
    }
}

/// Blind changes would leave one text in ten.
#[test]
fn changes_of_json_mostly_leave_json() {
    let seed = std::fs::read(folder("corpus/gltf/all")).unwrap();
    let (mut json, mut same) = (0, 0);
    for number in 0..500 {
        let mut data = seed.clone();
        data.resize(16_384, 0);
        let size = mutate_json(&mut data, seed.len(), 16_384, number, |data, size, _| {
            data[number as usize % size] ^= 0x10;
            size
        });
        let text = data[..size].split(|byte| *byte == SEPARATOR).next().unwrap();
        json += usize::from(serde_json::from_slice::<serde_json::Value>(text).is_ok());
        same += usize::from(data[..size] == seed);
    }
    assert!(json > 400 && same < 50, "{json} are JSON, {same} are unchanged");
}
