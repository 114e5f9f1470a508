//! The table of other people's files in `docs/formats.md` says what the readers do with them.

use crate::support::damage::{files, read_any};
use crate::support::data::models;
use avatar_exchange::{Format, ImportError, Scene, TextFile, bvh, collada, fbx, gltf, md5, obj};
use std::path::Path;

/// A row of the table.
#[derive(Debug, PartialEq)]
struct Row {
    folder: String,
    loaded: usize,
    /// Names of files in the order of their paths.
    refused: Vec<String>,
}

/// The table's rows with the numbers of refused files they tell.
fn documented() -> Vec<(Row, usize)> {
    let text = include_str!("../../../../docs/formats.md");
    let rows = text.split_once("| folder | loaded | refused | why |").unwrap().1;
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect();
    let rows = rows.lines().skip(2).take_while(|line| line.starts_with('|')).map(cells);
    rows.map(|cells: Vec<String>| {
        let [folder, loaded, refused, why] = &cells[..] else { panic!("{cells:?}") };
        // Names of files are code, and so is nothing else there.
        let mut names: Vec<String> = why.split('`').skip(1).step_by(2).map(str::to_owned).collect();
        names.sort();
        let row = Row { folder: folder.clone(), loaded: loaded.parse().unwrap(), refused: names };
        (row, refused.parse().unwrap())
    })
    .collect()
}

/// By the folder rather than by the name: archives and files that end in `.xml` are COLLADA, too.
fn read(folder: &str, path: &Path, name: &str, bytes: &[u8]) -> Result<Scene, ImportError> {
    let beside = path.parent().unwrap();
    let mut resolve = |wanted: &str| std::fs::read(beside.join(wanted)).map_err(|error| error.to_string());
    let format = if folder == "Collada" { Some(Format::Collada) } else { Format::of_name(name) };
    match format.unwrap() {
        Format::Gltf => gltf::read(name, bytes, &mut resolve),
        Format::Obj => obj::read(name, bytes, &mut resolve),
        Format::Fbx => fbx::read(name, bytes, &mut resolve),
        Format::Collada => collada::read(name, bytes, &mut resolve),
        Format::Md5 => md5::read(TextFile { file: name, bytes }, &[]),
        Format::Bvh => bvh::read(name, bytes),
        other => panic!("{other:?}"),
    }
}

#[test]
fn other_peoples_files_load_or_are_refused_as_documented() {
    let mut found = Vec::new();
    for (folder, endings) in [
        ("FBX", &["fbx"][..]),
        ("Collada", &["dae", "zae", "xml"]),
        ("OBJ", &["obj"]),
        ("MD5", &["md5mesh"]),
        ("BVH", &["bvh"]),
        ("glTF", &["gltf", "glb"]),
        ("glTF2", &["gltf", "glb"]),
        ("invalid", &["obj", "md5mesh"]),
    ] {
        let Some(path) = models(folder) else { return };
        let (mut loaded, mut refused) = (0, Vec::new());
        for file in files(&path, endings) {
            // In a subfolder names are not enough to tell files apart.
            let name = file.strip_prefix(&path).unwrap().to_string_lossy().into_owned();
            let read = |name: &str, bytes: &[u8]| read(folder, &file, name, bytes);
            match read_any(read, &name, &std::fs::read(&file).unwrap()) {
                Ok(_) => loaded += 1,
                Err(error) => {
                    println!("{folder}/{error}");
                    if folder == "glTF" {
                        assert!(error.expected.contains("glTF 2.0") && error.found.contains('1'), "{error}");
                        assert!(["asset.version", "byte 4"].contains(&error.place.as_str()), "{error}");
                    }
                    refused.push(name);
                }
            }
        }
        refused.sort();
        found.push(Row { folder: folder.to_owned(), loaded, refused });
    }
    for row in &found {
        println!("{row:?}");
    }
    let documented = documented();
    for (row, refused) in &documented {
        assert_eq!(row.refused.len(), *refused, "{row:?}");
    }
    let documented: Vec<Row> = documented.into_iter().map(|(row, _)| row).collect();
    assert_eq!(found, documented);
}
