//! What swings by itself: `springs.toml`, and what it does to a face.
#![allow(clippy::expect_used, reason = "a test: it may panic")]

use crate::common::golden;
use avatar_pack::joint_springs::{
    Collider, Constraint, ConstraintKind, Law, Shape, Spring, SpringError, Swing,
};
use avatar_pack::{ContentsError, FaceState, MemorySource, Pack, PackError, Springs, raw_files};
use glam::{Affine3A, Mat4, Quat, Vec3};
use rig_core::{RawJoint, RawRig, Rig};

/// The golden rig with a braid of three joints below the head, each a unit below the one before.
fn with_braid(springs: &str) -> Result<Pack, PackError> {
    let mut source = golden();
    let bytes = source.files.get("Transformations.xml").expect("a rig");
    let mut rig = RawRig::from_xml(bytes).expect("a good rig");
    for (name, above, place) in [
        ("Braid1", "HeadJoint", Vec3::new(0.5, 1.0, -1.0)),
        ("Braid2", "Braid1", Vec3::NEG_Y),
        ("Braid3", "Braid2", Vec3::NEG_Y),
    ] {
        rig.joints.push(RawJoint::new(name, Some(above), Mat4::from_translation(place)));
    }
    source.files.insert("Transformations.xml".to_owned(), rig.to_xml().expect("a rig").into_bytes());
    source.files.insert("springs.toml".to_owned(), springs.as_bytes().to_vec());
    Pack::load(&source)
}

const BRAID: &str = r#"
[[collider]]
name = "head"
joint = "HeadJoint"
sphere = { offset = [0, 0.5, 0], radius = 0.75 }

[[collider]]
name = "back"
joint = "NeckJoint"
plane = { offset = [0, 0, -3], normal = [0, 0, 1] }

[[collider]]
name = "hull"
joint = "NeckJoint"
capsule = { tail = [0, 1, 0], radius = 20 }
inside = true

[[chain]]
joints = ["Braid1", "Braid2", "Braid3"]
frequency = 1.5
damping = 0.25
gravity = [0.5, -2, 0]
radius = 0.125
colliders = ["back", "head"]

[[chain]]
joints = ["Braid3"]
tail = [0, -0.5, 0]
stiffness = 0.75
drag = 0.25
colliders = ["hull"]
center = "HeadJoint"
"#;

fn joint(pack: &Pack, name: &str) -> usize {
    pack.rig().joint(name).expect(name).index()
}

#[test]
fn chains_and_colliders_are_read() {
    let pack = with_braid(BRAID).expect("a good pack");
    let number = |name| joint(&pack, name);
    let colliders = [
        ("HeadJoint", Shape::Sphere { offset: Vec3::Y * 0.5, radius: 0.75, inside: false }),
        ("NeckJoint", Shape::Plane { offset: Vec3::Z * -3.0, normal: Vec3::Z }),
        ("NeckJoint", Shape::Capsule { offset: Vec3::ZERO, tail: Vec3::Y, radius: 20.0, inside: true }),
    ];
    let colliders = colliders.map(|(name, shape)| Collider { joint: number(name), shape });
    assert_eq!(pack.springs().colliders, colliders);
    let law = Law::Oscillator { frequency_hz: 1.5, damping_ratio: 0.25, gravity: Vec3::new(0.5, -2.0, 0.0) };
    let of_braid = |name| Spring {
        hit_radius: 0.125,
        colliders: vec![1, 0],
        ..Spring::new(number(name), Vec3::NEG_Y, law)
    };
    let rule = Law::Vrm { stiffness: 0.75, drag: 0.25, gravity: Vec3::ZERO };
    let end = Spring {
        center: Some(number("HeadJoint")),
        colliders: vec![2],
        ..Spring::new(number("Braid3"), Vec3::Y * -0.5, rule)
    };
    // The last joint of a chain without a tail is its end, and free for another chain.
    let expected = [of_braid("Braid1"), of_braid("Braid2"), end];
    let found = &pack.springs().springs;
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found.tail - expected.tail).length() < 1e-5, "{found:?}");
        assert_eq!(&Spring { tail: expected.tail, ..found.clone() }, expected);
    }
    // What a chain does not say.
    let plain = with_braid("[[chain]]\njoints = [\"Braid1\", \"Braid3\"]").expect("a good pack");
    let Spring { law, tail, hit_radius, center, colliders, .. } = &plain.springs().springs[0];
    let usual = Law::Oscillator { frequency_hz: 2.0, damping_ratio: 0.3, gravity: Vec3::ZERO };
    assert_eq!((*law, *hit_radius, *center, colliders.len()), (usual, 0.0, None, 0));
    assert!((*tail - Vec3::Y * -2.0).length() < 1e-5, "to the next joint that is named: {tail}");
    let rule =
        with_braid("[[chain]]\njoints = [\"Braid1\", \"Braid3\"]\nstiffness = 3").expect("a good pack");
    let usual = Law::Vrm { stiffness: 3.0, drag: 0.5, gravity: Vec3::ZERO };
    assert_eq!(rule.springs().springs[0].law, usual);
}

