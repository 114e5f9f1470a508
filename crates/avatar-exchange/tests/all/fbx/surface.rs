//! What vertices carry, and which texture coordinates a material uses.

use super::{FACE, close, node, read};
use avatar_exchange::{Scene, Transform, UvSet};
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

fn scene(text: &str) -> Scene {
    read("face.fbx", text.as_bytes()).unwrap()
}

fn is_told(scene: &Scene, finding: &str) -> bool {
    scene.notes.iter().any(|note| note.to_string().contains(finding))
}

/// The vertex of the square at a place.
fn at(scene: &Scene, position: Vec3) -> usize {
    scene.parts[0].mesh.positions.iter().position(|p| p.distance(position) < 1e-6).unwrap()
}

const FIRST_LAYER: &str = "\t\tLayer: 0 {\n\t\t\tVersion: 100\n";

/// The face with one more element of its layers; the numbers are those of a layer and of an element.
fn with_element(text: &str, kind: &str, [layer, element]: [usize; 2], name: &str, values: &str) -> String {
    let element_text = format!(
        "\t\tLayerElement{kind}: {element} {{\nVersion: 101\nName: \"{name}\"\n\
         MappingInformationType: \"ByPolygonVertex\"\nReferenceInformationType: \"Direct\"\n{values}\n}}\n"
    );
    let entry = format!("LayerElement: {{\nType: \"LayerElement{kind}\"\nTypedIndex: {element}\n}}\n");
    if layer == 0 {
        return text.replacen(FIRST_LAYER, &format!("{element_text}{FIRST_LAYER}{entry}"), 1);
    }
    let layer_text = format!("\t\tLayer: {layer} {{\nVersion: 100\n{entry}}}\n");
    let end = "\t}\n\tGeometry: 20,";
    text.replacen(FIRST_LAYER, &format!("{element_text}{FIRST_LAYER}"), 1).replacen(
        end,
        &(layer_text + end),
        1,
    )
}

#[test]
fn colours_of_vertices_are_decoded() {
    let text = with_element(
        FACE,
        "Color",
        [0, 0],
        "paint",
        "Colors: *16 { a: 1,1,1,1,0,0,0,1,0.5,1,0.04,0.25,2,-1,1,1 }",
    );
    let scene = scene(&text);
    let color = |x, y| scene.parts[0].mesh.colors[at(&scene, Vec3::new(x, y, 0.0))].to_array();
    close(&color(0.0, 0.0), &[1.0; 4]);
    close(&color(1.0, 0.0), &[0.0, 0.0, 0.0, 1.0]);
    // By IEC 61966-2-1: ((0.5 + 0.055) / 1.055)^2.4, and 0.04 / 12.92. Opacity is as it is.
    close(&color(1.0, 1.0), &[0.214_041, 1.0, 0.003_095_98, 0.25]);
    // Out of range.
    close(&color(0.0, 1.0), &[1.0, 0.0, 1.0, 1.0]);
    assert!(!is_told(&scene, "colours"), "{:?}", scene.notes);
}

#[test]
fn white_vertices_have_no_colours_and_further_sets_are_told() {
    let white = "Colors: *16 { a: 1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1 }";
    let one = with_element(FACE, "Color", [0, 0], "paint", white);
    assert!(scene(&one).parts[0].mesh.colors.is_empty() && scene(FACE).parts[0].mesh.uvs_1.is_empty());
    assert!(!is_told(&scene(&one), "further sets"));
    let two = with_element(&one, "Color", [1, 1], "more", white);
    assert!(is_told(&scene(&two), "1 further sets of colours are left out"));
}

/// A corner of two faces in two colours becomes two vertices.
#[test]
fn colours_part_vertices() {
    let text = FACE
        .replace("PolygonVertexIndex: *4 { a: 0,1,2,-4 }", "PolygonVertexIndex: *6 { a: 0,1,-3,0,2,-4 }")
        .replace("UV: *8 { a: 0,0,1,0,1,0.75,0,0.75 }", "UV: *12 { a: 0,0,0,0,0,0,0,0,0,0,0,0 }");
    let vertices = |text: &str| scene(text).parts[0].mesh.positions.len();
    let colors = "Colors: *24 { a: 1,0,0,1,1,0,0,1,1,0,0,1,0,1,0,1,0,1,0,1,0,1,0,1 }";
    assert_eq!((vertices(&text), vertices(&with_element(&text, "Color", [0, 0], "", colors))), (4, 6));
}

/// The face with three sets of texture coordinates, and textures of its material: property, name and set.
fn textured(textures: &[(&str, &str, &str)]) -> Scene {
    let light = with_element(FACE, "UV", [1, 1], "light", "UV: *8 { a: 0,0.25,0,0.25,0.5,1,0,0.25 }");
    let mut text = with_element(&light, "UV", [2, 2], "far", "UV: *8 { a: 0,0,0,0,0.125,0.5,0,0 }");
    for (number, (property, name, set)) in textures.iter().enumerate() {
        let number = 70 + number;
        let texture = format!(
            "\tTexture: {number}, \"Texture::{name}\", \"\" {{\nType: \"TextureVideoClip\"\nVersion: 202\n\
             FileName: \"{name}.png\"\nRelativeFilename: \"{name}.png\"\nProperties70: {{\n\
             P: \"UVSet\", \"KString\", \"\", \"\", \"{set}\"\n}}\n}}\n"
        );
        let material = "\tMaterial: 60,";
        text = text.replacen(material, &(texture + material), 1);
        let connection = format!("Connections:  {{\n\tC: \"OP\",{number},60, \"{property}\"\n");
        text = text.replacen("Connections:  {\n", &connection, 1);
    }
    scene(&text)
}

