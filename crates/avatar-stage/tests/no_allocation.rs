//! No frame of a performer allocates, whatever it does.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use avatar_stage::Performer;
use avatar_stage::avatar_pack::Springs;
use avatar_stage::avatar_pack::joint_springs::{Law, Spring};
use avatar_stage::glam::Vec3;
use avatar_stage::pose_anim::face;
use common::pack;

#[test]
fn no_frame_allocates() {
    let jaw = pack().rig().joint("JawJoint").unwrap().index();
    let law = Law::Oscillator { frequency_hz: 2.0, damping_ratio: 0.2, gravity: Vec3::NEG_Y };
    let mut swinging = pack().clone();
    swinging
        .set_springs(Springs { springs: vec![Spring::new(jaw, Vec3::NEG_Y, law)], ..Springs::default() })
        .unwrap();
    for pack in [pack().clone(), swinging] {
        without_allocation(Performer::new(pack));
    }
}

fn without_allocation(mut performer: Performer) {
    let size = pack().bounds().unwrap();
    let near = size.center() + Vec3::Z * 3.0 * size.size().z;
    let allocated = allocation_counter::measure(|| {
        for frame in 0..300u16 {
            match frame % 60 {
                0 => performer.press("smile").unwrap(),
                10 => performer.press("yawn").unwrap(),
                20 => performer.set(face::JAW_OPEN, 9.0).unwrap(),
                40 => performer.look_ahead(),
                50 => performer.stop(),
                _ => {}
            }
            if frame % 60 < 40 {
                performer.look_at(near + size.size() * (f32::from(frame) * 0.2).sin()).unwrap();
            }
            performer.advance(1.0 / 60.0).unwrap();
            assert!(performer.bones().len() + performer.weights().len() + performer.targets().len() > 0);
        }
    });
    assert_eq!(allocated.count_total, 0, "{allocated:?}");
}
