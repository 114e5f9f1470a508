use glam::{Affine3A, Quat, Vec3};
use joint_springs::{Collider, Law, Shape, Spring, Swing};

const LAWS: [Law; 2] = [
    Law::Oscillator { frequency_hz: 1.0, damping_ratio: 0.2, gravity: Vec3::ZERO },
    Law::Vrm { stiffness: 0.4, drag: 0.2, gravity: Vec3::ZERO },
];
const HIT: f32 = 0.05;

/// The tail of a joint of length 1 that hangs down from a root that swings about by 2 Hz, at every frame.
fn tails(law: Law, shape: Shape) -> Vec<Vec3> {
    let colliders = vec![Collider { joint: 0, shape }];
    let spring = Spring { hit_radius: HIT, colliders: vec![0], ..Spring::new(1, Vec3::NEG_Y, law) };
    let mut swing = Swing::new(&[None, None], vec![spring], colliders).unwrap();
    (0..400)
        .map(|frame| {
            let turn = Quat::from_rotation_z(1.5 * (frame as f32 / 60.0 * 4.0).sin());
            let mut world = [Affine3A::IDENTITY, Affine3A::from_quat(turn)];
            swing.advance(1.0 / 60.0, &mut world).unwrap();
            world[1].transform_point3(Vec3::NEG_Y)
        })
        .collect()
}

/// Tails stay on the allowed side; the same motion without the collider goes to the other.
fn kept_out(shape: Shape, depth: impl Fn(Vec3) -> f32) {
    let nothing = Shape::Sphere { offset: Vec3::splat(100.0), radius: 0.0, inside: false };
    for law in LAWS {
        let deepest = |shape| tails(law, shape).into_iter().map(&depth).fold(f32::MIN, f32::max);
        assert!(deepest(nothing) > 0.05, "{law:?}: nothing to bump against");
        // Back on its circle after it was pushed out, a tail can be a little inside again.
        assert!(deepest(shape) < 0.02, "{law:?} is {} in {shape:?}", deepest(shape));
    }
}

#[test]
fn spheres_keep_tails_out() {
    let offset = Vec3::new(0.8, -0.7, 0.0);
    kept_out(Shape::Sphere { offset, radius: 0.3, inside: false }, |tail| {
        0.3 + HIT - (tail - offset).length()
    });
}

#[test]
fn capsules_keep_tails_out() {
    let (offset, tail) = (Vec3::new(0.8, -0.7, -1.0), Vec3::new(0.8, -0.7, 1.0));
    kept_out(Shape::Capsule { offset, tail, radius: 0.3, inside: false }, |tail| {
        0.3 + HIT - (tail - offset).truncate().length()
    });
}

#[test]
fn planes_keep_tails_in_front() {
    let offset = Vec3::new(0.5, 0.0, 0.0);
    kept_out(Shape::Plane { offset, normal: Vec3::NEG_X * 3.0 }, |tail| tail.x + HIT - 0.5);
}

#[test]
fn spheres_and_capsules_keep_tails_in() {
    let offset = Vec3::NEG_Y;
    kept_out(Shape::Sphere { offset, radius: 0.6, inside: true }, |tail| {
        (tail - offset).length() + HIT - 0.6
    });
    let (from, to) = (Vec3::new(0.0, -1.0, -1.0), Vec3::new(0.0, -1.0, 1.0));
    kept_out(Shape::Capsule { offset: from, tail: to, radius: 0.6, inside: true }, |tail| {
        (tail - from).truncate().length() + HIT - 0.6
    });
}
