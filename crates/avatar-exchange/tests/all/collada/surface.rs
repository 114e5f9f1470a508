//! What vertices carry, and what materials say.

use super::{close, dented, load, note};
use avatar_exchange::{AlphaMode, Material, Scene, UvSet, collada};
use glam::Vec2;

const VERTEX: &str = "<input semantic='VERTEX' source='#v' offset='0'/>";

fn is_told(scene: &Scene, finding: &str) -> bool {
    scene.notes.iter().any(|note| note.to_string().contains(finding))
}

/// A source of numbers before the vertices.
fn with_source(text: &str, id: &str, stride: usize, numbers: &str) -> String {
    let count = numbers.split_whitespace().count();
    let source = format!(
        "<source id='{id}'><float_array id='{id}a' count='{count}'>{numbers}</float_array><technique_common>\
         <accessor source='#{id}a' count='{}' stride='{stride}'/></technique_common></source><vertices ",
        count / stride
    );
    text.replacen("<vertices ", &source, 1)
}

#[test]
fn colours_of_vertices_are_decoded() {
    let primitive = format!(
        "<triangles count='1'>{VERTEX}<input semantic='COLOR' source='#c' offset='1'/><p>0 0 1 1 2 2</p></triangles>"
    );
    let colors = |stride, numbers| {
        let scene = load(&with_source(&dented(&primitive), "c", stride, numbers));
        assert!(!is_told(&scene, "colours"), "{:?}", scene.notes);
        scene.parts[0].mesh.colors.iter().flat_map(|color| color.to_array()).collect::<Vec<f32>>()
    };
    // By IEC 61966-2-1: ((0.5 + 0.055) / 1.055)^2.4, and 0.04 / 12.92. Opacity is as it is.
    let (half, dark) = (0.214_041, 0.003_095_98);
    let expected = [1.0, 1.0, 1.0, 1.0, half, 0.0, dark, 0.25, 1.0, 0.0, 1.0, 1.0];
    close(&colors(4, "1 1 1 1 0.5 0 0.04 0.25 2 -1 1 7"), &expected);
    close(&colors(3, "1 1 1 0.5 0 0.04 1 0 1")[4..8], &[half, 0.0, dark, 1.0]);
    assert!(colors(3, "1 1 1 1 1 1 1 1 1").is_empty());
    // A second set is told.
    let two = primitive.replace("<p>", "<input semantic='COLOR' source='#c' offset='1' set='1'/><p>");
    let scene = load(&with_source(&dented(&two), "c", 3, "1 0 0 1 0 0 1 0 0"));
    note(&scene, "1 further sets of colours are left out");
    assert_eq!(scene.parts[0].mesh.colors.len(), 3);
}

/// Two effects' worth of a material: the inside of `<phong>`, what binds it, and what texture coordinates the
/// mesh has.
fn looks(inside: &str, after: &str, bind: &str, inputs: &str, indices: &str) -> Scene {
    let sampler = |name: &str| {
        format!(
            "<newparam sid='{name}-surf'><surface type='2D'><init_from>{name}</init_from></surface></newparam>\
             <newparam sid='{name}-samp'><sampler2D><source>{name}-surf</source></sampler2D></newparam>"
        )
    };
    let look = format!(
        "<library_images><image id='a'><init_from>a.png</init_from></image><image id='b'><init_from>b.png</init_from></image></library_images>\
         <library_effects><effect id='e'><profile_COMMON>{}{}<technique sid='c'><phong>{inside}</phong>{after}</technique></profile_COMMON></effect></library_effects>\
         <library_materials><material id='m'><instance_effect url='#e'/></material></library_materials><library_geometries>",
        sampler("a"),
        sampler("b"),
    );
    let instance = format!(
        "<instance_geometry url='#g'><bind_material><technique_common><instance_material symbol='s' target='#m'>{bind}</instance_material></technique_common></bind_material></instance_geometry>"
    );
    let text =
        dented(&format!("<triangles count='1' material='s'>{VERTEX}{inputs}<p>{indices}</p></triangles>"))
            .replace("<library_geometries>", &look)
            .replace("<instance_geometry url='#g'/>", &instance);
    collada::read("look.dae", text.as_bytes(), &mut |_| Ok(b"\x89PNG....".to_vec())).unwrap()
}

fn material(inside: &str, after: &str) -> (Scene, Material) {
    let scene = looks(inside, after, "", "", "0 1 4");
    let material = scene.materials[0].clone();
    (scene, material)
}

const DIFFUSE: &str = "<diffuse><texture texture='a-samp' texcoord='U'/></diffuse>";
const EMISSION: &str = "<emission><texture texture='b-samp' texcoord='V'/></emission>";

