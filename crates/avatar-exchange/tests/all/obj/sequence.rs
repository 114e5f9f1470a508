//! Sequences of files.

use avatar_exchange::obj::{ObjFrame, read_obj, read_sequence};
use avatar_mesh::deform;
use glam::Vec3;

#[test]
fn a_sequence_plays_its_files() {
    let frame = |z: f32| format!("v 0 0 {z}\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n");
    let files = [frame(0.0), frame(2.0), frame(-1.0)];
    let of = |k: usize, time_secs| ObjFrame {
        file: ["f0.obj", "f1.obj", "f2.obj"][k],
        bytes: files[k].as_bytes(),
        time_secs,
    };
    let scene = read_sequence(&[of(0, 1.0), of(2, 4.0), of(1, 2.0)], &mut |_| Err(String::new()))
        .expect("a sequence");
    let names: Vec<_> = scene.parts[0].mesh.shapes.iter().map(|shape| shape.name.as_str()).collect();
    assert_eq!(names, ["f0", "f1", "f2"]);
    let z_at = |time_secs| {
        let pose = scene.at(0, time_secs).expect("a clip");
        let bones = scene.bones(&pose);
        let mesh = &scene.parts[0].mesh;
        let mut out = mesh.deformed();
        deform(mesh, scene.bones_of(0, &bones), scene.weights_of(0, &pose), &mut out).expect("a pose");
        (out.positions[0].z, out.normals[0])
    };
    for (time_secs, z) in
        [(0.0, 0.0), (1.0, 0.0), (1.5, 1.0), (2.0, 2.0), (3.0, 0.5), (4.0, -1.0), (9.0, -1.0)]
    {
        assert!((z_at(time_secs).0 - z).abs() < 1e-6, "{time_secs}");
    }
    // The plane through (0, 0, 2), x and y.
    let normal = Vec3::new(2.0, 2.0, 1.0) / 3.0;
    assert!(z_at(2.0).1.abs_diff_eq(normal, 1e-6));
}

#[test]
fn frames_that_do_not_fit_are_told() {
    let a = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let of = |file, text: &'static str, time_secs| ObjFrame { file, bytes: text.as_bytes(), time_secs };
    let fails = |frames: &[ObjFrame<'_>]| {
        read_sequence(frames, &mut |_| Err(String::new())).expect_err("no sequence").to_string()
    };
    let more =
        fails(&[of("a.obj", a, 0.0), of("b.obj", "v 0 0 0\nv 0 1 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", 1.0)]);
    assert!(
        ["b.obj: shape \"b\": expected 3 vertices, as in a.obj", "found 4"]
            .iter()
            .all(|text| more.contains(text)),
        "{more}"
    );
    let other = fails(&[of("a.obj", a, 0.0), of("b.obj", "v 0 0 0\nv 0 1 0\nv 1 1 1\nf 3 2 1\n", 1.0)]);
    assert!(other.contains("b.obj") && other.contains("order of vertices"), "{other}");
    assert!(fails(&[of("a.obj", a, 0.0), of("b.obj", a, 0.0)]).contains("b.obj: its time"));
    assert!(fails(&[of("a.obj", a, f64::NAN)]).contains("finite"));
    assert!(fails(&[]).contains("1 to 4096 files"));
    // Faces that begin elsewhere are the same faces.
    let turned = "v 0 0 7\nv 1 0 0\nv 0 1 0\nf 2 3 1\n";
    let scene = read_sequence(&[of("a.obj", a, 0.0), of("b.obj", turned, 1.0)], &mut |_| Err(String::new()))
        .expect("a sequence");
    assert_eq!(scene.notes.len(), 1);
    assert_eq!(scene.parts[0].mesh.shapes[1].positions.get(0), Some(Vec3::Z * 7.0));
}

