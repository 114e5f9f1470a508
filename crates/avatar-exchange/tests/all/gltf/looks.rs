//! What vertices and materials say of looks: texture coordinates and their transforms, colours, pictures,
//! materials of extensions.

use crate::support::gltf::{Builder, F32, U8, U16, floats, one_primitive, read};
use avatar_exchange::{Material, Scene, TextureRef, UvSet};
use glam::{Vec2, Vec3, Vec4};

fn notes(scene: &Scene) -> Vec<String> {
    scene.notes.iter().map(ToString::to_string).collect()
}

/// A triangle with two sets of texture coordinates and a third one; `textures` are members of its material.
fn with_coordinates(textures: &str) -> (Builder, String) {
    let mut file = Builder::default();
    let position = file.triangle();
    let first = file.floats(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0], "VEC2");
    let second = file.floats(&[0.5, 0.5, 0.75, 0.5, 0.5, 0.75], "VEC2");
    let third = file.floats(&[9.0; 6], "VEC2");
    let rest = format!(
        r#""nodes": [{{"mesh": 0}}], "images": [{{"uri": "data:image/png;base64,Zm9v"}}], "textures": [{{"source": 0}}],
        "materials": [{{{textures}}}], "meshes": [{{"primitives": [{{"material": 0, "attributes": {{"POSITION": {position},
        "TEXCOORD_0": {first}, "TEXCOORD_1": {second}, "TEXCOORD_2": {third}}}}}]}}]"#
    );
    (file, rest)
}

fn pairs(flat: [f32; 6]) -> Vec<Vec2> {
    flat.chunks(2).map(|pair| Vec2::new(pair[0], pair[1])).collect()
}

fn close(found: &[Vec2], expected: [f32; 6]) {
    let expected = pairs(expected);
    let is_close = found.iter().zip(&expected).all(|(a, b)| a.abs_diff_eq(*b, 1e-6));
    assert!(is_close && found.len() == 3, "{found:?} {expected:?}");
}

