//! FBX: values computed by hand, other people's files, damaged files.

mod others;
mod reference;
mod surface;
mod takes;

use crate::support::damage::read_any;
use avatar_exchange::{ImportError, Scene, Transform, fbx};
use avatar_mesh::drivers::ShapeDrivers;
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

fn read(file: &str, bytes: &[u8]) -> Result<Scene, ImportError> {
    fbx::read(file, bytes, &mut |_| Err("there are no other files".to_owned()))
}

/// A square of 1 m in the x-y plane, in centimetres; a node that is turned before its own rotation; two bones
/// of which the second stands at the square's upper left corner; a channel with an in-between.
const FACE: &str = include_str!("face.fbx");

fn face() -> Scene {
    read("face.fbx", FACE.as_bytes()).unwrap()
}

fn node(scene: &Scene, name: &str) -> usize {
    scene.nodes.iter().position(|node| node.name == name).unwrap()
}

fn close(a: &[f32], b: &[f32]) {
    let near = a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(near, "{a:?} is not {b:?}");
}

#[test]
fn nodes_are_in_metres_and_turned_before_they_turn() {
    let scene = face();
    let worlds = scene.worlds(&scene.rest());
    close(&worlds[node(&scene, "turned")].translation.as_vec3().to_array(), &[1.0, 0.0, 0.0]);
    // 1 m along the turned x axis, which is y.
    close(&worlds[node(&scene, "tip")].translation.as_vec3().to_array(), &[1.0, 1.0, 0.0]);
    assert!(
        scene.notes.iter().any(|note| note.finding.to_string().contains("0.01 m were converted")),
        "{:?}",
        scene.notes
    );
}

#[test]
fn a_square_becomes_two_triangles_with_flipped_uvs_and_normals() {
    let scene = face();
    let [part] = &scene.parts[..] else { panic!("{} parts", scene.parts.len()) };
    assert_eq!((part.mesh.positions.len(), part.mesh.triangles.len()), (4, 2));
    let at = |position: Vec3| part.mesh.positions.iter().position(|p| p.distance(position) < 1e-6).unwrap();
    assert_eq!(part.mesh.uvs[at(Vec3::ZERO)], Vec2::new(0.0, 1.0));
    assert_eq!(part.mesh.uvs[at(Vec3::new(1.0, 1.0, 0.0))], Vec2::new(1.0, 0.25));
    assert!(part.mesh.normals.iter().all(|normal| normal.distance(Vec3::Z) < 1e-6));
    close(&scene.materials[part.material.unwrap()].base_color, &[0.5, 0.25, 0.125, 1.0]);
}

#[test]
fn cages_of_subdivision_are_told() {
    let is_told = |text: &str| {
        let scene = read("face.fbx", text.as_bytes()).unwrap();
        let finding = "a subdivision surface, of which the cage is read";
        scene.notes.iter().any(|note| note.to_string().contains(finding))
    };
    let smooth = FACE.replacen("GeometryVersion: 124", "GeometryVersion: 124\n\t\tSmoothness: 2", 1);
    assert!(is_told(&smooth) && !is_told(FACE));
}

