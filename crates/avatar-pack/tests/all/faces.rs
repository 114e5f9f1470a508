//! Faces of other people: which of the default poses they can take, by which shapes, and where they are on a
//! body.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test may panic and has a clock"
)]

use avatar_exchange::{Node, RawScene, Scene, ScenePart, Skin, Transform, Trs};
use avatar_mesh::{Bounds, Mesh, Shape, Skinning};
use avatar_pack::{FaceState, Import, Pack, ShapeSet, Textures, export};
use glam::{Affine3A, Vec2, Vec3};

/// A triangle above every one of these places, whose shapes each move the first one.
fn mesh(places: &[Vec3], shapes: &[&str]) -> Mesh {
    let positions: Vec<Vec3> =
        places.iter().flat_map(|place| [*place, *place + Vec3::X, *place + Vec3::Y]).collect();
    let count = positions.len();
    let moved = |name: &&str| Shape::from_pairs(*name, count, (0..3).map(|vertex| (vertex, Vec3::Z * 0.1)));
    Mesh {
        normals: vec![Vec3::Z; count],
        uvs: vec![Vec2::ZERO; count],
        triangles: (0..count as u32).step_by(3).map(|k| [k, k + 1, k + 2]).collect(),
        shapes: shapes.iter().map(moved).collect::<Result<_, _>>().expect("vertices of the mesh"),
        positions,
        ..Mesh::default()
    }
}

fn import(scene: RawScene) -> Import {
    Import::from_scene(Scene::from_raw(scene).expect("a scene")).expect("an avatar")
}

/// One part with shapes of these names.
pub(crate) fn face(shapes: &[&str]) -> Import {
    let nodes = vec![Node { weights: vec![0.0; shapes.len()], ..Node::default() }];
    let parts = vec![ScenePart::rigid("face", 0, mesh(&[Vec3::ZERO], shapes))];
    import(RawScene { nodes, parts, ..RawScene::default() })
}

pub(crate) fn values(pack: &Pack, pose: &str) -> Vec<(String, f32)> {
    let pose = pack.poses().get(pose).unwrap_or_else(|| panic!("a pose {pose}"));
    let name = |index: usize| pack.controls().controls()[index].name.clone();
    pose.values.iter().map(|(index, value)| (name(*index), *value)).collect()
}

fn value(pack: &Pack, pose: &str, control: &str) -> f32 {
    let values = values(pack, pose);
    values
        .iter()
        .find(|(name, _)| name == control)
        .unwrap_or_else(|| panic!("{control} of {pose}: {values:?}"))
        .1
}

#[test]
fn the_default_poses_are_there_for_shapes_of_arkit() {
    let pack = face(ShapeSet::ArKit.names()).pack;
    // The numbers of the default poses; where joints would do it, by the ranges of the controls: 13 of 20
    // degrees, 26 of 30, 45 of 45.
    for (pose, control, expected) in [
        ("smile", "mouthSmileLeft", 0.95),
        ("smile", "mouthSmileRight", 0.95),
        ("smile", "mouthFrownLeft", 0.0),
        ("laugh", "jawOpen", 0.75),
        ("surprise", "eyeWideLeft", 1.0),
        ("surprise", "eyeBlinkLeft", 0.0),
        ("surprise", "browInnerUp", 1.0),
        ("wink-left", "eyeBlinkLeft", 1.0),
        ("wink-left", "eyeSquintLeft", 0.5),
        // The lower lid by 4 of 25 degrees, where 2 of 45 close the upper one.
        ("wink-left", "eyeSquintRight", 4.0 / 25.0 * (43.0 / 45.0)),
        ("wink-left", "mouthSmileRight", 0.55),
        ("look-left", "eyeLookOutLeft", 26.0 / 30.0),
        ("look-left", "eyeLookInRight", 26.0 / 30.0),
        ("look-left", "eyeLookInLeft", 0.0),
        ("look-left", "eyeLookOutRight", 0.0),
        ("cross-eyed", "eyeLookInLeft", 26.0 / 30.0),
        ("cross-eyed", "eyeLookInRight", 26.0 / 30.0),
        ("look-up", "eyeLookUpRight", 21.0 / 25.0),
        ("anger", "browDownLeft", 1.0),
        ("disgust", "noseSneerRight", 1.0),
        ("blow", "cheekPuff", 1.0),
        ("tongue-out", "tongueOut", 1.0),
    ] {
        let found = value(&pack, pose, control);
        assert!((found - expected).abs() < 1e-6, "{pose}, {control}: expected {expected}, found {found}");
    }
    assert_eq!(pack.poses().by_key("1").map(|pose| pose.name.as_str()), Some("smile"));
    // All weights are weights.
    for pose in pack.poses() {
        assert!(pose.values.iter().all(|(_, value)| (0.0..=1.0).contains(value)), "{pose:?}");
    }
    // Timings are those of the controls that the shapes stand for.
    assert!(
        pack.poses()
            .iter()
            .flat_map(|pose| &pose.timings)
            .all(|(index, _)| *index < pack.controls().controls().len())
    );
}

