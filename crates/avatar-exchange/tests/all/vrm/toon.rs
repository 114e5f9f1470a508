//! MToon of both versions.

use super::{read, scene};
use avatar_exchange::vrm::VrmModel;
use avatar_exchange::{AlphaMode, Material, TextureRef, ToonMaterial, UvSet};
use glam::Vec2;
use serde_json::{Value, json};

/// With two pictures, of which the second texture shows the first.
fn with_pictures(mut json: Value, materials: Value) -> Value {
    json["images"] = json!([{ "uri": "a.png" }, { "uri": "b.png" }]);
    json["textures"] = json!([{ "source": 1 }, { "source": 0 }]);
    json["materials"] = materials;
    json
}

pub(super) fn v1() -> Value {
    let vrm = json!({ "VRMC_vrm": {
        "specVersion": "1.0",
        "meta": { "name": "N", "authors": ["A"], "licenseUrl": "" },
        "humanoid": { "humanBones": { "hips": { "node": 0 } } }
    } });
    let unlit = json!({});
    with_pictures(
        scene(vrm),
        json!([
            { "name": "skin", "extensions": { "KHR_materials_unlit": unlit, "VRMC_materials_mtoon": {
                "specVersion": "1.0",
                "shadeColorFactor": [0.5, 0.25, 0.125],
                "shadeMultiplyTexture": { "index": 1, "texCoord": 1 },
                "shadingShiftFactor": -0.25,
                "shadingToonyFactor": 0.75,
                "giEqualizationFactor": 0.9,
                "matcapTexture": { "index": 0 },
                "parametricRimColorFactor": [0, 0, 0],
                "rimLightingMixFactor": 1.0,
                "outlineWidthMode": "worldCoordinates",
                "outlineWidthFactor": 0.002,
                "outlineColorFactor": [0.1, 0.2, 0.3]
            } } },
            { "name": "cloth", "extensions": { "VRMC_materials_mtoon": {
                "specVersion": "1.0", "outlineWidthMode": "screenCoordinates", "outlineWidthFactor": 0.01,
                "shadingToonyFactor": 1.5
            } } },
            { "name": "plain", "emissiveFactor": [1.0, 0.5, 0.0],
              "extensions": { "VRMC_materials_hdr_emissiveMultiplier": { "emissiveMultiplier": 3.0 } } }
        ]),
    )
}

pub(super) fn v0() -> Value {
    let vrm = json!({ "VRM": {
        "specVersion": "0.0",
        "meta": { "title": "N" },
        "humanoid": { "humanBones": [{ "bone": "hips", "node": 0 }] },
        "materialProperties": [
            { "name": "skin", "shader": "VRM/MToon", "renderQueue": 2000,
              "floatProperties": { "_Cutoff": 0.25, "_BlendMode": 1, "_CullMode": 0, "_BumpScale": 0.5,
                  "_ShadeShift": -0.5, "_ShadeToony": 0.5, "_OutlineWidth": 0.25, "_OutlineWidthMode": 1,
                  "_UvAnimScrollX": 0.0, "_ReceiveShadowRate": 1.0 },
              "vectorProperties": { "_Color": [0.5, 1.0, 0.0, 0.75], "_ShadeColor": [0.5, 0.02, 1.0, 1.0],
                  "_EmissionColor": [0.5, 0.25, 0.0, 1.0], "_OutlineColor": [1.0, 0.5, 0.0, 1.0],
                  "_MainTex": [0.0, 0.0, 1.0, 1.0], "_RimColor": [0.5, 0.0, 0.0, 1.0] },
              "textureProperties": { "_MainTex": 0, "_ShadeTexture": 1, "_BumpMap": 1, "_SphereAdd": 0 },
              "keywordMap": {}, "tagMap": {} },
            { "name": "glow", "shader": "VRM/UnlitTransparent",
              "vectorProperties": { "_Color": [1.0, 0.5, 0.0, 0.5] }, "textureProperties": { "_MainTex": 0 } },
            { "name": "metal", "shader": "VRM_USE_GLTFSHADER" },
            { "name": "odd", "shader": "Someone/Else" },
            { "name": "none", "shader": "VRM/MToon" }
        ]
    } });
    let pbr =
        json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.9, 0.9, 0.9, 1.0], "metallicFactor": 0.5 } });
    with_pictures(scene(vrm), json!([{ "name": "skin" }, { "name": "glow" }, pbr, { "name": "odd" }]))
}

