//! GLB that is written, read again.

use crate::support::data::shared_data;
use crate::support::gltf::{read, read_file};
use crate::support::random;
use avatar_exchange::{
    Channel, ChannelTarget, Clip, Interpolation, Material, Node, RawScene, Scene, SceneImage, ScenePart,
    Skin, UvSet,
    glb::{self, ExportError},
    gltf,
};
use avatar_mesh::{Mesh, Shape, Skinning, deform};
use glam::{Affine3A, Vec2, Vec3};
use proptest::prelude::*;

fn read_raw(bytes: &[u8]) -> RawScene {
    gltf::read_raw("test", bytes, &mut |_| Err("no other files".to_owned())).expect("what was written")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_scene_is_the_same_to_the_bit(seed in any::<u64>()) {
        let scene = random::scene(seed);
        let bytes = glb::write_raw(&scene).expect("a valid scene");
        prop_assert_eq!(&read_raw(&bytes), &scene);
        prop_assert_eq!(glb::write_raw(&scene).expect("a valid scene"), bytes);
    }

    #[test]
    fn any_awkward_scene_deforms_as_before(seed in any::<u64>()) {
        let raw = random::awkward(seed);
        let bytes = glb::write_raw(&raw).expect("a valid scene");
        let (scene, again) = (Scene::from_raw(raw).expect("a valid scene"), read(&bytes).expect("what was written"));
        let worst = difference(&scene, &again, Compared::Positions);
        prop_assert!(worst <= 1e-6, "{}", worst);
        prop_assert!(again.notes.is_empty(), "{:?}", again.notes);
        // What was mended once needs no more.
        let second = read(&glb::write(&again).expect("a valid scene")).expect("what was written");
        prop_assert_eq!(second, again);
    }
}

/// The random scenes have everything that there is to write.
#[test]
fn random_scenes_are_rich() {
    let scenes: Vec<_> = (0..100).map(random::scene).collect();
    let any = |what: &dyn Fn(&RawScene) -> bool| scenes.iter().filter(|scene| what(scene)).count() > 5;
    assert!(any(&|scene| scene.parts.iter().any(|part| part.skin.is_some())));
    assert!(any(&|scene| scene.parts.iter().any(|part| part
        .mesh
        .shapes
        .iter()
        .any(|s| s.positions.is_sparse()))));
    assert!(any(&|scene| scene.parts.iter().any(|part| part.primitive > 0)));
    assert!(any(&|scene| scene
        .clips
        .iter()
        .flat_map(|c| &c.channels)
        .any(|c| c.target == ChannelTarget::Weights)));
    assert!(any(&|scene| scene.materials.iter().any(|m| m.textures().count() > 1)));
    assert!(any(&|scene| scene.materials.iter().any(|m| m.is_unlit)));
    assert!(any(&|scene| scene
        .materials
        .iter()
        .flat_map(Material::textures)
        .any(|t| t.uvs == UvSet::Second)));
    assert!(any(&|scene| scene.images.iter().any(|image| image.mime == "image/webp")));
    assert!(any(&|scene| scene.parts.iter().any(|part| !part.mesh.uvs_1.is_empty())));
    assert!(any(&|scene| scene.parts.iter().any(|part| !part.mesh.colors.is_empty())));
    let parts = |part: &ScenePart| part.mesh.shapes.iter().any(|shape| shape.tangents.is_some());
    assert!(any(&|scene| scene.parts.iter().any(parts)));
}

#[derive(Clone, Copy, PartialEq)]
enum Compared {
    Positions,
    PositionsAndNormals,
}

