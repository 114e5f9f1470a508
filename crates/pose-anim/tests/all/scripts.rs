//! Random interruption scripts: whatever is done whenever, nothing jumps, leaves its range or misses its
//! target.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod arrival;
mod generate;
mod smoothness;

use generate::{Action, Event, Random, Stage, play, script, table, value};
use glam::{Quat, Vec3};
use pose_anim::{ControlTable, Easing, Jet, JointTarget, Player, Pose};

/// Offsets in time at which a moment is looked at from both sides.
const NEAR: [f64; 4] = [1e-7, 3e-7, 1e-6, 2e-6];

fn easings(overshooting: bool) -> Vec<Easing> {
    let names = Easing::names().into_iter();
    let names =
        names.filter(|name| overshooting || !(name.starts_with("back") || name.starts_with("elastic")));
    names.map(|name| Easing::from_name(&name).unwrap()).collect()
}

fn widths(table: &ControlTable, states: usize) -> Vec<f64> {
    let width = |index| {
        table
            .controls()
            .get(index)
            .map_or(1.0, |control: &pose_anim::Control| f64::from(control.max - control.min))
    };
    (0..states).map(width).collect()
}

fn parts(jet: &Jet) -> [f64; 3] {
    [jet.value, jet.velocity, jet.acceleration]
}

/// In full precision, before anything is clamped.
fn assert_in_range(table: &ControlTable, states: &[Jet], what: &str) {
    for (state, control) in states.iter().zip(table.controls()) {
        let slack = 1e-12 * f64::from(control.max - control.min);
        let range = f64::from(control.min) - slack..=f64::from(control.max) + slack;
        assert!(range.contains(&state.value), "{what}: {} at {state:?}", control.name);
    }
}

/// What changes across a moment goes to 0 with the time around it: across both sides, and after it alone.
fn assert_smooth(before: &[Vec<Jet>], at: &[Jet], after: &[Vec<Jet>], widths: &[f64], what: &str) {
    for (index, width) in widths.iter().enumerate() {
        for part in 0..3 {
            let of = |states: &[Jet]| parts(&states[index])[part];
            let across: Vec<f64> = (0..NEAR.len()).map(|i| (of(&after[i]) - of(&before[i])).abs()).collect();
            let past: Vec<f64> = (0..NEAR.len()).map(|i| (of(&after[i]) - of(at)).abs()).collect();
            for changes in [across, past] {
                let allowed = changes[1..].iter().copied().fold(0.0, f64::max);
                let allowed = 0.5 * allowed + [1e-12, 1e-9, 1e-5][part] * width;
                assert!(
                    changes[0] <= allowed,
                    "{what}, state {index}, derivative {part}: {changes:?} {:?} {:?} {:?}",
                    before[0][index],
                    at[index],
                    after[0][index]
                );
            }
        }
    }
}

/// A press changes nothing at its own moment.
fn assert_unchanged(before: &[Jet], after: &[Jet], widths: &[f64], what: &str) {
    for (index, width) in widths.iter().enumerate() {
        let (before, after) = (parts(&before[index]), parts(&after[index]));
        // In units of the range; what rounding leaves of an acceleration grows with the accelerations around.
        let size = 1.0 + before[2].abs() / width;
        for (part, within) in [1e-13, 1e-11, 1e-9].into_iter().enumerate() {
            let change = (after[part] - before[part]).abs() / width;
            assert!(
                change <= within * size,
                "{what}, state {index}, derivative {part}: {before:?} {after:?}"
            );
        }
    }
}

