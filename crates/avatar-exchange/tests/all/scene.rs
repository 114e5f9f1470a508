//! Scenes made by hand: what is checked, the palette, poses.

use avatar_exchange::{
    Channel, ChannelTarget, Clip, ImportError, Interpolation, Material, Node, RawScene, Scene, ScenePart,
    ScenePose, Skin, Transform, Trs,
};
use avatar_mesh::{Mesh, Skinning};
use glam::{Affine3A, Quat, Vec2, Vec3, Vec4};

fn dot(skinning: Option<Skinning>) -> Mesh {
    Mesh {
        positions: vec![Vec3::X],
        uvs: vec![Vec2::ZERO],
        normals: vec![Vec3::Y],
        triangles: vec![[0; 3]],
        skinning,
        ..Mesh::default()
    }
}

fn bones(bones: [u16; 4]) -> Option<Skinning> {
    Some(Skinning { bones: vec![bones], weights: vec![[0.5, 0.5, 0.0, 0.0]], ..Skinning::default() })
}

fn node(parent: Option<usize>, translation: Vec3) -> Node {
    let local = Transform::Trs(Trs { translation, ..Trs::default() });
    Node { name: "n".to_owned(), parent, local, weights: Vec::new() }
}

/// Two skins over two joints, two rigid parts at one node, a clip.
fn sample() -> RawScene {
    let joints = vec![1, 2];
    let inverse_binds = vec![Affine3A::from_translation(-Vec3::X), Affine3A::IDENTITY];
    let skin = Skin { name: "s".to_owned(), joints, inverse_binds };
    RawScene {
        nodes: vec![node(Some(1), Vec3::Z), node(None, Vec3::X), node(Some(0), Vec3::Y)],
        parts: vec![
            ScenePart::rigid("a", 2, dot(None)),
            ScenePart::skinned("b", 0, dot(bones([0, 1, 0, 0])), 1),
            ScenePart::rigid("c", 2, dot(None)),
        ],
        skins: vec![skin.clone(), skin],
        clips: vec![Clip {
            name: "c".to_owned(),
            channels: vec![Channel {
                node: 1,
                target: ChannelTarget::Translation,
                interpolation: Interpolation::Linear,
                times: vec![0.0, 1.0],
                values: vec![0.0, 0.0, 0.0, 4.0, 0.0, 0.0],
            }],
        }],
        materials: vec![Material::default()],
        ..RawScene::default()
    }
}

#[test]
fn the_palette_has_joints_first_and_each_rigid_node_once() {
    let scene = Scene::from_raw(sample()).expect("a scene");
    assert_eq!(scene.palette().skins, [0, 2]);
    assert_eq!(scene.palette().rigid, [None, None, Some(4)]);
    let nodes: Vec<_> = scene.palette().entries.iter().map(|entry| entry.node).collect();
    assert_eq!(nodes, [1, 2, 1, 2, 2]);
    assert_eq!(scene.order(), [1, 0, 2]);
    assert_eq!(scene.parts[1].mesh.skinning.as_ref().expect("bones").bones, [[0, 1, 0, 0]]);
}

#[test]
fn poses_move_rigid_and_skinned_parts() {
    let scene = Scene::from_raw(sample()).expect("a scene");
    let mut pose = scene.rest();
    scene.apply(0, 0.5, &mut pose).expect("the scene's pose");
    let bones = scene.bones(&pose);
    let posed = |part: usize| {
        let mesh = &scene.parts[part].mesh;
        let mut out = mesh.deformed();
        avatar_mesh::deform(mesh, scene.bones_of(part, &bones), scene.weights_of(part, &pose), &mut out)
            .expect("it fits");
        out.positions[0]
    };
    // The root is at 2 x, the end at 2 x + z + y; the vertex at x.
    assert_eq!(posed(0), Vec3::new(3.0, 1.0, 1.0));
    assert_eq!(posed(1), (Vec3::new(2.0, 0.0, 0.0) + Vec3::new(3.0, 1.0, 1.0)) / 2.0);
    assert!(scene.bones_of(3, &bones).is_empty() && scene.bones_of(0, &[]).is_empty());
    assert!(scene.weights_of(3, &pose).is_empty());
    assert!(scene.apply(0, 0.5, &mut ScenePose::default()).is_err());
    pose.weights[1].push(0.0);
    assert!(scene.apply(0, 0.5, &mut pose).is_err());
}

type Change = fn(&mut RawScene);

