//! What a film of ten frames of 640x360 pixels costs.
#![allow(clippy::expect_used, missing_docs, reason = "a measurement may panic and needs no documentation")]

#[path = "../tests/common/mod.rs"]
mod common;

use avatar_film::{Format, Rate};

fn main() {
    divan::main();
}

#[divan::bench(args = Format::ALL)]
fn ten_frames(bencher: divan::Bencher<'_, '_>, format: &Format) {
    let pictures = common::frames(640, 360, 10, false);
    let rate = Rate::new(25, 1).expect("a rate");
    bencher.bench(|| common::film(*format, &pictures, 640, 360, rate));
}
