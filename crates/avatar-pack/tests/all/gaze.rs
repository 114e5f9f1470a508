//! Eyes that look at a point: directions are taken from the joints' own frames, in which x is forward.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::{folder_of, marsienne};
use avatar_pack::{FaceState, Gaze, Pack};
use glam::{DVec3, Vec3};

/// Numbers from −1 to 1, the same ones each time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0
    }
}

fn with(pack: &Pack, values: &[f32], changes: &[(usize, f32)]) -> (Vec<f32>, FaceState) {
    let mut values = values.to_vec();
    changes.iter().for_each(|(control, value)| values[*control] = *value);
    let mut state = FaceState::new(pack);
    state.pose(pack, &values).expect("values fit");
    (values, state)
}

fn set(pack: &Pack, name: &str, value: f32) -> (usize, f32) {
    (pack.controls().index(name).expect(name), value)
}

fn joint(pack: &Pack, state: &FaceState, name: &str) -> glam::Affine3A {
    state.rig_pose().world_from_joint()[pack.rig().joint(name).expect(name).index()]
}

fn degrees(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

/// By how many degrees an eye misses a point.
fn miss(pack: &Pack, state: &FaceState, eye: &str, target: Vec3) -> f64 {
    let frame = joint(pack, state, eye);
    degrees(frame.matrix3.x_axis.as_dvec3(), target.as_dvec3() - frame.translation.as_dvec3())
}

fn found(pack: &Pack, out: &[(usize, f32)], name: &str) -> f32 {
    let control = pack.controls().index(name).expect(name);
    out.iter().find(|(other, _)| *other == control).expect(name).1
}

const NAMES: [&str; 4] = ["eye.left.ud", "eye.left.lr", "eye.right.ud", "eye.right.lr"];

fn look(pack: &Pack, values: &[f32], target: Vec3) -> [f32; 4] {
    let mut out = vec![(99, 99.0)];
    Gaze::new(pack).expect("eyes").look_at(pack, values, target, &mut out).expect("values fit");
    assert_eq!(out.len(), 4);
    NAMES.map(|name| found(pack, &out, name))
}

#[test]
fn both_eyes_hit_what_is_within_range_however_the_head_is_turned() {
    let pack = marsienne();
    let mut gaze = Gaze::new(&pack).expect("eyes");
    let (mut random, mut out) = (Random(1), Vec::new());
    for _ in 0..200 {
        let head = [
            set(&pack, "head.turn", 70.0 * random.next()),
            set(&pack, "head.bow", 40.0 * random.next()),
            set(&pack, "head.bend", 40.0 * random.next()),
            // Where the eyes were does not matter.
            set(&pack, "eye.left.lr", 30.0 * random.next()),
        ];
        let (values, state) = with(&pack, &pack.controls().defaults(), &head);
        // In the head's frame at bind pose: 20° to either side, 18° up or down, from 25 to 1000 units away.
        let (side, up) = ((20.0 * random.next()).to_radians(), (18.0 * random.next()).to_radians());
        let away = 25.0 * 40f32.powf(0.5 + 0.5 * random.next());
        let left = pack.rig().joint("LtEyeJoint").expect("an eye").index();
        let middle = Vec3::from(pack.rig().world_from_bind()[left].translation) * Vec3::new(0.0, 1.0, 1.0);
        let there = middle + away * Vec3::new(side.sin(), up.tan() * side.cos(), side.cos());
        let head = pack.rig().joint("HeadJoint").expect("a head").index();
        let target = state.rig_pose().posed_from_bind()[head].transform_point3(there);
        gaze.look_at(&pack, &values, target, &mut out).expect("values fit");
        let (_, state) = with(&pack, &values, &out);
        for eye in ["LtEyeJoint", "RtEyeJoint"] {
            let miss = miss(&pack, &state, eye, target);
            assert!(miss < 0.1, "{eye} misses {target} by {miss}°: {out:?}");
        }
    }
}

#[test]
fn near_things_are_squinted_at_and_far_ones_are_not() {
    let pack = marsienne();
    let rest = pack.controls().defaults();
    let (_, state) = with(&pack, &rest, &[]);
    let eyes = ["LtEyeJoint", "RtEyeJoint"].map(|eye| Vec3::from(joint(&pack, &state, eye).translation));
    let middle = 0.5 * (eyes[0] + eyes[1]);
    for away in [10.0f32, 25.0, 100.0] {
        let [_, left, _, right] = look(&pack, &rest, middle + away * Vec3::Z);
        // The left eye looks to the character's right, by the angle of the triangle.
        let inward = (eyes[0].x / away).atan().to_degrees();
        assert!((left + inward).abs() < 0.05 && (right - inward).abs() < 0.05, "{left} {right} {inward}");
    }
    let [up_left, left, up_right, right] = look(&pack, &rest, middle + Vec3::new(2e4, 1e4, 1e5));
    assert!((left - right).abs() < 0.02 && (up_left - up_right).abs() < 0.02 && left > 10.0 && up_left > 5.0);
}

#[test]
fn a_mirrored_target_mirrors_the_eyes() {
    let pack = marsienne();
    let rest = pack.controls().defaults();
    let mut random = Random(7);
    for _ in 0..50 {
        let target = 80.0 * Vec3::new(random.next(), random.next(), random.next());
        let [ul, ll, ur, lr] = look(&pack, &rest, target);
        let mirrored = look(&pack, &rest, target * Vec3::new(-1.0, 1.0, 1.0));
        for (found, expected) in mirrored.into_iter().zip([ur, -lr, ul, -ll]) {
            assert!((found - expected).abs() < 0.05, "{target}: {found} {expected}");
        }
    }
}

#[test]
fn beyond_the_range_eyes_stay_at_the_nearest_limit() {
    let pack = marsienne();
    let rest = pack.controls().defaults();
    let middle = {
        let (_, state) = with(&pack, &rest, &[]);
        Vec3::from(joint(&pack, &state, "LtEyeJoint").translation) * Vec3::new(0.0, 1.0, 1.0)
    };
    for side in [-1.0f32, 1.0] {
        for angle in [45.0f32, 80.0, 100.0, 150.0, 178.0] {
            let angle = angle.to_radians();
            let target = middle + 300.0 * Vec3::new(side * angle.sin(), 0.0, angle.cos());
            let [ul, ll, ur, lr] = look(&pack, &rest, target);
            assert_eq!([ll, lr], [side * 30.0; 2], "{target}");
            assert!(ul.abs() < 0.1 && ur.abs() < 0.1, "{target}: {ul} {ur}");
        }
        let target = middle + 300.0 * Vec3::new(0.0, side, 0.3);
        let [ul, _, ur, _] = look(&pack, &rest, target);
        assert_eq!([ul, ur], [side * 25.0; 2]);
    }
    // Just outside of a corner: no other direction within the ranges is nearer.
    let target = middle + 400.0 * Vec3::new(0.6, 0.2, 0.8);
    let out = look(&pack, &rest, target);
    let miss_at = |ud: f32, lr: f32| {
        let (_, state) = with(&pack, &rest, &[set(&pack, "eye.left.ud", ud), set(&pack, "eye.left.lr", lr)]);
        miss(&pack, &state, "LtEyeJoint", target)
    };
    let best = miss_at(out[0], out[1]);
    assert_eq!(out[1], 30.0);
    for ud in -25..=25 {
        for lr in -30..=30 {
            assert!(miss_at(ud as f32, lr as f32) > best - 1e-3, "{ud} {lr} is nearer than {out:?}");
        }
    }
}

#[test]
fn eyes_never_part() {
    let pack = marsienne();
    let rest = pack.controls().defaults();
    let mut random = Random(3);
    for _ in 0..300 {
        let target = 60.0 * Vec3::new(random.next(), random.next(), random.next());
        let values = look(&pack, &rest, target);
        let (_, state) =
            with(&pack, &rest, &std::array::from_fn::<_, 4, _>(|i| set(&pack, NAMES[i], values[i])));
        let side = |eye: &str| joint(&pack, &state, eye).matrix3.x_axis.x;
        assert!(side("LtEyeJoint") <= side("RtEyeJoint") + 2e-3, "{target}: {values:?}");
        let behind = target.z < -10.0;
        assert!(!behind || (values[1] - values[3]).abs() < 0.1, "parallel for what is behind: {target}");
    }
}

#[test]
fn the_head_goes_its_share_of_the_way() {
    let pack = marsienne();
    let mut gaze = Gaze::new(&pack).expect("eyes");
    let (mut random, mut out) = (Random(5), Vec::new());
    for share in [0.0f32, 0.3, 0.6, 1.0] {
        for _ in 0..30 {
            // A head that is turned already and tilted: the share counts from straight ahead.
            let already = [
                set(&pack, "head.turn", 50.0 * random.next()),
                set(&pack, "head.bend", 10.0 * random.next()),
            ];
            let (values, _) = with(&pack, &pack.controls().defaults(), &already);
            let target = Vec3::new(40.0 * random.next(), 20.0 * random.next(), 60.0 + 20.0 * random.next());
            gaze.face_toward(&pack, &values, target, share, &mut out).expect("values fit");
            assert_eq!(out.len(), 2);
            let sight = |changes: &[(usize, f32)]| {
                let (_, state) = with(&pack, &values, changes);
                let eye = |name| joint(&pack, &state, name).translation.as_dvec3();
                let from = 0.5 * (eye("LtEyeJoint") + eye("RtEyeJoint"));
                // The head's z points backward.
                let forward = -joint(&pack, &state, "HeadJoint").matrix3.z_axis.as_dvec3();
                (forward, (target.as_dvec3() - from).normalize_or_zero())
            };
            let (ahead, _) = sight(&[set(&pack, "head.turn", 0.0), set(&pack, "head.bow", 0.0)]);
            let (forward, wanted) = sight(&out);
            let whole = degrees(ahead, wanted);
            let (gone, left) = (degrees(ahead, forward), degrees(forward, wanted));
            let share = f64::from(share);
            assert!((gone - share * whole).abs() < 1.0, "{gone} of {whole}, not {share}");
            assert!((left - (1.0 - share) * whole).abs() < 1.0, "{left} of {whole} left, not {share}");
        }
    }
}

/// The pack with other controls, and without the poses of its own.
fn with_controls(pack: Pack, controls: Vec<pose_anim::Control>) -> Pack {
    let mut contents = pack.into_contents();
    contents.controls = pose_anim::ControlTable::new(controls).expect("a table");
    (contents.poses, contents.clips) = Default::default();
    Pack::new(contents).expect("a pack")
}

#[test]
fn one_control_of_another_axis_is_enough_and_none_is_none() {
    let source =
        folder_of("assets/marsienne", |name| !name.ends_with(".png") && !name.starts_with("shapes."));
    let pack = Pack::load(&source).expect("a pack with two shapes");
    let mut controls = pack.controls().controls().to_vec();
    controls.retain(|control| control.name == "eye.right.lr" || control.name == "smile");
    let pose_anim::Drive::Joint { axis, .. } = &mut controls[0].drives else { panic!("a joint") };
    *axis = -*axis;
    let pack = with_controls(pack, controls.clone());
    let mut out = Vec::new();
    let mut gaze = Gaze::new(&pack).expect("an eye");
    gaze.look_at(&pack, &[0.0; 2], Vec3::new(-3.27 + 100.0, 0.0, 300.0), &mut out).expect("values fit");
    assert_eq!(out.len(), 1);
    assert!(out[0].0 == 0 && out[0].1 < -15.0 && out[0].1 > -21.0, "{out:?}");
    gaze.look_at(&pack, &[0.0; 2], Vec3::splat(f32::NAN), &mut out).expect("values fit");
    assert!(out.is_empty());
    gaze.face_toward(&pack, &[0.0; 2], Vec3::X, 0.5, &mut out).expect("values fit");
    assert!(out.is_empty(), "no head to turn");
    assert!(gaze.look_at(&pack, &[0.0; 3], Vec3::X, &mut out).is_err());

    let pack = with_controls(pack, controls.split_off(1));
    assert!(Gaze::new(&pack).is_none());
}
