//! A GLB with morph targets of other names than the pack's own.
#![allow(clippy::expect_used, reason = "a test may panic")]

use crate::export::{again, at_weight_1, marsienne};
use avatar_pack::{ExportTarget, FaceState, Pack, Textures, export_targets};

/// A target that is asked for shows at 1 what its controls do, in every part, and is all that the file has.
#[test]
fn targets_that_are_asked_for_replace_the_packs_own() {
    let pack = Pack::load(&marsienne()).expect("the default avatar");
    let target = |name: &str, set: &[(&str, f32)]| {
        let mut values = pack.controls().defaults();
        for (control, value) in set {
            values[pack.controls().index(control).expect(control)] = *value;
        }
        ExportTarget { name: name.to_owned(), values }
    };
    let targets = [
        target("aa", &[("jawOpen", 0.85), ("mouthUpperUpLeft", 0.25)]),
        target("neutral", &[]),
        target("blinkLeft", &[("eyeBlinkLeft", 1.0)]),
    ];
    let scene = again(&export_targets(&pack, &Textures::default(), &targets));
    assert!(scene.pack.poses().iter().all(|pose| pose.name != "smile"), "clips of shapes that are not there");
    let names: std::collections::BTreeSet<&String> = scene.pack.shapes().iter().collect();
    assert_eq!(names.into_iter().collect::<Vec<_>>(), ["aa", "blinkLeft"]);
    for wanted in [&targets[0], &targets[2]] {
        let mut state = FaceState::new(&pack);
        state.pose(&pack, &wanted.values).expect("a pose");
        for (number, part) in scene.pack.parts().iter().enumerate() {
            let posed = state.deform(&pack, number).expect("a part").positions;
            let found = at_weight_1(&part.mesh, &wanted.name).map(|(positions, _)| positions);
            let found = found.unwrap_or_else(|| part.mesh.positions.clone());
            let worst =
                posed.iter().zip(&found).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
            assert!(worst < 1e-4, "{} of {}: {worst}", wanted.name, part.name);
        }
    }
}
