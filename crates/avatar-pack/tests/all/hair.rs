//! `hair.toml` of a pack, and the hair that grows on the built-in head.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::{folder_of, golden};
use avatar_groom::{Groom, Hair, Region, Style};
use avatar_pack::{MemorySource, Pack, PackError, PackProblem, Texture, Textures, load_hair};
use glam::{Vec2, Vec3};

const FILE: &str = "hair.toml";

/// The built-in avatar, with no other texture than that of hair.
fn built_in() -> (Pack, Textures) {
    let source = folder_of("assets/marsienne", |name| !name.ends_with(".png") || name == "HairMap.png");
    (Pack::load(&source).expect("the built-in avatar"), Textures::load(&source))
}

fn only(bytes: impl Into<Vec<u8>>) -> MemorySource {
    MemorySource { files: [(FILE.to_owned(), bytes.into())].into() }
}

#[track_caller]
fn refused(bytes: impl Into<Vec<u8>>) -> PackError {
    load_hair(&only(bytes)).expect_err("not as the format demands")
}

#[test]
fn a_pack_has_the_hair_of_its_file_or_none() {
    assert_eq!(load_hair(&MemorySource::default()), Ok(None));
    assert_eq!(load_hair(&only("")), Ok(Some(Hair::default())));
    assert_eq!(load_hair(&only("\u{feff}")), Ok(Some(Hair::default())));
    assert_eq!(Pack::load(&golden()).expect("a good pack").hair(), None);

    let mut source = golden();
    source.files.insert(FILE.into(), "\u{feff}preset = 'curly'\nseed = 7\n[scalp]\ncurl_turns = 2\n".into());
    let pack = Pack::load(&source).expect("a good pack");
    let mut style = Style::CURLY;
    style.scalp.curl_turns = 2.0;
    assert_eq!(pack.hair(), Some(&Hair { style, density: 1.0, seed: 7 }));
    assert_eq!(load_hair(&source).expect("sound").as_ref(), pack.hair(), "by itself as with the pack");
}

#[test]
fn a_mistake_is_told_with_file_and_place() {
    let error = refused("# é\n[scalp]\n  lenght = 1\n");
    assert_eq!(error.file, FILE);
    let PackProblem::Hair(hair) = &*error.problem else { panic!("{error}") };
    assert_eq!((hair.line, hair.column, hair.key.as_str()), (3, 3, "scalp.lenght"));
    let text = error.to_string();
    assert!(
        text.starts_with("hair.toml: line 3, column 3: scalp.lenght: expected one of the keys density,"),
        "{text}"
    );
    assert!(text.ends_with("found \"lenght\"; did you mean \"length\"?"), "{text}");

    assert_eq!(*refused(b"# \xFF").problem, PackProblem::NotText { offset: 2 });
    let mut source = golden();
    source.files.insert(FILE.into(), "density = inf".into());
    let text = "hair.toml: line 1, column 11: density: expected a number from 0 to 7, found inf";
    assert_eq!(Pack::load(&source).expect_err("out of range").to_string(), text);
}

#[test]
fn without_a_map_nothing_grows() {
    let pack = Pack::load(&golden()).expect("a good pack");
    assert!(pack.groom(&Textures::default(), &Hair::default()).is_none());
}

/// Where each root is: on the map in its pixels, and in space.
fn places(pack: &Pack, groom: &Groom) -> Vec<(Region, Vec2, Vec3)> {
    let mesh = &pack.part("skin").expect("a skin").mesh;
    let place = |root: &avatar_groom::Root| {
        let corners = root.corners.map(|corner| corner as usize);
        let uv: Vec2 = (0..3).map(|i| mesh.uvs[corners[i]] * root.barycentric[i]).sum();
        (root.region, uv * 1024.0, (0..3).map(|i| mesh.positions[corners[i]] * root.barycentric[i]).sum())
    };
    groom.strands().iter().map(|strand| place(&strand.root)).collect()
}

/// On the built-in head brows and lashes are painted apart, and their places on the map are known.
#[test]
fn brows_and_lashes_grow_where_they_are_painted_and_nowhere_else() {
    let (pack, textures) = built_in();
    assert!(textures.get(Texture::HairDensity).is_some());
    let hair = Hair { style: Style::SHORT, density: 0.5, seed: 3 };
    let (skin, groom) = pack.groom(&textures, &hair).expect("hair");
    assert_eq!(pack.parts()[skin].name, "skin");
    let mut counts = [0; 3];
    for (region, pixel, _) in places(&pack, &groom) {
        let painted = match (pixel.x, pixel.y) {
            (285.0..740.0, 205.0..260.0) => Region::Brows,
            (340.0..690.0, 293.0..357.0) => Region::Lashes,
            _ => Region::Scalp,
        };
        assert_eq!(region, painted, "{pixel}");
        counts[region as usize] += 1;
    }
    // By the sums of the painted values, taken elsewhere: 0.8011, 0.00225 and 0.000116 of the head's height
    // squared.
    let scalp = 50_000.0 * 0.8011;
    let expected = [scalp, 50_000.0 * 0.00225 * 4.0, 50_000.0 * 0.000116 * 16.0];
    for (count, expected) in counts.into_iter().zip(expected) {
        let count = f64::from(count);
        assert!((count - expected).abs() < 0.05 * expected + 1.0, "{counts:?}, expected {expected}");
    }
}

#[test]
fn both_halves_of_the_head_have_as_much_hair_and_a_crest_is_a_crest() {
    let (pack, textures) = built_in();
    for (name, style) in Style::PRESETS {
        let (_, groom) = pack.groom(&textures, &Hair { style, ..Hair::default() }).expect("hair");
        let scalp: Vec<f32> = (places(&pack, &groom).iter())
            .filter_map(|(region, _, place)| (*region == Region::Scalp).then_some(place.x))
            .collect();
        assert_eq!(scalp.is_empty(), name == "bald", "{name}");
        let left = scalp.iter().filter(|x| **x > 0.0).count() as f64;
        assert!(
            (left - scalp.len() as f64 / 2.0).abs() < 0.02 * left + 1.0,
            "{name}: {left} of {}",
            scalp.len()
        );
        let widest = scalp.iter().fold(0.0f32, |widest, x| widest.max(x.abs())) / groom.height();
        assert!(name != "mohawk" || widest <= Style::MOHAWK.scalp.strip + 1e-4, "{widest}");
    }
}

#[test]
fn the_largest_density_fits_a_binding_of_default_limits() {
    let (pack, textures) = built_in();
    let strands = |style| {
        let hair = Hair { style, density: Hair::MAX_DENSITY, seed: 1 };
        pack.groom(&textures, &hair).expect("hair").1.strands().len()
    };
    let densest = strands(Style::BOB);
    // 128 MiB of points, and a normal, of 16 bytes each.
    let most = (128 << 20) / (16 * (avatar_groom::SEGMENTS + 2));
    assert!(densest <= most && 11 * densest > 10 * most, "{densest} of {most}");
    for (name, style) in Style::PRESETS {
        let densities = |style: Style| [style.scalp, style.brows, style.lashes].map(|region| region.density);
        let as_dense = densities(style).into_iter().zip(densities(Style::BOB)).all(|(a, b)| a <= b);
        assert!(as_dense, "{name}");
    }
}
