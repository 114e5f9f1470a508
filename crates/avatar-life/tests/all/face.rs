//! A face for tests and benches.

use pose_anim::{Control, ControlTable, Drive, Pace};

/// A control of a shape, from 0 to 1.
pub(crate) fn shape(name: &str) -> Control {
    Control {
        name: name.to_owned(),
        drives: Drive::Shape { shape: name.to_owned() },
        min: 0.0,
        max: 1.0,
        default: 0.0,
        pace: Pace::SHAPE,
        group: None,
    }
}

/// The nine-joint face with the shapes of ARKit that move by themselves.
pub(crate) fn full() -> ControlTable {
    let more = [
        "browInnerUp",
        "browOuterUpLeft",
        "browOuterUpRight",
        "browDownLeft",
        "browDownRight",
        "noseSneerLeft",
        "noseSneerRight",
    ];
    let table = ControlTable::default_face();
    let all = table.controls().iter().cloned().chain(more.iter().map(|name| shape(name)));
    ControlTable::new(all.collect()).unwrap()
}
