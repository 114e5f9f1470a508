//! Clips that end at speed, in the middle of a loop, or in other awkward ways.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{Clip, ControlTable, Easing, Key, Player, Track, Transition};
use proptest::prelude::*;
use std::sync::Arc;

fn table() -> ControlTable {
    ControlTable::from_toml("control = [{ name = 'smile', shape = 'S' }]").unwrap()
}

fn clip(keys: Vec<Key>) -> Clip {
    Clip::new("c", vec![Track::new(0, keys).unwrap()]).unwrap()
}

/// A number with a few decimals, as people write them; most have no exact binary form.
fn decimal(range: std::ops::Range<u32>, unit: f64) -> impl Strategy<Value = f64> {
    range.prop_map(move |n| f64::from(n) / unit)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// However the numbers are rounded, the speed at the end of a clip is braked and not dropped.
    #[test]
    fn a_clip_that_ends_at_speed_goes_on_smoothly(
        start in decimal(10..90, 100.0), end in decimal(10..90, 100.0),
        from_secs in decimal(0..30, 100.0), span_secs in decimal(1..80, 100.0),
        hermite in prop::option::of(-3.0f64..3.0),
    ) {
        prop_assume!((start - end).abs() > 0.05 || hermite.is_some());
        let transition = match hermite {
            None => Transition::LINEAR,
            Some(arriving) => Transition::Hermite { leaving: 0.0, arriving },
        };
        let end_secs = from_secs + span_secs;
        let keys = vec![
            Key { time_secs: from_secs, value: start, transition },
            Key::new(end_secs, end, Easing::Linear),
        ];
        let mut player = Player::new(&table()).with_overshoot();
        player.play(&Arc::new(clip(keys)), Some(0.001));
        let h = 1e-9;
        player.advance(end_secs - h).unwrap();
        let before = player.state(0).unwrap();
        player.advance(2.0 * h).unwrap();
        let after = player.state(0).unwrap();
        let speed = 1.0 + before.velocity.abs();
        // Braking in a few milliseconds at worst, so the change in 2 ns is small.
        prop_assert!((after.value - before.value).abs() < 4.0 * h * speed, "{before:?} {after:?}");
        prop_assert!((after.velocity - before.velocity).abs() < 1e-3 * speed, "{before:?} {after:?}");
    }

    /// What ends at rest is at rest at its end: no tail out of rounding.
    #[test]
    fn a_clip_that_ends_at_rest_ends_there(
        start in decimal(0..100, 100.0), end in decimal(0..100, 100.0),
        from_secs in decimal(0..30, 100.0), span_secs in decimal(2..80, 100.0), cubic in any::<bool>(),
    ) {
        let transition = if cubic {
            // No curvature at the end either: x = 1 - (1 - u)^3 has none, with a slope of 3 at its start.
            Transition::Ease(Easing::from_name("cubic-out").unwrap())
        } else {
            Transition::Ease(Easing::MinimumJerk)
        };
        let end_secs = from_secs + span_secs;
        let keys = vec![
            Key { time_secs: from_secs, value: start, transition },
            Key::new(end_secs, end, Easing::Linear),
        ];
        let mut player = Player::new(&table());
        player.play(&Arc::new(clip(keys)), Some(0.001));
        prop_assert!((player.secs_to_rest() - end_secs).abs() < 1e-9, "{} {end_secs}", player.secs_to_rest());
    }
}

#[test]
fn the_speed_of_a_line_is_not_lost_to_an_ulp() {
    let keys = vec![Key::new(0.0, 0.0, Easing::Linear), Key::new(0.09, 0.95, Easing::Linear)];
    let mut player = Player::new(&table());
    player.play(&Arc::new(clip(keys)), Some(0.001));
    player.advance(0.09).unwrap();
    assert!(player.state(0).unwrap().velocity > 10.0);
}

#[test]
fn a_last_step_and_a_last_jump_arrive_at_once() {
    let jump = [(0.0, 0.0), (0.5, 0.3), (0.5, 0.8)].map(|(t, v)| Key::new(t, v, Easing::Linear)).to_vec();
    let step = vec![Key::new(0.0, 0.3, Easing::StepEnd), Key::new(0.5, 0.8, Easing::Linear)];
    for keys in [jump, step] {
        let mut player = Player::new(&table());
        player.play(&Arc::new(clip(keys)), Some(0.1));
        player.advance(0.5 - 1e-6).unwrap();
        assert!(player.values()[0] < 0.31);
        player.advance(2e-6).unwrap();
        assert!(player.is_at_rest() && player.values()[0] == 0.8);
    }
}
