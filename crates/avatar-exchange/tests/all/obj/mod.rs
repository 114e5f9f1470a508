//! OBJ, MTL and sequences of OBJ files.

mod materials;
mod sequence;

use crate::support::data::shared_data;
use crate::support::texts;
use avatar_exchange::obj::{ObjFile, read, read_obj};
use avatar_exchange::{AlphaMode, ImportError, TextureRef, Wrap};
use avatar_mesh::{Mesh, obj};
use glam::{Vec2, Vec3};
use proptest::prelude::*;

fn parse(text: &str) -> Result<ObjFile, ImportError> {
    read_obj("a.obj", text.as_bytes(), &mut |_| Err(String::new()))
}

fn good(text: &str) -> ObjFile {
    parse(text).expect("a good file")
}

#[test]
fn a_quad_becomes_a_fan_with_texture_coordinates_from_the_top() {
    let obj = good("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0.25 0.75\nvt 1 0\nf 1/1 2/2 3/2 4/1\n");
    let mesh = &obj.parts[0].mesh;
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.uvs[0], Vec2::new(0.25, 0.25));
    assert_eq!(mesh.uvs[1], Vec2::new(1.0, 1.0));
    assert_eq!(mesh.normals, [Vec3::Z; 4]);
    assert_eq!((obj.parts[0].name.as_str(), obj.parts[0].material), ("a", None));
}

#[test]
fn negative_indices_count_back_from_where_they_stand() {
    let obj = good("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nf -1 -3 -2\n");
    assert_eq!((&obj.faces.corners[..], &obj.faces.ends[..]), (&[0, 1, 2, 3, 1, 2][..], &[3, 6][..]));
}

#[test]
fn vertices_keep_the_order_of_the_file_and_know_it() {
    // The first vertex belongs to no face, the last one has two normals.
    let obj =
        good("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nf 4//2 2//1 3//1\nf 4//1 3//1 2//1\n");
    let part = &obj.parts[0];
    assert_eq!(obj.positions.len(), 4);
    assert_eq!(part.sources, [1, 2, 3, 3]);
    assert_eq!(part.mesh.triangles, [[3, 0, 1], [2, 1, 0]]);
    assert_eq!(part.mesh.normals[2..], [Vec3::Z, Vec3::Y]);
    assert_eq!((&obj.faces.parts[..], &obj.faces.vertices[..]), (&[0, 0][..], &[3, 0, 1, 2, 1, 0][..]));
}

#[test]
fn groups_objects_and_materials_make_parts() {
    let triangle = "f 1 2 3\n";
    let text = format!(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\no body\n{triangle}g skin\n{triangle}usemtl red\n{triangle}g\n{triangle}g skin\n{triangle}o body\n{triangle}"
    );
    let obj = good(&text);
    let parts: Vec<_> =
        obj.parts.iter().map(|part| (part.name.as_str(), part.material, part.mesh.triangles.len())).collect();
    let expected = [
        ("body", None, 1),
        ("skin", None, 1),
        ("skin", Some(0), 2),
        ("body", Some(0), 1),
        ("body", Some(0), 1),
    ];
    assert_eq!(parts, expected);
    assert!(obj.notes.iter().any(|note| note.place == "material \"red\""));
}

/// Two squares that meet at a right angle along the y axis.
const FOLD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nv 0 1 -1\n";

#[test]
fn normals_follow_smoothing_groups() {
    let faces = |a: &str, b: &str| format!("{FOLD}{a}f 1 2 3 4\n{b}f 5 1 4 6\n");
    let smooth = good(&faces("", ""));
    assert_eq!(smooth.parts[0].mesh.positions.len(), 6);
    // Both faces have a right angle there, so they count alike.
    let between = Vec3::new(-1.0, 0.0, 1.0) / 2.0f32.sqrt();
    assert!(smooth.parts[0].mesh.normals[0].abs_diff_eq(between, 1e-6));
    for (a, b) in [("s off\n", ""), ("s 1\n", "s 2\n"), ("s 1\n", "s off\n")] {
        let hard = good(&faces(a, b));
        let mesh = &hard.parts[0].mesh;
        assert_eq!(mesh.positions.len(), 8, "{a}{b}");
        assert_eq!(mesh.normals.iter().filter(|n| n.abs_diff_eq(Vec3::Z, 1e-6)).count(), 4);
        assert_eq!(mesh.normals.iter().filter(|n| n.abs_diff_eq(-Vec3::X, 1e-6)).count(), 4);
    }
}