#[test]
fn textures_use_the_coordinates_that_they_name() {
    let corner = |scene: &Scene| scene.parts[0].mesh.uvs_1[at(scene, Vec3::new(1.0, 1.0, 0.0))];
    // No texture names a set: the second is the second.
    let scene = textured(&[]);
    assert_eq!(corner(&scene), Vec2::new(0.5, 0.0));
    assert!(is_told(&scene, "1 further sets of texture coordinates are left out"));
    let sets = [("DiffuseColor", "skin", "map"), ("NormalMap", "bumps", "far")];
    let scene = textured(&sets);
    let material = &scene.materials[0];
    let sets = [material.base_color_texture, material.normal_texture].map(|texture| texture.unwrap().uvs);
    assert_eq!(sets, [UvSet::First, UvSet::Second]);
    // The set that is used comes before the one that is not.
    assert_eq!(corner(&scene), Vec2::new(0.125, 0.5));
    assert_eq!(scene.parts[0].mesh.uvs[at(&scene, Vec3::new(1.0, 1.0, 0.0))], Vec2::new(1.0, 0.25));
    // Two sets besides the first are one too many.
    let scene = textured(&[("DiffuseColor", "skin", "far"), ("NormalMap", "bumps", "light")]);
    let material = &scene.materials[0];
    let sets = [material.base_color_texture, material.normal_texture].map(|texture| texture.unwrap().uvs);
    assert_eq!(sets, [UvSet::First, UvSet::Second]);
    assert!(
        is_told(&scene, "its texture uses the first texture coordinates, not 'far'"),
        "{:?}",
        scene.notes
    );
}

/// A texture of FBX takes the place of a colour: one of black emission is seen.
#[test]
fn a_texture_takes_the_place_of_emission() {
    let scene = textured(&[("EmissiveColor", "glow", "map")]);
    let material = &scene.materials[0];
    assert!(material.emissive_texture.is_some());
    assert_eq!(material.emissive, [1.0; 3]);
    assert_eq!(textured(&[]).materials[0].emissive, [0.0; 3]);
}

/// A second skin of the mesh moves two of its points: one that the first skin does not move, and one that it
/// moves as much.
#[test]
fn skins_of_a_mesh_are_added_up() {
    let cluster = "\tDeformer: 44, \"Deformer::more\", \"Skin\" { Version: 101 }
	Deformer: 45, \"SubDeformer::more\", \"Cluster\" {
		Version: 100
		Indexes: *2 { a: 1,3 }
		Weights: *2 { a: 1,1 }
		Transform: *16 { a: 1,0,0,0,0,1,0,0,0,0,1,0,0,-100,0,1 }
		TransformLink: *16 { a: 1,0,0,0,0,1,0,0,0,0,1,0,0,100,0,1 }
	}
";
    let text = FACE.replace("\tAnimationStack: 50,", &format!("{cluster}\tAnimationStack: 50,"));
    let more = "\tC: \"OO\",44,10\n\tC: \"OO\",45,44\n\tC: \"OO\",15,45\n\tC: \"OO\",51,50\n";
    let scene = scene(&text.replace("\tC: \"OO\",51,50\n", more));
    assert!(is_told(&scene, "its 2 skins became one with the bones of all"), "{:?}", scene.notes);
    assert!(!is_told(&scene, "points without weights"));
    let mut pose = scene.rest();
    pose.weights[scene.parts[0].node].fill(0.0);
    let Transform::Trs(knee) = &mut pose.locals[node(&scene, "knee")] else { panic!("a matrix") };
    knee.rotation = Quat::from_rotation_z(FRAC_PI_2);
    let bones = scene.bones(&pose);
    let mesh = &scene.parts[0].mesh;
    let mut out = mesh.deformed();
    avatar_mesh::deform(mesh, scene.bones_of(0, &bones), &[0.0; 2], &mut out).unwrap();
    let moved = |x, y| out.positions[at(&scene, Vec3::new(x, y, 0.0))].to_array();
    // The knee is at (0, 1, 0) and turns x to y. A point that moves with it by all of its weight:
    close(&moved(1.0, 1.0), &[0.0, 2.0, 0.0]);
    close(&moved(0.0, 1.0), &[0.0, 1.0, 0.0]);
    // (1, 0, 0), by half with the hip, which rests, and by half with the knee, which takes it to (1, 2, 0).
    close(&moved(1.0, 0.0), &[1.0, 1.0, 0.0]);
}

#[test]
fn dual_quaternions_are_told() {
    let told = |kind: &str| {
        let skin = format!("Link_DeformAcuracy: 50\n\t\tSkinningType: \"{kind}\"");
        is_told(&scene(&FACE.replace("Link_DeformAcuracy: 50", &skin)), "dual quaternion skinning")
    };
    assert_eq!(["Rigid", "Linear", "DualQuaternion"].map(told), [false, false, true]);
}
