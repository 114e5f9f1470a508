//! A performer does what the player, the couplings and the gaze do by hand, and tells of names that it does
//! not know.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod common;

use avatar_stage::avatar_pack::FaceState;
use avatar_stage::glam::{Affine3A, Vec3};
use avatar_stage::pose_anim::{Clip, Easing, Key, LayerMode, Player, Pose, Track, Wrap, face};
use avatar_stage::{Performer, PerformerError};
use common::pack;
use std::sync::Arc;

const FRAME_SECS: f64 = 1.0 / 60.0;

fn control(name: &str) -> usize {
    pack().controls().index(name).unwrap()
}

#[test]
fn it_is_a_player_and_a_face_state_to_the_bit() {
    let (mut performer, mut player) = (Performer::new(pack().clone()), Player::new(pack().controls()));
    let mut state = FaceState::new(pack());
    for (step, name) in ["smile", "wink-left", "yawn", "smile:0.5 frown:0.25"].into_iter().enumerate() {
        performer.press(name).unwrap();
        let pose = pack().poses().get(name).cloned();
        let pose = pose.unwrap_or_else(|| pack().poses().mix(name, pack().controls()).unwrap());
        player.press(&pose);
        assert!(performer.targets().eq(player.targets()), "{name}");
        for _ in 0..7 * (step + 1) {
            performer.advance(FRAME_SECS).unwrap();
            player.advance(FRAME_SECS).unwrap();
            state.pose(pack(), player.values()).unwrap();
            assert_eq!(performer.values(), player.values());
            assert_eq!((performer.bones(), performer.weights()), (state.bones(), state.weights()));
        }
    }
    // A pose is where it says, after any time that is long enough.
    performer.press("surprise").unwrap();
    performer.advance(f64::INFINITY).unwrap();
    assert!(performer.is_at_rest());
    for (control, value) in &pack().poses().get("surprise").unwrap().values {
        assert_eq!(performer.values()[*control], *value);
    }
}

#[test]
fn it_begins_at_the_defaults_and_jumps_to_any_face() {
    let mut performer = Performer::new(pack().clone());
    let mut state = FaceState::new(pack());
    state.pose(pack(), &pack().controls().defaults()).unwrap();
    assert_eq!((performer.bones(), performer.weights()), (state.bones(), state.weights()));

    let mut values = pack().controls().defaults();
    values[control(face::JAW_OPEN)] = 12.0;
    performer.jump_to(&values).unwrap();
    state.pose(pack(), &values).unwrap();
    assert_eq!((performer.values(), performer.bones()), (&values[..], state.bones()), "at once");
    assert!(performer.is_at_rest() && performer.targets().eq(values.iter().copied()));

    values[0] = f32::NAN;
    let before = performer.bones().to_vec();
    assert!(matches!(performer.jump_to(&values), Err(PerformerError::Jump(_))));
    assert!(matches!(performer.jump_to(&[1.0]), Err(PerformerError::Jump(_))));
    assert!(matches!(performer.advance(-1.0), Err(PerformerError::Advance(_))));
    assert!(matches!(performer.advance(f64::NAN), Err(PerformerError::Advance(_))));
    assert_eq!(performer.bones(), before, "errors change nothing");
}

#[test]
fn a_single_control_goes_where_it_is_set_and_no_other_moves() {
    let mut performer = Performer::new(pack().clone());
    performer.set(face::JAW_OPEN, 11.0).unwrap();
    performer.set_control(control(face::SMILE), 9.0);
    performer.set_control(9_999, 1.0);
    performer.set_control(control(face::SMILE), f32::NAN);
    let mut expected = pack().controls().defaults();
    (expected[control(face::JAW_OPEN)], expected[control(face::SMILE)]) = (11.0, 1.0);
    assert!(performer.targets().eq(expected.iter().copied()), "clamped to its range");
    performer.advance(0.01).unwrap();
    assert!((0.001..10.0).contains(&performer.values()[control(face::JAW_OPEN)]), "no jump");
    performer.advance(1.0).unwrap();
    assert_eq!(performer.values(), expected);
}

#[test]
fn names_that_there_are_not_are_errors_with_the_name_that_is_meant() {
    let mut performer = Performer::new(pack().clone());
    let told = |error: PerformerError| error.to_string();
    assert_eq!(
        told(performer.press("simle").unwrap_err()),
        "expected the name of a pose, found \"simle\"; did you mean \"smile\"?"
    );
    assert_eq!(
        told(performer.set("jaw.opne", 1.0).unwrap_err()),
        "expected the name of a control, found \"jaw.opne\"; did you mean \"jaw.open\"?"
    );
    assert_eq!(told(performer.play("nod").unwrap_err()), "expected the name of a clip, found \"nod\"");
    assert!(matches!(performer.press(""), Err(PerformerError::Pose(_))));
    assert!(performer.is_at_rest() && performer.clip_time_secs().is_none());
}

fn nod(wrap: Wrap) -> Clip {
    let keys = [(0.0, 0.0), (1.0, 0.8), (2.0, 0.2)];
    let keys = keys.map(|(at, value)| Key::new(at, value, Easing::MinimumJerk)).to_vec();
    Clip::new("nod", vec![Track::new(control(face::SMILE), keys).unwrap()]).unwrap().wrapped(wrap)
}

