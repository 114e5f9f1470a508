//! The same at every frame rate.

use crate::common::Random;
use crate::face::full;
use avatar_life::{Life, Style, Target};

/// Five minutes with a change every five seconds; values before each of the next ones.
fn values(steps: &mut dyn FnMut() -> f64) -> Vec<f64> {
    let controls = full();
    let mut life = Life::new(&controls, Style::preset("lively").unwrap(), 21);
    let mut all = Vec::new();
    for change in 0..60u32 {
        let side = f64::from(change % 7) / 7.0 - 0.5;
        match change % 6 {
            0 => {
                life.attend(0, Some(Target { velocity: [0.02, 0.0, 0.0], ..Target::face([side, 0.0, 1.0]) }))
            }
            1 => life
                .attend(1, Some(Target { velocity: [0.0, 0.01, 0.03], ..Target::point([side, 0.1, 0.7]) })),
            2 => life.set_style(Style::PRESETS[change as usize % 5]),
            3 => life.think(side.abs()),
            4 => life.set_light(1000.0 * side.abs()),
            _ => life.end_utterance(),
        }
        let mut left: f64 = 5.0;
        while left > 0.0 {
            let dt = steps().min(left);
            life.advance(dt).unwrap();
            left -= dt;
        }
        all.extend((0..controls.len()).map(|control| life.value(control, 0.0)));
        all.push(life.pupil_mm());
    }
    all
}

#[test]
fn all_frame_rates_agree() {
    let once = values(&mut || 5.0);
    assert!(once.iter().filter(|value| value.abs() > 0.01).count() > once.len() / 3);
    let mut random = Random(4);
    let mut steps: Vec<Box<dyn FnMut() -> f64>> =
        [24.0, 60.0, 144.0].map(|rate: f64| Box::new(move || 1.0 / rate) as Box<dyn FnMut() -> f64>).into();
    steps.push(Box::new(move || random.between(0.0005, 0.3)));
    for (which, mut steps) in steps.into_iter().enumerate() {
        let others = values(&mut *steps);
        assert_eq!(once.len(), others.len());
        for (one, other) in once.iter().zip(&others) {
            assert!((one - other).abs() < 1e-5, "{which}: {one} {other}");
        }
    }
}

/// The same seed is the same face; another one is another.
#[test]
fn seeds_decide() {
    let at = |seed: u64| {
        let controls = full();
        let mut life = Life::new(&controls, Style::default(), seed);
        life.advance(7.3).unwrap();
        (0..controls.len()).map(|control| life.value(control, 0.0)).collect::<Vec<_>>()
    };
    assert_eq!(at(1), at(1));
    let different = at(1).iter().zip(at(2)).filter(|(one, other)| (*one - other).abs() > 1e-3).count();
    assert!(different > 8, "{different}");
}

#[test]
fn wrong_steps_and_lengths_change_nothing() {
    let controls = full();
    let mut life = Life::new(&controls, Style::default(), 1);
    life.advance(3.0).unwrap();
    let before = life.clone();
    for dt in [-0.1, f64::NAN, f64::INFINITY, 1e9] {
        let error = life.advance(dt).unwrap_err();
        assert_eq!(error.to_string(), format!("expected a step of 0 to 86,400 seconds, found {dt}"));
    }
    let mut short = [9.0; 3];
    let error = life.apply(&controls.defaults(), &mut short).unwrap_err();
    assert_eq!(error.to_string(), "expected 22 values to be written, found 3");
    assert!(life.apply(&short, &mut controls.defaults()).is_err());
    assert_eq!((short, life.value(0, 0.0)), ([9.0; 3], before.value(0, 0.0)));
    // Numbers that mean nothing are passed over.
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        life.attend(0, Some(Target { position: [odd; 3], ..Target::point([0.0; 3]) }));
        life.attend(1, Some(Target { weight: odd, size: odd, ..Target::point([0.0; 3]) }));
        life.attend(99, Some(Target::point([0.0; 3])));
        life.think(odd);
        life.set_light(odd);
        life.set_interest(odd);
        let style = Style::default();
        life.set_style(Style { blinks_per_min: odd, fixation_secs: odd, breaths_per_min: odd, ..style });
        life.set_style(Style {
            contact: odd,
            glance_degrees: odd,
            head_share: odd,
            sway_degrees: odd,
            ..style
        });
        life.set_style(Style { droop: odd, breath_depth: odd, blink_slowness: odd, ..style });
        life.advance(20.0).unwrap();
        for control in 0..controls.len() {
            assert!(life.value(control, 0.0).is_finite(), "{odd} {control}");
        }
    }
}
