//! Eyes that look at targets.

use crate::face::full;
use avatar_life::{Amounts, Life, Style, Target};

/// Always on the target, with nothing else going on.
fn staring() -> Style {
    let amounts = Amounts { gaze: 1.0, head: 1.0, ..Amounts::NONE };
    Style { amounts, contact: 1.0, ..Style::default() }
}

/// Where the lines of sight of both eyes pass each other, in metres, with the pupils 63 mm apart and the head
/// turned about the middle between them: eyes' angles and the head's are added.
fn sights(life: &Life) -> [[f64; 2]; 2] {
    let [turn, bow, _] = life.head();
    life.eyes().map(|[yaw, pitch]| [yaw + turn, pitch - bow])
}

#[test]
fn both_eyes_meet_at_the_target() {
    let controls = full();
    for position in [[0.0, 0.0, 0.3], [0.2, 0.1, 0.5], [-0.5, -0.2, 1.0], [0.1, 0.4, 2.0], [0.0, 0.0, 20.0]] {
        let mut life = Life::new(&controls, staring(), 2);
        life.attend(3, Some(Target::point(position)));
        life.advance(6.0).unwrap();
        let [x, y, z]: [f64; 3] = position;
        for ([yaw, pitch], eye) in sights(&life).into_iter().zip([0.0315, -0.0315]) {
            let expected = [(x - eye).atan2(z).to_degrees(), y.atan2(x.hypot(z)).to_degrees()];
            assert!((yaw - expected[0]).abs() < 0.05, "{position:?}: {yaw} {expected:?}");
            assert!((pitch - expected[1]).abs() < 0.05, "{position:?}: {pitch} {expected:?}");
        }
    }
}

#[test]
fn the_head_follows_late_and_less() {
    let controls = full();
    let mut life = Life::new(&controls, staring(), 2);
    life.advance(1.0).unwrap();
    life.attend(0, Some(Target::point([0.7, 0.0, 0.7])));
    let (mut eyes_there, mut head_there) = (None, None);
    for step in 0..300 {
        life.advance(0.01).unwrap();
        let now = f64::from(step) * 0.01;
        let (yaw, turn) = (sights(&life)[0][0], life.head()[0]);
        if eyes_there.is_none() && yaw > 40.0 {
            eyes_there = Some(now);
            assert!(turn < 8.0, "the head is late: {turn}");
        }
        if head_there.is_none() && turn > 18.0 {
            head_there = Some(now);
        }
    }
    let (eyes, head) = (eyes_there.unwrap(), head_there.unwrap());
    assert!(head > eyes + 0.15 && eyes < 0.4, "{eyes} {head}");
    let turn = life.head()[0];
    assert!((10.0..35.0).contains(&turn), "less than the 45 degrees: {turn}");
}

/// A target that moves steadily is followed within a quarter of a degree once the eyes are on it; the same
/// motion told again and again changes nothing.
#[test]
fn what_moves_is_pursued() {
    let controls = full();
    let velocity = [0.12, 0.03, 0.0];
    let mut once = Life::new(&controls, staring(), 6);
    let mut often = once.clone();
    let at = |now: f64| [-0.3 + velocity[0] * now, velocity[1] * now, 1.0];
    let target = |now: f64| Some(Target { velocity, ..Target::point(at(now)) });
    once.attend(0, target(0.0));
    for frame in 0..240u32 {
        let now = f64::from(frame) / 60.0;
        often.attend(0, target(now));
        often.advance(1.0 / 60.0).unwrap();
        once.advance(1.0 / 60.0).unwrap();
        let [x, y, z] = at(f64::from(frame + 1) / 60.0);
        let expected = [x.atan2(z).to_degrees(), y.atan2(x.hypot(z)).to_degrees()];
        for life in [&once, &often] {
            let [left, right] = sights(life);
            let yaw = 0.5 * (left[0] + right[0]);
            if frame > 60 {
                assert!((yaw - expected[0]).abs() < 0.25, "{frame}: {yaw} {expected:?}");
                assert!((left[1] - expected[1]).abs() < 0.25, "{frame}: {left:?} {expected:?}");
            }
        }
    }
    let [a, b] = [&once, &often].map(|life| sights(life)[0][0]);
    assert!((a - b).abs() < 1e-6, "{a} {b}");
}

/// Weights say how often each is looked at.
#[test]
fn weights_share_the_attention() {
    let controls = full();
    let mut life = Life::new(&controls, staring(), 9);
    life.attend(0, Some(Target { weight: 3.0, ..Target::point([-0.2, 0.0, 1.0]) }));
    life.attend(1, Some(Target { weight: 1.0, ..Target::point([0.2, 0.0, 1.0]) }));
    let mut on_right = 0;
    for _ in 0..60_000 {
        life.advance(0.1).unwrap();
        on_right += u32::from(sights(&life)[0][0] < 0.0);
    }
    let share = f64::from(on_right) / 60_000.0;
    assert!((share - 0.75).abs() < 0.03, "{share}");
    // One that has gone is left.
    life.attend(0, None);
    life.advance(1.0).unwrap();
    assert!(sights(&life)[0][0] > 8.0);
}

/// Pupils by light: Moon & Spencer 1944 have 6.9 mm for 0.01, 4.9 for 1, 2.9 for 100 cd/m², by their formula
/// `4.9 − 3 tanh(0.4 log₁₀ L)`.
#[test]
fn pupils_answer_light_and_interest() {
    let controls = full();
    for (light, millimetres) in [(0.01, 6.8921), (1.0, 4.9), (100.0, 2.9079), (10_000.0, 2.1350)] {
        let style = Style { amounts: Amounts { pupils: 1.0, ..Amounts::NONE }, ..Style::default() };
        let mut life = Life::new(&controls, style, 1);
        life.set_light(light);
        life.advance(5.0).unwrap();
        // Pupils are never quite still.
        assert!((life.pupil_mm() - millimetres).abs() < 0.15, "{light}: {}", life.pupil_mm());
        let before = life.pupil_mm();
        life.set_interest(1.0);
        life.advance(1.0).unwrap();
        assert!(life.pupil_mm() > before + 0.2);
    }
}
