//! Many faces of one pack against faces one by one.

#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "helpers of tests fail as tests do, and read files"
)]

use avatar_pack::{FaceCrowd, FaceError, FaceState, MemorySource, Pack};
use glam::Affine3A;
use pose_anim::{Player, PlayerCrowd, Pose};
use std::path::Path;

/// The built-in avatar without its textures.
fn built_in() -> Pack {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if !name.ends_with(".png") {
            source.files.insert(name, std::fs::read(path).unwrap());
        }
    }
    Pack::load(&source).unwrap()
}

fn check(pack: &Pack) {
    const FACES: usize = 37;
    let mut crowd = PlayerCrowd::new(pack.controls(), FACES);
    let mut players = vec![Player::new(pack.controls()); FACES];
    let mut faces = FaceCrowd::new(pack, FACES);
    let mut state = FaceState::new(pack);
    let mut bones = vec![Affine3A::IDENTITY; pack.palette().len()];
    let mut weights = vec![0.0; pack.shapes().len()];
    let size = pack.rig().world_from_bind().iter().map(|w| w.translation.length()).fold(1.0, f32::max);
    for round in 0..4 {
        for (face, player) in players.iter_mut().enumerate() {
            let share = |control: usize| ((face * 31 + control * 17 + round * 7) % 11) as f32 / 10.0;
            let controls = pack.controls().controls().iter().enumerate();
            let values: Vec<_> = controls.map(|(i, c)| c.min + share(i) * (c.max - c.min)).collect();
            let pose = Pose::from_values("p", &values);
            crowd.press(face, &pose).unwrap();
            player.press(&pose);
        }
        for _ in 0..5 {
            crowd.advance(0.03).unwrap();
            Player::advance_all(&mut players, 0.03).unwrap();
        }
        faces.pose(pack, &crowd).unwrap();
        for (face, player) in players.iter().enumerate() {
            state.pose(pack, player.values()).unwrap();
            faces.copy_bones(pack, face, &mut bones).unwrap();
            faces.copy_weights(face, &mut weights);
            assert_eq!(weights, state.weights());
            for (crowd, single) in bones.iter().zip(state.bones()) {
                assert!(crowd.abs_diff_eq(*single, 1e-6 * size), "{crowd:?} {single:?}");
            }
        }
    }
}

#[test]
fn the_built_in_face_is_the_same_in_a_crowd() {
    check(&built_in());
}

/// Of a file with shapes behind sliders.
#[test]
fn sliders_are_run_for_each_face() {
    let import = super::sliders::avatar();
    assert!(import.pack.sliders().is_some());
    check(&import.pack);
}

#[test]
fn what_a_crowd_does_not_have() {
    let pack = built_in();
    let mut faces = FaceCrowd::new(&pack, 3);
    let players = PlayerCrowd::new(pack.controls(), 4);
    assert!(matches!(faces.pose(&pack, &players), Err(FaceError::ValueCount { .. })));
    let mut bones = vec![Affine3A::IDENTITY; pack.palette().len()];
    let error = faces.copy_bones(&pack, 3, &mut bones).unwrap_err();
    assert_eq!(error.to_string(), "expected a face below 3, the number of faces in the crowd, found 3");
    let mut untouched = [7.0; 2];
    faces.copy_weights(3, &mut untouched);
    assert_eq!((untouched, faces.len(), faces.is_empty()), ([7.0; 2], 3, false));
}
