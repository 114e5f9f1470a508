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

/// What is left of a small depth at a sphere's surface: a tail is pushed out along the normal and then back
/// to its circle, of radius 1 about the origin. Each of the two leaves the cosine between the joint and the
/// normal. `center` is the length of the sphere's middle, `radius` that of the surface that the tail touches.
fn left_by_sphere(center: f32, radius: f32) -> f32 {
    ((1.0 - center * center + radius * radius) / (2.0 * radius)).powi(2)
}

/// Tails stay on the allowed side; the same motion without the collider goes to the other. `left` is the
/// share of a depth that is left when a tail was pushed out and is back on its circle.
fn kept_out(shape: Shape, left: f32, depth: impl Fn(Vec3) -> f32) {
    let nothing = Shape::Sphere { offset: Vec3::splat(100.0), radius: 0.0, inside: false };
    for law in LAWS {
        let deepest = |shape| tails(law, shape).into_iter().map(&depth).fold(f32::MIN, f32::max);
        assert!(deepest(nothing) > 0.05, "{law:?}: nothing to bump against");
        // The root turns by 6 radians a second at most, by 0.1 in a tick: a depth from which a tail is
        // pushed out is about that at most.
        let allowed = (0.1 * left).min(0.02);
        assert!(deepest(shape) < allowed, "{law:?} is {} in {shape:?}, not {allowed}", deepest(shape));
    }
}

#[test]
fn spheres_keep_tails_out() {
    let offset = Vec3::new(0.8, -0.7, 0.0);
    kept_out(
        Shape::Sphere { offset, radius: 0.3, inside: false },
        left_by_sphere(offset.length(), 0.3 + HIT),
        |tail| 0.3 + HIT - (tail - offset).length(),
    );
}

#[test]
fn capsules_keep_tails_out() {
    let (offset, tail) = (Vec3::new(0.8, -0.7, -1.0), Vec3::new(0.8, -0.7, 1.0));
    let left = left_by_sphere(offset.truncate().length(), 0.3 + HIT);
    kept_out(Shape::Capsule { offset, tail, radius: 0.3, inside: false }, left, |tail| {
        0.3 + HIT - (tail - offset).truncate().length()
    });
}

#[test]
fn planes_keep_tails_in_front() {
    let offset = Vec3::new(0.5, 0.0, 0.0);
    kept_out(Shape::Plane { offset, normal: Vec3::NEG_X * 3.0 }, (0.5f32 - HIT).powi(2), |tail| {
        tail.x + HIT - 0.5
    });
}

#[test]
fn spheres_and_capsules_keep_tails_in() {
    let offset = Vec3::NEG_Y;
    let left = left_by_sphere(1.0, 0.6 - HIT);
    kept_out(Shape::Sphere { offset, radius: 0.6, inside: true }, left, |tail| {
        (tail - offset).length() + HIT - 0.6
    });
    let (from, to) = (Vec3::new(0.0, -1.0, -1.0), Vec3::new(0.0, -1.0, 1.0));
    kept_out(Shape::Capsule { offset: from, tail: to, radius: 0.6, inside: true }, left, |tail| {
        (tail - from).truncate().length() + HIT - 0.6
    });
}
