//! Whole rotations and translations of joints.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use glam::{Affine3A, DQuat, DVec3, Mat4, Quat, Vec3};
use pose_anim::{JointPlayer, JointTarget};
use proptest::prelude::*;
use rig_core::{RawJoint, RawRig, Rig};

const START: JointTarget = JointTarget { rotation: Quat::IDENTITY, translation: Vec3::ZERO };

fn target() -> impl Strategy<Value = JointTarget> {
    let number = || -1.0f32..1.0;
    (number(), number(), number(), number(), number(), number(), number()).prop_map(
        |(x, y, z, w, a, b, c)| {
            let rotation = Quat::from_xyzw(x, y, z, w);
            let rotation = if rotation.length() > 0.01 { rotation } else { Quat::IDENTITY };
            // As callers have them, unit up to rounding, and others.
            let rotation = if a > -0.5 { rotation.normalize() } else { rotation };
            JointTarget { rotation, translation: Vec3::new(a, b, c) }
        },
    )
}

/// How far apart two quaternions are. Lengths may differ by the rounding of a target in single precision.
fn jump(a: DQuat, b: DQuat) -> f64 {
    let (a, b) = (a.normalize(), b.normalize());
    DQuat::from_xyzw(a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w).length()
}

/// A rotation has two quaternions.
fn apart(a: DQuat, b: DQuat) -> f64 {
    let difference = |b: DQuat| DQuat::from_xyzw(a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w).length();
    difference(b).min(difference(-b))
}

proptest! {
    #[test]
    fn presses_are_smooth_and_arrivals_exact(
        presses in prop::collection::vec((target(), 0.05f64..1.0, 0.0f64..0.5), 1..8),
    ) {
        let mut player = JointPlayer::new(START);
        for (target, secs, wait) in presses {
            let before = player.clone();
            player.press(target, secs);
            // Nothing jumps at the press, and what changes afterwards goes to 0 with the time.
            let scale = 1.0 + before.angular_rates().1.length() + before.linear_rates().1.length();
            prop_assert!(jump(before.rotation(), player.rotation()) < 1e-12);
            prop_assert!((before.angular_rates().0 - player.angular_rates().0).length() < 1e-9 * scale);
            prop_assert!((before.angular_rates().1 - player.angular_rates().1).length() < 1e-7 * scale);
            prop_assert!((before.translation() - player.translation()).length() < 1e-12);
            prop_assert!((before.linear_rates().0 - player.linear_rates().0).length() < 1e-12 * scale);
            prop_assert!((before.linear_rates().1 - player.linear_rates().1).length() < 1e-10 * scale);

            // The rates are those of the motion.
            let h = 1e-5;
            let mut near = [player.clone(), player.clone(), player.clone()];
            for (index, player) in near.iter_mut().enumerate() {
                player.advance(0.3 * secs + h * index as f64).unwrap();
                prop_assert!((player.rotation().length() - 1.0).abs() < 1e-9);
            }
            let turned = near[2].rotation() * near[0].rotation().inverse();
            let turned = if turned.w < 0.0 { -turned } else { turned };
            let (omega, alpha) = near[1].angular_rates();
            // However often and fast it is interrupted, it does not spin up: half a turn in 0.05 s peaks at
            // 118.
            prop_assert!(omega.length() < 300.0 && near[1].linear_rates().0.length() < 300.0);
            let slope = 2.0 * DVec3::new(turned.x, turned.y, turned.z) / (2.0 * h);
            let curve = (near[2].angular_rates().0 - near[0].angular_rates().0) / (2.0 * h);
            let size = 1.0 + alpha.length() / secs;
            prop_assert!((slope - omega).length() < 1e-4 * size, "{slope} {omega}");
            prop_assert!((curve - alpha).length() < 1e-3 * size * (1.0 + 1.0 / secs), "{curve} {alpha}");

            let mut arrived = player.clone();
            arrived.advance(secs - 1e-9).unwrap();
            let near = arrived.rotation();
            arrived.advance(2e-9).unwrap();
            prop_assert!(arrived.is_at_rest());
            // The last moment is no jump either, and the target is reached bit for bit, in one of its two
            // forms.
            prop_assert!(jump(near, arrived.rotation()) < 1e-12);
            let (found, given) = (arrived.rotation().as_quat(), target.rotation);
            let precise = given.as_dquat() * (1.0 / given.as_dquat().length());
            let expected = if (given.as_dquat().length() - 1.0).abs() <= 1e-6 { given } else { precise.as_quat() };
            prop_assert!(found == expected || -found == expected, "{found} {expected}");
            prop_assert_eq!(arrived.rotation(), found.as_dquat());
            prop_assert_eq!(arrived.local(), Affine3A::from_rotation_translation(expected, target.translation));
            prop_assert_eq!(arrived.translation().as_vec3(), target.translation);
            prop_assert_eq!(arrived.angular_rates(), (DVec3::ZERO, DVec3::ZERO));

            // In one step or in many.
            let mut steps = player.clone();
            for _ in 0..10 {
                steps.advance(0.1 * wait).unwrap();
            }
            player.advance(wait).unwrap();
            prop_assert!(apart(steps.rotation(), player.rotation()) < 1e-9);
        }
    }

    /// Presses in quick succession, each at most 1.5 times slower than the one before and so of about its
    /// speed, or of any other length: no coordinate leaves the span of its targets by more than half the
    /// span's width.
    #[test]
    fn no_number_of_presses_overshoots_by_more_than_half_the_span(
        first in 0.02f64..0.2,
        presses in prop::collection::vec(
            (prop_oneof![-1.0f32..1.0, Just(-1.0), Just(1.0)], prop_oneof![4 => 1.2f64..1.5, 1 => 0.05f64..8.0], 0.0f64..1.0),
            2..16,
        ),
    ) {
        let mut player = JointPlayer::new(START);
        let (mut least, mut greatest, mut secs) = (0.0f64, 0.0f64, first);
        for (index, (at, factor, wait)) in presses.iter().enumerate() {
            secs = (secs * factor).clamp(0.01, 100.0);
            player.press(JointTarget { rotation: Quat::IDENTITY, translation: Vec3::X * *at }, secs);
            (least, greatest) = (least.min(f64::from(*at)), greatest.max(f64::from(*at)));
            // The first move gets up speed; most of the others are interrupted at once.
            let is_last = index + 1 == presses.len();
            let wait_secs = if is_last { secs } else if index == 0 { 0.5 * secs } else { wait.powi(6) * secs };
            let margin = 0.5 * (greatest - least) + 1e-9;
            for _ in 0..50 {
                player.advance(0.02 * wait_secs).unwrap();
                let x = player.translation().x;
                prop_assert!((least - margin..=greatest + margin).contains(&x), "press {index}: {x}");
            }
        }
    }

    /// From rest: the great arc, by minimum jerk.
    #[test]
    fn from_rest_it_is_the_great_arc(target in target(), s in 0.0f64..1.0) {
        let mut player = JointPlayer::new(START);
        player.press(target, 1.0);
        player.advance(s).unwrap();
        let rotation = target.rotation.as_dquat();
        let rotation = rotation * (1.0 / rotation.length());
        let short = if rotation.w < 0.0 { -rotation } else { rotation };
        let expected = DQuat::IDENTITY.slerp(short, 10.0 * s.powi(3) - 15.0 * s.powi(4) + 6.0 * s.powi(5));
        prop_assert!(apart(player.rotation(), expected) < 1e-6);
    }
}

