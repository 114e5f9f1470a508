//! Where everything hangs still.

use crate::scene::{LENGTH, PARENTS, animated, chain, end};
use glam::{Affine3A, Vec3};
use joint_springs::{Collider, Law, Shape, Spring, Swing};

const VRM: Law = Law::Vrm { stiffness: 0.6, drag: 0.25, gravity: Vec3::new(0.1, -0.4, 0.0) };
const OSCILLATOR: Law =
    Law::Oscillator { frequency_hz: 1.6, damping_ratio: 0.25, gravity: Vec3::new(2.0, -1.0, 0.0) };

/// A joint of VRM comes to rest where the forces pull: along stiffness times its own axis plus gravity.
#[test]
fn joints_of_vrm_settle_along_the_sum_of_forces() {
    // Whatever the drag is; without any, and without the extra one, it would swing for ever.
    for drag in [0.0, 0.4, 1.0] {
        let law = Law::Vrm { stiffness: 0.6, drag, gravity: Vec3::new(0.3, -0.2, 0.1) };
        let spring = Spring::new(1, Vec3::X * LENGTH, law);
        let mut swing = Swing::new(&PARENTS[..2], vec![spring], vec![]).unwrap();
        let mut world = [Affine3A::IDENTITY, Affine3A::from_translation(Vec3::new(0.5, 1.5, 0.0))];
        swing.settle(&mut world).unwrap();
        let expected = (Vec3::X * 0.6 + Vec3::new(0.3, -0.2, 0.1)).normalize_or_zero();
        let found = world[1].transform_vector3(Vec3::X);
        assert!((found - expected).length() < 1e-3, "drag {drag}: {found} for {expected}");
        assert!(swing.is_at_rest());
    }
}

/// Settled is where a long time would bring everything, and from there nothing moves.
#[test]
fn settled_is_what_a_long_time_brings() {
    let colliders = vec![Collider {
        joint: 0,
        shape: Shape::Sphere { offset: Vec3::new(0.12, -0.12, 0.0), radius: 0.06, inside: false },
    }];
    for law in [VRM, OSCILLATOR] {
        for hits in [vec![], vec![0]] {
            let springs: Vec<_> =
                chain(law).into_iter().map(|spring| Spring { colliders: hits.clone(), ..spring }).collect();
            let mut swing = Swing::new(&PARENTS, springs, colliders.clone()).unwrap();
            let mut long = animated(0.3);
            swing.advance(0.0, &mut long).unwrap();
            for _ in 0..1200 {
                long = animated(0.3);
                swing.advance(1.0 / 60.0, &mut long).unwrap();
            }
            let mut settled = animated(0.3);
            swing.settle(&mut settled).unwrap();
            let off = (end(&settled) - end(&long)).length();
            assert!(off < 2e-3 * LENGTH, "{law:?} is {off} off");
            let moved = (end(&settled) - end(&animated(0.3))).length();
            assert!(moved > 0.1 * LENGTH, "{law:?} hangs by {moved} only");
            let mut later = animated(0.3);
            swing.advance(0.7, &mut later).unwrap();
            assert!((end(&settled) - end(&later)).length() < 1e-3 * LENGTH, "{law:?} goes on");
        }
    }
}

#[test]
fn rest_is_told_from_motion() {
    for law in [VRM, OSCILLATOR] {
        let mut swing = Swing::new(&PARENTS, chain(law), vec![]).unwrap();
        swing.settle(&mut animated(0.0)).unwrap();
        assert!(swing.is_at_rest());
        let frames = |swing: &mut Swing, count: u32, time: &dyn Fn(u32) -> f64| {
            for frame in 1..=count {
                swing.advance(1.0 / 60.0, &mut animated(time(frame))).unwrap();
            }
        };
        frames(&mut swing, 60, &|frame| f64::from(frame) / 60.0);
        assert!(!swing.is_at_rest(), "{law:?}: the head moves");
        // The head stands, the chain swings on, and then stands as well.
        frames(&mut swing, 15, &|_| 1.0);
        assert!(!swing.is_at_rest(), "{law:?}: it swings on");
        frames(&mut swing, 1200, &|_| 1.0);
        assert!(swing.is_at_rest(), "{law:?}: it has swung out");
        swing.reset();
        assert!(!swing.is_at_rest(), "where it rests is not known yet");
    }
    assert!(Swing::new(&PARENTS, vec![], vec![]).unwrap().is_at_rest());
}

#[test]
fn what_cannot_settle_stays_as_it_is() {
    let mut swing = Swing::new(&PARENTS, chain(VRM), vec![]).unwrap();
    let mut world = animated(0.0);
    world[2].translation.x = f32::NAN;
    let before = world[1];
    swing.settle(&mut world).unwrap();
    assert_eq!(world[1], before);
    assert!(swing.settle(&mut world[..3]).is_err());
}
