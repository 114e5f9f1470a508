//! A crowd of players against players one by one.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use lanes::{LANES, Lanes};
use pose_anim::{
    ApplyError, Clip, ControlTable, Easing, JumpError, Key, Player, PlayerCrowd, Pose, Timing, Track,
    UnknownFace, Wrap,
};
use proptest::prelude::*;
use std::sync::Arc;

/// More than one block, and not a whole number of them.
const FACES: usize = LANES + 5;

#[derive(Clone, Debug)]
enum Event {
    Press { shares: Vec<f32>, secs: Option<f64>, easing: Option<&'static str>, delay_secs: f64 },
    Play { fade_secs: Option<f64>, wrap: Wrap },
    Stop,
    Jump { share: f32 },
}

fn event() -> impl Strategy<Value = Event> {
    let shares = prop::collection::vec(prop_oneof![0f32..=1.0, Just(0.0), Just(1.0)], 1..15);
    let secs = prop::option::of(prop_oneof![0.001f64..0.1, 0.1f64..2.0]);
    let easing = prop_oneof![
        6 => Just(None),
        1 => prop::sample::select(vec!["linear", "back-out", "ease-in-out", "step"]).prop_map(Some)
    ];
    let delay_secs = prop_oneof![5 => Just(0.0), 1 => 0.0f64..0.3];
    let press = (shares, secs, easing, delay_secs)
        .prop_map(|(shares, secs, easing, delay_secs)| Event::Press { shares, secs, easing, delay_secs });
    let wrap = prop::sample::select(vec![Wrap::Once, Wrap::Loop, Wrap::PingPong]);
    let play =
        (prop::option::of(0.01f64..0.5), wrap).prop_map(|(fade_secs, wrap)| Event::Play { fade_secs, wrap });
    prop_oneof![
        10 => press,
        1 => play,
        1 => Just(Event::Stop),
        1 => (0f32..=1.0).prop_map(|share| Event::Jump { share }),
    ]
}

fn dt_secs() -> impl Strategy<Value = f64> {
    prop_oneof![3 => Just(0.0), 10 => 0.0005f64..0.05, 2 => 0.05f64..1.0, 1 => Just(100.0)]
}

fn at(table: &ControlTable, control: usize, share: f32) -> f32 {
    let control = &table.controls()[control];
    control.min + share * (control.max - control.min)
}

fn pose(table: &ControlTable, shares: &[f32], delay_secs: f64) -> Pose {
    let values = shares.iter().enumerate().map(|(control, share)| (control, at(table, control, *share)));
    let pose = Pose::new("p", values.collect());
    if delay_secs > 0.0 { pose.timed(0, Timing { delay_secs, factor: 1.5 }) } else { pose }
}

fn clip(table: &ControlTable, wrap: Wrap) -> Arc<Clip> {
    let track = |control| {
        let key =
            |secs: f64, share| Key::new(secs, f64::from(at(table, control, share)), Easing::MinimumJerk);
        Track::new(control, vec![key(0.0, 0.2), key(0.3, 0.7), key(0.5, 0.4)]).unwrap()
    };
    Arc::new(Clip::new("c", vec![track(1), track(13)]).unwrap().wrapped(wrap))
}

fn run(events: &[(usize, Event, f64)], overshoot: bool) -> Result<(), TestCaseError> {
    let table = ControlTable::default_face();
    let (mut crowd, mut players) = (PlayerCrowd::new(&table, FACES), vec![Player::new(&table); FACES]);
    if overshoot {
        crowd = crowd.with_overshoot();
        players = players.into_iter().map(Player::with_overshoot).collect();
    }
    for (face, event, dt_secs) in events {
        let player = &mut players[*face];
        let before: Vec<_> = (0..table.len()).map(|control| crowd.state(*face, control).unwrap()).collect();
        match event {
            Event::Press { shares, secs, easing, delay_secs } => {
                let mut pose = pose(&table, shares, *delay_secs);
                pose.duration_secs = *secs;
                pose.transition = easing.and_then(Easing::from_name);
                player.press(&pose);
                crowd.press(*face, &pose).unwrap();
            }
            Event::Play { fade_secs, wrap } => {
                let clip = clip(&table, *wrap);
                player.play(&clip, *fade_secs);
                crowd.play(*face, &clip, *fade_secs).unwrap();
            }
            Event::Stop => {
                player.stop();
                crowd.stop(*face).unwrap();
            }
            Event::Jump { share } => {
                let values: Vec<_> = (0..table.len()).map(|control| at(&table, control, *share)).collect();
                player.jump_to(&values).unwrap();
                crowd.jump_to(*face, &values).unwrap();
            }
        }
        // Nothing jumps at the moment of an interruption: value, velocity and acceleration go on.
        if !matches!(event, Event::Jump { .. }) {
            for (control, before) in before.iter().enumerate() {
                let after = crowd.state(*face, control).unwrap();
                // A polynomial of the shortest move (1 ms) over a range of 140 degrees is of the size of
                // 140 / 1 ms² = 1.4e8 in its accelerations, and rounding takes 1e-13 of that.
                let near = |a: f64, b: f64, slack: f64| (a - b).abs() <= slack * (1.0 + a.abs());
                // An excess of a range that a player hides rests at its end.
                let hidden = !overshoot && (before.is_rest() || after.is_rest());
                prop_assert!(near(before.value, after.value, 1e-12), "{before:?} {after:?}");
                prop_assert!(hidden || near(before.velocity, after.velocity, 1e-7), "{before:?} {after:?}");
                prop_assert!(
                    hidden || near(before.acceleration, after.acceleration, 2e-5),
                    "{before:?} {after:?}"
                );
            }
        }
        crowd.advance(*dt_secs).unwrap();
        Player::advance_all(&mut players, *dt_secs).unwrap();
        for (face, player) in players.iter().enumerate() {
            let mut values = vec![0.0; table.len()];
            crowd.copy_values(face, &mut values).unwrap();
            for (crowd, single) in values.iter().zip(player.values()) {
                // Mostly the same bits. The time before a delay is added up otherwise, which shows in the
                // last bit of 64, or of 32.
                let slack = 1e-11 + f64::from(f32::EPSILON * single.abs());
                prop_assert!(
                    (f64::from(*crowd) - f64::from(*single)).abs() <= slack,
                    "{crowd} {single}, {face}"
                );
            }
            prop_assert_eq!(crowd.is_at_rest(face), player.is_at_rest());
            let secs = (crowd.secs_to_rest(face), player.secs_to_rest());
            prop_assert!(secs.0 == secs.1 || (secs.0 - secs.1).abs() < 1e-9, "{:?}", secs);
            for control in 0..table.len() {
                let (a, b) = (crowd.state(face, control).unwrap(), player.state(control).unwrap());
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + a.abs());
                prop_assert!(near(a.value, b.value) && near(a.velocity, b.velocity), "{:?} {:?}", a, b);
                prop_assert!(near(a.acceleration, b.acceleration), "{:?} {:?}", a, b);
                prop_assert_eq!(crowd.target(face, control), player.target(control));
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// Thousands of random interruptions.
    #[test]
    fn every_face_moves_as_a_player_does(
        events in prop::collection::vec((0..FACES, event(), dt_secs()), 1..80), overshoot: bool,
    ) {
        run(&events, overshoot)?;
    }

    /// All of them for one face, so that fades lie inside fades.
    #[test]
    fn interruptions_of_one_face_add_up(
        events in prop::collection::vec((Just(17usize), event(), 0.0f64..0.05), 20..80),
    ) {
        run(&events, false)?;
    }
}

#[test]
fn time_may_be_endless_and_not_negative() {
    let table = ControlTable::default_face();
    let mut crowd = PlayerCrowd::new(&table, 3);
    crowd.press(1, &pose(&table, &[1.0; 15], 0.0)).unwrap();
    assert!(crowd.advance(-1.0).is_err() && crowd.advance(f64::NAN).is_err());
    crowd.advance(0.01).unwrap();
    crowd.advance(0.01).unwrap();
    assert!(!crowd.is_at_rest(1) && crowd.is_at_rest(0));
    crowd.advance(f64::INFINITY).unwrap();
    let mut values = [0.0; 15];
    crowd.copy_values(1, &mut values).unwrap();
    assert!(values.iter().zip(table.controls()).all(|(value, control)| *value == control.max));
    assert!(crowd.is_at_rest(1));
}

#[test]
fn a_face_that_is_missing_is_an_error() {
    let table = ControlTable::default_face();
    let mut crowd = PlayerCrowd::new(&table, 2);
    let pose = Pose::new("p", vec![(0, 1.0), (99, 1.0), (1, f32::NAN)]);
    let error = crowd.press(2, &pose).unwrap_err();
    assert!(matches!(error, UnknownFace { face: 2, faces: 2, .. }));
    assert_eq!(error.to_string(), "expected a face below 2, the number of faces in the crowd, found 2");
    assert!(crowd.stop(2).is_err() && crowd.copy_values(2, &mut []).is_err());
    assert_eq!(crowd.jump_to(2, &[0.0; 15]), Err(JumpError::Face(error)));
    assert!(matches!(crowd.jump_to(0, &[0.0; 3]), Err(JumpError::Length { expected: 15, found: 3 })));
    assert!(matches!(crowd.jump_to(0, &[f32::NAN; 15]), Err(JumpError::NotFinite { control: 0, .. })));
    assert_eq!((crowd.state(2, 0), crowd.state(0, 15), crowd.target(2, 0)), (None, None, None));
    // What does not exist in a pose is ignored, as by a player.
    crowd.press(1, &pose).unwrap();
    crowd.advance(10.0).unwrap();
    assert_eq!((crowd.target(1, 0), crowd.target(1, 1)), (Some(1.0), Some(0.0)));
    let mut empty = PlayerCrowd::new(&table, 0);
    assert!(empty.is_empty() && empty.advance(1.0).is_ok() && empty.values().is_empty());
}

mod binding {
    use super::*;
    use glam::{Mat4, Quat, Vec3};
    use rig_core::{RawJoint, RawRig, Rig, RigCrowd};

    /// Controls of one joint after each other: rotations about axes of the frame and others, translations
    /// before and after them, shapes, couplings with one-sided ranges.
    const TABLE: &str = r#"
        control = [
            { name = "a", joint = "Child", axis = "+x", min = -90, max = 90 },
            { name = "b", joint = "Child", axis = [0.6, 0.0, -0.8], min = -90, max = 90 },
            { name = "c", joint = "Child", axis = "-y", kind = "translation", min = -1, max = 1 },
            { name = "d", joint = "Child", axis = "+z", min = 0, max = 90 },
            { name = "e", joint = "Root", axis = "+z", kind = "translation", min = -1, max = 1 },
            { name = "f", shape = "S", min = 0, max = 1 },
        ]
        coupling = [
            { from = "a", to = "d", factor = 0.5 },
            { from = "b", to = "d", factor = -0.25 },
            { from = "e", to = "f", factor = 1 },
        ]
    "#;

    fn rig() -> Rig {
        let bind =
            |angle: f32, place: Vec3| Mat4::from_rotation_translation(Quat::from_rotation_y(angle), place);
        let mut raw = RawRig::default();
        raw.joints.push(RawJoint::new("Root", None, bind(0.3, Vec3::new(0.1, 0.9, -0.2))));
        raw.joints.push(RawJoint::new("Child", Some("Root"), bind(-1.1, Vec3::new(0.3, 0.2, 0.1))));
        Rig::from_raw(&raw).unwrap()
    }

    fn compare(values: &[[f32; 6]], tolerance: f32) -> Result<(), TestCaseError> {
        let table = ControlTable::from_toml(TABLE).unwrap();
        let rig = rig();
        let binding = table.bind(&rig, &["S"]).unwrap();
        let mut rigs = RigCrowd::new(&rig, values.len());
        let mut wide = vec![Lanes::splat(0.0); 6 * rigs.blocks()];
        for (face, values) in values.iter().enumerate() {
            for (control, value) in values.iter().enumerate() {
                wide[face / LANES * 6 + control][face % LANES] = *value;
            }
        }
        let (mut effective, mut weights) = (wide.clone(), vec![Lanes::splat(0.0); rigs.blocks()]);
        binding.couple_crowd(&wide, &mut effective);
        binding.apply_crowd(&effective, &mut rigs, &mut weights).unwrap();
        rigs.update();
        for (face, values) in values.iter().enumerate() {
            let (mut single, mut locals, mut weight) = (values.to_vec(), rig.locals(), [0.0]);
            let mut pose = rig.pose();
            binding.couple(values, &mut single);
            binding.apply(&single, &mut locals, &mut weight).unwrap();
            rig.update(locals.as_slice(), &mut pose).unwrap();
            let (block, lane) = (face / LANES, face % LANES);
            for (control, value) in single.iter().enumerate() {
                prop_assert_eq!(effective[block * 6 + control][lane], *value);
            }
            prop_assert_eq!(weights[block][lane], weight[0]);
            for joint in rig.joints() {
                let (x, t) = (pose.posed_from_bind()[joint.index()], pose.world_from_joint()[joint.index()]);
                let (wide_x, wide_t) =
                    (rigs.posed_from_bind(face, joint).unwrap(), rigs.world_from_joint(face, joint).unwrap());
                for (one, wide) in [(x, wide_x), (t, wide_t)] {
                    // Of the size of the numbers: a matrix and a place some way from the origin.
                    let near = tolerance * one.translation.length().max(1.0);
                    prop_assert!(one.abs_diff_eq(wide, near), "{values:?}: {one:?} {wide:?}");
                }
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn couplings_and_bones_are_those_of_single_faces(
            values in prop::collection::vec(
                [-90f32..=90.0, -90f32..=90.0, -1f32..=1.0, 0f32..=90.0, -1f32..=1.0, 0f32..=1.0], 1..40),
        ) {
            compare(&values, 1e-6)?;
        }

        /// Ranges do not bind here.
        #[test]
        fn angles_go_far_around(
            values in prop::collection::vec(
                [-9e5f32..=9e5, -2000f32..=2000.0, -1f32..=1.0, -9e5f32..=9e5, -1f32..=1.0, 0f32..=1.0], 1..4),
        ) {
            compare(&values, 1e-6)?;
        }

        #[test]
        fn angles_go_very_far_around(
            values in prop::collection::vec(
                [-1e12f32..=1e12, -2000f32..=2000.0, -1f32..=1.0, -1e9f32..=1e9, -1f32..=1.0, 0f32..=1.0], 1..4),
        ) {
            compare(&values, 1e-6)?;
        }
    }

    #[test]
    fn wrong_lengths_and_values_are_errors() {
        let table = ControlTable::from_toml(TABLE).unwrap();
        let rig = rig();
        let binding = table.bind(&rig, &["S"]).unwrap();
        let mut rigs = RigCrowd::new(&rig, 20);
        let (mut values, mut weights) = (vec![Lanes::splat(0.0); 12], vec![Lanes::splat(0.5); 2]);
        assert!(matches!(
            binding.apply_crowd(&values[1..], &mut rigs, &mut weights),
            Err(ApplyError::Length { what: "blocks of control values", expected: 12, found: 11 })
        ));
        assert!(matches!(
            binding.apply_crowd(&values, &mut rigs, &mut weights[1..]),
            Err(ApplyError::Length { what: "blocks of shape weights", expected: 2, found: 1 })
        ));
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            values[9][3] = bad;
            let error = binding.apply_crowd(&values, &mut rigs, &mut weights).unwrap_err();
            assert!(
                matches!(error, ApplyError::NotFinite { control: 3, value } if value.to_bits() == bad.to_bits())
            );
        }
        assert_eq!(weights, vec![Lanes::splat(0.5); 2]);
        // Through couplings, NaN is not hidden by the ends of the follower's range.
        values[9][3] = 0.0;
        values[0][7] = f32::NAN;
        let mut effective = values.clone();
        binding.couple_crowd(&values, &mut effective);
        assert!(effective[3][7].is_nan());
        // Large, and finite: its square is not.
        values[0][7] = 1e30;
        assert!(binding.apply_crowd(&values, &mut rigs, &mut weights).is_ok());
    }
}