#[test]
fn quads_that_begin_at_another_corner_are_the_same_quads() {
    // A quad and a pentagon that share an edge, with a normal of its own at every corner.
    let points = |z: f32| format!("v 0 0 {z}\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\n");
    let normals =
        ["1 0 0", "0 1 0", "0 0 1", "0.6 0.8 0", "0 0.6 0.8", "0.8 0 0.6", "0 -1 0", "-1 0 0", "0 0 -1"];
    let normals: String = normals.iter().map(|normal| format!("vn {normal}\n")).collect();
    let base = format!("{}vn 0 0 1\nf 1//1 2//1 3//1 4//1\nf 2//1 5//1 6//1 7//1 3//1\n", points(0.0));
    // The other one first; each begins two corners later.
    let other = format!("{}{normals}f 6//7 7//8 3//9 2//5 5//6\nf 3//3 4//4 1//1 2//2\n", points(4.0));
    let of = |file, text: &str| read_obj(file, text.as_bytes(), &mut |_| Err(String::new())).expect(text);
    let (mut obj, frame) = (of("a.obj", &base), of("b.obj", &other));
    obj.add_shape_of("b", &frame).expect("the same faces");
    let note = obj.notes.last().expect("a warning");
    assert_eq!(note.place, "b.obj");
    let text = note.to_string();
    assert!(text.contains("2 of 2 elsewhere and 2 that begin at another corner"), "{text}");
    // Each corner's normal is the one that the other file gives to this vertex; where two faces meet at one,
    // the later face's holds, so that only corners of the quad alone and of the pentagon are looked at.
    let part = &obj.parts[0];
    let shape = &part.mesh.shapes[0];
    let change = |vertex: usize| {
        part.mesh.normals[vertex] + shape.normals.as_ref().expect("normals").get(vertex).unwrap_or(Vec3::ZERO)
    };
    for (source, expected) in [
        (0, Vec3::X),
        (3, Vec3::new(0.6, 0.8, 0.0)),
        (1, Vec3::new(0.0, 0.6, 0.8)),
        (4, Vec3::new(0.8, 0.0, 0.6)),
        (5, Vec3::NEG_Y),
        (6, Vec3::NEG_X),
        (2, Vec3::NEG_Z),
    ] {
        let vertex = part.sources.iter().position(|s| *s == source).expect("a vertex");
        assert!(change(vertex).abs_diff_eq(expected, 1e-6), "{source}: {}", change(vertex));
    }
    assert_eq!(shape.positions.get(0), Some(Vec3::Z * 4.0));
    // The other way around it is another face.
    let back = format!("{}f 1 4 3 2\nf 2 5 6 7 3\n", points(0.0));
    let error = obj.add_shape_of("back", &of("c.obj", &back)).expect_err("another face").to_string();
    assert!(
        error.contains("the base's 2 faces, as in a.obj")
            && error.contains("none for 1 of them (first 0: [0, 1, 2, 3])"),
        "{error}"
    );
}

#[test]
fn many_frames_of_many_vertices_are_refused_before_they_are_read() {
    let vertices: String = (0..5_000).map(|k| format!("v {k} 0 0\nv {k} 1 0\nv {k} 0 1\n")).collect();
    let faces: String =
        (0..5_000).map(|k| format!("f {} {} {}\n", 3 * k + 1, 3 * k + 2, 3 * k + 3)).collect();
    let text = vertices + &faces;
    // Only the first is a file at all.
    let frame = |k: u16| ObjFrame {
        file: "frame.obj",
        bytes: if k == 0 { text.as_bytes() } else { b"" },
        time_secs: f64::from(k),
    };
    let frames: Vec<_> = (0..4_000).map(frame).collect();
    let error = read_sequence(&frames, &mut |_| Err(String::new())).expect_err("too much");
    assert_eq!(error.place, "the sequence");
    assert!(error.expected.contains("vertices more in parts and shapes"), "{error}");
}

#[test]
fn frames_of_one_name_are_told_apart() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let of = |file, time_secs| ObjFrame { file, bytes: text.as_bytes(), time_secs };
    let frames = [of("a/f.obj", 0.0), of("b/f.obj", 1.0), of("f.2.obj", 2.0)];
    let scene = read_sequence(&frames, &mut |_| Err(String::new())).expect("a sequence");
    let names: Vec<_> = scene.parts[0].mesh.shapes.iter().map(|shape| shape.name.as_str()).collect();
    assert_eq!(names, ["f", "f.3", "f.2"]);
}
