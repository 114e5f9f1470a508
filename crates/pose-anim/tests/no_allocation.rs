//! Neither time nor presses allocate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use lanes::Lanes;
use pose_anim::{
    Clip, ControlTable, Drive, Easing, JointPlayer, JointTarget, Key, LayerMode, Layers, Player, PlayerCrowd,
    PoseSet, Timing, Track, Wrap,
};
use rig_core::{RawJoint, RawRig, Rig, RigCrowd};
use std::sync::Arc;

#[test]
fn updates_do_not_allocate() {
    let table = ControlTable::default_face();
    let poses = PoseSet::default_face(&table);
    let mut late = poses.get("anger").unwrap().clone().along(Easing::Linear);
    late.timings.push((3, Timing { delay_secs: 0.05, factor: 2.0 }));
    let keys = [0.0, 0.5, 1.0].map(|time| Key::new(time, time, Easing::MinimumJerk)).to_vec();
    let clip = Clip::new("c", vec![Track::new(13, keys).unwrap()]).unwrap().wrapped(Wrap::PingPong);
    let clip = Arc::new(clip);
    let mut layers = Layers::new(&table);
    let layer = layers.add(&table, LayerMode::Additive, &[1.0; 15]);
    let mut players = vec![Player::new(&table); 3];
    let start = JointTarget { rotation: glam::Quat::IDENTITY, translation: glam::Vec3::ZERO };
    let mut joint = JointPlayer::new(start);

    let mut sum = 0.0;
    let counted = allocation_counter::measure(|| {
        for round in 0..200 {
            for pose in &poses {
                players[0].press(pose);
                players[1].press(&late);
                layers.base().press(pose);
                layers.fade_to(layer, (round % 3) as f32 / 2.0, 0.2);
                if let Some(player) = layers.layer(layer) {
                    player.press(pose);
                    player.play(&clip, None);
                }
                players[2].play(&clip, Some(0.1));
                joint
                    .press(JointTarget { rotation: glam::Quat::from_rotation_y(round as f32), ..start }, 0.3);
                players[1].stop();
                let dt_secs = 0.0007 * f64::from(round);
                let results = [
                    Player::advance_all(&mut players, dt_secs),
                    layers.advance(dt_secs),
                    joint.advance(dt_secs),
                ];
                sum += f64::from(u8::from(results.iter().all(Result::is_ok)));
                sum +=
                    f64::from(layers.values()[0]) + f64::from(players[2].values()[13]) + joint.rotation().w;
            }
        }
    });
    assert_eq!(counted.count_total, 0, "{sum}");
}

/// A crowd of faces on its way, with every kind of interruption.
#[test]
fn crowds_do_not_allocate() {
    let table = ControlTable::default_face();
    let poses = PoseSet::default_face(&table);
    let mut late = poses.get("anger").unwrap().clone().along(Easing::Linear);
    late.timings.push((3, Timing { delay_secs: 0.05, factor: 2.0 }));
    let keys = [0.0, 0.5, 1.0].map(|time| Key::new(time, time, Easing::MinimumJerk)).to_vec();
    let clip = Arc::new(Clip::new("c", vec![Track::new(13, keys).unwrap()]).unwrap().wrapped(Wrap::Loop));
    let mut raw = RawRig::default();
    for control in table.controls() {
        if let Drive::Joint { joint, .. } = &control.drives
            && raw.joints.iter().all(|known| &known.name != joint)
        {
            raw.joints.push(RawJoint::new(joint.as_str(), None, glam::Mat4::IDENTITY));
        }
    }
    let rig = Rig::from_raw(&raw).unwrap();
    let binding = table.bind(&rig, &["SSmile", "Frown"]).unwrap();
    let (mut players, mut rigs) = (PlayerCrowd::new(&table, 40), RigCrowd::new(&rig, 40));
    let mut effective = players.values().to_vec();
    let mut weights = vec![Lanes::splat(0.0); 2 * rigs.blocks()];

    let mut all_well = true;
    let counted = allocation_counter::measure(|| {
        for round in 0..50 {
            for (face, pose) in (0..40).zip(poses.iter().cycle()) {
                let pressed = match (face + round) % 9 {
                    0 => players.press(face, &late),
                    1 => players.play(face, &clip, Some(0.1)),
                    2 => players.stop(face),
                    _ => players.press(face, pose),
                };
                let tick = players.advance(0.0007 * f64::from(round as u32));
                binding.couple_crowd(players.values(), &mut effective);
                let applied = binding.apply_crowd(&effective, &mut rigs, &mut weights);
                rigs.update();
                all_well &= pressed.is_ok() && tick.is_ok() && applied.is_ok();
            }
        }
    });
    assert!(all_well && rigs.bones(0)[0].0[0][0].is_finite());
    assert_eq!(counted.count_total, 0);
}
