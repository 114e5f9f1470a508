//! Transition functions against the numbers of d3-ease and against their own derivatives.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests read files and fail by panicking")]

use pose_anim::{Direction, Easing, Family};
use std::path::Path;

#[test]
fn the_numbers_of_d3_ease_are_met() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/easing-d3/d3-ease-expected.csv");
    let Ok(text) = std::fs::read_to_string(&path) else {
        let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!required, "expected data in {} (MIMIK_REQUIRE_DATA=1), found none", path.display());
        // Past the harness, which keeps the output of tests that pass to itself.
        let skipped = format_args!("SKIPPED: {} is not there\n", path.display());
        let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
        return;
    };
    let mut rows = 0;
    for line in text.lines().skip(1) {
        let [function, s, expected] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let (s, expected): (f64, f64) = (s.parse().unwrap(), expected.parse().unwrap());
        let family = match function.trim_start_matches("ease").trim_end_matches("In") {
            "Back" => Family::Back,
            "Bounce" => Family::Bounce,
            "Circle" => Family::Circ,
            "Cubic" | "Poly" => Family::Cubic,
            "Elastic" => Family::Elastic,
            "Exp" => Family::Expo,
            "Linear" => {
                assert_eq!(Easing::Linear.at(s).value, expected);
                continue;
            }
            "Quad" => Family::Quad,
            "Sin" => Family::Sine,
            other => panic!("{other}"),
        };
        let at = |direction, s: f64| Easing::Family(family, direction).at(s).value;
        assert!((at(Direction::In, s) - expected).abs() < 1e-6, "{line}: {}", at(Direction::In, s));
        assert!((at(Direction::Out, 1.0 - s) - (1.0 - expected)).abs() < 1e-6, "{line}");
        assert!((at(Direction::InOut, 0.5 * s) - 0.5 * expected).abs() < 1e-6, "{line}");
        assert!((at(Direction::InOut, 1.0 - 0.5 * s) - (1.0 - 0.5 * expected)).abs() < 1e-6, "{line}");
        rows += 1;
    }
    assert!(rows > 90);
}

#[test]
fn polynomials_by_hand() {
    for (name, power) in [("quad", 2), ("cubic", 3), ("quart", 4), ("quint", 5)] {
        for step in 0..=10 {
            let s = f64::from(step) / 10.0;
            let at = |direction: &str| Easing::from_name(&format!("{name}-{direction}")).unwrap().at(s).value;
            assert!((at("in") - s.powi(power)).abs() < 1e-15);
            assert!((at("out") - (1.0 - (1.0 - s).powi(power))).abs() < 1e-15);
        }
    }
}

#[test]
fn all_start_at_0_end_at_1_and_have_their_derivatives() {
    for name in Easing::names() {
        let easing = Easing::from_name(&name).unwrap();
        assert!(easing.at(0.0).value.abs() < 1e-12 && (easing.at(1.0).value - 1.0).abs() < 1e-12, "{name}");
        assert_eq!((easing.at(-3.0), easing.at(7.0)), (easing.at(0.0), easing.at(1.0)), "{name}");
        for step in 0..200 {
            // Irrational enough not to meet the corners of bounces and halves.
            let (s, h) = ((f64::from(step) + 0.2741) / 200.0, 1e-6);
            let (before, here, after) = (easing.at(s - h), easing.at(s), easing.at(s + h));
            let slope = (after.value - before.value) / (2.0 * h);
            let curve = (after.velocity - before.velocity) / (2.0 * h);
            assert!(
                (slope - here.velocity).abs() < 1e-5 * (1.0 + slope.abs()),
                "{name} {s}: {slope} {here:?}"
            );
            assert!(
                (curve - here.acceleration).abs() < 1e-4 * (1.0 + curve.abs()),
                "{name} {s}: {curve} {here:?}"
            );
            let mirrored = 1.0 - easing.reversed().at(1.0 - s).value;
            assert!((mirrored - here.value).abs() < 1e-12, "{name}");
        }
    }
    assert_eq!(Easing::from_name("quad"), None);
    assert_eq!(Easing::from_name("quad-up"), None);
}

/// Reference values of the CSS curves, by bisection of the curve's x in a program of its own.
#[test]
fn bezier_curves() {
    let rows =
        [("ease", 0.5, 0.802_403_387), ("ease-in", 0.5, 0.315_356_813), ("ease-in-out", 0.25, 0.129_161_931)];
    for (name, s, expected) in rows {
        assert!((Easing::from_name(name).unwrap().at(s).value - expected).abs() < 1e-6, "{name}");
    }
    // A straight line, and handles that stand upright at their ends.
    assert!((Easing::Bezier([1.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]).at(0.3).value - 0.3).abs() < 1e-15);
    for handles in [[0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 1.0], [-5.0, 2.0, 9.0, -2.0]]
    {
        for step in 0..=1000 {
            let jet = Easing::Bezier(handles).at(f64::from(step) / 1000.0);
            assert!(jet.value.is_finite() && jet.velocity.is_finite() && jet.acceleration.is_finite());
        }
    }
}
