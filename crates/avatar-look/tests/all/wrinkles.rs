//! Places of wrinkles: how strongly shapes bring them in, and where.

use avatar_look::Wrinkle;
use glam::Vec3;

fn wrinkle() -> Wrinkle {
    Wrinkle { center: Vec3::new(1.0, 2.0, 3.0), radius: 3.0, shapes: vec![(2, 0.5), (0, 1.0), (9, 4.0)] }
}

#[test]
fn weights_are_sums_between_nothing_and_all() {
    for (weights, expected) in [
        (&[][..], 0.0),
        (&[0.0, 1.0, 0.0][..], 0.0),
        (&[0.0, 0.0, 0.5][..], 0.25),
        (&[0.25, 0.0, 0.5][..], 0.5),
        (&[0.9, 0.0, 0.9][..], 1.0),
        (&[-1.0, 0.0, 1.0][..], 0.0),
        (&[f32::NAN, 0.0, 1.0][..], 0.0),
    ] {
        assert_eq!(wrinkle().weight(weights), expected, "{weights:?}");
    }
}

#[test]
fn a_place_is_whole_in_its_middle_and_gone_at_its_radius() {
    let at = |distance: f32| wrinkle().reach(wrinkle().center + Vec3::Y * distance);
    assert_eq!((at(0.0), at(0.99), at(3.0), at(40.0)), (1.0, 1.0, 0.0, 0.0));
    // Half-way between a third of the radius and all of it the smooth step is at its middle.
    assert!((at(2.0) - 0.5).abs() < 1e-5);
    let along: Vec<f32> = (0..40).map(|k| at(0.1 * k as f32)).collect();
    assert!(along.is_sorted_by(|near, far| near >= far), "{along:?}");
}
