//! Layers over a base player.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{ControlTable, Easing, Jet, LayerMode, Layers, Player, Pose};
use proptest::prelude::*;

fn table() -> ControlTable {
    let text =
        "control = [{ name = 'a', shape = 'A' }, { name = 'b', shape = 'B', min = -1, default = 0.25 }]";
    ControlTable::from_toml(text).unwrap()
}

fn pose(a: f32, b: f32, secs: f64) -> Pose {
    Pose::from_values("p", &[a, b]).lasting(secs)
}

#[test]
fn without_weight_the_base_goes_through_to_the_last_bit() {
    let table = table();
    let (mut layers, mut alone) = (Layers::new(&table), Player::new(&table));
    let over = layers.add(&table, LayerMode::Override, &[1.0, 1.0]);
    layers.layer(over).unwrap().press(&pose(1.0, 1.0, 0.2));
    for player in [layers.base(), &mut alone] {
        player.press(&pose(0.7, -0.3, 0.3));
    }
    for _ in 0..40 {
        layers.advance(0.01).unwrap();
        alone.advance(0.01).unwrap();
        assert_eq!(
            (layers.values(), layers.velocities(), layers.accelerations()),
            (alone.values(), alone.velocities(), alone.accelerations())
        );
    }
    assert!(layers.is_at_rest());
}

#[test]
fn modes_masks_and_weights() {
    let table = table();
    let mut layers = Layers::new(&table);
    let over = layers.add(&table, LayerMode::Override, &[1.0, 0.5]);
    let add = layers.add(&table, LayerMode::Additive, &[0.0, 1.0, 7.0]);
    layers.base().press(&pose(0.4, 0.0, 0.2));
    layers.layer(over).unwrap().press(&pose(1.0, 0.5, 0.2));
    // Half a unit above the default.
    layers.layer(add).unwrap().press(&pose(1.0, 0.75, 0.2));
    layers.fade_to(over, 1.0, 0.3);
    layers.advance(1.0).unwrap();
    assert_eq!(layers.values(), [1.0, 0.25]);
    layers.fade_to(add, 0.5, 0.3);
    layers.advance(1.0).unwrap();
    assert_eq!(layers.values(), [1.0, 0.5]);
    assert_eq!(layers.weight(add), Some(Jet::rest(0.5)));
    layers.fade_to(over, f32::NAN, 0.3);
    layers.fade_to(over, -4.0, 0.3);
    layers.advance(1.0).unwrap();
    assert_eq!(layers.values(), [0.4, 0.25]);
    assert!(layers.advance(-1.0).is_err());
}

#[test]
fn a_layer_of_another_stack_is_not_found() {
    let table = table();
    let (mut here, mut there) = (Layers::new(&table), Layers::new(&table));
    let mine = here.add(&table, LayerMode::Override, &[1.0, 1.0]);
    let other = there.add(&table, LayerMode::Override, &[1.0, 1.0]);
    assert_ne!(mine, other);
    assert!(here.layer(other).is_none() && here.weight(other).is_none());
    here.fade_to(other, 1.0, 0.1);
    here.advance(1.0).unwrap();
    assert_eq!(here.weight(mine), Some(Jet::rest(0.0)));
    // A clone is the same stack.
    let mut clone = here.clone();
    assert!(clone.layer(mine).is_some());
}

#[test]
fn a_layer_of_a_shorter_or_longer_table_has_no_share_in_the_rest() {
    let table = table();
    let short = ControlTable::from_toml("control = [{ name = 'a', shape = 'A' }]").unwrap();
    let long =
        "control = [{ name = 'a', shape = 'A' }, { name = 'b', shape = 'B' }, { name = 'c', shape = 'C' }]";
    let long = ControlTable::from_toml(long).unwrap();
    for other in [&short, &long] {
        let mut layers = Layers::new(&table);
        let over = layers.add(other, LayerMode::Override, &[1.0, 0.0, 1.0]);
        layers.fade_to(over, 1.0, 0.1);
        layers.base().press(&pose(0.2, 0.75, 0.1));
        layers.layer(over).unwrap().press(&Pose::new("p", vec![(0, 0.5), (2, 1.0)]).lasting(0.1));
        layers.advance(1.0).unwrap();
        assert_eq!(layers.values(), [0.5, 0.75]);
        assert_eq!((layers.state(0), layers.state(1)), (Some(Jet::rest(0.5)), Some(Jet::rest(0.75))));
        assert_eq!(layers.state(2), None);
    }
    // A mask does not make controls of a shorter table either.
    let mut layers = Layers::new(&table);
    let over = layers.add(&short, LayerMode::Override, &[1.0, 1.0]);
    layers.fade_to(over, 1.0, 0.1);
    layers.advance(1.0).unwrap();
    assert_eq!(layers.state(1), Some(Jet::rest(0.25)));
}

