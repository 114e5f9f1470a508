//! Small files made here: hierarchies, matrices, interpolation, normals under uneven scale.

use crate::support::gltf::{Builder, U8, one_primitive};
use avatar_exchange::{Scene, Transform};
use avatar_mesh::deform;
use glam::{DVec3, Quat, Vec3};

/// A scene in which one channel of one clip moves node 0.
fn moved(path: &str, interpolation: &str, times: &[f32], values: &[f32], type_: &str) -> Scene {
    let mut file = Builder::default();
    let (times, values) = (file.floats(times, "SCALAR"), file.floats(values, type_));
    file.scene(&format!(
        r#""nodes": [{{"translation": [7, 0, 0]}}], "animations": [{{"name": "Wave",
        "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "{path}"}}}}],
        "samplers": [{{"input": {times}, "output": {values}, "interpolation": "{interpolation}"}}]}}]"#
    ))
}

fn position(scene: &Scene, time_secs: f64) -> Vec3 {
    scene.worlds(&scene.at(0, time_secs).expect("a clip"))[0].translation.as_vec3()
}

#[test]
fn step_holds_and_linear_goes_straight() {
    let values = [0.0, 0.0, 0.0, 2.0, 4.0, 6.0];
    let step = moved("translation", "STEP", &[1.0, 3.0], &values, "VEC3");
    let linear = moved("translation", "LINEAR", &[1.0, 3.0], &values, "VEC3");
    let last = Vec3::new(2.0, 4.0, 6.0);
    for scene in [&step, &linear] {
        for (time, expected) in
            [(-5.0, Vec3::ZERO), (0.0, Vec3::ZERO), (1.0, Vec3::ZERO), (3.0, last), (9.0, last)]
        {
            assert_eq!(position(scene, time), expected, "at {time}");
        }
        assert_eq!(position(scene, f64::NAN), Vec3::ZERO);
        assert_eq!(scene.clips[0].duration_secs(), 3.0);
    }
    assert_eq!(position(&step, 2.9), Vec3::ZERO);
    assert_eq!(position(&linear, 1.5), last * 0.25);
    assert_eq!(step.worlds(&step.rest())[0].translation, DVec3::X * 7.0);
    assert!(step.at(1, 0.0).is_err());
}

#[test]
fn cubic_splines_use_their_tangents() {
    // x: in-tangent, value, out-tangent. From 1 with slope 2 to 5 with slope -1, within 2 seconds.
    let mut values = Vec::new();
    for [a, v, b] in [[99.0, 1.0, 2.0], [-1.0, 5.0, 99.0]] {
        values.extend([a, 0.0, 0.0, v, 0.0, 0.0, b, 0.0, 0.0]);
    }
    let scene = moved("translation", "CUBICSPLINE", &[1.0, 3.0], &values, "VEC3");
    let (mean, slope) = (3.0, (2.0 - -1.0) * 2.0 / 8.0);
    assert!((position(&scene, 2.0).x - (mean + slope)).abs() < 1e-6);
    let h = 1e-3;
    let slope_at =
        |time: f64| f64::from(position(&scene, time + h).x - position(&scene, time - h).x) / (2.0 * h);
    assert!((slope_at(1.0 + h) - 2.0).abs() < 0.02, "{}", slope_at(1.0 + h));
    assert!((slope_at(3.0 - h) + 1.0).abs() < 0.02, "{}", slope_at(3.0 - h));
    assert_eq!((position(&scene, 0.0).x, position(&scene, 4.0).x), (1.0, 5.0));
}

#[test]
fn rotations_take_the_shorter_arc() {
    let to = -Quat::from_rotation_z(2.0);
    let values: Vec<f32> = Quat::IDENTITY.to_array().into_iter().chain(to.to_array()).collect();
    let scene = moved("rotation", "LINEAR", &[0.0, 1.0], &values, "VEC4");
    for s in [0.0, 0.1, 0.5, 0.9, 1.0] {
        let Transform::Trs(trs) = scene.at(0, s).expect("a clip").locals[0] else { panic!("a matrix") };
        let expected = Quat::from_rotation_z((2.0 * s) as f32);
        assert!(trs.rotation.dot(expected).abs() > 1.0 - 1e-6, "{s}: {}", trs.rotation);
        let turned = trs.rotation * Vec3::X;
        assert!(turned.distance(expected * Vec3::X) < 1e-6, "{s}: {turned}");
    }
}

#[test]
fn weights_move_with_one_value_for_each_target() {
    let mut file = Builder::default();
    let (position, times) = (file.triangle(), file.floats(&[0.0, 1.0], "SCALAR"));
    let values = file.accessor_with(&[0, 255, 51, 0], U8, "SCALAR", 4, r#", "normalized": true"#);
    let primitive = format!(
        r#"{{"attributes": {{"POSITION": {position}}}, "targets": [{{"POSITION": {position}}}, {{}}]}}"#
    );
    let rest = format!(
        r#"{}, "animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 0, "path": "weights"}}}}],
        "samplers": [{{"input": {times}, "output": {values}}}]}}]"#,
        one_primitive(&primitive)
    );
    let scene = file.scene(&rest);
    assert_eq!(scene.at(0, 0.5).expect("a clip").weights, [[0.1, 0.5]]);
    assert_eq!(scene.rest().weights, [[0.0, 0.0]]);
}