/// Plays a script once, and looks at every moment where something may jump: presses, starts after a delay,
/// arrivals of each player, ends of tracks, arrivals of the joint.
fn look_at_all_seams(
    table: &ControlTable,
    stage: &mut Stage,
    events: &[Event],
    free: bool,
    what: &str,
) -> usize {
    let widths = widths(table, stage.states().len());
    let (mut now, mut next, mut seams, mut looked) = (0.0, 0, Vec::<f64>::new(), 0);
    loop {
        let event = events.get(next).map(|event| event.0);
        seams.retain(|seam| *seam > now);
        let seam = seams.iter().copied().fold(f64::INFINITY, f64::min);
        let at = match event {
            Some(event) => event.min(seam),
            None if seam.is_finite() => seam,
            None => return looked,
        };
        let room = at - NEAR[3] > now;
        let mut to = |stage: &mut Stage, time: f64| {
            // Where two moments are closer than the looks around them, the time does not go back.
            stage.advance((time - now).max(0.0));
            now = time.max(now);
            let states = stage.states();
            if free {
                assert_in_range(table, &states, what);
            }
            states
        };
        let before: Vec<_> =
            NEAR.iter().rev().map(|h| at - h).filter(|_| room).map(|t| to(stage, t)).collect();
        let mut here = to(stage, at);
        let mut moved = false;
        while let Some((_, who, action)) = events.get(next).filter(|event| event.0 == at) {
            let (old, values) = (stage.states(), stage.layers.values().to_vec());
            stage.act(*who, action);
            assert_unchanged(&old, &stage.states(), &widths, &format!("{what} at {at}"));
            let pressed = stage.states();
            stage.advance(0.0);
            assert!(
                stage.states() == pressed && stage.layers.values() == values,
                "{what}: no time changes nothing"
            );
            seams.extend(action.seams().into_iter().map(|secs| at + secs));
            (next, moved) = (next + 1, true);
        }
        if moved {
            here = stage.states();
        }
        seams.extend(stage.secs_to_rest().into_iter().filter(|secs| secs.is_finite()).map(|secs| at + secs));
        // Something else may begin before the last look.
        let clear = events.get(next).is_none_or(|event| event.0 > at + 2.0 * NEAR[3])
            && seams.iter().all(|seam| *seam <= at || *seam > at + 2.0 * NEAR[3]);
        if room && clear {
            let after: Vec<_> = NEAR.map(|h| to(stage, at + h)).into();
            let before: Vec<_> = before.into_iter().rev().collect();
            assert_smooth(&before, &here, &after, &widths, &format!("{what} at {at}"));
            looked += 1;
        }
    }
}

#[test]
fn ten_thousand_scripts_hold_every_promise() {
    let table = table();
    let mut random = Random(7);
    let transitions = [easings(false), easings(true)];
    let mut seams = 0;
    for round in 0..10_000 {
        // In two of three scripts nothing overshoots on purpose, so nothing may have to be clamped.
        let free = round % 3 > 0;
        let events = script(&mut random, &table, &transitions[usize::from(!free)]);
        let what = format!("script {round}, {events:?}");
        let mut stage = Stage::new(&table, free);
        seams += look_at_all_seams(&table, &mut stage, &events, free, &what);

        // Any rate, the same values; always in range.
        let now = events.last().map_or(0.0, |event| event.0);
        let looks = [0.5 * now, now, now + 0.1, now + 0.3];
        let mut found: Vec<Vec<Jet>> = Vec::new();
        let rates = [24.0, 30.0, 60.0, 144.0, 240.0];
        let rates = [Some(rates[random.below(2)]), Some(rates[2 + random.below(3)]), None];
        let mut last = None;
        for rate in rates {
            let mut stage = Stage::new(&table, free);
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
                        if free {
                            assert_in_range(&table, &stage.states(), &what);
                        }
                        for (value, control) in stage.layers.values().iter().zip(table.controls()) {
                            let clamped = value.max(control.min).min(control.max);
                            assert!((value - clamped).abs() <= 1e-6 * (control.max - control.min), "{what}");
                        }
                    },
                );
                time = look;
                states.extend(stage.states());
            }
            found.push(states);
            last = Some(stage);
        }
        for other in &found[1..] {
            for (a, b) in found[0].iter().zip(other) {
                assert!((a.value - b.value).abs() < 1e-6, "{what}: {a:?} {b:?}");
            }
        }

        // Arrival, bit for bit and at rest, from whatever runs.
        let mut stage = last.unwrap();
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
        let rotation = stage.joint.rotation().as_quat();
        assert!(rotation == Quat::IDENTITY || -rotation == Quat::IDENTITY);
    }
    // About two per event.
    assert!(seams > 60_000, "{seams}");
}

#[test]
fn more_presses_than_can_be_nested() {
    let table = table();
    let mut random = Random(23);
    for _ in 0..300 {
        let mut player = Player::new(&table).with_overshoot();
        let mut last = 0.0;
        for press in 0..200 {
            last = [0.0, 0.2, 0.9, 1.0][random.below(4)];
            let pose = Pose::new("p", vec![(2, last)]).lasting([0.05, 0.4, 2.0][random.below(3)]);
            let before = player.state(2).unwrap();
            player.press(&pose);
            assert_unchanged(&[before], &[player.state(2).unwrap()], &[1.0], &format!("press {press}"));
            player.advance(0.03 * random.unit()).unwrap();
            assert_in_range(&table, &[0, 1, 2].map(|c| player.state(c).unwrap()), "nested");
        }
        player.advance(f64::INFINITY).unwrap();
        assert_eq!(player.values()[2], last);
    }
}
