//! Shapes of one name at several nodes: one control where these agree, controls of their own where they rest
//! or move otherwise.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use avatar_exchange::{
    Channel, ChannelTarget, Clip, Interpolation, Node, NodeDrivers, RawScene, Scene, ScenePart, Skin,
    Transform, Trs,
};
use avatar_mesh::drivers::{Input, Rule, ShapeRule};
use avatar_mesh::{Mesh, Shape, Skinning};
use avatar_pack::{FaceState, Import, Pack, ShapeSet, Textures, export};
use glam::{Affine3A, Vec2, Vec3};

/// A square whose shapes move all of it: the first by 1 along z, the second by 3 along y.
fn square(shapes: &[&str]) -> Mesh {
    let offsets = [Vec3::Z, Vec3::Y * 3.0];
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y],
        normals: vec![Vec3::Z; 4],
        uvs: vec![Vec2::ZERO; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        shapes: shapes.iter().zip(offsets).map(|(name, offset)| Shape::new(*name, vec![offset; 4])).collect(),
        ..Mesh::default()
    }
}

fn node(name: &str, weights: &[f32]) -> Node {
    Node { name: name.to_owned(), weights: weights.to_vec(), ..Node::default() }
}

fn import(scene: RawScene) -> Import {
    Import::from_scene(Scene::from_raw(scene).expect("a scene")).expect("an avatar")
}

/// Parts of these names of nodes, weights at rest and names of shapes.
fn parts(of: &[(&str, &[f32], &[&str])]) -> RawScene {
    RawScene {
        nodes: of.iter().map(|(name, weights, _)| node(name, weights)).collect(),
        parts: (of.iter().enumerate())
            .map(|(number, (name, _, shapes))| ScenePart::rigid(name, number, square(shapes)))
            .collect(),
        ..RawScene::default()
    }
}

/// Controls of shapes with their values at rest.
fn controls(pack: &Pack) -> Vec<(&str, f32)> {
    let controls = pack.controls().controls().iter();
    let of_shapes = controls.filter(|control| matches!(control.drives, pose_anim::Drive::Shape { .. }));
    of_shapes.map(|control| (control.name.as_str(), control.default)).collect()
}

/// The first vertex of each part.
fn corners(pack: &Pack, values: &[f32]) -> Vec<Vec3> {
    let mut state = FaceState::new(pack);
    state.pose(pack, values).expect("a pose");
    (0..pack.parts().len()).map(|part| state.deform(pack, part).expect("a part").positions[0]).collect()
}

fn with(pack: &Pack, set: &[(&str, f32)]) -> Vec<f32> {
    let mut values = pack.controls().defaults();
    for (name, value) in set {
        values[pack.controls().index(name).unwrap_or_else(|| panic!("a control {name}"))] = *value;
    }
    values
}

/// glTF 2.0: the weights of a node are those of its own, whatever mesh it shares.
#[test]
fn nodes_that_share_a_mesh_keep_their_own_weights() {
    let mut scene = parts(&[("a", &[0.0, 1.0], &["up", "y"]), ("b", &[0.5, 0.5], &["up", "y"])]);
    scene.nodes[1].local = Transform::Trs(Trs { translation: Vec3::X * 5.0, ..Trs::default() });
    let bytes = avatar_exchange::glb::write(&Scene::from_raw(scene).expect("a scene")).expect("a file");
    let scene =
        avatar_exchange::gltf::read("shared.glb", &bytes, &mut |_| Err(String::new())).expect("a scene");
    let import = Import::from_scene(scene).expect("an avatar");
    let pack = &import.pack;
    let apart = [("a.up", 0.0), ("a.y", 1.0), ("b.up", 0.5), ("b.y", 0.5)];
    assert_eq!(controls(pack), apart);
    assert_eq!(import.report.apart, ["a.up", "b.up", "a.y", "b.y"]);
    let rest = [Vec3::new(0.0, 3.0, 0.0), Vec3::new(5.0, 1.5, 0.5)];
    assert_eq!(corners(pack, &pack.controls().defaults()), rest);
    // Each has its own sliders, and `neutral` brings back each node's own rest.
    let moved = with(pack, &[("a.up", 1.0), ("b.y", 0.0)]);
    assert_eq!(corners(pack, &moved), [Vec3::new(0.0, 3.0, 1.0), Vec3::new(5.0, 0.0, 0.5)]);
    let mut values = moved;
    let neutral = pack.poses().get("neutral").expect("a pose");
    neutral.values.iter().for_each(|(control, value)| values[*control] = *value);
    assert_eq!(corners(pack, &values), rest);
    // The avatar as a file, and back.
    let again = Scene::from_raw(export(pack, &Textures::default())).expect("a scene");
    let again = Import::from_scene(again).expect("an avatar").pack;
    assert_eq!(corners(&again, &again.controls().defaults()), rest);
}

