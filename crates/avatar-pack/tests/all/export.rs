//! Avatars that are written as GLB, read again and imported: the same rig, shapes, poses, vertices and
//! pictures.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::{folder, golden, shared};
use avatar_exchange::{AlphaMode, Node, RawScene, Scene, ScenePart, Transform, Trs, glb, gltf};
use avatar_mesh::{Winding, raw};
use avatar_pack::{FaceState, Import, MemorySource, Pack, Part, ShapeSet, Textures, export};
use glam::Vec3;
use pose_anim::{ControlTable, PoseSet};
use std::collections::BTreeSet;

/// Differences are parts of the avatar's size: single precision tells 1e-7 of it.
const TOLERANCE: f32 = 1e-6;

/// The files of a folder beside the workspace's crates; where it is missing, that is said past the harness.
pub(crate) fn marsienne() -> MemorySource {
    folder("assets/marsienne")
}

pub(crate) fn again(scene: &RawScene) -> Import {
    let bytes = glb::write_raw(scene).expect("a valid scene");
    let scene = gltf::read("export.glb", &bytes, &mut |_| Err("no other files".to_owned()));
    Import::from_scene(scene.expect("what was written")).expect("an avatar")
}

struct Worst {
    /// Of the matrices of joints at rest.
    rig: f32,
    /// Of vertices in all poses, in the rig's units.
    vertices: f32,
    /// Of normals.
    normals: f32,
    compared: usize,
}

/// Everything of an avatar that a GLB holds is there again.
fn comes_back(source: &MemorySource) -> Worst {
    let (pack, textures) = (Pack::load(source).expect("a pack"), Textures::load(source));
    let scene = export(&pack, &textures);
    let import = again(&scene);
    let bounds = pack.bounds().expect("vertices");
    let size = (bounds.max - bounds.min).max_element().max(1.0);
    let mut worst = Worst { rig: 0.0, vertices: 0.0, normals: 0.0, compared: 0 };

    for (name, bind) in pack.rig().names().iter().zip(pack.rig().world_from_bind()) {
        let joint = import.pack.rig().joint(name).expect("a joint of this name");
        let found = import.pack.rig().world_from_bind()[joint.index()];
        let of_axes =
            (found.matrix3 - bind.matrix3).to_cols_array().into_iter().fold(0.0, |m: f32, x| m.max(x.abs()));
        let of_place = (found.translation - bind.translation).abs().max_element() / size;
        worst.rig = worst.rig.max(of_axes).max(of_place);
    }
    assert!(worst.rig <= TOLERANCE, "{}", worst.rig);
    // Behind the shapes of each part are the targets of mixtures.
    let count = |number: usize| pack.parts()[number].mesh.shapes.len();
    let own = |number: usize| import.pack.parts()[number].first_shape..;
    let own: Vec<String> = (0..pack.parts().len())
        .flat_map(|number| import.pack.shapes()[own(number)][..count(number)].to_vec())
        .collect();
    let expected: Vec<String> =
        pack.parts().iter().flat_map(|part| pack.shapes()[part.shapes()].to_vec()).collect();
    assert_eq!(own, expected);
    let names: Vec<_> = pack.poses().iter().map(|pose| pose.name.clone()).collect();
    assert_eq!(import.pack.motion().expect("clips").clips(), names);
    assert_eq!(import.pack.palette().len(), pack.palette().len());

    for (number, (part, found)) in pack.parts().iter().zip(import.pack.parts()).enumerate() {
        assert_eq!(found.name, part.name);
        assert_eq!(found.mesh.positions, part.mesh.positions, "{}", part.name);
        assert_eq!(found.mesh.uvs, part.mesh.uvs, "{}", part.name);
        let offsets =
            |mesh: &avatar_mesh::Mesh| mesh.shapes.iter().map(|s| s.positions.clone()).collect::<Vec<_>>();
        let shapes = part.mesh.shapes.len();
        assert_eq!(offsets(&found.mesh)[..shapes], offsets(&part.mesh), "{}", part.name);
        let turned = Winding::of(&part.mesh).is_inside_out();
        let triangle = |[a, b, c]: [u32; 3]| if turned { [a, c, b] } else { [a, b, c] };
        assert!(part.mesh.triangles.iter().copied().map(triangle).eq(found.mesh.triangles.iter().copied()));
        let (own, other) = (textures.of_part(number, part.kind), import.textures.of_part(number, found.kind));
        assert_eq!(own.color.is_some(), other.color.is_some(), "{}", part.name);
        assert!(own.color == other.color && own.normal == other.normal && own.occlusion == other.occlusion);
    }

    let mut own = FaceState::new(&pack);
    let mut other = FaceState::new(&import.pack);
    for pose in pack.poses().iter() {
        let mut values = pack.controls().defaults();
        pose.values.iter().for_each(|(control, value)| values[*control] = *value);
        own.pose(&pack, &values).expect("a pose of the pack");
        let at = import.pack.motion().expect("clips").at(&pose.name, 0.0).expect("a clip");
        let defaults = import.pack.controls().defaults();
        other.pose_with(&import.pack, &defaults, |_| {}, &at.locals).expect("a clip's pose");
        other.set_weights(&at.weights);
        for part in 0..pack.parts().len() {
            let (a, b) =
                (own.deform(&pack, part).expect("a part"), other.deform(&import.pack, part).expect("a part"));
            assert_eq!(a.positions.len(), b.positions.len());
            for (a, b) in a.positions.iter().zip(&b.positions) {
                worst.vertices = worst.vertices.max((*a - *b).abs().max_element());
            }
            for (a, b) in a.normals.iter().zip(&b.normals) {
                worst.normals = worst.normals.max((*a - *b).abs().max_element());
            }
            worst.compared += a.positions.len();
        }
    }
    println!("rig {:e}, vertices {:e} of {size}, normals {:e}", worst.rig, worst.vertices, worst.normals);
    assert!(worst.compared > 0);
    assert!(worst.vertices <= TOLERANCE * size, "{} of {size}", worst.vertices);
    assert!(worst.normals <= TOLERANCE, "{}", worst.normals);
    worst
}

