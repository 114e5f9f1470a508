//! Random interruption scripts: whatever is done whenever, nothing jumps, leaves its range or misses its target.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use glam::{Quat, Vec3};
use pose_anim::{
    Clip, Control, ControlTable, Easing, Jet, JointPlayer, JointTarget, Key, LayerId, LayerMode, Layers,
    Player, Pose, Timing, Track, Transition, Wrap,
};
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

    fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
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

/// What a script does.
#[derive(Clone, Debug)]
enum Action {
    Press(Pose),
    Play(Arc<Clip>, Option<f32>),
    Stop,
    Weight(f32, f32),
    Joint(JointTarget, f32),
}

/// Layered players and a joint.
#[derive(Clone)]
struct Stage {
    layers: Layers,
    ids: [LayerId; 2],
    joint: JointPlayer,
}

/// An action at a time. The number says to whom: 0 the base, 1 and 2 the layers.
type Event = (f64, usize, Action);

impl Stage {
    fn new(table: &ControlTable) -> Self {
        let mut layers = Layers::new(table);
        let ids = [
            layers.add(table, LayerMode::Additive, &[1.0, 0.5, 0.8]),
            layers.add(table, LayerMode::Override, &[0.0, 1.0, 0.3]),
        ];
        let joint = JointPlayer::new(JointTarget { rotation: Quat::IDENTITY, translation: Vec3::ZERO });
        Self { layers, ids, joint }
    }

    fn act(&mut self, who: usize, action: &Action) {
        let id = self.ids[who.max(1) - 1];
        let player = if who == 0 { self.layers.base() } else { self.layers.layer(id).unwrap() };
        match action {
            Action::Press(pose) => player.press(pose),
            Action::Play(clip, fade_secs) => player.play(clip, *fade_secs),
            Action::Stop => player.stop(),
            Action::Weight(weight, secs) => self.layers.fade_to(id, *weight, *secs),
            Action::Joint(target, secs) => self.joint.press(*target, *secs),
        }
    }

    fn advance(&mut self, dt_secs: f64) {
        self.layers.advance(dt_secs).unwrap();
        self.joint.advance(dt_secs).unwrap();
    }

    /// The controls, then the joint's translation, then its rotation in place of a value with its angular rates.
    fn states(&self) -> Vec<Jet> {
        let jet = |value, velocity, acceleration| Jet { value, velocity, acceleration };
        let mut states: Vec<_> =
            (0..self.layers.values().len()).map(|control| self.layers.state(control).unwrap()).collect();
        let (at, (v, a)) = (self.joint.translation(), self.joint.linear_rates());
        states.extend((0..3).map(|axis| jet(at[axis], v[axis], a[axis])));
        let (q, (v, a)) = (self.joint.rotation(), self.joint.angular_rates());
        // One value per axis that does not depend on the quaternion's sign.
        states.extend((0..3).map(|axis| jet(q.to_array()[axis] * q.w, v[axis], a[axis])));
        states
    }
}

/// Plays a script in the given steps until `end`; looks at the stage after each step.
fn play(
    stage: &mut Stage,
    events: &[Event],
    end: f64,
    mut next_step: impl FnMut() -> f64,
    mut look: impl FnMut(f64, &Stage),
) {
    let (mut now, mut events) = (0.0, events.iter().peekable());
    while now < end {
        let until = (now + next_step()).min(end);
        while let Some((at, who, action)) = events.next_if(|event| event.0 <= until) {
            stage.advance(at - now);
            now = *at;
            stage.act(*who, action);
        }
        stage.advance(until - now);
        now = until;
        look(now, stage);
    }
}

fn value(random: &mut Random, control: &Control) -> f32 {
    match random.below(5) {
        0 => control.min,
        1 => control.max,
        _ => control.min + (control.max - control.min) * random.unit() as f32,
    }
}

/// A clip for some controls, twice continuously differentiable by itself. Some end at full speed.
fn clip(random: &mut Random, table: &ControlTable) -> Clip {
    let wrap = [Wrap::Once, Wrap::Loop, Wrap::PingPong][random.below(3)];
    let mut tracks = Vec::new();
    for (index, control) in table.controls().iter().enumerate() {
        let mut value = || f64::from(value(random, control));
        let (start, middle, end) = (value(), value(), value());
        let end_secs = 0.2 + random.unit();
        let keys = match (random.below(4), wrap) {
            (0, _) => continue,
            (1, Wrap::Once) => {
                // Monotone, so that it stays in range; it arrives with a slope, but not at the end of the range.
                let end = 0.9 * end + 0.1 * f64::from(0.5 * (control.min + control.max));
                let arriving = 1.5 * (end - start) / end_secs;
                let transition = Transition::Hermite { leaving: 0.3 * arriving, arriving };
                vec![
                    Key { time_secs: 0.0, value: start, transition },
                    Key::new(end_secs, end, Easing::Linear),
                ]
            }
            _ => {
                let key = |time_secs, value| Key::new(time_secs, value, Easing::MinimumJerk);
                let inner = [key(0.0, start), key(0.3 * end_secs, middle), key(0.8 * end_secs, end)];
                inner.into_iter().chain([key(end_secs, start)]).collect()
            }
        };
        tracks.push(Track::new(index, keys).unwrap());
    }
    Clip::new("c", tracks).unwrap().wrapped(wrap)
}