#[test]
fn mistakes_are_told_with_their_place() {
    let chain = "[[chain]]\njoints = [\"Braid1\", \"Braid2\"]\n";
    for (text, expected) in [
        (
            "[[chain]]\n",
            "line 1, column 1: chain.joints: expected names of joints, each below the one before, found none",
        ),
        (
            "[[chain]]\njoints = [\"Braid1\", \"Braid9\"]",
            "line 2, column 21: chain.joints: expected the name of a joint, found \"Braid9\"; did you mean \"Braid1\"?",
        ),
        (
            "[[chain]]\njoints = [\"Braid2\", \"Braid1\"]",
            "line 2, column 21: chain.joints: expected a joint below \"Braid2\", found \"Braid1\"",
        ),
        (
            "[[chain]]\njoints = [\"Braid2\"]",
            "line 2, column 10: chain.joints: expected two joints at least, or one and a tail, found 1",
        ),
        (
            &format!("{chain}{chain}"),
            "line 4, column 11: chain.joints: expected a joint that no other chain moves, found \"Braid1\" again",
        ),
        (
            &format!("{chain}frequency = 0"),
            "line 3, column 13: chain.frequency: expected a number from 0.05 to 100, found 0",
        ),
        (
            &format!("{chain}drag = 1.5"),
            "line 3, column 8: chain.drag: expected a number from 0 to 1, found 1.5",
        ),
        (
            &format!("{chain}damping = 1\nstiffness = 1"),
            "line 4, column 13: chain.stiffness: expected either frequency and damping or stiffness and drag, found both",
        ),
        (
            &format!("{chain}gravity = 9.81"),
            "line 3, column 11: chain.gravity: expected an array of three numbers from -1000000 to 1000000, found 9.81",
        ),
        (
            &format!("{chain}radius = -1"),
            "line 3, column 10: chain.radius: expected a number from 0 to 1000000, found -1",
        ),
        (
            &format!("{chain}colliders = [\"head\"]"),
            "line 3, column 14: chain.colliders: expected no collider where there is none, found \"head\"",
        ),
        (
            &format!("{chain}center = \"Head\""),
            "line 3, column 10: chain.center: expected the name of a joint, found \"Head\"",
        ),
        (
            &format!("{chain}mass = 1"),
            "line 3, column 1: chain.mass: expected one of the keys joints, tail, ",
        ),
        (
            "[[collider]]\nname = \"a\"\njoint = \"HeadJoint\"",
            "line 1, column 1: collider.sphere: expected one of sphere, capsule and plane, found none",
        ),
        (
            "[[collider]]\nname = \"a\"\njoint = \"HeadJoint\"\nsphere = { radius = 1 }\nplane = { normal = [0, 1, 0] }",
            "line 5, column 9: collider.plane: expected one of sphere, capsule and plane, found two",
        ),
        (
            "[[collider]]\nname = \"a\"\njoint = \"HeadJoint\"\nsphere = {}",
            "line 4, column 10: collider.sphere.radius: expected a number from 0 to 1000000, found none",
        ),
        (
            "[[collider]]\nname = \"a\"\njoint = \"HeadJoint\"\nplane = { normal = [0, 0, 0] }",
            "line 4, column 20: collider.plane.normal: expected a direction, found none",
        ),
        (
            "[[collider]]\nname = \"a\"\njoint = \"HeadJoint\"\nplane = { normal = [0, 0, 1] }\ninside = true",
            "line 5, column 10: collider.inside: expected inside beside a sphere or capsule, found it beside a plane",
        ),
        (
            "[[spring]]\n",
            "line 1, column 3: spring: expected one of the keys chain, collider, found \"spring\"",
        ),
    ] {
        let told = with_braid(text).expect_err(expected).to_string();
        assert!(told.starts_with(&format!("springs.toml: {expected}")), "{told}\n{expected}");
    }
}

