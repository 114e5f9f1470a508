//! What materials of files say reaches the parts.
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_exchange::{
    AlphaMode, Material, Node, RawScene, Scene, SceneImage, ScenePart, TextureRef, ToonMaterial, UvSet, Wrap,
};
use avatar_look::{Alpha, Cartoon, Lighting, Standard};
use avatar_mesh::{Mesh, PartKind};
use avatar_pack::{Import, export};
use glam::{Vec2, Vec3, Vec4};

/// A part of this name with a material, whose pictures 0 and 1 have these opacities all over.
fn import(name: &str, material: Material, vertex_alpha: f32, alphas: [u8; 2]) -> Import {
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        uvs: vec![Vec2::ZERO; 3],
        uvs_1: vec![Vec2::ONE; 3],
        colors: if vertex_alpha < 1.0 { vec![Vec4::new(1.0, 1.0, 1.0, vertex_alpha); 3] } else { Vec::new() },
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let picture = |alpha| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        let picture = image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 150, 100, alpha]));
        picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a picture");
        SceneImage { name: format!("of {alpha}"), bytes: bytes.into_inner(), ..SceneImage::default() }
    };
    let scene = RawScene {
        nodes: vec![Node::default()],
        parts: vec![ScenePart { material: Some(0), ..ScenePart::rigid(name, 0, mesh) }],
        materials: vec![material],
        images: alphas.map(picture).to_vec(),
        ..RawScene::default()
    };
    Import::from_scene(Scene::from_raw(scene).expect("a scene")).expect("an avatar")
}

fn look(import: &Import) -> Standard {
    import.pack.material(0).standard.expect("a look of the file's")
}

#[test]
fn what_is_opaque_all_over_is_drawn_as_opaque_whatever_the_mode() {
    let of = |alpha_mode, factor, vertex, picture| {
        let material = Material {
            alpha_mode,
            alpha_cutoff: 0.6,
            base_color: [1.0, 1.0, 1.0, factor],
            base_color_texture: Some(0.into()),
            ..Material::default()
        };
        look(&import("plate", material, vertex, [picture, 255])).alpha
    };
    assert_eq!(of(AlphaMode::Opaque, 0.1, 0.1, 0), Alpha::Opaque);
    assert_eq!(of(AlphaMode::Mask, 1.0, 1.0, 255), Alpha::Opaque);
    assert_eq!(of(AlphaMode::Mask, 0.7, 1.0, 255), Alpha::Opaque);
    assert_eq!(of(AlphaMode::Mask, 1.0, 1.0, 100), Alpha::Mask(0.6));
    assert_eq!(of(AlphaMode::Mask, 1.0, 0.5, 255), Alpha::Mask(0.6));
    assert_eq!(of(AlphaMode::Blend, 1.0, 1.0, 255), Alpha::Opaque);
    assert_eq!(of(AlphaMode::Blend, 0.5, 1.0, 255), Alpha::Blend);
    assert_eq!(of(AlphaMode::Blend, 1.0, 0.9, 255), Alpha::Blend);
    assert_eq!(of(AlphaMode::Blend, 1.0, 1.0, 254), Alpha::Blend);
}

#[test]
fn skin_is_what_is_called_so_and_says_no_more_than_skin_can_show() {
    let plain = Material { metallic: 0.0, base_color_texture: Some(0.into()), ..Material::default() };
    let kind = |name: &str, material: Material| import(name, material, 1.0, [100, 255]).pack.parts()[0].kind;
    assert_eq!(kind("face", plain.clone()), PartKind::Skin);
    assert_eq!(kind("plate", plain.clone()), PartKind::Surface);
    for more in [
        Material { alpha_mode: AlphaMode::Mask, ..plain.clone() },
        Material { is_unlit: true, ..plain.clone() },
        Material { toon: Some(ToonMaterial::default()), ..plain.clone() },
        Material { emissive: [0.1, 0.0, 0.0], ..plain.clone() },
        Material {
            base_color_texture: Some(TextureRef { uvs: UvSet::Second, ..TextureRef::from(0) }),
            ..plain.clone()
        },
    ] {
        assert_eq!(kind("face", more.clone()), PartKind::Surface, "{more:?}");
    }
}

#[test]
fn looks_survive_the_way_to_a_scene_and_back() {
    let second = |image| Some(TextureRef { image, uvs: UvSet::Second, wrap: [Wrap::Clamp, Wrap::Mirror] });
    let material = Material {
        name: "plate".to_owned(),
        base_color: [0.5, 0.6, 0.7, 0.8],
        base_color_texture: second(0),
        metallic: 0.3,
        roughness: 0.4,
        metallic_roughness_texture: Some(1.into()),
        occlusion_texture: second(1),
        occlusion_strength: 0.5,
        emissive: [0.1, 0.2, 3.0],
        emissive_texture: Some(1.into()),
        alpha_mode: AlphaMode::Mask,
        alpha_cutoff: 0.7,
        double_sided: true,
        ..Material::default()
    };
    let unlit = Material { is_unlit: true, alpha_mode: AlphaMode::Blend, ..material.clone() };
    let toon = ToonMaterial { shade_color: [0.1, 0.2, 0.3], outline_width: 0.01, ..ToonMaterial::default() };
    let cartoon = Material { toon: Some(toon), ..material.clone() };
    for from in [material, unlit, cartoon] {
        let first = import("plate", from.clone(), 1.0, [100, 255]);
        let raw = export(&first.pack, &first.textures);
        let again = Import::from_scene(Scene::from_raw(raw).expect("a scene")).expect("an avatar");
        assert_eq!(look(&again), look(&first), "{from:?}");
        let wraps = |import: &Import| import.textures.of_part(0, import.pack.parts()[0].kind).wraps;
        let clamped = [avatar_look::Wrap::Clamp, avatar_look::Wrap::Mirror];
        assert_eq!((wraps(&first).color, wraps(&first).occlusion), (clamped, clamped));
        assert_eq!(wraps(&first).emissive, [avatar_look::Wrap::Repeat; 2]);
        assert_eq!(wraps(&again), wraps(&first));
    }
}

#[test]
fn a_cartoon_reaches_its_part_as_the_file_has_it() {
    let toon = ToonMaterial {
        shade_color: [0.1, 0.2, 0.3],
        shade_texture: Some(1.into()),
        shading_shift: -0.2,
        shading_toony: 0.8,
        outline_width: 0.01,
        outline_color: [0.4, 0.0, 0.0],
    };
    let import =
        import("body", Material { toon: Some(toon.clone()), ..Material::default() }, 1.0, [255, 255]);
    let expected = Cartoon {
        shade_color: toon.shade_color,
        shading_shift: toon.shading_shift,
        shading_toony: toon.shading_toony,
        outline_width: toon.outline_width,
        outline_color: toon.outline_color,
    };
    assert_eq!(look(&import).lighting, Lighting::Cartoon(expected));
    assert!(import.textures.of_part(0, PartKind::Surface).shade.is_some());
    assert!(!import.report.notes.iter().any(|note| note.contains("not drawn")), "{:?}", import.report.notes);
}