#[test]
fn a_concave_polygon_is_covered_once() {
    // No fan around its first corner covers it.
    let arrow = good("v 0 2 0\nv 0 0 0\nv 2 0 0\nv 0.1 0.1 0\nf 3 4 1 2\n");
    assert_eq!(arrow.notes, []);
    let mesh = &arrow.parts[0].mesh;
    let twice_areas = mesh.triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        (b - a).cross(c - a).z
    });
    let twice_areas: Vec<f32> = twice_areas.collect();
    assert!(twice_areas.iter().all(|area| *area > 0.0), "{twice_areas:?}");
    assert!((twice_areas.iter().sum::<f32>() - 0.4).abs() < 1e-6, "{twice_areas:?}");
    assert_eq!(mesh.normals, [Vec3::Z; 4]);
    // One that crosses itself has no such triangles, which is told.
    let crossed = good("v 0 0 0\nv 4 3 0\nv 4 0 0\nv 0 3 0\nv -2 5 0\nf 1 2 3 4 5\n");
    let notes: Vec<_> = crossed.notes.iter().map(ToString::to_string).collect();
    assert_eq!(notes, ["faces: 1 polygons cross themselves: some of their triangles overlap"]);
}

#[test]
fn colours_of_vertices_are_decoded() {
    let text = "v 0 0 0 1 1 1\nv 1 0 0\nv 1 1 0 0.5 0.04 0\nv 0 1 0 1 1 0 0.5\nv 2 0 0\nf 1 2 3 4\n\
        o plain\nv 3 1 0 1 1 1\nf 2 5 6\n";
    let obj = good(text);
    let colors: Vec<_> = obj.parts[0].mesh.colors.iter().map(|color| color.to_array()).collect();
    // By IEC 61966-2-1: ((0.5 + 0.055) / 1.055)^2.4, and 0.04 / 12.92. A vertex without a colour is white.
    let half = 0.214_041;
    let expected = [[1.0; 4], [1.0; 4], [half, 0.003_095_98, 0.0, 1.0], [1.0, 0.0, half, 1.0]];
    assert_eq!(colors.len(), expected.len());
    for (color, expected) in colors.iter().flatten().zip(expected.iter().flatten()) {
        assert!((color - expected).abs() < 1e-6, "{colors:?}");
    }
    // What is white all over needs no colours.
    assert_eq!(obj.parts[1].mesh.colors, []);
    assert_eq!(obj.notes, []);
    assert_eq!(obj.into_scene().expect("a scene").parts[0].mesh.colors.len(), 4);
    // A weight before the colour is told, and so are numbers that no colour has.
    let odd = good("v 0 0 0 2 1 0 0\nv 1 0 0 255 0 -1\nv 1 1 0\nf 1 2 3\n");
    assert_eq!(odd.parts[0].mesh.colors[..2], [glam::Vec4::new(1.0, 0.0, 0.0, 1.0); 2]);
    let notes: Vec<_> = odd.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "line 1: weights of vertices, for rational curves, are left out",
            "line 2: colours of vertices beyond 0 to 1 are brought into it",
        ]
    );
}

