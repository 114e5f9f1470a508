//! Every control arrives when its pose says.

use super::easings;
use super::generate::{Random, pose, table};
use pose_anim::{Easing, Jet, Player, Pose};

/// Partial, weighted, delayed, eased presses, direct or as fades: of the last one that names a control, the
/// arrival is the press + its delay + its duration (or, if it has none, the control's own for the distance) ·
/// its factor. Not before, and then bit for bit and at rest.
#[test]
fn controls_arrive_when_their_pose_says() {
    let table = table();
    let mut random = Random(31);
    let transitions = easings(false);
    let mut checked = 0;
    for round in 0..3000 {
        let span = if random.one_in(2) { 0.1 } else { 0.8 };
        let mut times: Vec<f64> = (0..1 + random.below(8)).map(|_| span * random.unit()).collect();
        times.sort_by(f64::total_cmp);
        let presses: Vec<(f64, Pose)> =
            times.into_iter().map(|at| (at, pose(&mut random, &table, &transitions))).collect();
        // The player at a time, by the presses until then.
        let at = |time: f64| {
            let (mut player, mut now) = (Player::new(&table), 0.0);
            for (at, pose) in presses.iter().take_while(|press| press.0 <= time) {
                player.advance(at - now).unwrap();
                player.press(pose);
                now = *at;
            }
            player.advance(time - now).unwrap();
            player
        };
        for (index, control) in table.controls().iter().enumerate() {
            let last = presses.iter().rev().find(|(_, pose)| pose.value(index).is_some());
            let Some((pressed, pose)) = last else { continue };
            let (target, timing) = (pose.value(index).unwrap(), pose.timing(index));
            let start = pressed + timing.delay_secs;
            let state = at(start).state(index).unwrap();
            let own = || {
                control
                    .pace
                    .duration_secs(f64::from(target) - state.value, f64::from(control.max - control.min))
            };
            let secs = pose.duration_secs.unwrap_or_else(own) * timing.factor;
            let rest = Jet::rest(target.into());
            // A move that has nearly arrived cannot be told from one that has.
            let far = (f64::from(target) - state.value).abs() > 1e-3 * f64::from(control.max - control.min);
            // A fade out of a motion to the same place arrives when that motion does.
            let other = presses.iter().all(|(at, old)| at == pressed || old.value(index) != Some(target));
            if far && other && pose.transition != Some(Easing::StepStart) {
                let early = at(start + 0.99 * secs);
                assert_ne!(early.state(index), Some(rest), "script {round}: {presses:?}");
            }
            let arrived = at(start + secs + 1e-9);
            assert_eq!(arrived.state(index), Some(rest), "script {round}, control {index}: {presses:?}");
            assert_eq!(arrived.values()[index], target);
            assert_eq!((arrived.velocities()[index], arrived.accelerations()[index]), (0.0, 0.0));
            checked += 1;
        }
    }
    assert!(checked > 6000, "{checked}");
}
