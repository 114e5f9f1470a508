//! COLLADA: values computed by hand, other people's files, damaged files.

use crate::support::damage::{bounds, damage, files, read_any, triangles};
use crate::support::data::models;
use avatar_exchange::{ImportError, Scene, ScenePose, Transform, collada};
use glam::{DVec3, Quat, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

fn read(file: &str, bytes: &[u8]) -> Result<Scene, ImportError> {
    collada::read(file, bytes, &mut |_| Err("there are no other files".to_owned()))
}

fn load(text: &str) -> Scene {
    read("test.dae", text.as_bytes()).unwrap()
}

fn nodes(nodes: &str) -> String {
    format!(
        "<COLLADA version='1.4.1'><library_visual_scenes><visual_scene id='s'>{nodes}</visual_scene></library_visual_scenes></COLLADA>"
    )
}

fn close(a: &[f32], b: &[f32]) {
    let near = a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(near, "{a:?} is not {b:?}");
}

fn moved(scene: &Scene, pose: &ScenePose, part: usize) -> Vec<Vec3> {
    let bones = scene.bones(pose);
    let mesh = &scene.parts[part].mesh;
    let mut out = mesh.deformed();
    avatar_mesh::deform(mesh, scene.bones_of(part, &bones), scene.weights_of(part, pose), &mut out).unwrap();
    out.positions
}

fn note(scene: &Scene, text: &str) {
    assert!(
        scene.notes.iter().any(|note| note.finding.to_string().contains(text)),
        "{text:?} is not among {:?}",
        scene.notes
    );
}

#[test]
fn all_steps_of_transforms() {
    for (steps, from, to) in [
        ("<matrix>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</matrix>", [1.0, 0.0, 0.0], [6.0, 6.0, 7.0]),
        (
            "<translate>1 2 3</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale>",
            [1.0, 0.0, 0.0],
            [1.0, 4.0, 3.0],
        ),
        // From (0,0,5) to the origin: −z is already there.
        ("<lookat>0 0 5 0 0 0 0 1 0</lookat>", [0.0, 0.0, -5.0], [0.0, 0.0, 0.0]),
        // From (5,0,0) to the origin: −z is −x, and x is −z.
        ("<lookat>5 0 0 0 0 0 0 1 0</lookat>", [1.0, 0.0, -5.0], [0.0, 0.0, -1.0]),
        // The y axis leans by 45° toward x.
        ("<skew>45 0 1 0 1 0 0</skew>", [0.0, 2.0, 3.0], [2.0, 2.0, 3.0]),
    ] {
        let scene = load(&nodes(&format!("<node>{steps}</node>")));
        let point = scene.worlds(&scene.rest())[0].transform_point3(DVec3::from_array(from));
        assert!(point.abs_diff_eq(DVec3::from_array(to), 1e-6), "{steps}: {point}");
    }
}

#[test]
fn units_and_axes_are_converted_by_a_root() {
    for (axis, from, to) in [
        ("Z_UP", [0.0, 0.0, 100.0], [0.0, 1.0, 0.0]),
        ("Z_UP", [0.0, -100.0, 0.0], [0.0, 0.0, 1.0]),
        ("X_UP", [100.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ("X_UP", [0.0, -100.0, 0.0], [1.0, 0.0, 0.0]),
        ("Y_UP", [0.0, 100.0, 0.0], [0.0, 1.0, 0.0]),
    ] {
        for meter in ["0.01", "0,01"] {
            let asset = format!(
                "<asset><unit meter='{meter}'/><up_axis>{axis}</up_axis></asset><library_visual_scenes>"
            );
            let scene = load(&nodes("<node name='hip'/>").replace("<library_visual_scenes>", &asset));
            assert_eq!((scene.nodes.len(), scene.nodes[1].parent), (2, Some(0)));
            let point = scene.worlds(&scene.rest())[1].transform_point3(DVec3::from_array(from));
            assert!(point.abs_diff_eq(DVec3::from_array(to), 1e-6), "{axis}: {point}");
            note(&scene, "converted to metres");
        }
    }
}

#[test]
fn nodes_are_instantiated_and_not_endlessly() {
    let inner = "<node id='a'><translate>1 0 0</translate><instance_node url='#b'/></node><node id='b'><translate>0 1 0</translate></node>";
    let scene = load(&nodes(inner));
    let at: Vec<DVec3> = scene.worlds(&scene.rest()).iter().map(|world| world.translation).collect();
    assert_eq!(at, [DVec3::X, DVec3::X + DVec3::Y, DVec3::Y]);
    let error =
        read("loop.dae", nodes("<node id='a'><instance_node url='#a'/></node>").as_bytes()).unwrap_err();
    assert!(error.expected.contains("at most 65536 nodes"), "{error}");
    // Each of 40 nodes twice the one before.
    let doubled: String = (0..40)
        .map(|k| {
            format!("<node id='n{k}'><instance_node url='#n{0}'/><instance_node url='#n{0}'/></node>", k + 1)
        })
        .collect();
    let error = read_any(read, "double.dae", nodes(&(doubled + "<node id='n40'/>")).as_bytes()).unwrap_err();
    assert!(error.expected.contains("at most 65536 nodes"), "{error}");
    let deep = "<node>".repeat(2000) + &"</node>".repeat(2000);
    let error = read_any(read, "deep.dae", nodes(&deep).as_bytes()).unwrap_err();
    assert!(error.found.contains("nested more than 1024 deep"), "{error}");
}

/// A geometry of the five points (0,0) (2,0) (2,2) (1,0.5) (0,2), of which the fourth dents the outline.
fn dented(primitive: &str) -> String {
    let geometry = format!(
        "<library_geometries><geometry id='g' name='dent'><mesh>
        <source id='p'><float_array id='pa' count='15'>0 0 0 2 0 0 2 2 0 1 0.5 0 0 2 0</float_array>
            <technique_common><accessor source='#pa' count='5' stride='3'/></technique_common></source>
        <source id='n'><float_array id='na' count='3'>0 0 2</float_array>
            <technique_common><accessor source='#na' count='1' stride='3'/></technique_common></source>
        <source id='t'><float_array id='ta' count='4'>0 0.25 1 1</float_array>
            <technique_common><accessor source='#ta' count='2' stride='2'/></technique_common></source>
        <vertices id='v'><input semantic='POSITION' source='#p'/></vertices>{primitive}</mesh></geometry></library_geometries>
        <library_visual_scenes>"
    );
    nodes("<node><instance_geometry url='#g'/></node>").replace("<library_visual_scenes>", &geometry)
}

fn area(scene: &Scene) -> f32 {
    let mesh = &scene.parts[0].mesh;
    let at = |corner: u32| mesh.positions[corner as usize];
    mesh.triangles.iter().map(|[a, b, c]| (at(*b) - at(*a)).cross(at(*c) - at(*a)).z / 2.0).sum()
}

#[test]
fn primitives_of_all_kinds() {
    const VERTEX: &str = "<input semantic='VERTEX' source='#v' offset='0'/>";
    for (primitive, count, expected) in [
        ("<triangles count='1'>I<p>0 1 4</p></triangles>", 1, 2.0),
        // 2·2 less the dent of 2·1.5/2.
        ("<polylist count='1'>I<vcount>5</vcount><p>0 1 2 3 4</p></polylist>", 3, 2.5),
        ("<polygons count='2'>I<p>0 1 2 3 4</p><p>0 1 3</p></polygons>", 4, 3.0),
        ("<polygons count='1'>I<ph><p>0 1 2 3 4</p><h>0 1 3</h></ph></polygons>", 3, 2.5),
        ("<trifans count='1'>I<p>3 4 0 1 2</p></trifans>", 3, 2.5),
        ("<tristrips count='1'>I<p>0 1 4 2</p></tristrips>", 2, 4.0),
    ] {
        let scene = load(&dented(&primitive.replace('I', VERTEX)));
        assert_eq!(triangles(&scene), count, "{primitive}");
        assert!((area(&scene) - expected).abs() < 1e-6, "{primitive}: {}", area(&scene));
        note(&scene, "normals were computed");
        assert!(scene.parts[0].mesh.normals.iter().all(|normal| normal.distance(Vec3::Z) < 1e-6));
    }
}

#[test]
fn inputs_have_offsets_and_corners_that_agree_are_one_vertex() {
    let inputs = "<input semantic='TEXCOORD' source='#t' offset='2' set='1'/><input semantic='NORMAL' source='#n' offset='1'/><input semantic='VERTEX' source='#v' offset='0'/>";
    // Points 0 1 2, then 0 2 4; point 2 has other texture coordinates in the second.
    let indices = "0 0 0 1 0 0 2 0 0  0 0 0 2 0 1 4 0 0";
    let scene = load(&dented(&format!("<triangles count='2'>{inputs}<p>{indices}</p></triangles>")));
    let mesh = &scene.parts[0].mesh;
    assert_eq!((mesh.positions.len(), mesh.triangles.as_slice()), (5, &[[0, 1, 2], [0, 3, 4]][..]));
    assert_eq!([mesh.uvs[2], mesh.uvs[3]], [Vec2::new(0.0, 0.75), Vec2::new(1.0, 0.0)]);
    assert!(mesh.normals.iter().all(|normal| *normal == Vec3::Z));
}

/// A point with a morph in a skin: the joints stand at 0 and at (0, 1, 0), the mesh is bound 1 to the right.
fn puppet(method: &str, weights: &str) -> String {
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
const WEIGHTS: &str = "<vcount>1 1 0</vcount><v>0 0 1 1</v>";

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
fn five_bones_become_four() {
    let five = "<vcount>5 1 0</vcount><v>0 0 1 1 0 1 1 1 0 1 1 1</v>";
    let scene = load(&puppet("NORMALIZED", five));
    let skinning = scene.parts[0].mesh.skinning.as_ref().unwrap();
    // 1, ½, ½, ½ of 2½ are left.
    close(&skinning.weights[0], &[0.4, 0.2, 0.2, 0.2]);
    note(&scene, "1 points had more than 4 bones");
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
    // B(s) with control values 0 0 1 1 over control times 0 ½ ½ 1: at s = ¼, time 0.296875 and value 0.15625. Lines
    // between 30 samples are a bit off.
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

#[test]
fn materials_have_colours_and_textures() {
    let look = "<library_images><image id='i'><init_from>file:///C:/faces/%2e%2e/my%20skin%.PNG</init_from></image></library_images>
        <library_effects><effect id='e'><profile_COMMON>
        <newparam sid='surf'><surface type='2D'><init_from>i</init_from></surface></newparam>
        <newparam sid='samp'><sampler2D><source>surf</source></sampler2D></newparam>
        <technique sid='c'><phong><diffuse><texture texture='samp' texcoord='uv'/></diffuse></phong></technique></profile_COMMON></effect>
        <effect id='f'><profile_COMMON><technique><lambert><diffuse><color>0.5 0.25 0.125 1</color></diffuse>
        <transparent opaque='A_ONE'><color>1 1 1 1</color></transparent><transparency><float>0.75</float></transparency></lambert></technique></profile_COMMON></effect></library_effects>
        <library_materials><material id='skin'><instance_effect url='#e'/></material><material id='lid'><instance_effect url='#f'/></material></library_materials>
        <library_geometries>";
    let bind = "<instance_geometry url='#g'><bind_material><technique_common><instance_material symbol='two' target='#lid'/></technique_common></bind_material></instance_geometry>";
    let text = dented("<triangles count='1' material='two'><input semantic='VERTEX' source='#v' offset='0'/><p>0 1 4</p></triangles>")
        .replace("<library_geometries>", look)
        .replace("<instance_geometry url='#g'/>", bind);
    let mut asked = Vec::new();
    let scene = collada::read("look.dae", text.as_bytes(), &mut |path| {
        asked.push(path.to_owned());
        Ok(vec![1, 2, 3])
    });
    let scene = scene.unwrap();
    assert_eq!(asked, ["my skin%.PNG"]);
    assert_eq!(
        (scene.images[0].bytes.as_slice(), scene.images[0].mime.as_str()),
        (&[1, 2, 3][..], "image/png")
    );
    assert_eq!(scene.materials[0].base_color_texture, Some(0));
    assert_eq!(scene.parts[0].material, Some(1));
    close(&scene.materials[1].base_color, &[0.5, 0.25, 0.125, 0.75]);
    // Without the picture there is a note instead.
    let scene = load(&text);
    assert!(scene.images[0].bytes.is_empty());
    note(&scene, "'my skin%.PNG' was not found");
}

#[test]
fn errors_have_places() {
    for (text, place, expected) in [
        ("", "byte 0", "COLLADA as text"),
        ("PK\u{3}\u{4}", "byte 0", "COLLADA as text"),
        ("<COLLADA>\n<asset>\n", "line 3", "</asset>"),
        ("<svg/>", "line 1, <svg>", "<COLLADA>"),
        (&nodes("<node>\n<translate>1 2</translate></node>"), "line 2, <translate>", "3 numbers"),
        (&nodes("<node>\n\n<rotate>1 2 x 4</rotate></node>"), "line 3, <rotate>", "numbers"),
        (
            &nodes("<node><instance_geometry url='#none'/></node>"),
            "line 1, <instance_geometry>",
            "the '#id' of an element in 'url'",
        ),
        (
            &dented("<triangles><input semantic='VERTEX' source='#v' offset='0'/>\n<p>0 1 5</p></triangles>"),
            "line 9, <p>",
            "an index below 5",
        ),
        (
            &puppet("NORMALIZED", "<vcount>1 1</vcount><v>0 0 1 1</v>"),
            "line 15, <vertex_weights>",
            "weights of 3 points",
        ),
    ] {
        let error = read_any(read, "bad.dae", text.as_bytes()).unwrap_err();
        assert_eq!((error.place.as_str(), error.expected.as_str()), (place, expected), "{error}");
    }
}

/// Boxes are pycollada's, through trimesh, times the unit and with z up turned to y; so are numbers of triangles and
/// of meshes at nodes.
#[test]
fn other_peoples_files_have_the_sizes_that_another_reader_finds() {
    let Some(folder) = models("Collada") else { return };
    for (name, count, parts, low, high) in [
        ("duck.dae", 4212, 1, [-0.692985, 0.0992937, -0.613282], [0.961799, 1.6397, 0.539252]),
        ("COLLADA.dae", 6722, 2, [-4.0, 0.0, -2.0], [4.0, 1.08098, 2.0]),
        ("Cinema4D.dae", 1296, 3, [-100.0; 3], [314.019, 100.0, 310.63]),
        ("ConcavePolygon.dae", 64, 1, [-1.146, 1.6575, 1.6055], [-1.146, 3.1425, 3.0905]),
        ("cube_UTF16LE.dae", 12, 1, [-0.5; 3], [0.5; 3]),
        ("cube_tristrips.dae", 12, 1, [-50.0; 3], [50.0; 3]),
        (
            "anims_with_full_rotations_between_keys.DAE",
            768,
            64,
            [-0.31561, 0.0, -119.68456],
            [0.68595, 1.0, 0.5],
        ),
        ("regr01.dae", 172, 6, [-0.0051, 0.0, 0.0], [0.0078, 0.0162002, 0.0041998]),
        ("teapot_instancenodes.DAE", 2048, 2, [-4.823608, 0.0, -1.236898], [1.798858, 1.741637, 1.040253]),
    ] {
        let scene = read(name, &std::fs::read(folder.join(name)).unwrap()).unwrap();
        assert_eq!((triangles(&scene), scene.parts.len()), (count, parts), "{name}");
        let found = bounds(&scene);
        for (found, expected) in found.into_iter().flatten().zip([low, high].into_iter().flatten()) {
            assert!(
                (found - expected).abs() < 6e-6 * (1.0 + expected.abs()),
                "{name}: {found} is not {expected}"
            );
        }
    }
}

/// The bones of this file stand as they were bound, so that at rest all of them move the mesh alike; one of its clips
/// bends it.
#[test]
fn at_rest_bones_agree() {
    let Some(folder) = models("Collada") else { return };
    let name = "library_animation_clips.dae";
    let scene = read(name, &std::fs::read(folder.join(name)).unwrap()).unwrap();
    let spread = |pose: &ScenePose| {
        let bones = scene.bones(pose);
        let from_first = |bone: &glam::Affine3A| {
            bone.to_cols_array()
                .iter()
                .zip(bones[0].to_cols_array())
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f32::max)
        };
        bones.iter().map(from_first).fold(0.0, f32::max)
    };
    assert_eq!(scene.skins[0].joints.len(), 5);
    assert!(spread(&scene.rest()) < 1e-6);
    let clips: Vec<&str> = scene.clips.iter().map(|clip| clip.name.as_str()).collect();
    assert_eq!(clips, ["bend", "turn"]);
    let end = scene.clips[0].duration_secs();
    assert!(spread(&scene.at(0, 0.5 * end).unwrap()) > 0.1);
}

#[test]
fn other_peoples_files_load_or_are_refused() {
    let Some(folder) = models("Collada") else { return };
    let found = files(&folder, &["dae", "zae", "xml"]);
    assert!(found.len() >= 29, "{found:?}");
    let mut refused = Vec::new();
    for path in found {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if let Err(error) = read_any(read, &name, &std::fs::read(&path).unwrap()) {
            assert_eq!(error.found, "an archive; unpack it first", "{error}");
            refused.push(name);
        }
    }
    assert_eq!(refused, ["duck.zae", "duck_nomanifest.zae", "human.zae"]);
}

#[test]
fn damaged_files_are_refused_or_load() {
    let text = puppet("NORMALIZED", WEIGHTS);
    let all = text.len() / 64 + 1 + 400;
    let loaded = damage(read, "damaged.dae", text.as_bytes(), 400);
    assert!(loaded > 0 && loaded < all, "{loaded} of {all}");
    let Some(folder) = models("Collada") else { return };
    for name in ["cube_tristrips.dae", "box_nested_animation.dae"] {
        damage(read, name, &std::fs::read(folder.join(name)).unwrap(), 100);
    }
}
