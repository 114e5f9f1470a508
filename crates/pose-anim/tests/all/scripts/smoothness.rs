//! Every step of a script, at a fine rate, by itself: no change that its neighbours do not explain.

use super::generate::{Random, Stage, play, script, table};
use super::{parts, widths};
use pose_anim::{Easing, Jet};

/// Transition functions without corners and overshoot.
const SMOOTH: [&str; 8] =
    ["minimum-jerk", "linear", "step", "quad-in", "cubic-out", "expo-out", "circ-in", "ease-in-out"];

const STEP_SECS: f64 = 1e-4;

/// The velocity integrates to the value and the acceleration to the velocity, through all interruptions.
///
/// With `j` the changes of the acceleration in the steps around, which are `dt` times the local jerk: the
/// acceleration changes by no more than about `j`, and the trapezoid rule errs by about `dt · j / 12` in the
/// velocity and `dt² · j / 12` in the value. A jump of acceleration or velocity in one step has no such
/// neighbours. All is in units of the control's range.
fn failures(states: &[Vec<Jet>], index: usize, width: f64, is_value: bool) -> Vec<String> {
    let series: Vec<[f64; 3]> =
        states.iter().map(|states| parts(&states[index]).map(|part| part / width)).collect();
    let change = |step: usize| (series[step + 1][2] - series[step][2]).abs();
    let mut found = Vec::new();
    for step in 2..series.len() - 3 {
        let around = [step - 2, step - 1, step + 1, step + 2].map(change).into_iter().fold(0.0, f64::max);
        let [[x0, v0, a0], [x1, v1, a1]] = [series[step], series[step + 1]];
        let value = (x1 - x0 - 0.5 * STEP_SECS * (v0 + v1)).abs();
        let velocity = (v1 - v0 - 0.5 * STEP_SECS * (a0 + a1)).abs();
        let checks = [
            ("value", value, STEP_SECS * STEP_SECS * around + 1e-14, is_value),
            ("velocity", velocity, STEP_SECS * around + 1e-12, true),
            ("acceleration", change(step), 2.0 * around + 1e-7, true),
        ];
        for (what, error, allowed, counts) in checks {
            if counts && error > allowed {
                let at = step as f64 * STEP_SECS;
                found.push(format!("state {index} at {at}: {what} {error:e}, allowed {allowed:e}"));
            }
        }
    }
    found
}

#[test]
fn every_step_is_explained_by_its_neighbours() {
    let table = table();
    let mut random = Random(11);
    let transitions = SMOOTH.map(|name| Easing::from_name(name).unwrap());
    for round in 0..400 {
        let events = script(&mut random, &table, &transitions);
        let mut stage = Stage::new(&table, true);
        let mut states = vec![stage.states()];
        play(&mut stage, &events, 1.5, || STEP_SECS, |_, stage| states.push(stage.states()));
        let widths = widths(&table, states[0].len());
        // The values in place of a rotation have other derivatives.
        let values = widths.len() - 3;
        let found: Vec<String> = (0..widths.len())
            .flat_map(|index| failures(&states, index, widths[index], index < values))
            .collect();
        assert!(found.is_empty(), "script {round}: {:#?}, {events:?}", &found[..found.len().min(12)]);
    }
}
