//! Properties of W, T and X on random rigs, against an implementation in f64 that shares no code with the
//! library.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::naive::{M, relative_difference};
use glam::{Affine3A, Mat4, Quat, Vec3};
use proptest::prelude::*;
use rig_core::{Axis, Elementary, JointId, LengthMismatch, RawJoint, RawRig, Rig, UnknownJoint, product};

fn axis() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.0..1.0f64)
        .prop_filter("a direction", |v| v.iter().map(|x| x * x).sum::<f64>() > 0.01)
}

/// A rigid matrix, made in f64 and rounded to f32 once.
fn rigid() -> impl Strategy<Value = M> {
    (axis(), -4.0..4.0f64, prop::array::uniform3(-20.0..20.0f64)).prop_map(|(axis, angle, offset)| {
        crate::naive::translation(offset).times(&crate::naive::rotation(axis, angle))
    })
}

fn f32_matrix(m: &M) -> Mat4 {
    Mat4::from_cols_array_2d(&std::array::from_fn(|column| {
        std::array::from_fn(|row| m.0[row][column] as f32)
    }))
}

fn elementary() -> impl Strategy<Value = Elementary> {
    prop_oneof![
        (axis(), -7.0..7.0f32).prop_map(|(axis, angle_rad)| {
            let [x, y, z] = axis.map(|x| x as f32);
            Elementary::Rotation { axis: Vec3::new(x, y, z), angle_rad }
        }),
        prop::array::uniform3(-5.0..5.0f32).prop_map(|offset| Elementary::Translation(offset.into())),
    ]
}

fn naive_elementary(factor: &Elementary) -> M {
    match *factor {
        Elementary::Rotation { axis, angle_rad } => {
            crate::naive::rotation(axis.to_array().map(f64::from), angle_rad.into())
        }
        Elementary::Translation(offset) => crate::naive::translation(offset.to_array().map(f64::from)),
    }
}

/// A forest of up to 24 joints, with the factors of each joint's L.
#[derive(Debug, Clone)]
struct Case {
    raw: RawRig,
    factors: Vec<Vec<Elementary>>,
    shuffle: u64,
}

prop_compose! {
    fn case()(
        joints in prop::collection::vec(
            (any::<prop::sample::Index>(), 0..10u32, rigid(), prop::collection::vec(elementary(), 0..4)), 1..24),
        shuffle in any::<u64>(),
    ) -> Case {
        let mut raw = RawRig::default();
        let mut factors = Vec::new();
        for (i, (parent, root, bind, product)) in joints.into_iter().enumerate() {
            let parent = (i > 0 && root > 0).then(|| format!("j{}", parent.index(i)));
            raw.joints.push(RawJoint::new(format!("j{i}"), parent.as_deref(), f32_matrix(&bind)));
            factors.push(product);
        }
        Case { raw, factors, shuffle }
    }
}

/// Freezes, poses and updates; L by name, so that any order of joints gets the same.
fn posed(raw: &RawRig, case: &Case) -> (Rig, rig_core::RigPose) {
    let rig = Rig::from_raw(raw).unwrap();
    let mut locals = rig.locals();
    for (joint, factors) in case.raw.joints.iter().zip(&case.factors) {
        locals.set_product(rig.joint(&joint.name).unwrap(), factors).unwrap();
    }
    let mut pose = rig.pose();
    rig.update(locals.as_slice(), &mut pose).unwrap();
    (rig, pose)
}

/// W or T by recursion over names, in f64.
fn naive_world(case: &Case, name: &str, posed: bool) -> M {
    let index = case.raw.joints.iter().position(|joint| joint.name == name).unwrap();
    let joint = &case.raw.joints[index];
    let mut world = M::of(&Affine3A::from_mat4(joint.parent_from_joint));
    if posed {
        world = case.factors[index].iter().fold(world, |left, factor| left.times(&naive_elementary(factor)));
    }
    match &joint.parent {
        Some(parent) => naive_world(case, parent, posed).times(&world),
        None => world,
    }
}

