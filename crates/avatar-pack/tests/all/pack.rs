//! Packs from memory: what is loaded, what is refused, what is mended.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::{golden, marsienne};
use avatar_pack::{
    FaceState, MemorySource, Pack, PackProblem, Source, SourceError, Texture, Textures, Warning,
};
use std::borrow::Cow;

fn png(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_pixel(width, height, image::Rgba([1, 2, 3, 255]));
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
    bytes.into_inner()
}

#[test]
fn shoulders_are_not_the_head() {
    // The sculptor says where they begin: at a height of -15.4. The head ends with the last row of vertices
    // above it, and rows are less than 0.6 apart there. Ears are the widest part of it.
    let head = marsienne().head().expect("shoulders");
    assert!((-15.4..-14.8).contains(&head.min.y) && (8.0..9.0).contains(&head.max.x), "{head:?}");
    assert_eq!(marsienne().face(), Some(head), "what pictures of the face frame");
    let skin = marsienne().part("skin").and_then(|skin| skin.bounds).expect("a skin");
    assert!(skin.min.y < -24.0 && skin.max.x > 15.0 && skin.max.y == head.max.y, "{skin:?}");
    // A head without shoulders is all of the skin, however its neck ends.
    assert_eq!(Pack::load(&golden()).expect("a good pack").head(), None);
}

#[test]
fn a_pack_is_whole() {
    let pack = Pack::load(&golden()).expect("a good pack");
    assert_eq!(pack.parts().len(), 7);
    assert_eq!(pack.palette().len(), 9);
    let names: Vec<_> =
        pack.palette().iter().map(|bone| pack.rig().names()[bone.joint.index()].as_str()).collect();
    assert_eq!(names, avatar_mesh::FACE_BONES);
    assert_eq!(pack.controls().controls().len(), 15);
    assert!(pack.poses().iter().count() >= 16);
    assert_eq!(pack.part("left-cornea").and_then(|part| part.bone), Some(7));
    assert!(pack.part("skin").is_some_and(|part| part.bone.is_none()));
    let skin = pack.part("skin").expect("a skin").mesh.bounds().expect("vertices");
    let all = pack.bounds().expect("vertices");
    assert!(all.min.cmple(skin.min).all() && all.max.cmpge(skin.max).all());
}

#[test]
fn every_needed_file_is_missed_by_name() {
    let whole = golden();
    let needed: Vec<_> = whole.files.keys().filter(|name| name.ends_with(".raw")).cloned().collect();
    assert_eq!(needed.len(), 14);
    for name in needed {
        let mut source = whole.clone();
        source.files.remove(&name);
        let error = Pack::load(&source).expect_err("a file is missing");
        assert_eq!(
            (error.file.as_str(), *error.problem),
            (name.as_str(), PackProblem::Missing(name.clone()))
        );
    }
}

#[test]
fn own_controls_and_poses_replace_the_defaults() {
    let mut source = golden();
    let controls = "[[control]]\nname = \"nod\"\njoint = \"HeadJoint\"\naxis = \"+y\"\nmin = -10\nmax = 10\n";
    source.files.insert("controls.toml".into(), controls.into());
    let poses = "\u{feff}[[pose]]\nname = \"yes\"\nkey = \"y\"\n[pose.controls]\nnod = 8\n";
    source.files.insert("poses.toml".into(), poses.into());
    let pack = Pack::load(&source).expect("a good pack");
    assert_eq!(pack.controls().controls().len(), 1);
    assert_eq!(pack.poses().get("yes").expect("the pose").values, [(0, 8.0)]);

    let mut face = FaceState::new(&pack);
    face.pose(&pack, &[8.0]).expect("one value");
    let head = face.bones()[1].matrix3;
    assert!((head.col(0).length() - 1.0).abs() < 1e-5 && head != glam::Mat3A::IDENTITY);
    let error = face.pose(&pack, &[1.0, 2.0]).expect_err("two values");
    assert_eq!(error.to_string(), "expected 1 control values, found 2");
}

#[test]
fn a_reader_that_fails_is_not_a_missing_file() {
    struct Broken;
    impl Source for Broken {
        fn read(&self, _: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
            Err(SourceError("the disk is on fire".to_owned()))
        }
        fn locate(&self, name: &str) -> String {
            format!("disk:/{name}")
        }
    }
    let error = Pack::load(&Broken).expect_err("nothing can be read");
    assert_eq!(error.to_string(), "disk:/Transformations.xml: the disk is on fire");
    assert_eq!(Textures::load(&Broken).warnings.len(), Texture::ALL.len());
}

