//! One small file for each extension that is known, and the table of `docs/formats.md`.

use super::compressed::{PYRAMID, draco_pyramid, meshopt_pyramid};
use crate::support::gltf::{Builder, I8, I16, one_primitive, read};
use avatar_exchange::gltf::{EXTENSIONS, Support, support_of};
use avatar_exchange::{Finding, ImportError, Scene, TextureRef};
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;

fn extension_note(scene: &Scene, name: &str) -> bool {
    scene.notes.iter().any(|note| note.finding == Finding::Extension(name.to_owned()))
}

/// A file that has the extension, lists it, and requires it or not.
fn file_with(name: &str, required: bool) -> Result<Scene, ImportError> {
    let required = if required { format!(r#", "extensionsRequired": ["{name}"]"#) } else { String::new() };
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"name": "hip"}}], "extensionsUsed": ["{name}"]{required},
        "extensions": {{"{name}": {{}}}}}}"#
    );
    read(json.as_bytes())
}

#[test]
fn each_known_extension_is_read_noted_or_refused() {
    for known in EXTENSIONS {
        let (name, required) = (known.name, file_with(known.name, true));
        let optional = file_with(name, false).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(extension_note(&optional, name), known.support != Support::Read, "{name}");
        match known.support {
            Support::Read => shows_its_effect(name),
            Support::Vrm | Support::Noted => {
                assert!(extension_note(&required.expect(name), name), "{name}");
            }
            Support::Refused => {
                let error = required.expect_err(name);
                assert_eq!((error.place.as_str(), error.found), ("extensionsRequired", format!("'{name}'")));
            }
        }
    }
    let names: BTreeSet<_> = EXTENSIONS.iter().map(|known| known.name).collect();
    assert_eq!(names.len(), EXTENSIONS.len(), "each once");
}

