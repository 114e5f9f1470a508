//! Contents that contradict each other make no pack.
#![allow(clippy::expect_used, clippy::disallowed_methods, reason = "a test: it may panic and read files")]

use crate::common::marsienne;
use avatar_pack::{ContentsError, Pack, PackContents};
use pose_anim::{BindError, Clip, ClipSet, ControlTable, Easing, Key, Pose, PoseSet, Track};

fn refused(change: impl FnOnce(&mut PackContents)) -> ContentsError {
    let mut contents = marsienne().into_contents();
    change(&mut contents);
    Pack::new(contents).expect_err("a contradiction")
}

fn one_key(control: usize) -> ClipSet {
    let track = Track::new(control, vec![Key::new(0.0, 1.0, Easing::MinimumJerk)]).expect("a track");
    ClipSet { clips: vec![Clip::new("nod", vec![track]).expect("a clip")] }
}

#[test]
fn a_pack_taken_apart_goes_together_again() {
    let pack = marsienne();
    let again = Pack::new(pack.clone().into_contents()).expect("the same pack");
    assert_eq!((again.controls(), again.poses()), (pack.controls(), pack.poses()));
}

#[test]
fn every_contradiction_is_refused_with_its_place() {
    let text = |change: &dyn Fn(&mut PackContents)| refused(|contents| change(contents)).to_string();
    let (shapes, controls) = (marsienne().shapes().len(), marsienne().controls().controls().len());
    assert_eq!(
        text(&|contents| contents.parts[0].bone = Some(99)),
        r#"part "skin": expected the index of one of 9 bones, found 99"#
    );
    assert_eq!(
        text(&|contents| _ = contents.palette.pop()),
        r#"part "right-eyeball": expected the index of one of 8 bones, found 8"#,
    );
    assert_eq!(
        text(&|contents| _ = contents.shapes.pop()),
        format!(r#"part "lower-jaw": expected the index of one of {0} shapes, found {0}"#, shapes - 1)
    );
    let renamed = refused(|contents| {
        contents.sliders.as_mut().expect("further shapes have sliders").names[0] = "Grin".to_owned();
    });
    assert!(matches!(renamed, ContentsError::Bind(BindError::UnknownShape { .. })), "{renamed}");
    assert_eq!(
        text(&|contents| contents.poses.poses.push(Pose::new("odd", vec![(500, 1.0)]))),
        format!(r#"pose "odd": expected the index of one of {controls} controls, found 500"#)
    );
    assert_eq!(
        text(&|contents| contents.clips = one_key(controls)),
        format!(r#"clip "nod": expected the index of one of {controls} controls, found {controls}"#)
    );
    // Other controls, and the poses of the old ones.
    assert!(matches!(
        refused(|contents| contents.controls = ControlTable::new(Vec::new()).expect("none")),
        ContentsError::Index { what: "controls", count: 0, .. }
    ));
}

#[test]
fn poses_and_clips_that_do_not_fit_leave_those_before() {
    let mut pack = marsienne();
    let (before, controls) = (pack.clone(), pack.controls().controls().len());
    let odd = PoseSet { poses: vec![Pose::new("odd", vec![(500, 1.0)])] };
    pack.set_poses(odd).expect_err("no such control");
    pack.set_clips(one_key(controls)).expect_err("no such control");
    assert_eq!((pack.poses(), pack.clips()), (before.poses(), before.clips()));
    pack.set_clips(one_key(controls - 1)).expect("a clip of the last control");
    assert_eq!(pack.clips(), &one_key(controls - 1));
}