fn pose(random: &mut Random, table: &ControlTable, transitions: &[Easing]) -> Pose {
    let mut values = Vec::new();
    for (index, control) in table.controls().iter().enumerate() {
        if !random.one_in(5) {
            values.push((index, value(random, control)));
        }
    }
    let mut pose = Pose::new("p", values);
    pose.duration_secs = random.one_in(3).then(|| 0.02 + random.unit() as f32);
    if random.one_in(4) {
        pose.transition = Some(transitions[random.below(transitions.len())]);
    }
    for control in 0..table.len() {
        if random.one_in(4) {
            let delay_secs = 0.3 * random.unit() as f32;
            pose = pose.timed(control, Timing { delay_secs, factor: 0.5 + random.unit() as f32 });
        }
    }
    if random.one_in(4) {
        pose = Pose::mixed("m", &[(&pose, 1.5 * random.unit() as f32)], table);
    }
    pose
}

/// One to eight events, sorted. A third of the scripts leaves the layers alone, so that the base shows as it is.
fn script(random: &mut Random, table: &ControlTable, transitions: &[Easing]) -> Vec<Event> {
    let count = 1 + random.below(8);
    // Half of the scripts are hectic: everything within a tenth of a second.
    let span = if random.one_in(2) { 0.1 } else { 1.2 };
    let mut times: Vec<f64> = (0..count).map(|_| random.unit() * span).collect();
    times.sort_by(f64::total_cmp);
    if random.one_in(4) && count > 1 {
        // Two at the same moment, or one in the very first.
        times[1] = times[0];
    } else if random.one_in(4) {
        times[0] = 0.0;
    }
    let layered = !random.one_in(3);
    let event = |at: f64| {
        let who = if layered { random.below(3) } else { 0 };
        let secs = 0.05 + random.unit() as f32;
        let action = match random.below(9) {
            0 => Action::Play(Arc::new(clip(random, table)), random.one_in(2).then_some(secs)),
            1 if random.one_in(2) => Action::Stop,
            2 => {
                let mut number = || 2.0 * random.unit() as f32 - 1.0;
                let (x, y, z, w) = (number(), number(), number(), number());
                let translation = Vec3::new(number(), number(), number());
                Action::Joint(JointTarget { rotation: Quat::from_xyzw(x, y, z, w), translation }, secs)
            }
            3 | 4 if who > 0 => Action::Weight(random.below(3) as f32 / 2.0, secs),
            _ => Action::Press(pose(random, table, transitions)),
        };
        (at, who, action)
    };
    times.into_iter().map(event).collect()
}