#[test]
fn joints_move_points_and_points_without_weights_follow_the_mesh() {
    let scene = face();
    let mut pose = scene.rest();
    pose.weights[scene.parts[0].node].fill(0.0);
    let corner = |pose: &avatar_exchange::ScenePose, rest: Vec3| {
        let bones = scene.bones(pose);
        let mesh = &scene.parts[0].mesh;
        let mut out = mesh.deformed();
        avatar_mesh::deform(mesh, scene.bones_of(0, &bones), scene.weights_of(0, pose), &mut out).unwrap();
        out.positions[mesh.positions.iter().position(|p| p.distance(rest) < 1e-6).unwrap()].to_array()
    };
    let (right, left) = (Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
    close(&corner(&pose, right), &right.to_array());
    let knee = node(&scene, "knee");
    let Transform::Trs(trs) = &mut pose.locals[knee] else { panic!("a matrix") };
    trs.rotation = Quat::from_rotation_z(FRAC_PI_2);
    // 1 m to the right of the knee becomes 1 m above it. Its weight of 0.5, alone, was made 1.
    close(&corner(&pose, right), &[0.0, 2.0, 0.0]);
    close(&corner(&pose, left), &left.to_array());
    assert!(
        scene.notes.iter().any(|note| note.finding.to_string().contains("1 points without weights")),
        "{:?}",
        scene.notes
    );
}

#[test]
fn in_betweens_are_shapes_with_rules() {
    let scene = face();
    let part = &scene.parts[0];
    let names: Vec<&str> = part.mesh.shapes.iter().map(|shape| shape.name.as_str()).collect();
    assert_eq!(names, ["smile@50", "smile"]);
    // 75 %: halfway from the one to the other.
    close(&scene.nodes[part.node].weights, &[0.5, 0.5]);
    let lift =
        |shape: usize| part.mesh.shapes[shape].positions.iter().map(|(_, offset)| offset.z).sum::<f32>();
    close(&[lift(0), lift(1)], &[0.1, 0.4]);
    let [rules] = &scene.drivers[..] else { panic!("{:?}", scene.drivers) };
    let program = ShapeDrivers::new(&rules.drivers, &rules.shapes, &rules.rules).unwrap();
    let mut weights = [0.0; 2];
    program.run(&[0.25], &mut weights).unwrap();
    assert_eq!((rules.drivers[0].as_str(), weights), ("smile", [0.5, 0.0]));
}

#[test]
fn takes_move_nodes_and_shapes() {
    let scene = face();
    let [clip] = &scene.clips[..] else { panic!("{} clips", scene.clips.len()) };
    assert_eq!((clip.name.as_str(), clip.duration_secs()), ("nod", 1.0));
    let (face, knee) = (scene.parts[0].node, node(&scene, "knee"));
    for (time, weights) in
        [(0.0, [0.0, 0.0]), (0.25, [0.5, 0.0]), (0.5, [1.0, 0.0]), (0.75, [0.5, 0.5]), (1.0, [0.0, 1.0])]
    {
        let pose = scene.at(0, time).unwrap();
        close(&pose.weights[face], &weights);
        let Transform::Trs(trs) = pose.locals[knee] else { panic!("a matrix") };
        close(&trs.translation.to_array(), &[(0.5 * time) as f32, 1.0, 0.0]);
    }
}

/// The face with so many more clusters at the point of the knee, all of its weight.
fn with_clusters(more: usize) -> Scene {
    let cluster = |k: usize| {
        format!(
            r#"	Deformer: {}, "SubDeformer::more", "Cluster" {{
		Version: 100
		Indexes: *1 {{ a: 2 }}
		Weights: *1 {{ a: {} }}
		Transform: *16 {{ a: 1,0,0,0,0,1,0,0,0,0,1,0,0,-100,0,1 }}
		TransformLink: *16 {{ a: 1,0,0,0,0,1,0,0,0,0,1,0,0,100,0,1 }}
	}}
"#,
            400 + k,
            0.25 + 0.125 * k as f32
        )
    };
    let connection = |k: usize| format!("\tC: \"OO\",{0},40\n\tC: \"OO\",15,{0}\n", 400 + k);
    let clusters: String = (0..more).map(cluster).collect();
    let connections: String = (0..more).map(connection).collect();
    let before = "\tAnimationStack: 50,";
    let text = FACE.replace(before, &(clusters + before));
    let text = text.replace("\tC: \"OO\",51,50\n", &(connections + "\tC: \"OO\",51,50\n"));
    read("face.fbx", text.as_bytes()).unwrap()
}

#[test]
fn eight_clusters_move_a_point_and_the_ninth_is_noted() {
    let skinning = |scene: &Scene| scene.parts[0].mesh.skinning.clone().unwrap();
    assert!(skinning(&with_clusters(3)).more_bones.is_empty());
    let eight = with_clusters(7);
    let of_point = |scene: &Scene| {
        let skinning = skinning(scene);
        let vertex = skinning.more_weights.iter().position(|weights| *weights != [0.0; 4]).unwrap();
        [skinning.weights[vertex], skinning.more_weights[vertex]].concat()
    };
    // ½ and ¼, ⅜ … 1, the largest first, of a sum of 4.875.
    let all = [1.0, 0.875, 0.75, 0.625, 0.5, 0.5, 0.375, 0.25];
    close(&of_point(&eight), &all.map(|weight| weight / 4.875));
    let noted =
        |scene: &Scene| scene.notes.iter().any(|note| note.finding.to_string().contains("eight bones"));
    assert!(!noted(&eight));
    let nine = with_clusters(8);
    let all = [1.125, 1.0, 0.875, 0.75, 0.625, 0.5, 0.5, 0.375];
    close(&of_point(&nine), &all.map(|weight| weight / 5.75));
    assert!(noted(&nine));
}

#[test]
fn what_is_no_fbx_is_refused_with_its_place() {
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for bytes in [&b""[..], &b"glTF"[..], &obj[..], &[0; 4096]] {
        let error = read_any(read, "no.fbx", bytes).unwrap_err();
        assert_eq!((error.file.as_str(), error.expected.as_str()), ("no.fbx", "an FBX file"));
    }
}
