//! Writes the pack in a folder as GLB: `export_glb FOLDER OUT.glb`.
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program: it has arguments and opens files"
)]

use avatar_pack::{MemorySource, Pack, Textures};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, to] = &arguments[..] else { return Err("expected FOLDER OUT.glb".into()) };
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if let (true, Some(name)) = (path.is_file(), path.file_name().and_then(|name| name.to_str())) {
            source.files.insert(name.to_owned(), std::fs::read(&path)?);
        }
    }
    let scene = avatar_pack::export(&Pack::load(&source)?, &Textures::load(&source));
    scene.notes.iter().for_each(|note| println!("{note}"));
    std::fs::write(to, avatar_exchange::glb::write_raw(&scene)?)?;
    Ok(())
}
