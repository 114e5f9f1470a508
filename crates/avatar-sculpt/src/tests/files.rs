use std::{fs, path::PathBuf};

use super::{RIGID, geometry, mesh, skin};

/// The folder of the committed pack.
fn committed() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne")
}

#[test]
fn every_file_has_a_whole_number_of_entries() {
    for (name, bytes) in &geometry().files {
        let unit = match name.as_str() {
            "MarsienneSkin_VB.raw" => 124,
            n if n.ends_with("_VB.raw") => 32,
            n if n.ends_with("_IB.raw") => 12,
            _ => 1,
        };
        assert!(!bytes.is_empty(), "{name}");
        assert_eq!(bytes.len() % unit, 0, "{name}");
    }
}

#[test]
fn the_skin_is_neither_coarse_nor_too_large() {
    let m = skin();
    assert!((25_000..=35_000).contains(&m.triangles.len()), "{}", m.triangles.len());
    assert!(m.p.len() <= 63_488, "{}", m.p.len());
}

#[test]
fn indices_stay_inside_and_every_vertex_is_used() {
    for stem in RIGID.into_iter().chain(["MarsienneSkin"]) {
        let m = mesh(stem);
        let mut used = vec![false; m.p.len()];
        m.triangles.iter().flatten().for_each(|&i| used[i] = true);
        assert!(used.iter().all(|u| *u), "{stem}");
    }
}

#[test]
fn the_committed_files_are_what_this_source_makes() {
    for (name, bytes) in &geometry().files {
        let found = fs::read(committed().join(name)).unwrap();
        assert!(found == *bytes, "{name} differs: run avatar-sculpt and commit its files");
    }
}

#[test]
fn the_committed_pack_is_complete_and_small() {
    let mut total = 0;
    for entry in fs::read_dir(committed()).unwrap() {
        total += entry.unwrap().metadata().unwrap().len();
    }
    assert!(total <= 16_000_000, "{total} bytes");
    let sizes = [
        ("SkinTex_Decal", 2048),
        ("SkinTex_Normal", 2048),
        ("SkinTex_AO", 2048),
        ("SkinTex_Gloss", 2048),
        ("SkinTex_Thickness", 1024),
        ("SkinTex_Wrinkles", 1024),
        ("HairMap", 1024),
        ("EyeTex_Decal00", 1024),
        ("EyeTex_Decal01", 1024),
        ("EyeTex_Decal02", 1024),
        ("EyeTex_Decal03", 1024),
        ("TeethTex_Decal", 512),
    ];
    for (stem, side) in sizes {
        let bytes = fs::read(committed().join(format!("{stem}.png"))).unwrap();
        let reader = image::ImageReader::new(std::io::Cursor::new(bytes)).with_guessed_format().unwrap();
        assert_eq!(reader.into_dimensions().unwrap(), (side, side), "{stem}");
    }
}