#[test]
fn the_default_avatar_comes_back() {
    let worst = comes_back(&marsienne());
    assert!(worst.compared > 100_000, "{}", worst.compared);
}

#[test]
fn the_golden_pack_comes_back() {
    comes_back(&golden());
}

/// Its right eye is a mirror copy with the left one's triangles, as the original's.
#[test]
fn a_face_with_mirrored_parts_comes_back() {
    let Some(source) = shared("avatar-course-format-makehuman") else { return };
    comes_back(&source);
}

#[test]
fn parts_inside_out_are_turned_around() {
    let mut source = marsienne();
    let indices = source.files.get_mut("RtEyeBall_smtt_IB.raw").expect("an index buffer");
    for triangle in indices.as_chunks_mut::<12>().0 {
        let [_, b, c] = triangle.as_chunks_mut::<4>().0 else { panic!("three corners") };
        std::mem::swap(b, c);
    }
    let indices = indices.clone();
    let pack = Pack::load(&source).expect("a pack");
    let vertices = &source.files["RtEyeBall_smtt_VB.raw"];
    assert!(Winding::of(&raw::read_rigid(vertices, &indices).expect("a part")).is_inside_out());
    let scene = export(&pack, &Textures::default());
    for part in &scene.parts {
        assert!(!Winding::of(&part.mesh).is_inside_out(), "{}", part.name);
    }
    comes_back(&source);
}

