//! OBJ, MakeHuman targets, COLLADA, MD5, BVH and FBX.

use crate::bytes::zlib_zeros;
use crate::{growing, growing_beside, measured, refused};
use avatar_exchange::memory;

/// What the library that reads FBX may hold of its own beside a scene.
fn beside(file: &[u8]) -> u64 {
    memory::share(memory::FBX_LIBRARY, file.len() as u64)
}

#[test]
fn obj_corners_and_groups() {
    growing("corners.obj", |count| {
        let face = format!("f{}\n", " 1 2 3".repeat(1000));
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", face.repeat((count / 1000).clamp(1, 300) as usize))
            .into_bytes()
    });
    growing("uvs.obj", |count| {
        // Every corner is a vertex of its own.
        let count = count.clamp(3, 200_000);
        let uvs: String = (0..count).map(|k| format!("vt {k} 0\n")).collect();
        let faces: String = (3..count).map(|k| format!("f 1/{} 2/{} 3/{k}\n", k - 2, k - 1)).collect();
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{uvs}{faces}").into_bytes()
    });
    growing("groups.obj", |count| {
        let groups: String =
            (0..count.min(50_000)).map(|k| format!("g{k}\nusemtl m{k}\nf 1 2 3\n")).collect();
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{groups}").into_bytes()
    });
    measured("index.obj", b"v 0 0 0\nf 4294967295 1 2\nf -2147483648 1 1\n", &[], 0);
}

#[test]
fn targets_of_obj() {
    let vertices: String = (0..100_000).map(|k| format!("v {k} 0 0\n")).collect();
    let base = format!("{vertices}f 1 2 3\n");
    let targets: Vec<String> = (0..500).map(|k| format!("{} 0 1 0\n{} 0 0 1\n", k, 99_999)).collect();
    let names: Vec<String> = (0..500).map(|k| format!("{k}.target")).collect();
    let further: Vec<(&str, &[u8])> =
        names.iter().zip(&targets).map(|(name, target)| (name.as_str(), target.as_bytes())).collect();
    measured("base.obj", base.as_bytes(), &further, 0);
    measured(
        "base.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        &[("far.target", b"4294967295 0 0 1\n")],
        0,
    );
}

fn dae(geometry: &str, nodes: &str, more: &str) -> Vec<u8> {
    format!(
        r##"<?xml version="1.0"?><COLLADA version="1.4.1" xmlns="http://www.collada.org/2005/11/COLLADASchema">
        <library_geometries><geometry id="g"><mesh>{geometry}</mesh></geometry></library_geometries>{more}
        <library_visual_scenes><visual_scene id="s">{nodes}</visual_scene></library_visual_scenes>
        <scene><instance_visual_scene url="#s"/></scene></COLLADA>"##
    )
    .into_bytes()
}

fn triangles(numbers: u64, claimed: u64, indices: u64) -> String {
    let floats = vec!["0 0 1"; numbers as usize].join(" ");
    let corners = vec!["0 1 2"; indices as usize].join(" ");
    format!(
        r##"<source id="p"><float_array id="f" count="{claimed}">{floats}</float_array><technique_common>
        <accessor source="#f" count="{claimed}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
        <param name="Z" type="float"/></accessor></technique_common></source>
        <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
        <triangles count="{claimed}"><input semantic="VERTEX" source="#v" offset="0"/><p>{corners}</p></triangles>"##
    )
}