#[test]
fn textures_use_the_sets_that_they_are_bound_to() {
    let bind = |u: usize, v: usize| {
        format!(
            "<bind_vertex_input semantic='U' input_semantic='TEXCOORD' input_set='{u}'/>\
             <bind_vertex_input semantic='V' input_semantic='TEXCOORD' input_set='{v}'/>"
        )
    };
    let input = |set: usize| format!("<input semantic='TEXCOORD' source='#t' offset='{set}' set='{set}'/>");
    let inside = format!("{EMISSION}{DIFFUSE}");
    // Sets 1 and 3 of the file; corners have 0 0 0, 1 0 1, 2 1 0 with an index between that means nothing.
    let inputs = input(3) + &input(1);
    let scene = looks(&inside, "", &bind(3, 1), &inputs, "0 0 0 1 1 0 0 0 2 1 0 0");
    let mesh = &scene.parts[0].mesh;
    assert_eq!(mesh.uvs, [Vec2::new(0.0, 0.75), Vec2::new(0.0, 0.75), Vec2::new(1.0, 0.0)]);
    assert_eq!(mesh.uvs_1, [Vec2::new(1.0, 0.0), Vec2::new(0.0, 0.75), Vec2::new(0.0, 0.75)]);
    let sets = |scene: &Scene| {
        let material = &scene.materials[0];
        [material.base_color_texture, material.emissive_texture].map(|texture| texture.unwrap().uvs)
    };
    assert_eq!(sets(&scene), [UvSet::Second, UvSet::First]);
    assert!(!is_told(&scene, "texture coordinates"), "{:?}", scene.notes);
    // Without a binding, the first set.
    assert_eq!(sets(&looks(&inside, "", "", &inputs, "0 0 0 1 1 0 0 0 2 1 0 0")), [UvSet::First; 2]);
    // A set that is not read is told.
    let three = looks(&inside, "", &bind(4, 1), &(inputs + &input(4)), "0 0 0 1 0 1 0 0 0 0 2 1 0 0 0");
    note(&three, "1 further sets of texture coordinates are left out");
    note(&three, "texture coordinates 'U' of its material are taken from the first set");
    assert_eq!(sets(&three), [UvSet::First; 2]);
}

#[test]
fn light_given_off_may_be_a_texture() {
    let (_, read) = material(EMISSION, "");
    assert_eq!((read.emissive, read.emissive_texture), ([1.0; 3], Some(0.into())));
    let (_, read) = material("<emission><color>0.5 0 0.25 1</color></emission>", "");
    assert_eq!((read.emissive, read.emissive_texture), ([0.5, 0.0, 0.25], None));
}

#[test]
fn opacity_is_the_alpha_of_the_picture_of_the_colour() {
    let transparent = |mode: &str, picture: &str| {
        let text = format!("{DIFFUSE}<transparent{mode}><texture texture='{picture}-samp'/></transparent>");
        let (scene, read) = material(&text, "");
        assert_eq!(scene.images.len(), 1, "a picture that nothing shows is not kept");
        (read.alpha_mode, is_told(&scene, "its opacity texture is left out"))
    };
    // Without a mode it is A_ONE: COLLADA 1.4.1, chapter 7, "Determining Transparency".
    assert_eq!(transparent("", "a"), (AlphaMode::Blend, false));
    assert_eq!(transparent(" opaque='A_ONE'", "a"), (AlphaMode::Blend, false));
    assert_eq!(transparent(" opaque='RGB_ZERO'", "a"), (AlphaMode::Opaque, true));
    assert_eq!(transparent(" opaque='A_ONE'", "b"), (AlphaMode::Opaque, true));
}

#[test]
fn normal_maps_of_exporters_are_read() {
    let bump = |kind: &str| {
        let text = format!(
            "<extra><technique profile='OpenCOLLADA3dsMax'><bump{kind}><texture texture='b-samp' texcoord='V'/></bump></technique></extra>"
        );
        let inside = material(DIFFUSE, &text);
        let in_model = material(&format!("{DIFFUSE}{text}"), "");
        assert_eq!(inside.1, in_model.1);
        (inside.1.normal_texture, is_told(&inside.0, "its map of heights is left out"))
    };
    assert_eq!(bump(" bumptype='NORMALMAP'"), (Some(1.into()), false));
    assert_eq!(bump(" bumptype='HEIGHTFIELD'"), (None, true));
    assert_eq!(bump(""), (None, true));
}

#[test]
fn terms_are_told_as_documented() {
    let rows = include_str!("../../../../../docs/formats.md").split_once("| element of COLLADA |").unwrap().1;
    let rows = rows.lines().skip(2).take_while(|line| line.starts_with('|'));
    let told = rows.filter_map(|row| row.strip_suffix("| a note |"));
    let mut names: Vec<&str> = told.flat_map(|row| row.split('`').skip(1).step_by(2)).collect();
    names.sort_unstable();
    let tested = ["ambient", "index_of_refraction", "reflective", "reflectivity", "shininess", "specular"];
    assert_eq!(names, tested);
}

#[test]
fn terms_that_surfaces_do_not_have_are_told_once() {
    let color = |name: &str, color: &str| format!("<{name}><color>{color} 1</color></{name}>");
    let number = |name: &str, number: &str| format!("<{name}><float>{number}</float></{name}>");
    for name in ["ambient", "specular", "reflective"] {
        let text = format!("<{name}> of 1 materials is left out");
        assert!(is_told(&material(&color(name, "0.1 0 0"), "").0, &text), "{name}");
        assert!(!is_told(&material(&color(name, "0 0 0"), "").0, &text), "{name}");
        assert!(
            is_told(&material(&format!("<{name}><texture texture='a-samp'/></{name}>"), "").0, &text),
            "{name}"
        );
    }
    for (name, none, some) in
        [("reflectivity", "0", "0.5"), ("index_of_refraction", "1", "1.5"), ("shininess", "0", "20")]
    {
        let text = format!("<{name}> of 1 materials is left out");
        assert!(is_told(&material(&number(name, some), "").0, &text), "{name}");
        assert!(!is_told(&material(&number(name, none), "").0, &text), "{name}");
    }
}
