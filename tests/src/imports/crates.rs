//! The crates of the workspace and what ARCHITECTURE.md says of their dependencies.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::{fs, io};

use super::modules::Files;

/// A crate's source and manifest.
#[derive(Debug)]
pub struct Crate {
    /// Its name and folder below `crates`.
    pub name: String,
    /// The text of its Cargo.toml.
    pub manifest: String,
    /// Its `src`.
    pub files: Files,
}

/// Reads all crates below `crates` of the workspace, by name.
///
/// # Errors
///
/// A folder or file that cannot be read.
pub fn read_crates(workspace: &Path) -> io::Result<Vec<Crate>> {
    let mut crates = Vec::new();
    for entry in fs::read_dir(workspace.join("crates"))? {
        let folder = entry?.path();
        if !folder.join("Cargo.toml").is_file() {
            continue;
        }
        let mut files = Files::new();
        read_folder(&folder.join("src"), "", &mut files)?;
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        crates.push(Crate { name, manifest: fs::read_to_string(folder.join("Cargo.toml"))?, files });
    }
    crates.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(crates)
}

fn read_folder(folder: &Path, prefix: &str, files: &mut Files) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = format!("{prefix}{}", path.file_name().unwrap_or_default().to_string_lossy());
        if path.is_dir() {
            read_folder(&path, &format!("{name}/"), files)?;
        } else if name.ends_with(".rs") {
            files.insert(name, fs::read_to_string(&path)?);
        }
    }
    Ok(())
}

/// Where the manifests and the last column of ARCHITECTURE.md's code map differ, each as a sentence.
/// `manifests` holds names and texts of Cargo.toml.
pub fn dependencies(architecture: &str, manifests: &[(&str, &str)]) -> Vec<String> {
    let names: BTreeSet<&str> = manifests.iter().map(|(name, _)| *name).collect();
    let mut findings = Vec::new();
    let mut table: BTreeMap<&str, (BTreeSet<&str>, bool)> = BTreeMap::new();
    for line in architecture.lines().filter(|line| line.starts_with("| `crates/")) {
        let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
        let name = cells[0].trim_matches('`').trim_start_matches("crates/");
        let last = cells.last().copied().unwrap_or_default();
        // The program may use whatever stands above it.
        let any_above = last == "any of the above";
        let listed = match last {
            "any of the above" => table.keys().copied().collect(),
            "–" => BTreeSet::new(),
            list => list.split(',').map(|name| name.trim().trim_matches('`')).collect(),
        };
        findings.extend(listed.iter().filter(|other| !names.contains(**other)).map(|other| {
            format!("ARCHITECTURE.md says that {name} depends on {other}, which is not a crate here")
        }));
        table.insert(name, (listed, any_above));
    }
    for (name, manifest) in manifests {
        let Some((listed, any_above)) = table.get(name) else {
            findings.push(format!("ARCHITECTURE.md's table has no row for crates/{name}"));
            continue;
        };
        let used: BTreeSet<&str> = dependencies_of(manifest).filter(|other| names.contains(other)).collect();
        for other in used.difference(listed) {
            findings.push(format!("{name} depends on {other}, but not in ARCHITECTURE.md"));
        }
        for other in listed.difference(&used).filter(|_| !any_above) {
            findings.push(format!("ARCHITECTURE.md says that {name} depends on {other}, but it does not"));
        }
    }
    let unknown = table.keys().filter(|name| !names.contains(**name));
    findings.extend(
        unknown.map(|name| format!("ARCHITECTURE.md has a row for crates/{name}, which is not there")),
    );
    findings
}

/// The names in a manifest's tables of dependencies, without those of tests and build scripts.
fn dependencies_of(manifest: &str) -> impl Iterator<Item = &str> {
    let mut inside = false;
    manifest.lines().filter_map(move |line| {
        if line.starts_with('[') {
            inside = line == "[dependencies]"
                || (line.starts_with("[target.") && line.ends_with(".dependencies]"));
            return None;
        }
        let name = line.split(['.', '=', ' ']).next().unwrap_or_default();
        (inside && !name.is_empty() && !name.starts_with('#')).then_some(name)
    })
}