#[test]
fn overshoot_is_cut_at_the_very_end_or_not_at_all() {
    let table = table();
    let back = Easing::from_name("back-out").unwrap();
    for (free, lower) in [(true, 0.0), (false, 0.0), (false, -0.5), (true, -0.5)] {
        let mut layers = Layers::new(&table);
        if free {
            layers = layers.with_overshoot();
        }
        let over = layers.add(&table, LayerMode::Override, &[0.5, 0.0]);
        let add = layers.add(&table, LayerMode::Additive, &[0.0, 1.0]);
        for id in [over, add] {
            layers.fade_to(id, 1.0, 0.1);
        }
        layers.layer(over).unwrap().press(&pose(0.0, 0.0, 0.1));
        layers.layer(add).unwrap().press(&pose(0.0, 0.25 + lower, 0.1));
        layers.advance(1.0).unwrap();
        layers.base().press(&pose(1.0, 1.0, 1.0).along(back));
        layers.advance(0.6).unwrap();
        let up = back.at(0.6).value;
        assert!(up > 1.05);
        // Half of an overshoot that is not cut before it is combined.
        assert!((f64::from(layers.values()[0]) - 0.5 * up).abs() < 1e-6);
        let b = 0.25 + 0.75 * up + f64::from(lower);
        let b = if free { b } else { b.min(1.0) };
        assert!((f64::from(layers.values()[1]) - b).abs() < 1e-6, "{:?} {b}", layers.values());
        assert_eq!(layers.state(1).unwrap().value as f32, layers.values()[1]);
        layers.advance(1.0).unwrap();
        assert!((layers.values()[1] - (1.0 + lower)).abs() < 1e-6 && layers.is_at_rest());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// With everything moving at once, the combination is in range and has the derivatives that it says,
    /// through presses of all players and weights. The trapezoid rule's error falls with the step only if
    /// nothing jumps.
    #[test]
    fn combinations_are_smooth_and_in_range(
        presses in prop::collection::vec((0.0f64..1.0, 0usize..5, 0.0f32..=1.0, -1.0f32..=1.0, 0.05f64..0.6), 1..9),
    ) {
        let table = table();
        let error = |step: f64| {
            // Nothing overshoots on purpose, so nothing has to be cut at the end of the pipeline.
            let mut layers = Layers::new(&table).with_overshoot();
            let ids = [
                layers.add(&table, LayerMode::Additive, &[1.0, 0.8]),
                layers.add(&table, LayerMode::Override, &[0.7, 1.0]),
            ];
            layers.fade_to(ids[0], 1.0, 0.2);
            let mut presses = presses.clone();
            presses.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut presses = presses.into_iter().peekable();
            let states = |layers: &Layers| [layers.state(0).unwrap(), layers.state(1).unwrap()];
            let (mut now, mut worst, mut before) = (0.0, [0.0f64; 2], states(&layers));
            while now < 1.7 {
                let until = now + step;
                let mut at = now;
                while let Some((time, who, a, b, secs)) = presses.next_if(|press| press.0 <= until) {
                    layers.advance(time - at).unwrap();
                    at = time;
                    match who {
                        0 => layers.base().press(&pose(a, b, secs)),
                        1 | 2 => layers.layer(ids[who - 1]).unwrap().press(&pose(a, b, secs)),
                        _ => layers.fade_to(ids[who - 3], a, secs),
                    }
                }
                layers.advance(until - at).unwrap();
                let after = states(&layers);
                for (index, control) in table.controls().iter().enumerate() {
                    let slack = 1e-12 * f64::from(control.max - control.min);
                    let range = f64::from(control.min) - slack..=f64::from(control.max) + slack;
                    assert!(range.contains(&after[index].value), "{:?}", after[index]);
                    let (a, b) = (before[index], after[index]);
                    worst[0] = worst[0].max((b.value - a.value - 0.5 * step * (a.velocity + b.velocity)).abs());
                    worst[1] = worst[1].max((b.velocity - a.velocity - 0.5 * step * (a.acceleration + b.acceleration)).abs());
                }
                (now, before) = (until, after);
            }
            worst
        };
        // What a bend costs depends on where in a step it falls: three steps, so that none looks good by
        // luck.
        let coarse = [1e-3, 0.93e-3, 1.06e-3].map(error);
        let coarse = [0, 1].map(|which| coarse.iter().map(|worst| worst[which]).fold(0.0, f64::max));
        let fine = error(6.25e-5);
        prop_assert!(fine[0] < coarse[0] / 60.0 + 1e-9, "{coarse:?} {fine:?}");
        prop_assert!(fine[1] < coarse[1] / 20.0 + 1e-7, "{coarse:?} {fine:?}");
    }
}
