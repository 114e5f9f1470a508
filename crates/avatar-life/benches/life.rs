//! What a living face costs in a frame.

#![allow(missing_docs, clippy::unwrap_used, reason = "a program")]

#[path = "../tests/all/face.rs"]
mod face;

use avatar_life::{Life, Style, Target};
use divan::{Bencher, black_box, counter::ItemsCount};

const DT_SECS: f64 = 1.0 / 60.0;
const FACES: usize = 1000;

fn main() {
    divan::main();
}

/// Time and values of a thousand faces, each with a seed of its own.
#[divan::bench(args = ["ahead", "moving target"])]
fn thousand_faces(bencher: Bencher<'_, '_>, looking: &str) {
    let controls = face::full();
    let mut faces: Vec<Life> = (0..FACES)
        .map(|seed| Life::new(&controls, Style::preset("lively").unwrap_or_default(), seed as u64))
        .collect();
    if looking != "ahead" {
        let target = Target { velocity: [0.01, 0.0, 0.0], ..Target::face([0.2, 0.1, 1.0]) };
        faces.iter_mut().for_each(|face| face.attend(0, Some(target)));
    }
    let below = controls.defaults();
    let mut values = below.clone();
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        for face in black_box(&mut faces) {
            let _ = face.advance(DT_SECS);
            let _ = face.apply(black_box(&below), &mut values);
            black_box(&values);
        }
    });
}
