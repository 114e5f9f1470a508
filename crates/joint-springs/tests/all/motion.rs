use crate::scene::{LENGTH, PARENTS, animated, chain, end};
use glam::{Affine3A, DVec3, Quat, Vec3};
use joint_springs::{Law, Spring, Swing};

const SOFT: Law =
    Law::Oscillator { frequency_hz: 1.6, damping_ratio: 0.25, gravity: Vec3::new(0.0, -1.0, 0.0) };
const VRM: Law = Law::Vrm { stiffness: 0.6, drag: 0.25, gravity: Vec3::new(0.0, -0.15, 0.0) };

/// The end of the chain at these times, in the order given.
fn ends(law: Law, times: impl IntoIterator<Item = f64>) -> Vec<Vec3> {
    let mut swing = Swing::new(&PARENTS, chain(law), vec![]).unwrap();
    let mut before = 0.0;
    times
        .into_iter()
        .map(|time| {
            let mut world = animated(time);
            swing.advance(time - before, &mut world).unwrap();
            before = time;
            end(&world)
        })
        .collect()
}

/// Frames of these rates meet every half second; there the ends may differ by a thousandth of the chain.
#[test]
fn frame_rates_agree() {
    for law in [SOFT, VRM] {
        let at = |rate: usize| {
            let all = ends(law, (0..=6 * rate).map(|frame| frame as f64 / rate as f64));
            all.into_iter().step_by(rate / 2).collect::<Vec<_>>()
        };
        let expected = at(960);
        // Without a swing there would be nothing to agree about.
        let still: f32 =
            (0..12).map(|n| (expected[n] - end(&animated(n as f64 / 2.0))).length()).sum::<f32>() / 12.0;
        assert!(still > 0.1 * LENGTH, "{law:?} swings by {still}");
        for rate in [24, 60, 144] {
            let worst = expected.iter().zip(at(rate)).map(|(a, b)| (*a - b).length()).fold(0.0, f32::max);
            assert!(worst < 1e-3 * 3.0 * LENGTH, "{law:?} at {rate} Hz is {worst} off");
        }
        // Steps of 0.2 to 40 ms, each other one short.
        let mut state = 7u32;
        let mut time = 0.0;
        let mut times = vec![0.0];
        for half in 1..=12 {
            let goal = f64::from(half) / 2.0;
            while time < goal {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let share = f64::from(state >> 8) / f64::from(1u32 << 24);
                time = f64::min(goal, time + 2e-4 + 0.04 * share * share);
                times.push(time);
            }
        }
        let all = ends(law, times.iter().copied());
        let met = times.iter().zip(all).filter(|(time, _)| (**time * 2.0).fract() == 0.0).map(|(_, end)| end);
        let worst = expected.iter().zip(met).map(|(a, b)| (*a - b).length()).fold(0.0, f32::max);
        assert!(worst < 1e-3 * 3.0 * LENGTH, "{law:?} at random steps is {worst} off");
    }
}

/// Against the formula of the standard, written out for one joint in numbers of 64 bits.
#[test]
fn vrm_joints_follow_the_standard() {
    let (stiffness, drag, gravity) = (0.8, 0.3, DVec3::new(0.02, -0.2, 0.05));
    let law = Law::Vrm { stiffness: stiffness as f32, drag: drag as f32, gravity: gravity.as_vec3() };
    let mut swing =
        Swing::new(&PARENTS[..2], vec![Spring::new(1, Vec3::NEG_Y * LENGTH, law)], vec![]).unwrap();
    let rest = |frame: u32| {
        let matrix = animated(f64::from(frame) / 60.0)[1];
        (matrix.translation.as_dvec3(), matrix.transform_vector3(Vec3::NEG_Y).as_dvec3().normalize_or_zero())
    };
    let length = f64::from(LENGTH);
    let (origin, axis) = rest(0);
    let mut tail = origin + axis * length;
    let mut before = tail;
    for frame in 0..400 {
        let mut world = animated(f64::from(frame) / 60.0);
        swing.advance(if frame == 0 { 0.0 } else { 1.0 / 60.0 }, &mut world[..2]).unwrap();
        if frame > 0 {
            let (origin, axis) = rest(frame);
            let next = tail + (tail - before) * (1.0 - drag) + axis * stiffness / 60.0 + gravity / 60.0;
            before = tail;
            tail = origin + (next - origin).normalize_or_zero() * length;
        }
        let found = world[1].transform_point3(Vec3::NEG_Y * LENGTH).as_dvec3();
        assert!((found - tail).length() < 1e-5 * length.max(1.0), "frame {frame}: {found} for {tail}");
    }
}

