//! In-between shapes of a scene: one control for a slider, weights of all its shapes.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use avatar_exchange::{
    Channel, ChannelTarget, Clip, Interpolation, Node, NodeDrivers, RawScene, Scene, ScenePart,
};
use avatar_mesh::drivers::{Input, Rule, ShapeRule};
use avatar_mesh::{Mesh, Shape};
use avatar_pack::{FaceState, Import, MotionAt, RawError, Textures, export, raw_files};
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

fn part(name: &str, node: usize, shapes: &[(&str, Vec3)]) -> ScenePart {
    let shape = |(name, offset): &(&str, Vec3)| Shape::new(*name, vec![*offset; 3]);
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        uvs: vec![Vec2::ZERO; 3],
        triangles: vec![[0, 1, 2]],
        shapes: shapes.iter().map(shape).collect(),
        ..Mesh::default()
    };
    ScenePart::rigid(name, node, mesh)
}

/// Lids that shut in two steps and rest at three quarters of their way; a shape of another node of the same
/// name as a slider, which rests at the same value; a corrective shape.
fn lids() -> RawScene {
    let node = |name: &str, weights: &[f32]| Node {
        name: name.to_owned(),
        weights: weights.into(),
        ..Node::default()
    };
    let follows = |shape: &str, full_weight| ShapeRule {
        shape: shape.to_owned(),
        rule: Rule::Follows { input: Input::Driver("shut".to_owned()), full_weight },
    };
    let both = ["shut", "smile"].map(|name| Input::Driver(name.to_owned()));
    RawScene {
        nodes: vec![node("brow", &[0.75]), node("lids", &[0.5, 0.5, 0.0, 0.0])],
        parts: vec![
            part("brow", 0, &[("shut", Vec3::X)]),
            part(
                "lids",
                1,
                &[("shut@50", Vec3::Z), ("shut", Vec3::Y), ("smile", Vec3::X), ("squint", -Vec3::X)],
            ),
        ],
        drivers: vec![NodeDrivers {
            node: 1,
            drivers: vec!["smile".to_owned(), "shut".to_owned()],
            rest: vec![0.0, 0.75],
            shapes: ["shut@50", "shut", "smile", "squint"].map(str::to_owned).into(),
            rules: vec![
                follows("shut@50", 0.5),
                follows("shut", 1.0),
                ShapeRule { shape: "squint".to_owned(), rule: Rule::Product(both.into()) },
            ],
        }],
        clips: vec![Clip {
            name: "half".to_owned(),
            channels: vec![Channel {
                node: 1,
                target: ChannelTarget::Weights,
                interpolation: Interpolation::Step,
                times: vec![0.0],
                values: vec![1.0, 0.0, 0.0, 0.0],
            }],
        }],
        ..RawScene::default()
    }
}

pub(crate) fn avatar() -> Import {
    Import::from_scene(Scene::from_raw(lids()).expect("a scene")).expect("an avatar")
}

fn weights(import: &Import, values: &[(&str, f32)]) -> Vec<f32> {
    let mut all = import.pack.controls().defaults();
    for (name, value) in values {
        all[import.pack.controls().index(name).unwrap_or_else(|| panic!("the control {name}"))] = *value;
    }
    let mut state = FaceState::new(&import.pack);
    state.pose(&import.pack, &all).expect("a pose");
    state.weights().to_vec()
}