#[test]
fn a_pose_is_not_offered_without_what_it_lives_by() {
    let names = |shapes: &[&str]| -> Vec<String> {
        face(shapes).pack.poses().iter().map(|pose| pose.name.clone()).collect()
    };
    // Half a smile is none, and nothing else here is in the default poses.
    assert_eq!(names(&["mouthSmileLeft", "cheekPuff"]), ["neutral", "mouthSmileLeft", "cheekPuff"]);
    let eyes = ["eyeLookOutLeft", "eyeLookInLeft", "eyeLookOutRight", "eyeLookInRight"];
    let found = names(&eyes);
    assert_eq!(
        found[..5],
        ["neutral", "cross-eyed", "look-left", "look-right", "eyeLookOutLeft"],
        "{found:?}"
    );
}

#[test]
fn neutral_puts_everything_to_rest() {
    let pack = face(&["jawOpen", "cheekPuff", "wings"]).pack;
    let names: Vec<&str> = pack.controls().controls().iter().map(|control| control.name.as_str()).collect();
    assert!(["jawOpen", "cheekPuff", "wings"].iter().all(|name| names.contains(name)), "{names:?}");
    assert_eq!(
        values(&pack, "neutral"),
        names.iter().map(|name| ((*name).to_owned(), 0.0)).collect::<Vec<_>>()
    );
}

#[test]
fn makehuman_smiles_by_pulling_the_corners_of_the_mouth() {
    let import = face(ShapeSet::MakeHuman.names());
    assert_eq!(import.report.shape_sets, [(ShapeSet::MakeHuman, 34)]);
    let pack = &import.pack;
    assert!(pack.controls().index("mouth-corner-puller").is_none());
    assert_eq!(value(pack, "smile", "smile"), 0.85);
    assert_eq!(value(pack, "wink-right", "eye-right-closure"), 1.0);
    assert_eq!(value(pack, "yawn", "mouth-open"), 1.0);
    assert!(pack.poses().get("look-left").is_none(), "its eyes are not moved by shapes");
}

#[test]
fn what_makehuman_fits_clothes_to_is_not_shown() {
    let groups = ["body", "helper-hair", "helper-l-eye", "joint-head", "helper-tights"];
    let parts = |groups: &[&str]| -> (Vec<String>, Vec<String>) {
        let parts = groups.iter().map(|name| ScenePart::rigid(name, 0, mesh(&[Vec3::ZERO], &[]))).collect();
        let import = import(RawScene { nodes: vec![Node::default()], parts, ..RawScene::default() });
        (import.pack.parts().iter().map(|part| part.name.clone()).collect(), import.report.notes)
    };
    let (shown, notes) = parts(&groups);
    assert_eq!(shown, ["body", "helper-l-eye"]);
    assert!(notes.iter().any(|note| note.starts_with("3 parts of MakeHuman's base mesh")), "{notes:?}");
    // Whatever has no body is something else.
    assert_eq!(parts(&groups[1..]).0, groups[1..]);
}

fn node(name: &str, parent: Option<usize>, translation: Vec3) -> Node {
    Node {
        name: name.to_owned(),
        parent,
        local: Transform::Trs(Trs { translation, ..Trs::default() }),
        weights: Vec::new(),
    }
}

