//! Time of one `RigCrowd::update` of faces with nine joints, beside `Rig::update` of the same, per face
//! (divan prints items per second: faces).
#![allow(clippy::unwrap_used, reason = "a bench may panic")]

use divan::Bencher;
use divan::counter::ItemsCount;
use glam::{Affine3A, Mat4, Quat, Vec3};
use rig_core::{RawJoint, RawRig, Rig, RigCrowd};

fn main() {
    divan::main();
}

/// Neck, head and seven children, as a face has them.
fn face() -> Rig {
    let mut raw = RawRig::default();
    raw.joints.push(RawJoint::new("0", None, bind(0)));
    raw.joints.push(RawJoint::new("1", Some("0"), bind(1)));
    raw.joints.extend((2..9).map(|i| RawJoint::new(i.to_string(), Some("1"), bind(i))));
    Rig::from_raw(&raw).unwrap()
}

fn bind(i: usize) -> Mat4 {
    let angle = i as f32 * 0.7;
    let axis = Vec3::new(angle.sin(), angle.cos(), 0.5).normalize_or_zero();
    Mat4::from_rotation_translation(Quat::from_axis_angle(axis, angle), Vec3::new(0.1, 1.0, angle.sin()))
}

fn turn(face: usize, joint: usize) -> Quat {
    Quat::from_rotation_x((face as f32 * 0.37).sin() * 0.4 * (1.0 + 0.1 * joint as f32))
}

#[divan::bench(args = [1, 1024, 16384])]
fn crowd(bencher: Bencher<'_, '_>, faces: usize) {
    let rig = face();
    let mut crowd = RigCrowd::new(&rig, faces);
    for face in 0..faces {
        for joint in rig.joints() {
            crowd.set(face, joint, turn(face, joint.index()), Vec3::ZERO).unwrap();
        }
    }
    bencher.counter(ItemsCount::new(faces)).bench_local(|| {
        divan::black_box(&mut crowd).update();
        divan::black_box(&crowd);
    });
}

#[divan::bench(args = [1, 1024, 16384])]
fn one_by_one(bencher: Bencher<'_, '_>, faces: usize) {
    let rig = face();
    let locals = |face: usize| {
        let mut locals = rig.locals();
        rig.joints().for_each(|j| locals.set(j, Affine3A::from_quat(turn(face, j.index()))).unwrap());
        locals
    };
    let mut faces_of: Vec<_> = (0..faces).map(|face| (locals(face), rig.pose())).collect();
    bencher.counter(ItemsCount::new(faces)).bench_local(|| {
        for (locals, pose) in divan::black_box(&mut faces_of) {
            rig.update(locals.as_slice(), pose).unwrap();
        }
    });
}