/// A head that is moved at once by a step: the tail follows `1 − e^(−ζωt) (cos ω′t + ζω/ω′ sin ω′t)`.
#[test]
fn an_oscillator_answers_a_step_as_the_formula_says() {
    let (frequency, damping) = (2.0f64, 0.2f64);
    let law = Law::Oscillator { frequency_hz: 2.0, damping_ratio: 0.2, gravity: Vec3::ZERO };
    // A long joint and a short way, so that the turn is the way over the length.
    let mut swing = Swing::new(&[None], vec![Spring::new(0, Vec3::NEG_Y, law)], vec![]).unwrap();
    swing.advance(0.0, &mut [Affine3A::IDENTITY]).unwrap();
    let step = 1e-2f32;
    let (omega, tick) = (std::f64::consts::TAU * frequency, 1.0 / 60.0);
    let damped = omega * (1.0 - damping * damping).sqrt();
    let answer = |t: f64| {
        1.0 - (-damping * omega * t).exp()
            * ((damped * t).cos() + damping * omega / damped * (damped * t).sin())
    };
    // The way is taken within one tick, at one speed: the mean of the answers to all steps during it.
    let mean =
        |t: f64| (0..2000).map(|n| answer(t - tick * (f64::from(n) + 0.5) / 2000.0)).sum::<f64>() / 2000.0;
    let mut t = 0.0;
    for frame in 1..240 {
        let mut world = [Affine3A::from_translation(Vec3::X * step)];
        swing.advance(tick, &mut world).unwrap();
        t += tick;
        let tail = f64::from(world[0].transform_point3(Vec3::NEG_Y).x);
        // The damping acts against the speed of the rest, so during the tick it pulls along.
        let pulled = tail / f64::from(step);
        let expected = mean(t) + 2.0 * damping * omega * impulse(t, tick, damping * omega, damped);
        assert!((pulled - expected).abs() < 2e-3, "frame {frame}: {pulled} for {expected}");
    }
}

/// The mean over a tick of `e^(−at) sin(bt) / b`, the answer to a push.
fn impulse(t: f64, tick: f64, a: f64, b: f64) -> f64 {
    (0..2000)
        .map(|n| t - tick * (f64::from(n) + 0.5) / 2000.0)
        .map(|t| (-a * t).exp() * (b * t).sin() / b)
        .sum::<f64>()
        / 2000.0
}

/// At rest nothing moves, and what hangs in gravity hangs below its rest.
#[test]
fn a_still_skeleton_stays_at_rest() {
    let law = Law::Oscillator { frequency_hz: 2.0, damping_ratio: 0.3, gravity: Vec3::ZERO };
    for law in [law, Law::Vrm { stiffness: 1.0, drag: 0.4, gravity: Vec3::ZERO }] {
        let mut swing = Swing::new(&PARENTS, chain(law), vec![]).unwrap();
        for _ in 0..200 {
            let mut world = animated(0.3);
            swing.advance(1.0 / 90.0, &mut world).unwrap();
            assert!((end(&world) - end(&animated(0.3))).length() < 1e-6);
        }
    }
    let gravity = Vec3::new(0.0, 0.0, -2.0);
    let law = Law::Oscillator { frequency_hz: 1.0, damping_ratio: 1.0, gravity };
    let mut swing = Swing::new(&[None], vec![Spring::new(0, Vec3::NEG_Y, law)], vec![]).unwrap();
    let mut world = [Affine3A::IDENTITY];
    for _ in 0..600 {
        world = [Affine3A::IDENTITY];
        swing.advance(1.0 / 60.0, &mut world).unwrap();
    }
    let tail = world[0].transform_point3(Vec3::NEG_Y);
    let sag = 2.0 / std::f32::consts::TAU.powi(2);
    assert!((-tail.z / -tail.y - sag).abs() < 1e-5, "{tail}");
}

