//! What a player promises, whatever is pressed at any moment.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{AdvanceError, Clip, ControlTable, Easing, Jet, JumpError, Player, Pose, PoseSet, Timing};
use pose_anim::{Key, Track, Transition, Wrap};
use proptest::prelude::*;
use std::sync::Arc;

/// A few controls with default paces and ranges, so that scripts are many rather than wide.
fn table() -> ControlTable {
    let text = "
        [[control]]\nname = 'turn'\njoint = 'HeadJoint'\naxis = '+x'\nmin = -70\nmax = 70
        [[control]]\nname = 'lid'\njoint = 'LtUpperLidJoint'\naxis = '-z'\nmin = -10\nmax = 45
        [[control]]\nname = 'smile'\nshape = 'S'";
    ControlTable::from_toml(text).unwrap()
}

#[test]
fn time_steps_that_are_none() {
    let table = table();
    let mut player = Player::new(&table);
    player.press(&Pose::new("p", vec![(0, 10.0)]));
    player.advance(0.1).unwrap();
    let before = player.values().to_vec();
    assert_eq!(player.advance(-0.1), Err(AdvanceError::Negative { dt_secs: -0.1 }));
    assert_eq!(player.advance(f64::NAN), Err(AdvanceError::NotANumber));
    assert_eq!(player.values(), before);
    player.advance(1e300).unwrap();
    assert!(player.is_at_rest());
    assert_eq!(player.values(), [10.0, 0.0, 0.0]);
    assert_eq!(player.secs_to_rest(), 0.0);
}

#[test]
fn poses_from_elsewhere_cannot_harm() {
    let table = table();
    let mut player = Player::new(&table);
    for (value, duration) in
        [(f32::NAN, 1.0), (f32::INFINITY, 0.0), (1e38, -3.0), (-5.0, f64::NAN), (9.0, 1e300)]
    {
        let mut pose = Pose::new("p", vec![(99, 1.0), (0, value), (2, value)]);
        pose.duration_secs = Some(duration);
        player.press(&pose);
        player.advance(0.01).unwrap();
        assert!((-70.0..=70.0).contains(&player.values()[0]) && (0.0..=1.0).contains(&player.values()[2]));
        assert!(player.velocities().iter().chain(player.accelerations()).all(|rate| rate.is_finite()));
    }
    assert!(player.state(3).is_none());
}

/// Numbers that only a program can put into a pose, in every combination, at rest and while moving, clamped
/// and not.
#[test]
fn poses_of_bad_numbers_give_good_ones() {
    let table = table();
    let numbers = [f64::NAN, 0.0, -1.0, f64::INFINITY, f64::NEG_INFINITY];
    let mut transitions = vec![None, Some(Easing::Bezier([0.0, 1000.0, 1.0, -1000.0]))];
    for bad in [f64::NAN, 1e300, -1e300, f64::INFINITY] {
        transitions
            .extend([[bad; 4], [0.3, bad, 0.4, 1.0], [bad, 0.0, 0.4, 1.0]].map(Easing::Bezier).map(Some));
    }
    for (delay_secs, factor) in numbers.iter().flat_map(|a| numbers.map(|b| (*a, b))) {
        let mut players = [Player::new(&table), Player::new(&table).with_overshoot()];
        for transition in &transitions {
            let mut pose = Pose::new("p", vec![(0, 40.0), (2, 0.5)]).timed(0, Timing { delay_secs, factor });
            pose.transition = *transition;
            for player in &mut players {
                player.press(&pose);
                for dt in [0.0, 1e-9, 0.01, 0.05] {
                    player.advance(dt).unwrap();
                    for control in 0..3 {
                        let state = player.state(control).unwrap();
                        let parts = [state.value, state.velocity, state.acceleration];
                        assert!(parts.iter().all(|part| part.is_finite()), "{pose:?}: {state:?}");
                    }
                    let rates = player.velocities().iter().chain(player.accelerations());
                    assert!(rates.chain(player.values()).all(|number| number.is_finite()), "{pose:?}");
                }
            }
        }
        for player in &mut players {
            player.advance(1e9).unwrap();
            assert_eq!((player.values()[0], player.values()[2]), (40.0, 0.5));
        }
    }
    // An unsound transition is ignored: the move has the least jerk.
    let mut player = Player::new(&table);
    player.press(&Pose::new("p", vec![(2, 1.0)]).lasting(1.0).along(Easing::Bezier([f64::NAN; 4])));
    player.advance(0.25).unwrap();
    assert!((player.state(2).unwrap().value - Jet::step(0.25, 1.0).value).abs() < 1e-12);
}

