//! Keys in time: the weights between them, and edits.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::sequence::{Between, Sequence, SequenceError, SequenceKey};
use avatar_mesh::{Mesh, ShapeNormals, blend};
use glam::Vec3;
use pose_anim::Easing;
use proptest::prelude::*;

fn linear(s: f32) -> f32 {
    s
}

fn easing(easing: Easing) -> impl Fn(f32) -> f32 {
    move |s| easing.at(s.into()).value as f32
}

/// Keys at different eighths of a second, in any order.
fn sequence(random: &mut Random, keys: usize, vertices: usize) -> Sequence {
    let mut times: Vec<f64> = (0..3 * keys).map(|eighth| eighth as f64 / 8.0 - 1.0).collect();
    let key = |random: &mut Random, times: &mut Vec<f64>| SequenceKey {
        time_secs: times.swap_remove(random.below(times.len())),
        positions: (0..vertices).map(|_| random.vec3(10.0)).collect(),
    };
    Sequence::new((0..keys).map(|_| key(random, &mut times)).collect()).unwrap()
}

fn at(sequence: &Sequence, time: f64, f: impl Fn(f32) -> f32) -> Vec<Vec3> {
    let mut out = vec![Vec3::NAN; sequence.vertex_count()];
    sequence.positions(time, f, &mut out).unwrap();
    out
}

fn furthest(a: &[Vec3], b: &[Vec3]) -> f32 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

proptest! {
    /// With every function that pose-anim knows.
    #[test]
    fn weights_come_from_the_progress(seed in any::<u64>(), keys in 2..6usize, u in 0.0..1.0f64, span in any::<prop::sample::Index>()) {
        let mut random = Random(seed);
        let sequence = sequence(&mut random, keys, 4);
        let a = span.index(keys - 1);
        let (ka, kb) = (&sequence.keys()[a], &sequence.keys()[a + 1]);
        prop_assert!(ka.time_secs < kb.time_secs);
        let time = ka.time_secs + u * (kb.time_secs - ka.time_secs);
        prop_assume!(time < kb.time_secs);
        for name in Easing::names() {
            let f = easing(Easing::from_name(&name).unwrap());
            let found = sequence.between(time, &f).unwrap();
            let s = ((time - ka.time_secs) / (kb.time_secs - ka.time_secs)) as f32;
            prop_assert_eq!(found, Between { a, b: a + 1, weight_a: 1.0 - f(s), weight_b: f(s) });
            let mut weights = vec![f32::NAN; keys];
            sequence.weights(time, &f, &mut weights).unwrap();
            prop_assert_eq!((weights[a], weights[a + 1]), (1.0 - f(s), f(s)));
            prop_assert_eq!(weights.iter().filter(|w| **w != 0.0).count(), [1.0 - f(s), f(s)].iter().filter(|w| **w != 0.0).count());
            for (vertex, found) in at(&sequence, time, &f).iter().enumerate() {
                let expected = ka.positions[vertex].as_dvec3().lerp(kb.positions[vertex].as_dvec3(), f(s).into());
                // Weights up to 2, coordinates up to 10: three roundings of at most 30.
                prop_assert!(found.as_dvec3().distance(expected) < 1e-5, "{name}");
            }
        }
    }

    #[test]
    fn keys_stand_where_they_are_and_nothing_moves_outside(seed in any::<u64>(), keys in 1..6usize) {
        let sequence = sequence(&mut Random(seed), keys, 3);
        for name in Easing::names() {
            let f = easing(Easing::from_name(&name).unwrap());
            for key in sequence.keys() {
                prop_assert_eq!(&at(&sequence, key.time_secs, &f), &key.positions);
            }
            let (first, last) = (&sequence.keys()[0], &sequence.keys()[keys - 1]);
            for early in [first.time_secs - 0.1, f64::NEG_INFINITY, f64::NAN] {
                prop_assert_eq!(&at(&sequence, early, &f), &first.positions);
            }
            for late in [last.time_secs + 0.1, f64::INFINITY] {
                prop_assert_eq!(&at(&sequence, late, &f), &last.positions);
            }
        }
    }

    #[test]
    fn baking_between_straight_keys_changes_no_motion(seed in any::<u64>(), bake in -0.9..1.0f64, times in prop::collection::vec(-2.0..3.0f64, 10)) {
        let before = sequence(&mut Random(seed), 5, 3);
        let mut after = before.clone();
        prop_assume!(before.keys().iter().all(|key| key.time_secs != bake));
        let place = after.bake(bake, linear).unwrap();
        prop_assert_eq!(after.keys()[place].time_secs, bake);
        prop_assert_eq!(after.keys().len(), 6);
        for time in times {
            prop_assert!(furthest(&at(&before, time, linear), &at(&after, time, linear)) < 2e-5);
        }
        prop_assert_eq!(after.bake(bake, linear), Err(SequenceError::SameTime { time_secs: bake }));
        after.delete(place).unwrap();
        prop_assert_eq!(after, before);
    }

    #[test]
    fn a_baked_key_is_what_the_function_made_there(seed in any::<u64>(), bake in -0.9..1.0f64) {
        let mut sequence = sequence(&mut Random(seed), 5, 3);
        prop_assume!(sequence.keys().iter().all(|key| key.time_secs != bake));
        let f = easing(Easing::from_name("elastic-out").unwrap());
        let before = at(&sequence, bake, &f);
        let place = sequence.bake(bake, &f).unwrap();
        prop_assert_eq!(&sequence.keys()[place].positions, &before);
    }

    #[test]
    fn edits_keep_order_and_unique_times(seed in any::<u64>(), edits in 0..40usize) {
        let mut random = Random(seed);
        let mut sequence = sequence(&mut random, 4, 2);
        for _ in 0..edits {
            let (key, time) = (random.below(8), random.below(24) as f64 / 8.0 - 1.0);
            let before = sequence.clone();
            let taken = |but: Option<usize>| {
                before.keys().iter().enumerate().any(|(k, other)| Some(k) != but && other.time_secs == time)
            };
            match random.below(3) {
                0 => {
                    let positions = vec![random.vec3(1.0); before.vertex_count()];
                    let new = SequenceKey { time_secs: time, positions };
                    match sequence.insert(new.clone()) {
                        Ok(place) => prop_assert_eq!(&sequence.keys()[place], &new),
                        error => {
                            prop_assert_eq!(error, Err(SequenceError::SameTime { time_secs: time }));
                            prop_assert!(taken(None) && sequence == before);
                        }
                    }
                }
                1 => match sequence.move_to(key, time) {
                    Ok(place) => {
                        prop_assert_eq!(sequence.keys()[place].time_secs, time);
                        prop_assert_eq!(&sequence.keys()[place].positions, &before.keys()[key].positions);
                    }
                    error => {
                        let missing = SequenceError::NoKey { keys: before.keys().len(), found: key };
                        let expected = if key >= before.keys().len() { missing } else { SequenceError::SameTime { time_secs: time } };
                        prop_assert_eq!(error, Err(expected));
                        prop_assert!(sequence == before && (key >= before.keys().len() || taken(Some(key))));
                    }
                },
                _ => match sequence.delete(key) {
                    Ok(gone) => prop_assert_eq!(&gone, &before.keys()[key]),
                    error => prop_assert_eq!(error, Err(SequenceError::NoKey { keys: before.keys().len(), found: key })),
                },
            }
            prop_assert!(sequence.keys().windows(2).all(|two| two[0].time_secs < two[1].time_secs));
        }
    }

    #[test]
    fn as_shapes_of_any_base_a_sequence_is_the_same(seed in any::<u64>(), time in -2.0..3.0f64) {
        let mut random = Random(seed);
        let sequence = sequence(&mut random, 4, 6);
        let mut mesh = random.mesh(6, 0, 1);
        mesh.shapes = sequence.shapes(&mesh.positions, |k| format!("frame {k}")).unwrap();
        let f = easing(Easing::from_name("back-in-out").unwrap());
        let mut weights = [0.0; 4];
        sequence.weights(time, &f, &mut weights).unwrap();
        let mut out = mesh.deformed();
        blend(&mesh, &weights, ShapeNormals::Given, &mut out).unwrap();
        // Coordinates up to 25 and weights up to 1.1: five roundings of 32.
        prop_assert!(furthest(&out.positions, &at(&sequence, time, &f)) < 2e-5);
        let other = Mesh::default();
        prop_assert!(sequence.shapes(&other.positions, |k| k.to_string()).is_err());
    }
}

