//! Weights of many faces at once against those of faces one by one, to the bit.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::drivers::{Input, LengthError, Rule, ShapeDrivers, ShapeRule};
use avatar_mesh::expressions::{Expression, Group, Override, add, add_lanes};
use lanes::{LANES, Lanes};
use proptest::prelude::*;

/// Also numbers that are at an edge of something.
fn number(random: &mut Random) -> f32 {
    match random.below(8) {
        0 => 0.0,
        1 => 0.5,
        2 => 1.0,
        3 => -0.0,
        _ => random.signed() * 2.0,
    }
}

fn column(numbers: &[Lanes], lane: usize) -> Vec<f32> {
    numbers.iter().map(|lanes| lanes[lane]).collect()
}

fn bits(numbers: &[f32]) -> Vec<u32> {
    numbers.iter().map(|number| number.to_bits()).collect()
}

proptest! {
    #[test]
    fn drivers_are_those_of_single_faces(seed in any::<u64>(), blocks in 0..4usize) {
        let driver = |name: &str| Input::Driver(name.to_owned());
        let follows = |shape: &str, input, full_weight| ShapeRule {
            shape: shape.to_owned(),
            rule: Rule::Follows { input, full_weight },
        };
        let rules = [
            follows("half", driver("x"), 0.5),
            follows("full", driver("x"), 1.0),
            follows("back", driver("x"), -1.0),
            follows("echo", Input::Shape("half".to_owned()), 0.25),
            ShapeRule {
                shape: "both".to_owned(),
                rule: Rule::Product(vec![Input::Shape("full".to_owned()), driver("y"), driver("y")]),
            },
            ShapeRule { shape: "none".to_owned(), rule: Rule::Product(Vec::new()) },
        ];
        let shapes = ["both", "y", "half", "full", "back", "echo", "none", "free"];
        let drivers = ShapeDrivers::new(&["x", "y"], &shapes, &rules).unwrap();
        let mut random = Random(seed);
        let values: Vec<_> =
            (0..2 * blocks).map(|_| Lanes(std::array::from_fn(|_| number(&mut random)))).collect();
        let mut weights = vec![Lanes::splat(f32::NAN); shapes.len() * blocks];
        drivers.run_crowd(blocks, &values, &mut weights).unwrap();
        for (values, weights) in values.chunks(2).zip(weights.chunks(shapes.len())) {
            for lane in 0..LANES {
                let mut single = [f32::NAN; 8];
                drivers.run(&column(values, lane), &mut single).unwrap();
                prop_assert_eq!(bits(&single), bits(&column(weights, lane)));
            }
        }
    }

    #[test]
    fn expressions_are_those_of_single_faces(seed in any::<u64>()) {
        let mut random = Random(seed);
        let expressions: Vec<_> = (0..5)
            .map(|_| Expression {
                is_binary: random.below(3) == 0,
                group: Group::ALL.get(random.below(4)).copied(),
                overrides: [(); 3].map(|()| {
                    [Override::None, Override::Block, Override::Blend][random.below(3)]
                }),
                // Some beyond the weights.
                binds: (0..random.below(4)).map(|_| (random.below(5), number(&mut random))).collect(),
            })
            .collect();
        // The last expression has no value.
        let mut values = [(); 4].map(|()| Lanes(std::array::from_fn(|_| number(&mut random))));
        values[0][3] = f32::NAN;
        let before = [(); 4].map(|()| Lanes(std::array::from_fn(|_| number(&mut random))));
        let mut weights = before;
        add_lanes(&expressions, &values, &mut weights);
        for lane in 0..LANES {
            let mut single = column(&before, lane);
            add(&expressions, &column(&values, lane), &mut single);
            prop_assert_eq!(bits(&single), bits(&column(&weights, lane)));
        }
    }
}

#[test]
fn blocks_that_are_not_there() {
    let drivers = ShapeDrivers::new(&["x"], &["x"], &[]).unwrap();
    let mut weights = [Lanes::splat(7.0); 2];
    let error = drivers.run_crowd(2, &[Lanes::splat(1.0)], &mut weights).unwrap_err();
    assert_eq!(error, LengthError { what: "blocks of driver values", expected: 2, found: 1 });
    let error = drivers.run_crowd(1, &[Lanes::splat(1.0)], &mut weights).unwrap_err();
    assert_eq!(error, LengthError { what: "blocks of weights", expected: 1, found: 2 });
    assert_eq!(weights, [Lanes::splat(7.0); 2]);
    assert!(drivers.run_crowd(usize::MAX, &[], &mut []).is_err());
}
