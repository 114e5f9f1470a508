//! Reads a glTF file and writes its scene as GLB: `rewrite_glb IN.gltf OUT.glb`.
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program: it has arguments and opens files"
)]

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [from, to] = &arguments[..] else { return Err("expected IN.gltf OUT.glb".into()) };
    let folder = Path::new(from).parent().unwrap_or(Path::new("."));
    let mut resolve = |uri: &str| std::fs::read(folder.join(uri)).map_err(|error| error.to_string());
    let scene = avatar_exchange::gltf::read(from, &std::fs::read(from)?, &mut resolve)?;
    scene.notes.iter().for_each(|note| println!("{note}"));
    std::fs::write(to, avatar_exchange::glb::write(&scene)?)?;
    Ok(())
}
