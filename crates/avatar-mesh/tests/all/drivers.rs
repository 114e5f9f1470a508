//! In-between shapes, combinations, and rules that cannot be followed.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::drivers::{DriversError, Input, LengthError, Rule, ShapeDrivers, ShapeRule};
use proptest::prelude::*;

fn driver(name: &str) -> Input {
    Input::Driver(name.to_owned())
}

fn shape(name: &str) -> Input {
    Input::Shape(name.to_owned())
}

fn follows(of: &str, input: Input, full_weight: f32) -> ShapeRule {
    ShapeRule { shape: of.to_owned(), rule: Rule::Follows { input, full_weight } }
}

fn product(of: &str, inputs: &[Input]) -> ShapeRule {
    ShapeRule { shape: of.to_owned(), rule: Rule::Product(inputs.to_vec()) }
}

fn run(drivers: &ShapeDrivers, values: &[f32], shapes: usize) -> Vec<f32> {
    let mut weights = vec![f32::NAN; shapes];
    drivers.run(values, &mut weights).unwrap();
    weights
}

/// Shapes named by their order that follow one driver at these values.
fn channel(full_weights: &[f32]) -> Result<ShapeDrivers, DriversError> {
    let names: Vec<String> = (0..full_weights.len()).map(|k| k.to_string()).collect();
    let rules: Vec<ShapeRule> =
        names.iter().zip(full_weights).map(|(name, at)| follows(name, driver("x"), *at)).collect();
    ShapeDrivers::new(&["x".to_owned()], &names, &rules)
}

proptest! {
    /// Against linear interpolation in a table of points, beyond its ends as well.
    #[test]
    fn in_betweens_are_piecewise_linear(
        eighths in prop::collection::btree_set(-12..=16i32, 1..7), seed in any::<u64>(), x in -3.0..3.0f32,
    ) {
        let mut full: Vec<f32> = eighths.into_iter().filter(|e| *e != 0).map(|e| e as f32 / 8.0).collect();
        let mut random = Random(seed);
        for i in (1..full.len()).rev() {
            full.swap(i, random.below(i + 1));
        }
        let drivers = channel(&full).unwrap();
        // Each stands alone at its value, and at 0 there is the base only.
        for (k, at) in full.iter().enumerate() {
            let expected: Vec<f32> = (0..full.len()).map(|other| if other == k { 1.0 } else { 0.0 }).collect();
            prop_assert_eq!(run(&drivers, &[*at], full.len()), expected);
        }
        prop_assert_eq!(run(&drivers, &[0.0], full.len()), vec![0.0; full.len()]);
        let mut table: Vec<f32> = full.iter().copied().chain([0.0]).collect();
        table.sort_by(f32::total_cmp);
        if table.len() > 1 {
            let span = table[1..table.len() - 1].iter().filter(|at| **at <= x).count();
            let (a, b) = (table[span], table[span + 1]);
            let u = (x - a) / (b - a);
            for (at, found) in full.iter().zip(run(&drivers, &[x], full.len())) {
                let expected = if *at == a { 1.0 - u } else if *at == b { u } else { 0.0 };
                prop_assert!((found - expected).abs() <= 1e-6 * (1.0 + u.abs()), "{} of {:?} at {}: {}", at, table, x, found);
            }
        }
    }

    #[test]
    fn in_betweens_never_jump(eighths in prop::collection::btree_set(1..=16i32, 1..7), x in -1.0..3.0f32) {
        let full: Vec<f32> = eighths.into_iter().map(|e| e as f32 / 8.0).collect();
        let drivers = channel(&full).unwrap();
        let (a, b) = (run(&drivers, &[x], full.len()), run(&drivers, &[x + 1e-4], full.len()));
        // An eighth is the narrowest span: a slope of 8.
        prop_assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 8.0 * 1e-4 + 1e-5), "{:?} {:?}", a, b);
    }

    #[test]
    fn products_multiply_whatever_the_order_of_rules(seed in any::<u64>(), x in -1.0..2.0f32, y in -1.0..2.0f32) {
        let mut random = Random(seed);
        let mut rules = vec![
            follows("a", driver("x"), 0.5),
            product("ab", &[shape("a"), driver("y")]),
            product("aba", &[shape("ab"), shape("a")]),
            product("always", &[]),
            follows("late", shape("aba"), 2.0),
        ];
        for i in (1..rules.len()).rev() {
            rules.swap(i, random.below(i + 1));
        }
        let names = ["late", "aba", "ab", "a", "always", "y", "rests"];
        let drivers = ShapeDrivers::new(&["x", "y"], &names, &rules).unwrap();
        let a = x / 0.5;
        prop_assert_eq!(run(&drivers, &[x, y], 7), vec![a * y * a / 2.0, a * y * a, a * y, a, 1.0, y, 0.0]);
    }
}