proptest! {
    #[test]
    fn w_t_and_x_agree_with_a_recursion_in_f64(case in case()) {
        let (rig, pose) = posed(&case.raw, &case);
        for joint in rig.joints() {
            let (i, name) = (joint.index(), &rig.names()[joint.index()]);
            let w = naive_world(&case, name, false);
            let t = naive_world(&case, name, true);
            // By Gauss, not by transposing: the rigid inverse must be an inverse.
            let x = t.times(&w.inverse());
            prop_assert!(relative_difference(&rig.world_from_bind()[i], &w) < 1e-5);
            prop_assert!(relative_difference(&rig.bind_from_world()[i], &w.inverse()) < 1e-5);
            prop_assert!(relative_difference(&pose.world_from_joint()[i], &t) < 1e-5);
            prop_assert!(relative_difference(&pose.posed_from_bind()[i], &x) < 1e-4);
        }
    }

    #[test]
    fn without_local_transforms_x_is_the_identity(case in case()) {
        let rig = Rig::from_raw(&case.raw).unwrap();
        let mut pose = rig.pose();
        prop_assert!(pose.posed_from_bind().iter().all(|x| *x == Affine3A::IDENTITY));
        rig.update(rig.locals().as_slice(), &mut pose).unwrap();
        prop_assert_eq!(pose.world_from_joint(), rig.world_from_bind());
        for (x, w) in pose.posed_from_bind().iter().zip(rig.world_from_bind()) {
            let scale = 1.0 + w.translation.abs().max_element();
            prop_assert!(x.matrix3.abs_diff_eq(glam::Mat3A::IDENTITY, 1e-4));
            prop_assert!(x.translation.abs().max_element() < 1e-4 * scale, "{} at {}", x.translation, w.translation);
        }
    }

    /// A file prints few digits. Without local transforms, what is computed is still the bind pose up to the
    /// rounding of f32, and a rig that was frozen once is frozen again to the same bits.
    #[test]
    fn rotations_of_few_digits_make_one_bind_pose(
        case in case(),
        off in prop::collection::vec(-1.5e-4..1.5e-4f32, 9),
    ) {
        let mut raw = case.raw;
        for joint in &mut raw.joints {
            for (at, off) in off.iter().enumerate() {
                joint.parent_from_joint.col_mut(at / 3)[at % 3] += off;
            }
        }
        let rig = Rig::from_raw(&raw).unwrap();
        let (bind, mut pose) = (rig.pose(), rig.pose());
        rig.update(rig.locals().as_slice(), &mut pose).unwrap();
        prop_assert_eq!(pose.world_from_joint(), bind.world_from_joint());
        for (i, x) in pose.posed_from_bind().iter().enumerate() {
            let scale = 1.0 + rig.world_from_bind()[i].translation.abs().max_element();
            prop_assert!(x.matrix3.abs_diff_eq(bind.posed_from_bind()[i].matrix3, 1e-5), "{x}");
            prop_assert!(x.translation.abs().max_element() < 1e-5 * scale, "{x}");
        }
        for joint in &mut raw.joints {
            let frozen = rig.parent_from_joint()[rig.joint(&joint.name).unwrap().index()];
            // As near to the file as the file is to a rotation, and where the file says.
            let file = Affine3A::from_mat4(joint.parent_from_joint);
            prop_assert!(frozen.matrix3.abs_diff_eq(file.matrix3, 1e-3));
            prop_assert_eq!(frozen.translation, file.translation);
            joint.parent_from_joint = frozen.into();
        }
        let again = Rig::from_raw(&raw).unwrap();
        prop_assert_eq!(again.parent_from_joint(), rig.parent_from_joint());
    }

    #[test]
    fn the_inverse_of_w_undoes_w(case in case(), point in prop::array::uniform3(-20.0..20.0f32)) {
        let rig = Rig::from_raw(&case.raw).unwrap();
        let point = Vec3::from(point);
        for (w, inverse) in rig.world_from_bind().iter().zip(rig.bind_from_world()) {
            let scale = 1.0 + point.length() + w.translation.length();
            prop_assert!(inverse.transform_point3(w.transform_point3(point)).distance(point) < 1e-5 * scale);
            prop_assert!(w.transform_point3(inverse.transform_point3(point)).distance(point) < 1e-5 * scale);
        }
    }

    #[test]
    fn a_product_is_its_matrices_multiplied(factors in prop::collection::vec(elementary(), 0..6)) {
        let expected = factors.iter().map(naive_elementary).fold(M::IDENTITY, |left, m| left.times(&m));
        prop_assert!(relative_difference(&product(&factors), &expected) < 1e-5);
        // Any cut of the product gives the same.
        for cut in 0..=factors.len() {
            let (left, right) = factors.split_at(cut);
            prop_assert!(relative_difference(&(product(left) * product(right)), &expected) < 1e-5);
        }
    }

    #[test]
    fn the_order_of_the_list_changes_no_joint(case in case()) {
        let (rig, pose) = posed(&case.raw, &case);
        let mut shuffled = case.raw.clone();
        let mut random = crate::common::Random(case.shuffle);
        for i in (1..shuffled.joints.len()).rev() {
            shuffled.joints.swap(i, random.below(i + 1));
        }
        let (other_rig, other_pose) = posed(&shuffled, &case);
        for joint in rig.joints() {
            let (i, other) = (joint.index(), other_rig.joint(&rig.names()[joint.index()]).unwrap().index());
            // To the bit: each joint's path to its root is the same.
            prop_assert_eq!(rig.world_from_bind()[i], other_rig.world_from_bind()[other]);
            prop_assert_eq!(pose.world_from_joint()[i], other_pose.world_from_joint()[other]);
            prop_assert_eq!(pose.posed_from_bind()[i], other_pose.posed_from_bind()[other]);
        }
    }

    #[test]
    fn joints_come_parents_first_and_reversed_children_first(case in case()) {
        let rig = Rig::from_raw(&case.raw).unwrap();
        let forward: Vec<JointId> = rig.joints().collect();
        let mut backward: Vec<JointId> = rig.joints().rev().collect();
        prop_assert_eq!(forward.len(), case.raw.joints.len());
        prop_assert_eq!(rig.joints().len(), rig.len());
        for (position, joint) in forward.iter().enumerate() {
            prop_assert_eq!(joint.index(), position);
            let name = &rig.names()[position];
            prop_assert_eq!(rig.joint(name), Some(*joint));
            let parent = rig.parents()[position];
            prop_assert!(parent.is_none_or(|parent| parent < *joint));
            let raw = case.raw.joints.iter().find(|joint| joint.name == *name).unwrap();
            prop_assert_eq!(parent.map(|parent| &rig.names()[parent.index()]), raw.parent.as_ref());
            // A subtree is one piece: this joint's ancestors are all on the path of the joint before it.
            if let (Some(parent), Some(before)) = (parent, position.checked_sub(1)) {
                let mut path = Some(forward[before]);
                while path.is_some_and(|joint| joint != parent) {
                    path = rig.parents()[path.unwrap().index()];
                }
                prop_assert!(path.is_some());
            }
        }
        backward.reverse();
        prop_assert_eq!(forward, backward);
    }

    #[test]
    fn update_depends_on_nothing_but_its_arguments_and_reuses_their_room(case in case()) {
        let (rig, fresh) = posed(&case.raw, &case);
        let mut locals = rig.locals();
        let mut pose = rig.pose();
        let room = |pose: &rig_core::RigPose| (pose.world_from_joint().as_ptr(), pose.posed_from_bind().as_ptr());
        let before = room(&pose);
        rig.update(locals.as_slice(), &mut pose).unwrap();
        for (joint, factors) in case.raw.joints.iter().zip(&case.factors) {
            locals.set_product(rig.joint(&joint.name).unwrap(), factors).unwrap();
        }
        rig.update(locals.as_slice(), &mut pose).unwrap();
        rig.update(locals.as_slice(), &mut pose).unwrap();
        prop_assert_eq!(&pose, &fresh);
        prop_assert_eq!(room(&pose), before);
        locals.reset();
        prop_assert_eq!(locals, rig.locals());
    }
}