#[test]
fn what_is_written_is_read_as_the_same() {
    let pack = with_braid(BRAID).expect("a good pack");
    let written = pack.springs().to_toml(pack.rig().names());
    assert_eq!(Springs::from_toml(&written, pack.rig()).as_ref(), Ok(pack.springs()), "{written}");
    let files = raw_files(&pack, &avatar_pack::Textures::default()).expect("a pack").files;
    let again = Pack::load(&MemorySource { files: files.into_iter().collect() }).expect("a good pack");
    assert_eq!(again.springs(), pack.springs());
}

/// A swing of the crate by hand, on the same pose.
#[test]
fn a_state_swings_and_settles_as_its_springs() {
    let pack = with_braid(BRAID).expect("a good pack");
    let springs = pack.springs();
    let parents: Vec<_> = pack.rig().parents().iter().map(|parent| parent.map(|p| p.index())).collect();
    let mut by_hand =
        Swing::new(&parents, springs.springs.clone(), springs.colliders.clone()).expect("a swing");
    let mut state = FaceState::new(&pack);
    let head = pack.rig().joint("HeadJoint").expect("a head");
    let (mut locals, mut posed) = (pack.rig().locals(), pack.rig().pose());
    let values = pack.controls().defaults();
    for frame in 0..90u16 {
        let turn = Affine3A::from_rotation_y(0.6 * (f32::from(frame) * 0.12).sin());
        state.pose_with(&pack, &values, |_| {}, &[(head, turn)]).expect("a pose");
        locals.set(head, turn).expect("a joint");
        pack.rig().update(locals.as_slice(), &mut posed).expect("a pose");
        let mut world = posed.world_from_joint().to_vec();
        assert_eq!(state.rig_pose().world_from_joint(), world, "a pose alone does not swing");
        match frame {
            0 | 60 => {
                state.settle(&pack).expect("a pose");
                by_hand.settle(&mut world).expect("a pose");
                assert!(!state.swings());
            }
            _ => {
                state.swing(&pack, 1.0 / 60.0).expect("a pose");
                by_hand.advance(1.0 / 60.0, &mut world).expect("a pose");
                assert!(state.swings() || frame < 3);
            }
        }
        assert_eq!(state.rig_pose().world_from_joint(), world);
        // Bone matrices follow.
        for (joint, skin) in state.rig_pose().posed_from_bind().iter().enumerate() {
            assert_eq!(*skin, world[joint] * pack.rig().bind_from_world()[joint]);
        }
    }
}