#[test]
fn collada_counts_and_instances() {
    let node = r##"<node><instance_geometry url="#g"/></node>"##;
    refused("counts.dae", |count| dae(&triangles(3, count, 1), node, ""));
    growing("corners.dae", |count| dae(&triangles(3, 3, count.min(1 << 20)), node, ""));
    growing("nodes.dae", |count| {
        dae(&triangles(1_000, 1_000, 3_000), &node.repeat(count.min(1 << 14) as usize), "")
    });
    // Each node twice the one before.
    let doubled: String = (0..40)
        .map(|k| {
            let inner = format!(r##"<instance_node url="#n{}"/>"##, k + 1);
            format!(r#"<node id="n{k}">{inner}{inner}</node>"#)
        })
        .collect();
    let library = format!(
        r##"<library_nodes>{doubled}<node id="n40"><instance_geometry url="#g"/></node></library_nodes>"##
    );
    let outcome = measured(
        "doubled.dae",
        &dae(&triangles(3, 3, 1), r##"<node><instance_node url="#n0"/></node>"##, &library),
        &[],
        0,
    );
    assert!(!outcome.is_read());
}

#[test]
fn md5_counts() {
    let file = |vertices: u64, weights: u64, lines: &str| {
        format!(
            "MD5Version 10\ncommandline \"\"\nnumJoints 1\nnumMeshes 1\njoints {{\n\"root\" -1 ( 0 0 0 ) ( 0 0 0 )\n}}\nmesh {{\nshader \"s\"\n\
             numverts {vertices}\n{lines}numtris 1\ntri 0 0 1 2\nnumweights {weights}\nweight 0 0 1 ( 0 0 0 )\n}}\n"
        )
        .into_bytes()
    };
    let three = "vert 0 ( 0 0 ) 0 1\nvert 1 ( 0 0 ) 0 1\nvert 2 ( 0 0 ) 0 1\n";
    for count in [3, 4_000_000_000, u64::MAX] {
        measured("verts.md5mesh", &file(count, 1, three), &[], 0);
        measured("weights.md5mesh", &file(3, count, three), &[], 0);
        let wide = three.replace("0 1\n", &format!("0 {count}\n"));
        measured("wide.md5mesh", &file(3, 1, &wide), &[], 0);
    }
    let anim = |frames: u64, joints: u64, components: u64| {
        format!(
            "MD5Version 10\ncommandline \"\"\nnumFrames {frames}\nnumJoints {joints}\nframeRate 24\nnumAnimatedComponents {components}\n\
             hierarchy {{\n\"root\" -1 0 0\n}}\nbounds {{\n( 0 0 0 ) ( 0 0 0 )\n}}\nbaseframe {{\n( 0 0 0 ) ( 0 0 0 )\n}}\nframe 0 {{\n}}\n"
        )
    };
    for (frames, joints, components) in
        [(u64::MAX, 1, 0), (4_000_000_000, 1, 0), (1, 4_000_000_000, 0), (1, 1, 4_000_000_000)]
    {
        let anim = anim(frames, joints, components);
        measured("run.md5mesh", &file(3, 1, three), &[("run.md5anim", anim.as_bytes())], 0);
    }
}

#[test]
fn bvh_frames() {
    let file = |frames: u64, lines: &str| {
        format!(
            "HIERARCHY\nROOT hip\n{{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
             End Site\n{{\nOFFSET 0 1 0\n}}\n}}\nMOTION\nFrames: {frames}\nFrame Time: 0.01\n{lines}"
        )
        .into_bytes()
    };
    for frames in [1, 2_000_000_000, u64::MAX] {
        measured("frames.bvh", &file(frames, "0 0 0 0 0 0\n"), &[], 0);
    }
    growing("lines.bvh", |count| {
        let count = count.min(1 << 17);
        file(count, &"0 0 0 0 0 0\n".repeat(count as usize))
    });
}

#[test]
fn fbx_arrays() {
    let text = |count: u64, numbers: &str| {
        format!(
            "; FBX 7.4.0 project file\nFBXHeaderExtension: {{\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}}\nObjects: {{\n\
             Geometry: 1, \"Geometry::g\", \"Mesh\" {{\nVertices: *{count} {{\na: {numbers}\n}}\nPolygonVertexIndex: *{count} {{\na: 0,0,-1\n}}\n}}\n\
             Model: 2, \"Model::m\", \"Mesh\" {{\n}}\n}}\nConnections: {{\nC: \"OO\",1,2\nC: \"OO\",2,0\n}}\n"
        )
        .into_bytes()
    };
    for count in [9, 400_000_000, 4_000_000_000, u64::MAX] {
        let file = text(count, "0,0,0,1,0,0,0,1,0");
        measured("text.fbx", &file, &[], beside(&file));
    }
    for step in 4..12 {
        // Vertices and corners that are all zero, packed to a hundred and fiftieth.
        let count = 3 << (2 * step);
        let file = packed_fbx(count);
        measured(&format!("{count}.fbx"), &file, &[], beside(&file));
    }
}

/// A take of one curve, which moves places, angles and sizes of many nodes along all axes.
fn shared_curve(keys: usize, nodes: u64) -> Vec<u8> {
    let list = |number: &dyn Fn(usize) -> usize| {
        (0..keys).map(|key| number(key).to_string()).collect::<Vec<_>>().join(",")
    };
    let (times, values) = (list(&|key| key * 1_000), list(&|key| key % 7));
    let mut objects = format!(
        "AnimationStack: 1, \"AnimStack::take\", \"\" {{\n}}\nAnimationLayer: 2, \"AnimLayer::l\", \"\" {{\n}}\n\
         AnimationCurve: 3, \"AnimCurve::\", \"\" {{\nKeyTime: *{keys} {{\na: {times}\n}}\nKeyValueFloat: *{keys} {{\na: {values}\n}}\n\
         KeyAttrFlags: *1 {{\na: 4\n}}\nKeyAttrDataFloat: *4 {{\na: 0,0,0,0\n}}\nKeyAttrRefCount: *1 {{\na: {keys}\n}}\n}}\n"
    );
    let mut links = "C: \"OO\",2,1\n".to_owned();
    for model in (0..nodes).map(|node| 10 + 4 * node) {
        objects += &format!("Model: {model}, \"Model::a\", \"Null\" {{\n}}\n");
        links += &format!("C: \"OO\",{model},0\n");
        for (moved, name) in (model + 1..).zip(["Translation", "Rotation", "Scaling"]) {
            objects += &format!("AnimationCurveNode: {moved}, \"AnimCurveNode::{name}\", \"\" {{\n}}\n");
            links += &format!("C: \"OO\",{moved},2\nC: \"OP\",{moved},{model}, \"Lcl {name}\"\n");
            for axis in ["X", "Y", "Z"] {
                links += &format!("C: \"OP\",3,{moved}, \"d|{axis}\"\n");
            }
        }
    }
    format!(
        "; FBX 7.4.0 project file\nFBXHeaderExtension: {{\nFBXVersion: 7400\n}}\nObjects: {{\n{objects}}}\nConnections: {{\n{links}}}\n"
    )
    .into_bytes()
}

/// It is sampled for each of the nodes.
#[test]
fn fbx_curves_that_many_share() {
    growing_beside("curves.fbx", |count| shared_curve(2_000, count.min(1 << 14)), beside);
}

/// Sixty bones for some minutes, in less than a megabyte: keys count by what becomes of them, not for each
/// curve that asks for their times.
#[test]
fn a_long_take_of_fbx_is_read() {
    let file = shared_curve(10_000, 60);
    assert!(file.len() < 1 << 20);
    let outcome = measured("long.fbx", &file, &[], beside(&file));
    assert!(outcome.is_read(), "{outcome:?}");
}

/// A binary FBX of one mesh of so many numbers, all zero, its corners too.
fn packed_fbx(count: u64) -> Vec<u8> {
    let mut file = b"Kaydara FBX Binary  \0\x1a\0".to_vec();
    file.extend(7400_u32.to_le_bytes());
    let start = file.len();
    let long = |value: i64| [&b"L"[..], &value.to_le_bytes()].concat();
    let string = |text: &[u8]| [&b"S"[..], &(text.len() as u32).to_le_bytes(), text].concat();
    let array = |kind: u8, count: u64, size: u64| {
        let packed = zlib_zeros(count * size);
        let mut bytes = vec![kind];
        for number in [count, 1, packed.len() as u64] {
            bytes.extend((number as u32).to_le_bytes());
        }
        bytes.extend(packed);
        bytes
    };
    let geometry = Node {
        name: "Geometry",
        properties: vec![long(1), string(b"g\0\x01Geometry"), string(b"Mesh")],
        children: vec![
            Node::of("Vertices", vec![array(b'd', count, 8)]),
            Node::of("PolygonVertexIndex", vec![array(b'i', count, 4)]),
        ],
    };
    let model = Node::of("Model", vec![long(2), string(b"m\0\x01Model"), string(b"Mesh")]);
    let connect = |a, b| Node::of("C", vec![string(b"OO"), long(a), long(b)]);
    let roots = [
        Node { name: "Objects", properties: Vec::new(), children: vec![geometry, model] },
        Node { name: "Connections", properties: Vec::new(), children: vec![connect(1, 2), connect(2, 0)] },
    ];
    for root in &roots {
        root.write(&mut file);
    }
    file.extend([0; 13]);
    assert!(file.len() > start);
    file
}

/// A node of a binary FBX.
struct Node {
    name: &'static str,
    properties: Vec<Vec<u8>>,
    children: Vec<Node>,
}

impl Node {
    fn of(name: &'static str, properties: Vec<Vec<u8>>) -> Self {
        Self { name, properties, children: Vec::new() }
    }

    /// End, number of properties and their length, name, properties, children, and a node of zeros.
    fn write(&self, file: &mut Vec<u8>) {
        let start = file.len();
        let length: usize = self.properties.iter().map(Vec::len).sum();
        for number in [0, self.properties.len(), length] {
            file.extend((number as u32).to_le_bytes());
        }
        file.push(self.name.len() as u8);
        file.extend(self.name.as_bytes());
        self.properties.iter().for_each(|property| file.extend(property));
        if !self.children.is_empty() {
            self.children.iter().for_each(|child| child.write(file));
            file.extend([0; 13]);
        }
        let end = (file.len() as u32).to_le_bytes();
        file[start..start + 4].copy_from_slice(&end);
    }
}

/// Joints that take a few bytes of a file each.
#[test]
fn dense_joints() {
    growing("joints.bvh", |count| {
        let joints = "JOINT a\n{\nOFFSET 0 0 0\nCHANNELS 0\nEnd Site\n{\nOFFSET 0 0 0\n}\n}\n";
        let joints = joints.repeat(count.min(1 << 18) as usize);
        format!("HIERARCHY\nROOT a\n{{\nOFFSET 0 0 0\nCHANNELS 0\n{joints}}}\nMOTION\nFrames: 0\nFrame Time: 0.01\n")
            .into_bytes()
    });
    growing("chain.bvh", |count| {
        let count = count.min(1 << 17) as usize;
        let joints = "JOINT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n".repeat(count);
        let ends = "}\n".repeat(count);
        format!(
            "HIERARCHY\nROOT a\n{{\nOFFSET 0 0 0\nCHANNELS 0\n{joints}End Site\n{{\nOFFSET 0 0 0\n}}\n{ends}}}\nMOTION\nFrames: 0\nFrame Time: 0.01\n"
        )
        .into_bytes()
    });
    growing("joints.md5mesh", |count| {
        let count = count.min(1 << 18);
        let joints: String = (0..count).map(|k| format!("\"{k:x}\" -1 ( 0 0 0 ) ( 0 0 0 )\n")).collect();
        format!("MD5Version 10\ncommandline \"\"\nnumJoints {count}\nnumMeshes 0\njoints {{\n{joints}}}\n")
            .into_bytes()
    });
    growing("empty nodes.dae", |count| {
        dae(&triangles(3, 3, 1), &"<node/>".repeat(count.min(1 << 18) as usize), "")
    });
    growing("empty joints.dae", |count| {
        format!(
            r##"<?xml version="1.0"?><COLLADA version="1.4.1"><library_visual_scenes><visual_scene id="s">{}</visual_scene></library_visual_scenes>
            <scene><instance_visual_scene url="#s"/></scene></COLLADA>"##,
            r#"<node type="JOINT"/>"#.repeat(count.min(1 << 18) as usize)
        )
        .into_bytes()
    });
    growing("elements.dae", |count| dae(&"<a/>".repeat(count.min(1 << 20) as usize), "<node/>", ""));
    growing("materials.dae", |count| {
        let materials = "<material/>".repeat(count.min(1 << 18) as usize);
        dae(&triangles(3, 3, 1), "<node/>", &format!("<library_materials>{materials}</library_materials>"))
    });
    growing("materials.obj", |count| {
        let count = count.min(1 << 17);
        let faces: String = (0..count).map(|k| format!("usemtl {k:x}\nf 1 2 3\n")).collect();
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{faces}").into_bytes()
    });
    growing_beside(
        "models.fbx",
        |count| {
            let count = count.min(1 << 17);
            let models: String =
                (1..=count).map(|k| format!("Model: {k}, \"Model::a\", \"Null\" {{\n}}\n")).collect();
            format!("; FBX 7.4.0 project file\nFBXHeaderExtension: {{\nFBXVersion: 7400\n}}\nObjects: {{\n{models}}}\n").into_bytes()
        },
        beside,
    );
}
