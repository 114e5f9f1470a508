use crate::scene::{PARENTS, animated, chain};
use glam::{Affine3A, Vec3};
use joint_springs::{
    Collider, Constraint, ConstraintKind, Constraints, Law, Shape, Spring, SpringError, Swing,
};
use proptest::prelude::*;

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![any::<f32>(), -2.0f32..2.0, Just(0.0), Just(f32::NAN), Just(f32::MAX), Just(-f32::INFINITY)]
}

fn vector() -> impl Strategy<Value = Vec3> {
    [number(), number(), number()].prop_map(Vec3::from)
}

proptest! {
    /// No numbers of springs, colliders and times make finite matrices infinite, or fail.
    #[test]
    fn nothing_breaks_springs(
        numbers in [number(), number(), number()],
        vectors in [vector(), vector(), vector()],
        vrm in any::<bool>(),
        steps in prop::collection::vec(prop_oneof![any::<f64>(), 0.0f64..0.1], 1..20),
        shape in 0..3u8,
        scale in number(),
    ) {
        let [a, b, c] = numbers;
        let [gravity, offset, tail] = vectors;
        let law = if vrm {
            Law::Vrm { stiffness: a, drag: b, gravity }
        } else {
            Law::Oscillator { frequency_hz: a, damping_ratio: b, gravity }
        };
        let shape = match shape {
            0 => Shape::Sphere { offset, radius: c, inside: vrm },
            1 => Shape::Capsule { offset, tail, radius: c, inside: vrm },
            _ => Shape::Plane { offset, normal: tail },
        };
        let springs = [Vec3::NEG_Y, tail, offset].into_iter().enumerate().map(|(at, tail)| {
            Spring { hit_radius: c, colliders: vec![0], center: (at == 1).then_some(3), ..Spring::new(at + 1, tail, law) }
        });
        let mut swing = Swing::new(&PARENTS, springs.collect(), vec![Collider { joint: 3, shape }]).unwrap();
        let mut time = 0.0;
        for step in steps {
            time += if step.is_finite() { step.abs() % 1.0 } else { 0.0 };
            let mut world = animated(time);
            world[2] *= Affine3A::from_scale(Vec3::splat(scale));
            let finite = world.iter().all(|matrix| matrix.is_finite());
            swing.advance(step, &mut world).unwrap();
            prop_assert_eq!(finite, world.iter().all(|matrix| matrix.is_finite()));
        }
    }

    /// Nor do constraints.
    #[test]
    fn nothing_breaks_constraints(weight in number(), axis in vector(), place in vector(), scale in number(), kind in 0..3u8) {
        let kind = [ConstraintKind::Roll { axis }, ConstraintKind::Aim { axis }, ConstraintKind::Rotation][usize::from(kind)];
        let list = [Constraint { joint: 2, source: 0, weight, kind }];
        let mut constraints = Constraints::new(&PARENTS, &animated(0.0), &list).unwrap();
        let mut world = animated(0.4);
        world[0].translation = place.into();
        world[1] *= Affine3A::from_scale(Vec3::splat(scale));
        let finite = world.each_ref().map(Affine3A::is_finite);
        constraints.apply(&mut world).unwrap();
        for (finite, world) in finite.into_iter().zip(world) {
            prop_assert!(!finite || world.is_finite());
        }
    }
}

/// A frame that is not finite passes, and the next ones start from rest.
#[test]
fn springs_recover_from_a_broken_frame() {
    let law = Law::Vrm { stiffness: 1.0, drag: 0.4, gravity: Vec3::ZERO };
    let mut swing = Swing::new(&PARENTS, chain(law), vec![]).unwrap();
    for frame in 0..50 {
        let rest = animated(0.5);
        let mut world = animated(f64::from(frame) / 60.0);
        if frame == 20 {
            world[1].translation.x = f32::NAN;
        }
        if frame > 20 {
            world = rest;
        }
        swing.advance(1.0 / 60.0, &mut world).unwrap();
        assert!(frame <= 20 || world[3].abs_diff_eq(rest[3], 1e-5), "frame {frame}");
    }
}

#[test]
fn mistakes_are_named() {
    let law = Law::Vrm { stiffness: 1.0, drag: 0.4, gravity: Vec3::ZERO };
    let one = |joint| Spring::new(joint, Vec3::Y, law);
    let new = |parents: &[Option<usize>], springs| Swing::new(parents, springs, vec![]).err();
    assert_eq!(new(&[Some(0)], vec![]), Some(SpringError::ParentAfter { joint: 0, parent: 0 }));
    assert_eq!(
        new(&[None], vec![one(1)]),
        Some(SpringError::UnknownJoint { what: "a spring", found: 1, joints: 1 })
    );
    assert_eq!(new(&[None], vec![one(0), one(0)]), Some(SpringError::Twice { what: "springs", joint: 0 }));
    let bumps = Spring { colliders: vec![2], ..one(0) };
    assert_eq!(
        new(&[None], vec![bumps]),
        Some(SpringError::UnknownCollider { joint: 0, found: 2, colliders: 0 })
    );
    let mut swing = Swing::new(&[None], vec![one(0)], vec![]).unwrap();
    assert_eq!(swing.advance(0.1, &mut []), Err(SpringError::Length { expected: 1, found: 0 }));
}
