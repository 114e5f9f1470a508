//! What swings by itself follows a performer, the same at every frame rate.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use avatar_stage::Performer;
use avatar_stage::avatar_pack::joint_springs::{Law, Spring};
use avatar_stage::avatar_pack::{FaceState, Pack, Springs};
use avatar_stage::glam::Vec3;
use avatar_stage::pose_anim::{Clip, Easing, Key, Track, Wrap, face};
use common::pack;

const TAIL: Vec3 = Vec3::new(0.0, -3.0, 2.0);
const LAWS: [Law; 2] = [
    Law::Oscillator { frequency_hz: 1.8, damping_ratio: 0.2, gravity: Vec3::new(0.0, -40.0, 0.0) },
    Law::Vrm { stiffness: 12.0, drag: 0.3, gravity: Vec3::new(0.0, -4.0, 0.0) },
];

fn jaw() -> usize {
    pack().rig().joint("JawJoint").unwrap().index()
}

/// The default face, whose jaw swings.
fn loose(law: Law) -> Pack {
    let mut loose = pack().clone();
    loose
        .set_springs(Springs { springs: vec![Spring::new(jaw(), TAIL, law)], ..Springs::default() })
        .unwrap();
    loose
}

/// Where the jaw's end is in world space.
fn end(performer: &Performer) -> Vec3 {
    performer.state().rig_pose().world_from_joint()[jaw()].transform_point3(TAIL)
}

/// The end of the jaw that does not swing, in the same pose.
fn stiff(performer: &Performer) -> Vec3 {
    let mut state = FaceState::new(pack());
    state.pose(pack(), performer.values()).unwrap();
    state.rig_pose().world_from_joint()[jaw()].transform_point3(TAIL)
}

/// The head turns to one side and the other, a way within two thirds of a second.
fn shake() -> Clip {
    let turn = pack().controls().index(face::HEAD_TURN).unwrap();
    let keys = (0..6).map(|way| {
        let value = [0.0, 28.0, -28.0, 28.0, -28.0, 0.0][way];
        Key::new(way as f64 * 0.65, value, Easing::MinimumJerk)
    });
    let mut clip = Clip::new("shake".to_owned(), vec![Track::new(turn, keys.collect()).unwrap()]).unwrap();
    clip.wrap = Wrap::Once;
    clip
}

#[test]
fn a_jump_hangs_still_and_a_motion_swings_at_every_rate_alike() {
    for law in LAWS {
        let at = |rate: u32| {
            let mut performer = Performer::new(loose(law));
            let hanging = end(&performer);
            assert!((hanging - stiff(&performer)).length() > 0.02 * TAIL.length(), "{law:?} does not hang");
            assert!(!performer.swings());
            performer.play_clip(&shake(), 0.0).unwrap();
            let mut ends = Vec::new();
            let (mut swung, mut swings) = (0.0f32, false);
            for frame in 1..=4 * rate {
                performer.advance(1.0 / f64::from(rate)).unwrap();
                swung = swung.max((end(&performer) - stiff(&performer)).length());
                swings |= performer.swings();
                if frame % (rate / 12) == 0 {
                    ends.push(end(&performer));
                }
            }
            let own = (hanging - stiff(&performer)).length();
            assert!(
                swung > own + 0.05 * TAIL.length() && swings,
                "{law:?} swings by {swung}, hangs by {own}"
            );
            ends
        };
        let expected = at(60);
        for rate in [24, 144] {
            let worst = expected.iter().zip(at(rate)).map(|(a, b)| (*a - b).length()).fold(0.0, f32::max);
            // What the README of joint-springs says of such a motion.
            assert!(worst < 4.1e-3 * TAIL.length(), "{law:?} at {rate} Hz is {worst} off");
        }
    }
}

#[test]
fn a_jump_begins_anew() {
    let mut performer = Performer::new(loose(LAWS[1]));
    let start = end(&performer);
    performer.play_clip(&shake(), 0.0).unwrap();
    (0..40).for_each(|_| performer.advance(1.0 / 60.0).unwrap());
    assert!(performer.swings());
    let values = pack().controls().defaults();
    performer.jump_to(&values).unwrap();
    assert_eq!(end(&performer), start);
    assert!(!performer.swings());
    // Time passes, and nothing has changed: it hangs as it did.
    (0..40).for_each(|_| performer.advance(1.0 / 60.0).unwrap());
    assert!((end(&performer) - start).length() < 1e-3 * TAIL.length());
    // All time has passed: it hangs still, too.
    performer.press("yawn").unwrap();
    performer.advance(f64::INFINITY).unwrap();
    assert!(performer.is_at_rest() && !performer.swings());
}

#[test]
fn posing_again_is_not_time() {
    let mut performer = Performer::new(loose(LAWS[0]));
    performer.play_clip(&shake(), 0.0).unwrap();
    (0..40).for_each(|_| performer.advance(1.0 / 60.0).unwrap());
    let before = end(&performer);
    for _ in 0..3 {
        performer.pose_with(|pack, values, state| state.pose(pack, values)).unwrap();
        assert_eq!(end(&performer), before);
    }
    // Time that passes without posing counts at the next one.
    let mut other = performer.clone();
    performer.advance(1.0 / 60.0).unwrap();
    other.pass(1.0 / 60.0).unwrap();
    assert_eq!(end(&other), before);
    other.pose_with(|pack, values, state| state.pose(pack, values)).unwrap();
    assert_eq!(end(&other), end(&performer));
    assert!(end(&other) != before);
}

#[test]
fn what_swings_follows_a_face_that_is_driven() {
    let mut performer = Performer::new(loose(LAWS[0]));
    let turn = pack().controls().index(face::HEAD_TURN).unwrap();
    let mut values = pack().controls().defaults();
    let mut swung = 0.0f32;
    for frame in 0..60 {
        values[turn] = 28.0 * (frame as f32 * 0.15).sin();
        performer.pass(1.0 / 60.0).unwrap();
        performer.follow(&values).unwrap();
        performer.pose_with(|pack, values, state| state.pose(pack, values)).unwrap();
        assert_eq!(performer.values(), values);
        swung = swung.max((end(&performer) - stiff(&performer)).length());
    }
    let mut still = Performer::new(loose(LAWS[0]));
    still.jump_to(&values).unwrap();
    let hangs = (end(&still) - stiff(&still)).length();
    assert!(performer.swings() && swung > hangs + 0.05 * TAIL.length(), "{swung}, hangs by {hangs}");
}
