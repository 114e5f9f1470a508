//! Frames on the controls of avatars.

use avatar_live::{ControlMap, Frame};
use pose_anim::{Control, ControlTable, Drive, Pace};

fn shapes(names: &[&str]) -> ControlTable {
    let control = |name: &&str| Control {
        name: (*name).to_owned(),
        drives: Drive::Shape { shape: (*name).to_owned() },
        min: 0.0,
        max: 1.0,
        default: 0.0,
        pace: Pace::SHAPE,
        group: None,
    };
    ControlTable::new(names.iter().map(control).collect()).unwrap()
}

fn frame(values: &[(&str, f32)]) -> Frame {
    let mut frame = Frame::default();
    for (name, value) in values {
        assert!(frame.set_named(name, *value), "{name}");
    }
    frame
}

fn shown(controls: &ControlTable, frame: &Frame) -> Vec<(String, f32)> {
    let mut values = controls.defaults();
    ControlMap::new(controls).apply(frame, &mut values);
    let moved = controls.controls().iter().zip(values).filter(|(control, value)| *value != control.default);
    moved.map(|(control, value)| (control.name.clone(), value)).collect()
}

#[test]
fn a_nine_joint_face_follows_shapes_by_its_joints() {
    let controls = ControlTable::default_face();
    let moved = shown(
        &controls,
        &frame(&[
            ("jawOpen", 1.0),
            ("eyeBlinkLeft", 1.0),
            ("eyeLookOutLeft", 0.5),
            ("eyeLookInLeft", 0.0),
            ("head.turn", 12.0),
            ("head.bow", 90.0),
        ]),
    );
    let of = |name: &str| moved.iter().find(|(other, _)| other == name).map_or(0.0, |(_, value)| *value);
    assert_eq!((of("head.turn"), of("head.bow")), (12.0, 40.0));
    assert_eq!(of("eye.left.lr"), 15.0);
    assert!(
        of("jaw.open") > 10.0 && of("lid.left.upper") > 20.0 && of("lid.right.upper") == 0.0,
        "{moved:?}"
    );
}

/// Performers of VMC send shapes of ARKit and expressions of VRM at once.
#[test]
fn shapes_move_a_nine_joint_face_whose_sender_has_expressions_too() {
    let controls = ControlTable::default_face();
    let moved = shown(&controls, &frame(&[("jawOpen", 1.0), ("aa", 0.0)]));
    assert!(moved.iter().any(|(name, value)| name == "jaw.open" && *value > 10.0), "{moved:?}");
}

#[test]
fn shapes_become_expressions_and_expressions_shapes() {
    let vrm = shapes(&["expression.aa", "expression.blinkLeft", "expression.blinkRight", "expression.happy"]);
    let moved = shown(&vrm, &frame(&[("jawOpen", 0.5), ("eyeBlinkLeft", 1.0)]));
    assert!(moved.iter().any(|(name, value)| name == "expression.aa" && *value > 0.2), "{moved:?}");
    assert!(moved.contains(&("expression.blinkLeft".to_owned(), 1.0)), "{moved:?}");
    // What a sender says in the avatar's own names is not led around.
    let own = shown(&vrm, &frame(&[("jawOpen", 1.0), ("aa", 0.25)]));
    assert_eq!(own, [("expression.aa".to_owned(), 0.25)]);

    let names: Vec<&str> = avatar_live::channels().iter().take(52).map(|channel| channel.name).collect();
    let arkit = shapes(&names);
    let moved = shown(&arkit, &frame(&[("aa", 1.0), ("blinkLeft", 1.0)]));
    assert!(moved.iter().any(|(name, value)| name == "jawOpen" && *value > 0.2), "{moved:?}");
    assert!(moved.contains(&("eyeBlinkLeft".to_owned(), 1.0)), "{moved:?}");
}