/// Largest difference of all vertices at several times of all clips, as a part of the scene's size.
fn difference(a: &Scene, b: &Scene, compared: Compared) -> f64 {
    assert_eq!((a.parts.len(), a.clips.len()), (b.parts.len(), b.clips.len()));
    let mut worst = 0.0f64;
    let times = |scene: &Scene, clip: usize| {
        let end = scene.clips[clip].duration_secs();
        [0.0, 0.13 * end, 0.5 * end, 0.77 * end, end]
    };
    let mut poses = vec![(a.rest(), b.rest())];
    for clip in 0..a.clips.len() {
        let at = |time| (a.at(clip, time).expect("a clip"), b.at(clip, time).expect("a clip"));
        poses.extend(times(a, clip).map(at));
    }
    for (of_a, of_b) in poses {
        let bones = (a.bones(&of_a), b.bones(&of_b));
        // Sums round by their largest terms: in a chain of nodes these may be far larger than where vertices
        // end.
        let worlds = a.worlds(&of_a).into_iter().flat_map(|world| world.to_cols_array());
        let entries = worlds.map(|x| x as f32).chain(bones.0.iter().flat_map(Affine3A::to_cols_array));
        let of_matrices = entries.fold(1.0f32, |most, x| most.max(x.abs()));
        for number in 0..a.parts.len() {
            let tagged = |part: &ScenePart| part.mesh.uvs[0].x == number as f32;
            let other = match compared {
                Compared::Positions => b.parts.iter().position(tagged).expect("the same part"),
                Compared::PositionsAndNormals => number,
            };
            let deformed = |scene: &Scene, number: usize, bones: &[Affine3A], pose| {
                let mesh = &scene.parts[number].mesh;
                let mut out = mesh.deformed();
                let weights = scene.weights_of(number, pose);
                deform(mesh, scene.bones_of(number, bones), weights, &mut out).expect("it fits");
                out
            };
            let (x, y) = (deformed(a, number, &bones.0, &of_a), deformed(b, other, &bones.1, &of_b));
            let size = x.positions.iter().fold(1.0f32, |most, p| most.max(p.abs().max_element()));
            let size = if compared == Compared::Positions { size * of_matrices } else { size };
            let normals =
                x.normals.iter().zip(&y.normals).filter(|_| compared == Compared::PositionsAndNormals);
            let pairs = x.positions.iter().zip(&y.positions).chain(normals);
            for (p, q) in pairs {
                worst = worst.max(f64::from((*p - *q).abs().max_element() / size));
            }
        }
    }
    worst
}

#[test]
fn published_files_deform_as_before() {
    let files = [
        "khronos-gltf/SimpleMorph/glTF/SimpleMorph.gltf",
        "khronos-gltf/AnimatedMorphCube/glTF/AnimatedMorphCube.gltf",
        "khronos-gltf/MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf",
        "khronos-gltf/SimpleSkin/SimpleSkin.gltf",
        "khronos-gltf/RiggedSimple/RiggedSimple.glb",
        "robot-expressive/RobotExpressive.glb",
    ];
    for file in files {
        let Some(path) = shared_data(file) else { continue };
        let scene = read_file(&path).expect("a published file");
        let bytes = glb::write(&scene).expect("a scene that was read");
        let again = read(&bytes).expect("what was written");
        let worst = difference(&scene, &again, Compared::PositionsAndNormals);
        println!("{file}: {worst:e}");
        assert!(worst <= 1e-6, "{file}: {worst}");
        assert_eq!(scene.materials, again.materials, "{file}");
        let names = |scene: &Scene| scene.clips.iter().map(|clip| clip.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&scene), names(&again), "{file}");
    }
}

fn dot(at: Vec3) -> Mesh {
    Mesh {
        positions: vec![at],
        uvs: vec![Vec2::ZERO],
        normals: vec![Vec3::Y],
        triangles: vec![[0; 3]],
        ..Mesh::default()
    }
}

fn skinned(bones: [u16; 4], weights: [f32; 4]) -> Mesh {
    let skinning = Skinning { bones: vec![bones], weights: vec![weights], ..Skinning::default() };
    Mesh { skinning: Some(skinning), ..dot(Vec3::X) }
}

fn node(name: &str, parent: Option<usize>) -> Node {
    Node { name: name.to_owned(), parent, ..Node::default() }
}

#[test]
fn eight_bones_are_written_in_two_sets() {
    let mut scene = RawScene { nodes: vec![node("a", None)], ..RawScene::default() };
    scene.nodes.extend((1..8).map(|_| node("b", Some(0))));
    scene.skins.push(Skin {
        name: String::new(),
        joints: (0..8).collect(),
        inverse_binds: vec![Affine3A::IDENTITY; 8],
    });
    let mut mesh = skinned([0, 1, 2, 3], [0.25, 0.125, 0.125, 0.125]);
    let more = mesh.skinning.as_mut().expect("bones");
    // The sixth and the seventh are one bone, the eighth has no weight.
    (more.more_bones, more.more_weights) = (vec![[4, 5, 5, 7]], vec![[0.125, 0.125, 0.125, 0.0]]);
    scene.parts.push(ScenePart::skinned("eight", 0, mesh, 0));
    let bytes = glb::write_raw(&scene).expect("a good scene");
    let again = read(&bytes).expect("what was written");
    let skinning = again.parts[0].mesh.skinning.as_ref().expect("bones");
    let json = String::from_utf8_lossy(&bytes).into_owned();
    assert!(json.contains("JOINTS_1") && json.contains("WEIGHTS_1"), "{json}");
    // Read, the largest are first.
    assert_eq!((skinning.bones[0], skinning.weights[0]), ([0, 5, 1, 2], [0.25, 0.25, 0.125, 0.125]));
    assert_eq!((skinning.more_bones[0], skinning.more_weights[0]), ([3, 4, 0, 0], [0.125, 0.125, 0.0, 0.0]));
    let four = skinned([0, 1, 2, 3], [0.25; 4]);
    scene.parts[0].mesh = four;
    let bytes = glb::write_raw(&scene).expect("a good scene");
    assert!(!String::from_utf8_lossy(&bytes).contains("JOINTS_1"));
}

