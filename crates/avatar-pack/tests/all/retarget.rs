//! A tracker's stream on an avatar that has bones and expressions only.
#![cfg(feature = "vrm")]
#![allow(clippy::expect_used, reason = "a test may panic")]

use crate::vrm::{VRM, glb};
use avatar_exchange::vrm::read;
use avatar_pack::Import;

/// Of a tracker's stream, the head turns by its angles, the left eye by its look, and expressions show the
/// rest.
#[test]
fn a_trackers_stream_drives_bones_and_expressions() {
    let model = read("nina.vrm", &glb(VRM), &mut |_| Err(String::new())).expect("a VRM");
    let Import { pack, .. } = Import::from_vrm(model).expect("an avatar");
    let space = face_space::Standard::LiveLink.space();
    let mut live = space.rest();
    for (name, value) in [
        ("headYaw", 0.5),
        ("eyeLookUpLeft", 0.4),
        ("mouthSmileLeft", 1.0),
        ("mouthSmileRight", 0.5),
        ("browDownLeft", 0.5),
    ] {
        live[space.index(name).expect(name)] = value;
    }
    let mut values = pack.controls().defaults();
    avatar_pack::retarget(&pack).apply(&live, &mut values);
    let value = |name: &str| values[pack.controls().index(name).expect(name)];
    assert_eq!(value("head.turn"), 0.5f32.to_degrees());
    assert_eq!(value("eye.left.ud"), 10.0);
    assert_eq!((value("expression.happy"), value("expression.angry")), (0.75, 0.25));
    assert_eq!((value("mouth"), value("brows")), (0.0, 0.0));
}