#[test]
fn channels_that_do_not_fit_are_errors_with_their_place() {
    let file = |times: &[f32], values: &[f32], node: &str| {
        let mut file = Builder::default();
        let (times, values) = (file.floats(times, "SCALAR"), file.floats(values, "VEC3"));
        file.error(&format!(
            r#""nodes": [{node}], "animations": [{{"name": "Wave",
            "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "scale"}}}}],
            "samplers": [{{"input": {times}, "output": {values}}}]}}]"#
        ))
    };
    let two = [1.0; 6];
    let sheared = r#"{"matrix": [1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1]}"#;
    for (times, values, node) in [
        (&[0.0][..], &two[..], "{}"),
        (&[1.0, 0.5], &two, "{}"),
        (&[0.0, f32::NAN], &two, "{}"),
        (&[0.0, f32::INFINITY], &two, "{}"),
        (&[0.0, 1.0], &[1.0, 1.0, f32::NAN, 1.0, 1.0, 1.0], "{}"),
        (&[0.0, 1.0], &two, sheared),
    ] {
        let error = file(times, values, node);
        assert_eq!(error.place, "animation 'Wave', channel 0", "{error}");
        assert_eq!(error.file, "test");
    }
}

#[test]
fn channels_without_a_node_are_left_out() {
    let mut file = Builder::default();
    let (times, values) = (file.floats(&[0.0], "SCALAR"), file.floats(&[1.0; 3], "VEC3"));
    let channel = |target: &str| format!(r#"{{"sampler": 0, "target": {{{target}}}}}"#);
    let scene = file.scene(&format!(
        r#""nodes": [{{"extras": {{"a": [1]}}}}], "animations": [{{"channels": [{}, {}, {}],
        "samplers": [{{"input": {times}, "output": {values}}}]}}]"#,
        channel(r#""path": "scale""#),
        channel(r#""node": 0, "path": "translation""#),
        channel(r#""node": 0, "path": "pointer""#),
    ));
    assert_eq!(position(&scene, 0.0), Vec3::ONE);
    assert_eq!((scene.clips[0].channels.len(), scene.notes.len()), (1, 2), "{:?}", scene.notes);
}

#[test]
fn children_may_stand_before_parents_and_roots_may_be_many() {
    let scene = Builder::default().scene(
        r#""nodes": [{"translation": [0, 0, 1]}, {"children": [0], "translation": [0, 1, 0]},
        {"children": [1], "scale": [2, 2, 2]}, {"translation": [5, 5, 5]}]"#,
    );
    let at = |node: usize| scene.worlds(&scene.rest())[node].translation;
    assert_eq!(
        [at(0), at(1), at(3)],
        [DVec3::new(0.0, 2.0, 2.0), DVec3::new(0.0, 2.0, 0.0), DVec3::splat(5.0)]
    );
    let place = |node: usize| scene.order().iter().position(|n| *n == node).expect("all nodes");
    assert!(place(2) < place(1) && place(1) < place(0));
    assert_eq!(scene.order().len(), 4);
}

#[test]
fn matrices_decompose_where_they_can() {
    let scene = Builder::default().scene(
        r#""nodes": [{"matrix": [0,2,0,0, -2,0,0,0, 0,0,-2,0, 1,2,3,1]}, {"matrix": [1,0,0,0, 1,1,0,0, 0,0,1,0, 1,2,3,1]},
        {"matrix": [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1]}]"#,
    );
    let worlds = scene.worlds(&scene.rest());
    assert!(matches!(scene.nodes[0].local, Transform::Trs(_)));
    assert!(worlds[0].transform_point3(DVec3::ONE).distance(DVec3::new(-1.0, 4.0, 1.0)) < 1e-6);
    assert!(matches!(scene.nodes[1].local, Transform::Matrix(_)));
    assert_eq!(worlds[1].transform_point3(DVec3::ONE), DVec3::new(3.0, 3.0, 4.0));
    assert_eq!(worlds[2].transform_point3(DVec3::ONE), DVec3::ZERO);
    let error = Builder::default().error(r#""nodes": [{"matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]"#);
    assert_eq!(error.place, "node 0");
}

#[test]
fn normals_stay_upright_under_uneven_scale() {
    let mut file = Builder::default();
    // A slope of 45° about z, stretched and mirrored along x.
    let position = file.floats(&[0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0], "VEC3");
    let primitive = format!(r#"{{"attributes": {{"POSITION": {position}}}}}"#);
    for scale in [3.0f32, -3.0] {
        let rest = one_primitive(&primitive)
            .replace(r#"{"mesh": 0}"#, &format!(r#"{{"mesh": 0, "scale": [{scale}, 1, 1]}}"#));
        let scene = file.scene(&rest);
        let (mesh, bones) = (&scene.parts[0].mesh, scene.bones(&scene.rest()));
        let mut deformed = mesh.deformed();
        deform(mesh, scene.bones_of(0, &bones), &[], &mut deformed).expect("it fits");
        let [a, b, c] = [0, 1, 2].map(|corner| deformed.positions[corner]);
        for normal in deformed.normals {
            assert!(normal.dot(b - a).abs() < 1e-6 && normal.dot(c - a).abs() < 1e-6, "{normal}");
            assert!(normal.is_normalized() && (normal.y > 0.0) == (mesh.normals[0].y > 0.0), "{normal}");
        }
    }
}
