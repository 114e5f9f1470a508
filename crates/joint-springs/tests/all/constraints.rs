use glam::{Affine3A, Quat, Vec3};
use joint_springs::{Constraint, ConstraintKind, Constraints, SpringError};

const PARENTS: [Option<usize>; 4] = [None, Some(0), Some(0), Some(2)];

/// A root, a source, a joint and a joint below it.
fn rest() -> [Affine3A; 4] {
    let at = |turn, place| Affine3A::from_rotation_translation(turn, place);
    let root = at(Quat::from_rotation_y(0.3), Vec3::new(0.0, 1.0, 0.0));
    let source = root * at(Quat::from_rotation_z(0.2), Vec3::X);
    let joint = root * at(Quat::from_rotation_x(-0.4), Vec3::NEG_X);
    [root, source, joint, joint * at(Quat::IDENTITY, Vec3::Y)]
}

fn applied(kind: ConstraintKind, weight: f32, world: [Affine3A; 4]) -> [Affine3A; 4] {
    let constraint = Constraint { joint: 2, source: 1, weight, kind };
    let mut world = world;
    Constraints::new(&PARENTS, &rest(), &[constraint]).unwrap().apply(&mut world).unwrap();
    world
}

#[test]
fn rest_stays_rest_and_the_joint_below_goes_along() {
    for kind in [ConstraintKind::Rotation, ConstraintKind::Roll { axis: Vec3::Z }] {
        let found = applied(kind, 1.0, rest());
        for (found, rest) in found.iter().zip(rest()) {
            assert!(found.abs_diff_eq(rest, 1e-5), "{kind:?}");
        }
    }
}

/// A turn of the source in its own axes is the joint's in its own.
#[test]
fn rotations_are_taken_over_by_weight() {
    for (weight, angle) in [(1.0, 0.8), (0.5, 0.4), (0.0, 0.0)] {
        let mut world = rest();
        world[1] *= Affine3A::from_rotation_y(0.8);
        let found = applied(ConstraintKind::Rotation, weight, world);
        let expected = rest()[2] * Affine3A::from_rotation_y(angle);
        assert!(found[2].abs_diff_eq(expected, 1e-5), "weight {weight}");
        assert!(found[3].abs_diff_eq(expected * Affine3A::from_translation(Vec3::Y), 1e-5));
    }
}

/// Of a turn about X and then Y in the parent's axes, rolling about X keeps what a swing from X to its image
/// leaves over.
#[test]
fn rolls_keep_the_turn_about_their_axis() {
    let parents = [None, Some(0), Some(0)];
    let rest = [Affine3A::IDENTITY; 3];
    let kind = ConstraintKind::Roll { axis: Vec3::X };
    let mut constraints =
        Constraints::new(&parents, &rest, &[Constraint { joint: 2, source: 1, weight: 1.0, kind }]).unwrap();
    for swing in [Quat::IDENTITY, Quat::from_rotation_y(0.7), Quat::from_rotation_z(-0.5)] {
        let mut world = rest;
        world[1] = Affine3A::from_quat(swing * Quat::from_rotation_x(0.6));
        constraints.apply(&mut world).unwrap();
        assert!(world[2].abs_diff_eq(Affine3A::from_rotation_x(0.6), 1e-5), "{swing}");
    }
}

#[test]
fn aims_point_to_the_source() {
    for axis in [Vec3::X, Vec3::NEG_Y, Vec3::Z] {
        for place in [Vec3::new(3.0, 2.0, 1.0), Vec3::new(-1.0, 5.0, -2.0)] {
            let mut world = rest();
            world[1].translation = place.into();
            let found = applied(ConstraintKind::Aim { axis }, 1.0, world);
            let there = (place - Vec3::from(found[2].translation)).normalize_or_zero();
            assert!((found[2].transform_vector3(axis) - there).length() < 1e-5);
            assert_eq!(found[2].translation, world[2].translation);
        }
    }
}

/// One constraint's source is turned by another that stands behind it in the list.
#[test]
fn constraints_wait_for_those_they_depend_on() {
    let parents = [None, Some(0), Some(0), Some(0)];
    let kind = ConstraintKind::Rotation;
    let list = [
        Constraint { joint: 1, source: 2, weight: 1.0, kind },
        Constraint { joint: 2, source: 3, weight: 1.0, kind },
    ];
    let mut world = [Affine3A::IDENTITY; 4];
    world[3] = Affine3A::from_rotation_z(0.5);
    Constraints::new(&parents, &[Affine3A::IDENTITY; 4], &list).unwrap().apply(&mut world).unwrap();
    assert!(world[1].abs_diff_eq(world[3], 1e-6));
}

#[test]
fn circles_are_refused() {
    let parents = [None, Some(0), Some(1)];
    let one = |joint, source| Constraint { joint, source, weight: 1.0, kind: ConstraintKind::Rotation };
    let new = |list: &[Constraint]| Constraints::new(&parents, &[Affine3A::IDENTITY; 3], list).err();
    // The error names a joint whose constraint is part of the circle: leaving it out breaks it.
    assert_eq!(new(&[one(1, 1)]), Some(SpringError::Circle { joint: 1 }));
    assert_eq!(new(&[one(0, 2)]), Some(SpringError::Circle { joint: 0 }), "the source is below the joint");
    assert_eq!(new(&[one(1, 2), one(2, 0)]), Some(SpringError::Circle { joint: 1 }));
    assert_eq!(new(&[one(1, 0), one(1, 0)]), Some(SpringError::Twice { what: "constraints", joint: 1 }));
    assert_eq!(
        new(&[one(1, 3)]),
        Some(SpringError::UnknownJoint { what: "a constraint", found: 3, joints: 3 })
    );
}
