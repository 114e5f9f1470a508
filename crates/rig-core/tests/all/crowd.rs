//! A crowd of rigs against rigs one by one.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use glam::{Affine3A, DAffine3, Mat4, Quat, Vec3};
use lanes::LANES;
use proptest::prelude::*;
use rig_core::{RawJoint, RawRig, Rig, RigCrowd};

fn quat() -> impl Strategy<Value = Quat> {
    ([-1f32..1.0, -1f32..1.0, -1f32..1.0], -3f32..3.0).prop_map(|(axis, angle)| {
        let axis = Vec3::from(axis).try_normalize().unwrap_or(Vec3::Z);
        Quat::from_axis_angle(axis, angle)
    })
}

fn place() -> impl Strategy<Value = Vec3> {
    [-1f32..1.0, -1f32..1.0, -1f32..1.0].prop_map(Vec3::from)
}

/// `stretch` is how much bind matrices magnify rounding: 1 where they are rigid.
fn check(rig: &Rig, motions: &[Vec<(Quat, Vec3)>], stretch: f64) -> Result<(), TestCaseError> {
    let mut crowd = RigCrowd::new(rig, motions.len());
    prop_assert_eq!((crowd.len(), crowd.blocks()), (motions.len(), motions.len().div_ceil(LANES)));
    for (face, motions) in motions.iter().enumerate() {
        for (joint, (rotation, translation)) in rig.joints().zip(motions) {
            crowd.set(face, joint, *rotation, *translation).unwrap();
        }
    }
    crowd.update();
    for (face, motions) in motions.iter().enumerate() {
        let (mut locals, mut pose) = (rig.locals(), rig.pose());
        for (joint, (rotation, translation)) in rig.joints().zip(motions) {
            locals.set(joint, Affine3A::from_rotation_translation(*rotation, *translation)).unwrap();
        }
        rig.update(locals.as_slice(), &mut pose).unwrap();
        let mut exact: Vec<[DAffine3; 2]> = Vec::new();
        for (joint, (rotation, translation)) in rig.joints().zip(motions) {
            // The same products in f64, from the bind matrices that the rig was frozen with.
            let bind = rig.parent_from_joint()[joint.index()];
            let bind = DAffine3 {
                matrix3: bind.matrix3.as_dmat3(),
                translation: Vec3::from(bind.translation).as_dvec3(),
            };
            let local = DAffine3::from_rotation_translation(rotation.as_dquat(), translation.as_dvec3());
            let [world_from_bind, world_from_joint] = match rig.parents()[joint.index()] {
                Some(parent) => exact[parent.index()],
                None => [DAffine3::IDENTITY; 2],
            };
            let (w, t) = (world_from_bind * bind, world_from_joint * bind * local);
            exact.push([w, t]);
            let x = t * w.inverse();
            let singles = [pose.posed_from_bind()[joint.index()], pose.world_from_joint()[joint.index()]];
            let crowds =
                [crowd.posed_from_bind(face, joint).unwrap(), crowd.world_from_joint(face, joint).unwrap()];
            for ((exact, single), crowd) in [x, t].into_iter().zip(singles).zip(crowds) {
                let off = |found: Affine3A| {
                    let pairs = found.to_cols_array().into_iter().zip(exact.to_cols_array());
                    pairs.map(|(found, exact)| (f64::from(found) - exact).abs()).fold(0.0, f64::max)
                };
                // Of the size of what was added up: up to four places, each within a cube of 2.
                let size = exact.to_cols_array().into_iter().fold(4.0f64, |most, x| most.max(x.abs()));
                // Of rounding from parent to child, single rigs have as much: two results, each within a
                // millionth of what is exact.
                let near = if joint.index() == 0 { 1e-6 } else { 2e-6 } * size * stretch;
                prop_assert!(off(crowd) < near, "{joint:?}: {exact:?} {crowd:?} {single:?}");
                prop_assert!(
                    crowd.abs_diff_eq(single, near as f32),
                    "{joint:?}: {exact:?} {crowd:?} {single:?}"
                );
            }
        }
    }
    Ok(())
}

