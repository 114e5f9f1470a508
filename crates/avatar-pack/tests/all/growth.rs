//! Work grows with the size of a file, not with its square: each test does 16 times as much, which takes
//! 16 times as long, or some 256 times where everything is compared with everything.
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_exchange::{
    Channel, ChannelTarget, Clip, Interpolation, Node, NodeDrivers, RawScene, Scene, ScenePart,
};
use avatar_mesh::drivers::{Input, Rule, ShapeRule};
use avatar_mesh::{Mesh, Shape};
use avatar_pack::{Import, Pack, Textures, export};
use cpu_time::ThreadTime;
use glam::{Vec2, Vec3};
use std::time::Duration;

/// How much longer the large one takes than the small one, each in the best of some runs, by the time in
/// which the processor works for this thread: other programs have time of their own, and only disturb the
/// caches.
fn growth<T, R>(mut small: impl FnMut() -> T, mut large: impl FnMut() -> T, run: impl Fn(T) -> R) -> f64 {
    let time = |what: T| {
        let start = ThreadTime::now();
        let result = run(what);
        let took = start.elapsed();
        drop(result);
        took
    };
    let mut best = [Duration::MAX; 2];
    for _ in 0..5 {
        best[0] = best[0].min(time(small()));
        best[1] = best[1].min(time(large()));
    }
    best[1].as_secs_f64() / best[0].as_secs_f64().max(1e-9)
}

#[track_caller]
fn assert_linear(growth: f64) {
    assert!(growth < 64.0, "16 times as much takes {growth:.1} times as long");
}

fn mesh(shapes: impl IntoIterator<Item = String>) -> Mesh {
    let shape = |name: String| Shape::from_pairs(name, 3, [(0, Vec3::Z)]).expect("a vertex of the mesh");
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        uvs: vec![Vec2::ZERO; 3],
        triangles: vec![[0, 1, 2]],
        shapes: shapes.into_iter().map(shape).collect(),
        ..Mesh::default()
    }
}

fn import(scene: Scene) -> Pack {
    Import::from_scene(scene).expect("an avatar").pack
}

/// Nodes with a part and a shape each, some of them with rules.
fn nodes(count: usize, with_rules: bool) -> Scene {
    let node = |number: usize| Node { name: format!("n{number}"), weights: vec![0.0], ..Node::default() };
    let part = |number: usize| ScenePart::rigid(&format!("p{number}"), number, mesh([format!("s{number}")]));
    let rules = |node: usize| NodeDrivers {
        node,
        drivers: vec![format!("s{node}")],
        rest: vec![0.0],
        shapes: vec![format!("s{node}")],
        rules: Vec::new(),
    };
    Scene::from_raw(RawScene {
        nodes: (0..count).map(node).collect(),
        parts: (0..count).map(part).collect(),
        drivers: if with_rules { (0..count).map(rules).collect() } else { Vec::new() },
        ..RawScene::default()
    })
    .expect("a scene")
}

/// One node with many shapes, each with a rule and a slider of its own.
fn rules(count: usize) -> Scene {
    let shape = |number: usize| format!("s{number}");
    let rule = |number: usize| ShapeRule {
        shape: shape(number),
        rule: Rule::Follows { input: Input::Driver(format!("d{number}")), full_weight: 0.5 },
    };
    Scene::from_raw(RawScene {
        nodes: vec![Node { name: "face".to_owned(), weights: vec![0.0; count], ..Node::default() }],
        parts: vec![ScenePart::rigid("face", 0, mesh((0..count).map(shape)))],
        drivers: vec![NodeDrivers {
            node: 0,
            drivers: (0..count).map(|number| format!("d{number}")).collect(),
            rest: vec![0.0; count],
            shapes: (0..count).map(shape).collect(),
            rules: (0..count).map(rule).collect(),
        }],
        ..RawScene::default()
    })
    .expect("a scene")
}

#[test]
fn of_nodes_and_parts() {
    let (small, large) = (nodes(500, false), nodes(8_000, false));
    assert_linear(growth(|| small.clone(), || large.clone(), import));
}

#[test]
fn of_nodes_with_rules() {
    let (small, large) = (nodes(500, true), nodes(8_000, true));
    assert_linear(growth(|| small.clone(), || large.clone(), import));
}

#[test]
fn of_shapes_with_rules() {
    let (small, large) = (rules(1_000), rules(16_000));
    assert_linear(growth(|| small.clone(), || large.clone(), import));
}

/// Nodes with meshes that differ in their last vertex only, all moved by a clip.
fn nearly_equal(count: usize) -> Scene {
    const VERTICES: usize = 300;
    let shape = || Shape::from_pairs("s", VERTICES, [(0, Vec3::Z)]).expect("a vertex of the mesh");
    let mesh = |number: usize| {
        let mut positions = vec![Vec3::X; VERTICES];
        positions[VERTICES - 1].y = number as f32;
        Mesh {
            positions,
            normals: vec![Vec3::Z; VERTICES],
            uvs: vec![Vec2::ZERO; VERTICES],
            triangles: vec![[0, 1, 2]],
            shapes: vec![shape()],
            ..Mesh::default()
        }
    };
    let channel = Channel {
        node: 0,
        target: ChannelTarget::Weights,
        interpolation: Interpolation::Linear,
        times: vec![0.0, 1.0],
        values: vec![0.0, 1.0],
    };
    let node = |number: usize| Node { name: format!("n{number}"), weights: vec![0.0], ..Node::default() };
    Scene::from_raw(RawScene {
        nodes: (0..count).map(node).collect(),
        parts: (0..count)
            .map(|number| ScenePart::rigid(&format!("p{number}"), number, mesh(number)))
            .collect(),
        clips: vec![Clip { name: "c".to_owned(), channels: vec![channel] }],
        ..RawScene::default()
    })
    .expect("a scene")
}

#[test]
fn of_meshes_that_are_nearly_equal() {
    let (small, large) = (nearly_equal(250), nearly_equal(4_000));
    assert_linear(growth(|| small.clone(), || large.clone(), import));
}

#[test]
fn of_joints_that_are_written() {
    let (small, large) = (import(nodes(500, false)), import(nodes(8_000, false)));
    let textures = Textures::default();
    // Only few poses: each has a key for every joint.
    let few = |pack: Pack| {
        let mut contents = pack.into_contents();
        contents.poses.poses.truncate(2);
        Pack::new(contents).expect("a pack")
    };
    let (small, large) = (few(small), few(large));
    assert_linear(growth(|| &small, || &large, |pack| export(pack, &textures)));
}

/// Each shape counts as the product of the one before with itself: as many ways lead to the first one as 2⁶⁰.
#[test]
fn of_shapes_that_many_ways_lead_to() {
    let count = 60;
    let shape = |number: usize| format!("s{number}");
    let twice = |number: usize| ShapeRule {
        shape: shape(number),
        rule: Rule::Product(vec![Input::Shape(shape(number - 1)), Input::Shape(shape(number - 1))]),
    };
    let scene = RawScene {
        nodes: vec![Node { name: "face".to_owned(), weights: vec![0.0; count], ..Node::default() }],
        parts: vec![ScenePart::rigid("face", 0, mesh((0..count).map(shape)))],
        drivers: vec![NodeDrivers {
            node: 0,
            drivers: vec![shape(0)],
            rest: vec![0.0],
            shapes: (0..count).map(shape).collect(),
            rules: (1..count).map(twice).collect(),
        }],
        ..RawScene::default()
    };
    let pack = import(Scene::from_raw(scene).expect("a scene"));
    assert!((0..count).all(|shape| pack.follows(shape, "s0")));
}