/// What was imported from a file with shapes at several nodes is exported with each part's own shapes.
#[test]
fn an_import_comes_back() {
    let source = marsienne();
    let (pack, textures) = (Pack::load(&source).expect("a pack"), Textures::load(&source));
    let mut scene = export(&pack, &textures);
    // A second part with shapes, whose places come after those of the skin.
    let jaw = scene.parts.iter().position(|part| part.name == "lower-jaw").expect("a part");
    let vertices = scene.parts[jaw].mesh.positions.len();
    let drop = avatar_mesh::Shape::new("Drop", vec![glam::Vec3::NEG_Y; vertices]);
    scene.parts[jaw].mesh.shapes.push(drop);
    scene.nodes[scene.parts[jaw].node].weights.push(0.0);
    scene.clips.clear();
    let first = again(&scene);
    let names = |part: &Part| part.mesh.shapes.iter().map(|shape| shape.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&first.pack.parts()[jaw]).last().map(String::as_str), Some("Drop"));
    let second = again(&export(&first.pack, &first.textures));
    assert_eq!(second.pack.shapes(), first.pack.shapes());
    let drop = first.pack.controls().index("Drop").expect("a control");
    let state = |import: &Import| {
        let mut values = import.pack.controls().defaults();
        values[drop] = 1.0;
        let mut state = FaceState::new(&import.pack);
        state.pose(&import.pack, &values).expect("a pose");
        state.deform(&import.pack, jaw).expect("a part").positions
    };
    assert_eq!(second.pack.controls().index("Drop"), Some(drop));
    let (a, b) = (state(&first), state(&second));
    assert_eq!(a.len(), b.len());
    let worst = a.iter().zip(&b).fold(0.0f32, |worst, (a, b)| worst.max((*a - *b).abs().max_element()));
    let rest = &first.pack.parts()[jaw].mesh.positions;
    let moved = a.iter().zip(rest).all(|(a, rest)| (*a - *rest).length() > 0.5);
    assert!(moved && worst <= 25.0 * TOLERANCE, "{worst}");
}

#[test]
fn looks_and_rest_are_those_of_the_pack() {
    let source = marsienne();
    let (pack, textures) = (Pack::load(&source).expect("a pack"), Textures::load(&source));
    let scene = export(&pack, &textures);
    let material =
        |name: &str| scene.materials.iter().find(|material| material.name == name).expect("a material");
    let skin = material("skin");
    assert!(skin.base_color_texture.is_some() && skin.metallic == 0.0, "{skin:?}");
    assert_eq!(skin.base_color, [1.0; 4]);
    let cornea = material("left-cornea");
    let look =
        pack.material(pack.parts().iter().position(|part| part.name == "left-cornea").expect("a part"));
    let [r, g, b] = look.color;
    assert_eq!((cornea.alpha_mode, cornea.base_color), (AlphaMode::Blend, [r, g, b, look.opacity]));
    // Both eyes have one picture.
    let eye = material("left-eyeball").base_color_texture;
    assert!(eye.is_some() && eye == material("right-eyeball").base_color_texture);
    assert!(scene.nodes.iter().all(|node| matches!(node.local, Transform::Trs(_))));
    // Gloss 0 is as rough as the material says.
    let rough = skin.metallic_roughness_texture.expect("a texture");
    let decoded = image::load_from_memory(&scene.images[rough.image].bytes).expect("a PNG").into_rgba8();
    let gloss = textures.of_part(0, avatar_mesh::PartKind::Skin).gloss.expect("a gloss texture");
    let look = pack.material(0);
    for (x, y) in [(0, 0), (decoded.width() / 2, decoded.height() / 3)] {
        let share = f32::from(gloss.get_pixel(x, y).0[0]) / 255.0;
        let expected = 255.0 * (look.roughness_matte * (1.0 - share) + look.roughness_glossy * share);
        assert!((f32::from(decoded.get_pixel(x, y).0[1]) - expected).abs() <= 0.51, "{x} {y}");
        assert_eq!(decoded.get_pixel(x, y).0[2], 0, "no metal");
    }
}

