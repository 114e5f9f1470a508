//! What a player promises, whatever is pressed whenever.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{AdvanceError, Clip, ControlTable, Easing, Jet, JumpError, Player, Pose, PoseSet, Timing};
use pose_anim::{Key, Track, Transition, Wrap};
use proptest::prelude::*;
use std::sync::Arc;

/// SplitMix64 (Steele, Lea & Flood 2014): scripts have to be the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }
}

/// A few controls with default paces and ranges, so that scripts are many rather than wide.
fn table() -> ControlTable {
    let text = "
        [[control]]\nname = 'turn'\njoint = 'HeadJoint'\naxis = '+x'\nmin = -70\nmax = 70
        [[control]]\nname = 'lid'\njoint = 'LtUpperLidJoint'\naxis = '-z'\nmin = -10\nmax = 45
        [[control]]\nname = 'smile'\nshape = 'S'";
    ControlTable::from_toml(text).unwrap()
}

/// Transition functions without corners and overshoot.
const SMOOTH: [&str; 8] =
    ["minimum-jerk", "linear", "step", "quad-in", "cubic-out", "expo-out", "circ-in", "ease-in-out"];

/// What a script does.
#[derive(Clone, Debug)]
enum Action {
    Press(Pose),
    Play(Arc<Clip>, Option<f32>),
    Stop,
}

impl Action {
    fn act(&self, player: &mut Player) {
        match self {
            Self::Press(pose) => player.press(pose),
            Self::Play(clip, fade_secs) => player.play(clip, *fade_secs),
            Self::Stop => player.stop(),
        }
    }
}

/// A clip for some controls, twice continuously differentiable by itself. Some end at full speed.
fn clip(random: &mut Random, table: &ControlTable) -> Clip {
    let wrap = [Wrap::Once, Wrap::Loop, Wrap::PingPong][random.below(3)];
    let mut tracks = Vec::new();
    for (index, control) in table.controls().iter().enumerate() {
        let value = |random: &mut Random| {
            f64::from(control.min) + f64::from(control.max - control.min) * random.unit()
        };
        let start = value(random);
        let end_secs = 0.2 + random.unit();
        let keys = match (random.below(4), wrap) {
            (0, _) => continue,
            (1, Wrap::Once) => {
                // Monotone, so that it stays in range; it arrives with a slope.
                let end = value(random);
                let arriving = 1.5 * (end - start) / end_secs;
                let transition = Transition::Hermite { leaving: 0.3 * arriving, arriving };
                vec![
                    Key { time_secs: 0.0, value: start, transition },
                    Key::new(end_secs, end, Easing::Linear),
                ]
            }
            _ => {
                let key = |time_secs, value| Key::new(time_secs, value, Easing::MinimumJerk);
                let middle = key(0.3 * end_secs, value(random));
                vec![key(0.0, start), middle, key(0.8 * end_secs, value(random)), key(end_secs, start)]
            }
        };
        tracks.push(Track::new(index, keys).unwrap());
    }
    Clip::new("c", tracks).unwrap().wrapped(wrap)
}

/// A script: actions at times, sorted.
fn script(random: &mut Random, table: &ControlTable, transitions: &[Easing]) -> Vec<(f64, Action)> {
    let count = 1 + random.below(8);
    // Half of the scripts are hectic: all presses within a tenth of a second.
    let span = if random.below(2) == 0 { 0.1 } else { 1.2 };
    let mut times: Vec<f64> = (0..count).map(|_| random.unit() * span).collect();
    times.sort_by(f64::total_cmp);
    if random.below(4) == 0 && count > 1 {
        times[1] = times[0];
    }
    let mut presses = Vec::new();
    for at in times {
        match random.below(6) {
            0 => {
                let fade_secs = (random.below(2) == 0).then(|| 0.05 + random.unit() as f32);
                presses.push((at, Action::Play(Arc::new(clip(random, table)), fade_secs)));
                continue;
            }
            1 if random.below(3) == 0 => {
                presses.push((at, Action::Stop));
                continue;
            }
            _ => {}
        }
        let mut values = Vec::new();
        for (index, control) in table.controls().iter().enumerate() {
            let value = match random.below(5) {
                0 => control.min,
                1 => control.max,
                2 => continue,
                _ => control.min + (control.max - control.min) * random.unit() as f32,
            };
            values.push((index, value));
        }
        let mut pose = Pose::new("p", values);
        pose.duration_secs = (random.below(3) == 0).then(|| 0.02 + random.unit() as f32);
        if random.below(4) == 0 {
            pose.transition = Some(transitions[random.below(transitions.len())]);
        }
        for control in 0..table.len() {
            if random.below(4) == 0 {
                let delay_secs = 0.3 * random.unit() as f32;
                pose = pose.timed(control, Timing { delay_secs, factor: 0.5 + random.unit() as f32 });
            }
        }
        if random.below(4) == 0 {
            pose = Pose::mixed("m", &[(&pose, 1.5 * random.unit() as f32)], table);
        }
        presses.push((at, Action::Press(pose)));
    }
    presses
}

