//! What a player says of where it is heading: targets of controls, and the time of a clip.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{Clip, ControlTable, Key, Layers, Player, Pose, Timing, Track, Wrap};
use std::sync::Arc;

const SMILE: usize = 13;
const FROWN: usize = 14;

fn clip(wrap: Wrap) -> Arc<Clip> {
    let keys = [(0.0, 0.0), (1.0, 0.8), (2.0, 0.2)];
    let keys = keys.map(|(at, value)| Key::new(at, value, pose_anim::Easing::MinimumJerk)).to_vec();
    Arc::new(Clip::new("nod", vec![Track::new(SMILE, keys).unwrap()]).unwrap().wrapped(wrap))
}

#[test]
fn a_target_is_the_last_press_whether_it_has_begun_or_waits() {
    let controls = ControlTable::default_face();
    let mut player = Player::new(&controls);
    assert!(player.targets().eq(controls.defaults()));
    let late = Timing { delay_secs: 0.5, ..Timing::default() };
    player.press(&Pose::new("late", vec![(SMILE, 0.7), (FROWN, 9.0)]).timed(SMILE, late));
    assert_eq!((player.target(SMILE), player.target(FROWN)), (Some(0.7), Some(1.0)), "waiting; clamped");
    for _ in 0..30 {
        player.advance(0.02).unwrap();
        assert_eq!((player.target(SMILE), player.target(FROWN)), (Some(0.7), Some(1.0)));
    }
    player.press(&Pose::new("back", vec![(SMILE, 0.1)]));
    assert_eq!(player.target(SMILE), Some(0.1));
    player.advance(f64::INFINITY).unwrap();
    assert!(player.targets().eq(player.values().iter().copied()), "arrived");
    assert_eq!(player.target(99), None);
}

#[test]
fn a_control_that_a_clip_moves_heads_for_where_it_is() {
    let mut player = Player::new(&ControlTable::default_face());
    player.play(&clip(Wrap::Loop), Some(0.0));
    for _ in 0..200 {
        player.advance(0.03).unwrap();
        assert_eq!(player.target(SMILE), Some(player.values()[SMILE]));
    }
}

#[test]
fn a_clip_stands_where_the_time_since_its_start_leads() {
    for (wrap, period_secs) in [(Wrap::Once, f64::INFINITY), (Wrap::Loop, 2.0), (Wrap::PingPong, 4.0)] {
        let (clip, mut player) = (clip(wrap), Player::new(&ControlTable::default_face()));
        assert_eq!(player.clip_time_secs(&clip), None, "not played yet");
        player.play(&clip, None);
        for step in 1..=100 {
            player.advance(0.07).unwrap();
            let secs = 0.07 * f64::from(step);
            match player.clip_time_secs(&clip) {
                Some(found) => {
                    let off = (found - secs).rem_euclid(period_secs.min(1e9));
                    assert!(off < 1e-9 || period_secs - off < 1e-9, "{wrap:?}: {found} after {secs}");
                    assert!(wrap != Wrap::Once || secs < 2.0);
                }
                None => assert!(wrap == Wrap::Once && secs >= 2.0, "{wrap:?}: none after {secs}"),
            }
        }
    }
    let (looping, other, mut player) =
        (clip(Wrap::Loop), clip(Wrap::Loop), Player::new(&ControlTable::default_face()));
    player.play(&looping, None);
    assert_eq!(player.clip_time_secs(&other), None, "an equal clip that is not the same");
    player.press(&Pose::new("away", vec![(SMILE, 0.5)]));
    assert_eq!(player.clip_time_secs(&looping), None, "all of its controls are pressed elsewhere");
}

#[test]
fn layers_show_a_jump_of_their_base_at_once() {
    let controls = ControlTable::default_face();
    let (mut layers, mut values) = (Layers::new(&controls), controls.defaults());
    values[SMILE] = 0.6;
    layers.jump_to(&values).unwrap();
    assert_eq!(layers.values(), values);
    assert!(layers.base_ref().targets().eq(values));
    layers.jump_to(&[0.0]).expect_err("too few");
}