#[test]
fn a_move_that_waits_lets_the_running_one_go_on() {
    let table = table();
    let first = Pose::new("p", vec![(0, 60.0)]).lasting(0.5);
    let late = Pose::new("q", vec![(0, -20.0), (2, 1.0)])
        .lasting(0.2)
        .timed(0, Timing { delay_secs: 0.15, factor: 2.0 });
    let (mut player, mut undisturbed) = (Player::new(&table), Player::new(&table));
    for player in [&mut player, &mut undisturbed] {
        player.press(&first);
        player.advance(0.1).unwrap();
    }
    player.press(&late);
    for _ in 0..14 {
        player.advance(0.01).unwrap();
        undisturbed.advance(0.01).unwrap();
        assert_eq!(player.values()[0], undisturbed.values()[0]);
    }
    assert!(player.values()[2] > 0.5 && !player.is_at_rest());
    assert!((player.secs_to_rest() - 0.41).abs() < 1e-6);
    player.advance(0.41 + 1e-6).unwrap();
    assert!(player.is_at_rest());
    assert_eq!(player.values(), [-20.0, 0.0, 1.0]);
    // A control that waits at rest is not at rest, and another press drops what waits.
    player.press(&late.clone().timed(2, Timing { delay_secs: 0.1, factor: 1.0 }));
    assert!(!player.is_at_rest());
    player.press(&Pose::new("r", vec![(0, 5.0), (2, 0.5)]));
    player.advance(f64::INFINITY).unwrap();
    assert_eq!(player.values(), [5.0, 0.0, 0.5]);
}

#[test]
fn transitions_run_as_named_between_their_ends() {
    let table = table();
    for (name, at, expected) in [("linear", 0.5, 0.5), ("quad-in", 0.5, 0.25), ("back-out", 0.6, 1.087_697_2)]
    {
        let mut player = Player::new(&table).with_overshoot();
        player.press(&Pose::new("p", vec![(2, 1.0)]).lasting(1.0).along(Easing::from_name(name).unwrap()));
        player.advance(at).unwrap();
        let expected =
            if name == "back-out" { Easing::from_name(name).unwrap().at(at).value as f32 } else { expected };
        assert!((player.values()[2] - expected).abs() < 1e-6, "{name}: {}", player.values()[2]);
        let mut confined = Player::new(&table);
        confined.press(&Pose::new("p", vec![(2, 1.0)]).lasting(1.0).along(Easing::from_name(name).unwrap()));
        confined.advance(at).unwrap();
        assert_eq!(confined.values()[2], expected.min(1.0));
        player.advance(1.0).unwrap();
        assert_eq!((player.values()[2], player.velocities()[2]), (1.0, 0.0));
    }
}