/// What moves with the center does not swing.
#[test]
fn inertia_counts_in_the_center() {
    for law in [SOFT, Law::Vrm { stiffness: 0.5, drag: 0.2, gravity: Vec3::ZERO }] {
        let law = match law {
            Law::Oscillator { frequency_hz, damping_ratio, .. } => {
                Law::Oscillator { frequency_hz, damping_ratio, gravity: Vec3::ZERO }
            }
            vrm => vrm,
        };
        let springs = |center| chain(law).into_iter().map(|spring| Spring { center, ..spring }).collect();
        let mut swings = [Some(0), None].map(|center| Swing::new(&PARENTS, springs(center), vec![]).unwrap());
        let mut worst = [0.0f32; 2];
        for frame in 0..300 {
            let rest = animated(f64::from(frame) / 60.0);
            for (swing, worst) in swings.iter_mut().zip(&mut worst) {
                let mut world = rest;
                swing.advance(1.0 / 60.0, &mut world).unwrap();
                *worst = worst.max((end(&world) - end(&rest)).length());
            }
        }
        assert!(worst[0] < 1e-5 && worst[1] > 0.2 * LENGTH, "{law:?}: {worst:?}");
    }
}

/// Joints keep their lengths, and no stiffness or step makes them shake apart.
#[test]
fn every_stiffness_is_stable() {
    for frequency_hz in [0.0, 0.1, 5.0, 60.0, 999.0, 1e9, f32::INFINITY] {
        for damping_ratio in [0.0, 0.5, 1.0, 50.0, f32::MAX] {
            let law = Law::Oscillator { frequency_hz, damping_ratio, gravity: Vec3::ZERO };
            let mut swing = Swing::new(&PARENTS, chain(law), vec![]).unwrap();
            let mut time = 0.0;
            for frame in 0..600 {
                let dt = [0.001, 0.3, 0.016, 5.0][frame % 4];
                time += dt;
                // Moves for a while, then stands.
                let rest = animated(f64::min(time, 20.0));
                let mut world = rest;
                swing.advance(dt, &mut world).unwrap();
                for joint in &world[1..] {
                    assert!(joint.is_finite());
                    let along = joint.transform_vector3(Vec3::NEG_Y * LENGTH).length();
                    assert!((along - LENGTH).abs() < 1e-4 * LENGTH);
                }
                if time > 400.0
                    && damping_ratio > 0.0
                    && frequency_hz < 1e3
                    && frequency_hz > 1.0
                    && damping_ratio < 2.0
                {
                    assert!((end(&world) - end(&rest)).length() < 1e-4, "{law:?}");
                }
            }
        }
    }
}

/// Everything below a joint that swings goes with it, and nothing else is touched.
#[test]
fn what_hangs_below_goes_along() {
    let parents = [None, Some(0), Some(1), Some(0)];
    let spring = Spring::new(1, Vec3::NEG_Y, SOFT);
    let mut swing = Swing::new(&parents, vec![spring], vec![]).unwrap();
    let below = Affine3A::from_rotation_translation(Quat::from_rotation_x(0.4), Vec3::new(0.1, -0.2, 0.3));
    for frame in 0..60 {
        let head = animated(f64::from(frame) / 30.0)[0];
        let mut world = [head, head, head * below, head * below];
        swing.advance(1.0 / 30.0, &mut world).unwrap();
        assert_eq!(world[0], head);
        assert_eq!(world[3], head * below);
        assert!((world[1] * below).abs_diff_eq(world[2], 1e-5));
    }
}
