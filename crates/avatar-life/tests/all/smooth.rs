//! Values are twice continuously differentiable, and within their ranges.

use crate::common::Random;
use crate::face::full;
use avatar_life::{Amounts, Life, Style, Target};
use pose_anim::{LayerMode, Layers, PoseSet};

/// Random interruptions of a life.
fn interrupt(life: &mut Life, random: &mut Random) {
    let mut place = |most: f64| random.between(-most, most);
    let position = [place(1.0), place(0.5), place(0.6) + 0.7];
    let velocity = [place(0.4), place(0.2), place(0.3)];
    let target = Target { position, velocity, weight: 1.0, size: 0.02 };
    match random.below(8) {
        0 | 1 => life.attend(random.below(3), Some(target)),
        2 => life.attend(random.below(3), None),
        3 => life.set_style(Style::PRESETS[random.below(5)]),
        4 => {
            let mut amount = || random.share();
            let amounts = Amounts {
                blinks: amount(),
                gaze: amount(),
                micro: amount(),
                head: amount(),
                sway: amount(),
                brows: amount(),
                breath: amount(),
                pupils: amount(),
            };
            life.set_style(Style { amounts, ..Style::PRESETS[random.below(5)] });
        }
        5 => life.think(random.share()),
        6 => life.end_utterance(),
        _ => life.set_light(1000.0 * random.share()),
    }
}

/// Ten thousand random mixtures of poses in motion, a layer over them, and life: all values in their ranges,
/// and no value jumps. A saccade goes at 700 degrees a second at most, a lid at 55 degrees in 70 ms or 1.9
/// times as fast at its peak, poses at their own pace.
#[test]
fn mixtures_keep_their_ranges() {
    let controls = full();
    let poses = PoseSet::default_face(&controls);
    let mut random = Random(1);
    let mut layers = Layers::new(&controls);
    let layer = layers.add(&controls, LayerMode::Additive, &vec![1.0; controls.len()]);
    layers.fade_to(layer, 0.7, 0.1);
    let mut life = Life::new(&controls, Style::default(), 77);
    let mut values = controls.defaults();
    let mut mixtures = 0;
    while mixtures < 10_000 {
        if random.share() < 0.3 {
            let pose = poses.iter().nth(random.below(poses.poses.len())).unwrap();
            match random.below(3) {
                0 => layers.layer(layer).unwrap().press(pose),
                _ => layers.base().press(pose),
            }
        }
        interrupt(&mut life, &mut random);
        for _ in 0..random.below(8) + 1 {
            let dt = random.between(0.001, 0.08);
            layers.advance(dt).unwrap();
            life.advance(dt).unwrap();
            let before = values.clone();
            life.apply(layers.values(), &mut values).unwrap();
            for ((control, value), before) in controls.controls().iter().zip(&values).zip(&before) {
                assert!((control.min..=control.max).contains(value), "{}: {value}", control.name);
                let fastest = f64::from(control.max - control.min) * 40.0 * dt + 1e-3;
                assert!(f64::from((value - before).abs()) < fastest, "{}: {before} {value}", control.name);
            }
        }
        mixtures += 1;
    }
}

/// The largest change of the acceleration from one step to the next, of each control, over a stretch that is
/// full of interruptions, over poses in motion.
fn roughness(seed: u64, step_secs: f64) -> Vec<f64> {
    let controls = full();
    let poses = PoseSet::default_face(&controls);
    let mut random = Random(seed);
    let mut life = Life::new(&controls, Style::preset("nervous").unwrap(), seed);
    let mut layers = Layers::new(&controls);
    let mut last: Vec<[f64; 4]> = vec![[0.0; 4]; controls.len()];
    let mut worst = vec![0.0f64; controls.len()];
    let mut seen = 0;
    for _ in 0..12 {
        interrupt(&mut life, &mut random);
        layers.base().press(poses.iter().nth(random.below(poses.poses.len())).unwrap());
        for _ in 0..(0.35 / step_secs).round() as usize {
            layers.advance(step_secs).unwrap();
            life.advance(step_secs).unwrap();
            for (control, last) in last.iter_mut().enumerate() {
                let below = layers.state(control).unwrap().value;
                *last = [last[1], last[2], last[3], life.value(control, below)];
                if seen >= 3 {
                    let third = last[3] - 3.0 * last[2] + 3.0 * last[1] - last[0];
                    worst[control] = worst[control].max(third.abs() / (step_secs * step_secs));
                }
            }
            seen += 1;
        }
    }
    worst
}

/// With a step of a fourth, changes of a continuous acceleration are a fourth; where it, or the velocity,
/// jumps, they stay as they are, or grow.
#[test]
fn accelerations_do_not_jump() {
    let (mut checked, controls) = (0, full());
    for seed in 0..40 {
        let (coarse, fine) = (roughness(seed, 4e-5), roughness(seed, 1e-5));
        for ((control, coarse), fine) in controls.controls().iter().zip(coarse).zip(fine) {
            // What rounding leaves of values up to 70 in steps of 1e-5.
            let rounding = 8.0 * 70.0 * f64::EPSILON / 1e-10;
            assert!(fine < 0.4 * coarse + rounding, "{} of seed {seed}: {coarse} {fine}", control.name);
            checked += usize::from(fine > 10.0 * rounding);
        }
    }
    assert!(checked > 200, "{checked}");
}
