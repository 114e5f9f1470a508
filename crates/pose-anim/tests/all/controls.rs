//! What the default controls do to a rig with the frames of the nine-joint face.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use approx::assert_abs_diff_eq;
use glam::{DMat3, DVec3, Mat3, Mat4, Vec3};
use pose_anim::{
    ApplyError, BindError, Binding, ControlTable, DEFAULT_CONTROLS_TOML, Drive, JointMotion, Pace,
};
use rig_core::{RawJoint, RawRig, Rig};

const SHAPES: [&str; 2] = ["SSmile", "Frown"];

/// The nine joints. Columns: where the joint's x, y and z point in the parent's frame.
fn rig() -> Rig {
    let up_left_back = Mat3::from_cols(Vec3::Y, Vec3::X, Vec3::NEG_Z);
    // Seen from the world: forward, up, to the character's right. Relative to the head, whose frame is not
    // the world's.
    let in_head = up_left_back.transpose() * Mat3::from_cols(Vec3::Z, Vec3::Y, Vec3::NEG_X);
    let turned_about_z = in_head * Mat3::from_cols(Vec3::NEG_X, Vec3::NEG_Y, Vec3::Z);
    let joint = |name: &str, parent, frame: Mat3, at: Vec3| {
        let matrix = Mat4::from_cols(
            frame.x_axis.extend(0.0),
            frame.y_axis.extend(0.0),
            frame.z_axis.extend(0.0),
            at.extend(1.0),
        );
        RawJoint::new(name, parent, matrix)
    };
    let head = Some("HeadJoint");
    let eye = |x: f32| up_left_back.transpose() * Vec3::new(x, 10.6, 3.1);
    let joints = vec![
        joint("NeckJoint", None, Mat3::IDENTITY, Vec3::new(0.0, -13.9, -1.9)),
        joint("HeadJoint", Some("NeckJoint"), up_left_back, Vec3::new(0.0, 3.5, 0.25)),
        joint("JawJoint", head, in_head, up_left_back.transpose() * Vec3::new(0.0, 6.9, 0.0)),
        joint("LtUpperLidJoint", head, in_head, eye(3.27)),
        joint("RtUpperLidJoint", head, turned_about_z, eye(-3.27)),
        joint("LtLowerLidJoint", head, in_head, eye(3.27)),
        joint("RtLowerLidJoint", head, turned_about_z, eye(-3.27)),
        joint("LtEyeJoint", head, in_head, eye(3.27)),
        joint("RtEyeJoint", head, in_head, eye(-3.27)),
    ];
    Rig::from_raw(&RawRig { joints }).unwrap()
}

fn bound() -> (Rig, ControlTable, Binding) {
    let (rig, table) = (rig(), ControlTable::default_face());
    let binding = table.bind(&rig, &SHAPES).unwrap();
    (rig, table, binding)
}

/// Where the world direction `from`, fixed to `joint`, points after these controls.
fn moved(settings: &[(&str, f32)], joint: &str, from: Vec3) -> Vec3 {
    let (rig, table, binding) = bound();
    let mut values = table.defaults();
    for (name, value) in settings {
        values[table.index(name).unwrap()] = *value;
    }
    let (mut locals, mut weights) = (rig.locals(), [0.0; 2]);
    binding.apply(&values, &mut locals, &mut weights).unwrap();
    let mut pose = rig.pose();
    rig.update(locals.as_slice(), &mut pose).unwrap();
    pose.posed_from_bind()[rig.joint(joint).unwrap().index()].transform_vector3(from)
}

