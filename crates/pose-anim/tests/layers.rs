//! Layers over a base player.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{ControlTable, Jet, LayerMode, Layers, Player, Pose};
use proptest::prelude::*;

fn table() -> ControlTable {
    let text =
        "control = [{ name = 'a', shape = 'A' }, { name = 'b', shape = 'B', min = -1, default = 0.25 }]";
    ControlTable::from_toml(text).unwrap()
}

fn pose(a: f32, b: f32, secs: f32) -> Pose {
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

    // A layer of another stack.
    let mut other = Layers::new(&table);
    assert!(other.layer(over).is_none() && other.weight(add).is_none());
    other.fade_to(add, 1.0, 1.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// With everything moving at once, the combination is in range and has the derivatives that it says, through presses
    /// of all players and weights. The trapezoid rule's error falls with the step only if nothing jumps.
    #[test]
    fn combinations_are_smooth_and_in_range(
        presses in prop::collection::vec((0.0f64..1.0, 0usize..5, 0.0f32..=1.0, -1.0f32..=1.0, 0.05f32..0.6), 1..9),
    ) {
        let table = table();
        let error = |step: f64| {
            let mut layers = Layers::new(&table);
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
                    assert!((control.min..=control.max).contains(&layers.values()[index]));
                    let (a, b) = (before[index], after[index]);
                    worst[0] = worst[0].max((b.value - a.value - 0.5 * step * (a.velocity + b.velocity)).abs());
                    worst[1] = worst[1].max((b.velocity - a.velocity - 0.5 * step * (a.acceleration + b.acceleration)).abs());
                }
                (now, before) = (until, after);
            }
            worst
        };
        let (coarse, fine) = (error(1e-3), error(6.25e-5));
        prop_assert!(fine[0] < coarse[0] / 60.0 + 1e-9, "{coarse:?} {fine:?}");
        prop_assert!(fine[1] < coarse[1] / 20.0 + 1e-7, "{coarse:?} {fine:?}");
    }
}
