//! Time of one `Rig::update`, per joint (divan prints items per second: joints).
#![allow(clippy::unwrap_used, reason = "a bench may panic")]

use divan::Bencher;
use divan::counter::ItemsCount;
use glam::{Mat4, Quat, Vec3};
use rig_core::{Axis, Elementary, RawJoint, RawRig, Rig};

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

/// A body-like tree: joint i hangs on joint i / 2.
fn tree(joints: usize) -> Rig {
    let joint = |i: usize| {
        let parent = (i / 2).to_string();
        RawJoint::new(i.to_string(), (i > 0).then_some(parent.as_str()), bind(i))
    };
    Rig::from_raw(&RawRig { joints: (0..joints).map(joint).collect() }).unwrap()
}

fn bind(i: usize) -> Mat4 {
    let angle = i as f32 * 0.7;
    let axis = Vec3::new(angle.sin(), angle.cos(), 0.5).normalize_or_zero();
    Mat4::from_rotation_translation(Quat::from_axis_angle(axis, angle), Vec3::new(0.1, 1.0, angle.sin()))
}

#[divan::bench(args = [9, 100, 1000])]
fn update(bencher: Bencher<'_, '_>, joints: usize) {
    let rig = if joints == 9 { face() } else { tree(joints) };
    let mut locals = rig.locals();
    for joint in rig.joints() {
        let angle_rad = joint.index() as f32 * 0.01;
        locals.set_product(joint, &[Elementary::rotation(Axis::X, angle_rad)]).unwrap();
    }
    let mut pose = rig.pose();
    bencher.counter(ItemsCount::new(joints)).bench_local(|| {
        rig.update(divan::black_box(locals.as_slice()), &mut pose).unwrap();
        divan::black_box(&pose);
    });
}