#[test]
fn what_is_no_target_is_passed_over() {
    let mut player = JointPlayer::new(START);
    let rotation = Quat::from_xyzw(0.1, -0.7, 0.3, 0.64).normalize();
    player.press(JointTarget { rotation, translation: Vec3::new(1.0, 2.0, 3.0) }, 0.5);
    player.advance(0.2).unwrap();
    let bad = [Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)];
    for rotation in bad {
        let translation = Vec3::new(f32::INFINITY, 5.0, f32::NAN);
        player.press(JointTarget { rotation, translation }, 0.5);
        player.advance(0.1).unwrap();
    }
    player.advance(1.0).unwrap();
    assert_eq!(player.translation().as_vec3(), Vec3::new(1.0, 5.0, 3.0));
    let found = player.rotation().as_quat();
    assert!(found == rotation || -found == rotation);
}

#[test]
fn it_sets_a_joint_and_survives_anything() {
    let rig = Rig::from_raw(&RawRig { joints: vec![RawJoint::new("a", None, Mat4::IDENTITY)] }).unwrap();
    let mut locals = rig.locals();
    let mut player = JointPlayer::new(START);
    let half_turn =
        JointTarget { rotation: Quat::from_rotation_y(std::f32::consts::PI), translation: Vec3::X };
    player.press(half_turn, 0.5);
    player.advance(f64::INFINITY).unwrap();
    player.apply(rig.joint("a").unwrap(), &mut locals).unwrap();
    let moved = locals.as_slice()[0].transform_point3(Vec3::Z);
    assert!((moved - Vec3::new(1.0, 0.0, -1.0)).length() < 1e-6);
    // Another half turn, both ways of which are equally short, and rotations that are ignored.
    for rotation in
        [Quat::IDENTITY, Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)]
    {
        for secs in [0.0, f64::NAN, -1.0, 0.2] {
            player.press(JointTarget { rotation, translation: Vec3::splat(f32::INFINITY) }, secs);
            player.advance(0.0004).unwrap();
            assert!(player.local().is_finite());
        }
    }
    assert!(player.advance(f64::NAN).is_err());
}
