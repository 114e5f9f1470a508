//! Statements of material libraries.

use avatar_exchange::obj::read;
use avatar_exchange::{Material, TextureRef};

/// The material of a library of one, with the texts of the notes.
fn material(statements: &str) -> (Material, Vec<String>) {
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    let library = format!("newmtl m\n{statements}");
    let scene = read("a.obj", text.as_bytes(), &mut |path| match path {
        "a.mtl" => Ok(library.clone().into_bytes()),
        _ => Ok(b"\x89PNG....".to_vec()),
    })
    .expect("a good file");
    (scene.materials[0].clone(), scene.notes.iter().map(ToString::to_string).collect())
}

const LEFT_OUT: &str = "statements that surfaces here have no term for are left out: ";

#[test]
fn a_black_factor_does_not_hide_a_texture() {
    let (read, notes) = material("map_Ke glow.png\n");
    assert_eq!((read.emissive, read.emissive_texture, notes.len()), ([1.0; 3], Some(0.into()), 0));
    assert_eq!(material("Ke 0 0 0\nmap_Ke glow.png\n").0.emissive, [1.0; 3]);
    assert_eq!(material("map_Ke glow.png\nKe 0.5 0 0\n").0.emissive, [0.5, 0.0, 0.0]);
    let (read, notes) = material("Kd 0 0 0\nd 0.5\nmap_Kd skin.png\n");
    assert_eq!(read.base_color, [1.0, 1.0, 1.0, 0.5]);
    assert_eq!(notes, ["material \"m\": its colour Kd is black and would hide its texture: white is taken"]);
    assert_eq!(material("Kd 0 0 0\n").0.base_color, [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(material("Kd 0 0.5 0\nmap_Kd skin.png\n").0.base_color, [0.0, 0.5, 0.0, 1.0]);
}

#[test]
fn roughness_and_metalness_are_read() {
    let (read, notes) = material("Pr 0.25\nNs 6\nPm 0.75\n");
    assert_eq!((read.roughness, read.metallic, notes.len()), (0.25, 0.75, 0));
    // Roughness in green; blue, where the picture has the same value, is multiplied by no metalness.
    let (read, notes) = material("Pr 0\nmap_Pr rough.png\n");
    assert_eq!((read.roughness, read.metallic), (1.0, 0.0));
    assert_eq!((read.metallic_roughness_texture, notes.len()), (Some(0.into()), 0));
    let (read, notes) = material("map_Pm both.png\nmap_Pr both.png\n");
    assert_eq!((read.roughness, read.metallic), (1.0, 1.0));
    assert_eq!((read.metallic_roughness_texture, notes.len()), (Some(0.into()), 0));
    // What one picture cannot hold is told.
    for (statements, texture, left_out) in [
        ("map_Pr a.png\nmap_Pm b.png\n", Some(TextureRef::from(0)), &["metalness"][..]),
        ("map_Pm b.png\n", None, &["metalness"]),
        ("Pm 1\nmap_Pr a.png\n", None, &["roughness"]),
        ("Pm 1\nmap_Pr a.png\nmap_Pm b.png\n", None, &["roughness", "metalness"]),
    ] {
        let (read, notes) = material(statements);
        assert_eq!(read.metallic_roughness_texture, texture, "{statements}");
        let expected: Vec<String> =
            left_out.iter().map(|what| format!("material \"m\": its {what} texture is left out")).collect();
        assert_eq!(notes, expected, "{statements}");
    }
}

#[test]
fn bump_maps_stand_in_for_normal_maps_with_their_multiplier() {
    let (read, notes) = material("map_Bump -bm 0.5 dents.png\n");
    assert_eq!((read.normal_texture, read.normal_scale), (Some(0.into()), 0.5));
    assert_eq!(notes, ["material \"m\": its bump map is taken for a normal map"]);
    let (read, notes) = material("map_Bump -bm 0.5 dents.png\nnorm normals.png\n");
    assert_eq!((read.normal_texture, read.normal_scale, notes.len()), (Some(0.into()), 1.0, 0));
}

#[test]
fn statements_are_read_and_told_as_documented() {
    let rows = include_str!("../../../../../docs/formats.md").split_once("| statement of MTL |").unwrap().1;
    let (mut read, mut told) = (0, 0);
    for row in rows.lines().skip(2).take_while(|line| line.starts_with('|')) {
        let (names, what) = row.trim_start_matches('|').split_once('|').unwrap();
        for name in names.split('`').skip(1).step_by(2) {
            let is_picture =
                name.starts_with("map_") || ["norm", "bump", "disp", "decal", "refl"].contains(&name);
            let (found, notes) = material(&format!("{name} {}\n", if is_picture { "a.png" } else { "0.5" }));
            let is_told = notes.iter().any(|note| note.contains(&format!("{LEFT_OUT}\"{name}\" (1)")));
            assert_eq!(is_told, what.trim_end_matches('|').trim() == "a note", "{name}: {notes:?}");
            if is_told {
                told += 1;
            } else {
                // Pictures that need another statement beside them tell so.
                assert!(
                    found != material("").0 || notes.iter().any(|note| note.contains("texture")),
                    "{name}"
                );
                read += 1;
            }
        }
    }
    assert_eq!((read, told), (18, 21));
}

#[test]
fn every_other_statement_is_told_once() {
    for statement in [
        "Ka 0.2 0.2 0.2",
        "Ks 0.5 0.5 0.5",
        "Tf 0.5 1 1",
        "Ni 1.45",
        "illum 4",
        "sharpness 60",
        "Ps 0.5",
        "Pc 0.1",
        "Pcr 0.5",
        "aniso 0.5",
        "anisor 0.5",
        "refl -type sphere sky.png",
        "map_Ka a.png",
        "map_Ks a.png",
        "map_Ns a.png",
        "map_Ps a.png",
        "map_Tr a.png",
        "map_refl a.png",
        "map_aat on",
        "disp a.png",
        "decal a.png",
        "map_RMA a.png",
        "what",
    ] {
        let keyword = statement.split(' ').next().unwrap_or_default();
        let (read, notes) = material(&format!("{statement}\n{statement}\n"));
        assert_eq!(notes, [format!("a.mtl, line 2: {LEFT_OUT}\"{keyword}\" (2)")], "{statement}");
        assert_eq!(read, material("").0, "{statement}");
    }
    // What says that there is nothing of a kind.
    let nothing = "Ka 0 0 0\nKs 0 0 0\nTf 1 1 1\nNi 1.0\nillum 2\nPs 0\nPc 0\nPcr 0.0\naniso 0\nanisor 0\n";
    assert_eq!(material(nothing).1, Vec::<String>::new());
    let many: String = (0..100).map(|k| format!("word{k:02}\n")).collect();
    let (_, notes) = material(&many);
    assert_eq!((notes.len(), notes[0].matches("word").count()), (1, 32));
}