#[test]
fn two_sets_of_coordinates_are_read_and_further_ones_noted() {
    let (file, rest) = with_coordinates(
        r#""pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "occlusionTexture": {"index": 0, "texCoord": 1}"#,
    );
    let scene = file.scene(&rest);
    let mesh = &scene.parts[0].mesh;
    assert_eq!(mesh.uvs, pairs([0.0, 0.0, 1.0, 0.0, 1.0, 1.0]));
    assert_eq!(mesh.uvs_1, pairs([0.5, 0.5, 0.75, 0.5, 0.5, 0.75]));
    let material = &scene.materials[0];
    assert_eq!(material.base_color_texture.map(|texture| texture.uvs), Some(UvSet::First));
    assert_eq!(material.occlusion_texture.map(|texture| texture.uvs), Some(UvSet::Second));
    assert!(notes(&scene).contains(&"mesh 0, primitive 0: TEXCOORD_2 is left out".to_owned()));
    // Only the second set is used: both keep their places.
    let (file, rest) = with_coordinates(r#""emissiveTexture": {"index": 0, "texCoord": 1}"#);
    let scene = file.scene(&rest);
    assert_eq!(
        scene.materials[0].emissive_texture,
        Some(TextureRef { uvs: UvSet::Second, ..TextureRef::from(0) })
    );
    close(&scene.parts[0].mesh.uvs_1, [0.5, 0.5, 0.75, 0.5, 0.5, 0.75]);
    // The third one takes the place of the first, which nothing uses.
    let (file, rest) = with_coordinates(r#""emissiveTexture": {"index": 0, "texCoord": 2}"#);
    let scene = file.scene(&rest);
    assert_eq!(scene.materials[0].emissive_texture, Some(0.into()));
    close(&scene.parts[0].mesh.uvs, [9.0; 6]);
    assert!(notes(&scene).contains(&"mesh 0, primitive 0: TEXCOORD_0 is left out".to_owned()));
}

fn transform(json: &str) -> String {
    format!(r#""extensions": {{"KHR_texture_transform": {{{json}}}}}"#)
}

/// The first example of the extension's own page: the lower left quarter of the picture, turned by 90°.
#[test]
fn a_transform_is_baked_into_the_coordinates() {
    let quarter = transform(r#""offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]"#);
    let (file, rest) = with_coordinates(&format!(r#""emissiveTexture": {{"index": 0, {quarter}}}"#));
    let scene = file.scene(&rest);
    close(&scene.parts[0].mesh.uvs, [0.0, 1.0, 0.0, 0.5, 0.5, 0.5]);
    // Scale comes first: (1, 1) is (2, 3), turned (3, -2), moved (3.5, -3).
    let uneven = transform(r#""offset": [0.5, -1], "rotation": 1.57079632679, "scale": [2, 3]"#);
    let (file, rest) = with_coordinates(&format!(r#""emissiveTexture": {{"index": 0, {uneven}}}"#));
    close(&file.scene(&rest).parts[0].mesh.uvs, [0.5, -1.0, 0.5, -3.0, 3.5, -3.0]);
}

#[test]
fn each_set_with_each_transform_is_coordinates_of_its_own() {
    let twice = transform(r#""scale": [2, 2]"#);
    let other_set = transform(r#""scale": [2, 2], "texCoord": 1"#);
    let nothing = transform(r#""scale": [1, 1]"#);
    let (file, rest) = with_coordinates(&format!(
        r#""pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0, {twice}}}, "metallicRoughnessTexture": {{"index": 0, {twice}}}}},
        "normalTexture": {{"index": 0, {other_set}}}, "emissiveTexture": {{"index": 0, {nothing}}}"#
    ));
    let scene = file.scene(&rest);
    let mesh = &scene.parts[0].mesh;
    close(&mesh.uvs, [0.0, 0.0, 2.0, 0.0, 2.0, 2.0]);
    close(&mesh.uvs_1, [1.0, 1.0, 1.5, 1.0, 1.0, 1.5]);
    let material = &scene.materials[0];
    let of = |texture: Option<TextureRef>| texture.map(|texture| texture.uvs);
    assert_eq!(of(material.base_color_texture), Some(UvSet::First));
    assert_eq!(of(material.metallic_roughness_texture), Some(UvSet::First));
    assert_eq!(of(material.normal_texture), Some(UvSet::Second));
    assert_eq!(of(material.emissive_texture), None);
    let third = "material 0, emissiveTexture: needs a third set of texture coordinates and is left out";
    assert!(notes(&scene).contains(&third.to_owned()), "{:?}", scene.notes);
    // A mesh is read for its own material: without one, as it is.
    let plain = rest.replace(r#""material": 0, "#, "");
    close(&file.scene(&plain).parts[0].mesh.uvs, [0.0, 0.0, 1.0, 0.0, 1.0, 1.0]);
}

#[test]
fn wrong_transforms_are_errors_with_their_place() {
    for (json, key) in [
        (r#""scale": [1]"#, "scale"),
        (r#""offset": "x""#, "offset"),
        (r#""rotation": [1]"#, "rotation"),
        (r#""offset": [1e300, 0]"#, "offset"),
    ] {
        let (file, rest) =
            with_coordinates(&format!(r#""emissiveTexture": {{"index": 0, {}}}"#, transform(json)));
        let place = format!("material 0, emissiveTexture, KHR_texture_transform, {key}");
        assert_eq!(file.error(&rest).place, place);
    }
}

#[test]
fn coordinates_that_a_mesh_lacks_are_noted() {
    let (file, rest) = with_coordinates(r#""emissiveTexture": {"index": 0, "texCoord": 5}"#);
    let scene = file.scene(&rest);
    assert_eq!(scene.parts[0].mesh.uvs, [Vec2::ZERO; 3]);
    let text = "mesh 0, primitive 0: has no TEXCOORD_5, which its material uses: it is 0 everywhere";
    assert!(notes(&scene).contains(&text.to_owned()), "{:?}", scene.notes);
}

/// Section 3.7.2.1: floats, or normalised integers; without opacity it is 1; linear.
#[test]
fn colors_of_every_component_type() {
    let rgb = [Vec3::new(1.0, 0.0, 0.2), Vec3::ZERO, Vec3::ONE];
    let alpha = [0.2, 1.0, 0.0];
    let cases: [(u32, f32); 3] = [(U8, 255.0), (U16, 65535.0), (F32, 1.0)];
    for (component, largest) in cases {
        for has_alpha in [false, true] {
            let numbers = rgb.iter().zip(alpha).flat_map(|(color, alpha)| {
                let color = color.to_array().into_iter().chain(has_alpha.then_some(alpha));
                color.collect::<Vec<_>>()
            });
            // What a view of vertices needs: elements at multiples of four bytes.
            let width = if has_alpha { 4 } else { 3 };
            let mut data = Vec::new();
            for color in numbers.collect::<Vec<f32>>().chunks(width) {
                for x in color {
                    let x = x * largest;
                    match component {
                        U8 => data.push(x.round() as u8),
                        U16 => data.extend((x.round() as u16).to_le_bytes()),
                        _ => data.extend(floats(&[x])),
                    }
                }
                data.resize(data.len().next_multiple_of(4), 0);
            }
            let mut file = Builder::default();
            let position = file.triangle();
            let view = file.view(&data, &format!(r#", "byteStride": {}"#, data.len() / 3));
            let normalized = component != F32;
            let color = file.raw_accessor(format!(
                r#"{{"bufferView": {view}, "componentType": {component}, "type": "VEC{width}", "count": 3, "normalized": {normalized}}}"#
            ));
            let primitive = format!(r#"{{"attributes": {{"POSITION": {position}, "COLOR_0": {color}}}}}"#);
            let scene = file.scene(&one_primitive(&primitive));
            let expected: Vec<Vec4> = rgb
                .iter()
                .zip(alpha)
                .map(|(color, alpha)| color.extend(if has_alpha { alpha } else { 1.0 }))
                .collect();
            let found = &scene.parts[0].mesh.colors;
            assert!(
                found.iter().zip(&expected).all(|(a, b)| a.abs_diff_eq(*b, 1e-7)),
                "{component} {found:?}"
            );
            assert_eq!(found.len(), 3);
            assert!(!notes(&scene).iter().any(|note| note.contains("COLOR")), "{:?}", scene.notes);
        }
    }
}

#[test]
fn second_colors_and_integers_that_are_no_fractions_are_noted() {
    let mut file = Builder::default();
    let position = file.triangle();
    let color = file.accessor(&[255; 12], U8, "VEC4", 3);
    let attributes = format!(r#""POSITION": {position}, "COLOR_0": {color}, "COLOR_1": {color}"#);
    let scene = file.scene(&one_primitive(&format!(r#"{{"attributes": {{{attributes}}}}}"#)));
    assert_eq!(scene.parts[0].mesh.colors, [Vec4::ONE; 3]);
    for note in ["COLOR_1 is left out", "COLOR_0 of integers is taken for fractions"] {
        assert!(notes(&scene).contains(&format!("mesh 0, primitive 0: {note}")), "{:?}", scene.notes);
    }
    let few = file.accessor(&[255; 8], U8, "VEC4", 2);
    let attributes = format!(r#""POSITION": {position}, "COLOR_0": {few}"#);
    let error = file.error(&one_primitive(&format!(r#"{{"attributes": {{{attributes}}}}}"#)));
    assert_eq!(error.place, format!("accessor {few}"));
}

/// A material whose colour is the only texture of a file with two pictures.
fn textured(texture: &str) -> Scene {
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "images": [{{"uri": "data:,a"}}, {{"uri": "data:,b"}}], "textures": [{texture}],
        "materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}}}}]}}"#
    );
    read(json.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn pictures_of_extensions_have_their_order() {
    let image = |scene: &Scene| scene.materials[0].base_color_texture.map(|texture| texture.image);
    let webp = r#"{"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}"#;
    assert_eq!(image(&textured(webp)), Some(1));
    assert_eq!(image(&textured(r#"{"extensions": {"EXT_texture_webp": {"source": 1}}}"#)), Some(1));
    for name in ["KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"] {
        let both = textured(&format!(r#"{{"source": 0, "extensions": {{"{name}": {{"source": 1}}}}}}"#));
        let note = format!("material 0, baseColorTexture: its picture without {name} is taken");
        assert!(image(&both) == Some(0) && notes(&both).contains(&note), "{:?}", both.notes);
        let only = textured(&format!(r#"{{"extensions": {{"{name}": {{"source": 1}}}}}}"#));
        let note = format!("material 0, baseColorTexture: its only picture is one of {name}");
        assert!(image(&only) == Some(1) && notes(&only).contains(&note), "{:?}", only.notes);
    }
    let none = textured(r#"{"extensions": {"ACME_pictures": {"source": 1}}}"#);
    assert_eq!(image(&none), None);
    for note in ["ACME_pictures is not represented", "has no image"] {
        assert!(notes(&none).contains(&format!("material 0, baseColorTexture: {note}")), "{:?}", none.notes);
    }
}

/// A picture is a matter of looks: what an extension says wrongly of it costs neither the file nor the plain
/// picture.
#[test]
fn an_extension_that_names_no_picture_of_the_file_leaves_the_plain_one() {
    for name in ["EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"] {
        for (wrong, found) in [
            (r#"{"source": 2}"#, "2"),
            (r#"{"source": -1}"#, "-1"),
            (r#"{"source": "a.png"}"#, r#""a.png""#),
            ("{}", "none"),
            ("7", "none"),
        ] {
            let note =
                format!("material 0, baseColorTexture: {name}: expected an image below 2, found {found}");
            let both = textured(&format!(r#"{{"source": 1, "extensions": {{"{name}": {wrong}}}}}"#));
            let image = both.materials[0].base_color_texture.map(|texture| texture.image);
            assert!(image == Some(1) && notes(&both).contains(&note), "{:?}", both.notes);
            let alone = textured(&format!(r#"{{"extensions": {{"{name}": {wrong}}}}}"#));
            let none = "material 0, baseColorTexture: has no image".to_owned();
            let notes = notes(&alone);
            assert!(notes.contains(&note) && notes.contains(&none), "{notes:?}");
            assert_eq!(alone.materials[0].base_color_texture, None);
        }
    }
}

fn specular(members: &str, plain: &str) -> (Material, Vec<String>) {
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "images": [{{"uri": "data:,a"}}], "textures": [{{"source": 0}}], "materials": [{{{plain}
        "extensions": {{"KHR_materials_pbrSpecularGlossiness": {{{members}}}}}}}]}}"#
    );
    let scene = read(json.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    (scene.materials[0].clone(), notes(&scene))
}

/// What reflects its own colour and nothing diffusely is a metal of that colour.
#[test]
fn specular_colors_become_metal() {
    let gold =
        r#""diffuseFactor": [0, 0, 0, 1], "specularFactor": [1, 0.766, 0.336], "glossinessFactor": 0.8"#;
    let (found, _) = specular(gold, "");
    let [r, g, b, a] = found.base_color;
    assert!((Vec3::new(r, g, b) - Vec3::new(1.0, 0.766, 0.336)).abs().max_element() < 1e-5, "{found:?}");
    assert!(
        (found.metallic - 1.0).abs() < 1e-5 && (found.roughness - 0.2).abs() < 1e-6 && a == 1.0,
        "{found:?}"
    );
    // A plain material of the file's own is what it says to programs that know no other.
    let plain = r#""pbrMetallicRoughness": {"metallicFactor": 0.25, "baseColorFactor": [0.5, 0.5, 0.5, 1]},"#;
    let (found, notes) = specular(gold, plain);
    assert_eq!((found.metallic, found.base_color[0]), (0.25, 0.5));
    assert!(notes.iter().any(|note| note.contains("the plain material is taken")), "{notes:?}");
    let (found, notes) = specular(r#""specularGlossinessTexture": {"index": 0}"#, "");
    assert_eq!((found.metallic, found.roughness), (0.0, 0.5));
    assert!(notes.contains(&"material 0: specularGlossinessTexture is left out".to_owned()), "{notes:?}");
}
