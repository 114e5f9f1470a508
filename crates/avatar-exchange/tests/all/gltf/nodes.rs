//! Which meshes nodes show and with which weights: instances, hidden nodes, targets and their names, channels
//! that point at what they move.

use crate::support::gltf::{Builder, I8, one_primitive};
use avatar_exchange::{ChannelTarget, Scene};
use glam::{DVec3, Quat, Vec3};

fn notes(scene: &Scene) -> Vec<String> {
    scene.notes.iter().map(ToString::to_string).collect()
}

fn has_note(scene: &Scene, text: &str) {
    assert!(scene.notes.iter().any(|note| note.to_string().contains(text)), "{text}: {:?}", scene.notes);
}

/// A triangle at a node that is moved, with two instances that are turned, scaled and moved.
fn instanced(attributes: impl Fn([usize; 3]) -> String, node: &str) -> (Builder, String) {
    let mut file = Builder::default();
    let position = file.triangle();
    let moved = file.floats(&[0.0, 0.0, 5.0, 0.0, 0.0, 7.0], "VEC3");
    // Half a turn about y, as normalised bytes, and none.
    let turned = file.accessor_with(&[0, 127, 0, 0, 0, 0, 0, 127], I8, "VEC4", 2, r#", "normalized": true"#);
    let scaled = file.floats(&[2.0, 2.0, 2.0, 1.0, 3.0, 1.0], "VEC3");
    let (times, weights) = (file.floats(&[0.0, 1.0], "SCALAR"), file.floats(&[0.0, 1.0], "SCALAR"));
    let rest = format!(
        r#""nodes": [{{"name": "tree", "translation": [10, 0, 0], "mesh": 0, {node}
        "extensions": {{"EXT_mesh_gpu_instancing": {{"attributes": {{{}}}}}}}}}, {{"name": "last"}}],
        "meshes": [{{"weights": [0.25], "primitives": [{{"attributes": {{"POSITION": {position}}}, "targets": [{{"POSITION": {position}}}]}}]}}],
        "animations": [{{"samplers": [{{"input": {times}, "output": {weights}}}],
        "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "weights"}}}}]}}]"#,
        attributes([moved, turned, scaled])
    );
    (file, rest)
}

/// `world_from_vertex` of an instance is that of its node times its own translation, rotation and scale.
#[test]
fn instances_are_nodes_and_parts() {
    let all = |[t, r, s]: [usize; 3]| format!(r#""TRANSLATION": {t}, "ROTATION": {r}, "SCALE": {s}"#);
    let (file, rest) = instanced(all, "");
    let scene = file.scene(&rest);
    assert_eq!(scene.nodes[1].name, "last", "the file's own nodes keep their numbers");
    let names: Vec<_> = scene.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["tree.1", "tree.2"]);
    let worlds = scene.worlds(&scene.rest());
    let corner = |part: usize, vertex: usize| {
        let part = &scene.parts[part];
        worlds[part.node].transform_point3(part.mesh.positions[vertex].as_dvec3())
    };
    let close =
        |found: DVec3, expected: DVec3| assert!(found.abs_diff_eq(expected, 1e-6), "{found} {expected}");
    close(corner(0, 1), DVec3::new(10.0 - 2.0, 0.0, 5.0));
    close(corner(0, 2), DVec3::new(10.0, 2.0, 5.0));
    close(corner(1, 1), DVec3::new(10.0 + 1.0, 0.0, 7.0));
    close(corner(1, 2), DVec3::new(10.0, 3.0, 7.0));
    // Weights and clips of the node are those of its instances.
    assert_eq!(scene.weights_of(1, &scene.rest()), [0.25]);
    let pose = scene.at(0, 0.5).expect("a clip");
    assert_eq!((scene.weights_of(0, &pose), scene.weights_of(1, &pose)), (&[0.5][..], &[0.5][..]));
}

#[test]
fn instances_of_other_kinds_are_noted_or_errors() {
    let (file, rest) = instanced(|[t, _, _]| format!(r#""TRANSLATION": {t}, "_ID": 0"#), "");
    let scene = file.scene(&rest);
    assert_eq!(scene.parts.len(), 2);
    has_note(&scene, "node 0, EXT_mesh_gpu_instancing: '_ID' of its instances is left out");
    // Nothing that says how many there are.
    let (file, rest) = instanced(|_| String::new(), "");
    assert_eq!(file.scene(&rest).parts.len(), 1);
    let (file, rest) = instanced(|[t, _, _]| format!(r#""TRANSLATION": {t}"#), r#""skin": 0,"#);
    let scene = file.scene(&format!(r#"{rest}, "skins": [{{"joints": [1]}}]"#));
    assert_eq!(scene.parts.len(), 1);
    has_note(&scene, "its mesh has a skin: instances are left out");
    let place = "node 0, EXT_mesh_gpu_instancing";
    let (file, rest) = instanced(|[t, _, _]| format!(r#""TRANSLATION": {t}, "SCALE": 0"#), "");
    let error = file.error(&rest);
    assert_eq!((error.place.as_str(), error.found.as_str()), (place, "3"), "{error}");
    let (file, rest) = instanced(|_| r#""TRANSLATION": "x""#.to_owned(), "");
    assert_eq!(file.error(&rest).place, place);
}

/// A few bytes can claim millions of instances.
#[test]
fn instances_are_limited_by_the_size_of_the_file() {
    let mut file = Builder::default();
    let position = file.triangle();
    let many = file.raw_accessor(r#"{"componentType": 5126, "type": "VEC3", "count": 4000000}"#.to_owned());
    let rest = format!(
        r#""nodes": [{{"mesh": 0, "extensions": {{"EXT_mesh_gpu_instancing": {{"attributes": {{"TRANSLATION": {many}}}}}}}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {position}}}}}]}}]"#
    );
    assert!(file.error(&rest).expected.contains("in a file of this size"));
}

#[test]
fn hidden_nodes_keep_their_places_and_lose_their_meshes() {
    let mut file = Builder::default();
    let position = file.triangle();
    let hidden = r#""extensions": {"KHR_node_visibility": {"visible": false}}"#;
    let shown = r#""extensions": {"KHR_node_visibility": {"visible": true}}"#;
    // Below a hidden node, one that says it is visible is hidden, too.
    let rest = format!(
        r#""nodes": [{{"name": "a", "children": [1, 3], {hidden}}}, {{"name": "b", "children": [2], "mesh": 0, {shown}}},
        {{"name": "c", "mesh": 0}}, {{"name": "d", "translation": [0, 1, 0]}}, {{"name": "e", "mesh": 0, {shown}}}],
        "scenes": [{{"nodes": [0, 4]}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {position}}}}}]}}]"#
    );
    for rest in [rest.clone(), rest.replace(r#""scenes": [{"nodes": [0, 4]}],"#, "")] {
        let scene = file.scene(&rest);
        assert_eq!(scene.parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["e"]);
        assert_eq!(scene.nodes.len(), 5);
        assert_eq!(scene.worlds(&scene.rest())[3].translation, DVec3::Y);
        for node in [1, 2] {
            has_note(&scene, &format!("node {node}: is hidden, or below a hidden one: its mesh is left out"));
        }
    }
}

/// A mesh of two primitives of which only one has targets; `weights` of the mesh and of the nodes.
#[test]
fn primitives_without_targets_rest() {
    let mut file = Builder::default();
    let position = file.triangle();
    let still = format!(r#"{{"attributes": {{"POSITION": {position}}}}}"#);
    let target = format!(r#"{{"POSITION": {position}}}"#);
    let moving = format!(r#"{{"attributes": {{"POSITION": {position}}}, "targets": [{target}, {target}]}}"#);
    let less = format!(r#"{{"attributes": {{"POSITION": {position}}}, "targets": [{target}]}}"#);
    for (primitives, rests) in [([&still, &moving], [2, 0]), ([&moving, &less], [0, 1])] {
        let [first, second] = primitives;
        let scene = file.scene(&format!(
            r#""nodes": [{{"mesh": 0}}], "meshes": [{{"weights": [0, 0.5], "primitives": [{first}, {second}],
            "extras": {{"targetNames": ["up", "down"]}}}}]"#
        ));
        for (part, resting) in scene.parts.iter().zip(rests) {
            let names: Vec<_> = part.mesh.shapes.iter().map(|shape| shape.name.as_str()).collect();
            assert_eq!(names, ["up", "down"]);
            let still = part.mesh.shapes.iter().filter(|shape| shape.positions.moved_vertices() == 0).count();
            assert_eq!(still, resting);
            if resting > 0 {
                let place = format!("mesh 0, primitive {}: has {} targets of 2", part.primitive, 2 - resting);
                has_note(&scene, &place);
            }
        }
        assert_eq!(scene.weights_of(0, &scene.rest()), [0.0, 0.5]);
    }
}

/// Two nodes show one mesh: the one has its own weights, the other those of the mesh (section 3.7.2.2).
#[test]
fn weights_of_a_node_come_before_those_of_its_mesh() {
    let mut file = Builder::default();
    let position = file.triangle();
    let up = file.floats(&[0.0, 3.0, 0.0].repeat(3), "VEC3");
    let back = file.floats(&[0.0, 0.0, 1.0].repeat(3), "VEC3");
    let scene = file.scene(&format!(
        r#""nodes": [{{"mesh": 0, "weights": [0, 1]}}, {{"mesh": 0}}], "meshes": [{{"weights": [0.5, 0.5],
        "primitives": [{{"attributes": {{"POSITION": {position}}}, "targets": [{{"POSITION": {back}}}, {{"POSITION": {up}}}]}}]}}]"#
    ));
    let (pose, bones) = (scene.rest(), scene.bones(&scene.rest()));
    let first = |part: usize| {
        let mesh = &scene.parts[part].mesh;
        let mut out = mesh.deformed();
        let weights = scene.weights_of(part, &pose);
        avatar_mesh::deform(mesh, scene.bones_of(part, &bones), weights, &mut out).expect("it fits");
        out.positions[0]
    };
    assert_eq!((first(0), first(1)), (Vec3::new(0.0, 3.0, 0.0), Vec3::new(0.0, 1.5, 0.5)));
}

/// The names of two targets in a file that has them at these places.
fn target_names(mesh: &str, primitive: &str, accessors: [&str; 2]) -> Vec<String> {
    let mut file = Builder::default();
    let position = file.triangle();
    let moved = accessors.map(|name| {
        let name = if name.is_empty() { String::new() } else { format!(r#", "name": "{name}""#) };
        file.accessor_with(&[0; 36], 5126, "VEC3", 3, &name)
    });
    let targets = format!(r#"[{{"POSITION": {}}}, {{"POSITION": {}}}]"#, moved[0], moved[1]);
    let scene = file.scene(&format!(
        r#""nodes": [{{"mesh": 0}}], "meshes": [{{{mesh} "primitives": [
        {{{primitive} "attributes": {{"POSITION": {position}}}, "targets": {targets}}}]}}]"#
    ));
    scene.parts[0].mesh.shapes.iter().map(|shape| shape.name.clone()).collect()
}

#[test]
fn names_of_targets_are_found_where_programs_write_them() {
    let (mesh, primitive) = (
        r#""extras": {"targetNames": ["jawOpen", "smile"]},"#,
        r#""extras": {"targetNames": ["Fcl_A", "Fcl_I"]},"#,
    );
    let accessors = ["face.jaw", "face.smile"];
    assert_eq!(target_names(mesh, primitive, accessors), ["jawOpen", "smile"]);
    // VRM 0.x: "Morph target names are saved in /meshes/*/primitives/*/extras/targetNames".
    assert_eq!(target_names("", primitive, accessors), ["Fcl_A", "Fcl_I"]);
    assert_eq!(target_names("", "", accessors), accessors);
    // Names that tell nothing apart are none.
    assert_eq!(target_names("", "", ["positions", "positions"]), ["target 0", "target 1"]);
    assert_eq!(target_names("", "", ["positions", ""]), ["target 0", "target 1"]);
    let broken = r#""extras": {"targetNames": "jawOpen"},"#;
    assert_eq!(target_names(broken, "", ["", ""]), ["target 0", "target 1"]);
}

#[test]
fn what_else_targets_move_is_noted() {
    let mut file = Builder::default();
    let position = file.triangle();
    let target = format!(r#"{{"POSITION": {position}, "TEXCOORD_0": {position}, "extras": {{"x": 1}}}}"#);
    let primitive = format!(r#"{{"attributes": {{"POSITION": {position}}}, "targets": [{target}]}}"#);
    let scene = file.scene(&one_primitive(&primitive));
    let of_targets: Vec<_> = notes(&scene).into_iter().filter(|note| note.contains("targets")).collect();
    assert_eq!(of_targets, ["meshes, targets: 'TEXCOORD_0' is left out"]);
}

/// Pointer, times, values, their type and how to interpolate.
type Pointed<'p> = (&'p str, &'p [f32], &'p [f32], &'p str, &'p str);

/// Two nodes that show a mesh of two targets, the second with weights of its own, and channels by pointer.
fn pointed(channels: &[Pointed<'_>]) -> (Builder, String) {
    let mut file = Builder::default();
    let position = file.triangle();
    let (mut samplers, mut targets) = (Vec::new(), Vec::new());
    for (number, (pointer, times, values, type_, interpolation)) in channels.iter().enumerate() {
        let (times, values) = (file.floats(times, "SCALAR"), file.floats(values, type_));
        samplers
            .push(format!(r#"{{"input": {times}, "output": {values}, "interpolation": "{interpolation}"}}"#));
        targets.push(format!(
            r#"{{"sampler": {number}, "target": {{"path": "pointer", "extensions": {{"KHR_animation_pointer": {{"pointer": "{pointer}"}}}}}}}}"#
        ));
    }
    let rest = format!(
        r#""nodes": [{{"mesh": 0}}, {{"mesh": 0, "weights": [0, 1]}}, {{"mesh": 0}}], "meshes": [{{"weights": [0.5, 0.25], "primitives": [
        {{"attributes": {{"POSITION": {position}}}, "targets": [{{"POSITION": {position}}}, {{"POSITION": {position}}}]}}]}}],
        "animations": [{{"samplers": [{}], "channels": [{}]}}]"#,
        samplers.join(", "),
        targets.join(", ")
    );
    (file, rest)
}

#[test]
fn pointers_move_nodes_and_weights() {
    let (file, rest) = pointed(&[
        ("/nodes/1/rotation", &[0.0], &[0.0, 1.0, 0.0, 0.0], "VEC4", "LINEAR"),
        ("/nodes/1/scale", &[0.0], &[2.0, 3.0, 4.0], "VEC3", "STEP"),
        ("/nodes/1/weights", &[0.0, 1.0], &[0.0, 0.0, 1.0, 0.5], "SCALAR", "LINEAR"),
        ("/meshes/0/weights", &[0.0, 1.0], &[1.0, 1.0, 0.0, 0.5], "SCALAR", "LINEAR"),
    ]);
    let scene = file.scene(&rest);
    let pose = scene.at(0, 0.5).expect("a clip");
    let (scale, rotation, _) = scene.worlds(&pose)[1].to_scale_rotation_translation();
    assert_eq!(scale.as_vec3(), Vec3::new(2.0, 3.0, 4.0));
    assert!(rotation.as_quat().abs_diff_eq(Quat::from_xyzw(0.0, 1.0, 0.0, 0.0), 1e-6));
    // A mesh's weights are those of the nodes that have none of their own.
    assert_eq!(pose.weights, [vec![0.5, 0.75], vec![0.5, 0.25], vec![0.5, 0.75]]);
}

#[test]
fn pointers_to_single_weights_make_one_channel() {
    let linear = |keys: &'static [f32], values: &'static [f32]| (keys, values, "SCALAR", "LINEAR");
    let channel =
        |pointer, (keys, values, type_, interpolation)| (pointer, keys, values, type_, interpolation);
    let (file, rest) = pointed(&[
        channel("/nodes/0/weights/1", linear(&[0.0, 2.0], &[0.0, 1.0])),
        channel("/nodes/1/weights/0", linear(&[0.0, 2.0], &[0.0, 1.0])),
        channel("/nodes/1/weights/1", linear(&[1.0, 3.0], &[0.0, 1.0])),
    ]);
    let scene = file.scene(&rest);
    assert!(scene.clips[0].channels.iter().all(|channel| channel.target == ChannelTarget::Weights));
    assert_eq!(scene.clips[0].channels.len(), 2);
    for (time, expected) in [(0.0, [0.0, 0.0]), (1.5, [0.75, 0.25]), (2.5, [1.0, 0.75]), (9.0, [1.0, 1.0])] {
        let pose = scene.at(0, time).expect("a clip");
        assert_eq!(pose.weights[1], expected, "at {time}");
        // What no channel moves is at rest.
        assert_eq!(pose.weights[0], [0.5, (time as f32 / 2.0).min(1.0)], "at {time}");
    }
    // A spline of in-tangent, value and out-tangent, whose other weight rests.
    let spline: &[f32] = &[0.0, 0.0, 1.0, 1.0, 1.0, 0.0];
    let (file, rest) = pointed(&[("/meshes/0/weights/0", &[0.0, 1.0], spline, "SCALAR", "CUBICSPLINE")]);
    let pose = file.scene(&rest).at(0, 0.5).expect("a clip");
    assert_eq!((pose.weights[0][0], pose.weights[0][1], pose.weights[1][0]), (0.5, 0.25, 0.0));
    // It has keys of its own, which a line cannot follow.
    let (file, rest) = pointed(&[
        channel("/nodes/0/weights/0", linear(&[0.0, 2.0], &[0.0, 1.0])),
        ("/nodes/0/weights/1", &[0.0, 1.0], spline, "SCALAR", "CUBICSPLINE"),
    ]);
    let scene = file.scene(&rest);
    assert_eq!(scene.at(0, 1.0).expect("a clip").weights[0], [0.5, 0.25]);
    has_note(&scene, "animation 0, channel 1: moves one weight between other keys");
}

#[test]
fn other_pointers_are_noted_and_wrong_ones_are_errors() {
    let keys: (&[f32], &[f32]) = (&[0.0], &[1.0]);
    let one = |pointer: &'static str| pointed(&[(pointer, keys.0, keys.1, "SCALAR", "STEP")]);
    for pointer in
        ["/materials/0/alphaCutoff", "/nodes/0/extensions/KHR_node_visibility/visible", "", "/nodes/0"]
    {
        let (file, rest) = one(pointer);
        let scene = file.scene(&rest);
        assert!(scene.clips[0].channels.is_empty());
        has_note(&scene, &format!("animation 0: moves '{pointer}', which is not represented"));
    }
    for (pointer, place) in [
        ("/nodes/9/weights/0", "animation 0, channel 0"),
        ("/nodes/0/weights/2", "animation 0, channel 0"),
        ("/meshes/9/weights", "animation 0, channel 0, meshes"),
    ] {
        let (file, rest) = one(pointer);
        assert_eq!(file.error(&rest).place, place, "{pointer}");
    }
    // A mesh that only nodes with weights of their own show.
    let (file, rest) = one("/meshes/0/weights/0");
    let rest = rest.replace(r#"{"mesh": 0}"#, r#"{"mesh": 0, "weights": [0, 0]}"#);
    has_note(
        &file.scene(&rest),
        "animation 0, channel 0: moves the weights of a mesh that no node shows with them",
    );
}