#[test]
fn ten_thousand_scripts_hold_every_promise() {
    let table = table();
    let mut random = Random(7);
    let transitions: Vec<_> = Easing::names().iter().map(|name| Easing::from_name(name).unwrap()).collect();
    for round in 0..10_000 {
        let events = script(&mut random, &table, &transitions);
        let mut stage = Stage::new(&table);
        let mut now = 0.0;
        for (at, who, action) in &events {
            stage.advance(at - now);
            now = *at;
            let before = stage.states();
            stage.act(*who, action);
            let values = stage.layers.values().to_vec();
            stage.advance(0.0);
            assert_eq!(stage.layers.values(), values, "script {round}");
            // At the event itself nothing changes, and what changes just after it goes to 0 with the time.
            let after = |secs: f64| {
                let mut stage = stage.clone();
                stage.advance(secs);
                stage.states()
            };
            let near = after(1e-7);
            let far = [3e-7, 6e-7, 1e-6, 2e-6].map(after);
            for (index, before) in before.iter().enumerate() {
                let width =
                    table.controls().get(index).map_or(1.0, |control| f64::from(control.max - control.min));
                let parts = |jet: &Jet| [jet.value, jet.velocity, jet.acceleration];
                for part in 0..3 {
                    let change = |states: &[Jet]| (parts(&states[index])[part] - parts(before)[part]).abs();
                    let allowed = far.iter().map(|far| change(far)).fold(0.0, f64::max);
                    let allowed = 0.5 * allowed + [1e-12, 1e-9, 1e-5][part] * width;
                    assert!(
                        change(&near) <= allowed,
                        "script {round}, at {at}, state {index}, derivative {part}: {before:?} {:?} {:?}, {events:?}",
                        near[index],
                        far.each_ref().map(|far| far[index])
                    );
                }
            }
        }

        // Any rate, the same values; always in range.
        let looks = [0.5 * now, now, now + 0.1, now + 0.3];
        let mut found: Vec<Vec<Jet>> = Vec::new();
        let rates = [24.0, 30.0, 60.0, 144.0, 240.0];
        for rate in [Some(rates[random.below(2)]), Some(rates[2 + random.below(3)]), None] {
            let mut stage = Stage::new(&table);
            let (mut time, mut states) = (0.0, Vec::new());
            for look in looks {
                let due: Vec<_> = events
                    .iter()
                    .filter(|(at, ..)| (*at > time || states.is_empty()) && *at <= look)
                    .map(|(at, who, action)| (at - time, *who, action.clone()))
                    .collect();
                let step = |random: &mut Random| rate.map_or_else(|| 0.05 * random.unit(), |rate| 1.0 / rate);
                play(
                    &mut stage,
                    &due,
                    look - time,
                    || step(&mut random),
                    |_, stage| {
                        for (value, control) in stage.layers.values().iter().zip(table.controls()) {
                            assert!((control.min..=control.max).contains(value), "script {round}");
                        }
                    },
                );
                time = look;
                states.extend(stage.states());
            }
            found.push(states);
        }
        for other in &found[1..] {
            for (a, b) in found[0].iter().zip(other) {
                assert!((a.value - b.value).abs() < 1e-6, "script {round}: {a:?} {b:?}, {events:?}");
            }
        }

        // Arrival, bit for bit and at rest, from whatever runs.
        stage.advance(0.2 * random.unit());
        let end: Vec<_> = table.controls().iter().map(|control| value(&mut random, control)).collect();
        let place = Vec3::new(random.unit() as f32, 0.25, -3.0);
        stage.act(0, &Action::Press(Pose::from_values("end", &end)));
        for who in 1..3 {
            stage.act(who, &Action::Stop);
            stage.act(who, &Action::Weight(0.0, 0.3));
        }
        stage.act(0, &Action::Joint(JointTarget { rotation: Quat::IDENTITY, translation: place }, 0.4));
        stage.advance(1.0);
        assert!(stage.layers.is_at_rest() && stage.joint.is_at_rest(), "script {round}");
        assert_eq!(stage.layers.values(), end, "script {round}");
        assert!(
            stage.layers.velocities().iter().chain(stage.layers.accelerations()).all(|rate| *rate == 0.0)
        );
        assert_eq!(stage.joint.translation().as_vec3(), place);
        assert_eq!(stage.joint.rotation().as_quat(), Quat::IDENTITY);
    }
}

/// Transition functions without corners and overshoot.
const SMOOTH: [&str; 8] =
    ["minimum-jerk", "linear", "step", "quad-in", "cubic-out", "expo-out", "circ-in", "ease-in-out"];

/// The velocity integrates to the value and the acceleration to the velocity, through all interruptions; the error of the
/// trapezoid rule falls with the step as it does for continuous derivatives only.
#[test]
fn derivatives_are_those_of_the_values() {
    let table = table();
    let mut random = Random(11);
    let transitions = SMOOTH.map(|name| Easing::from_name(name).unwrap());
    for round in 0..200 {
        let events = script(&mut random, &table, &transitions);
        let error = |step: f64| {
            let mut stage = Stage::new(&table);
            let mut before = stage.states();
            // The values in place of a rotation have other derivatives.
            let counted = before.len() - 3;
            let (mut worst, mut time) = ([0.0f64; 2], 0.0);
            play(
                &mut stage,
                &events,
                1.5,
                || step,
                |now, stage| {
                    let (dt, after) = (now - time, stage.states());
                    time = now;
                    for (a, b) in before.iter().zip(&after).take(counted) {
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
        // Locally third order where a third derivative exists, second order where only it jumps. How large that one is
        // depends on where in a step it falls, so the coarse steps are tried several times.
        let coarse =
            [2e-4, 2.13e-4, 1.87e-4].map(error).into_iter().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        let (coarse, fine) = (coarse.unwrap(), error(2.5e-5));
        assert!(fine[0] < coarse[0] / 50.0 + 1e-9, "script {round}: {coarse:?} {fine:?}, {events:?}");
        assert!(fine[1] < coarse[1] / 15.0 + 1e-7, "script {round}: {coarse:?} {fine:?}, {events:?}");
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