/// What glTF has no word for becomes what deforms alike.
#[test]
fn awkward_scenes_deform_as_before() {
    let nodes = vec![node("a", None), node("b", None), node("c", Some(1))];
    let mut scene = RawScene { nodes, ..RawScene::default() };
    scene.nodes[0].weights = vec![0.25];
    scene.nodes[1].local = avatar_exchange::Transform::Trs(avatar_exchange::Trs {
        translation: Vec3::Z,
        ..avatar_exchange::Trs::default()
    });
    // Joints twice, and in different trees.
    let joints = vec![0, 1, 1];
    let inverse_binds = vec![Affine3A::IDENTITY, Affine3A::IDENTITY, Affine3A::from_translation(Vec3::Y)];
    scene.skins.push(Skin { name: String::new(), joints, inverse_binds });
    let shape = |name: &str| vec![Shape::new(name, vec![Vec3::Y])];
    // At one node: rigid, skinned, and with another name of the shape.
    let rigid = Mesh { shapes: shape("up"), ..dot(Vec3::ZERO) };
    scene.parts.push(ScenePart::rigid("rigid", 0, rigid));
    let bones = Mesh { shapes: shape("up"), ..skinned([2, 1, 2, 0], [0.25, 0.25, 0.25, 0.25]) };
    scene.parts.push(ScenePart::skinned("skinned", 0, bones, 0));
    let other = Mesh { shapes: shape("lift"), ..dot(Vec3::Z) };
    scene.parts.push(ScenePart::rigid("other", 0, other));
    // Two channels for one property, a jump, a spline of one key, a beginning before 0.
    let channel = |node, target, interpolation, times: &[f64], values: &[f32]| Channel {
        node,
        target,
        interpolation,
        times: times.to_vec(),
        values: values.to_vec(),
    };
    use ChannelTarget::{Scale, Translation, Weights};
    use Interpolation::{CubicSpline, Linear};
    let channels = vec![
        channel(1, Translation, Linear, &[0.0], &[9.0; 3]),
        channel(
            1,
            Translation,
            Linear,
            &[0.5, 1.0, 1.0, 1.0, 2.0],
            &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 5.0, 5.0, 5.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0],
        ),
        channel(2, Scale, CubicSpline, &[0.0], &[0.0, 0.0, 0.0, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0]),
        channel(0, Weights, Linear, &[0.0, 2.0], &[0.0, 1.0]),
    ];
    scene.clips.push(Clip { name: "clip".to_owned(), channels });
    scene.materials.push(Material {
        base_color_texture: Some(0.into()),
        metallic: 7.0,
        ..Material::default()
    });
    scene.images.push(SceneImage::default());

    let bytes = glb::write_raw(&scene).expect("a valid scene");
    let again = read(&bytes).expect("what was written");
    let scene = Scene::from_raw(scene).expect("a valid scene");
    let order: Vec<_> = again.parts.iter().map(|part| part.mesh.shapes[0].name.as_str()).collect();
    assert_eq!(order, ["up", "up", "lift"]);
    let worst = difference(&scene, &again, Compared::PositionsAndNormals);
    assert!(worst <= 1e-6, "{worst}");
    for time in [0.0, 0.7, 0.999_99, 1.0, 1.5, 3.0] {
        let at = |scene: &Scene| scene.worlds(&scene.at(0, time).expect("a clip"))[2].translation;
        assert!(
            (at(&scene) - at(&again)).abs().max_element() < 1e-4,
            "{time}: {} {}",
            at(&scene),
            at(&again)
        );
    }
    assert_eq!((again.images.len(), again.materials[0].base_color_texture), (0, None));
    assert_eq!(again.materials[0].metallic, 1.0);
    assert!(again.notes.is_empty(), "{:?}", again.notes);
}