#[test]
fn a_clip_plays_from_any_time_and_tells_where_it_stands() {
    for (wrap, period_secs) in [(Wrap::Once, f64::INFINITY), (Wrap::Loop, 2.0), (Wrap::PingPong, 4.0)] {
        for from_secs in [0.0, 0.5, 1.25] {
            let (clip, mut performer) = (nod(wrap), Performer::new(pack().clone()));
            performer.play_clip(&clip, from_secs).unwrap();
            let mut values = pack().controls().defaults();
            for step in 1..200 {
                performer.advance(0.05).unwrap();
                let secs = from_secs + 0.05 * f64::from(step);
                let Some(found) = performer.clip_time_secs() else {
                    assert!(
                        wrap == Wrap::Once && secs > 2.0 - 1e-9,
                        "{wrap:?} from {from_secs}: over at {secs}"
                    );
                    break;
                };
                let expected = if period_secs.is_finite() { secs % period_secs } else { secs };
                let off = (found - expected).abs();
                assert!(
                    off.min(period_secs - off) < 1e-9,
                    "{wrap:?} from {from_secs}: {found}, not {expected}"
                );
                // Once the face has been led into the clip it is the clip's.
                if step > 30 {
                    clip.sample(secs, &mut values);
                    let (is, to_be) =
                        (performer.values()[control(face::SMILE)], values[control(face::SMILE)]);
                    assert!(
                        (is - to_be).abs() < 1e-4,
                        "{wrap:?} from {from_secs} at {secs}: {is}, not {to_be}"
                    );
                }
            }
        }
    }
    let mut performer = Performer::new(pack().clone());
    performer.set_clips(avatar_stage::pose_anim::ClipSet { clips: vec![nod(Wrap::Loop)] }).unwrap();
    performer.play("nod").unwrap();
    performer.advance(0.3).unwrap();
    assert!(performer.clip_time_secs().is_some() && !performer.is_at_rest());
    performer.stop();
    assert_eq!(performer.clip_time_secs(), None);
    performer.advance(2.0).unwrap();
    assert!(performer.is_at_rest());
    assert!(matches!(performer.play_clip(&nod(Wrap::Loop), f64::NAN), Err(PerformerError::Clip(_))));
}

/// Where an eye looks: what looks along +Z at bind pose, by its joint's bone matrix.
fn sight(performer: &Performer, eye: &str) -> (Vec3, Vec3) {
    let joint = pack().rig().joint(eye).unwrap().index();
    let posed_from_bind: Affine3A = performer.state().rig_pose().posed_from_bind()[joint];
    let origin = pack().rig().world_from_bind()[joint].translation.into();
    (posed_from_bind.transform_point3(origin), posed_from_bind.transform_vector3(Vec3::Z))
}

#[test]
fn both_eyes_and_a_part_of_the_head_follow_a_point() {
    let mut performer = Performer::new(pack().clone());
    let size = pack().bounds().unwrap();
    let point = size.center() + size.size() * Vec3::new(0.3, 0.3, 2.5);
    let mut changes = 0;
    for _ in 0..120 {
        changes += u32::from(performer.look_at(point).unwrap());
        performer.advance(FRAME_SECS).unwrap();
    }
    for eye in ["LtEyeJoint", "RtEyeJoint"] {
        let (origin, direction) = sight(&performer, eye);
        let off = direction.angle_between(point - origin).to_degrees();
        assert!(off < 0.5, "{eye} is {off} degrees off");
    }
    assert!(performer.values()[control(face::HEAD_TURN)].abs() > 1.0, "the head turns, too");
    assert!((1..110).contains(&changes), "who looks there already is left alone: {changes}");

    performer.look_ahead();
    performer.advance(5.0).unwrap();
    assert_eq!(performer.values(), pack().controls().defaults());
    assert!(!performer.look_at(Vec3::NAN).unwrap());
    assert!(performer.is_at_rest());
}

#[test]
fn a_layer_goes_over_the_poses() {
    let mut performer = Performer::new(pack().clone());
    let mut mask = vec![0.0; pack().controls().len()];
    mask[control(face::JAW_OPEN)] = 1.0;
    let speech = performer.layers().add(pack().controls(), LayerMode::Override, &mask);
    performer.layers().fade_to(speech, 1.0, 0.1);
    let open = Pose::new("a", vec![(control(face::JAW_OPEN), 10.0)]);
    performer.layers().layer(speech).unwrap().press(&open);
    performer.press("smile").unwrap();
    performer.advance(5.0).unwrap();
    assert_eq!(performer.values()[control(face::JAW_OPEN)], 10.0);
    let bend = pack().poses().get("smile").unwrap().value(control(face::HEAD_BEND)).unwrap();
    assert!(bend != 0.0 && performer.values()[control(face::HEAD_BEND)] == bend);
}

#[test]
fn faces_share_a_pack_until_one_changes_it() {
    let shared = Arc::new(pack().clone());
    let (one, mut other) = (Performer::new(Arc::clone(&shared)), Performer::new(Arc::clone(&shared)));
    assert!(Arc::ptr_eq(one.pack(), other.pack()));
    other.set_poses(Default::default()).unwrap();
    assert!(Arc::ptr_eq(one.pack(), &shared) && !one.pack().poses().poses.is_empty());
    assert!(other.pack().poses().poses.is_empty());
    other.set_hair(Some(Default::default()));
    assert!(other.pack().hair().is_some());
}
