//! glTF: counts of accessors without data, sparse ones, buffers and URIs, meshes at many nodes, pictures.

use crate::bytes::{base64, black_png};
use crate::{growing, measured};

/// A scene of one node with a mesh, of these accessors: 0 is POSITION, of `count`; the rest is given.
fn file(mesh: &str, accessors: &[String], more: &str) -> Vec<u8> {
    let accessors = accessors.join(",");
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{mesh}],"accessors":[{accessors}]{more}}}"#
    )
    .into_bytes()
}

fn accessor(kind: &str, component: u32, count: u64) -> String {
    format!(r#"{{"componentType":{component},"count":{count},"type":"{kind}","min":[0,0,0],"max":[0,0,0]}}"#)
}

fn vec3(count: u64) -> String {
    accessor("VEC3", 5126, count)
}

#[test]
fn accessors_without_data() {
    let mesh = r#"{"primitives":[{"attributes":{"POSITION":0}}]}"#;
    growing("positions.gltf", |count| file(mesh, &[vec3(count - count % 3)], ""));
    let all = r#"{"primitives":[{"attributes":{"POSITION":0,"NORMAL":0,"TANGENT":1,"TEXCOORD_0":2,"TEXCOORD_1":2,"COLOR_0":1}}]}"#;
    growing("attributes.gltf", |count| {
        let count = count - count % 3;
        file(all, &[vec3(count), accessor("VEC4", 5126, count), accessor("VEC2", 5126, count)], "")
    });
    let indexed = r#"{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}"#;
    growing("indices.gltf", |count| file(indexed, &[vec3(3), accessor("SCALAR", 5125, count * 3)], ""));
    let strip = r#"{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5}]}"#;
    growing("strip.gltf", |count| file(strip, &[vec3(3), accessor("SCALAR", 5121, count)], ""));
}

#[test]
fn targets_without_data() {
    growing("targets.gltf", |count| {
        let targets = vec![r#"{"POSITION":0}"#; 64].join(",");
        let mesh = format!(r#"{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{targets}]}}]}}"#);
        file(&mesh, &[vec3(count - count % 3)], "")
    });
    growing("many_targets.gltf", |count| {
        let targets = vec![r#"{"POSITION":0}"#; count.min(1 << 15) as usize].join(",");
        let mesh = format!(r#"{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{targets}]}}]}}"#);
        file(&mesh, &[vec3(count.saturating_mul(3).min(3 << 20))], "")
    });
}

/// All vertices moved, each shape from the same few bytes: dense offsets without any in the file.
#[test]
fn sparse_accessors() {
    let buffer = base64(&[[0, 0, 0, 0].as_slice(), &1.0_f32.to_le_bytes(), &[0; 8]].concat());
    let more = format!(
        r#","buffers":[{{"byteLength":16,"uri":"data:application/octet-stream;base64,{buffer}"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":4}},{{"buffer":0,"byteOffset":4,"byteLength":12}}]"#
    );
    let sparse = |count: u64| {
        format!(
            r#"{{"componentType":5126,"count":{count},"type":"VEC3","min":[0,0,0],"max":[1,0,0],
            "sparse":{{"count":1,"indices":{{"bufferView":0,"componentType":5125}},"values":{{"bufferView":1}}}}}}"#
        )
    };
    let mesh = r#"{"primitives":[{"attributes":{"POSITION":0}}]}"#;
    growing("sparse.gltf", |count| file(mesh, &[sparse(count - count % 3)], &more));
    growing("sparse_targets.gltf", |count| {
        let targets = vec![r#"{"POSITION":0}"#; 200].join(",");
        let mesh = format!(r#"{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{targets}]}}]}}"#);
        file(&mesh, &[sparse(count - count % 3)], &more)
    });
}

#[test]
fn buffers_that_are_not_there() {
    let mesh = r#"{"primitives":[{"attributes":{"POSITION":0}}]}"#;
    let view = |length: u64, uri: &str| {
        format!(
            r#","buffers":[{{"byteLength":{length}{uri}}}],"bufferViews":[{{"buffer":0,"byteLength":{length}}}]"#
        )
    };
    let accessor = r#"{"bufferView":0,"componentType":5126,"count":300000000,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}"#;
    for uri in ["", r#","uri":"data:application/octet-stream;base64,AAAA""#, r#","uri":"more.bin""#] {
        let outcome =
            measured("buffer.gltf", &file(mesh, &[accessor.to_owned()], &view(4_000_000_000, uri)), &[], 0);
        assert!(!outcome.is_read(), "{uri}");
    }
}

/// Data of the file that many share: it is unpacked for each of them.
#[test]
fn meshes_at_many_nodes() {
    let scene = |nodes: u64, count: u64, mesh: &str, extra: &str| {
        let nodes_of: Vec<String> = (0..nodes).map(|_| format!(r#"{{"mesh":0{extra}}}"#)).collect();
        let roots: Vec<String> = (0..nodes).map(|node| node.to_string()).collect();
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],
            "meshes":[{mesh}],"accessors":[{}]}}"#,
            roots.join(","),
            nodes_of.join(","),
            vec3(count)
        )
        .into_bytes()
    };
    let mesh = r#"{"primitives":[{"attributes":{"POSITION":0}}]}"#;
    growing("nodes.gltf", |nodes| scene(nodes.min(1 << 14), (nodes * 3).min(30_000), mesh, ""));
    let targets = vec![r#"{"POSITION":0}"#; 50].join(",");
    let mesh = format!(r#"{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{targets}]}}]}}"#);
    growing("faces.gltf", |nodes| scene(nodes.min(1 << 14), (nodes * 3).min(3_000), &mesh, ""));
    let primitives = vec![r#"{"attributes":{"POSITION":0}}"#; 4_000].join(",");
    let mesh = format!(r#"{{"primitives":[{primitives}]}}"#);
    growing("primitives.gltf", |count| scene(1, count - count % 3, &mesh, ""));
}

/// Nodes and names alone.
#[test]
fn many_nodes_and_shapes() {
    growing("chain.gltf", |count| {
        let count = count.min(1 << 18);
        let nodes: Vec<String> = (0..count)
            .map(|node| {
                if node + 1 < count {
                    format!(r#"{{"children":[{}]}}"#, node + 1)
                } else {
                    r#"{"mesh":0}"#.to_owned()
                }
            })
            .collect();
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{}]}}"#,
            nodes.join(","),
            vec3(3)
        )
        .into_bytes()
    });
}

#[test]
fn skins_and_animations_without_data() {
    let scene = |more: &str, accessors: &[String]| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
            "nodes":[{{"mesh":0,"skin":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}}}]}}],
            "accessors":[{}]{more}}}"#,
            accessors.join(",")
        )
        .into_bytes()
    };
    growing("skin.gltf", |count| {
        let count = count - count % 3;
        let accessors = [vec3(count), accessor("VEC4", 5121, count), accessor("VEC4", 5126, count)];
        scene(r#","skins":[{"joints":[0]}]"#, &accessors)
    });
    growing("joints.gltf", |count| {
        let joints = vec!["0"; count.min(65_000) as usize].join(",");
        let accessors =
            [vec3(3), accessor("VEC4", 5121, 3), accessor("VEC4", 5126, 3), accessor("MAT4", 5126, count)];
        scene(&format!(r#","skins":[{{"joints":[{joints}],"inverseBindMatrices":3}}]"#), &accessors)
    });
    growing("keys.gltf", |count| {
        let accessors = [
            vec3(3),
            accessor("VEC4", 5121, 3),
            accessor("VEC4", 5126, 3),
            accessor("SCALAR", 5126, count),
            accessor("VEC3", 5126, count),
        ];
        let channels = vec![r#"{"sampler":0,"target":{"node":0,"path":"translation"}}"#; 100].join(",");
        scene(
            &format!(
                r#","skins":[{{"joints":[0]}}],"animations":[{{"samplers":[{{"input":3,"output":4}}],"channels":[{channels}]}}]"#
            ),
            &accessors,
        )
    });
}

#[test]
fn pictures_of_one_colour() {
    for (side, copies) in [(16_384, 1), (4_096, 12)] {
        let png = base64(&black_png(side));
        let images = vec![format!(r#"{{"uri":"data:image/png;base64,{png}"}}"#); copies].join(",");
        let list = |what: &dyn Fn(usize) -> String| (0..copies).map(what).collect::<Vec<_>>().join(",");
        let textures = list(&|image| format!(r#"{{"source":{image}}}"#));
        let materials = list(&|image| {
            format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{image}}}}}}}"#)
        });
        let primitives =
            list(&|material| format!(r#"{{"attributes":{{"POSITION":0}},"material":{material}}}"#));
        let mesh = format!(r#"{{"primitives":[{primitives}]}}"#);
        let more = format!(r#","images":[{images}],"textures":[{textures}],"materials":[{materials}]"#);
        let outcome = measured("picture.gltf", &file(&mesh, &[vec3(3)], &more), &[], 0);
        assert!(outcome.is_read(), "without the picture, with a note: {outcome:?}");
    }
}
