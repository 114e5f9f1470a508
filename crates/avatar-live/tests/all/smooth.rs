//! The face is twice continuously differentiable, whatever happens; and the 1€ filter is the paper's.

use crate::chance::Chance;
use avatar_live::{Frame, OneEuro, Receiver, Settings};

/// Random frames at random times, gaps, changes of sender, mirrors and new neutrals: the second derivative
/// never jumps. A lag less in any place would let it jump by 40 · 60 or so.
#[test]
fn nothing_makes_it_jump() {
    let (lag_secs, dt_secs) = (0.05, 1e-4);
    let rate = 2.0 / lag_secs;
    for seed in 0..3 {
        let mut chance = Chance::new(seed);
        let lead_secs = 0.004 * seed as f64;
        let settings =
            Settings { lag_secs, lead_secs, hold_secs: 0.1, ease_secs: 0.2, ..Settings::default() };
        let mut receiver = Receiver::new(settings);
        let mut next = [0.0, 0.0];
        let mut past = [0.0f64; 4];
        let (mut worst, mut largest) = (0.0f64, 0.0f64);
        for step in 0..100_000 {
            let now_secs = f64::from(step) * dt_secs;
            for (sender, name) in ["Ann", "Bob"].into_iter().enumerate() {
                if now_secs >= next[sender] {
                    next[sender] = now_secs + chance.within(0.01, 0.03);
                    if chance.share() < 0.02 {
                        next[sender] += 1.5;
                    }
                    let mut frame = chance.frame();
                    frame.time_secs = (sender == 0).then_some(now_secs);
                    receiver.push(now_secs, name, &frame).unwrap();
                }
            }
            match chance.bits() % 20_000 {
                0 => receiver.set_mirrored(!receiver.is_mirrored()),
                1 => receiver.choose(Some(0)),
                2 => receiver.choose(Some(1)),
                3 => drop(receiver.calibrate()),
                _ => {}
            }
            let value = f64::from(receiver.advance(now_secs).named("mouthSmileLeft").unwrap_or_default());
            past = [past[1], past[2], past[3], value];
            let second = |a: f64, b: f64, c: f64| (a - 2.0 * b + c) / (dt_secs * dt_secs);
            let [before, after] = [second(past[0], past[1], past[2]), second(past[1], past[2], past[3])];
            if step > 10 {
                worst = worst.max((after - before).abs());
                largest = largest.max(after.abs());
            }
        }
        println!("{seed}: worst {worst} of {largest}");
        // A line's slope is at most 1 in 5 ms (half of the shortest time between frames, made up for by 10
        // %): x''' ≤ rate² · 2 · 220 = 704,000, in a step 70; differences of 32-bit numbers near 1 add
        // 8 · 6e-8 / 1e-8 = 48.
        assert!(worst < rate * rate * 440.0 * dt_secs + 48.0, "{worst} of {largest}");
        assert!(largest > 500.0, "nothing moved: {largest}");
    }
}

/// The formulas of the paper, written out for one sample after the other.
#[test]
fn one_euro_by_hand() {
    let (dt, least, beta) = (1.0 / 60.0, 1.0, 0.5);
    let alpha = |cutoff: f64| 1.0 / (1.0 + (1.0 / (2.0 * std::f64::consts::PI * cutoff)) / dt);
    let mut filter = OneEuro::default();
    let (mut x, mut dx) = (0.3, 0.0);
    assert_eq!(filter.next(0.3, dt, least, beta), x);
    let mut chance = Chance::new(1);
    for _ in 0..100 {
        let sample = chance.share();
        dx = alpha(1.0) * ((sample - x) / dt) + (1.0 - alpha(1.0)) * dx;
        let a = alpha(least + beta * f64::abs(dx));
        x = a * sample + (1.0 - a) * x;
        assert!((filter.next(sample, dt, least, beta) - x).abs() < 1e-12);
    }
    assert_eq!(filter.next(f64::NAN, dt, least, beta), filter.next(0.0, 0.0, least, beta));
}

/// Trembling at rest gets less, and what moves is no later than the bound.
#[test]
fn smoothing_calms_and_its_delay_is_bounded() {
    let run = |smooth_secs: Option<f64>| {
        let mut chance = Chance::new(5);
        let mut receiver = Receiver::new(Settings { smooth_secs, ..Settings::default() });
        let mut squares = 0.0;
        let mut delays = Vec::new();
        for step in 0..1200 {
            let now_secs = f64::from(step) / 60.0;
            // It rests for ten seconds, then it goes to and fro in slopes of half a second.
            let face = |secs: f64| if secs < 10.0 { 0.5 } else { (0.5 + (secs - 10.0)).min(1.0) };
            let mut frame = Frame::at(Some(now_secs));
            let noise = if now_secs < 9.0 { chance.within(-0.02, 0.02) } else { 0.0 };
            frame.set_named("jawOpen", (face(now_secs) + noise) as f32);
            receiver.push(now_secs, "Ann", &frame).unwrap();
            let shown = f64::from(receiver.advance(now_secs).named("jawOpen").unwrap_or_default());
            if (240..540).contains(&step) {
                squares += (shown - 0.5).powi(2);
            }
            if (10.2..10.45).contains(&now_secs) {
                delays.push(now_secs - (10.0 + shown - 0.5));
            }
        }
        ((squares / 300.0).sqrt(), delays.iter().copied().fold(0.0, f64::max))
    };
    let (plain, plain_delay) = run(None);
    for bound in [0.02, 0.05, 0.1] {
        let (noise, delay) = run(Some(bound));
        println!("{bound}: noise {noise} of {plain}, delay {delay} of {plain_delay}");
        assert!(noise < plain * (1.0 - 2.0 * bound).min(0.8), "{noise} of {plain}");
        assert!(delay <= plain_delay + bound, "{delay}");
    }
}
