//! Times that are long, huge or infinite.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{Clip, ControlTable, Easing, Key, Player, Pose, Timing, Track, Wrap};
use std::sync::Arc;

/// A clip of 0.7 s whose period has no exact binary form.
fn repeated(wrap: Wrap) -> Arc<Clip> {
    let key = |time, value| Key::new(time, value, Easing::MinimumJerk);
    let track = Track::new(0, vec![key(0.0, 0.25), key(0.3, 1.0), key(0.7, 0.25)]).unwrap();
    Arc::new(Clip::new("c", vec![track]).unwrap().wrapped(wrap))
}

fn player() -> Player {
    Player::new(&ControlTable::from_toml("control = [{ name = 'smile', shape = 'S' }]").unwrap())
}

#[test]
fn a_day_of_a_clip_at_60_hertz() {
    for wrap in [Wrap::Loop, Wrap::PingPong] {
        let clip = repeated(wrap);
        let mut player = player();
        player.play(&clip, Some(0.2));
        let ticks = 24 * 3600 * 60;
        for _ in 0..ticks {
            player.advance(1.0 / 60.0).unwrap();
        }
        // The step is not a sixtieth to the last bit either, which is not the player's drift. The product is
        // exact to 2^-53 of a day.
        let expected = clip.at(0, f64::from(ticks) * (1.0 / 60.0)).unwrap();
        let found = player.state(0).unwrap();
        assert!((found.value - expected.value).abs() < 5e-10, "{found:?} {expected:?}");
        assert!((found.velocity - expected.velocity).abs() < 1e-8, "{found:?} {expected:?}");
    }
}

#[test]
fn huge_and_infinite_steps_do_not_stop_a_clip() {
    for wrap in [Wrap::Loop, Wrap::PingPong] {
        for huge in [1e9, 1e18, 1e300, f64::MAX, f64::INFINITY] {
            let clip = repeated(wrap);
            let mut player = player();
            player.play(&clip, None);
            player.advance(huge).unwrap();
            assert_eq!(player.secs_to_rest(), f64::INFINITY);
            // From the phase that this leads to, the clip goes on.
            let period = if wrap == Wrap::Loop { 0.7 } else { 1.4 };
            let phase = if huge.is_finite() { huge % period } else { 0.0 };
            for _ in 0..50 {
                player.advance(0.02).unwrap();
            }
            let (found, expected) = (player.state(0).unwrap(), clip.at(0, phase + 1.0).unwrap());
            assert!((found.value - expected.value).abs() < 1e-9, "{huge}: {found:?} {expected:?}");
            player.stop();
            player.advance(huge).unwrap();
            assert!(player.is_at_rest() && player.state(0).unwrap().is_rest());
        }
    }
}

#[test]
fn a_delayed_move_ends_a_clip_however_long_the_step() {
    for huge in [10.0, 1e300, f64::INFINITY] {
        let mut player = player();
        player.play(&repeated(Wrap::Loop), None);
        player.advance(1.3).unwrap();
        player.press(&Pose::new("p", vec![(0, 0.5)]).timed(0, Timing { delay_secs: 0.4, factor: 1.0 }));
        player.advance(huge).unwrap();
        assert!(player.is_at_rest() && player.values() == [0.5]);
    }
}
