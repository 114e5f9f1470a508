//! glTF: pictures, and data that Draco or meshoptimizer packed.

use crate::bytes::{base64, black_png, meshopt_zeros, plain_webp};
use crate::gltf::{file, vec3};
use crate::{growing, measured};
use avatar_exchange::gltf;
use avatar_mesh::PartKind;
use avatar_pack::Import;

#[test]
fn pictures_of_one_colour() {
    for (side, copies) in [(16_384, 1), (4_096, 12), (2_048, 20), (16, 1)] {
        for (mime, bytes) in [("image/png", black_png(side)), ("image/webp", plain_webp(side))] {
            let image = format!(r#"{{"uri":"data:{mime};base64,{}"}}"#, base64(&bytes));
            let images = vec![image; copies].join(",");
            let list = |what: &dyn Fn(usize) -> String| (0..copies).map(what).collect::<Vec<_>>().join(",");
            let textures = list(&|image| match mime {
                "image/png" => format!(r#"{{"source":{image}}}"#),
                _ => format!(r#"{{"extensions":{{"EXT_texture_webp":{{"source":{image}}}}}}}"#),
            });
            let materials = list(&|image| {
                format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{image}}}}}}}"#)
            });
            let primitives =
                list(&|material| format!(r#"{{"attributes":{{"POSITION":0}},"material":{material}}}"#));
            let mesh = format!(r#"{{"primitives":[{primitives}]}}"#);
            let more = format!(r#","images":[{images}],"textures":[{textures}],"materials":[{materials}]"#);
            let file = file(&mesh, &[vec3(3)], &more);
            let outcome = measured(&format!("{side}.picture.gltf"), &file, &[], 0);
            assert!(outcome.is_read(), "without the picture, with a note: {outcome:?}");
            if side == 16 {
                let scene = gltf::read("picture.gltf", &file, &mut |_| Err("no files".to_owned()));
                let import = Import::from_scene(scene.expect("it was read before")).expect("as well");
                assert_eq!(import.textures.warnings, [], "{mime}");
                let picture = import.textures.of_part(0, PartKind::Surface).color;
                assert_eq!(picture.map(|picture| picture.dimensions()), Some((16, 16)), "{mime}");
            }
        }
    }
}

/// A pyramid of five corners with texture coordinates and colours, packed by Draco.
const DRACO: &str = "445241434f02020100000006050100010200020300040101040202040303040001030009030000030902000102020400020202010001\
     01000c03cd0c2335330304e082f83f0000000000fcffff0000000003f03f00000000ff070000000101000b036926cd0c1bcd0c0305f5\
     9da4fc2f2000000000ff030000000101000903cd0c9919139d1903de90b0698061c6bc5c76d6cc8c0600000000ff0000000000000000\
     00000000000000000000400b00000000000000000000803f0a";

/// The same few packed bytes, unpacked for each primitive.
#[test]
fn packed_data_that_many_share() {
    let bytes: Vec<u8> = (0..DRACO.len() / 2)
        .map(|at| u8::from_str_radix(&DRACO[2 * at..2 * at + 2], 16).expect("hex"))
        .collect();
    let padded: Vec<u8> = bytes.iter().copied().chain(vec![0; (3 - bytes.len() % 3) % 3]).collect();
    let buffer = format!(
        r#""buffers":[{{"byteLength":{0},"uri":"data:application/octet-stream;base64,{1}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{0}}}]"#,
        bytes.len(),
        base64(&padded)
    );
    let primitive = r#"{"attributes":{"POSITION":0},"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,
        "attributes":{"POSITION":0}}}}"#;
    growing("draco.gltf", |count| {
        let primitives = vec![primitive; count.min(1 << 15) as usize].join(",");
        file(&format!(r#"{{"primitives":[{primitives}]}}"#), &[vec3(5)], &format!(",{buffer}"))
    });
}

#[test]
fn views_that_are_packed() {
    const STRIDE: usize = 12;
    let view = |vertices: usize, packed: usize| {
        format!(
            r#"{{"buffer":1,"byteLength":{},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,
            "byteLength":{packed},"byteStride":{STRIDE},"count":{vertices},"mode":"ATTRIBUTES"}}}}}}"#,
            STRIDE * vertices
        )
    };
    let scene = |vertices: usize, views: usize| {
        let packed = meshopt_zeros(vertices, STRIDE);
        let data = format!("data:application/octet-stream;base64,{}", base64(&packed));
        let views = vec![view(vertices, packed.len()); views].join(",");
        let more = format!(
            r#","buffers":[{{"byteLength":{},"uri":"{data}"}},
            {{"byteLength":{},"extensions":{{"EXT_meshopt_compression":{{"fallback":true}}}}}}],"bufferViews":[{views}]"#,
            packed.len(),
            STRIDE * vertices
        );
        let accessor = vec3(vertices as u64).replacen('{', r#"{"bufferView":0,"#, 1);
        file(r#"{"primitives":[{"attributes":{"POSITION":0}}]}"#, &[accessor], &more)
    };
    assert!(measured("one.gltf", &scene(768, 1), &[], 0).is_read());
    growing("packed.gltf", |count| scene(768 * (count as usize).min(1 << 13), 1));
    growing("views.gltf", |count| scene(768, (count as usize).min(1 << 17)));
}