/// Joint i hangs on joint (i - 1) / 2.
fn raw(binds: &[Mat4]) -> RawRig {
    let joint = |(i, bind): (usize, &Mat4)| {
        let parent = (i > 0).then(|| ((i - 1) / 2).to_string());
        RawJoint::new(i.to_string(), parent.as_deref(), *bind)
    };
    RawRig { joints: binds.iter().enumerate().map(joint).collect() }
}

const JOINTS: usize = 9;

proptest! {
    #[test]
    fn bones_are_those_of_single_rigs(
        binds in prop::collection::vec((quat(), place()), JOINTS),
        motions in prop::collection::vec(prop::collection::vec((quat(), place()), JOINTS), 1..40),
    ) {
        let binds: Vec<_> = binds.iter().map(|(q, t)| Mat4::from_rotation_translation(*q, *t)).collect();
        check(&Rig::from_raw(&raw(&binds)).unwrap(), &motions, 1.0)?;
    }

    /// Nodes of interchange formats scale and mirror.
    #[test]
    fn bind_matrices_may_scale_and_mirror(
        binds in prop::collection::vec((quat(), place(), [0.7f32..1.4, 0.7f32..1.4, 0.7f32..1.4], any::<bool>()), 4),
        motions in prop::collection::vec(prop::collection::vec((quat(), place()), 4), 1..20),
    ) {
        let bind = |(q, t, scale, mirror): &(Quat, Vec3, [f32; 3], bool)| {
            let scale = Vec3::from(*scale) * if *mirror { Vec3::new(-1.0, 1.0, 1.0) } else { Vec3::ONE };
            Mat4::from_scale_rotation_translation(scale, *q, *t)
        };
        let binds: Vec<_> = binds.iter().map(bind).collect();
        // Two levels stretch by up to 1.4² · 1/0.7².
        check(&Rig::from_raw_affine(&raw(&binds)).unwrap(), &motions, 4.0)?;
    }

    #[test]
    fn at_rest_every_bone_is_the_identity_to_the_bit(
        binds in prop::collection::vec((quat(), place()), JOINTS),
    ) {
        let binds: Vec<_> = binds.iter().map(|(q, t)| Mat4::from_rotation_translation(*q, *t)).collect();
        let rig = Rig::from_raw(&raw(&binds)).unwrap();
        let mut crowd = RigCrowd::new(&rig, 2);
        crowd.update();
        prop_assert!(rig.joints().all(|joint| crowd.posed_from_bind(1, joint) == Some(Affine3A::IDENTITY)));
    }
}

#[test]
fn what_a_crowd_does_not_have() {
    let rig = Rig::from_raw(&raw(&[Mat4::IDENTITY; 2])).unwrap();
    let larger = Rig::from_raw(&raw(&[Mat4::IDENTITY; 3])).unwrap();
    let (mine, other) = (rig.joints().last().unwrap(), larger.joints().last().unwrap());
    let mut crowd = RigCrowd::new(&rig, 17);
    let errors = [(0, other), (17, mine)]
        .map(|(face, joint)| crowd.set(face, joint, Quat::IDENTITY, Vec3::ZERO).unwrap_err().to_string());
    assert!(errors[0].contains('2'), "{}", errors[0]);
    assert_eq!(errors[1], "expected a rig below 17, the number of rigs in the crowd, found 17");
    assert_eq!((crowd.posed_from_bind(0, other), crowd.world_from_joint(17, mine)), (None, None));
    assert_eq!((crowd.bones(1).len(), crowd.bones(2).len(), crowd.motions_mut(2).len()), (2, 0, 0));
    let mut nobody = RigCrowd::new(&rig, 0);
    nobody.update();
    assert!(nobody.is_empty() && nobody.blocks() == 0);
    let nothing = Rig::from_raw(&RawRig::default()).unwrap();
    RigCrowd::new(&nothing, 5).update();
}
