//! Small files made here: component types, sparse accessors, topologies, bones of vertices, names.

use crate::support::data::shared_case;
use crate::support::gltf::{Builder, F32, I8, I16, U8, U16, U32, floats, one_primitive, read};
use avatar_exchange::{AlphaMode, Material, Scene, TextureRef, UvSet, Wrap};
use glam::{Vec2, Vec3, Vec4};

#[test]
fn positions_of_every_component_type() {
    let cases: [(u32, &str, Vec<u8>, [f32; 3]); 8] = [
        (I8, "", vec![127, 0x80, 3], [127.0, -128.0, 3.0]),
        (I8, r#", "normalized": true"#, vec![127, 0x80, 0], [1.0, -1.0, 0.0]),
        (U8, "", vec![255, 0, 7], [255.0, 0.0, 7.0]),
        (U8, r#", "normalized": true"#, vec![255, 0, 51], [1.0, 0.0, 0.2]),
        (I16, "", vec![0xff, 0x7f, 0, 0x80, 2, 0], [32767.0, -32768.0, 2.0]),
        (I16, r#", "normalized": true"#, vec![0xff, 0x7f, 0, 0x80, 0, 0], [1.0, -1.0, 0.0]),
        (U16, r#", "normalized": true"#, vec![0xff, 0xff, 0, 0, 0x33, 0x33], [1.0, 0.0, 0.2]),
        (F32, "", floats(&[0.25, -1e30, 1e-30]), [0.25, -1e30, 1e-30]),
    ];
    for (component, more, element, expected) in cases {
        let mut file = Builder::default();
        // The second element stands 4 bytes further than it must.
        let mut bytes = element.clone();
        bytes.extend([99; 4]);
        bytes.extend(element.iter());
        let view = file.view(&bytes, &format!(r#", "byteStride": {}"#, element.len() + 4));
        let position = file.raw_accessor(format!(
            r#"{{"bufferView": {view}, "componentType": {component}, "type": "VEC3", "count": 2{more}}}"#
        ));
        let scene = file.scene(&one_primitive(&format!(r#"{{"attributes": {{"POSITION": {position}}}}}"#)));
        let mesh = &scene.parts[0].mesh;
        assert_eq!(mesh.positions, [Vec3::from_array(expected); 2], "{component}{more}");
    }
}

#[test]
fn texture_coordinates_and_indices_of_every_component_type() {
    let coordinates: [(u32, Vec<u8>); 3] = [
        (U8, vec![0, 255, 51, 0, 255, 255]),
        (U16, vec![0, 0, 0xff, 0xff, 0x33, 0x33, 0, 0, 0xff, 0xff, 0xff, 0xff]),
        (F32, floats(&[0.0, 1.0, 0.2, 0.0, 1.0, 1.0])),
    ];
    let indices: [(u32, Vec<u8>); 3] =
        [(U8, vec![2, 0, 1]), (U16, vec![2, 0, 0, 0, 1, 0]), (U32, vec![2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0])];
    for ((uv_type, uvs), (index_type, indices)) in coordinates.into_iter().zip(indices) {
        let mut file = Builder::default();
        let position = file.triangle();
        let uv =
            file.accessor_with(&uvs, uv_type, "VEC2", 3, &format!(r#", "normalized": {}"#, uv_type != F32));
        let index = file.accessor(&indices, index_type, "SCALAR", 3);
        let primitive = format!(
            r#"{{"attributes": {{"POSITION": {position}, "TEXCOORD_0": {uv}}}, "indices": {index}}}"#
        );
        let scene = file.scene(&one_primitive(&primitive));
        let mesh = &scene.parts[0].mesh;
        assert_eq!(mesh.uvs, [Vec2::Y, Vec2::new(0.2, 0.0), Vec2::ONE], "{uv_type}");
        assert_eq!(mesh.triangles, [[2, 0, 1]], "{index_type}");
        assert_eq!(mesh.normals, [Vec3::Z; 3], "those of the triangle");
    }
}

#[test]
fn sparse_accessors_with_and_without_a_base() {
    for base in [true, false] {
        let mut file = Builder::default();
        let dense = file.view(&floats(&[1.0; 9]), "");
        let index = file.view(&[0, 0, 2, 0], "");
        let value = file.view(&floats(&[5.0, 6.0, 7.0, 8.0, 9.0, 10.0]), "");
        let base_json = if base { format!(r#""bufferView": {dense}, "#) } else { String::new() };
        let sparse = format!(
            r#"{{"count": 2, "indices": {{"bufferView": {index}, "componentType": 5123}}, "values": {{"bufferView": {value}}}}}"#
        );
        let offsets = file.raw_accessor(format!(
            r#"{{{base_json}"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {sparse}}}"#
        ));
        let position = file.triangle();
        let primitive = format!(
            r#"{{"attributes": {{"POSITION": {position}}}, "targets": [{{"POSITION": {offsets}}}]}}"#
        );
        let scene = file.scene(&one_primitive(&primitive));
        let pose = avatar_exchange::ScenePose { weights: vec![vec![1.0]], ..scene.rest() };
        let mesh = &scene.parts[0].mesh;
        let mut deformed = mesh.deformed();
        avatar_mesh::deform(mesh, &scene.bones(&pose), scene.weights_of(0, &pose), &mut deformed)
            .expect("it fits");
        let middle = if base { Vec3::new(2.0, 1.0, 1.0) } else { Vec3::X };
        assert_eq!(deformed.positions, [Vec3::new(5.0, 6.0, 7.0), middle, Vec3::new(8.0, 10.0, 10.0)]);
    }
}

#[test]
fn sparse_indices_must_rise_and_stay_inside() {
    for indices in [[2, 0, 0, 0], [0, 0, 0, 0], [0, 0, 3, 0]] {
        let mut file = Builder::default();
        let index = file.view(&indices, "");
        let value = file.view(&floats(&[0.0; 6]), "");
        let sparse = format!(
            r#"{{"count": 2, "indices": {{"bufferView": {index}, "componentType": 5123}}, "values": {{"bufferView": {value}}}}}"#
        );
        let position = file.raw_accessor(format!(
            r#"{{"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {sparse}}}"#
        ));
        let error = file.error(&one_primitive(&format!(r#"{{"attributes": {{"POSITION": {position}}}}}"#)));
        assert_eq!(error.place, "accessor 0, sparse index 1", "{error}");
    }
}

#[test]
fn strips_and_fans_become_triangles() {
    let modes: [(u32, &[[u32; 3]]); 3] =
        [(4, &[[0, 1, 2]]), (5, &[[0, 1, 2], [1, 3, 2], [2, 3, 4]]), (6, &[[1, 2, 0], [2, 3, 0], [3, 4, 0]])];
    for (mode, triangles) in modes {
        let mut file = Builder::default();
        let position = file.floats(&[0.0; 15], "VEC3");
        let primitive = format!(r#"{{"attributes": {{"POSITION": {position}}}, "mode": {mode}}}"#);
        let scene = file.scene(&one_primitive(&primitive));
        assert_eq!(scene.parts[0].mesh.triangles, triangles, "mode {mode}");
        let left_over =
            scene.notes.iter().any(|note| note.finding.to_string().starts_with("2 vertices at the end"));
        assert_eq!(left_over, mode == 4, "{:?}", scene.notes);
    }
}

#[test]
fn points_and_lines_are_noted() {
    for mode in 0..4 {
        let mut file = Builder::default();
        let position = file.triangle();
        let primitive = format!(r#"{{"attributes": {{"POSITION": {position}}}, "mode": {mode}}}"#);
        let scene = file.scene(&one_primitive(&primitive));
        assert!(scene.parts.is_empty());
        assert_eq!(scene.notes[0].place, "mesh 0, primitive 0");
    }
}

/// A file with a triangle on two joints; each set is joints and weights of its three vertices.
fn skinned(sets: &[([u8; 12], [f32; 12])]) -> (Builder, String) {
    let mut file = Builder::default();
    let mut attributes = format!(r#""POSITION": {}"#, file.triangle());
    for (set, (joints, weights)) in sets.iter().enumerate() {
        let (joints, weights) = (file.accessor(joints, U8, "VEC4", 3), file.floats(weights, "VEC4"));
        attributes += &format!(r#", "JOINTS_{set}": {joints}, "WEIGHTS_{set}": {weights}"#);
    }
    let rest = format!(
        r#""nodes": [{{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}}, {{"translation": [1, 0, 0]}}, {{"translation": [0, 2, 0]}}],
        "meshes": [{{"primitives": [{{"attributes": {{{attributes}}}}}]}}], "skins": [{{"joints": [2, 1]}}]"#
    );
    (file, rest)
}

#[test]
fn five_bones_are_kept_and_the_first_four_are_the_largest() {
    let first = ([0; 12], [0.1, 0.1, 0.1, 0.1, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let second = (
        [1, 1, 0, 0, 77, 77, 77, 77, 0, 0, 0, 0],
        [0.4, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    );
    let (file, rest) = skinned(&[first, second]);
    let scene = file.scene(&rest);
    let skinning = scene.parts[0].mesh.skinning.as_ref().expect("bones");
    assert_eq!(skinning.bones, [[1, 1, 0, 0], [0; 4], [0; 4]]);
    assert_eq!(skinning.weights[0], [0.4, 0.2, 0.1, 0.1]);
    assert_eq!(skinning.weights[1..], [[1.0, 0.0, 0.0, 0.0]; 2]);
    assert_eq!(skinning.more_bones, [[0; 4]; 3]);
    assert_eq!(skinning.more_weights, [[0.1, 0.1, 0.0, 0.0], [0.0; 4], [0.0; 4]]);
    let texts: Vec<_> = scene.notes.iter().map(|note| note.finding.to_string()).collect();
    assert!(!texts.iter().any(|text| text.contains("bones")), "{texts:?}");
    assert!(texts.iter().any(|text| text.starts_with("1 vertices without weight")), "{texts:?}");
    // The node of a skinned part does not move it.
    let bones = scene.bones(&scene.rest());
    assert_eq!(
        bones.iter().map(|bone| Vec3::from(bone.translation)).collect::<Vec<_>>(),
        [2.0 * Vec3::Y, Vec3::X]
    );
    // A second set that says nothing takes no room.
    let (file, rest) = skinned(&[([0; 12], [1.0; 12]), ([0; 12], [0.0; 12])]);
    let scene = file.scene(&rest);
    assert!(scene.parts[0].mesh.skinning.as_ref().expect("bones").more_bones.is_empty());
}

/// Eight and more joints that carry the first vertex, each along its own vector: all of eight count, and of
/// nine the eight largest.
#[test]
fn eight_joints_move_a_vertex_and_the_ninth_is_noted() {
    let weights = [0.05, 0.1, 0.2, 0.15, 0.125, 0.075, 0.18, 0.12];
    let along = |k: usize| [k as f32, (k * k) as f32 * 0.5, 3.0 - k as f32];
    let scene_of = |ninth: Option<f32>| {
        let mut sets = vec![([0u8; 12], [0.0f32; 12]); if ninth.is_some() { 3 } else { 2 }];
        for (k, weight) in weights.into_iter().chain(ninth).enumerate() {
            (sets[k / 4].0[k % 4], sets[k / 4].1[k % 4]) = (k as u8, weight);
        }
        // The other vertices have one joint.
        (sets[0].1[4], sets[0].1[8]) = (1.0, 1.0);
        let (file, rest) = skinned(&sets);
        let mut rest = rest.replace("\"joints\": [2, 1]", "\"joints\": [1, 2, 3, 4, 5, 6, 7, 8, 9]");
        let old = r#", {"translation": [1, 0, 0]}, {"translation": [0, 2, 0]}"#;
        let nodes: String = (0..9).map(|k| format!(r#", {{"translation": {:?}}}"#, along(k))).collect();
        rest = rest.replace(old, &nodes);
        file.scene(&rest)
    };
    let moved = |scene: &Scene| {
        let bones = scene.bones(&scene.rest());
        let mesh = &scene.parts[0].mesh;
        let mut out = mesh.deformed();
        avatar_mesh::deform(mesh, scene.bones_of(0, &bones), &[], &mut out).expect("it fits");
        out.positions[0] - mesh.positions[0]
    };
    let sum = |left_out: Option<usize>, ninth: Option<f32>| {
        let all = weights.into_iter().chain(ninth).enumerate().filter(|(k, _)| Some(*k) != left_out);
        let total: f32 = all.clone().map(|(_, weight)| weight).sum();
        all.map(|(k, weight)| Vec3::from(along(k)) * weight / total).sum::<Vec3>()
    };
    let eight = scene_of(None);
    assert!(moved(&eight).distance(sum(None, None)) < 1e-5, "{}", moved(&eight));
    assert!(!eight.notes.iter().any(|note| note.finding.to_string().contains("bones")), "{:?}", eight.notes);
    let nine = scene_of(Some(0.09));
    // The first is the smallest.
    assert!(moved(&nine).distance(sum(Some(0), Some(0.09))) < 1e-5, "{}", moved(&nine));
    let texts: Vec<_> = nine.notes.iter().map(|note| note.finding.to_string()).collect();
    let expected = "1 vertices have more than eight bones: the eight largest are kept";
    assert!(texts.iter().any(|text| text == expected), "{texts:?}");
}

#[test]
fn the_shared_case_of_eight_influences_has_its_value() {
    let Some(path) = shared_case("eight-influences/eight.glb") else { return };
    let scene = read(&std::fs::read(path).expect("a file that is there")).expect("a good file");
    let (mesh, bones) = (&scene.parts[0].mesh, scene.bones(&scene.rest()));
    let mut out = mesh.deformed();
    avatar_mesh::deform(mesh, scene.bones_of(0, &bones), &[], &mut out).expect("it fits");
    assert!(out.positions[0].distance(Vec3::new(2.34, 1.58, -2.34)) < 1e-5, "{}", out.positions[0]);
}

#[test]
fn joints_beyond_the_skin_and_negative_weights_are_errors() {
    let weights = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let (file, rest) = skinned(&[([0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0], weights)]);
    let error = file.error(&rest);
    assert!(error.found.contains("vertex 1, bone 0") && error.found.contains("from 0 to 1"), "{error}");
    let mut negative = weights;
    negative[5] = -0.5;
    let (file, rest) = skinned(&[([0; 12], negative)]);
    assert_eq!(file.error(&rest).place, "accessor 2, element 1");
    let mut nan = weights;
    nan[0] = f32::NAN;
    let (file, rest) = skinned(&[([0; 12], nan)]);
    assert_eq!(file.error(&rest).place, "accessor 2, element 0");
}

#[test]
fn targets_get_their_names_and_names_are_told_apart() {
    let mut file = Builder::default();
    let position = file.triangle();
    let target = format!(r#"{{"POSITION": {position}}}"#);
    let rest = format!(
        r#""nodes": [{{"mesh": 0, "name": "face"}}, {{"mesh": 0, "weights": [1, 2, 3, 4]}}],
        "meshes": [{{"weights": [0, 0.5, 0, 0], "extras": {{"targetNames": ["a", "a", "a.2"]}},
        "primitives": [{{"attributes": {{"POSITION": {position}}}, "targets": [{target}, {target}, {target}, {{}}]}}]}}]"#
    );
    let scene = file.scene(&rest);
    let names: Vec<_> = scene.parts[0].mesh.shapes.iter().map(|shape| shape.name.as_str()).collect();
    assert_eq!(names, ["a", "a.3", "a.2", "target 3"]);
    let pose = scene.rest();
    assert_eq!(scene.weights_of(0, &pose), [0.0, 0.5, 0.0, 0.0], "those of the mesh");
    assert_eq!(scene.weights_of(1, &pose), [1.0, 2.0, 3.0, 4.0], "the node's own");
    assert_eq!((scene.parts[0].name.as_str(), scene.parts[1].name.as_str()), ("face", "node 1"));
    let few = rest.replace("[1, 2, 3, 4]", "[1]");
    assert_eq!(file.error(&few).place, "node 1 or mesh 0, weights");
}

#[test]
fn targets_move_tangents() {
    let mut file = Builder::default();
    let position = file.triangle();
    let tangents = file.floats(&[1.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0], "VEC4");
    let offsets = file.floats(&[0.0, 0.5, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 2.0], "VEC3");
    let rest = format!(
        r#""nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {position}, "TANGENT": {tangents}}},
        "targets": [{{"POSITION": {position}, "TANGENT": {offsets}}}]}}]}}]"#
    );
    let scene = file.scene(&rest);
    let part = &scene.parts[0];
    assert_eq!(part.mesh.tangents[0], Vec4::new(1.0, 0.0, 0.0, -1.0));
    let moved = part.mesh.shapes[0].tangents.as_ref().expect("tangents");
    let moved: Vec<_> = (0..3).map(|vertex| moved.get(vertex).unwrap_or(Vec3::ZERO)).collect();
    assert_eq!(moved, [Vec3::new(0.0, 0.5, 0.0), Vec3::ZERO, Vec3::new(-1.0, 0.0, 2.0)]);
    // So that deformation moves them.
    let mut out = part.mesh.deformed();
    let bones = scene.bones(&scene.rest());
    avatar_mesh::deform(&part.mesh, scene.bones_of(0, &bones), &[1.0], &mut out).expect("it fits");
    let turned = Vec3::new(1.0, 0.5, 0.0).normalize();
    assert!(out.tangents[0].abs_diff_eq(turned.extend(-1.0), 1e-6), "{}", out.tangents[0]);
    assert_eq!(out.tangents[1], Vec4::X + Vec4::W);
}

#[test]
fn the_default_scene_is_what_is_shown() {
    let mut file = Builder::default();
    let position = file.triangle();
    // A group with a child, a node of the second scene, one of none.
    let rest = format!(
        r#""nodes": [{{"name": "group", "children": [1]}}, {{"name": "child", "mesh": 0}}, {{"name": "other", "mesh": 0}}, {{"name": "loose", "mesh": 0}}],
        "scenes": [{{"nodes": [2]}}, {{"nodes": [0]}}], "scene": 1,
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {position}}}}}]}}]"#
    );
    let parts =
        |rest: &str| -> Vec<String> { file.scene(rest).parts.iter().map(|part| part.name.clone()).collect() };
    assert_eq!(parts(&rest), ["child"]);
    assert_eq!(parts(&rest.replace(r#", "scene": 1"#, "")), ["other"], "the first one");
    let none = rest.replace(r#""scenes": [{"nodes": [2]}, {"nodes": [0]}], "scene": 1,"#, "");
    assert_eq!(parts(&none), ["child", "other", "loose"]);
    let scene = file.scene(&rest);
    assert_eq!(scene.nodes.len(), 4, "joints may be anywhere");
    let notes: Vec<String> = scene.notes.iter().map(ToString::to_string).collect();
    assert!(
        ["node 2", "node 3"].iter().all(|node| notes.iter().any(|note| note.contains(node))),
        "{notes:?}"
    );
    let lost = rest.replace(r#""scene": 1"#, r#""scene": 2"#);
    assert_eq!(parts(&lost), ["child", "other", "loose"]);
    assert!(
        file.scene(&lost).notes.iter().any(|note| note.finding.to_string().contains("scene 2 is not there"))
    );
    assert_eq!(file.error(&rest.replace(r#"{"nodes": [0]}"#, r#"{"nodes": [9]}"#)).place, "nodes");
}

#[test]
fn vertices_that_are_no_numbers_are_errors() {
    let mut file = Builder::default();
    let position = file.floats(&[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0], "VEC3");
    let error = file.error(&one_primitive(&format!(r#"{{"attributes": {{"POSITION": {position}}}}}"#)));
    assert!(error.place.starts_with("part 0") && error.found.contains("vertex 1"), "{error}");
}

#[test]
fn materials_arrive_and_what_they_cannot_say_is_noted() {
    let json = r#"{"asset": {"version": "2.0"}, "images": [{"uri": "data:image/png;base64,Zm9v", "name": "pores"}],
        "samplers": [{"wrapS": 33071}], "textures": [{}, {"source": 0, "sampler": 0}], "materials": [{}, {"name": "skin",
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
        "baseColorTexture": {"index": 1, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}},
        "metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 1, "scale": 0.7, "texCoord": 1}, "occlusionTexture": {"index": 1, "strength": 0.8},
        "emissiveTexture": {"index": 1}, "emissiveFactor": [1, 0, 0], "alphaMode": "MASK", "alphaCutoff": 0.25,
        "doubleSided": true, "extensions": {"KHR_materials_sheen": {}}}]}"#;
    let scene = crate::support::gltf::read(json.as_bytes()).expect("a scene");
    assert_eq!(scene.materials[0], Material::default());
    let wrap = [Wrap::Clamp, Wrap::Repeat];
    let expected = Material {
        name: "skin".to_owned(),
        base_color: [0.1, 0.2, 0.3, 0.4],
        base_color_texture: Some(TextureRef { wrap, ..TextureRef::from(0) }),
        metallic: 0.5,
        roughness: 0.6,
        metallic_roughness_texture: None,
        normal_texture: Some(TextureRef { uvs: UvSet::Second, wrap, image: 0 }),
        normal_scale: 0.7,
        occlusion_texture: None,
        occlusion_strength: 0.8,
        emissive: [1.0, 0.0, 0.0],
        emissive_texture: None,
        alpha_mode: AlphaMode::Mask,
        alpha_cutoff: 0.25,
        double_sided: true,
        ..Material::default()
    };
    assert_eq!(scene.materials[1], expected);
    let notes: Vec<_> = scene.notes.iter().map(ToString::to_string).collect();
    for note in [
        "material 1: KHR_materials_sheen is not represented",
        "material 1, emissiveTexture: needs a third set of texture coordinates and is left out",
        "material 1, occlusionTexture: needs a third set of texture coordinates and is left out",
        "material 1, metallicRoughnessTexture: has no image",
    ] {
        assert!(notes.iter().any(|found| found == note), "{note}: {notes:?}");
    }
    for (right, lie, place) in [
        (r#""source": 0"#, r#""source": 1"#, "material 1 'skin'"),
        (r#""index": 1, "strength""#, r#""index": 2, "strength""#, "textures"),
        (r#""sampler": 0"#, r#""sampler": 1"#, "samplers"),
        ("0.6", "1e39", "JSON, line 3, column 120"),
        ("MASK", "NONE", "material 1"),
    ] {
        let error = crate::support::gltf::read(json.replace(right, lie).as_bytes()).expect_err("an error");
        assert_eq!(error.place, place, "{error}");
    }
}