#[test]
fn materials_come_from_libraries() {
    let text = "mtllib ./my stuff.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red paint\nf 1 2 3\n";
    let library = "newmtl other\nmap_Kd unused.png\n\nnewmtl red paint\nKd 0.8 0.1 0.2\nNs 6\nd 0.5\nTr 1\nKe 0.25\n\
        map_Kd -s 1 1 1 -clamp on textures\\red paint.png\nbump -bm 0.5 dents.png\n";
    let mut asked = Vec::new();
    let scene = read("a.obj", text.as_bytes(), &mut |path| {
        asked.push(path.to_owned());
        match path {
            "my stuff.mtl" => Ok(library.as_bytes().to_vec()),
            "textures/red paint.png" => Ok(b"\x89PNG....".to_vec()),
            _ => Err("none".to_owned()),
        }
    })
    .expect("a good file");
    assert_eq!(asked, ["my stuff.mtl", "textures/red paint.png", "dents.png"]);
    let material = &scene.materials[scene.parts[0].material.expect("a material")];
    assert_eq!(material.base_color, [0.8, 0.1, 0.2, 0.5]);
    assert_eq!((material.alpha_mode, material.metallic), (AlphaMode::Blend, 0.0));
    assert_eq!(material.emissive, [0.25; 3]);
    // The fourth root of 2 / (6 + 2).
    assert!((material.roughness - 0.5f32.sqrt()).abs() < 1e-6);
    let clamped = TextureRef { wrap: [Wrap::Clamp; 2], ..TextureRef::from(0) };
    assert_eq!((material.base_color_texture, material.normal_texture), (Some(clamped), Some(1.into())));
    assert_eq!((scene.images[0].mime.as_str(), scene.images[1].bytes.len()), ("image/png", 0));
    assert!(scene.notes.iter().any(|note| note.place == "dents.png"));
    let error = read("a.obj", text.as_bytes(), &mut |_| Ok(b"newmtl a\nKd red".to_vec())).map(|_| ());
    assert_eq!(error, Ok(()));
    let error =
        read("a.obj", text.as_bytes(), &mut |_| Ok(b"newmtl a\nKd 1 x 1".to_vec())).expect_err("no number");
    assert_eq!((error.file.as_str(), error.place.as_str()), ("my stuff.mtl", "line 2"));
}

#[test]
fn the_opacity_of_the_picture_of_the_colour_is_its_alpha() {
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl hair\nf 1 2 3\n";
    let material = |library: &str| {
        let scene = read("a.obj", text.as_bytes(), &mut |path| match path {
            "a.mtl" => Ok(library.as_bytes().to_vec()),
            _ => Ok(b"\x89PNG....".to_vec()),
        })
        .expect("a good file");
        let told =
            scene.notes.iter().any(|note| note.to_string().contains("its opacity texture is left out"));
        (scene.materials[0].alpha_mode, told, scene.materials[0].double_sided)
    };
    // In either order; a file of this kind says nothing about sides.
    assert_eq!(material("newmtl hair\nmap_Kd a.png\nmap_d a.png\n"), (AlphaMode::Blend, false, true));
    assert_eq!(material("newmtl hair\nmap_d a.png\nmap_Kd a.png\n"), (AlphaMode::Blend, false, true));
    assert_eq!(material("newmtl hair\nmap_Kd a.png\nmap_d b.png\n"), (AlphaMode::Opaque, true, true));
    assert_eq!(material("newmtl hair\nmap_Kd a.png\n"), (AlphaMode::Opaque, false, true));
}

#[test]
fn paths_stay_in_the_folder() {
    for (written, asked) in [
        (r"C:\Users\me\skin.png", Some("skin.png")),
        ("/home/me/my skin.png", Some("my skin.png")),
        ("../../textures/skin.png", Some("skin.png")),
        (r"a\..\..\skin.png", Some("skin.png")),
        ("./maps//skin.png", Some("maps/skin.png")),
        (r"\\server\share\skin.png", Some("skin.png")),
        ("C:skin.png", None),
        ("..", None),
        ("/", None),
        ("-s 1 1 1", None),
    ] {
        let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
        let library = format!("newmtl a\nmap_Kd {written}\n");
        let mut found = Vec::new();
        let scene = read("a.obj", text.as_bytes(), &mut |path| {
            found.push(path.to_owned());
            if path == "a.mtl" { Ok(library.clone().into_bytes()) } else { Err("no such file".to_owned()) }
        })
        .expect("a good file");
        assert_eq!(found[1..], asked.into_iter().collect::<Vec<_>>(), "{written}");
        assert_eq!(scene.images.len(), found.len() - 1);
    }
}

