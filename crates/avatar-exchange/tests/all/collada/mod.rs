//! COLLADA: values computed by hand, other people's files, damaged files.

mod others;
mod puppet;
mod surface;

use crate::support::damage::{read_any, triangles};
use avatar_exchange::{ImportError, Scene, ScenePose, TextureRef, Wrap, collada};
use glam::{DVec3, Vec2, Vec3};
use puppet::puppet;

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
    assert_eq!(scene.materials[0].base_color_texture, Some(0.into()));
    assert_eq!(scene.parts[0].material, Some(1));
    for (s, t, wrap, noted) in [
        ("WRAP", "MIRROR", [Wrap::Repeat, Wrap::Mirror], None),
        ("CLAMP", "BORDER", [Wrap::Clamp, Wrap::Clamp], Some("'BORDER' is taken as CLAMP")),
        ("MIRROR", "round", [Wrap::Mirror, Wrap::Repeat], Some("'round' is taken as WRAP")),
    ] {
        let wraps = format!("</source><wrap_s>{s}</wrap_s><wrap_t>{t}</wrap_t></sampler2D>");
        let wrapped = text.replace("</source></sampler2D>", &wraps);
        assert_ne!(wrapped, text);
        let scene = load(&wrapped);
        let expected = TextureRef { wrap, ..TextureRef::from(0) };
        assert_eq!(scene.materials[0].base_color_texture, Some(expected), "{s}, {t}");
        noted.into_iter().for_each(|noted| note(&scene, noted));
    }
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
            &dented("<triangles/>").replace("</node>", "<instance_geometry url='#none'/></node>"),
            "line 9, <instance_geometry>",
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

#[test]
fn skeletons_come_without_meshes() {
    const BONES: &str = "<node id='hip' type='JOINT'><translate>0 1 0</translate>\
        <node id='knee' type='JOINT'><translate>0 2 0</translate></node></node>";
    let skeleton = |scene: &Scene| {
        let worlds = scene.worlds(&scene.rest());
        assert_eq!((scene.nodes[1].name.as_str(), scene.parts.len()), ("knee", 0));
        assert_eq!(worlds[1].translation, DVec3::new(0.0, 3.0, 0.0));
    };
    skeleton(&load(&nodes(BONES)));
    // Nodes of the library, shown by no scene.
    let library = format!("<COLLADA version='1.4.1'><library_nodes>{BONES}</library_nodes></COLLADA>");
    let scene = load(&library);
    skeleton(&scene);
    note(&scene, "no visual scene, so all nodes of the library");
    // Meshes that were left out, and their instances not.
    const SKIN: &str = "<library_controllers><controller id='c'><skin source='#gone'/></controller>\
        </library_controllers><library_visual";
    for instance in
        ["instance_geometry url='#gone'", "instance_controller url='#gone'", "instance_controller url='#c'"]
    {
        let text = nodes(&format!("{BONES}<node><{instance}/></node>"));
        let scene = load(&text.replacen("<library_visual", SKIN, 1));
        skeleton(&scene);
        note(&scene, "its mesh is left out: expected the '#id'");
    }
}

#[test]
fn nesting_of_any_depth_ends_in_an_error() {
    let deep = format!("<COLLADA>{}", "<node>".repeat(200_000));
    let error = read_any(read, "deep.dae", deep.as_bytes()).unwrap_err();
    assert_eq!(error.found, "elements nested more than 1024 deep", "{error}");
}

#[test]
fn names_are_decoded_as_the_file_says_or_as_they_can_be_read() {
    let named = |declaration: &str, name: &[u8]| {
        let text = format!("{declaration}{}", nodes("<node name='@'/>"));
        let (head, tail) = text.split_once('@').unwrap();
        let bytes = [head.as_bytes(), name, tail.as_bytes()].concat();
        read("a.dae", &bytes).unwrap().nodes[0].name.clone()
    };
    let encoding = |name: &str| format!("<?xml version=\"1.0\" encoding='{name}'?>");
    // In Latin-1 the bytes 0x80 to 0x9f are control characters; in Windows-1252 they are letters and signs.
    assert_eq!(named(&encoding("windows-1252"), b"\x80 \x93J\xfcrgen\x94 \x9f"), "€ “Jürgen” Ÿ");
    assert_eq!(named(&encoding("ISO-8859-1"), b"J\xfcrgen \x8a"), "Jürgen Š");
    assert_eq!(named("", b"J\xfcrgen"), "Jürgen");
    assert_eq!(named(&encoding("shift_jis"), b"\x8a\xe7"), "顔");
    // Editors save UTF-8 and leave the statement.
    assert_eq!(named(&encoding("windows-1252"), "Jürgen".as_bytes()), "Jürgen");
    let units: Vec<u8> = nodes("<node name='Jürgen'/>").encode_utf16().flat_map(u16::to_be_bytes).collect();
    assert_eq!(read("a.dae", &units).unwrap().nodes[0].name, "Jürgen");
}
