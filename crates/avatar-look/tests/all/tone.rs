//! Tone mappers against a chart that `make_tone_chart.py` computes in double precision, and their promises.

use avatar_look::ToneMap;
use avatar_look::tone::{agx, agx_curve, neutral};
use proptest::prelude::*;

/// Light, and what Neutral and AgX make of it.
fn chart() -> impl Iterator<Item = [[f32; 3]; 3]> {
    include_str!("../tone_chart.csv").lines().skip(1).map(|line| {
        let numbers: Vec<f32> = line.split(',').map_while(|number| number.parse().ok()).collect();
        assert_eq!(numbers.len(), 9, "{line}");
        [0, 3, 6].map(|i| [numbers[i], numbers[i + 1], numbers[i + 2]])
    })
}

#[test]
fn the_chart_comes_out_as_computed_elsewhere() {
    assert_eq!(chart().count(), 32 * 9);
    for [light, by_neutral, by_agx] in chart() {
        approx::assert_abs_diff_eq!(neutral(light)[..], by_neutral[..], epsilon = 2e-6);
        approx::assert_abs_diff_eq!(agx(light)[..], by_agx[..], epsilon = 1e-5);
        assert_eq!(ToneMap::Neutral.apply(light), neutral(light));
        assert_eq!(ToneMap::AgX.apply(light), agx(light));
        assert_eq!(ToneMap::Linear.apply(light), light);
    }
}

#[test]
fn agx_is_near_its_published_polynomials() {
    // B. Wrensch, "Minimal AgX Implementation", 2023: fits of degree 6 and 7. Their coefficients are
    // published with four digits, and cancel: at white that costs the better fit 0.018.
    let sixth = [-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5];
    let seventh = [0.002857, -0.1718, 4.361, -28.72, 92.06, -126.7, 78.01, -17.86];
    for (fit, most, mean_square) in [(&sixth[..], 0.006, 8e-6), (&seventh[..], 0.0185, 3.2e-5f32)] {
        let steps = 1000;
        let mut square = 0.0;
        for i in 0..=steps {
            let x = i as f32 / steps as f32;
            let error = agx_curve(x) - fit.iter().rev().fold(0.0, |sum, factor| sum * x + factor);
            assert!(error.abs() < most, "{error} at {x}");
            square += error * error;
        }
        assert!(square / (steps as f32) < mean_square, "{}", square / steps as f32);
    }
}

#[test]
fn agx_runs_from_black_over_grey_to_white() {
    approx::assert_abs_diff_eq!(agx_curve(0.0), 0.0, epsilon = 1e-6);
    approx::assert_abs_diff_eq!(agx_curve(20.0 / 33.0), 0.5, epsilon = 1e-6);
    approx::assert_abs_diff_eq!(agx_curve(1.0), 1.0, epsilon = 1e-6);
    approx::assert_abs_diff_eq!(agx([0.18; 3])[1], 0.5f32.powf(2.2), epsilon = 1e-5);
}

#[test]
fn neutral_keeps_colours_that_are_not_bright() {
    // A base colour, and what a dielectric adds to it.
    for color in [[0.6, 0.36, 0.26], [0.1, 0.2, 0.3], [0.72, 0.04, 0.5f32]] {
        approx::assert_abs_diff_eq!(neutral(color.map(|c| c + 0.04))[..], color[..], epsilon = 1e-6);
    }
}

proptest! {
    #[test]
    fn any_light_becomes_a_colour(light in prop::array::uniform3(-1.0f32..1e6)) {
        for mapped in [neutral(light), agx(light)] {
            prop_assert!(mapped.iter().all(|c| (0.0..=1.0).contains(c)), "{mapped:?}");
        }
    }

    #[test]
    fn grey_stays_grey_and_brighter_stays_brighter(light in 0.0f32..20.0, more in 0.01f32..1.0) {
        for map in [neutral, agx] {
            let (dark, bright) = (map([light; 3]), map([light + more; 3]));
            prop_assert!((dark[0] - dark[1]).abs() < 1e-5 && (dark[1] - dark[2]).abs() < 1e-5);
            prop_assert!(bright[0] >= dark[0]);
        }
    }
}
