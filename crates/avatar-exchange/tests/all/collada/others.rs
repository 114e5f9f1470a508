//! Other people's files, and damaged ones.

use super::puppet::{WEIGHTS, puppet};
use super::read;
use crate::support::damage::{bounds, damage, files, read_any, triangles};
use crate::support::data::models;
use avatar_exchange::ScenePose;

/// Boxes are pycollada's, through trimesh, times the unit and with z up turned to y; so are numbers of
/// triangles and of meshes at nodes.
#[test]
fn other_peoples_files_have_the_sizes_that_another_reader_finds() {
    let Some(folder) = models("Collada") else { return };
    for (name, count, parts, low, high) in [
        ("duck.dae", 4212, 1, [-0.692985, 0.0992937, -0.613282], [0.961799, 1.6397, 0.539252]),
        ("COLLADA.dae", 6722, 2, [-4.0, 0.0, -2.0], [4.0, 1.08098, 2.0]),
        ("Cinema4D.dae", 1296, 3, [-100.0; 3], [314.019, 100.0, 310.63]),
        ("ConcavePolygon.dae", 64, 1, [-1.146, 1.6575, 1.6055], [-1.146, 3.1425, 3.0905]),
        ("cube_UTF16LE.dae", 12, 1, [-0.5; 3], [0.5; 3]),
        ("cube_tristrips.dae", 12, 1, [-50.0; 3], [50.0; 3]),
        (
            "anims_with_full_rotations_between_keys.DAE",
            768,
            64,
            [-0.31561, 0.0, -119.68456],
            [0.68595, 1.0, 0.5],
        ),
        ("regr01.dae", 172, 6, [-0.0051, 0.0, 0.0], [0.0078, 0.0162002, 0.0041998]),
        ("teapot_instancenodes.DAE", 2048, 2, [-4.823608, 0.0, -1.236898], [1.798858, 1.741637, 1.040253]),
    ] {
        let scene = read(name, &std::fs::read(folder.join(name)).unwrap()).unwrap();
        assert_eq!((triangles(&scene), scene.parts.len()), (count, parts), "{name}");
        let found = bounds(&scene);
        for (found, expected) in found.into_iter().flatten().zip([low, high].into_iter().flatten()) {
            assert!(
                (found - expected).abs() < 6e-6 * (1.0 + expected.abs()),
                "{name}: {found} is not {expected}"
            );
        }
    }
}

/// The bones of this file stand as they were bound, so that at rest all of them move the mesh alike; one of
/// its clips bends it.
#[test]
fn at_rest_bones_agree() {
    let Some(folder) = models("Collada") else { return };
    let name = "library_animation_clips.dae";
    let scene = read(name, &std::fs::read(folder.join(name)).unwrap()).unwrap();
    let spread = |pose: &ScenePose| {
        let bones = scene.bones(pose);
        let from_first = |bone: &glam::Affine3A| {
            bone.to_cols_array()
                .iter()
                .zip(bones[0].to_cols_array())
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f32::max)
        };
        bones.iter().map(from_first).fold(0.0, f32::max)
    };
    assert_eq!(scene.skins[0].joints.len(), 5);
    assert!(spread(&scene.rest()) < 1e-6);
    let clips: Vec<&str> = scene.clips.iter().map(|clip| clip.name.as_str()).collect();
    assert_eq!(clips, ["bend", "turn"]);
    let end = scene.clips[0].duration_secs();
    assert!(spread(&scene.at(0, 0.5 * end).unwrap()) > 0.1);
}

#[test]
fn other_peoples_files_load_or_are_refused() {
    let Some(folder) = models("Collada") else { return };
    let found = files(&folder, &["dae", "zae", "xml"]);
    assert!(found.len() >= 29, "{found:?}");
    let mut refused = Vec::new();
    for path in found {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if let Err(error) = read_any(read, &name, &std::fs::read(&path).unwrap()) {
            assert_eq!(error.found, "an archive; unpack it first", "{error}");
            refused.push(name);
        }
    }
    assert_eq!(refused, ["duck.zae", "duck_nomanifest.zae", "human.zae"]);
}

#[test]
fn damaged_files_are_refused_or_load() {
    let text = puppet("NORMALIZED", WEIGHTS);
    let all = text.len() / 64 + 1 + 400;
    let loaded = damage(read, "damaged.dae", text.as_bytes(), 400);
    assert!(loaded > 0 && loaded < all, "{loaded} of {all}");
    let Some(folder) = models("Collada") else { return };
    for name in ["cube_tristrips.dae", "box_nested_animation.dae"] {
        damage(read, name, &std::fs::read(folder.join(name)).unwrap(), 100);
    }
}