#[test]
fn lines_may_be_continued_and_encoded_in_sixteen_bits() {
    let text = "v 0 0 0 # origin\r\nv 1 0 \\\r\n 0\r\nv 0 1 0\r\nf 1 2 3\r\n";
    let wide: Vec<u8> =
        "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_be_bytes).collect();
    let narrow = good(text);
    assert_eq!(narrow.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(read_obj("a.obj", &wide, &mut |_| Err(String::new())), Ok(narrow));
}

#[test]
fn errors_name_their_line() {
    let v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (rest, line) in [
        ("f 1 2\n", 4),
        ("f\n", 4),
        ("f 1 2 0\n", 4),
        ("f 1 2 -4\n", 4),
        ("f 1 2 4\nf 1 2 3", 4),
        ("f 1 2 9999999999999999999999\n", 4),
        ("f 1 2 -9223372036854775808\n", 4),
        ("f 1/1 2/1 3/1\n", 4),
        ("f 1//1 2//1 3//1\n", 4),
        ("f 1/2/3/4 2 3\n", 4),
        ("\nv 1 2\n", 5),
        ("v 1 nan 2\n", 4),
        ("v 1 1e39 2\n", 4),
        ("vn 1 0\n", 4),
        ("vt inf\n", 4),
        ("s x\n", 4),
        ("f 1 2 \\\n", 4),
        ("l 1 2\n", 4),
        ("", 3),
    ] {
        let error = parse(&format!("{v}{rest}")).expect_err(rest);
        assert_eq!((error.file.as_str(), error.place), ("a.obj", format!("line {line}")), "{rest}");
    }
    assert!(parse("").is_err());
}

#[test]
fn faces_of_many_corners_and_many_parts_take_bounded_time() {
    let corners: String = (0..100_000).map(|k| format!(" {}", 1 + k % 3)).collect();
    let obj = good(&format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf{corners}\n"));
    assert_eq!(obj.parts[0].mesh.triangles.len(), 99_998);
    let joined = good(&format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2{}3\n", "\\\n".repeat(1_000_000)));
    assert_eq!(joined.faces.corners, [0, 1, 2]);
    let groups: String = (0..70_000).map(|k| format!("g {k}\nf 1 2 3\n")).collect();
    let error = parse(&format!("\n\ng {}\n", "x".repeat(2000))).expect_err("too long");
    assert_eq!((error.place.as_str(), error.found.as_str()), ("line 3", "2000"));
    let error = parse(&format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{groups}")).expect_err("too many");
    assert_eq!(error.place, format!("line {}", 3 + 2 * 65_536 + 2));
}

/// Statements of a kind, counted without the reader.
fn count(text: &str, keyword: &str) -> usize {
    text.lines().filter(|line| line.split_whitespace().next() == Some(keyword)).count()
}

#[test]
fn real_faces_load() {
    for name in [
        "makehuman-cc0/base.obj",
        "mediapipe-face/canonical_face_model.obj",
        "mediapipe-face/face_model_with_iris.obj",
    ] {
        let Some(path) = shared_data(name) else { continue };
        let bytes = texts::bytes(&path);
        let text = String::from_utf8_lossy(&bytes);
        let obj = read_obj(name, &bytes, &mut |_| Err(String::new())).expect(name);
        assert_eq!(obj.positions.len(), count(&text, "v"), "{name}");
        let faces = text.lines().filter(|line| line.starts_with("f "));
        let triangles: usize = faces.map(|line| line.split_whitespace().count() - 3).sum();
        assert_eq!(obj.faces.ends.len(), count(&text, "f"), "{name}");
        let in_parts: usize = obj.parts.iter().map(|part| part.mesh.triangles.len()).sum();
        assert_eq!(in_parts, triangles, "{name}");
        let groups: std::collections::HashSet<_> =
            text.lines().filter(|line| line.starts_with("g ")).collect();
        assert_eq!(obj.parts.len(), groups.len().max(1), "{name}");
        for part in &obj.parts {
            let from_file = part.sources.iter().map(|source| obj.positions[*source as usize]);
            assert!(from_file.eq(part.mesh.positions.iter().copied()), "{name}");
        }
        obj.into_scene().expect(name);
    }
}

#[test]
fn test_models_load_or_tell() {
    let mut loaded = 0;
    let models = texts::test_models(&["obj"]);
    for path in &models {
        let folder = path.parent().expect("a folder");
        let mut resolve = |name: &str| std::fs::read(folder.join(name)).map_err(|error| error.to_string());
        loaded +=
            usize::from(texts::loads_or_tells(path, |name, bytes| read(name, bytes, &mut resolve)).is_ok());
    }
    // A few of them are broken or have no faces.
    assert!(2 * loaded >= models.len(), "{loaded} of {}", models.len());
}

#[test]
fn the_end_of_the_name_tells_the_format() {
    let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let none = &mut |_: &str| Err(String::new());
    assert_eq!(avatar_exchange::read("a.OBJ", text, &[], none), read("a.OBJ", text, none));
}

#[test]
fn damaged_files_are_told() {
    let mut text = String::from("mtllib a.mtl\no grid\n");
    for k in 0..64 {
        text += &format!("v {} {} {}\nvt 0.{k} 0.5\nvn 0 0 1\n", k % 8, k / 8, 0.25 * f64::from(k % 3));
    }
    for k in (0..55).filter(|k| k % 8 != 7) {
        let corner = |k: i32| format!("{k}/{k}/{k}");
        text += &format!(
            "usemtl m{}\nf {} {} {} {}\n",
            k % 2,
            corner(k + 1),
            corner(k + 2),
            corner(k + 10),
            corner(k + 9)
        );
    }
    let told =
        texts::survives_damage(text.as_bytes(), |bytes| read("a.obj", bytes, &mut |_| Err(String::new())));
    assert!(told > 200, "{told}");
    let library = b"newmtl m0\nKd 0.5 0.5 0.5\nmap_Kd -s 1 1 -o 0 0 a.png\nNs 50\nd 0.5\nnewmtl m1\nKe 1\nmap_Bump -bm 1 b.png\n";
    let told = texts::survives_damage(library, |bytes| {
        read("a.obj", text.as_bytes(), &mut |path| {
            (path == "a.mtl").then(|| bytes.to_vec()).ok_or_else(String::new)
        })
    });
    assert!(told > 20, "{told}");
}

fn mesh() -> impl Strategy<Value = Mesh> {
    let number = || prop_oneof![-1e3f32..1e3, any::<f32>().prop_filter("finite", |x| x.is_finite())];
    let vertex = (number(), number(), number(), -4.0f32..4.0, -4.0f32..4.0, -3.0f32..3.0, -1.5f32..1.5);
    prop::collection::vec(vertex, 3..40).prop_flat_map(|vertices| {
        let count = vertices.len() as u32;
        prop::collection::vec([0..count, 0..count, 0..count], 0..30).prop_map(move |more| {
            // Every vertex is used.
            let triangles = (0..count).map(|k| [k, (k + 1) % count, (k + 2) % count]).chain(more);
            Mesh {
                positions: vertices.iter().map(|v| Vec3::new(v.0, v.1, v.2)).collect(),
                uvs: vertices.iter().map(|v| Vec2::new(v.3, v.4)).collect(),
                normals: vertices
                    .iter()
                    .map(|v| Vec3::new(v.5.cos() * v.6.cos(), v.6.sin(), v.5.sin() * v.6.cos()))
                    .collect(),
                triangles: triangles.collect(),
                ..Mesh::default()
            }
        })
    })
}

proptest! {
    #[test]
    fn what_is_written_reads_back(meshes in prop::collection::vec((mesh(), "[ -~]{0,8}"), 1..4)) {
        let parts: Vec<_> = meshes.iter().map(|(mesh, name)| obj::ObjPart {
            name, positions: &mesh.positions, normals: &mesh.normals, uvs: &mesh.uvs, triangles: &mesh.triangles,
        }).collect();
        let again = good(&obj::write_parts(&parts));
        prop_assert_eq!(again.parts.len(), meshes.len());
        for ((mesh, _), part) in meshes.iter().zip(&again.parts) {
            // A coordinate v next to 0 is not told from 1 − v next to 1.
            let flat = |mesh: &Mesh| mesh.uvs.iter().flat_map(|uv| uv.to_array()).collect::<Vec<f32>>();
            let close = flat(mesh).iter().zip(flat(&part.mesh)).all(|(a, b)| (a - b).abs() < 1e-15 + 1e-7 * a.abs());
            prop_assert!(close);
            prop_assert_eq!(&Mesh { uvs: Vec::new(), ..part.mesh.clone() }, &Mesh { uvs: Vec::new(), ..mesh.clone() });
        }
    }
}