#[test]
fn the_table_is_the_documented_one() {
    let expected = [
        ("head.turn", "HeadJoint +x", -70.0, 70.0),
        ("head.bow", "HeadJoint +y", -40.0, 40.0),
        ("head.bend", "HeadJoint +z", -40.0, 40.0),
        ("jaw.open", "JawJoint -z", 0.0, 20.0),
        ("jaw.jut", "JawJoint +y", -8.0, 8.0),
        ("eye.left.ud", "LtEyeJoint +z", -25.0, 25.0),
        ("eye.right.ud", "RtEyeJoint +z", -25.0, 25.0),
        ("eye.left.lr", "LtEyeJoint +y", -30.0, 30.0),
        ("eye.right.lr", "RtEyeJoint +y", -30.0, 30.0),
        ("lid.left.upper", "LtUpperLidJoint -z", -10.0, 45.0),
        ("lid.right.upper", "RtUpperLidJoint -z", -10.0, 45.0),
        ("lid.left.lower", "LtLowerLidJoint +z", -5.0, 25.0),
        ("lid.right.lower", "RtLowerLidJoint +z", -5.0, 25.0),
        ("smile", "SSmile", 0.0, 1.0),
        ("frown", "Frown", 0.0, 1.0),
    ];
    let axes = [
        ("+x", Vec3::X),
        ("-x", Vec3::NEG_X),
        ("+y", Vec3::Y),
        ("-y", Vec3::NEG_Y),
        ("+z", Vec3::Z),
        ("-z", Vec3::NEG_Z),
    ];
    let table = ControlTable::default_face();
    assert_eq!(ControlTable::from_toml(DEFAULT_CONTROLS_TOML).as_ref(), Ok(&table));
    assert_eq!(table.len(), expected.len());
    assert!(table.couplings().is_empty());
    for (control, (name, drives, min, max)) in table.controls().iter().zip(expected) {
        let found = match &control.drives {
            Drive::Shape { shape } => shape.clone(),
            Drive::Joint { joint, axis, kind } => {
                assert_eq!(*kind, JointMotion::Rotation);
                format!("{joint} {}", axes.iter().find(|(_, vector)| vector == axis).unwrap().0)
            }
        };
        assert_eq!((control.name.as_str(), found.as_str()), (name, drives));
        assert_eq!((control.min, control.max, control.default), (min, max, 0.0), "{name}");
    }
}

/// Each row: the control at this value carries a direction of the bind pose to another one, worked out by
/// hand: a turn by α in the plane from u to v carries u to cos α · u + sin α · v.
#[test]
fn every_joint_control_moves_the_face_as_documented() {
    let (left, up, forward) = (Vec3::X, Vec3::Y, Vec3::Z);
    let rows = [
        ("head.turn", "HeadJoint", forward, left),
        ("head.bow", "HeadJoint", forward, -up),
        ("head.bend", "HeadJoint", up, left),
        ("jaw.open", "JawJoint", forward, -up),
        ("jaw.jut", "JawJoint", forward, left),
        ("eye.left.ud", "LtEyeJoint", forward, up),
        ("eye.right.ud", "RtEyeJoint", forward, up),
        ("eye.left.lr", "LtEyeJoint", forward, left),
        ("eye.right.lr", "RtEyeJoint", forward, left),
        ("lid.left.upper", "LtUpperLidJoint", forward, -up),
        ("lid.right.upper", "RtUpperLidJoint", forward, -up),
        ("lid.left.lower", "LtLowerLidJoint", forward, up),
        ("lid.right.lower", "RtLowerLidJoint", forward, up),
    ];
    let table = ControlTable::default_face();
    for (name, joint, from, towards) in rows {
        let control = &table.controls()[table.index(name).unwrap()];
        for degrees in [control.min, control.max, 0.5 * control.max] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let expected = from * cos + towards * sin;
            let found = moved(&[(name, degrees)], joint, from);
            assert_abs_diff_eq!(found.to_array()[..], expected.to_array()[..], epsilon = 1e-6);
            // The third direction is the axis: it stays.
            let axis = from.cross(towards);
            let found = moved(&[(name, degrees)], joint, axis);
            assert_abs_diff_eq!(found.to_array()[..], axis.to_array()[..], epsilon = 1e-6);
        }
    }
}

#[test]
fn joints_compose_left_to_right_in_table_order() {
    let (turn, bow, bend) = (33.0f64, -21.0, 12.5);
    let settings = [("head.turn", turn as f32), ("head.bow", bow as f32), ("head.bend", bend as f32)];
    // In the world: about up, about the character's left, about backward. The last factor acts first.
    let about = |axis: DVec3, degrees: f64| DMat3::from_axis_angle(axis, degrees.to_radians());
    let product = about(DVec3::Y, turn) * about(DVec3::X, bow) * about(DVec3::NEG_Z, bend);
    for from in [Vec3::X, Vec3::Y, Vec3::Z] {
        let expected = (product * from.as_dvec3()).as_vec3();
        let found = moved(&settings, "HeadJoint", from);
        assert_abs_diff_eq!(found.to_array()[..], expected.to_array()[..], epsilon = 1e-6);
    }
    let product = about(DVec3::X, 15.0) * about(DVec3::Y, -5.0);
    let found = moved(&[("jaw.open", 15.0), ("jaw.jut", -5.0)], "JawJoint", Vec3::Z);
    let expected = (product * DVec3::Z).as_vec3();
    assert_abs_diff_eq!(found.to_array()[..], expected.to_array()[..], epsilon = 1e-6);
    let product = about(DVec3::NEG_X, 20.0) * about(DVec3::Y, 30.0);
    let found = moved(&[("eye.left.ud", 20.0), ("eye.left.lr", 30.0)], "LtEyeJoint", Vec3::Z);
    let expected = (product * DVec3::Z).as_vec3();
    assert_abs_diff_eq!(found.to_array()[..], expected.to_array()[..], epsilon = 1e-6);
}