#[test]
fn what_is_no_sequence_is_an_error_with_both_numbers() {
    let key = |time_secs, vertices| SequenceKey { time_secs, positions: vec![Vec3::ONE; vertices] };
    let text = |keys: &[SequenceKey]| Sequence::new(keys.to_vec()).unwrap_err().to_string();
    assert_eq!(text(&[key(0.0, 3), key(1.0, 2)]), "expected 3 vertices, found 2");
    assert_eq!(text(&[key(1.0, 3), key(0.5, 3), key(1.0, 3)]), "expected each time once, found 1 s again");
    assert_eq!(text(&[key(0.0, 3), key(-0.0, 3)]), "expected each time once, found 0 s again");
    assert_eq!(text(&[key(f64::INFINITY, 3)]), "expected a time in seconds, found inf");
    let mut two = Sequence::new(vec![key(2.0, 3), key(1.0, 3)]).unwrap();
    assert!(matches!(two.move_to(0, f64::NAN), Err(SequenceError::Time { .. })));
    assert_eq!(two.insert(key(3.0, 4)), Err(SequenceError::VertexCount { expected: 3, found: 4 }));
    assert_eq!(two.move_to(0, 5.0), Ok(1));
    // To where it is.
    assert_eq!(two.move_to(1, 5.0), Ok(1));
    assert_eq!(two.delete(2), Err(SequenceError::NoKey { keys: 2, found: 2 }));
    let short = two.weights(1.5, linear, &mut [0.0; 3]);
    assert_eq!(short, Err(SequenceError::WeightCount { expected: 2, found: 3 }));
    let room = two.positions(1.5, linear, &mut [Vec3::ZERO; 2]);
    assert_eq!(room, Err(SequenceError::VertexCount { expected: 3, found: 2 }));

    let mut none = Sequence::default();
    assert_eq!(none.between(0.0, linear), None);
    assert_eq!(none.positions(0.0, linear, &mut []), Ok(()));
    assert_eq!(none.insert(key(0.0, 7)), Ok(0));
    // The first key says how many vertices there are.
    assert_eq!(none.vertex_count(), 7);

    let frames =
        |interval| Sequence::from_frames(interval, vec![vec![Vec3::X], vec![Vec3::Y], vec![Vec3::Z]]);
    let times: Vec<f64> = frames(0.5).unwrap().keys().iter().map(|key| key.time_secs).collect();
    assert_eq!(times, [0.0, 0.5, 1.0]);
    assert_eq!(frames(0.0), Err(SequenceError::SameTime { time_secs: 0.0 }));
    assert!(frames(f64::NAN).is_err());
    // The furthest and the nearest times there are.
    for (a, b) in [(f64::MIN, f64::MAX), (0.0, f64::from_bits(1))] {
        let two = Sequence::new(vec![key(a, 1), key(b, 1)]).unwrap();
        for time in [a, b, 0.0] {
            assert_eq!(at(&two, time, linear), [Vec3::ONE]);
        }
    }
}
