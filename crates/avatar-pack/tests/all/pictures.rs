//! Pictures of imported files.
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_exchange::{Material, Node, RawScene, Scene, SceneImage, ScenePart};
use avatar_mesh::Mesh;
use avatar_pack::{Import, MemorySource, Texture, Textures, portable_pictures};
use glam::{Vec2, Vec3};
use std::borrow::Cow;

fn with_picture(name: &str, bytes: &[u8]) -> Import {
    Import::from_scene(scene_with_picture(name, bytes)).expect("an avatar")
}

fn scene_with_picture(name: &str, bytes: &[u8]) -> Scene {
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        uvs: vec![Vec2::ZERO; 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let scene = RawScene {
        nodes: vec![Node::default()],
        parts: vec![ScenePart { material: Some(0), ..ScenePart::rigid("duck", 0, mesh) }],
        materials: vec![Material { base_color_texture: Some(0.into()), ..Material::default() }],
        images: vec![SceneImage { name: name.to_owned(), mime: String::new(), bytes: bytes.to_vec() }],
        ..RawScene::default()
    };
    Scene::from_raw(scene).expect("a scene")
}

/// Truevision's TGA 2.0: an uncompressed picture (type 2) of 2 × 1 pixels of 24 bits, blue first, its origin
/// at the bottom left.
const TGA: [u8; 24] = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 24, 0, 10, 20, 30, 40, 50, 60];

#[test]
fn a_picture_that_does_not_say_what_it_is_goes_by_its_name() {
    let import = with_picture("textures/duckCM.TGA", &TGA);
    let kind = import.pack.parts()[0].kind;
    let color = import.textures.of_part(0, kind).color.expect("a picture");
    assert_eq!(
        (color.dimensions(), color.as_raw().as_slice()),
        ((2, 1), &[30, 20, 10, 255, 60, 50, 40, 255][..])
    );
    assert!(import.textures.warnings.is_empty(), "{:?}", import.textures.warnings);
    let import = with_picture("duck", &TGA);
    let told = import.textures.warnings[0].to_string();
    assert!(told.contains("duck: expected a picture (PNG, JPEG, WebP, TGA or BMP)"), "{told}");
}

#[test]
fn pictures_that_gltf_does_not_know_become_png() {
    let import = with_picture("duckCM.tga", &TGA);
    let scene = scene_with_picture("duckCM.tga", &TGA);
    let portable = portable_pictures(&scene);
    let again = Import::from_scene(portable.clone().into_owned()).expect("an avatar");
    assert_eq!(portable.images[0].mime, "image/png");
    assert!(portable.images[0].bytes.starts_with(b"\x89PNG"));
    let color = |import: &Import| import.textures.of_part(0, import.pack.parts()[0].kind).color.cloned();
    assert_eq!(color(&again), color(&import));
    // PNG and JPEG files stay as they are, and so do bytes that are no picture.
    assert!(matches!(portable_pictures(&portable), Cow::Borrowed(_)));
    let scene = scene_with_picture("duck", &TGA);
    assert_eq!(portable_pictures(&scene).images[0].bytes, TGA);
}

/// A bitmap's header (BITMAPINFOHEADER, 24 bits a pixel) without any pixels.
fn claims(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = b"BM\x36\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0".to_vec();
    bytes.extend(width.to_le_bytes());
    bytes.extend(height.to_le_bytes());
    bytes.extend([1, 0, 24, 0]);
    bytes.resize(54, 0);
    bytes
}

/// A few bytes must not take hundreds of megabytes, neither alone nor together.
#[test]
fn pictures_of_packs_have_a_budget() {
    let told = |name: &str, bytes: Vec<u8>| {
        let mut source = MemorySource::default();
        source.files.insert(name.to_owned(), bytes);
        let textures = Textures::load(&source);
        assert!(textures.get(Texture::SkinColor).is_none());
        textures.warnings[0].to_string()
    };
    let text = told("SkinTex_Decal.png", claims(11_000, 7_000));
    assert!(text.contains("Memory limit"), "{text}");
    // Within the budget it is decoded, and found to end too early.
    let text = told("SkinTex_Decal.png", claims(3000, 3000));
    assert!(!text.contains("Memory limit"), "{text}");

    // Pictures that are as large as their files say are all read.
    let mut picture = claims(3000, 3000);
    picture.resize(54 + 27_000_000, 0);
    let names = ["SkinTex_Decal", "SkinTex_AO", "SkinTex_Gloss", "SkinTex_Normal", "EyeTex_Decal00"];
    let mut source = MemorySource::default();
    for name in names {
        source.files.insert(format!("{name}.png"), picture.clone());
    }
    let textures = Textures::load(&source);
    assert!(textures.warnings.is_empty(), "{:?}", textures.warnings);
}
