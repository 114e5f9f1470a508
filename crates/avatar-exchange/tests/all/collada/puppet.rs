//! A point with a morph in a skin: bones, shapes, clips.

use super::{close, load, moved, note};
use avatar_exchange::Transform;
use glam::{Quat, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A point with a morph in a skin: the joints stand at 0 and at (0, 1, 0), the mesh is bound 1 to the right.
pub(super) fn puppet(method: &str, weights: &str) -> String {
    let points = |id: &str, x: f32| {
        format!(
            "<geometry id='{id}' name='{id}'><mesh><source id='{id}p'><float_array id='{id}a' count='9'>{x} 0 0 1 1 0 0 1 0</float_array>
            <technique_common><accessor source='#{id}a' count='3' stride='3'/></technique_common></source>
            <vertices id='{id}v'><input semantic='POSITION' source='#{id}p'/></vertices>
            <triangles count='1'><input semantic='VERTEX' source='#{id}v' offset='0'/><p>0 1 2</p></triangles></mesh></geometry>"
        )
    };
    let floats = |id: &str, stride: usize, text: &str| {
        let count = text.split_whitespace().count();
        format!(
            "<source id='{id}'><float_array id='{id}-a' count='{count}'>{text}</float_array><technique_common><accessor source='#{id}-a' count='{}' stride='{stride}'/></technique_common></source>",
            count / stride
        )
    };
    let names = |id: &str, text: &str| {
        let count = text.split_whitespace().count();
        format!(
            "<source id='{id}'><Name_array id='{id}-a' count='{count}'>{text}</Name_array><technique_common><accessor source='#{id}-a' count='{count}'/></technique_common></source>"
        )
    };
    let inverse = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1  1 0 0 0 0 1 0 -1 0 0 1 0 0 0 0 1";
    format!(
        "<COLLADA version='1.4.1'>
        <library_geometries>{base}{other}</library_geometries>
        <library_controllers>
          <controller id='m'><morph source='#base' method='{method}'>{targets}{morph_weights}
            <targets><input semantic='MORPH_TARGET' source='#mt'/><input semantic='MORPH_WEIGHT' source='#mw'/></targets></morph></controller>
          <controller id='k'><skin source='#m'><bind_shape_matrix>1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>
            {joints}{inverses}{skin_weights}
            <joints><input semantic='JOINT' source='#kj'/><input semantic='INV_BIND_MATRIX' source='#ki'/></joints>
            <vertex_weights count='3'><input semantic='JOINT' source='#kj' offset='0'/><input semantic='WEIGHT' source='#kw' offset='1'/>{weights}</vertex_weights>
          </skin></controller>
        </library_controllers>
        <library_animations><animation id='a'>
          {times}{turn}{step}{move}{lift}{tangents_in}{tangents_out}{bezier}
          <sampler id='s0'><input semantic='INPUT' source='#at'/><input semantic='OUTPUT' source='#ar'/></sampler>
          <channel source='#s0' target='knee/turn.ANGLE'/>
          <sampler id='s1'><input semantic='INPUT' source='#at'/><input semantic='OUTPUT' source='#aw'/><input semantic='INTERPOLATION' source='#as'/></sampler>
          <channel source='#s1' target='mw(0)'/>
          <sampler id='s2'><input semantic='INPUT' source='#at'/><input semantic='OUTPUT' source='#ab'/><input semantic='INTERPOLATION' source='#az'/>
            <input semantic='IN_TANGENT' source='#ain'/><input semantic='OUT_TANGENT' source='#aout'/></sampler>
          <channel source='#s2' target='hip/place.X'/>
          <channel source='#s2' target='nobody/place.X'/>
        </animation></library_animations>
        <library_visual_scenes><visual_scene id='s'>
          <node id='hip' sid='j0' type='JOINT'><translate sid='place'>0 0 0</translate>
            <node id='knee' sid='j1' type='JOINT'><translate>0 1 0</translate><rotate sid='turn'>0 0 1 0</rotate></node></node>
          <node id='body'><instance_controller url='#k'><skeleton>#hip</skeleton></instance_controller></node>
        </visual_scene></library_visual_scenes></COLLADA>",
        base = points("base", 0.0),
        other = points("wide", 3.0),
        targets = names("mt", "wide"),
        morph_weights = floats("mw", 1, "0"),
        joints = names("kj", "j0 j1"),
        inverses = floats("ki", 16, inverse),
        skin_weights = floats("kw", 1, "1 0.5"),
        times = floats("at", 1, "0 1"),
        turn = floats("ar", 1, "0 360"),
        step = floats("aw", 1, "0.25 0.75"),
        move = names("as", "STEP STEP"),
        lift = floats("ab", 1, "0 1"),
        tangents_in = floats("ain", 2, "0 0 0.5 1"),
        tangents_out = floats("aout", 2, "0.5 0 0 0"),
        bezier = names("az", "BEZIER BEZIER"),
    )
}

/// The first point follows the hip, the second the knee, the third nothing.
pub(super) const WEIGHTS: &str = "<vcount>1 1 0</vcount><v>0 0 1 1</v>";

#[test]
fn skins_bind_shapes_and_joints() {
    let scene = load(&puppet("NORMALIZED", WEIGHTS));
    let mut pose = scene.rest();
    // The bind shape moves all by 1.
    close(
        &moved(&scene, &pose, 0).iter().flat_map(|p| p.to_array()).collect::<Vec<_>>(),
        &[1.0, 0.0, 0.0, 2.0, 1.0, 0.0, 1.0, 1.0, 0.0],
    );
    let knee = scene.nodes.iter().position(|node| node.name == "knee").unwrap();
    let Transform::Trs(trs) = &mut pose.locals[knee] else { panic!("a matrix") };
    trs.rotation = Quat::from_rotation_z(FRAC_PI_2);
    // (2, 1) is 2 to the right of the knee at (0, 1), then 2 above it. A weight of 0.5, alone, is made 1.
    close(&moved(&scene, &pose, 0)[1].to_array(), &[0.0, 3.0, 0.0]);
    close(&moved(&scene, &pose, 0)[2].to_array(), &[1.0, 1.0, 0.0]);
    note(&scene, "1 points without weights follow the mesh's own node");
}

#[test]
fn nine_bones_become_eight() {
    let of = |count: usize| {
        // The first has a weight of 1, the others of ½.
        let v = "0 0".to_owned() + &" 1 1".repeat(count - 1);
        let weights = format!("<vcount>{count} 1 0</vcount><v>{v} 1 1</v>");
        load(&puppet("NORMALIZED", &weights))
    };
    let five = of(5);
    let skinning = five.parts[0].mesh.skinning.as_ref().unwrap();
    // Of 1 + 4 · ½.
    close(&skinning.weights[0], &[1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0]);
    close(&skinning.more_weights[0], &[1.0 / 6.0, 0.0, 0.0, 0.0]);
    assert!(!five.notes.iter().any(|note| note.finding.to_string().contains("eight bones")));
    let nine = of(9);
    let skinning = nine.parts[0].mesh.skinning.as_ref().unwrap();
    // 1 and seven times ½ of 5 are left.
    close(&skinning.weights[0], &[1.0 / 4.5, 0.5 / 4.5, 0.5 / 4.5, 0.5 / 4.5]);
    close(&skinning.more_weights[0], &[0.5 / 4.5; 4]);
    note(&nine, "1 points have more than eight bones");
    assert!(of(4).parts[0].mesh.skinning.as_ref().unwrap().more_bones.is_empty());
}

#[test]
fn morphs_are_absolute_or_relative() {
    for (method, x) in [("NORMALIZED", 3.0), ("RELATIVE", 3.0)] {
        let scene = load(&puppet(method, WEIGHTS));
        let shape = &scene.parts[0].mesh.shapes[0];
        assert_eq!((shape.name.as_str(), shape.positions.get(0)), ("wide", Some(Vec3::new(x, 0.0, 0.0))));
        let still = if method == "RELATIVE" { Vec3::new(1.0, 1.0, 0.0) } else { Vec3::ZERO };
        assert_eq!(shape.positions.get(1), Some(still));
    }
}

#[test]
fn animations_become_a_clip() {
    let scene = load(&puppet("NORMALIZED", WEIGHTS));
    let [clip] = &scene.clips[..] else { panic!("{} clips", scene.clips.len()) };
    assert_eq!(clip.duration_secs(), 1.0);
    let node = |name: &str| scene.nodes.iter().position(|node| node.name == name).unwrap();
    for (time, weight) in [(0.0, 0.25), (0.5, 0.25), (0.999, 0.25), (1.0, 0.75)] {
        close(&scene.at(0, time).unwrap().weights[node("body")], &[weight]);
    }
    // A whole turn between two keys, which two rotations cannot tell from none.
    let pose = scene.at(0, 0.5).unwrap();
    close(&moved(&scene, &pose, 0)[1].to_array(), &[-1.5, 1.0, 0.0]);
    // B(s) with control values 0 0 1 1 over control times 0 ½ ½ 1: at s = ¼, time 0.296875 and value 0.15625.
    // Lines between 30 samples are a bit off.
    for (time, x) in [(0.0, 0.0), (0.296_875, 0.156_25), (0.5, 0.5), (0.703_125, 0.843_75), (1.0, 1.0)] {
        let pose = scene.at(0, time).unwrap();
        let Transform::Trs(trs) = pose.locals[node("hip")] else { panic!("a matrix") };
        assert!((trs.translation.x - x).abs() < 1e-3, "{time}: {}", trs.translation.x);
    }
    note(&scene, "'nobody/place.X'");
}

#[test]
fn clips_of_the_file_cut_time() {
    let clips = "<library_animation_clips><animation_clip id='late' start='0.5' end='1'><instance_animation url='#a'/></animation_clip></library_animation_clips><library_visual_scenes>";
    let scene = load(&puppet("NORMALIZED", WEIGHTS).replace("<library_visual_scenes>", clips));
    let [clip] = &scene.clips[..] else { panic!("{} clips", scene.clips.len()) };
    assert_eq!((clip.name.as_str(), clip.duration_secs()), ("late", 0.5));
    let Transform::Trs(trs) = scene.at(0, 0.0).unwrap().locals[0] else { panic!("a matrix") };
    close(&trs.translation.to_array(), &[0.5, 0.0, 0.0]);
}