#[test]
fn joints_turn_with_others_in_every_pose() {
    let mut pack = with_braid("").expect("a good pack");
    let (braid, jaw) = (joint(&pack, "Braid1"), joint(&pack, "JawJoint"));
    let follows = Constraint { joint: braid, source: jaw, weight: 0.5, kind: ConstraintKind::Rotation };
    pack.set_springs(Springs { constraints: vec![follows], ..Springs::default() }).expect("a constraint");
    let mut state = FaceState::new(&pack);
    let turn = Affine3A::from_quat(Quat::from_rotation_x(0.8));
    let jaw = pack.rig().joint("JawJoint").expect("a jaw");
    state.pose_with(&pack, &pack.controls().defaults(), |_| {}, &[(jaw, turn)]).expect("a pose");
    let world = state.rig_pose().world_from_joint();
    let head = world[joint(&pack, "HeadJoint")];
    let (_, found, _) = (head.inverse() * world[braid]).to_scale_rotation_translation();
    let (_, rest, _) = pack.rig().parent_from_joint()[braid].to_scale_rotation_translation();
    let expected = rest * Quat::from_rotation_x(0.4);
    assert!(found.angle_between(expected) < 1e-3, "{found} for {expected}");
    assert!(!state.swings(), "a constraint is no spring");
}

#[test]
fn springs_that_do_not_fit_are_refused() {
    let mut pack = with_braid(BRAID).expect("a good pack");
    let before = pack.springs().clone();
    let twice = Springs { springs: [&before.springs[..], &before.springs[..1]].concat(), ..before.clone() };
    let joint = before.springs[0].joint;
    assert_eq!(
        pack.set_springs(twice),
        Err(ContentsError::Springs(SpringError::Twice { what: "springs", joint }))
    );
    let itself = Constraint { joint: 0, source: 0, weight: 1.0, kind: ConstraintKind::Rotation };
    let circle = Springs { constraints: vec![itself], ..Springs::default() };
    assert_eq!(pack.set_springs(circle), Err(ContentsError::Springs(SpringError::Circle { joint: 0 })));
    assert_eq!(pack.springs(), &before);
}

/// The ends of springs go where their places go.
#[test]
fn springs_of_another_person_fit_the_joints() {
    let mut source = golden();
    let axis = "[[axis]]\nname = \"tall\"\nless = \"low\"\nmore = \"tall\"\n[[axis.map]]\ncenter = [0, 2, 0]\n\
                radii = [1e5, 1e5, 1e5]\nfull = 0.9\nscale = [1, 2, 1]\n";
    source.files.insert("identity.toml".to_owned(), axis.as_bytes().to_vec());
    let springs = "[[chain]]\njoints = [\"JawJoint\"]\ntail = [0, -1, 0]\ncolliders = [\"c\"]\n\
                   [[collider]]\nname = \"c\"\njoint = \"HeadJoint\"\nsphere = { offset = [0, 1, 0], radius = 1 }\n";
    source.files.insert("springs.toml".to_owned(), springs.as_bytes().to_vec());
    let pack = Pack::load(&source).expect("a good pack");
    let person = pack.with_identity(&[1.0]).expect("a person");
    let places = |pack: &Pack| {
        let world = pack.rig().world_from_bind();
        let (spring, collider) = (&pack.springs().springs[0], pack.springs().colliders[0]);
        let Shape::Sphere { offset, radius, .. } = collider.shape else { unreachable!("it is a sphere") };
        assert_eq!(radius, 1.0);
        [world[spring.joint].transform_point3(spring.tail), world[collider.joint].transform_point3(offset)]
    };
    for (before, after) in places(&pack).into_iter().zip(places(&person)) {
        let expected = Vec3::new(before.x, 2.0 + (before.y - 2.0) * 2.0, before.z);
        assert!((after - expected).length() < 1e-3, "{before} goes to {after}, not {expected}");
    }
}

/// Reading needs no pack.
#[test]
fn a_rig_alone_is_enough() {
    let rig =
        Rig::from_raw(&RawRig { joints: vec![RawJoint::new("a", None, Mat4::IDENTITY)] }).expect("a rig");
    let springs = Springs::from_toml("[[chain]]\njoints = [\"a\"]\ntail = [1, 0, 0]", &rig).expect("a chain");
    assert_eq!(springs.springs.len(), 1);
    assert_eq!(Springs::from_toml("", &rig), Ok(Springs::default()));
}