#[test]
fn a_clip_before_zero_begins_at_zero() {
    let mut scene = RawScene { nodes: vec![node("a", None)], ..RawScene::default() };
    let channel = Channel {
        node: 0,
        target: ChannelTarget::Translation,
        interpolation: Interpolation::Linear,
        times: vec![-1.0, 1.0],
        values: vec![0.0, 0.0, 0.0, 2.0, 0.0, 0.0],
    };
    scene.clips.push(Clip { name: String::new(), channels: vec![channel] });
    let again = read_raw(&glb::write_raw(&scene).expect("a valid scene"));
    assert_eq!(again.clips[0].channels[0].times, [0.0, 2.0]);
}

/// What plain glTF has no word for is an extension, which the file lists.
#[test]
fn extensions_are_used_where_they_are_needed() {
    let mut scene = RawScene::default();
    let json = |scene: &RawScene| -> serde_json::Value {
        let bytes = glb::write_raw(scene).expect("a valid scene");
        serde_json::from_slice(gltf::split(&bytes).expect("GLB").json).expect("JSON")
    };
    assert_eq!(json(&scene).get("extensionsUsed"), None);
    let webp = SceneImage {
        mime: "image/webp".to_owned(),
        bytes: b"RIFF\x04\0\0\0WEBP".to_vec(),
        ..SceneImage::default()
    };
    scene.images = vec![webp];
    let bright = Material { emissive: [8.0, 2.0, 0.0], ..Material::default() };
    let textured = Material { base_color_texture: Some(0.into()), is_unlit: true, ..Material::default() };
    scene.materials = vec![bright, textured];
    let found = json(&scene);
    let used =
        serde_json::json!(["EXT_texture_webp", "KHR_materials_emissive_strength", "KHR_materials_unlit"]);
    assert_eq!(
        (&found["extensionsUsed"], &found["extensionsRequired"]),
        (&used, &serde_json::json!(["EXT_texture_webp"]))
    );
    assert_eq!(
        found["textures"],
        serde_json::json!([{ "extensions": { "EXT_texture_webp": { "source": 0 } } }])
    );
    assert_eq!(found["materials"][0]["emissiveFactor"], serde_json::json!([1.0, 0.25, 0.0]));
    assert_eq!(read_raw(&glb::write_raw(&scene).expect("a valid scene")), scene);
}

#[test]
fn nothing_at_all_can_be_written() {
    let bytes = glb::write_raw(&RawScene::default()).expect("an empty scene");
    assert_eq!(read_raw(&bytes), RawScene::default());
    assert_eq!(bytes.len() % 4, 0);
}

/// Shapes that move little take little.
#[test]
fn sparse_shapes_are_sparse_in_the_file() {
    let vertices = 10_000;
    let mesh = |moved: usize| {
        let offsets = (0..vertices).map(|v| if v < moved { Vec3::X } else { Vec3::ZERO }).collect::<Vec<_>>();
        Mesh {
            positions: vec![Vec3::ZERO; vertices],
            uvs: vec![Vec2::ZERO; vertices],
            normals: vec![Vec3::Y; vertices],
            triangles: vec![[0; 3]],
            shapes: vec![Shape::new("s", offsets)],
            ..Mesh::default()
        }
    };
    let length = |moved| {
        let mut scene = RawScene { nodes: vec![node("a", None)], ..RawScene::default() };
        scene.nodes[0].weights = vec![0.0];
        scene.parts.push(ScenePart::rigid("a", 0, mesh(moved)));
        let bytes = glb::write_raw(&scene).expect("a valid scene");
        assert_eq!(read_raw(&bytes), scene);
        bytes.len()
    };
    let still = length(0);
    assert!(length(10) < still + 500, "ten vertices");
    assert!(length(vertices) > still + 12 * vertices - 500, "all");
}

#[test]
fn wrong_scenes_are_refused_with_their_place() {
    let mut scene = RawScene { nodes: vec![node("a", None)], ..RawScene::default() };
    scene.parts.push(ScenePart::rigid("lost", 3, dot(Vec3::ZERO)));
    let error = glb::write_raw(&scene).expect_err("no such node");
    assert_eq!(error.to_string(), "part 0 'lost': expected a node below 1, found 3");

    scene.skins.push(Skin { name: String::new(), joints: vec![0], inverse_binds: vec![Affine3A::IDENTITY] });
    scene.parts[0] = ScenePart::skinned("torn", 0, skinned([0; 4], [1.5, -0.5, 0.0, 0.0]), 0);
    let error = glb::write_raw(&scene).expect_err("a negative weight");
    assert_eq!(
        error,
        ExportError::NegativeWeight { part: 0, name: "torn".to_owned(), vertex: 0, found: -0.5 }
    );
}