/// A triangle at a node that mirrors, imported, written as GLB, and read again: its front is where its normal
/// points, for readers that ask the joints and for those that ask the node of the mesh.
#[test]
fn a_mirrored_part_is_written_with_its_front_outside() {
    let mirror = Trs { scale: Vec3::new(-1.0, 1.0, 1.0), translation: Vec3::X, ..Trs::default() };
    let node =
        |name: &str, trs| Node { name: name.to_owned(), local: Transform::Trs(trs), ..Node::default() };
    let mesh = avatar_mesh::Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![glam::Vec2::ZERO; 3],
        normals: vec![Vec3::Z; 3],
        triangles: vec![[0, 1, 2]],
        ..avatar_mesh::Mesh::default()
    };
    let parts = vec![ScenePart::rigid("mirrored", 0, mesh.clone()), ScenePart::rigid("plain", 1, mesh)];
    let nodes = vec![node("mirrored", mirror), node("plain", Trs::default())];
    let raw = RawScene { nodes, parts, ..RawScene::default() };
    let first = Import::from_scene(Scene::from_raw(raw).expect("a scene")).expect("an avatar");
    let scene = export(&first.pack, &first.textures);
    let is_mirrored = |part: usize| match scene.nodes[scene.parts[part].node].local {
        Transform::Trs(trs) => trs.scale.element_product() < 0.0,
        Transform::Matrix(_) => panic!("a matrix"),
    };
    assert_eq!([0, 1].map(is_mirrored), [true, false]);
    let second = again(&scene);
    for import in [&first, &second] {
        let mut state = FaceState::new(&import.pack);
        state.pose(&import.pack, &import.pack.controls().defaults()).expect("a pose");
        for part in 0..2 {
            let deformed = state.deform(&import.pack, part).expect("a part");
            let [a, b, c] =
                state.triangles(&import.pack, part)[0].map(|corner| deformed.positions[corner as usize]);
            let front = (b - a).cross(c - a).normalize_or_zero();
            assert!(
                front.distance(Vec3::Z) < 1e-6 && deformed.normals[0].distance(Vec3::Z) < 1e-6,
                "{front}"
            );
        }
    }
}

/// A skeleton has no vertices that a palette could move.
#[test]
fn a_skeleton_alone_comes_back() {
    let node = |name: &str, parent| Node { name: name.to_owned(), parent, ..Node::default() };
    let scene = RawScene { nodes: vec![node("hip", None), node("head", Some(0))], ..RawScene::default() };
    let first = Import::from_scene(Scene::from_raw(scene).expect("a scene")).expect("an avatar");
    let scene = export(&first.pack, &first.textures);
    assert!(scene.skins.is_empty());
    let second = again(&scene);
    assert_eq!(second.pack.rig().names(), first.pack.rig().names());
}

/// What glTF 2.0 says in sections 3.7.2.2 and 3.7.3.3 of a target at weight 1, at rest: its offsets added,
/// and joints that move nothing. Written here by itself, so that nothing of this library but the reader of
/// GLB takes part.
pub(crate) fn at_weight_1(mesh: &avatar_mesh::Mesh, name: &str) -> Option<(Vec<Vec3>, Vec<Vec3>)> {
    let shape = mesh.shapes.iter().find(|shape| shape.name == name)?;
    let (mut positions, mut normals) = (mesh.positions.clone(), mesh.normals.clone());
    shape.positions.iter().for_each(|(vertex, offset)| positions[vertex] += offset);
    shape.normals.iter().flat_map(|offsets| offsets.iter()).for_each(|(v, offset)| normals[v] += offset);
    Some((positions, normals.into_iter().map(Vec3::normalize_or_zero).collect()))
}