#[test]
fn a_mesh_with_two_skins_keeps_the_weights_of_both_nodes() {
    let skinned = || {
        let skinning = Skinning {
            bones: vec![[0; 4]; 4],
            weights: vec![[1.0, 0.0, 0.0, 0.0]; 4],
            ..Skinning::default()
        };
        Mesh { skinning: Some(skinning), ..square(&["up", "y"]) }
    };
    let skin =
        |joint| Skin { name: String::new(), joints: vec![joint], inverse_binds: vec![Affine3A::IDENTITY] };
    let pack = import(RawScene {
        nodes: vec![node("a", &[0.0, 1.0]), node("b", &[0.5, 1.0]), node("low", &[]), node("high", &[])],
        skins: vec![skin(2), skin(3)],
        parts: vec![ScenePart::skinned("a", 0, skinned(), 0), ScenePart::skinned("b", 1, skinned(), 1)],
        ..RawScene::default()
    })
    .pack;
    // They differ in one of the shapes.
    assert_eq!(controls(&pack), [("a.up", 0.0), ("y", 1.0), ("b.up", 0.5)]);
    assert_eq!(corners(&pack, &pack.controls().defaults()), [Vec3::Y * 3.0, Vec3::new(0.0, 3.0, 0.5)]);
    assert_eq!(corners(&pack, &with(&pack, &[("y", 0.0)])), [Vec3::ZERO, Vec3::Z * 0.5]);
}

#[test]
fn parts_of_one_face_share_a_control_by_whatever_name() {
    let scene = parts(&[
        ("head", &[0.25], &["head.jawOpen"]),
        ("teeth", &[0.25], &["blendShape2.jawOpen"]),
        ("brows", &[0.25], &["jaw_open"]),
    ]);
    let import = import(scene);
    let pack = &import.pack;
    assert_eq!(controls(pack), [("jawOpen", 0.25)]);
    assert_eq!(import.report.shape_sets, [(ShapeSet::ArKit, 1)]);
    assert_eq!(corners(pack, &with(pack, &[("jawOpen", 1.0)])), [Vec3::Z; 3]);
    // One spelling stays as the file has it, and so do names that nobody knows.
    let scene = parts(&[("head", &[0.0], &["head.jawOpen"]), ("teeth", &[0.0], &["Teeth.Wobble"])]);
    assert_eq!(controls(&self::import(scene).pack), [("head.jawOpen", 0.0), ("Teeth.Wobble", 0.0)]);
}

/// The name alone is that of most of them, so that it still means the face.
#[test]
fn one_of_several_that_differs_gets_a_control_of_its_own() {
    let mut scene = parts(&[
        ("head", &[0.0], &["jawOpen"]),
        ("teeth", &[0.0], &["jawOpen"]),
        ("tongue", &[0.5], &["jawOpen"]),
    ]);
    scene.nodes.push(node("tongue.jawOpen", &[]));
    let import = import(scene);
    let pack = &import.pack;
    assert_eq!(controls(pack), [("jawOpen", 0.0), ("tongue.jawOpen", 0.5)]);
    assert_eq!(import.report.apart, ["tongue.jawOpen"]);
    assert_eq!(import.report.shape_sets, [(ShapeSet::ArKit, 1)], "one shape, though of two controls");
}

/// A pose takes all of them along.
#[test]
fn poses_move_all_controls_of_a_shape() {
    let smile = ["mouthSmileLeft", "mouthSmileRight"];
    let pack = import(parts(&[("a", &[0.0, 0.0], &smile), ("b", &[0.25, 0.25], &smile)])).pack;
    let pose = pack.poses().get("smile").expect("a smile");
    let mut values = pack.controls().defaults();
    pose.values.iter().for_each(|(control, value)| values[*control] = *value);
    assert_eq!(corners(&pack, &values), [Vec3::new(0.0, 0.85 * 3.0, 0.85); 2]);
}

/// A clip that moves one of two nodes.
fn moving(node: usize, values: Vec<f32>) -> Clip {
    let channel = Channel {
        node,
        target: ChannelTarget::Weights,
        interpolation: Interpolation::Linear,
        times: vec![0.0, 1.0],
        values,
    };
    Clip { name: "move".to_owned(), channels: vec![channel] }
}

