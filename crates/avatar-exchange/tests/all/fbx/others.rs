//! Other people's files, and damaged ones.

use super::{FACE, node, read};
use crate::support::damage::{bounds, damage, files, read_any, triangles};
use crate::support::data::models;
use avatar_exchange::fbx;

/// Numbers of the Open Asset Import Library 5.2.5, from its export to glTF, times 0.01 where it keeps
/// centimetres. Boxes of skinned meshes are those before skinning: its weights do not sum to 1.
#[test]
fn other_peoples_files_have_the_sizes_that_another_reader_finds() {
    let Some(folder) = models("FBX") else { return };
    let open = |name: &str| read(name, &std::fs::read(folder.join(name)).unwrap()).unwrap();
    let near = |found: f32, expected: f32| {
        assert!((found - expected).abs() < 2e-5 * (1.0 + expected.abs()), "{found} is not {expected}");
    };
    let mirrored = open("cubes_with_mirroring_and_pivot.fbx");
    assert_eq!(triangles(&mirrored), 420);
    let box_ = [-0.06067, -0.14515, -0.06044, 0.14866, 0.15981, 0.26727];
    bounds(&mirrored).iter().flatten().zip(box_).for_each(|(found, expected)| near(*found, expected));
    let spider = open("spider.fbx");
    assert_eq!((triangles(&spider), spider.nodes.len()), (1368, 22));
    let box_ = [-92.655_235, -42.233_826, -106.691_2, 57.936_22, 37.503_952, 86.691_2];
    bounds(&spider).iter().flatten().zip(box_).for_each(|(found, expected)| near(*found, expected));

    let bones = open("huesitos.fbx");
    let worlds = bones.worlds(&bones.rest());
    for (name, expected) in [
        ("Bone", [-0.04024, 0.0, -3.07135]),
        ("Bone.002", [-0.04024, 2.11188, -3.07135]),
        ("Bone.004", [0.88255, 2.11188, -3.41173]),
        ("Bone.006", [3.14413, 2.11188, -4.50092]),
        ("Bone.008", [-0.04024, 4.62308, -3.07135]),
    ] {
        let world = worlds[node(&bones, name)].translation.as_vec3().to_array();
        world.into_iter().zip(expected).for_each(|(found, expected)| near(found, expected));
    }
    let mesh = bones.parts[0].mesh.bounds().unwrap();
    let box_ = [-1.023_423_4, -1.023_423_4, -1.256_192_7, 4.334_299, 2.191_927_7, 4.182_18].map(|x| x * 0.01);
    mesh.min
        .to_array()
        .into_iter()
        .chain(mesh.max.to_array())
        .zip(box_)
        .for_each(|(found, expected)| near(found, expected));
    assert_eq!((triangles(&bones), bones.skins[0].joints.len(), bones.clips.len()), (120, 9, 1));

    let tube = open("animation_with_skeleton.fbx");
    assert_eq!((triangles(&tube), tube.skins[0].joints.len(), tube.nodes.len()), (2112, 14, 21));
    assert_eq!(tube.clips[0].name, "Armature|ArmatureAction");
}

/// The bones of these files stand as they were bound, so that at rest all of them move the mesh alike.
#[test]
fn at_rest_bones_agree() {
    let Some(folder) = models("FBX") else { return };
    let scene = read("huesitos.fbx", &std::fs::read(folder.join("huesitos.fbx")).unwrap()).unwrap();
    let bones = scene.bones(&scene.rest());
    for bone in &bones {
        let difference = bone
            .to_cols_array()
            .iter()
            .zip(bones[0].to_cols_array())
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f32::max);
        // Matrices hold a scale of 100.
        assert!(difference < 1e-3, "{bone} is not {}", bones[0]);
    }
}

#[test]
fn embedded_pictures_come_with_their_bytes() {
    let Some(folder) = models("FBX") else { return };
    // How the bytes of a Targa picture (colours, packed by run lengths) and of a PNG begin.
    for (name, picture, begin) in [
        ("box_orphant_embedded_texture.fbx", "GridGrey.tga", &[0, 10][..]),
        ("embedded_ascii/box_embedded_texture_fragmented.fbx", "paper.png", b"PN"),
    ] {
        let scene = read(name, &std::fs::read(folder.join(name)).unwrap()).unwrap();
        let image = &scene.images[scene.materials[0].base_color_texture.unwrap().image];
        assert_eq!((image.name.as_str(), image.bytes.get(1..3)), (picture, Some(begin)), "{name}");
    }
    // The other way: a file that is brought.
    let bytes = std::fs::read(folder.join("spider.fbx")).unwrap();
    let scene = fbx::read("spider.fbx", &bytes, &mut |path| Ok(path.as_bytes().to_vec())).unwrap();
    let brought = scene.images.iter().find(|image| image.name == "SpiderTex.jpg").unwrap();
    assert_eq!((brought.bytes.as_slice(), brought.mime.as_str()), (&b"SpiderTex.jpg"[..], "image/jpeg"));
}

#[test]
fn other_peoples_files_load_or_are_refused() {
    let Some(folder) = models("FBX") else { return };
    let mut refused = Vec::new();
    let found = files(&folder, &["fbx"]);
    assert!(found.len() >= 19, "{found:?}");
    for path in found {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if let Err(error) = read_any(read, &name, &std::fs::read(&path).unwrap()) {
            refused.push(error.to_string());
        }
    }
    // A binary file whose zeros became blanks.
    assert_eq!(
        refused,
        ["transparentTest.fbx: near byte 0: expected an FBX file, found Not an FBX file (Unknown)"]
    );
}

#[test]
fn damaged_files_are_refused_or_load() {
    let bytes = FACE.as_bytes();
    let all = bytes.len() / 64 + 1 + 200;
    let loaded = damage(read, "damaged.fbx", bytes, 200);
    // Some flips hit numbers.
    assert!(loaded > 0 && loaded < all, "{loaded} of {all}");
    let Some(folder) = models("FBX") else { return };
    for name in ["phong_cube.fbx", "boxWithCompressedCTypeArray.FBX"] {
        damage(read, name, &std::fs::read(folder.join(name)).unwrap(), 100);
    }
}