fn states(player: &Player) -> Vec<Jet> {
    (0..player.values().len()).map(|control| player.state(control).unwrap()).collect()
}

/// Plays a script in the given steps until `end`; looks at the player after each step.
fn play(
    player: &mut Player,
    presses: &[(f64, Action)],
    end: f64,
    mut next_step: impl FnMut() -> f64,
    mut look: impl FnMut(f64, &Player),
) {
    let (mut now, mut presses) = (0.0, presses.iter().peekable());
    while now < end {
        let until = (now + next_step()).min(end);
        while let Some((at, action)) = presses.next_if(|(at, _)| *at <= until) {
            player.advance(at - now).unwrap();
            now = *at;
            action.act(player);
        }
        player.advance(until - now).unwrap();
        now = until;
        look(now, player);
    }
}

#[test]
fn random_scripts_hold_every_promise() {
    let table = table();
    let mut random = Random(7);
    let transitions: Vec<_> = Easing::names().iter().map(|name| Easing::from_name(name).unwrap()).collect();
    for round in 0..10_000 {
        let presses = script(&mut random, &table, &transitions);
        let mut player = Player::new(&table);
        let mut now = 0.0;
        for (at, action) in &presses {
            player.advance(at - now).unwrap();
            now = *at;
            let before = states(&player);
            action.act(&mut player);
            // At the press itself nothing changes, and what changes just after it goes to 0 with the time.
            let jump = |after_secs: f64| {
                let mut player = player.clone();
                player.advance(after_secs).unwrap();
                states(&player)
            };
            let near = jump(1e-7);
            let far = [3e-7, 6e-7, 1e-6, 2e-6].map(jump);
            for (index, before) in before.iter().enumerate() {
                let width = f64::from(table.controls()[index].max - table.controls()[index].min);
                let parts = |jet: &Jet| [jet.value, jet.velocity, jet.acceleration];
                for part in 0..3 {
                    let change = |states: &[Jet]| (parts(&states[index])[part] - parts(before)[part]).abs();
                    let allowed = far.iter().map(|far| change(far)).fold(0.0, f64::max);
                    let allowed = 0.5 * allowed + [1e-13, 1e-10, 1e-5][part] * width;
                    assert!(
                        change(&near) <= allowed,
                        "script {round}, at {at}, control {index}, derivative {part}: {before:?} {near:?} {far:?}, {presses:?}"
                    );
                }
            }
            let values = player.values().to_vec();
            player.advance(0.0).unwrap();
            assert_eq!(player.values(), values);
        }

        // Any rate, the same values; always in range.
        let end = now + 0.3;
        let looks = [0.5 * now, now, now + 0.1, end];
        let rates = [24.0, 60.0, 240.0];
        let mut found: Vec<Vec<Jet>> = Vec::new();
        for rate in 0..4 {
            let mut player = Player::new(&table);
            let (mut time, mut states_now) = (0.0, Vec::new());
            for look in looks {
                let rest: Vec<_> = presses
                    .iter()
                    .filter(|(at, _)| (*at > time || time == 0.0) && *at <= look)
                    .map(|(at, action)| (at - time, action.clone()))
                    .collect();
                let step = |random: &mut Random| match rates.get(rate) {
                    Some(rate) => 1.0 / rate,
                    None => 0.04 * random.unit(),
                };
                play(
                    &mut player,
                    &rest,
                    look - time,
                    || step(&mut random),
                    |_, player| {
                        for (value, control) in player.values().iter().zip(table.controls()) {
                            assert!((control.min..=control.max).contains(value), "script {round}");
                        }
                    },
                );
                time = look;
                states_now.extend(states(&player));
            }
            found.push(states_now);
        }
        for other in &found[1..] {
            for (a, b) in found[0].iter().zip(other) {
                assert!((a.value - b.value).abs() < 1e-6, "script {round}: {a:?} {b:?}");
            }
        }

        // Arrival, bit for bit and at rest.
        player.advance(0.2 * random.unit()).unwrap();
        let end = |control: &pose_anim::Control| {
            control.min + (control.max - control.min) * random.below(5) as f32 / 4.0
        };
        let targets: Vec<_> = table.controls().iter().map(end).collect();
        player.press(&Pose::from_values("end", &targets));
        player.advance(player.secs_to_rest() + 1e-9).unwrap();
        assert!(player.is_at_rest(), "script {round}");
        assert_eq!(player.values(), targets, "script {round}");
        assert!(player.velocities().iter().chain(player.accelerations()).all(|rate| *rate == 0.0));
    }
}