#[test]
fn a_slider_is_one_control() {
    let import = avatar();
    let pack = &import.pack;
    assert_eq!(pack.shapes(), ["shut", "shut@50", "shut", "smile", "squint"]);
    let of_shapes: Vec<&str> = pack.controls().names().filter(|name| !name.contains('.')).collect();
    assert_eq!(of_shapes, ["shut", "smile"]);
    // At rest the file's weights, and the brow's shape with the slider of its name.
    assert_eq!(weights(&import, &[]), [0.75, 0.5, 0.5, 0.0, 0.0]);
    assert_eq!(weights(&import, &[("shut", 0.25)]), [0.25, 0.5, 0.0, 0.0, 0.0]);
    assert_eq!(weights(&import, &[("shut", 1.0), ("smile", 0.5)]), [1.0, 0.0, 1.0, 0.5, 0.5]);
    let control = pack.controls().index("shut").expect("a control");
    assert_eq!(pack.controls().controls()[control].default, 0.75);
    // Offsets by hand: 0.75 of the way is half of each shape.
    let mut state = FaceState::new(pack);
    state.pose(pack, &pack.controls().defaults()).expect("a pose");
    let lids = state.deform(pack, 1).expect("the lids");
    assert_eq!(lids.positions[0], Vec3::new(0.0, 0.5, 0.5));
    for (shape, follows) in [(0, true), (1, true), (2, true), (3, false), (4, true)] {
        assert_eq!(pack.follows(shape, "shut"), follows, "{shape}");
    }
}

#[test]
fn clips_set_the_shapes_themselves() {
    let import = avatar();
    let at = import.pack.motion().expect("clips").at("half", 0.0).expect("the clip");
    // All of the node that has a channel, and nothing of the other.
    assert_eq!(at.weights, [(1, 1.0), (2, 0.0), (3, 0.0), (4, 0.0)]);
}

