//! MakeHuman targets on OBJ files.

use crate::support::data::shared_data;
use crate::support::texts;
use avatar_exchange::obj::{ObjFile, read_obj};
use avatar_exchange::target;
use avatar_mesh::deform;
use glam::Vec3;
use std::collections::HashMap;

/// Two triangles in two groups that share an edge; the last vertex belongs to no face.
const BASE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 7 7 7\ng left\nf 1 2 3\ng right\nf 2 4 3\n";

fn base() -> ObjFile {
    read_obj("base.obj", BASE.as_bytes(), &mut |_| Err(String::new())).expect("a good file")
}

#[test]
fn offsets_reach_every_part() {
    let mut obj = base();
    target::add("targets/lift.target", b"# a comment\n\n1 0 0 .5\n4 1 1 1\n3 0 0 -2.5e-1 # more\n", &mut obj)
        .expect("a target");
    target::add("rest.target", b"", &mut obj).expect("an empty target");
    let scene = obj.into_scene().expect("a scene");
    assert_eq!(scene.nodes[0].weights, [0.0; 2]);
    let shapes: Vec<_> = scene.parts.iter().map(|part| &part.mesh.shapes).collect();
    assert_eq!((shapes[0][0].name.as_str(), shapes[0][1].name.as_str()), ("lift", "rest"));
    let moved = |part: usize| shapes[part][0].positions.iter().collect::<Vec<_>>();
    assert_eq!(moved(0), [(1, Vec3::Z * 0.5)]);
    assert_eq!(moved(1), [(0, Vec3::Z * 0.5), (2, Vec3::Z * -0.25)]);
    assert_eq!(shapes[0][1].moved_vertices() + shapes[1][1].moved_vertices(), 0);
    // The left triangle becomes that of 0, (1, 0, ½) and y; its normals follow, and stay the same on both
    // sides of the cut.
    let mut pose = scene.rest();
    pose.weights[0] = vec![1.0, 0.0];
    let mesh = &scene.parts[0].mesh;
    let bones = scene.bones(&pose);
    let mut out = mesh.deformed();
    deform(mesh, scene.bones_of(0, &bones), scene.weights_of(0, &pose), &mut out).expect("a pose");
    assert_eq!(out.positions[1], Vec3::new(1.0, 0.0, 0.5));
    assert!(out.normals[0].abs_diff_eq(Vec3::new(-0.5, 0.0, 1.0).normalize_or_zero(), 1e-6));
    let right = &scene.parts[1].mesh;
    let mut other = right.deformed();
    deform(right, scene.bones_of(1, &bones), scene.weights_of(1, &pose), &mut other).expect("a pose");
    assert!(other.normals[0].abs_diff_eq(out.normals[1], 1e-6) && out.normals[1].x < -0.1);
}

#[test]
fn errors_name_their_line() {
    for (text, line) in [
        ("0 1 2 3\n5 0 0 0\n", 2),
        ("0 1 2\n", 1),
        ("0 1 2 3 4\n", 1),
        ("\n# a\n-1 0 0 0\n", 3),
        ("1.5 0 0 0\n", 1),
        ("1 0 nan 0\n", 1),
        ("1 0 1e40 0\n", 1),
        ("1 0 0 0\n2 0 0 0\n1 0 0 0\n", 3),
        ("99999999999 0 0 0", 1),
        ("what is this", 1),
    ] {
        let error = target::add("a.target", text.as_bytes(), &mut base()).expect_err(text);
        assert_eq!((error.file.as_str(), error.place), ("a.target", format!("line {line}")), "{text}");
    }
    let mut obj = base();
    target::add("a.target", b"", &mut obj).expect("a target");
    let error = target::add("b/a.target", b"", &mut obj).expect_err("the same name");
    assert_eq!((error.file.as_str(), error.place.as_str()), ("b/a.target", "shape \"a\""));
}

#[test]
fn many_vertices_at_one_place_take_bounded_time() {
    let vertices = "v 1 1 1\n".repeat(200_000);
    let faces: String = (1..199_000).step_by(3).map(|k| format!("f {k} {} {}\n", k + 1, k + 2)).collect();
    let start = std::time::Instant::now();
    let mut obj =
        read_obj("a.obj", (vertices + &faces).as_bytes(), &mut |_| Err(String::new())).expect("a file");
    target::add("a.target", b"0 1 0 0\n", &mut obj).expect("a target");
    let scene = obj.into_scene().expect("a scene");
    assert_eq!(scene.parts[0].mesh.shapes[0].moved_vertices(), 1);
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn damaged_files_are_told() {
    let text: String = (0..5).map(|k| format!("# vertex {k}\n{k} 0.0012500{k} -0.25 1e-3{k}\n")).collect();
    let told = texts::survives_damage(text.as_bytes(), |bytes| {
        let mut obj = base();
        target::add("a.target", bytes, &mut obj)?;
        obj.into_scene()
    });
    assert!(told > 100, "{told}");
}

#[test]
fn real_targets_move_what_their_lines_say() {
    let Some(path) = shared_data("makehuman-cc0/base.obj") else { return };
    let mut obj = read_obj("base.obj", &texts::bytes(&path), &mut |_| Err(String::new())).expect("base.obj");
    let mut expected: HashMap<String, HashMap<usize, [f32; 3]>> = HashMap::new();
    for folder in ["talkinghead-arkit-targets", "makehuman-cc0/expression-units-caucasian"] {
        let Some(folder) = shared_data(folder) else { continue };
        let mut files: Vec<_> =
            std::fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path()).collect();
        files.retain(|path| path.extension().is_some_and(|extension| extension == "target"));
        files.sort();
        assert!(!files.is_empty());
        for path in files {
            let bytes = texts::bytes(&path);
            let name = path.file_name().expect("a file").to_string_lossy();
            target::add(&name, &bytes, &mut obj).expect(&name);
            let text = String::from_utf8_lossy(&bytes).into_owned();
            let lines = text.lines().filter(|line| !line.starts_with('#')).map(|line| {
                let n: Vec<f32> =
                    line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
                (n[0] as usize, [n[1], n[2], n[3]])
            });
            expected.insert(name.trim_end_matches(".target").to_owned(), lines.collect());
        }
    }
    let mut compared = 0;
    for part in &obj.parts {
        assert_eq!(part.mesh.shapes.len(), expected.len());
        for shape in &part.mesh.shapes {
            let lines = &expected[&shape.name];
            for (vertex, source) in part.sources.iter().enumerate() {
                let offset = lines.get(&(*source as usize)).copied().unwrap_or_default();
                assert_eq!(shape.positions.get(vertex), Some(Vec3::from(offset)), "{}", shape.name);
                compared += usize::from(offset != [0.0; 3]);
            }
        }
    }
    assert!(compared > expected.len(), "{compared}");
    let shapes = expected.len();
    let scene = obj.into_scene().expect("a scene");
    assert_eq!(scene.nodes[0].weights.len(), shapes);
}
