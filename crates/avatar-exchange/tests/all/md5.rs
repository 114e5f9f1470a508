//! Meshes and animations of id Tech 4.

use crate::support::texts;
use avatar_exchange::md5::read;
use avatar_exchange::{ImportError, Scene, TextFile};
use avatar_mesh::deform;
use glam::{DVec3, Vec2, Vec3};

/// An arm that points along x at bind pose, from two joints: the second one is turned a quarter about z, so
/// that its x is the model's y.
const MESH: &str = r#"MD5Version 10
commandline "mesh arm.ma // not a comment"

numJoints 2
numMeshes 1

joints {
	"upper arm"	-1 ( 0 0 10 ) ( 0 0 0 )		// origin
	"hand"	0 ( 4 0 10 ) ( 0 0 -0.7071067811865476 )
}

mesh {
	shader "models/arm"

	numverts 4
	vert 0 ( 0 0.25 ) 0 1
	vert 1 ( 1 0.25 ) 1 1
	vert 2 ( 0 1 ) 2 2
	vert 3 ( 1 1 ) 4 5

	numtris 2
	tri 0 0 2 1
	tri 1 1 2 3

	numweights 9
	weight 0 0 1 ( 0 0 0 )
	weight 1 1 1 ( 0 -2 0 )
	weight 2 0 0.5 ( 2 2 0 )
	weight 3 1 0.5 ( 2 2 0 )
	weight 4 0 0.25 ( 6 3 0 )
	weight 5 1 0.2 ( 3 -2 0 )
	weight 6 1 0.2 ( 3 -2 0 )
	weight 7 0 0.05 ( 6 3 0 )
	weight 8 0 0.3 ( 6 3 0 )
}
"#;

/// The hand moves to y = 1 and turns back; the upper arm stays 2 higher than in the mesh.
const ANIM: &str = r#"MD5Version 10
commandline ""

numFrames 2
numJoints 2
frameRate 4
numAnimatedComponents 2

hierarchy {
	"upper arm" -1 0 0
	"hand" 0 34 0 // upper arm
}

bounds {
	( 0 0 0 ) ( 1 1 1 )
	( 0 0 0 ) ( 1 1 1 )
}

baseframe {
	( 0 0 12 ) ( 0 0 0 )
	( 4 0 0 ) ( 0 0 0 )
}

frame 0 {
	0 -0.7071067811865476
}

frame 1 {
	1 0
}
"#;

fn read_texts(mesh: &str, animations: &[(&str, &str)]) -> Result<Scene, ImportError> {
    let files: Vec<_> =
        animations.iter().map(|(file, text)| TextFile { file, bytes: text.as_bytes() }).collect();
    read(TextFile { file: "arm.md5mesh", bytes: mesh.as_bytes() }, &files)
}

fn posed(scene: &Scene, clip: usize, time_secs: f64) -> Vec<Vec3> {
    let pose = scene.at(clip, time_secs).expect("a clip");
    let bones = scene.bones(&pose);
    let mesh = &scene.parts[0].mesh;
    let mut out = mesh.deformed();
    deform(mesh, scene.bones_of(0, &bones), scene.weights_of(0, &pose), &mut out).expect("a pose");
    out.positions
}

#[test]
fn of_nine_weights_the_eight_largest_remain() {
    let nine = MESH.replace("vert 3 ( 1 1 ) 4 5", "vert 3 ( 1 1 ) 0 9");
    let scene = read_texts(&nine, &[]).expect("a good file");
    let skinning = scene.parts[0].mesh.skinning.as_ref().expect("bones");
    let expected = [1.0, 1.0, 0.5, 0.5, 0.3, 0.25, 0.2, 0.2].map(|weight: f32| weight / 3.95);
    let found = [skinning.weights[3], skinning.more_weights[3]].concat();
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?}");
    let notes: Vec<_> = scene.notes.iter().map(|note| note.finding.to_string()).collect();
    assert!(notes[0].starts_with("1 vertices have more than eight bones"), "{notes:?}");
}

fn close(found: &[Vec3], expected: &[[f32; 3]]) {
    let all = found.iter().zip(expected).all(|(a, b)| a.abs_diff_eq(Vec3::from(*b), 1e-5));
    assert!(all && found.len() == expected.len(), "{found:?} {expected:?}");
}