fn notes(model: &VrmModel) -> Vec<String> {
    model.scene.notes.iter().map(ToString::to_string).collect()
}

#[test]
fn mtoon_of_version_1_becomes_a_toon_material() {
    let model = read(&v1()).expect("a VRM");
    let [skin, cloth, plain] = &model.scene.materials[..] else { panic!("three materials") };
    assert_eq!(
        skin.toon,
        Some(ToonMaterial {
            shade_color: [0.5, 0.25, 0.125],
            shade_texture: Some(TextureRef { uvs: UvSet::Second, ..TextureRef::from(0) }),
            shading_shift: -0.25,
            shading_toony: 0.75,
            outline_width: 0.002,
            outline_color: [0.1, 0.2, 0.3],
        })
    );
    assert!(!skin.is_unlit, "that is for programs that do not know the extension");
    // The standard's own defaults, and a number beyond its range.
    assert_eq!(cloth.toon, Some(ToonMaterial { shading_toony: 1.0, ..ToonMaterial::default() }));
    assert_eq!((&plain.toon, plain.emissive), (&None, [3.0, 1.5, 0.0]));
    let notes = notes(&model);
    for text in [
        "material 0, VRMC_materials_mtoon: matcapTexture are not represented",
        "material 1, VRMC_materials_mtoon.shadingToonyFactor: 1.5 is out of range: 1 is taken",
        "material 1, VRMC_materials_mtoon: an outline of constant width on the screen is not represented",
    ] {
        assert!(notes.iter().any(|note| note == text), "{text}: {notes:?}");
    }
    assert!(!notes.iter().any(|note| note.contains("mtoon is not represented")), "{notes:?}");
}

/// The texture coordinates of the first vertex that the shade, the base colour and the normals of a material
/// use, in a file whose own are all 0.
fn coordinates(base: Value, shade: Value, normals: Value) -> (VrmModel, [Option<Vec2>; 3]) {
    let mut json = v1();
    let zeros = json!({ "componentType": 5126, "type": "VEC2", "count": 3 });
    json["accessors"].as_array_mut().expect("a list").push(zeros);
    let primitive = &mut json["meshes"][0]["primitives"][0];
    primitive["material"] = json!(0);
    primitive["attributes"] = json!({ "POSITION": 0, "TEXCOORD_0": 1 });
    json["materials"][0]["pbrMetallicRoughness"] = json!({ "baseColorTexture": base });
    json["materials"][0]["normalTexture"] = normals;
    json["materials"][0]["extensions"]["VRMC_materials_mtoon"]["shadeMultiplyTexture"] = shade;
    let model = read(&json).expect("a VRM");
    let (mesh, material) = (&model.scene.parts[0].mesh, &model.scene.materials[0]);
    let shade = material.toon.as_ref().expect("a toon").shade_texture;
    let found = [shade, material.base_color_texture, material.normal_texture].map(|used| {
        used.map(|used| match used.uvs {
            UvSet::First => mesh.uvs[0],
            UvSet::Second => mesh.uvs_1[0],
        })
    });
    (model, found)
}

/// Each texture of the standard has coordinates of its own, with a transform or without one.
#[test]
fn a_shade_texture_keeps_its_coordinates_beside_others() {
    let moved = |index: u32, offset: [f32; 2]| json!({ "index": index, "extensions": { "KHR_texture_transform": { "offset": offset } } });
    let plain = |index: u32| json!({ "index": index });
    let (base, shade) = ([0.5, 0.25], [0.125, 0.75]);
    for (base_texture, shade_texture, expected) in [
        (moved(0, base), plain(1), [Vec2::ZERO, Vec2::from(base)]),
        (plain(0), moved(1, shade), [Vec2::from(shade), Vec2::ZERO]),
        (moved(0, base), moved(1, shade), [Vec2::from(shade), Vec2::from(base)]),
        (moved(0, base), moved(1, base), [Vec2::from(base); 2]),
        (plain(0), plain(1), [Vec2::ZERO; 2]),
    ] {
        // Of three that differ, the normals' have no place.
        let (model, found) = coordinates(base_texture, shade_texture, moved(0, [0.0, 9.0]));
        assert_eq!(found[..2], expected.map(Some));
        let has_place = expected[0] == expected[1];
        assert_eq!(found[2], has_place.then_some(Vec2::new(0.0, 9.0)));
        let note = "material 0, normalTexture: needs a third set of texture coordinates and is left out";
        assert_eq!(notes(&model).iter().any(|text| text == note), !has_place);
    }
}

