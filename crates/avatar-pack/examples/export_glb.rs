//! Writes the pack in a folder as GLB: `export_glb FOLDER OUT.glb [OUT.tsv]`. The third argument is for
//! comparing other programs' results: pose, part and the mean of its vertices, as this program computes it.
//! Beside it `OUT.targets.tsv` lists each mixture with each part and the place of its first number in
//! `OUT.targets.f32`, where all vertices are as the mixture at 1 moves them.
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program: it has arguments and opens files"
)]

use avatar_pack::{FaceState, MemorySource, Pack, Textures};
use glam::DVec3;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, to, means @ ..] = &arguments[..] else {
        return Err("expected FOLDER OUT.glb [OUT.tsv]".into());
    };
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if let (true, Some(name)) = (path.is_file(), path.file_name().and_then(|name| name.to_str())) {
            source.files.insert(name.to_owned(), std::fs::read(&path)?);
        }
    }
    let pack = Pack::load(&source)?;
    let scene = avatar_pack::export(&pack, &Textures::load(&source));
    scene.notes.iter().for_each(|note| println!("{note}"));
    std::fs::write(to, avatar_exchange::glb::write_raw(&scene)?)?;
    if let [means] = means {
        std::fs::write(means, means_of(&pack)?)?;
        let (lines, numbers) = mixtures_of(&pack)?;
        let means = std::path::Path::new(means);
        std::fs::write(means.with_extension("targets.tsv"), lines)?;
        std::fs::write(means.with_extension("targets.f32"), numbers)?;
    }
    Ok(())
}

fn means_of(pack: &Pack) -> Result<String, Box<dyn Error>> {
    let mut lines = String::new();
    let mut state = FaceState::new(pack);
    for pose in &pack.poses().poses {
        let mut values = pack.controls().defaults();
        pose.values.iter().for_each(|(control, value)| values[*control] = *value);
        state.pose(pack, &values)?;
        for (number, part) in pack.parts().iter().enumerate() {
            let positions = state.deform(pack, number)?.positions;
            let sum: DVec3 = positions.iter().map(|position| position.as_dvec3()).sum();
            let DVec3 { x, y, z } = sum / positions.len() as f64;
            lines += &format!("{}\t{}\t{x}\t{y}\t{z}\n", pose.name, part.name);
        }
    }
    Ok(lines)
}

/// A line for each mixture and part, and the vertices of all these in little-endian numbers.
fn mixtures_of(pack: &Pack) -> Result<(String, Vec<u8>), Box<dyn Error>> {
    let (mut lines, mut numbers) = (String::new(), Vec::new());
    let mut state = FaceState::new(pack);
    for mixture in pack.further_shapes().map_or(&[][..], |shapes| &shapes.mixtures) {
        let mut values = pack.controls().defaults();
        values[pack.controls().index(&mixture.name).ok_or("expected a control of each mixture")?] = 1.0;
        state.pose(pack, &values)?;
        for (number, part) in pack.parts().iter().enumerate() {
            lines += &format!("{}\t{}\t{}\n", mixture.name, part.name, numbers.len() / 4);
            let positions = state.deform(pack, number)?.positions;
            numbers
                .extend(positions.iter().flat_map(|position| position.to_array()).flat_map(f32::to_le_bytes));
        }
    }
    Ok((lines, numbers))
}