#[test]
fn vertices_come_from_weights() {
    let scene = read_texts(MESH, &[]).expect("a good file");
    let mesh = &scene.parts[0].mesh;
    // The hand takes (x, y) to (4 − y, x): vertex 2 lies between (2, 2) and (2, 2), vertex 3 at (6, 3) by all
    // weights.
    close(&mesh.positions, &[[0.0, 0.0, 10.0], [6.0, 0.0, 10.0], [2.0, 2.0, 10.0], [6.0, 3.0, 10.0]]);
    assert_eq!(mesh.uvs[0], Vec2::new(0.0, 0.25));
    // Turned around: up.
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(mesh.normals, [Vec3::Z; 4]);
    let skinning = mesh.skinning.as_ref().expect("bones");
    assert_eq!(skinning.weights[2], [0.5, 0.5, 0.0, 0.0]);
    assert_eq!((skinning.bones[3], skinning.weights[3]), ([0, 0, 1, 1], [0.3, 0.25, 0.2, 0.2]));
    assert_eq!((skinning.more_bones[3], skinning.more_weights[3]), ([0; 4], [0.05, 0.0, 0.0, 0.0]));
    assert_eq!(skinning.more_weights[..3], [[0.0; 4]; 3]);
    let notes: Vec<_> = scene.notes.iter().map(|note| note.finding.to_string()).collect();
    assert!(notes[0].starts_with("z is up and x is forward"), "{notes:?}");
    assert_eq!(scene.materials[scene.parts[0].material.expect("a material")].name, "models/arm");
    // In the world y is up, and the model looks along z: (x, y, z) is (y, z, x).
    let worlds = scene.worlds(&scene.rest());
    assert_eq!(scene.nodes[2].name, "hand");
    assert!(worlds[2].translation.abs_diff_eq(DVec3::new(0.0, 10.0, 4.0), 1e-6));
}

#[test]
fn animations_become_clips() {
    let scene = read_texts(MESH, &[("walk.md5anim", ANIM), ("wave.md5anim", ANIM)]).expect("good files");
    let names: Vec<_> = scene.clips.iter().map(|clip| clip.name.as_str()).collect();
    assert_eq!((names, scene.clips[0].duration_secs()), (vec!["walk", "wave"], 0.25));
    // As at bind pose, but 2 higher: (x, y, z) is (y, z, x) in the world.
    close(&posed(&scene, 1, 0.0), &[[0.0, 12.0, 0.0], [0.0, 12.0, 6.0], [2.0, 12.0, 2.0], [3.0, 12.0, 6.0]]);
    // The hand at (4, 1), not turned: its (0, −2) is at (4, −1), its (2, 2) at (6, 3); vertex 3 was at its
    // (3, −2), now (7, −1).
    let share = 0.4;
    let last = [3.0 - 4.0 * share, 12.0, 6.0 + share];
    close(&posed(&scene, 0, 0.25), &[[0.0, 12.0, 0.0], [-1.0, 12.0, 4.0], [2.5, 12.0, 4.0], last]);
}

