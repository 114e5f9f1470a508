//! A head that turns and nods, and a chain of three joints that hangs on it.

use glam::{Affine3A, EulerRot, Quat, Vec3};
use joint_springs::{Law, Spring};

/// The length of one joint of the chain; the head's own joint is 0.
pub(crate) const LENGTH: f32 = 0.08;
pub(crate) const PARENTS: [Option<usize>; 4] = [None, Some(0), Some(1), Some(2)];

/// The chain begins at the side of the head.
fn places() -> [Vec3; 3] {
    [Vec3::new(0.09, 0.05, 0.0), Vec3::NEG_Y * LENGTH, Vec3::NEG_Y * LENGTH]
}

/// World matrices at a time: yaw, nod and a walk, all smooth.
pub(crate) fn animated(secs: f64) -> [Affine3A; 4] {
    let wave = |hz: f64, phase: f64| (std::f64::consts::TAU * hz * secs + phase).sin() as f32;
    let turn =
        Quat::from_euler(EulerRot::YXZ, 0.5 * wave(0.7, 0.0), 0.25 * wave(0.9, 1.0), 0.1 * wave(0.5, 2.0));
    let place = Vec3::new(0.05 * wave(0.6, 0.5), 1.5 + 0.02 * wave(1.1, 0.0), 0.03 * wave(0.4, 1.0));
    let head = Affine3A::from_rotation_translation(turn, place);
    let mut world = [head; 4];
    for (joint, offset) in places().into_iter().enumerate() {
        world[joint + 1] = world[joint] * Affine3A::from_translation(offset);
    }
    world
}

/// A spring at each joint of the chain.
pub(crate) fn chain(law: Law) -> Vec<Spring> {
    (1..4).map(|joint| Spring::new(joint, Vec3::NEG_Y * LENGTH, law)).collect()
}

/// Where the end of the chain is.
pub(crate) fn end(world: &[Affine3A]) -> Vec3 {
    world[3].transform_point3(Vec3::NEG_Y * LENGTH)
}
