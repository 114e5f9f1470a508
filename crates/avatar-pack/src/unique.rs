//! Names that are different from each other.

use std::collections::{HashMap, HashSet};

/// Bytes of a name. Names are made of other names and stand in many places, so that a long one of a file
/// would take a multiple of the file.
pub(crate) const LONGEST: usize = 256;

/// As much of a name as may be kept.
pub(crate) fn short(name: &str) -> &str {
    &name[..name.floor_char_boundary(LONGEST)]
}

/// Names that are not empty, not too long, and each there once: `Hand`, `Hand.2`, `Hand.3`.
pub(crate) fn unique_names<'a>(names: impl Iterator<Item = &'a str>, otherwise: &str) -> Vec<String> {
    let mut used = HashSet::new();
    let mut counts: HashMap<String, usize> = HashMap::new();
    names
        .enumerate()
        .map(|(index, name)| {
            let trimmed = short(name.trim());
            let wanted = if trimmed.is_empty() { format!("{otherwise}.{index}") } else { trimmed.to_owned() };
            let mut unique = wanted.clone();
            while !used.insert(unique.clone()) {
                let count = counts.entry(wanted.clone()).or_insert(1);
                *count += 1;
                unique = format!("{wanted}.{count}");
            }
            unique
        })
        .collect()
}
