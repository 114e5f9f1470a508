//! What a second of sound costs.

#![allow(clippy::expect_used, reason = "a measurement may panic")]

use avatar_hearing::Hearing;

fn main() {
    divan::main();
}

/// Noise as loud as speech, at these rates.
#[divan::bench(args = [8_000, 16_000, 48_000, 192_000])]
fn a_second(bencher: divan::Bencher, rate: u32) {
    let mut hearing = Hearing::new(rate).expect("the rate is heard");
    let mut seed = 1_u32;
    let samples: Vec<f32> = (0..rate)
        .map(|_| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32 * 0.2 - 0.1
        })
        .collect();
    bencher.bench_local(|| {
        hearing.push(divan::black_box(&samples), |frame| {
            divan::black_box(frame);
        })
    });
}