#[test]
fn the_face_of_a_body_is_its_head() {
    // Feet at the hip's joint, a face at that of an eye, and a hat that is a part of its own.
    let mut body = mesh(&[Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, 17.0, 0.0)], &[]);
    body.skinning = Some(Skinning {
        bones: [[0, 0, 0, 0]; 3].into_iter().chain([[1, 0, 0, 0]; 3]).collect(),
        weights: [[1.0, 0.0, 0.0, 0.0]; 3].into_iter().chain([[0.7, 0.3, 0.0, 0.0]; 3]).collect(),
        ..Skinning::default()
    });
    let to = |y: f32| Affine3A::from_translation(Vec3::Y * -y);
    let scene = RawScene {
        nodes: vec![
            node("hip", None, Vec3::Y * 9.0),
            node("Head", Some(0), Vec3::Y * 7.0),
            node("LeftEye", Some(1), Vec3::Y),
            node("hat", Some(1), Vec3::Y * 4.0),
        ],
        skins: vec![Skin { name: String::new(), joints: vec![0, 2], inverse_binds: vec![to(9.0), to(17.0)] }],
        parts: vec![
            ScenePart::skinned("body", 0, body, 0),
            ScenePart::rigid("hat", 3, mesh(&[Vec3::ZERO], &[])),
        ],
        ..RawScene::default()
    };
    let expected = Bounds { min: Vec3::new(0.0, 17.0, 0.0), max: Vec3::new(1.0, 21.0, 0.0) };
    let finds_it = |scene: RawScene| {
        let pack = import(scene).pack;
        let face = pack.face().expect("a face");
        let near = face.min.abs_diff_eq(expected.min, 1e-5) && face.max.abs_diff_eq(expected.max, 1e-5);
        assert!(near, "{face:?}");
    };
    finds_it(scene.clone());
    // The same with most of the head's weight in further bones.
    let mut further = scene;
    let skinning = further.parts[0].mesh.skinning.as_mut().expect("a skinned body");
    skinning.more_bones = vec![[1, 1, 0, 0]; 6];
    skinning.more_weights = [[0.0; 4]; 3].into_iter().chain([[0.25, 0.3, 0.0, 0.0]; 3]).collect();
    for vertex in 3..6 {
        (skinning.bones[vertex], skinning.weights[vertex]) = ([0; 4], [0.15, 0.1, 0.1, 0.1]);
    }
    finds_it(further);
}

/// Two parts on skins of their own: the first of so many joints, the second of one, 5 above.
fn two_skins(joints_of_the_first: usize) -> Scene {
    let skinned = || {
        let skinning = Skinning {
            bones: vec![[0; 4]; 3],
            weights: vec![[1.0, 0.0, 0.0, 0.0]; 3],
            ..Skinning::default()
        };
        Mesh { skinning: Some(skinning), ..mesh(&[Vec3::ZERO], &[]) }
    };
    let skin = |joints: Vec<usize>| Skin {
        name: String::new(),
        inverse_binds: vec![Affine3A::IDENTITY; joints.len()],
        joints,
    };
    let scene = RawScene {
        nodes: vec![node("low", None, Vec3::ZERO), node("high", None, Vec3::Y * 5.0)],
        skins: vec![skin(vec![0; joints_of_the_first]), skin(vec![1])],
        parts: vec![ScenePart::skinned("low", 0, skinned(), 0), ScenePart::skinned("high", 0, skinned(), 1)],
        ..RawScene::default()
    };
    Scene::from_raw(scene).expect("a scene")
}

#[test]
fn bones_of_a_part_are_those_of_its_own_skin() {
    let pack = Import::from_scene(two_skins(3)).expect("an avatar").pack;
    let mut state = FaceState::new(&pack);
    state.pose(&pack, &pack.controls().defaults()).expect("a pose");
    assert_eq!(state.deform(&pack, 0).expect("it fits").positions[0], Vec3::ZERO);
    assert_eq!(state.deform(&pack, 1).expect("it fits").positions[0], Vec3::Y * 5.0);
    // Further bones, too: half of the weight is on the second bone of a vertex, which is the same one.
    let mut raw = RawScene::clone(&two_skins(3));
    let skinning = raw.parts[1].mesh.skinning.as_mut().expect("a skinned part");
    (skinning.more_bones, skinning.more_weights) = (vec![[0; 4]; 3], vec![[0.5, 0.0, 0.0, 0.0]; 3]);
    skinning.weights = vec![[0.5, 0.0, 0.0, 0.0]; 3];
    let pack = import(raw).pack;
    let mut state = FaceState::new(&pack);
    state.pose(&pack, &pack.controls().defaults()).expect("a pose");
    assert_eq!(state.deform(&pack, 1).expect("it fits").positions[0], Vec3::Y * 5.0);
    let error = Import::from_scene(two_skins(70_000)).expect_err("too many joints");
    assert_eq!(error.to_string(), "expected at most 65536 joints in all skins, found 70001");
}

#[test]
fn without_a_head_the_face_is_where_shapes_are() {
    let body = |height: f32| {
        let parts = vec![ScenePart::rigid("body", 0, mesh(&[Vec3::Y * height, Vec3::ZERO], &["jawOpen"]))];
        import(RawScene {
            nodes: vec![Node { weights: vec![0.0], ..Node::default() }],
            parts,
            ..RawScene::default()
        })
        .pack
    };
    // The moved triangle and a third of its height more, where there is something.
    let face = body(20.0).face().expect("a face");
    assert!((face.min.y - 19.65).abs() < 1e-5 && (face.max.y - 21.0).abs() < 1e-5, "{face:?}");
    assert_eq!(body(0.5).face(), None, "there is no more than the face");
    assert_eq!(self::face(&[]).pack.face(), None);
}