/// A clip that takes a head from turned to rest and back, and a shape from 1 to rest; each also has a
/// control.
#[test]
fn what_a_clip_brings_to_rest_stays_its_own() {
    let key = |node, target, values: Vec<f32>| Channel {
        node,
        target,
        interpolation: Interpolation::Linear,
        times: vec![0.0, 1.0, 2.0],
        values,
    };
    let quarter = Quat::from_rotation_y(FRAC_PI_2).to_array();
    let turns = [quarter, Quat::IDENTITY.to_array(), quarter].concat();
    let scene = RawScene {
        nodes: vec![
            Node { name: "Head".to_owned(), weights: vec![0.0, 0.0], ..Node::default() },
            Node { name: "Jaw".to_owned(), parent: Some(0), ..Node::default() },
        ],
        parts: vec![part("face", 0, &[("smile", Vec3::X), ("frown", Vec3::Y)]), part("teeth", 1, &[])],
        clips: vec![Clip {
            name: "shake".to_owned(),
            channels: vec![
                key(0, ChannelTarget::Rotation, turns),
                key(0, ChannelTarget::Weights, vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
            ],
        }],
        ..RawScene::default()
    };
    let import = Import::from_scene(Scene::from_raw(scene).expect("a scene")).expect("an avatar");
    let pack = &import.pack;
    let motion = pack.motion().expect("clips");
    let mut sampler = motion.sampler(0).expect("the clip");
    // Every control is off its default while the clip plays.
    let mut values = pack.controls().defaults();
    for (value, control) in values.iter_mut().zip(pack.controls().controls()) {
        *value = control.max;
    }
    let mut state = FaceState::new(pack);
    let head = pack.rig().joint("Head").expect("a head").index();
    let mut turned_at = |time_secs| {
        let clip = motion.sample(&mut sampler, time_secs).clone();
        state.pose_toward(pack, &values, &clip, 1.0).expect("a pose");
        let nose = state.rig_pose().world_from_joint()[head].transform_vector3(Vec3::Z);
        (nose.x.atan2(nose.z).to_degrees(), state.weights().to_vec())
    };
    for (time_secs, degrees, smile) in [(0.0, 90.0, 1.0), (0.5, 45.0, 0.5), (1.0, 0.0, 0.0), (1.5, 45.0, 0.5)]
    {
        let (turned, weights) = turned_at(time_secs);
        assert!((turned - degrees).abs() < 1e-3, "{turned} of {degrees} degrees at {time_secs} s");
        assert!((weights[0] - smile).abs() < 1e-6 && weights[1] == 0.0, "{weights:?} at {time_secs} s");
    }
    // The jaw has no channel: its control keeps it.
    let jaw = pack.rig().joint("Jaw").expect("a jaw");
    assert!(motion.at("shake", 1.0).expect("the clip").locals.iter().all(|(joint, _)| *joint != jaw));
}

#[test]
fn a_clip_is_approached_from_the_face_of_the_controls() {
    let import = avatar();
    let pack = &import.pack;
    let motion = pack.motion().expect("clips");
    let mut sampler = motion.sampler(0).expect("the clip");
    assert!(motion.sampler(1).is_err());
    let clip = motion.sample(&mut sampler, 0.0).clone();
    assert_eq!(clip, motion.at("half", 0.0).expect("the clip"));
    let values = pack.controls().defaults();
    let mut state = FaceState::new(pack);
    // The clip sets the second shape to 1 and the third to 0; both rest at 0.5.
    for (share, expected) in [
        (0.0, [0.75, 0.5, 0.5, 0.0, 0.0]),
        (0.25, [0.75, 0.625, 0.375, 0.0, 0.0]),
        (1.0, [0.75, 1.0, 0.0, 0.0, 0.0]),
        (f32::NAN, [0.75, 0.5, 0.5, 0.0, 0.0]),
    ] {
        state.pose_toward(pack, &values, &clip, share).expect("a pose");
        assert_eq!(state.weights(), expected, "{share}");
    }
    // Half the way of a quarter turn is an eighth, and half of a shift is half of it.
    let joint = pack.rig().joint("brow").expect("a joint");
    let turned = Affine3A::from_rotation_translation(Quat::from_rotation_y(FRAC_PI_2), Vec3::X);
    let turn = MotionAt { locals: vec![(joint, turned)], weights: Vec::new() };
    state.pose_toward(pack, &values, &turn, 0.5).expect("a pose");
    let between = Affine3A::from_rotation_translation(Quat::from_rotation_y(FRAC_PI_4), Vec3::X * 0.5);
    let mut expected = FaceState::new(pack);
    expected.pose_with(pack, &values, |_| {}, &[(joint, between)]).expect("a pose");
    for (found, expected) in state.bones().iter().zip(expected.bones()) {
        assert!(found.abs_diff_eq(*expected, 1e-6), "{found:?} {expected:?}");
    }
    // Nothing of it stays.
    let mut rest = FaceState::new(pack);
    rest.pose(pack, &values).expect("a pose");
    state.pose(pack, &values).expect("a pose");
    assert_eq!(state.bones(), rest.bones());
}

#[test]
fn files_without_sliders_keep_the_shapes_or_refuse_them() {
    let import = avatar();
    let scene = export(&import.pack, &Textures::default());
    let lids = scene.nodes.iter().find(|node| node.name == "lids").expect("a node");
    assert!(lids.weights.is_empty(), "a joint");
    let rest: Vec<_> =
        scene.nodes.iter().map(|node| node.weights.as_slice()).filter(|w| !w.is_empty()).collect();
    assert_eq!(rest, [&[0.75][..], &[0.5, 0.5, 0.0, 0.0]]);
    assert!(
        scene.notes.iter().any(|note| note.finding.to_string().contains("sliders are left out")),
        "{:?}",
        scene.notes
    );
    let refused = raw_files(&import.pack, &import.textures).expect_err("in-betweens");
    assert_eq!(refused, RawError::InBetween { sliders: ["shut", "smile", "shut"].map(str::to_owned).into() });
}

/// With places for the shapes of other nodes it would take 12 GiB.
#[test]
fn shapes_at_very_many_nodes_take_memory_of_their_own_only() {
    let names: Vec<String> = (0..60).map(|k| format!("shape {k}")).collect();
    let offsets: Vec<_> = names.iter().map(|name| (name.as_str(), Vec3::X)).collect();
    let nodes = 2_000;
    let node =
        |number: usize| Node { name: format!("face {number}"), weights: vec![0.0; 60], ..Node::default() };
    let raw = RawScene {
        nodes: (0..nodes).map(node).collect(),
        parts: (0..nodes).map(|node| part("face", node, &offsets)).collect(),
        ..RawScene::default()
    };
    let pack = Import::from_scene(Scene::from_raw(raw).expect("a scene")).expect("an avatar").pack;
    assert_eq!(pack.shapes().len(), 60 * nodes);
    assert!(pack.parts().iter().all(|part| part.mesh.shapes.len() == 60));
}
