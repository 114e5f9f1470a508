//! What the controls of a face move: of the built-in avatar, and of it with sixty controls.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a bench: it may panic and read files"
)]

use avatar_mesh::{PartKind, Shape};
use avatar_pack::{FaceState, Gaze, MemorySource, Pack, Reach};
use divan::Bencher;
use glam::Vec3;
use pose_anim::{Control, ControlTable, Drive, Pace};
use std::path::Path;

fn main() {
    divan::main();
}

fn built_in() -> Pack {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder).expect("the built-in avatar") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        if !name.ends_with(".png") {
            source.files.insert(name, std::fs::read(path).expect("a file"));
        }
    }
    Pack::load(&source).expect("a good pack")
}

/// With shapes that each move another tenth of the skin.
fn sixty_controls() -> Pack {
    let mut contents = built_in().into_contents();
    let mut controls = contents.controls.controls().to_vec();
    let skin = contents.parts.iter_mut().find(|part| part.kind == PartKind::Skin).expect("a skin");
    let count = skin.mesh.positions.len();
    for index in 0..60 - controls.len() {
        let name = format!("shape{index}");
        let start = index * count / 50;
        let moved = (start..(start + count / 10).min(count)).map(|vertex| (vertex as u32, Vec3::Z));
        skin.mesh.shapes.push(Shape::from_pairs(&name, count, moved).expect("a shape"));
        contents.shapes.push(name.clone());
        let drives = Drive::Shape { shape: name.clone() };
        let pace = Pace::of(&drives);
        controls.push(Control { name, drives, min: 0.0, max: 1.0, default: 0.0, pace, group: None });
    }
    contents.controls = ControlTable::new(controls).expect("controls");
    Pack::new(contents).expect("a pack")
}

#[divan::bench(sample_count = 5)]
fn reach(bencher: Bencher<'_, '_>) {
    let pack = built_in();
    bencher.bench(|| Reach::new(&pack));
}

#[divan::bench(sample_count = 5)]
fn reach_of_sixty_controls(bencher: Bencher<'_, '_>) {
    let pack = sixty_controls();
    assert_eq!(pack.controls().len(), 60);
    bencher.bench(|| Reach::new(&pack));
}

#[divan::bench]
fn hit(bencher: Bencher<'_, '_>) {
    let pack = built_in();
    let state = FaceState::new(&pack);
    let face: Vec<_> =
        (0..pack.parts().len()).map(|part| state.deform(&pack, part).expect("a part")).collect();
    bencher.bench(|| pack.hit(&face, Vec3::new(0.5, 5.0, 100.0), Vec3::NEG_Z));
}

#[divan::bench]
fn look_at(bencher: Bencher<'_, '_>) {
    let pack = built_in();
    let (mut gaze, values) = (Gaze::new(&pack).expect("eyes"), pack.controls().defaults());
    let mut out = Vec::new();
    bencher.bench_local(|| gaze.look_at(&pack, &values, Vec3::new(10.0, 5.0, 60.0), &mut out));
}