#[test]
fn errors_name_file_and_line() {
    for (from, to, line) in [
        ("Version 10", "Version 11", 1),
        ("numJoints 2", "numJoints 3", 12),
        ("numJoints 2", "numJoints -2", 4),
        ("numJoints 2", "numJoints 1", 9),
        ("numMeshes 1", "numMeshes 2", 36),
        ("\"hand\"	0", "\"hand\"	1", 9),
        ("\"hand\"	0", "\"hand\"	-2", 9),
        ("( 4 0 10 )", "( 4 0 )", 9),
        ("( 4 0 10 )", "( 4 0 1e39 )", 9),
        ("numverts 4", "numverts 4000000000", 21),
        ("numverts 4", "numverts 3", 19),
        ("vert 2", "vert 1", 18),
        ("2 2\n", "2 8\n", 18),
        ("2 2\n", "2 99999999999\n", 18),
        ("2 2\n", "2 0\n", 18),
        ("2 2\n", "4294967294 200\n", 18),
        ("tri 1 1 2 3", "tri 1 1 2 4", 23),
        ("weight 3 1", "weight 3 2", 29),
        ("weight 3 1 0.5", "weight 3 1 nan", 29),
        ("weight 3 1 0.5", "weight 3 1 -0.5", 29),
        ("weight 0 0 1", "weight 0 0 0", 16),
        ("shader", "shadow", 13),
        ("joints {", "bones {", 7),
        ("\"upper arm\"", "\"upper arm", 9),
    ] {
        assert!(MESH.contains(from), "{from}");
        let error = read_texts(&MESH.replacen(from, to, 1), &[]).expect_err(to);
        assert_eq!((error.file.as_str(), error.place), ("arm.md5mesh", format!("line {line}")), "{to}");
    }
    for (from, to, line) in [
        ("numJoints 2", "numJoints 3", 5),
        ("\"hand\" 0", "\"foot\" 0", 11),
        ("\"hand\" 0", "\"hand\" -1", 11),
        ("0 34 0", "0 64 0", 11),
        ("0 34 0", "0 34 1", 11),
        ("0 34 0", "0 63 0", 11),
        ("-1 0 0\n", "-1 3 0\n", 11),
        ("frameRate 4", "frameRate 0", 6),
        ("frameRate 4", "frameRate inf", 6),
        ("numFrames 2", "numFrames 3", 17),
        ("frame 1 {", "frame 2 {", 28),
        ("frame 1 {", "fame 1 {", 28),
        ("1 0\n}", "1\n}", 30),
        ("1 0\n}", "1 0 0\n}", 29),
        ("baseframe", "frame", 19),
    ] {
        assert!(ANIM.contains(from), "{from}");
        let error = read_texts(MESH, &[("a.md5anim", &ANIM.replacen(from, to, 1))]).expect_err(to);
        assert_eq!((error.file.as_str(), error.place), ("a.md5anim", format!("line {line}")), "{to}");
    }
    assert_eq!(read_texts("", &[]).expect_err("nothing").found, "the end of the file");
}

#[test]
fn short_files_stand_for_no_long_ones() {
    // Joints that share components, and frames of nothing.
    let joints = 20_000;
    let list = |line: &dyn Fn(usize) -> String| (0..joints).map(line).collect::<String>();
    let bones = list(&|k| format!("\"j{k}\" {} ( 0 0 0 ) ( 0 0 0 )\n", k as i64 - 1));
    let mesh = format!("MD5Version 10 numJoints {joints} numMeshes 0 joints {{\n{bones}}}");
    let anim = |flags: usize| {
        let hierarchy = list(&|k| format!("\"j{k}\" {} {flags} 0\n", k as i64 - 1));
        let base = "( 0 0 0 ) ( 0 0 0 )\n".repeat(joints);
        let frames: String = (0..joints).map(|k| format!("frame {k} {{ }}\n")).collect();
        format!(
            "MD5Version 10 numFrames {joints} frameRate 30 hierarchy {{ {hierarchy} }} baseframe {{ {base} }} {frames}"
        )
    };
    let start = std::time::Instant::now();
    let scene = read_texts(&mesh, &[("a.md5anim", &anim(0))]).expect("long, but good");
    assert_eq!(scene.clips[0].channels.iter().map(|channel| channel.times.len()).sum::<usize>(), 2 * joints);
    assert!(
        read_texts(&mesh, &[("a.md5anim", &anim(63))]).expect_err("shared").expected.contains("of its own")
    );
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn damaged_files_are_told() {
    let anim = [("a.md5anim", ANIM)];
    let told =
        texts::survives_damage(MESH.as_bytes(), |bytes| read_texts(&String::from_utf8_lossy(bytes), &anim));
    assert!(told > 300, "{told}");
    let told = texts::survives_damage(ANIM.as_bytes(), |bytes| {
        read(
            TextFile { file: "arm.md5mesh", bytes: MESH.as_bytes() },
            &[TextFile { file: "a.md5anim", bytes }],
        )
    });
    assert!(told > 300, "{told}");
}

#[test]
fn test_models_load_or_tell() {
    for path in texts::test_models(&["md5mesh"]) {
        let scene = texts::loads_or_tells(&path, |file, bytes| read(TextFile { file, bytes }, &[]));
        match path.file_stem().expect("a file").to_str() {
            Some("SimpleCube") => {
                let mesh = &scene.expect("a good file").parts[0].mesh;
                // A cube of edge 64, seen from outside.
                let volume = |corners: &[u32; 3]| {
                    let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize].as_dvec3());
                    a.dot(b.cross(c)) / 6.0
                };
                let volume: f64 = mesh.triangles.iter().map(volume).sum();
                assert!((volume / 64f64.powi(3) - 1.0).abs() < 1e-5, "{volume}");
            }
            Some("empty") => assert!(scene.is_err()),
            _ => {}
        }
    }
}
