//! glTF: counts of accessors without data, sparse ones, buffers and URIs, meshes at many nodes.

use crate::bytes::base64;
use crate::{growing, measured, refused};

/// A scene of one node with a mesh, of these accessors: 0 is POSITION, of `count`; the rest is given.
pub(crate) fn file(mesh: &str, accessors: &[String], more: &str) -> Vec<u8> {
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

pub(crate) fn vec3(count: u64) -> String {
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
    refused("joints.gltf", |count| {
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

/// Lists of a glTF file, and the shortest of their elements that mean something.
const LISTS: [(&str, &str); 13] = [
    ("nodes", "{}"),
    ("materials", "{}"),
    ("accessors", r#"{"componentType":5126,"count":1,"type":"SCALAR"}"#),
    ("animations", r#"{"channels":[],"samplers":[]}"#),
    ("buffers", r#"{"byteLength":0,"uri":"data:,"}"#),
    ("bufferViews", r#"{"buffer":0,"byteLength":0}"#),
    ("cameras", r#"{"type":"orthographic"}"#),
    ("images", "{}"),
    ("meshes", r#"{"primitives":[]}"#),
    ("samplers", "{}"),
    ("scenes", "{}"),
    ("skins", r#"{"joints":[0]}"#),
    ("textures", "{}"),
];

/// Most elements of such a list.
const MOST: u64 = 1 << 19;

fn list(name: &str, element: &str, count: u64) -> Vec<u8> {
    let elements = vec![element; count.min(MOST) as usize].join(",");
    let node = if name == "nodes" { "" } else { r#""nodes":[{}],"# };
    format!(r#"{{"asset":{{"version":"2.0"}},{node}"{name}":[{elements}]}}"#).into_bytes()
}

/// Structures take more than the text that they stand in, whatever becomes of them.
#[test]
fn dense_lists() {
    for (name, element) in LISTS {
        growing(&format!("{name}.gltf"), |count| list(name, element, count));
    }
}

/// One long name of a node and many shapes that two nodes have at different weights: each gets a control of
/// both names.
#[test]
fn long_names() {
    growing("names.gltf", |count| {
        let (name, shapes) = ("a".repeat(count.min(1 << 20) as usize), 1_500);
        let list = |what: &dyn Fn(usize) -> String| (0..shapes).map(what).collect::<Vec<_>>().join(",");
        let nodes = [1, 2].map(|rest| {
            format!(r#"{{"name":"{name}","mesh":0,"weights":[{}]}}"#, list(&|_| format!("0.{rest}")))
        });
        let targets = list(&|_| r#"{"POSITION":0}"#.to_owned());
        let names = list(&|shape| format!(r#""s{shape}""#));
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],"nodes":[{}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{targets}]}}],
            "extras":{{"targetNames":[{names}]}}}}],"accessors":[{}]}}"#,
            nodes.join(","),
            vec3(3)
        )
        .into_bytes()
    });
}

/// What readers pass over, though it is no valid JSON, does not hide what comes behind it.
#[test]
fn behind_what_is_passed_over() {
    let deep = format!("{}{}", "[".repeat(200), "]".repeat(200));
    for odd in ["1e999", r#""\ud800""#, deep.as_str()] {
        growing("materials.gltf", |count| {
            let materials = vec!["{}"; count.min(MOST) as usize].join(",");
            format!(r#"{{"asset":{{"version":"2.0"}},"odd":{odd},"nodes":[{{}}],"materials":[{materials}]}}"#)
                .into_bytes()
        });
    }
}

/// What the structures keep as it is: extensions, extras, smallest and largest values.
#[test]
fn dense_values() {
    for element in [r#"{"":0}"#, "[]", "0", r#""""#, "{}", "[0]"] {
        let values = |count: u64| vec![element; count.min(MOST) as usize].join(",");
        growing("extensions of a node.gltf", |count| {
            list("nodes", &format!(r#"{{"extensions":{{"X":[{}]}}}}"#, values(count)), 1)
        });
        growing("extensions of nodes.gltf", |count| {
            list("nodes", &format!(r#"{{"extensions":{{"X":{element}}}}}"#), count)
        });
        growing("extras of a mesh.gltf", |count| {
            list(
                "meshes",
                &format!(r#"{{"primitives":[],"extras":{{"targetNames":[{}]}}}}"#, values(count)),
                1,
            )
        });
        growing("bounds of an accessor.gltf", |count| {
            let bounds = values(count);
            let accessor = format!(
                r#"{{"componentType":5126,"count":1,"type":"SCALAR","max":[{bounds}],"min":[{bounds}]}}"#
            );
            list("accessors", &accessor, 1)
        });
    }
    growing("extensions.gltf", |count| list("extensionsUsed", r#""x""#, count));
    growing("distinct extensions.gltf", |count| {
        let names: Vec<String> = (0..count.min(MOST)).map(|name| format!(r#""{name:x}""#)).collect();
        list("extensionsUsed", &names.join(","), 1)
    });
    let names = |count: u64| (0..count.min(MOST)).map(|name| format!(r#"{{"name":"{name:x}"}}"#));
    growing("names.gltf", |count| list("nodes", &names(count).collect::<Vec<_>>().join(","), 1));
    growing("primitives.gltf", |count| {
        let primitives = vec![r#"{"attributes":{}}"#; count.min(MOST) as usize].join(",");
        list("meshes", &format!(r#"{{"primitives":[{primitives}]}}"#), 1)
    });
    growing("channels.gltf", |count| {
        // One that has no node makes a tree of all.
        for target in [r#"{"path":"scale"}"#, r#"{"node":0,"path":"scale"}"#] {
            let channels = vec![format!(r#"{{"sampler":0,"target":{target}}}"#); count.min(MOST) as usize];
            let animation = format!(r#"{{"samplers":[],"channels":[{}]}}"#, channels.join(","));
            measured("channel.gltf", &list("animations", &animation, 1), &[], 0);
        }
        list("nodes", "{}", 1)
    });
}

/// VRM of both versions: what its extensions list.
#[test]
fn dense_avatars() {
    let file = |extension: &str, value: &str| {
        let bones = r#"{"humanoid":{"humanBones":[{"bone":"head","node":0}]},"#;
        let value = if value.contains("humanoid") { value.to_owned() } else { value.replacen('{', bones, 1) };
        format!(r#"{{"asset":{{"version":"2.0"}},"nodes":[{{}}],"meshes":[{{"primitives":[]}}],"extensions":{{"{extension}":{value}}}}}"#)
            .into_bytes()
    };
    let many = |element: &str, count: u64| vec![element; count.min(MOST) as usize].join(",");
    for element in ["{}", r#"{"presetName":"joy"}"#] {
        growing("groups.vrm", |count| {
            let value =
                format!(r#"{{"blendShapeMaster":{{"blendShapeGroups":[{}]}}}}"#, many(element, count));
            file("VRM", &value)
        });
    }
    for (list, element) in [
        ("secondaryAnimation\":{\"boneGroups", r#"{"bones":[0]}"#),
        ("secondaryAnimation\":{\"colliderGroups", r#"{"node":0,"colliders":[{}]}"#),
        ("humanoid\":{\"humanBones", r#"{"bone":"head","node":0}"#),
        ("firstPerson\":{\"meshAnnotations", r#"{"mesh":0}"#),
    ] {
        growing(&format!("{}.vrm", list.replace("\":{\"", ".")), |count| {
            let list = list.replace('\\', "");
            file("VRM", &format!(r#"{{"{list}":[{}]}}}}"#, many(element, count)))
        });
    }
    growing("materials.vrm", |count| {
        file("VRM", &format!(r#"{{"materialProperties":[{}]}}"#, many("{}", count)))
    });
    for (list, element) in [
        ("springs", r#"{"joints":[{"node":0}]}"#),
        ("colliders", r#"{"node":0,"shape":{"sphere":{}}}"#),
        ("colliderGroups", r#"{"colliders":[]}"#),
    ] {
        growing(&format!("{list}.vrm"), |count| {
            format!(
                r#"{{"asset":{{"version":"2.0"}},"nodes":[{{}}],"extensions":{{
                "VRMC_vrm":{{"specVersion":"1.0","humanoid":{{"humanBones":{{"head":{{"node":0}}}}}}}},
                "VRMC_springBone":{{"specVersion":"1.0","{list}":[{}]}}}}}}"#,
                many(element, count)
            )
            .into_bytes()
        });
    }
    // Kept beside the structures for the reader of VRM.
    growing("constraints.vrm", |count| {
        let node = format!(r#"{{"extensions":{{"VRMC_unknown":[{}]}}}}"#, many(r#"{"":0}"#, count));
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{node}],"extensions":{{
            "VRMC_vrm":{{"specVersion":"1.0","humanoid":{{"humanBones":{{"head":{{"node":0}}}}}}}}}}}}"#
        )
        .into_bytes()
    });
    growing("custom.vrm", |count| {
        let custom: Vec<String> = (0..count.min(MOST)).map(|name| format!(r#""{name:x}":{{}}"#)).collect();
        file(
            "VRMC_vrm",
            &format!(
                r#"{{"specVersion":"1.0","humanoid":{{"humanBones":{{"head":{{"node":0}}}}}},"expressions":{{"custom":{{{}}}}}}}"#,
                custom.join(",")
            ),
        )
    });
}

/// Instances of a node: as many as accessors without data claim.
#[test]
fn instances() {
    growing("instances.gltf", |count| {
        let all = r#"{"TRANSLATION":1,"ROTATION":2,"SCALE":1}"#;
        let (count, node) = (
            count - count % 3,
            format!(r#"{{"mesh":0,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{all}}}}}}}"#),
        );
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{node}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{},{},{}]}}"#,
            vec3(3),
            vec3(count),
            accessor("VEC4", 5126, count)
        )
        .into_bytes()
    });
}