/// Geometry and motion are refused by name; what only looks have, or the file as a whole, is a note.
#[test]
fn an_unknown_required_extension_is_refused_where_geometry_has_it() {
    assert_eq!(support_of("ACME_anvil"), None);
    let own = r#""extensions": {"ACME_anvil": {}}"#;
    let file = |place: &str, required: bool| {
        let required = if required { r#""extensionsRequired": ["ACME_anvil"],"# } else { "" };
        read(format!(r#"{{"asset": {{"version": "2.0"}}, {required} {place}}}"#).as_bytes())
    };
    for place in [
        String::from(r#""nodes": []"#),
        own.to_owned(),
        format!(r#""materials": [{{{own}}}]"#),
        format!(
            r#""materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0, {own}}}}}}}], "textures": [{{}}]"#
        ),
        format!(r#""textures": [{{{own}}}], "images": [{{{own}}}], "samplers": [{{{own}}}]"#),
        format!(r#""cameras": [{{"type": "perspective", "perspective": {{"yfov": 1, "znear": 1}}, {own}}}]"#),
        format!(r#""scenes": [{{"nodes": [], {own}}}]"#),
        // Their own words for anything.
        format!(r#""nodes": [{{"extras": {{{own}}}}}]"#),
    ] {
        let scene = file(&place, true).unwrap_or_else(|error| panic!("{place}: {error}"));
        assert!(extension_note(&scene, "ACME_anvil"), "{place}");
    }
    for place in [
        format!(r#""nodes": [{{{own}}}]"#),
        format!(r#""meshes": [{{"primitives": [], {own}}}]"#),
        format!(r#""meshes": [{{"primitives": [{{"attributes": {{}}, {own}}}]}}]"#),
        format!(r#""accessors": [{{"count": 1, "componentType": 5126, "type": "SCALAR", {own}}}]"#),
        format!(r#""buffers": [{{"byteLength": 0, "uri": "data:,", {own}}}]"#),
        format!(r#""skins": [{{"joints": [0], {own}}}], "nodes": [{{}}]"#),
        format!(r#""animations": [{{"channels": [], "samplers": [], {own}}}]"#),
    ] {
        assert_eq!(file(&place, true).expect_err(&place).found, "'ACME_anvil'");
        let scene = file(&place, false).unwrap_or_else(|error| panic!("{place}: {error}"));
        assert!(extension_note(&scene, "ACME_anvil"), "{place}");
    }
}

/// Wherever an object has it, and though the file does not list it.
#[test]
fn an_extension_that_is_not_listed_is_noted() {
    let at = |place: &str| {
        place.replace('@', r#""extensions": {"ACME_anvil": {"extensions": {"ACME_hammer": 1}}}"#)
    };
    for place in [
        r#""asset": {"version": "2.0", @}"#,
        r#""asset": {"version": "2.0"}, "scenes": [{"nodes": [], @}]"#,
        r#""asset": {"version": "2.0"}, "nodes": [{@}]"#,
        r#""asset": {"version": "2.0"}, "samplers": [{@}]"#,
        r#""asset": {"version": "2.0"}, "buffers": [{"byteLength": 3, "uri": "data:,abc", @}]"#,
        r#""asset": {"version": "2.0"}, "meshes": [{"primitives": [{"attributes": {}, @}]}]"#,
        r#""asset": {"version": "2.0"}, "animations": [{"channels": [], "samplers": [], @}]"#,
    ] {
        let scene = read(format!("{{{}}}", at(place)).as_bytes()).expect("a scene");
        assert!(extension_note(&scene, "ACME_anvil") && extension_note(&scene, "ACME_hammer"), "{place}");
    }
    let extras = r#"{"asset": {"version": "2.0"}, "extras": {"extensions": {"ACME_anvil": 1}}}"#;
    assert!(read(extras.as_bytes()).expect("a scene").notes.is_empty(), "a program's own data");
}

/// A scene of a file that requires an extension and uses it as `rest` says.
fn requires(file: &Builder, name: &str, rest: &str) -> Scene {
    let scene =
        file.scene(&format!(r#""extensionsUsed": ["{name}"], "extensionsRequired": ["{name}"], {rest}"#));
    assert!(!extension_note(&scene, name), "{:?}", scene.notes);
    scene
}

/// A triangle with texture coordinates whose material is this.
fn with_material(name: &str, material: &str) -> Scene {
    let mut file = Builder::default();
    let position = file.triangle();
    let uv = file.floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0], "VEC2");
    let rest = format!(
        r#""nodes": [{{"mesh": 0}}], "materials": [{material}], "textures": [{{"source": 0}}],
        "images": [{{"uri": "data:image/png;base64,Zm9v"}}], "meshes": [{{"primitives": [
        {{"attributes": {{"POSITION": {position}, "TEXCOORD_0": {uv}}}, "material": 0}}]}}]"#
    );
    requires(&file, name, &rest)
}

/// A file in which an extension that is read makes a difference.
fn shows_its_effect(name: &str) {
    match name {
        "KHR_animation_pointer" => {
            let mut file = Builder::default();
            let (times, values) = (file.floats(&[0.0], "SCALAR"), file.floats(&[1.0, 2.0, 3.0], "VEC3"));
            let rest = format!(
                r#""nodes": [{{}}], "animations": [{{"samplers": [{{"input": {times}, "output": {values}}}], "channels": [
                {{"sampler": 0, "target": {{"path": "pointer", "extensions": {{"{name}": {{"pointer": "/nodes/0/translation"}}}}}}}}]}}]"#
            );
            let scene = requires(&file, name, &rest);
            let pose = scene.at(0, 0.0).expect("a clip");
            assert_eq!(scene.worlds(&pose)[0].translation.as_vec3(), Vec3::new(1.0, 2.0, 3.0));
        }
        "KHR_draco_mesh_compression" => {
            let (file, rest) = draco_pyramid();
            let scene = requires(&file, name, &rest);
            assert_eq!(scene.parts[0].mesh.triangles.len(), 6);
        }
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            let (file, rest) = meshopt_pyramid(name);
            assert_eq!(requires(&file, name, &rest).parts[0].mesh.positions, PYRAMID);
        }
        "KHR_materials_emissive_strength" => {
            let material = format!(
                r#"{{"emissiveFactor": [1, 0.5, 0], "extensions": {{"{name}": {{"emissiveStrength": 4}}}}}}"#
            );
            assert_eq!(with_material(name, &material).materials[0].emissive, [4.0, 2.0, 0.0]);
        }
        "KHR_materials_pbrSpecularGlossiness" => {
            // It reflects what all do that are no metals, so its base colour is the diffuse one.
            let material = format!(
                r#"{{"extensions": {{"{name}": {{"diffuseFactor": [0.48, 0.24, 0.12, 0.5], "specularFactor": [0.04, 0.04, 0.04],
                "glossinessFactor": 0.25, "diffuseTexture": {{"index": 0}}}}}}}}"#
            );
            let scene = with_material(name, &material);
            let found = &scene.materials[0];
            let [r, g, b, a] = found.base_color;
            assert!(
                (Vec3::new(r, g, b) - Vec3::new(0.48, 0.24, 0.12)).abs().max_element() < 1e-6,
                "{found:?}"
            );
            assert_eq!((a, found.metallic, found.roughness), (0.5, 0.0, 0.75));
            assert_eq!(found.base_color_texture, Some(0.into()));
            assert!(scene.notes.iter().any(|note| note.to_string().contains(name)), "it is not exact");
        }
        "KHR_materials_unlit" => {
            let material = format!(r#"{{"extensions": {{"{name}": {{}}}}}}"#);
            assert!(with_material(name, &material).materials[0].is_unlit);
        }
        "KHR_mesh_quantization" => {
            let mut file = Builder::default();
            let position = file.accessor(
                &[0, 0, 0, 0, 0, 0, 0xe8, 3, 0, 0, 0, 0, 0, 0, 0x18, 0xfc, 0, 0],
                I16,
                "VEC3",
                3,
            );
            let normal = file.accessor_with(
                &[0, 0, 127, 0, 0, 127, 0, 0, 127],
                I8,
                "VEC3",
                3,
                r#", "normalized": true"#,
            );
            let moved = file.accessor(&[0, 0, 0, 0, 5, 0, 0, 0, 0xfb], I8, "VEC3", 3);
            let primitive = format!(
                r#"{{"attributes": {{"POSITION": {position}, "NORMAL": {normal}}}, "targets": [{{"POSITION": {moved}}}]}}"#
            );
            let scene = requires(&file, name, &one_primitive(&primitive));
            let mesh = &scene.parts[0].mesh;
            assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X * 1000.0, Vec3::Y * -1000.0]);
            assert_eq!(mesh.normals, [Vec3::Z; 3]);
            assert_eq!(
                (mesh.shapes[0].positions.get(1), mesh.shapes[0].positions.get(2)),
                (Some(Vec3::Y * 5.0), Some(Vec3::Z * -5.0))
            );
        }
        "KHR_node_visibility" => {
            let mut file = Builder::default();
            let position = file.triangle();
            let rest = format!(
                r#""nodes": [{{"extensions": {{"{name}": {{"visible": false}}}}, "children": [1]}}, {{"mesh": 0}}, {{"mesh": 0}}],
                "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {position}}}}}]}}]"#
            );
            let scene = requires(&file, name, &rest);
            assert_eq!(scene.parts.iter().map(|part| part.node).collect::<Vec<_>>(), [2]);
        }
        "KHR_texture_transform" => {
            let material = format!(
                r#"{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0, "extensions": {{"{name}": {{"offset": [0.5, 0], "scale": [2, 3]}}}}}}}}}}"#
            );
            let scene = with_material(name, &material);
            assert_eq!(
                scene.parts[0].mesh.uvs,
                [Vec2::new(0.5, 0.0), Vec2::new(2.5, 0.0), Vec2::new(0.5, 3.0)]
            );
            let used = TextureRef::from(0);
            assert_eq!(scene.materials[0].base_color_texture, Some(used));
        }
        "EXT_mesh_gpu_instancing" => {
            let mut file = Builder::default();
            let position = file.triangle();
            let moved = file.floats(&[0.0, 0.0, 5.0, 0.0, 0.0, 7.0], "VEC3");
            let rest = format!(
                r#""nodes": [{{"mesh": 0, "extensions": {{"{name}": {{"attributes": {{"TRANSLATION": {moved}}}}}}}}}],
                "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {position}}}}}]}}]"#
            );
            let scene = requires(&file, name, &rest);
            let worlds = scene.worlds(&scene.rest());
            let places: Vec<_> = scene.parts.iter().map(|part| worlds[part.node].translation.z).collect();
            assert_eq!(places, [5.0, 7.0]);
        }
        "EXT_texture_webp" => {
            let rest = format!(
                r#""images": [{{"uri": "data:image/png;base64,Zm9v"}}, {{"uri": "data:image/webp;base64,Zm9v"}}],
                "textures": [{{"source": 0, "extensions": {{"{name}": {{"source": 1}}}}}}],
                "materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}}}}]"#
            );
            let scene = requires(&Builder::default(), name, &rest);
            assert_eq!(scene.materials[0].base_color_texture, Some(1.into()));
        }
        _ => panic!("{name} is said to be read, and no file here shows it"),
    }
}

/// The rows of the two tables are all extensions that are known, by what becomes of them.
#[test]
fn the_table_of_extensions_is_true() {
    let text = include_str!("../../../../../docs/formats.md");
    let rows_of = |head: &str| -> Vec<Vec<String>> {
        let rows = text.split_once(head).unwrap_or_else(|| panic!("no table {head}")).1;
        let rows = rows.lines().skip(2).take_while(|line| line.starts_with('|'));
        rows.map(|row| row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect())
            .collect()
    };
    let names =
        |cell: &str| -> BTreeSet<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let known = |support: Support| -> BTreeSet<String> {
        EXTENSIONS
            .iter()
            .filter(|known| known.support == support)
            .map(|known| known.name.to_owned())
            .collect()
    };
    let read: BTreeSet<String> =
        rows_of("| extension | read as |").iter().flat_map(|row| names(&row[0])).collect();
    assert_eq!(read, known(Support::Read));
    let others = rows_of("| other extensions | |");
    let (all, supports) = (others.len(), [Support::Vrm, Support::Noted, Support::Refused]);
    assert_eq!(all, supports.len());
    for (row, support) in others.iter().zip(supports) {
        assert_eq!(names(&row[1]), known(support), "{}", row[0]);
    }
}
