//! Uses all that a scene says.

use avatar_exchange::{Scene, glb, gltf, memory};
use avatar_mesh::deform;
use avatar_pack::{FaceState, Import, Pack, Textures, export};

/// Clips that are looked at: one reader makes all of a scene's clips, so a few stand for the others.
const CLIPS: usize = 4;

/// Runs a part of a target and checks the memory that it has at one time.
pub(crate) fn within_memory<T>(input: usize, what: &str, run: impl FnOnce() -> T) -> T {
    let mut result = None;
    let taken = allocation_counter::measure(|| result = Some(run())).bytes_max;
    let allowed = memory::most(input as u64);
    assert!(taken <= allowed, "{what} took {taken} bytes of memory, {allowed} are allowed");
    match result {
        Some(result) => result,
        None => unreachable!("the closure has run"),
    }
}

/// Poses a scene, writes it as GLB, which must be readable, and makes an avatar of it.
pub(crate) fn exercise(scene: Scene, input: usize) {
    pose(&scene);
    if let Ok(bytes) = glb::write(&scene) {
        let again = gltf::read("written.glb", &bytes, &mut |_| Err("all is embedded".to_owned()));
        if let Err(error) = again {
            panic!("what was written cannot be read: {error}");
        }
    }
    let import = within_memory(input, "the import", || Import::from_scene(scene));
    if let Ok(Import { pack, textures, report }) = import {
        let _ = report.to_string();
        act(&pack, &textures);
    }
}

fn pose(scene: &Scene) {
    let mut poses = vec![scene.rest()];
    for (number, clip) in scene.clips.iter().enumerate().take(CLIPS) {
        for time in [-1.0, 0.3 * clip.duration_secs(), f64::INFINITY, f64::NAN] {
            poses.extend(scene.at(number, time));
        }
    }
    for pose in &poses {
        let bones = scene.bones(pose);
        for (number, part) in scene.parts.iter().enumerate() {
            let mut out = part.mesh.deformed();
            let (bones, weights) = (scene.bones_of(number, &bones), scene.weights_of(number, pose));
            if let Err(error) = deform(&part.mesh, bones, weights, &mut out) {
                panic!("a checked part cannot be deformed: {error}");
            }
        }
    }
}

/// Poses an avatar with all controls at rest and at both ends, and by its clips, then exports it.
pub(crate) fn act(pack: &Pack, textures: &Textures) {
    let mut state = FaceState::new(pack);
    let ends = |end: fn(&pose_anim::Control) -> f32| pack.controls().controls().iter().map(end).collect();
    let values: [Vec<f32>; 3] = [pack.controls().defaults(), ends(|it| it.min), ends(|it| it.max)];
    for values in &values {
        if let Err(error) = state.pose(pack, values) {
            panic!("a pack's own values are refused: {error}");
        }
        for part in 0..pack.parts().len() {
            if let Err(error) = state.deform(pack, part) {
                panic!("a checked part cannot be deformed: {error}");
            }
        }
        for secs in [0.0, 0.02, 0.9] {
            if let Err(error) = state.swing(pack, secs) {
                panic!("a pack's own springs are refused: {error}");
            }
        }
        if let Err(error) = state.settle(pack) {
            panic!("a pack's own springs are refused: {error}");
        }
    }
    if let Some(motion) = pack.motion() {
        for clip in motion.clips().iter().take(CLIPS) {
            for time in [0.0, 0.25, f64::NAN] {
                if let Ok(at) = motion.at(clip, time) {
                    let _ = state.pose_toward(pack, &values[0], &at, 0.5);
                }
            }
        }
    }
    let scene = export(pack, textures);
    let _ = Scene::from_raw(scene);
}
