//! Other people's files, all of Debian's `assimp-testmodels` in formats that are read here: `docs/formats.md` says which load.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "a test reads files and fails by panicking")]

mod texts;

use avatar_exchange::read;
use std::path::Path;

/// A row of the table: endings of names, and how many files load and how many are refused.
fn rows(text: &str) -> Vec<(Vec<String>, usize, usize)> {
    let table = text.split("| ending | loaded | refused |").nth(1).unwrap();
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    rows.map(|row| {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let endings = cells[1].split(", ").map(|ending| ending.trim_matches(['`', '.']).to_owned());
        (endings.collect(), cells[2].parse().unwrap(), cells[3].parse().unwrap())
    })
    .collect()
}

#[test]
fn the_documented_files_load_and_no_others() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/formats.md");
    let text = std::fs::read_to_string(docs).unwrap();
    let rows = rows(&text);
    assert!(rows.len() >= 6, "{rows:?}");
    for (endings, loaded, refused) in rows {
        let endings: Vec<&str> = endings.iter().map(String::as_str).collect();
        let models = texts::test_models(&endings);
        if models.is_empty() {
            // The reason has been told.
            return;
        }
        let mut found = (0, Vec::new());
        for path in &models {
            let folder = path.parent().unwrap();
            let mut beside =
                |name: &str| std::fs::read(folder.join(name)).map_err(|error| error.to_string());
            let result = texts::loads_or_tells(path, |name, bytes| read(name, bytes, &[], &mut beside));
            match result {
                Ok(_) => found.0 += 1,
                Err(_) => found.1.push(path.file_name().unwrap().to_string_lossy().into_owned()),
            }
        }
        assert_eq!((found.0, found.1.len()), (loaded, refused), "{endings:?}: refused were {:?}", found.1);
        for name in found.1 {
            assert!(text.contains(&name), "{name} was refused, and docs/formats.md does not say why");
        }
    }
}
