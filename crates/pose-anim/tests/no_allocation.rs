//! Neither time nor presses allocate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pose_anim::{
    Clip, ControlTable, Easing, JointPlayer, JointTarget, Key, LayerMode, Layers, Player, PoseSet, Timing,
    Track, Wrap,
};
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