#[test]
fn rotations_are_right_handed_and_translations_come_first_when_they_stand_last() {
    let quarter = std::f32::consts::FRAC_PI_2;
    for (axis, from, to) in
        [(Axis::X, Vec3::Y, Vec3::Z), (Axis::Y, Vec3::Z, Vec3::X), (Axis::Z, Vec3::X, Vec3::Y)]
    {
        let turned = Elementary::rotation(axis, quarter).matrix().transform_vector3(from);
        assert!(turned.distance(to) < 1e-6, "{axis:?}: {turned}");
    }
    let moved = [Elementary::rotation(Axis::Z, quarter), Elementary::Translation(Vec3::X)];
    assert!(product(&moved).transform_point3(Vec3::ZERO).distance(Vec3::Y) < 1e-6);
    let no_axis = Elementary::Rotation { axis: Vec3::ZERO, angle_rad: 1.0 };
    assert_eq!(no_axis.matrix(), Affine3A::IDENTITY);
    // The length of the axis does not matter.
    let long = Elementary::Rotation { axis: Vec3::Z * 100.0, angle_rad: quarter };
    assert!(long.matrix().abs_diff_eq(Affine3A::from_quat(Quat::from_rotation_z(quarter)), 1e-6));
}

#[test]
fn lengths_and_joints_of_another_rig_are_errors() {
    let chain = |n: usize| {
        let parent = |i: usize| i.checked_sub(1).map(|parent| parent.to_string());
        let joint = |i: usize| RawJoint::new(i.to_string(), parent(i).as_deref(), Mat4::IDENTITY);
        Rig::from_raw(&RawRig { joints: (0..n).map(joint).collect() }).unwrap()
    };
    let (small, large) = (chain(2), chain(3));
    let last = large.joint("2").unwrap();
    let unknown = UnknownJoint { index: 2, joints: 2 };
    assert_eq!(small.locals().set(last, Affine3A::IDENTITY), Err(unknown));
    assert_eq!(small.locals().set_product(last, &[]), Err(unknown));
    assert_eq!(small.pose().gather(&[last], &mut [Affine3A::IDENTITY]), Err(unknown));
    let mismatch = |what| LengthMismatch { what, expected: 2, found: 3 };
    let locals = mismatch("the local transforms");
    assert_eq!(small.update(large.locals().as_slice(), &mut small.pose()), Err(locals));
    assert_eq!(small.update(small.locals().as_slice(), &mut large.pose()), Err(mismatch("the pose")));
    assert_eq!(locals.to_string(), "expected 2 joints in the local transforms, found 3");
    assert_eq!(unknown.to_string(), "expected a joint index below 2, found 2");
}

#[test]
fn an_empty_rig_is_a_rig() {
    let rig = Rig::from_raw(&RawRig::default()).unwrap();
    assert!(rig.is_empty() && rig.joints().next().is_none());
    rig.update(&[], &mut rig.pose()).unwrap();
}

#[test]
fn gathering_follows_the_palette() {
    let joint = |i: usize| RawJoint::new(i.to_string(), None, Mat4::IDENTITY);
    let rig = Rig::from_raw(&RawRig { joints: (0..4).map(joint).collect() }).unwrap();
    let mut locals = rig.locals();
    let moved = |i: usize| Affine3A::from_translation(Vec3::X * i as f32);
    rig.joints().for_each(|joint| locals.set(joint, moved(joint.index())).unwrap());
    let mut pose = rig.pose();
    rig.update(locals.as_slice(), &mut pose).unwrap();
    let palette = ["3", "0", "0", "2"].map(|name| rig.joint(name).unwrap());
    let mut out = [Affine3A::IDENTITY; 4];
    pose.gather(&palette, &mut out).unwrap();
    assert_eq!(out, [moved(3), moved(0), moved(0), moved(2)]);
}