#[test]
fn shapes_get_their_weights_and_other_joints_keep_their_transform() {
    let (rig, table, binding) = bound();
    let mut values = table.defaults();
    values[table.index("smile").unwrap()] = 0.25;
    values[table.index("frown").unwrap()] = 0.75;
    let (mut locals, mut weights) = (rig.locals(), [9.0; 2]);
    let neck = rig.joint("NeckJoint").unwrap();
    let shifted = glam::Affine3A::from_translation(Vec3::new(1.0, 2.0, 3.0));
    locals.set(neck, shifted).unwrap();
    binding.apply(&values, &mut locals, &mut weights).unwrap();
    assert_eq!(weights, [0.25, 0.75]);
    assert_eq!(locals.as_slice()[neck.index()], shifted);

    // The caller's order of shapes counts, not the table's.
    let swapped = table.bind(&rig, &["Frown", "other", "SSmile"]).unwrap();
    let mut weights = [9.0; 3];
    swapped.apply(&values, &mut locals, &mut weights).unwrap();
    assert_eq!(weights, [0.75, 9.0, 0.25]);
}

#[test]
fn translations_are_in_units_of_the_rig() {
    let text = "[[control]]\nname='a'\njoint='NeckJoint'\naxis=[0,0,-2]\nkind='translation'\nmin=-3\nmax=3";
    let rig = rig();
    let binding = ControlTable::from_toml(text).unwrap().bind(&rig, &[]).unwrap();
    let mut locals = rig.locals();
    binding.apply(&[1.5], &mut locals, &mut []).unwrap();
    assert_eq!(locals.as_slice()[0].translation, glam::Vec3A::new(0.0, 0.0, -1.5));
}

#[test]
fn binding_names_what_is_missing() {
    let table = ControlTable::default_face();
    let error = table.bind(&rig(), &["Smile", "Frown"]).unwrap_err();
    let message =
        r#"control "smile": expected a blend shape of the face, found "SSmile"; did you mean "Smile"?"#;
    assert_eq!(error.to_string(), message);
    let lone = RawRig { joints: vec![RawJoint::new("HaedJoint", None, Mat4::IDENTITY)] };
    let error = table.bind(&Rig::from_raw(&lone).unwrap(), &SHAPES).unwrap_err();
    assert!(matches!(&error, BindError::UnknownJoint { control, .. } if control == "head.turn"));
    let message =
        r#"control "head.turn": expected a joint of the rig, found "HeadJoint"; did you mean "HaedJoint"?"#;
    assert_eq!(error.to_string(), message);
}

#[test]
fn wrong_slices_and_numbers_are_errors_and_change_nothing() {
    let (rig, table, binding) = bound();
    let (mut locals, mut weights) = (rig.locals(), [0.5; 2]);
    let mut values = vec![1.0; table.len()];
    let error = binding.apply(&values[1..], &mut locals, &mut weights).unwrap_err();
    assert_eq!(error.to_string(), "expected 15 control values, found 14");
    let error = binding.apply(&values, &mut locals, &mut [0.0; 3]).unwrap_err();
    assert_eq!(error, ApplyError::Length { what: "shape weights", expected: 2, found: 3 });
    let other = Rig::from_raw(&RawRig { joints: vec![RawJoint::new("a", None, Mat4::IDENTITY)] }).unwrap();
    let error = binding.apply(&values, &mut other.locals(), &mut weights).unwrap_err();
    assert_eq!(error, ApplyError::Length { what: "local transforms", expected: 9, found: 1 });
    values[3] = f32::NAN;
    let error = binding.apply(&values, &mut locals, &mut weights).unwrap_err();
    assert!(matches!(error, ApplyError::NotFinite { control: 3, .. }));
    assert_eq!((locals, weights), (rig.locals(), [0.5; 2]));
}

fn coupled() -> (ControlTable, Binding) {
    let text = format!(
        "{DEFAULT_CONTROLS_TOML}\n[[coupling]]\nfrom = 'eye.left.ud'\nto = 'lid.left.upper'\nfactor = -0.4\n"
    );
    let table = ControlTable::from_toml(&text).unwrap();
    let binding = table.bind(&rig(), &SHAPES).unwrap();
    (table, binding)
}