fn near(found: &[f32], expected: &[f32]) {
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(found.len() == expected.len() && off < 1e-5, "{found:?} {expected:?}");
}

/// What sRGB's standard gives for the codes 0.5 and 0.02.
const HALF: f32 = 0.214_041_14;
const DARK: f32 = 0.02 / 12.92;

#[test]
fn mtoon_of_version_0_says_the_same_in_other_units() {
    let model = read(&v0()).expect("a VRM");
    let [skin, glow, metal, odd] = &model.scene.materials[..] else { panic!("four materials") };
    near(&skin.base_color, &[HALF, 1.0, 0.0, 0.75]);
    assert_eq!(skin.base_color_texture, Some(TextureRef::from(1)));
    assert_eq!((skin.alpha_mode, skin.alpha_cutoff, skin.double_sided), (AlphaMode::Mask, 0.25, true));
    assert_eq!((skin.normal_texture, skin.normal_scale), (Some(TextureRef::from(0)), 0.5));
    // The light that a surface gives off is linear there, too.
    assert_eq!((skin.emissive, skin.is_unlit), ([0.5, 0.25, 0.0], false));
    let toon = skin.toon.as_ref().expect("a cartoon");
    near(&toon.shade_color, &[HALF, DARK, 1.0]);
    assert_eq!(toon.shade_texture, Some(TextureRef::from(0)));
    // The border goes from -0.5 to 0.25 there: as wide, and about the same middle, in version 1.
    near(&[toon.shading_shift, toon.shading_toony], &[0.125, 0.625]);
    assert_eq!([toon.shading_toony - 1.0, 1.0 - toon.shading_toony], [-0.5 + 0.125, 0.25 + 0.125]);
    // Centimetres become metres.
    near(&[toon.outline_width], &[0.0025]);
    near(&toon.outline_color, &[1.0, HALF, 0.0]);

    assert!(glow.is_unlit && glow.toon.is_none() && glow.alpha_mode == AlphaMode::Blend);
    near(&glow.base_color, &[1.0, HALF, 0.0, 0.5]);
    let expected = Material { base_color: [0.9, 0.9, 0.9, 1.0], metallic: 0.5, ..Material::default() };
    assert_eq!(*metal, expected, "as glTF says it");
    assert_eq!(odd.toon, None);
    let notes = notes(&model);
    for text in [
        "extensions.VRM.materialProperties[0]: _SphereAdd, _RimColor are not represented",
        "extensions.VRM.materialProperties[3]: the shader 'Someone/Else' is not represented",
        "extensions.VRM.materialProperties[4]: is left out: there is no material for it",
    ] {
        assert!(notes.iter().any(|note| note == text), "{text}: {notes:?}");
    }
}

#[test]
fn mistakes_are_told_with_their_place() {
    let mtoon = "/materials/0/extensions/VRMC_materials_mtoon";
    let properties = "/extensions/VRM/materialProperties/0";
    for (mut json, pointer, value, expected) in [
        (
            v1(),
            format!("{mtoon}/shadeMultiplyTexture/index"),
            json!(2),
            "material 0, VRMC_materials_mtoon.shadeMultiplyTexture.index: expected a texture below 2, found 2",
        ),
        (
            v1(),
            format!("{mtoon}/shadeColorFactor"),
            json!([1, 2]),
            "material 0, VRMC_materials_mtoon.shadeColorFactor: expected three numbers, found [1,2]",
        ),
        (
            v1(),
            format!("{mtoon}/outlineWidthMode"),
            json!("thick"),
            "material 0, VRMC_materials_mtoon.outlineWidthMode: expected none, worldCoordinates or screenCoordinates, found \"thick\"",
        ),
        (
            v0(),
            format!("{properties}/textureProperties/_MainTex"),
            json!(5),
            "extensions.VRM.materialProperties[0].textureProperties._MainTex: expected a texture below 2, found 5",
        ),
        (
            v0(),
            format!("{properties}/vectorProperties/_Color"),
            json!([1]),
            "extensions.VRM.materialProperties[0].vectorProperties._Color: expected four numbers, found [1]",
        ),
        (
            v0(),
            format!("{properties}/floatProperties/_ShadeShift"),
            json!("x"),
            "extensions.VRM.materialProperties[0].floatProperties._ShadeShift: expected a finite number, found \"x\"",
        ),
    ] {
        *json.pointer_mut(&pointer).expect("a place in the file") = value;
        assert_eq!(read(&json).expect_err(expected).to_string(), format!("face.vrm: {expected}"));
    }
}
