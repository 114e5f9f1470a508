//! Swinging does not allocate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

#[path = "all/scene.rs"]
mod scene;

use glam::{Affine3A, Vec3};
use joint_springs::{Collider, Constraint, ConstraintKind, Constraints, Law, Shape, Spring, Swing};

#[test]
fn a_frame_does_not_allocate() {
    for law in [
        Law::Vrm { stiffness: 1.0, drag: 0.4, gravity: Vec3::ZERO },
        Law::Oscillator { frequency_hz: 2.0, damping_ratio: 0.4, gravity: Vec3::NEG_Y },
    ] {
        let springs = scene::chain(law).into_iter().map(|spring| Spring { colliders: vec![0], ..spring });
        let shape = Shape::Sphere { offset: Vec3::ZERO, radius: 0.1, inside: false };
        let mut swing =
            Swing::new(&scene::PARENTS, springs.collect(), vec![Collider { joint: 0, shape }]).unwrap();
        let list = [Constraint { joint: 1, source: 0, weight: 0.5, kind: ConstraintKind::Rotation }];
        let mut constraints = Constraints::new(&scene::PARENTS, &scene::animated(0.0), &list).unwrap();
        let mut moved = 0.0f32;
        let counted = allocation_counter::measure(|| {
            swing.settle(&mut scene::animated(0.0)).unwrap();
            for frame in 0..2000 {
                let mut world: [Affine3A; 4] = scene::animated(f64::from(frame) / 90.0);
                let rest = scene::end(&world);
                constraints.apply(&mut world).unwrap();
                swing.advance(1.0 / 90.0, &mut world).unwrap();
                moved = moved.max((scene::end(&world) - rest).length());
            }
        });
        assert_eq!(counted.count_total, 0);
        assert!(moved > 0.1 * scene::LENGTH);
    }
}