/// Every name of ARKit and every sound is a target that shows what the control shows, in all parts.
#[test]
fn mixtures_are_targets_for_programs_without_mixtures() {
    let pack = Pack::load(&marsienne()).expect("a pack");
    let bytes = glb::write_raw(&export(&pack, &Textures::default())).expect("a valid scene");
    let scene = gltf::read("a.glb", &bytes, &mut |_| Err(String::new())).expect("a scene");
    let mixtures: Vec<String> =
        pack.further_shapes().expect("shapes").mixtures.iter().map(|m| m.name.clone()).collect();
    for name in ShapeSet::ArKit.names().iter().chain(ShapeSet::Visemes.names()) {
        let is_there = |part: &ScenePart| part.mesh.shapes.iter().any(|shape| shape.name == *name);
        assert!(scene.parts.iter().any(is_there), "{name}");
    }
    let size = pack.bounds().map(|bounds| (bounds.max - bounds.min).max_element()).expect("vertices");
    let (mut worst, mut worst_normal, mut moving) = (0.0f32, 0.0f32, 0);
    for name in &mixtures {
        let mut values = pack.controls().defaults();
        values[pack.controls().index(name).expect("a control")] = 1.0;
        let mut state = FaceState::new(&pack);
        state.pose(&pack, &values).expect("a pose");
        for (number, part) in scene.parts.iter().enumerate() {
            let expected = state.deform(&pack, number).expect("a part");
            let (positions, normals) = match at_weight_1(&part.mesh, name) {
                Some(moved) => moved,
                None => (part.mesh.positions.clone(), part.mesh.normals.clone()),
            };
            assert_eq!(positions.len(), expected.positions.len());
            let off = positions.iter().zip(&expected.positions).map(|(a, b)| (*a - *b).abs().max_element());
            worst = off.fold(worst, f32::max);
            let off = normals.iter().zip(&expected.normals).map(|(a, b)| (*a - *b).abs().max_element());
            worst_normal = off.fold(worst_normal, f32::max);
            moving += usize::from(positions != part.mesh.positions);
        }
    }
    println!(
        "{moving} targets of {} mixtures: positions {worst:e} of {size}, normals {worst_normal:e}",
        mixtures.len()
    );
    assert!(moving > mixtures.len(), "{moving}");
    assert!(worst <= 1e-5 && worst_normal <= 1e-5, "{worst} {worst_normal}");
}

/// Read again, the face is posed by joints or by a target, and neither moves the other: the name alone shows
/// what the mixture shows, and poses of joints leave the targets at rest.
#[test]
fn targets_of_mixtures_double_nothing_that_is_read_again() {
    let pack = Pack::load(&marsienne()).expect("a pack");
    let import = again(&export(&pack, &Textures::default()));
    let deformed = |pack: &Pack, set: &[(&str, f32)]| {
        let mut values = pack.controls().defaults();
        for (name, value) in set {
            values[pack.controls().index(name).expect(name)] = *value;
        }
        let mut state = FaceState::new(pack);
        state.pose(pack, &values).expect("a pose");
        (0..pack.parts().len()).map(|part| state.deform(pack, part).expect("a part").positions).collect()
    };
    let worst = |a: Vec<Vec<Vec3>>, b: Vec<Vec<Vec3>>| {
        let parts = a.iter().zip(&b).inspect(|(a, b)| assert_eq!(a.len(), b.len()));
        parts.flat_map(|(a, b)| a.iter().zip(b)).fold(0.0f32, |worst, (a, b)| worst.max(a.distance(*b)))
    };
    for name in ["jawOpen", "eyeBlinkLeft", "eyeLookInRight", "viseme_U", "viseme_PP"] {
        let off = worst(deformed(&pack, &[(name, 1.0)]), deformed(&import.pack, &[(name, 1.0)]));
        assert!(off <= 2e-5, "{name}: {off}");
    }
    let of_joint = [("jaw.open", 13.0)];
    let jaw = import.pack.parts().iter().position(|part| part.name == "lower-jaw").expect("a part");
    let (own, other): (Vec<Vec<Vec3>>, Vec<Vec<Vec3>>) =
        (deformed(&pack, &of_joint), deformed(&import.pack, &of_joint));
    let off = worst(vec![own[jaw].clone()], vec![other[jaw].clone()]);
    assert!(off <= 2e-5, "the jaw's joint: {off}");
    let mixed: BTreeSet<&str> =
        pack.further_shapes().expect("shapes").mixtures.iter().map(|mixture| mixture.name.as_str()).collect();
    for pose in PoseSet::default_face(&ControlTable::default_face()).iter() {
        let Some(pose) = import.pack.poses().get(&pose.name) else { continue };
        for (control, value) in &pose.values {
            let name = import.pack.controls().controls()[*control].name.as_str();
            assert!(*value == 0.0 || !mixed.contains(name), "{}: {name} = {value}", pose.name);
        }
    }
    // Written once more, there is no mixture left to be made a target of.
    let once_more = again(&export(&import.pack, &import.textures));
    assert_eq!(once_more.pack.shapes(), import.pack.shapes());
}