#[test]
fn a_mesh_that_a_clip_moves_at_one_node_has_controls_for_each() {
    let shapes = ["up", "y"];
    let mut scene = parts(&[("a", &[0.0, 0.0], &shapes), ("b", &[0.0, 0.0], &shapes)]);
    assert_eq!(controls(&import(scene.clone()).pack), [("up", 0.0), ("y", 0.0)]);
    scene.clips = vec![moving(0, vec![0.0, 0.0, 1.0, 0.0])];
    let pack = import(scene.clone()).pack;
    // Of the channel's two shapes both are moved, if one only to rest, and both at one node.
    assert_eq!(controls(&pack), [("a.up", 0.0), ("a.y", 0.0), ("b.up", 0.0), ("b.y", 0.0)]);
    // Both alike: one control. The second shape otherwise: that one apart.
    let also = Channel { node: 1, ..scene.clips[0].channels[0].clone() };
    scene.clips[0].channels.push(also);
    assert_eq!(controls(&import(scene.clone()).pack), [("up", 0.0), ("y", 0.0)]);
    scene.clips[0].channels[1].values[3] = 0.5;
    assert_eq!(controls(&import(scene).pack), [("up", 0.0), ("a.y", 0.0), ("b.y", 0.0)]);
    // Head and teeth are other meshes: a clip that moves the head only leaves them one control.
    let mut face = parts(&[("head", &[0.0, 0.0], &shapes), ("teeth", &[0.0, 0.0], &shapes)]);
    face.parts[1].mesh.positions[0] = Vec3::NEG_X;
    face.clips = vec![moving(0, vec![0.0, 0.0, 1.0, 0.0])];
    assert_eq!(controls(&import(face).pack), [("up", 0.0), ("y", 0.0)]);
}

#[test]
fn sliders_of_several_shapes_are_told_apart_as_well() {
    let drivers = |node: usize, rest: f32| NodeDrivers {
        node,
        drivers: vec!["shut".to_owned()],
        rest: vec![rest],
        shapes: ["shut@50", "shut"].map(str::to_owned).into(),
        rules: vec![
            ShapeRule {
                shape: "shut@50".to_owned(),
                rule: Rule::Follows { input: Input::Driver("shut".to_owned()), full_weight: 0.5 },
            },
            ShapeRule {
                shape: "shut".to_owned(),
                rule: Rule::Follows { input: Input::Driver("shut".to_owned()), full_weight: 1.0 },
            },
        ],
    };
    let shapes = ["shut@50", "shut"];
    // By hand: at half of the way the first shape is there in full, at three quarters half of each.
    let mut scene = parts(&[("a", &[1.0, 0.0], &shapes), ("b", &[0.5, 0.5], &shapes)]);
    scene.drivers = vec![drivers(0, 0.5), drivers(1, 0.75)];
    let pack = import(scene).pack;
    assert_eq!(controls(&pack), [("a.shut", 0.5), ("b.shut", 0.75)]);
    assert_eq!(pack.shapes(), ["shut@50", "shut", "shut@50", "shut"]);
    let rest = [Vec3::Z, Vec3::new(0.0, 1.5, 0.5)];
    assert_eq!(corners(&pack, &pack.controls().defaults()), rest);
    assert!(pack.follows(0, "a.shut") && !pack.follows(0, "b.shut") && pack.follows(2, "b.shut"));
}

#[test]
fn two_shapes_of_a_node_that_mean_the_same_are_told_apart_with_a_note() {
    let import = import(parts(&[("head", &[0.0, 0.0], &["jawOpen.001", "jawOpen"])]));
    assert_eq!(controls(&import.pack), [("jawOpen.001", 0.0), ("jawOpen", 0.0)]);
    assert_eq!(import.report.shape_sets, [(ShapeSet::ArKit, 1)]);
    assert_eq!(import.report.other_shapes, ["jawOpen.001"]);
    let note = "node \"head\": the shapes \"jawOpen\" and \"jawOpen.001\" both mean \"jawOpen\" of ARKit: the first \
                does, the other is by its own name";
    assert_eq!(import.report.notes, [note]);
}

/// Where each of many nodes rests otherwise, and where names are told apart by numbers.
#[test]
fn time_grows_with_the_number_of_nodes() {
    let nodes = 3_000;
    let weights: Vec<[f32; 2]> = (0..nodes).map(|number| [number as f32 / nodes as f32, 0.0]).collect();
    let of: Vec<(&str, &[f32], &[&str])> =
        weights.iter().map(|weights| ("same", &weights[..], &["up", "y"][..])).collect();
    let pack = import(parts(&of)).pack;
    let found = controls(&pack);
    assert_eq!(found.len(), nodes + 1);
    assert_eq!(found[..3], [("same.up", 0.0), ("y", 0.0), ("same.2.up", 1.0 / nodes as f32)]);
}