/// The velocity integrates to the value and the acceleration to the velocity, through all interruptions; the error of the
/// trapezoid rule falls with the square of the step, as it does for continuous derivatives only.
#[test]
fn derivatives_are_those_of_the_values() {
    let table = table();
    let mut random = Random(11);
    for round in 0..200 {
        let presses = script(&mut random, &table, &SMOOTH.map(|name| Easing::from_name(name).unwrap()));
        let error = |step: f64| {
            let mut player = Player::new(&table);
            let mut before = states(&player);
            let (mut worst, mut time) = ([0.0f64; 2], 0.0);
            play(
                &mut player,
                &presses,
                1.5,
                || step,
                |now, player| {
                    let (dt, after) = (now - time, states(player));
                    time = now;
                    for (a, b) in before.iter().zip(&after) {
                        let value = (b.value - a.value - 0.5 * dt * (a.velocity + b.velocity)).abs();
                        let velocity =
                            (b.velocity - a.velocity - 0.5 * dt * (a.acceleration + b.acceleration)).abs();
                        worst = [worst[0].max(value), worst[1].max(velocity)];
                    }
                    before = after;
                },
            );
            worst
        };
        // Locally third order where a third derivative exists, second order where only it jumps.
        // How large that one is depends on where in a step it falls, so the coarse steps are tried several times.
        let coarse =
            [2e-4, 2.13e-4, 1.87e-4].map(error).into_iter().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        let (coarse, fine) = (coarse.unwrap(), error(2.5e-5));
        assert!(fine[0] < coarse[0] / 50.0 + 1e-9, "script {round}: {coarse:?} {fine:?}");
        assert!(fine[1] < coarse[1] / 15.0 + 1e-7, "script {round}: {coarse:?} {fine:?}");
    }
}

#[test]
fn more_presses_than_can_be_nested() {
    let table = table();
    let mut random = Random(23);
    for _ in 0..300 {
        let mut player = Player::new(&table);
        let mut last = 0.0;
        for _ in 0..200 {
            last = [0.0, 0.2, 0.9, 1.0][random.below(4)];
            let pose = Pose::new("p", vec![(2, last)]).lasting([0.05, 0.4, 2.0][random.below(3)]);
            let before = player.state(2).unwrap();
            player.press(&pose);
            let dt = 1e-6;
            let mut soon = player.clone();
            soon.advance(dt).unwrap();
            let after = soon.state(2).unwrap();
            assert!((after.value - before.value - dt * before.velocity).abs() < 1e-7);
            assert!((after.velocity - before.velocity).abs() < 1e-2);
            assert!(
                (after.acceleration - before.acceleration).abs() < 0.05 * before.acceleration.abs().max(2e4)
            );
            player.advance(0.03 * random.unit()).unwrap();
            assert!((0.0..=1.0).contains(&player.values()[2]));
        }
        player.advance(f64::INFINITY).unwrap();
        assert_eq!(player.values()[2], last);
    }
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
        [(f32::NAN, 1.0), (f32::INFINITY, 0.0), (1e38, -3.0), (-5.0, f32::NAN), (9.0, 1e38)]
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
        let mut player = Player::new(&table);
        player.press(pose);
        let secs = |name: &str| {
            let control = table.index(name).unwrap();
            let mut alone = Player::new(&table);
            alone.press(&Pose::new("p", vec![(control, pose.value(control).unwrap())]));
            alone.secs_to_rest()
        };
        let within = |secs: f64, range: std::ops::RangeInclusive<f64>| secs == 0.0 || range.contains(&secs);
        assert!(within(secs("lid.left.upper"), 0.0999..=0.1501), "{}", pose.name);
        assert!(within(secs("eye.left.lr"), 0.0599..=0.2001), "{}", pose.name);
        assert!(within(secs("head.turn"), 0.3999..=0.9001), "{}", pose.name);
        player.advance(0.91).unwrap();
        assert!(player.is_at_rest());
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

proptest! {
    /// From rest, a move is the textbook minimum-jerk move, monotone.
    #[test]
    fn from_rest_it_is_minimum_jerk(from in -70.0f32..70.0, to in -70.0f32..70.0, secs in 0.01f32..5.0, s in 0.0f64..1.0) {
        let table = table();
        let mut player = Player::new(&table);
        player.jump_to(&[from, 0.0, 0.0]).unwrap();
        player.press(&Pose::new("p", vec![(0, to)]).lasting(secs));
        player.advance(s * f64::from(secs)).unwrap();
        let expected = f64::from(from) + f64::from(to - from) * (10.0 * s.powi(3) - 15.0 * s.powi(4) + 6.0 * s.powi(5));
        prop_assert!((player.state(0).unwrap().value - expected).abs() < 1e-4);
    }
}
