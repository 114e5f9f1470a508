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

/// A scene with a part for each material, and these pictures.
fn scene_of(materials: Vec<Material>, pictures: Vec<Vec<u8>>) -> Scene {
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        uvs: vec![Vec2::ZERO; 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let part = |material| ScenePart {
        material: Some(material),
        ..ScenePart::rigid(&format!("plate {material}"), 0, mesh.clone())
    };
    let image =
        |(number, bytes)| SceneImage { name: format!("picture {number}"), bytes, ..Default::default() };
    let scene = RawScene {
        nodes: vec![Node::default()],
        parts: (0..materials.len()).map(part).collect(),
        materials,
        images: pictures.into_iter().enumerate().map(image).collect(),
        ..RawScene::default()
    };
    Scene::from_raw(scene).expect("a scene")
}

fn painted(image: usize) -> Material {
    Material { base_color_texture: Some(image.into()), metallic: 0.0, ..Material::default() }
}

fn encoded(picture: image::DynamicImage, format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("a picture");
    bytes.into_inner()
}

#[test]
fn a_picture_is_decoded_once_for_all_colours_that_it_is_multiplied_by() {
    let png = encoded(
        image::RgbaImage::from_pixel(2, 2, image::Rgba([9, 8, 7, 255])).into(),
        image::ImageFormat::Png,
    );
    let tints = [[1.0; 4], [0.5, 1.0, 1.0, 1.0], [0.2, 0.1, 0.9, 1.0]];
    let materials = tints.map(|base_color| Material { base_color, ..painted(0) });
    let import = Import::from_scene(scene_of(materials.to_vec(), vec![png])).expect("an avatar");
    let color = |part: usize| {
        let kind = import.pack.parts()[part].kind;
        import.textures.of_part(part, kind).color.expect("a picture")
    };
    assert!(std::ptr::eq(color(0), color(1)) && std::ptr::eq(color(1), color(2)));
    for (part, tint) in tints.iter().enumerate() {
        let look = import.pack.material(part).standard.expect("a look of the file's");
        assert_eq!(look.base_color, *tint);
    }
}

#[test]
fn webp_is_read_and_what_is_no_picture_is_one_note() {
    let webp = encoded(
        image::RgbaImage::from_pixel(3, 2, image::Rgba([200, 100, 50, 128])).into(),
        image::ImageFormat::WebP,
    );
    let mut ktx = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    ktx.extend([0; 64]);
    // Both broken pictures are used three times.
    let materials = [0, 1, 1, 1, 2, 2, 2].map(painted);
    let pictures = vec![webp, ktx, b"no picture".to_vec()];
    let import = Import::from_scene(scene_of(materials.to_vec(), pictures)).expect("an avatar");
    let color = |part: usize| import.textures.of_part(part, import.pack.parts()[part].kind).color;
    let (width, height) = color(0).expect("WebP").dimensions();
    assert_eq!((width, height), (3, 2));
    assert_eq!(color(0).expect("WebP").get_pixel(1, 1).0, [200, 100, 50, 128]);
    assert!((1..7).all(|part| color(part).is_none()));
    let told: Vec<String> = import.textures.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("picture 1") && told[0].contains("found KTX"), "{told:?}");
    assert!(told[1].contains("picture 2"), "{told:?}");
}

#[test]
fn all_pictures_together_keep_within_a_budget() {
    // Sixteen mebibytes each once it is decoded, and a few kilobytes in the file.
    let flat = encoded(image::GrayImage::new(2048, 2048).into(), image::ImageFormat::Png);
    assert!(flat.len() < 1 << 16);
    let materials = (0..16).map(painted).collect();
    let import = Import::from_scene(scene_of(materials, vec![flat.clone(); 16])).expect("an avatar");
    let decoded = (0..16)
        .filter(|part| import.textures.of_part(*part, import.pack.parts()[*part].kind).color.is_some())
        .count();
    let budget = (128 << 20) + 24 * 16 * flat.len();
    assert!(decoded >= 4 && decoded * (16 << 20) <= budget, "{decoded}");
    let told: Vec<String> = import.textures.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 16 - decoded, "{told:?}");
    assert!(told[0].contains("2048×2048") && told[0].contains("134217728 bytes"), "{}", told[0]);
}
