//! A face tracker's recording on the built-in face.
#![allow(clippy::expect_used, reason = "a test may panic")]

use crate::common::{marsienne, shared};
use avatar_pack::{FaceState, ShapeSet};
use pose_anim::Recording;

/// Three seconds of a person who talks: 180 rows of 186 frames, a sixtieth of a second each.
#[test]
fn a_phones_recording_plays_within_the_bounds_of_all_shapes() {
    let Some(source) = shared("livelink-recording") else { return };
    let text = String::from_utf8(source.files["dao.csv"].clone()).expect("a text");
    let pack = marsienne();
    let Recording { clip, passed_over, .. } =
        Recording::from_csv("dao", &text, pack.controls()).expect("a recording");
    assert!(passed_over.is_empty(), "{passed_over:?}");
    let track = |name: &str| clip.track(pack.controls().index(name).expect(name)).expect(name);
    let last_secs = (5_375_921.237_316_132 - 5_375_735.121_925_354) / 60.0;
    assert!((clip.duration_secs() - last_secs).abs() < 1e-6, "{} s", clip.duration_secs());
    // The 52 shapes and the head; each weight is that of the file.
    assert_eq!(clip.tracks().len(), 52 + 3);
    let mut lines = text.lines();
    let columns: Vec<&str> = lines.next().expect("names").split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 180);
    for name in ShapeSet::ArKit.names() {
        let column = columns.iter().position(|column| column.eq_ignore_ascii_case(name)).expect(name);
        for (row, key) in rows.iter().zip(track(name).keys()) {
            assert_eq!(row[column].parse::<f64>(), Ok(key.value), "{name}");
            assert!((0.0..=1.0).contains(&key.value), "{name}: {}", key.value);
        }
        assert_eq!(track(name).keys().len(), rows.len());
    }
    // At four times the rate, whatever mixtures and correctives make of it.
    let mut state = FaceState::new(&pack);
    let mut most = vec![0.0f32; pack.shapes().len()];
    for step in 0..=744 {
        let mut values = pack.controls().defaults();
        clip.sample(f64::from(step) / 240.0, &mut values);
        state.pose(&pack, &values).expect("a pose");
        for (most, weight) in most.iter_mut().zip(state.weights()) {
            assert!((0.0..=1.0).contains(weight), "{weight} after {step} of 240 s");
            *most = most.max(*weight);
        }
        assert!(state.bones().iter().all(|bone| bone.is_finite()), "after {step} of 240 s");
    }
    // Nothing is lost on the way: greatest weights of single columns.
    for (name, expected) in [("browInnerUp", 0.882), ("mouthSmileLeft", 0.918), ("mouthLeft", 0.731)] {
        let shape = pack.shapes().iter().position(|shape| shape == name).expect(name);
        assert!((most[shape] - expected).abs() < 2e-3, "{name}: {}", most[shape]);
    }
}
