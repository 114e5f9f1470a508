//! `materials.toml` of a pack: what is taken over, and what is told of one that cannot be.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::golden;
use avatar_look::Materials;
use avatar_mesh::{FACE_PARTS, PartKind};
use avatar_pack::{
    MemorySource, Pack, PackError, PackProblem, Source, SourceError, Texture, Textures, load_materials,
};
use std::borrow::Cow;

const FILE: &str = "materials.toml";

/// A source that has nothing but materials.
fn only(bytes: impl Into<Vec<u8>>) -> MemorySource {
    MemorySource { files: [(FILE.to_owned(), bytes.into())].into() }
}

#[track_caller]
fn refused(bytes: impl Into<Vec<u8>>) -> PackError {
    load_materials(&only(bytes)).expect_err("not as the format demands")
}

#[test]
fn without_the_file_the_defaults_hold() {
    assert_eq!(load_materials(&MemorySource::default()), Ok(Materials::default()));
    assert_eq!(load_materials(&only("")), Ok(Materials::default()));
    assert_eq!(load_materials(&only("\u{feff}")), Ok(Materials::default()));
    assert_eq!(Pack::load(&golden()).expect("a good pack").materials(), &Materials::default());
}

#[test]
fn a_pack_has_the_materials_of_its_file() {
    let text = "[eyeball.iris]\npupil = 0.6\n[left-eyeball.iris]\npupil = 0.2\n[lower-jaw]\nwetness = 0.1\n";
    let mut source = golden();
    source.files.insert(FILE.into(), format!("\u{feff}{text}").into());
    let pack = Pack::load(&source).expect("a good pack");
    assert_eq!(load_materials(&source).as_ref(), Ok(pack.materials()), "by itself as with the pack");
    let of = |name: &str| {
        let part = pack.part(name).expect("a part");
        pack.materials().of(&part.name, part.kind)
    };
    assert_eq!((of("left-eyeball").iris.pupil, of("right-eyeball").iris.pupil), (0.2, 0.6));
    let teeth = Materials::default().of("upper-jaw", PartKind::Surface);
    assert_eq!((of("upper-jaw"), of("lower-jaw").wetness), (teeth, 0.1));
}

#[test]
fn every_part_takes_its_own_table() {
    for spec in FACE_PARTS {
        let mut source = golden();
        let text = format!("[{}]\nreflectance = 0.25\n", spec.name);
        source.files.insert(FILE.into(), text.into());
        let pack = Pack::load(&source).expect("a good pack");
        let changed: Vec<_> = (pack.parts().iter())
            .filter(|part| pack.materials().of(&part.name, part.kind).reflectance == 0.25)
            .map(|part| part.name.as_str())
            .collect();
        assert_eq!(changed, [spec.name]);
    }
}

#[test]
fn a_mistake_is_told_with_file_and_place() {
    let error = refused("# é\n[skin]\n  \"colour\" = [1, 1, 1]\n");
    assert_eq!(error.file, FILE);
    let PackProblem::Look(look) = &*error.problem else { panic!("{error}") };
    assert_eq!((look.line, look.column, look.key.as_str()), (3, 3, "skin.colour"));
    assert_eq!(look.nearest.as_deref(), Some("color"));
    let text = error.to_string();
    assert!(
        text.starts_with("materials.toml: line 3, column 3: skin.colour: expected one of the keys color,")
    );
    assert!(text.ends_with("found \"colour\"; did you mean \"color\"?"), "{text}");

    let mut source = golden();
    source.files.insert(FILE.into(), "[cornea]\nopacity = 1.5\n".into());
    let text = "materials.toml: line 2, column 11: cornea.opacity: expected a number from 0 to 1, found 1.5";
    assert_eq!(Pack::load(&source).expect_err("out of range").to_string(), text);
}

#[test]
fn a_bad_byte_is_told_with_its_place_in_the_file() {
    let not_text = |offset| PackProblem::NotText { offset };
    assert_eq!(*refused(b"[skin]\n# \xFF\n").problem, not_text(9));
    assert_eq!(*refused(b"\xEF\xBB\xBF# \xFF").problem, not_text(5), "the mark at the start counts");
    // UTF-16, as some editors save.
    assert_eq!(*refused(b"\xFF\xFE[\0s\0").problem, not_text(0));
    assert_eq!(*refused(b"# \xC3").problem, not_text(2), "cut within a character");
}

#[test]
fn a_file_that_cannot_be_read_is_not_a_missing_one() {
    struct Locked;
    impl Source for Locked {
        fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
            if name == FILE { Err(SourceError("it is locked".to_owned())) } else { Ok(None) }
        }
        fn locate(&self, name: &str) -> String {
            format!("disk:/{name}")
        }
    }
    let error = load_materials(&Locked).expect_err("nothing can be read");
    assert_eq!(error.to_string(), "disk:/materials.toml: it is locked");
    assert_eq!(*error.problem, PackProblem::Unreadable(SourceError("it is locked".to_owned())));
}

#[test]
fn the_thickness_of_the_skin_is_a_texture_that_may_be_missing() {
    let about_thickness = |textures: &Textures| {
        textures.warnings.iter().filter(|warning| warning.to_string().contains("SkinTex_Thickness")).count()
    };
    let without = Textures::load(&MemorySource::default());
    assert!(without.get(Texture::SkinThickness).is_none());
    assert_eq!(about_thickness(&without), 0);

    let mut bytes = std::io::Cursor::new(Vec::new());
    let gray = image::GrayImage::from_fn(5, 3, |x, y| image::Luma([(x * 50 + y) as u8]));
    gray.write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
    let mut source = MemorySource::default();
    source.files.insert("SkinTex_Thickness.png".into(), bytes.into_inner());
    let with = Textures::load(&source);
    let thickness = with.get(Texture::SkinThickness).expect("the texture");
    assert_eq!((thickness.dimensions(), thickness.get_pixel(4, 2).0), ((5, 3), [202, 202, 202, 255]));
    assert_eq!(about_thickness(&with), 0);

    source.files.insert("SkinTex_Thickness.png".into(), b"no picture".to_vec());
    let broken = Textures::load(&source);
    assert!(broken.get(Texture::SkinThickness).is_none());
    assert_eq!(about_thickness(&broken), 1);
}
