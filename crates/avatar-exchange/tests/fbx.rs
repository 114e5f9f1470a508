//! FBX: values computed by hand, other people's files, damaged files.
#![cfg(feature = "fbx")]
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test: it may panic, read files and look at the clock"
)]

mod damage;

use avatar_exchange::{ImportError, Scene, fbx};
use damage::{damage, files, models, read_any, summary};

fn read(file: &str, bytes: &[u8]) -> Result<Scene, ImportError> {
    fbx::read(file, bytes, &mut |_| Err("there are no other files".to_owned()))
}

#[test]
fn other_peoples_files_load_or_are_refused() {
    let Some(folder) = models("FBX") else { return };
    for path in files(&folder, &["fbx"]) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let result = read_any(read, &name, &std::fs::read(&path).unwrap());
        match result {
            Ok(scene) => println!("{name}: {}\n   {:?}", summary(&scene), scene.notes.iter().map(|n| n.to_string()).collect::<Vec<_>>()),
            Err(error) => println!("{error}"),
        }
    }
}