#[test]
fn shapes_that_depend_on_themselves_are_an_error_with_their_names() {
    let names = ["a", "b", "c", "d"];
    let cycle = |rules: &[ShapeRule]| match ShapeDrivers::new(&["x"], &names, rules) {
        Err(DriversError::Cycle { shapes }) => shapes,
        other => panic!("{other:?}"),
    };
    assert_eq!(cycle(&[product("b", &[driver("x"), shape("b")])]), ["b"]);
    let three = [
        product("a", &[driver("x"), shape("b")]),
        product("b", &[shape("c")]),
        follows("c", shape("d"), 1.0),
        product("d", &[shape("b")]),
    ];
    // a leads into the circle but is not of it.
    assert_eq!(cycle(&three), ["b", "c", "d"]);
    let error = ShapeDrivers::new(&["x"], &names, &three).unwrap_err();
    assert_eq!(error.to_string(), "expected shapes that do not depend on themselves, found b → c → d");
    // Two ways to one shape are no circle.
    let diamond = [
        product("a", &[shape("b"), shape("c")]),
        product("b", &[shape("d")]),
        product("c", &[shape("d")]),
        follows("d", driver("x"), 1.0),
    ];
    let drivers = ShapeDrivers::new(&["x"], &names, &diamond).unwrap();
    assert_eq!(run(&drivers, &[0.5], 4), [0.25, 0.5, 0.5, 0.5]);
}

#[test]
fn a_chain_of_a_hundred_thousand_shapes_is_no_deeper_than_the_heap() {
    let names: Vec<String> = (0..100_000).map(|k| k.to_string()).collect();
    let mut rules: Vec<ShapeRule> = names.windows(2).map(|two| product(&two[0], &[shape(&two[1])])).collect();
    rules.push(follows("99999", driver("x"), 1.0));
    let drivers = ShapeDrivers::new(&["x".to_owned()], &names, &rules).unwrap();
    assert_eq!(run(&drivers, &[0.75], names.len()), vec![0.75; names.len()]);
    *rules.last_mut().unwrap() = product("99999", &[shape("0")]);
    let Err(DriversError::Cycle { shapes }) = ShapeDrivers::new(&["x".to_owned()], &names, &rules) else {
        panic!("a circle")
    };
    assert_eq!(shapes.len(), names.len());
}

#[test]
fn every_wrong_rule_is_an_error_with_its_names() {
    let text = |rules: &[ShapeRule]| ShapeDrivers::new(&["x"], &["a", "b"], rules).unwrap_err().to_string();
    assert_eq!(
        text(&[follows("c", driver("x"), 1.0)]),
        "rule of shape \"c\": expected a shape of the mesh, found \"c\""
    );
    assert_eq!(
        text(&[product("a", &[shape("x")])]),
        "rule of shape \"a\": expected a shape of the mesh, found \"x\""
    );
    assert_eq!(
        text(&[follows("a", driver("b"), 1.0)]),
        "rule of shape \"a\": expected a driver, found \"b\""
    );
    let twice = [follows("a", driver("x"), 1.0), product("a", &[])];
    assert_eq!(text(&twice), "expected one rule for shape \"a\", found two");
    let same = [follows("a", driver("x"), 0.5), follows("b", driver("x"), 0.5)];
    assert_eq!(text(&same), "shapes \"a\" and \"b\": expected different full weights, found 0.5 twice");
    for bad in [0.0, -0.0, f32::NAN, f32::INFINITY] {
        let error = ShapeDrivers::new(&["x"], &["a", "b"], &[follows("a", driver("x"), bad)]).unwrap_err();
        assert!(matches!(error, DriversError::FullWeight { shape, .. } if shape == "a"));
    }
    // The same full weights of different inputs are the usual case.
    let two = [follows("a", driver("x"), 1.0), follows("b", shape("a"), 1.0)];
    let drivers = ShapeDrivers::new(&["x"], &["a", "b"], &two).unwrap();
    assert_eq!(run(&drivers, &[-0.5], 2), [-0.5; 2]);
    let lengths = |values: usize, weights: usize| drivers.run(&vec![0.0; values], &mut vec![0.0; weights]);
    assert_eq!(lengths(2, 2), Err(LengthError { what: "driver values", expected: 1, found: 2 }));
    assert_eq!(lengths(1, 0), Err(LengthError { what: "weights", expected: 2, found: 0 }));
    // Any number may come out of a driver.
    let odd = channel(&[f32::MAX, f32::MIN, f32::from_bits(1)]).unwrap();
    for x in [f32::NAN, f32::INFINITY, f32::MIN] {
        run(&odd, &[x], 3);
    }
}
