use super::{RIGID, file, mesh, pack, skin};

#[test]
fn every_file_has_a_whole_number_of_entries() {
    for (name, bytes) in &pack().files {
        let unit = match name.as_str() {
            "MarsienneSkin_VB.raw" => 124,
            n if n.ends_with("_VB.raw") => 32,
            n if n.ends_with("_IB.raw") => 12,
            _ => 1,
        };
        assert!(!bytes.is_empty(), "{name}");
        assert_eq!(bytes.len() % unit, 0, "{name}");
    }
    let total: usize = pack().files.iter().map(|(_, b)| b.len()).sum();
    assert!(total < 6 << 20, "{total} bytes");
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
fn building_twice_gives_the_same_bytes() {
    let again = crate::build().unwrap();
    assert_eq!(again.files.len(), pack().files.len());
    for ((a, x), (b, y)) in again.files.iter().zip(&pack().files) {
        assert_eq!(a, b);
        assert!(x == y, "{a}");
    }
}

#[test]
fn all_pictures_are_there() {
    let names = [
        "SkinTex_Decal",
        "SkinTex_AO",
        "SkinTex_Gloss",
        "HairMap",
        "EyeTex_Decal00",
        "EyeTex_Decal01",
        "EyeTex_Decal02",
        "EyeTex_Decal03",
        "TeethTex_Decal",
    ];
    for name in names {
        let picture = image::load_from_memory(file(&format!("{name}.png"))).unwrap();
        assert_eq!(picture.width(), picture.height(), "{name}");
    }
}