#[test]
fn a_lid_follows_its_eye_but_stays_closed() {
    let (table, binding) = coupled();
    let (eye, lid) = (table.index("eye.left.ud").unwrap(), table.index("lid.left.upper").unwrap());
    let effective = |eye_value: f32, lid_value: f32| {
        let mut values = table.defaults();
        (values[eye], values[lid]) = (eye_value, lid_value);
        let mut out = vec![f32::NAN; values.len()];
        binding.couple(&values, &mut out);
        for (index, value) in values.iter().enumerate() {
            assert!(index == lid || out[index] == *value);
        }
        out[lid]
    };
    assert_abs_diff_eq!(effective(20.0, 0.0), -8.0, epsilon = 1e-6);
    assert_abs_diff_eq!(effective(-20.0, 0.0), 8.0, epsilon = 1e-6);
    assert_eq!(effective(0.0, 12.0), 12.0);
    for eye_value in [-25.0, -1.0, 3.0, 25.0] {
        assert_eq!(effective(eye_value, 45.0), 45.0);
        assert_eq!(effective(eye_value, -10.0), -10.0);
    }
    assert_abs_diff_eq!(effective(10.0, 22.5), 20.5, epsilon = 1e-5);
    // Continuous and within the range everywhere, also where the sum would leave it.
    for step in 0..=550 {
        let value = -10.0 + 0.1 * step as f32;
        for eye_value in [-25.0, 25.0] {
            let here = effective(eye_value, value);
            assert!((-10.0..=45.0).contains(&here));
            assert!((effective(eye_value, value + 0.01) - here).abs() < 0.05);
        }
    }
}

#[test]
fn couplings_read_raw_values() {
    // a leads b, b leads c: c sees the raw b.
    let text = "
        control = [
            { name = 'a', shape = 'A', min = -1 }, { name = 'b', shape = 'B', min = -1 },
            { name = 'c', shape = 'C', min = -1 },
        ]
        coupling = [{ from = 'a', to = 'b', factor = 0.5 }, { from = 'b', to = 'c', factor = 1 }]";
    let binding = ControlTable::from_toml(text).unwrap().bind(&rig(), &["A", "B", "C"]).unwrap();
    let mut out = [0.0; 3];
    binding.couple(&[0.5, 0.0, 0.0], &mut out);
    assert_eq!(out, [0.5, 0.25, 0.0]);
    // Too short a slice is no reason to panic.
    binding.couple(&[0.5], &mut out);
    binding.couple(&[0.5, 0.0, 0.0], &mut out[..1]);
}

#[test]
fn paces_go_by_the_part_of_the_face() {
    let shape = |name: &str| Pace::of(&Drive::Shape { shape: name.to_owned() });
    let joint = |name: &str| {
        Pace::of(&Drive::Joint { joint: name.to_owned(), axis: Vec3::X, kind: JointMotion::Rotation })
    };
    for name in ["eyeBlinkLeft", "EyeBlink_R", "eyeSquintLeft", "eyeWideRight", "eyelid_close", "blink"] {
        assert_eq!((shape(name), joint(name)), (Pace::LID, Pace::LID), "{name}");
    }
    for name in ["eyeLookUpLeft", "eyeLookOutRight", "LtEyeJoint", "eye.L", "look_left", "gaze"] {
        assert_eq!((shape(name), joint(name)), (Pace::EYE, Pace::EYE), "{name}");
    }
    for name in ["browInnerUp", "eyebrow", "LtEyebrowJoint", "forehead"] {
        assert_eq!((shape(name), joint(name)), (Pace::SHAPE, Pace::SHAPE), "{name}");
    }
    assert_eq!(
        (shape("jawOpen"), joint("JawJoint"), joint("LtUpperLidJoint")),
        (Pace::JAW, Pace::JAW, Pace::LID)
    );
    assert_eq!((joint("HeadJoint"), joint("neck_01"), shape("head")), (Pace::HEAD, Pace::HEAD, Pace::HEAD));
    for name in ["mouthSmileLeft", "slide", "SSmile", "cheekPuff"] {
        assert_eq!((shape(name), joint(name)), (Pace::SHAPE, Pace::OTHER), "{name}");
    }
    // The name of the control helps where that of the shape tells nothing.
    let text = "control = [{ name = 'lid.left', shape = 'Morph17' }, { name = 'head.turn', shape = 'eyeBlinkLeft' }]";
    let table = ControlTable::from_toml(text).unwrap();
    assert_eq!(
        table.controls().iter().map(|control| control.pace).collect::<Vec<_>>(),
        [Pace::LID, Pace::LID]
    );
}