#[test]
fn textures_are_found_by_any_of_their_names_and_missed_once() {
    let mut source = MemorySource::default();
    source.files.insert("SkinTex_Decal.png".into(), png(3, 2));
    source.files.insert("SkinTex_AO.jpeg".into(), b"no picture".to_vec());
    // The ending lies; the bytes tell.
    source.files.insert("EyeTex_Decal00.jpg".into(), png(4, 4));
    let textures = Textures::load(&source);
    assert_eq!(textures.get(Texture::SkinColor).map(|image| image.dimensions()), Some((3, 2)));
    assert_eq!(textures.get(Texture::Eye(0)).map(|image| image.dimensions()), Some((4, 4)));
    assert!(textures.get(Texture::SkinOcclusion).is_none());
    let about: Vec<_> = textures
        .warnings
        .iter()
        .map(|warning| match warning {
            Warning::Texture { file, .. } => file.as_str(),
            other => panic!("{other}"),
        })
        .collect();
    assert_eq!(about, ["SkinTex_AO.jpeg", "SkinTex_Gloss.png"]);
}

/// Values of all samples, and those that `image` makes of them.
#[test]
fn pictures_of_all_kinds_get_four_bytes_a_pixel() {
    use image::DynamicImage as D;
    let color = image::RgbaImage::from_fn(16, 16, |x, y| {
        let at = (16 * y + x) as u8;
        image::Rgba([at, at.wrapping_mul(7), 255 - at, at.wrapping_mul(31)])
    });
    let color = D::ImageRgba8(color);
    for picture in [
        D::ImageLuma8(color.to_luma8()),
        D::ImageLumaA8(color.to_luma_alpha8()),
        D::ImageRgb8(color.to_rgb8()),
        D::ImageRgb16(color.to_rgb16()),
        color.clone(),
    ] {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
        let mut source = MemorySource::default();
        source.files.insert("SkinTex_Decal.png".into(), bytes.into_inner());
        let textures = Textures::load(&source);
        assert_eq!(textures.get(Texture::SkinColor), Some(&picture.to_rgba8()), "{:?}", picture.color());
    }
}

#[test]
fn textures_may_be_decoded_in_any_order_by_anyone() {
    let mut source = MemorySource::default();
    source.files.insert("SkinTex_Decal.png".into(), png(3, 2));
    source.files.insert("SkinTex_AO.png".into(), b"\x89PNG\r\n\x1a\nnothing".to_vec());
    let mut cut = png(64, 64);
    cut.truncate(60);
    source.files.insert("SkinTex_Normal.png".into(), cut);
    source.files.insert("EyeTex_Decal00.png".into(), png(4, 4));
    source.files.insert("EyeTex_Decal01.png".into(), png(5, 5));
    let all = Textures::load(&source);
    let told = |textures: &Textures| textures.warnings.iter().map(Warning::to_string).collect::<Vec<_>>();
    for (file, told) in ["SkinTex_AO", "SkinTex_Gloss", "SkinTex_Normal"].into_iter().zip(told(&all)) {
        assert!(told.contains(file), "expected {file} to be told of, found {told}");
    }
    let backward = Textures::load_by(&source, &Texture::ALL, |count, decode| {
        std::thread::scope(|scope| {
            (0..count).rev().for_each(|place| drop(scope.spawn(move || decode(place))));
        });
    });
    let none = Textures::load_by(&source, &Texture::ALL, |_, _| {});
    for other in [&backward, &none] {
        assert_eq!(told(other), told(&all));
        assert!(Texture::ALL.iter().all(|texture| other.get(*texture) == all.get(*texture)));
    }
    let drawn = Textures::load_by(&source, &Texture::DRAWN, |_, _| {});
    assert!(drawn.get(Texture::Eye(0)).is_some() && drawn.get(Texture::Eye(1)).is_none());
}

#[test]
fn pictures_that_claim_to_be_huge_are_refused_before_they_are_decoded() {
    // The header says 2³¹ − 1 pixels on a side.
    let mut bytes = png(1, 1);
    bytes[16..20].copy_from_slice(&0x7fff_ffffu32.to_be_bytes());
    bytes[20..24].copy_from_slice(&0x7fff_ffffu32.to_be_bytes());
    let checksum = crc32(&bytes[12..29]).to_be_bytes();
    bytes[29..33].copy_from_slice(&checksum);
    let mut source = MemorySource::default();
    source.files.insert("SkinTex_Decal.png".into(), bytes);
    let textures = Textures::load(&source);
    assert!(textures.get(Texture::SkinColor).is_none());
    let warning = textures.warnings[0].to_string();
    assert!(warning.contains("SkinTex_Decal.png") && warning.contains("limit"), "{warning}");
}

/// The checksum of PNG chunks (ISO 3309).
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

#[test]
fn the_state_at_rest_is_the_bind_pose() {
    let pack = Pack::load(&golden()).expect("a good pack");
    let mut face = FaceState::new(&pack);
    face.pose(&pack, &pack.controls().defaults()).expect("values fit");
    for bone in face.bones() {
        assert!(bone.abs_diff_eq(glam::Affine3A::IDENTITY, 1e-4), "{bone}");
    }
    assert_eq!(face.weights(), [0.0, 0.0]);
}