#[test]
fn mixtures() {
    let table = ControlTable::default_face();
    let poses = PoseSet::default_face(&table);
    let smile = poses.get("smile").unwrap();
    assert_eq!(&poses.mix("smile", &table).unwrap(), smile);
    let half = poses.mix("smile:0.5", &table).unwrap();
    for (control, value) in &half.values {
        assert_eq!(*value, 0.5 * smile.value(*control).unwrap());
    }
    let both = poses.mix(" smile:0.5, frown ", &table).unwrap();
    let bow = table.index("head.bow").unwrap();
    assert_eq!(both.value(bow), Some(-1.0 + 6.0));
    assert_eq!(both.value(table.index("frown").unwrap()), Some(0.85));
    let much = poses.mix("yawn:3", &table).unwrap();
    assert_eq!(much.value(table.index("jaw.open").unwrap()), Some(20.0));
    let errors = [
        ("smlie", r#"expected the name of a pose, found "smlie"; did you mean "smile"?"#),
        ("smile:much", r#"pose "smile": expected a finite number as weight, found "much""#),
        ("smile:nan", r#"pose "smile": expected a finite number as weight, found "nan""#),
        (" ", r#"expected poses such as "smile" or "smile:0.5 wink-left", found none"#),
    ];
    for (text, expected) in errors {
        assert_eq!(poses.mix(text, &table).unwrap_err().to_string(), expected);
    }
}

#[test]
fn mixtures_keep_to_ranges_and_to_poses_that_name_the_control() {
    let table = table();
    let timing = |delay_secs| Timing { delay_secs, factor: 2.0 };
    // A timing without a value: the pose does not move this control.
    let silent = Pose::new("a", vec![(2, 0.5)]).timed(0, timing(0.1));
    // Two timings: the last one holds, as when the pose is pressed alone.
    let spoken = Pose::new("b", vec![(0, 500.0)]).timed(0, timing(0.2)).timed(0, timing(0.3));
    let later = Pose::new("c", vec![(0, f32::NAN), (1, 5.0)]).timed(0, timing(0.4));
    let mixed = Pose::mixed("m", &[(&later, 1.0), (&silent, 1.0), (&spoken, 1.0)], &table);
    assert_eq!(mixed.timing(0), spoken.timing(0));
    assert_eq!(mixed.timing(0).delay_secs, 0.3);
    assert_eq!(mixed.values, [(0, 70.0), (1, 5.0), (2, 0.5)]);
    assert_eq!(mixed.timings.len(), 1);
}

#[test]
fn clips_start_run_and_end() {
    let table = table();
    let keys = |values: [f64; 3]| {
        let times = [0.0, 0.5, 1.0].into_iter().zip(values);
        times.map(|(time, value)| Key::new(time, value, Easing::MinimumJerk)).collect()
    };
    let tracks =
        vec![Track::new(0, keys([0.0, 40.0, 10.0])).unwrap(), Track::new(2, keys([0.5, 1.0, 0.0])).unwrap()];
    let once = Arc::new(Clip::new("c", tracks).unwrap());
    let mut player = Player::new(&table);
    player.press(&Pose::new("p", vec![(1, 30.0), (2, 1.0)]).lasting(2.0));
    player.play(&once, Some(0.25));
    player.advance(0.3).unwrap();
    // What the clip has no track for goes on; the rest is the clip's.
    assert!(player.values()[1] > 0.0);
    for control in [0, 2] {
        assert_eq!(player.state(control), once.at(control, 0.3));
    }
    player.advance(0.8).unwrap();
    assert_eq!((player.values()[0], player.values()[2]), (10.0, 0.0));
    assert!(!player.is_at_rest());
    player.advance(1.0).unwrap();
    assert!(player.is_at_rest());

    // A clip that repeats never rests, until it is stopped.
    let repeated = Arc::new(Clip::clone(&once).wrapped(Wrap::PingPong));
    player.play(&repeated, None);
    player.advance(77.3).unwrap();
    assert_eq!(player.state(0), repeated.at(0, 77.3));
    assert_eq!(player.secs_to_rest(), f64::INFINITY);
    player.stop();
    player.advance(0.9).unwrap();
    assert!(player.is_at_rest());

    // One that ends at speed comes to rest smoothly and in range.
    let transition = Transition::Hermite { leaving: 0.0, arriving: 3.0 };
    let keys = vec![Key { time_secs: 0.0, value: 0.0, transition }, Key::new(1.0, 0.95, Easing::Linear)];
    let fast = Arc::new(Clip::new("c", vec![Track::new(2, keys).unwrap()]).unwrap());
    player.play(&fast, Some(0.1));
    player.advance(1.0 - 1e-7).unwrap();
    let before = player.state(2).unwrap();
    player.advance(2e-7).unwrap();
    let after = player.state(2).unwrap();
    assert!((before.velocity - 3.0).abs() < 1e-5 && (after.velocity - before.velocity).abs() < 1e-4);
    while !player.is_at_rest() {
        player.advance(0.001).unwrap();
        assert!((0.0..=1.0).contains(&player.values()[2]));
    }
    // At speed into the very end of the range: no smooth way on exists, so the value is held.
    let keys = vec![Key { time_secs: 0.0, value: 0.0, transition }, Key::new(1.0, 1.0, Easing::Linear)];
    player.play(&Arc::new(Clip::new("c", vec![Track::new(2, keys).unwrap()]).unwrap()), Some(0.1));
    player.advance(1.0 + 1e-6).unwrap();
    assert_eq!(player.values()[2], 1.0);
    player.advance(1e-3).unwrap();
    assert_eq!(player.values()[2], 1.0);
    // A clip for other controls, or one without length.
    let strange =
        vec![Track::from_samples(99, [(0.0, 1.0)]).unwrap(), Track::from_samples(2, [(0.0, 0.25)]).unwrap()];
    player.play(&Arc::new(Clip::new("c", strange).unwrap().wrapped(Wrap::Loop)), None);
    player.advance(1.0).unwrap();
    assert!(player.is_at_rest() && player.values()[2] == 0.25);
}

#[test]
fn jumps() {
    let table = table();
    let mut player = Player::new(&table);
    player.press(&Pose::new("p", vec![(0, 10.0)]));
    player.advance(0.1).unwrap();
    assert_eq!(player.jump_to(&[1.0]), Err(JumpError::Length { expected: 3, found: 1 }));
    assert!(matches!(player.jump_to(&[1.0, f32::NAN, 0.0]), Err(JumpError::NotFinite { control: 1, .. })));
    player.jump_to(&[-5.0, 100.0, 0.5]).unwrap();
    assert_eq!(player.values(), [-5.0, 45.0, 0.5]);
    assert!(player.is_at_rest());
    player.advance(1.0).unwrap();
    assert_eq!(player.values(), [-5.0, 45.0, 0.5]);
}

#[test]
fn default_poses_take_their_time() {
    let table = ControlTable::default_face();
    let poses = PoseSet::default_face(&table);
    for pose in &poses {
        // The motion itself, in steps of a millisecond: from the press to the last look at which it moves or
        // arrives.
        let mut player = Player::new(&table);
        player.press(pose);
        let (mut last_moved, mut moved) = (vec![0; table.len()], vec![false; table.len()]);
        for tick in 1..=1000 {
            let before = player.values().to_vec();
            player.advance(0.001).unwrap();
            for control in 0..table.len() {
                let moves = player.values()[control] != before[control]
                    || player.velocities()[control] != 0.0
                    || player.accelerations()[control] != 0.0;
                if moves {
                    (last_moved[control], moved[control]) = (tick, true);
                }
            }
        }
        assert!(player.is_at_rest());
        for (index, control) in table.controls().iter().enumerate() {
            let range = match &control.name {
                name if name.starts_with("lid") => 100..=150,
                name if name.starts_with("eye") => 60..=200,
                name if name.starts_with("head") => 400..=900,
                name if name.starts_with("jaw") => 180..=400,
                _ => 200..=400,
            };
            let ms: i32 = last_moved[index];
            assert!(!moved[index] || range.contains(&ms), "{}, {}: {ms} ms", pose.name, control.name);
            assert_eq!(moved[index], pose.value(index) != Some(control.default));
        }
    }
    // A partial pose on top of another: the smile goes on.
    let mut player = Player::new(&table);
    player.press(poses.get("smile").unwrap());
    player.advance(0.05).unwrap();
    let lid = table.index("lid.left.upper").unwrap();
    player.press(&Pose::new("wink", vec![(lid, 45.0)]));
    player.advance(2.0).unwrap();
    let expected = poses.get("smile").unwrap();
    for (index, value) in player.values().iter().enumerate() {
        assert_eq!(*value, if index == lid { 45.0 } else { expected.value(index).unwrap() });
    }
}

/// A jump ends everything that moves, and so it lets go of the clips that moved it.
#[test]
fn a_jump_lets_go_of_clips() {
    let table = table();
    let keys = vec![Key::new(0.0, 0.2, Easing::MinimumJerk), Key::new(1.0, 0.7, Easing::MinimumJerk)];
    let clip = Arc::new(Clip::new("c", vec![Track::new(2, keys).unwrap()]).unwrap());
    let mut player = Player::new(&table);
    // Once as what runs, once as what fades out.
    player.play(&clip, Some(0.1));
    player.advance(0.2).unwrap();
    player.play(&clip, Some(0.1));
    assert_eq!(Arc::strong_count(&clip), 3);
    player.jump_to(&[0.0, 0.0, 0.5]).unwrap();
    assert_eq!(Arc::strong_count(&clip), 1);
    // And so does a press to where a clip without duration rests already.
    let still = Arc::new(
        Clip::new("c", vec![Track::new(2, vec![Key::new(0.0, 0.5, Easing::Linear)]).unwrap()]).unwrap(),
    );
    player.play(&still, Some(0.001));
    player.advance(0.001).unwrap();
    player.press(&Pose::new("p", vec![(2, 0.5)]));
    assert_eq!(Arc::strong_count(&still), 1);
}

proptest! {
    /// From rest, a move is the textbook minimum-jerk move, monotone.
    #[test]
    fn from_rest_it_is_minimum_jerk(from in -70.0f32..70.0, to in -70.0f32..70.0, secs in 0.01f64..5.0, s in 0.0f64..1.0) {
        let table = table();
        let mut player = Player::new(&table);
        player.jump_to(&[from, 0.0, 0.0]).unwrap();
        player.press(&Pose::new("p", vec![(0, to)]).lasting(secs));
        player.advance(s * secs).unwrap();
        let expected = f64::from(from) + f64::from(to - from) * (10.0 * s.powi(3) - 15.0 * s.powi(4) + 6.0 * s.powi(5));
        prop_assert!((player.state(0).unwrap().value - expected).abs() < 1e-4);
    }
}