#[test]
fn parts_hold_their_own_shapes_only_and_follow_their_own_weights() {
    let (nodes, shapes) = (400, 50);
    let parts = (0..nodes).map(|node| {
        let names: Vec<String> = (0..shapes).map(|shape| format!("{node}: {shape}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        ScenePart::rigid(&format!("part {node}"), node, mesh(&[Vec3::X * node as f32], &names))
    });
    let node = Node { weights: vec![0.0; shapes], ..Node::default() };
    let pack =
        import(RawScene { nodes: vec![node; nodes], parts: parts.collect(), ..RawScene::default() }).pack;
    assert_eq!(pack.shapes().len(), nodes * shapes);
    for (index, part) in pack.parts().iter().enumerate() {
        assert_eq!(part.shapes(), index * shapes..(index + 1) * shapes);
        assert_eq!(part.mesh.shapes.len(), shapes, "no places for shapes of other parts");
    }
    let mut state = FaceState::new(&pack);
    let mut values = pack.controls().defaults();
    values[pack.controls().index("300: 20").expect("a control")] = 1.0;
    state.pose(&pack, &values).expect("a pose");
    for index in [0, 299, 300, 301, 399] {
        let moved = state.deform(&pack, index).expect("a part").positions[0].z;
        assert_eq!(moved, if index == 300 { 0.1 } else { 0.0 }, "part {index}");
    }
    // Written and read again, each part has its own shapes again.
    let scene = Scene::from_raw(export(&pack, &Textures::default())).expect("a scene");
    assert_eq!(Import::from_scene(scene).expect("an avatar").pack.shapes(), pack.shapes());
}

/// A second or two; where each shape looks at all others it takes minutes.
#[test]
fn time_grows_with_the_number_of_shapes() {
    let names: Vec<String> = (0..100_000).map(|number| format!("shape {number}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let start = std::time::Instant::now();
    let pack = face(&names).pack;
    let took = start.elapsed();
    assert!(pack.controls().controls().len() >= 100_000);
    assert!(took < std::time::Duration::from_secs(30), "{took:?}");
}

/// A byte for a seed: xorshift.
fn next(seed: &mut u64) -> u64 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    *seed
}

#[test]
fn damaged_files_are_avatars_or_errors() {
    let mut body = mesh(&[Vec3::ZERO, Vec3::Y * 17.0], &["jawOpen", "wings"]);
    body.skinning = Some(Skinning {
        bones: vec![[0, 1, 0, 0]; 6],
        weights: vec![[0.5, 0.5, 0.0, 0.0]; 6],
        ..Skinning::default()
    });
    let mut hip = node("hip", None, Vec3::Y * 9.0);
    hip.weights = vec![0.0, 0.5];
    let scene = RawScene {
        nodes: vec![hip, node("Head", Some(0), Vec3::Y), node("LeftEye", Some(1), Vec3::Z)],
        skins: vec![Skin {
            name: String::new(),
            joints: vec![0, 1],
            inverse_binds: vec![Affine3A::IDENTITY; 2],
        }],
        parts: vec![
            ScenePart::skinned("body", 0, body, 0),
            ScenePart::rigid("eye", 2, mesh(&[Vec3::ZERO], &[])),
        ],
        ..RawScene::default()
    };
    let bytes = avatar_exchange::glb::write(&Scene::from_raw(scene).expect("a scene")).expect("a file");
    let (mut seed, mut avatars, mut errors) = (0x9e37_79b9_7f4a_7c15, 0, 0);
    for round in 0..3000 {
        let mut damaged = bytes.clone();
        for _ in 0..=round % 4 {
            let (at, bit) = (next(&mut seed) as usize % damaged.len(), next(&mut seed) % 8);
            damaged[at] ^= 1 << bit;
        }
        let read = avatar_exchange::gltf::read("damaged.glb", &damaged, &mut |_| Err(String::new()));
        let Some(import) = read.ok().and_then(|scene| Import::from_scene(scene).ok()) else {
            errors += 1;
            continue;
        };
        avatars += 1;
        let pack = &import.pack;
        let mut state = FaceState::new(pack);
        for pose in pack.poses() {
            let mut values = pack.controls().defaults();
            pose.values.iter().for_each(|(control, value)| values[*control] = *value);
            if state.pose(pack, &values).is_ok() {
                // Numbers that are too large are told.
                (0..pack.parts().len()).for_each(|part| _ = state.deform(pack, part));
            }
        }
    }
    assert!(avatars > 300 && errors > 300, "{avatars} avatars, {errors} errors");
}
