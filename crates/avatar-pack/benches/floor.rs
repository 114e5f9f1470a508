//! Work that is little more than moving bytes, beside moving as many: loading a pack, deforming a skin,
//! welding. Both in turns in one run, since ratios of two runs on a shared machine mean little.
//!
//! `cargo bench -p avatar-pack --bench floor [-- load|deform|weld]`
#![allow(
    clippy::expect_used,
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench: it may panic, read files and a clock, and print"
)]

use avatar_mesh::{Mesh, deform, weld};
use avatar_pack::{FaceState, MemorySource, Pack};
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 301;

fn main() {
    let source = source();
    let bytes: usize = source.files.values().map(Vec::len).sum();
    println!(
        "medians and minima of {ROUNDS} rounds in turns; of a copy: bytes per second by those of the copy\n"
    );
    println!(
        "{:34}{:>12}{:>12}{:>12}{:>12}{:>10}",
        "", "median µs", "least µs", "copy", "least", "of a copy"
    );
    let load = || {
        black_box(Pack::load(black_box(&source)).expect("a good pack"));
    };
    let load_micros = row("load the built-in pack", load, || {
        for file in source.files.values() {
            black_box(black_box(file).clone());
        }
    });
    if let Some(load_micros) = load_micros {
        // Copies above fit into caches; this one is of memory.
        let (from, mut to) = halves(1 << 30);
        let copies = (0..7).map(|_| micros(&mut || black_box(&mut to).copy_from_slice(black_box(&from))));
        let mut copies: Vec<f64> = copies.collect();
        copies.sort_by(f64::total_cmp);
        let (copy, load) = (from.len() as f64 / copies[3] / 1e3, bytes as f64 / load_micros / 1e3);
        println!(
            "    which is {load:.1} GB/s; 512 MiB of memory copy at {copy:.1} GB/s; of that {:.2}",
            load / copy
        );
    }

    let pack = Pack::load(&source).expect("a good pack");
    let mut state = FaceState::new(&pack);
    let values: Vec<f32> = pack.controls().controls().iter().map(|control| control.max * 0.5).collect();
    state.pose(&pack, &values).expect("a pose");
    let skin = &pack.parts().iter().find(|part| part.mesh.skinning.is_some()).expect("a skin").mesh;
    let mut out = skin.deformed();
    for active in 0..=skin.shapes.len() {
        let weights: Vec<f32> = (0..skin.shapes.len()).map(|k| if k < active { 0.5 } else { 0.0 }).collect();
        let (read, written) = deform_bytes(skin, active);
        let (from, mut to) = halves(read + written);
        let work = || {
            deform(skin, black_box(state.bones()), black_box(&weights), &mut out).expect("deformed");
            black_box(&out);
        };
        row(&format!("deform its skin, {active} shapes"), work, || {
            black_box(&mut to).copy_from_slice(black_box(&from));
        });
    }

    let (from, mut to) = halves(2 * (31 * 4 * skin.positions.len() + 12 * skin.triangles.len()));
    let work = || {
        black_box(weld(black_box(skin)));
    };
    row("weld its skin to the bit", work, || {
        black_box(&mut to).copy_from_slice(black_box(&from));
    });
    println!("\n{bytes} bytes in the pack, {} vertices in its skin", skin.positions.len());
}

/// The built-in avatar without its textures.
fn source() -> MemorySource {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder).expect("the built-in avatar") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        if !name.ends_with(".png") {
            source.files.insert(name, std::fs::read(path).expect("a file"));
        }
    }
    source
}

/// What deforming has to read and write: positions, normals, four bones and weights, and offsets of the
/// active shapes; positions and normals.
fn deform_bytes(mesh: &Mesh, active: usize) -> (usize, usize) {
    let vertices = mesh.positions.len();
    let offsets: usize = mesh.shapes.iter().take(active).map(|shape| shape.memory_bytes()).sum();
    (vertices * (12 + 12 + 8 + 16) + offsets, vertices * 24)
}

/// Room for a copy that reads and writes so many bytes together.
fn halves(bytes: usize) -> (Vec<u8>, Vec<u8>) {
    (vec![1; bytes / 2], vec![2; bytes / 2])
}

/// Times both in turns, and prints them, unless other rows are asked for. The median of the work in
/// microseconds.
fn row(name: &str, mut work: impl FnMut(), mut copy: impl FnMut()) -> Option<f64> {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    if !wanted.is_empty() && !wanted.iter().any(|word| name.contains(word.as_str())) {
        return None;
    }
    let (mut working, mut copying) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        working.push(micros(&mut work));
        copying.push(micros(&mut copy));
    }
    for times in [&mut working, &mut copying] {
        times.sort_by(f64::total_cmp);
    }
    let (median, least) = (ROUNDS / 2, 0);
    println!(
        "{name:34}{:12.1}{:12.1}{:12.1}{:12.1}{:10.3}",
        working[median],
        working[least],
        copying[median],
        copying[least],
        copying[median] / working[median]
    );
    Some(working[median])
}

fn micros(work: &mut impl FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e6
}