#[test]
fn whatever_is_wrong_has_its_place() {
    let wrong = |change: Change| -> ImportError {
        let mut raw = sample();
        change(&mut raw);
        Scene::from_raw(raw).expect_err("an error")
    };
    let cases: [(&str, Change); 17] = [
        ("node 0 'n'", |raw| raw.nodes[0].parent = Some(3)),
        ("node 0 'n'", |raw| raw.nodes[1].parent = Some(2)),
        ("node 1 'n'", |raw| raw.nodes[1] = node(None, Vec3::NAN)),
        ("skin 1 's'", |raw| raw.skins[1].joints[0] = 3),
        ("skin 0 's'", |raw| raw.skins[0] = Skin { name: "s".to_owned(), ..Skin::default() }),
        ("skin 0 's'", |raw| raw.skins[0].inverse_binds.truncate(1)),
        ("skin 0 's', joint 1", |raw| raw.skins[0].inverse_binds[1].translation.x = f32::NAN),
        ("part 0 'a'", |raw| raw.parts[0].node = 3),
        ("part 0 'a'", |raw| raw.parts[0].material = Some(1)),
        ("part 0 'a'", |raw| raw.parts[0].skin = Some(0)),
        ("part 0 'a'", |raw| raw.parts[0].mesh.tangents = vec![Vec4::X; 2]),
        ("part 0 'a'", |raw| raw.parts[0].mesh.triangles[0][2] = 1),
        ("part 1 'b'", |raw| raw.parts[1].skin = None),
        ("part 1 'b'", |raw| raw.parts[1].mesh.skinning = bones([2, 0, 0, 0])),
        ("part 0 'a'", |raw| raw.nodes[2].weights.push(0.0)),
        ("animation 'c', channel 0", |raw| raw.clips[0].channels[0].node = 3),
        ("material 0 ''", |raw| raw.materials[0].normal_texture = Some(0.into())),
    ];
    for (number, (place, change)) in cases.into_iter().enumerate() {
        let error = wrong(change);
        assert_eq!(error.place, place, "case {number}: {error}");
        assert_eq!(error.clone().in_file("x.y").to_string(), format!("x.y: {error}"));
    }
}

#[test]
fn a_part_gets_the_joints_of_its_own_skin_however_many_others_have() {
    let mut raw = sample();
    raw.skins[0].joints = vec![1; 70_000];
    raw.skins[0].inverse_binds = vec![Affine3A::IDENTITY; 70_000];
    let (scene, few) = (Scene::from_raw(raw).expect("a scene"), Scene::from_raw(sample()).expect("a scene"));
    let (bones, bones_of_few) = (scene.bones(&scene.rest()), few.bones(&few.rest()));
    assert_eq!(bones.len(), 70_003);
    assert_eq!(scene.bones_of(1, &bones), few.bones_of(1, &bones_of_few));
}

#[test]
fn a_graph_has_the_poses_of_its_scene() {
    let scene = Scene::from_raw(sample()).expect("a scene");
    let graph = scene.clone().into_graph();
    assert_eq!((graph.nodes(), graph.clips()), (&scene.nodes[..], &scene.clips[..]));
    assert_eq!(graph.rest(), scene.rest());
    let pose = scene.at(0, 0.5).expect("a clip");
    assert_eq!(graph.at(0, 0.5).expect("a clip"), pose);
    assert_eq!((graph.worlds(&pose), graph.bones(&pose)), (scene.worlds(&pose), scene.bones(&pose)));
    assert!(graph.at(1, 0.0).is_err());
}

#[test]
fn transforms_come_back_from_their_matrices() {
    let rotation = Quat::from_euler(glam::EulerRot::YXZ, 0.4, -1.1, 2.0);
    for scale in [Vec3::ONE, Vec3::new(100.0, 100.0, 100.0), Vec3::new(0.01, 3.0, -2.0)] {
        let trs = Transform::Trs(Trs { translation: Vec3::new(1.0, -2.0, 3e4), rotation, scale });
        let again = Transform::from_matrix(trs.affine().into());
        assert!(matches!(again, Transform::Trs(_)), "{again:?}");
        let size = f64::from(scale.abs().max_element());
        assert!(again.affine().matrix3.abs_diff_eq(trs.affine().matrix3, 1e-6 * size), "{again:?}");
        assert_eq!(again.affine().translation, trs.affine().translation);
    }
}

/// A file decides how long its names are, and errors repeat them.
#[test]
fn errors_are_short_and_never_empty() {
    let long = "ä".repeat(100_000);
    let error = ImportError::new(long.clone(), long.clone(), long);
    let lengths = [error.place, error.expected, error.found].map(|text| text.chars().count());
    assert_eq!(lengths, [1001; 3]);
    assert_eq!(ImportError::new("here", "a name", "").found, "an empty text");
}

/// A clip that could not be written: glTF's times have 32 bits.
#[test]
fn times_fit_into_32_bits() {
    let mut raw = sample();
    let last = raw.clips[0].channels[0].times.len() - 1;
    raw.clips[0].channels[0].times.fill(f64::from(f32::MAX));
    assert!(Scene::from_raw(raw.clone()).is_ok());
    raw.clips[0].channels[0].times[last] = 1e39;
    let error = Scene::from_raw(raw).expect_err("an endless clip");
    assert_eq!(error.expected, format!("a finite time of key {last}"));
}
