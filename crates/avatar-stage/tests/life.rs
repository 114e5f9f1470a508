//! A face that lives.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod common;

use avatar_stage::Performer;
use avatar_stage::avatar_life::{Life, Style};
use common::pack;

#[test]
fn a_performer_shows_its_pose_with_life_on_top() {
    let pack = pack();
    let mut face = Performer::new(pack.clone());
    let mut still = Performer::new(pack.clone());
    let life = Life::new(pack.controls(), Style::default(), 4);
    face.set_life(Some(life.clone())).unwrap();
    for performer in [&mut face, &mut still] {
        performer.press("smile").unwrap();
    }
    let mut alone = life;
    let mut expected = vec![0.0; pack.controls().len()];
    for frame in 0..300 {
        for performer in [&mut face, &mut still] {
            performer.advance(1.0 / 60.0).unwrap();
        }
        alone.advance(1.0 / 60.0).unwrap();
        alone.apply(still.values(), &mut expected).unwrap();
        assert_eq!((face.values(), face.shown()), (still.values(), &expected[..]), "frame {frame}");
        assert_ne!(face.bones(), still.bones(), "frame {frame}");
    }
    // The life of an avatar with other controls is none of this one's.
    let other = Life::new(&Default::default(), Style::default(), 4);
    assert!(face.set_life(Some(other)).is_err());
    assert_eq!(face.shown(), expected);
    face.set_life(None).unwrap();
    assert_eq!((face.shown(), face.bones()), (still.values(), still.bones()));
}
