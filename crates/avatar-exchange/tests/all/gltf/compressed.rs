//! Compressed and quantised data. The bytes were made by other programs: meshoptimizer 1.3 and Google's Draco
//! 1.5.7; what they mean is what those decode them to.

use crate::support::gltf::{Builder, I8, I16, U8, one_primitive};
use avatar_exchange::ImportError;
use glam::{Vec2, Vec3, Vec4};

/// The corners of a pyramid, its base first.
pub(super) const PYRAMID: [Vec3; 5] = [
    Vec3::new(0.0, 0.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
    Vec3::new(1.0, 0.0, 1.0),
    Vec3::new(0.0, 0.0, 1.0),
    Vec3::new(0.5, 2.0, 0.5),
];
const TRIANGLES: [[u32; 3]; 6] = [[0, 1, 2], [0, 2, 3], [0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]];

/// Its positions in the first and second version of the codec.
const POSITIONS: [&str; 2] = [
    "a000000133000000ffff0133c000007e7d7e0000000100c00000800000010cc00000ffff010c0000007e00000000000000000000000000\
     00000000000000000000000000000000000000",
    "a1da6a5a000800ff007f007e7e00100080001000ff0004007f000000000000000000000000000000000000000000010001",
];
/// Its triangles, the third one turned by a corner, and the same corners as a mere list.
const CORNERS: &str = "e1f00040021114007687566778a9866589689801690000";
const SEQUENCE: &str = "d10004040608040a100a000c0600080200040e00000000";

/// Filtered data: normals, colours, the positions times three as numbers with an exponent, and rotations.
const NORMALS: &str = "a0013fc000006c6b6b6c013fc000006f256bfe00000000000000000000000000000000000000000000000000000000000000817f00";
const COLORS: &str =
    "a1ff007e7d81ce00fdfdfe650083828000007d7ffe3100000000000000000000000000000000000000407fc1ff00";
const TRIPLED: &str = "a0000133c00000605f18000130800000cc000100c0000060000130800000cc00010cc000006047000130800000cc000000000000\
     00000000000000000000000000000000008e0000008e0000008e";
const ROTATIONS: &str = "a0010f000000fbfc010f000000b4b3013f000000c733fc013f000000d823b3010fc00000fbfca2010fc00000b4b365010cc00000\
     050600000000000000000000000000000000000000000000000000000000000000ff7f";

fn bytes(hex: &str) -> Vec<u8> {
    let digits: Vec<u8> = hex.bytes().filter(|digit| !digit.is_ascii_whitespace()).collect();
    let digit = |digit: u8| (digit as char).to_digit(16).expect("a hexadecimal digit") as u8;
    digits.chunks(2).map(|pair| 16 * digit(pair[0]) + digit(pair[1])).collect()
}

/// A view of packed data: where its bytes are, how many there are unpacked, and how they are read.
struct Packed<'p> {
    name: &'p str,
    data: &'p [u8],
    count: usize,
    stride: usize,
    mode: &'p str,
    filter: &'p str,
}

/// The accessor of a packed view. Its own buffer is the second one, which has no data.
fn packed(file: &mut Builder, packed: &Packed<'_>, accessor: &str) -> usize {
    let Packed { name, count, stride, mode, filter, .. } = packed;
    let plain = file.view(packed.data, "");
    let (offset, length) = file.range(plain);
    let byte_stride =
        if *mode == "ATTRIBUTES" { format!(r#""byteStride": {stride}, "#) } else { String::new() };
    let view = file.raw_view(format!(
        r#"{{"buffer": 1, "byteOffset": 0, "byteLength": {}, {byte_stride}"extensions": {{"{name}": {{"buffer": 0,
        "byteOffset": {offset}, "byteLength": {length}, "byteStride": {stride}, "count": {count}, "mode": "{mode}",
        "filter": "{filter}"}}}}}}"#,
        count * stride
    ));
    file.raw_accessor(format!(r#"{{"bufferView": {view}, "count": {count}, {accessor}}}"#))
}

const VEC3: &str = r#""componentType": 5126, "type": "VEC3""#;
const CORNER: &str = r#""componentType": 5123, "type": "SCALAR""#;

fn positions<'p>(name: &'p str, data: &'p [u8]) -> Packed<'p> {
    Packed { name, data, count: 5, stride: 12, mode: "ATTRIBUTES", filter: "NONE" }
}

/// The pyramid, packed by meshoptimizer.
pub(super) fn meshopt_pyramid(name: &str) -> (Builder, String) {
    let mut file = Builder::with_fallback(name);
    let version = usize::from(name.starts_with("KHR"));
    let position = packed(&mut file, &positions(name, &bytes(POSITIONS[version])), VEC3);
    let corners =
        Packed { name, data: &bytes(CORNERS), count: 18, stride: 2, mode: "TRIANGLES", filter: "NONE" };
    let corners = packed(&mut file, &corners, CORNER);
    (file, one_primitive(&format!(r#"{{"attributes": {{"POSITION": {position}}}, "indices": {corners}}}"#)))
}

#[test]
fn meshopt_unpacks_positions_and_triangles() {
    for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let (file, rest) = meshopt_pyramid(name);
        let scene = file.scene(&rest);
        let mesh = &scene.parts[0].mesh;
        assert_eq!(mesh.positions, PYRAMID);
        // The codec may turn a triangle, not flip it.
        let turned: Vec<_> = TRIANGLES.iter().map(|t| if *t == [0, 4, 1] { [1, 0, 4] } else { *t }).collect();
        assert_eq!(mesh.triangles, turned);
    }
    let name = "EXT_meshopt_compression";
    let mut file = Builder::with_fallback(name);
    let position = packed(&mut file, &positions(name, &bytes(POSITIONS[0])), VEC3);
    let corners =
        Packed { name, data: &bytes(SEQUENCE), count: 18, stride: 2, mode: "INDICES", filter: "NONE" };
    let corners = packed(&mut file, &corners, CORNER);
    let rest =
        one_primitive(&format!(r#"{{"attributes": {{"POSITION": {position}}}, "indices": {corners}}}"#));
    assert_eq!(file.scene(&rest).parts[0].mesh.triangles, TRIANGLES);
}

/// What the filters make of the bytes, as numbers of an attribute.
#[test]
fn meshopt_filters_normals_rotations_numbers_and_colors() {
    let name = "KHR_meshopt_compression";
    let mut file = Builder::with_fallback(name);
    let position = packed(&mut file, &positions(name, &bytes(POSITIONS[0])), VEC3);
    let octahedral =
        Packed { name, data: &bytes(NORMALS), count: 5, stride: 4, mode: "ATTRIBUTES", filter: "OCTAHEDRAL" };
    let normal =
        packed(&mut file, &octahedral, r#""componentType": 5120, "normalized": true, "type": "VEC3""#);
    let color =
        Packed { name, data: &bytes(COLORS), count: 5, stride: 4, mode: "ATTRIBUTES", filter: "COLOR" };
    let color = packed(&mut file, &color, r#""componentType": 5121, "normalized": true, "type": "VEC4""#);
    let exponential = Packed {
        name,
        data: &bytes(TRIPLED),
        count: 5,
        stride: 12,
        mode: "ATTRIBUTES",
        filter: "EXPONENTIAL",
    };
    let target = packed(&mut file, &exponential, VEC3);
    let attributes = format!(r#""POSITION": {position}, "NORMAL": {normal}, "COLOR_0": {color}"#);
    let primitive = format!(r#"{{"attributes": {{{attributes}}}, "targets": [{{"POSITION": {target}}}]}}"#);
    let scene = file.scene(&one_primitive(&primitive));
    let mesh = &scene.parts[0].mesh;
    let expected = [[0, -127, 0], [76, 102, 0], [0, 76, 102], [-76, 0, 102], [0, 127, 0]];
    let expected = expected.map(|n| Vec3::from_array(n.map(|x| x as f32 / 127.0)));
    assert_eq!(mesh.normals, expected);
    let expected =
        [[254, 1, 0, 255], [0, 254, 0, 128], [1, 0, 255, 0], [255, 255, 255, 255], [51, 102, 153, 204]];
    assert_eq!(mesh.colors, expected.map(|c| Vec4::from_array(c.map(|x| x as f32 / 255.0))));
    let moved: Vec<Vec3> = mesh.shapes[0].positions.per_vertex().collect();
    assert_eq!(moved, PYRAMID.map(|corner| 3.0 * corner));
}

#[test]
fn meshopt_unpacks_rotations_of_clips() {
    let name = "EXT_meshopt_compression";
    let mut file = Builder::with_fallback(name);
    let times = file.floats(&[0.0, 1.0, 2.0, 3.0, 4.0], "SCALAR");
    let rotations = Packed {
        name,
        data: &bytes(ROTATIONS),
        count: 5,
        stride: 8,
        mode: "ATTRIBUTES",
        filter: "QUATERNION",
    };
    let rotations =
        packed(&mut file, &rotations, r#""componentType": 5122, "normalized": true, "type": "VEC4""#);
    let scene = file.scene(&format!(
        r#""nodes": [{{}}], "animations": [{{"samplers": [{{"input": {times}, "output": {rotations}}}],
        "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "rotation"}}}}]}}]"#
    ));
    let expected = [
        [0, 0, 0, 32767],
        [0, 19660, 0, 26213],
        [16383, 16384, 16384, 16384],
        [32767, 0, 0, 0],
        [0, 0, -9175, 31456],
    ];
    let expected: Vec<f32> = expected.iter().flatten().map(|x| *x as f32 / 32767.0).collect();
    assert_eq!(scene.clips[0].channels[0].values, expected);
}

fn meshopt_error(change: impl Fn(String) -> String, data: &[u8]) -> ImportError {
    let name = "EXT_meshopt_compression";
    let mut file = Builder::with_fallback(name);
    let position = packed(&mut file, &positions(name, data), VEC3);
    file.change_last_view(change);
    file.error(&one_primitive(&format!(r#"{{"attributes": {{"POSITION": {position}}}}}"#)))
}

#[test]
fn damaged_packed_views_are_errors_with_their_place() {
    let whole = bytes(POSITIONS[0]);
    let place = "bufferView 1, EXT_meshopt_compression";
    let same = |view: String| view;
    for length in 0..whole.len() {
        assert_eq!(meshopt_error(same, &whole[..length]).place, place, "{length} bytes");
    }
    assert_eq!(meshopt_error(same, &[0xff; 74]).place, place);
    let changed = |right: &str, lie: &str| {
        let error = meshopt_error(|view| view.replace(right, lie), &whole);
        (error.place.replace(place, ""), error.found)
    };
    let found = |place: &str, found: &str| (place.to_owned(), found.to_owned());
    assert_eq!(changed("ATTRIBUTES", "POINTS"), found(", mode", "\"POINTS\""));
    assert_eq!(changed("NONE", "SHEER"), found(", filter", "\"SHEER\""));
    assert_eq!(changed(r#""count": 5"#, r#""count": -5"#), found(", count", "-5"));
    assert_eq!(changed(r#""count": 5"#, r#""count": 6"#), found("", "6 times 12"));
    assert_eq!(changed(r#""buffer": 0"#, r#""buffer": 9"#).0, "buffers");
    assert_eq!(changed(r#""buffer": 0,"#, "").0, ", buffer");
    // Few bytes that claim more than there is memory for.
    let many = "4294967292";
    let error = meshopt_error(
        |view| {
            let view = view.replace(r#""count": 5"#, r#""count": 357913941"#);
            view.replace(r#""byteLength": 60"#, &format!(r#""byteLength": {many}"#))
        },
        &whole,
    );
    assert_eq!((error.place.as_str(), error.found.as_str()), (place, many));
}

/// The pyramid with texture coordinates and colours, packed by Draco: first in the order of the file, then as
/// connected triangles.
const DRACO: [&str; 2] = [
    "445241434f02020100000006050100010200020300040101040202040303040001030009030000030902000102020400020202010001\
     01000c03cd0c2335330304e082f83f0000000000fcffff0000000003f03f00000000ff070000000101000b036926cd0c1bcd0c0305f5\
     9da4fc2f2000000000ff030000000101000903cd0c9919139d1903de90b0698061c6bc5c76d6cc8c0600000000ff0000000000000000\
     00000000000000000000400b00000000000000000000803f0a",
    "445241434f02020101000000050602050000026f01010110ff029940ff02994003ff0000000000010000010009030000020103090200\
     010201020204000201010101000c03cd0c1fcd0c6926035def9c000c0000ff17e07f0000e0ffff0700000100000000ff070000000000\
     000000000000000000000000400b050101000b0399191f6926034c0987ff03f8ff7f003c0803000000ab03ec5b8000000000ff030000\
     00000000000000000000803f0a010101000903cd0ccd0c0fcd0c9d190469ff80808786c6dc5c560604006801cb0000000000ff000000",
];

fn draco(data: &[u8], attributes: &str) -> (Builder, String) {
    let mut file = Builder::default();
    let view = file.view(data, "");
    let position = file.raw_accessor(format!(r#"{{"count": 5, {VEC3}}}"#));
    let uv = file.raw_accessor(r#"{"count": 5, "componentType": 5126, "type": "VEC2"}"#.to_owned());
    let color = r#"{"count": 5, "componentType": 5121, "normalized": true, "type": "VEC4"}"#;
    let color = file.raw_accessor(color.to_owned());
    let corners = file.raw_accessor(format!(r#"{{"count": 18, {CORNER}}}"#));
    let primitive = format!(
        r#"{{"attributes": {{"POSITION": {position}, "TEXCOORD_0": {uv}, "COLOR_0": {color}}}, "indices": {corners},
        "extensions": {{"KHR_draco_mesh_compression": {{"bufferView": {view}, "attributes": {{{attributes}}}}}}}}}"#
    );
    (file, one_primitive(&primitive))
}

const DRACO_ATTRIBUTES: &str = r#""POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2"#;

pub(super) fn draco_pyramid() -> (Builder, String) {
    draco(&bytes(DRACO[0]), DRACO_ATTRIBUTES)
}

#[test]
fn draco_unpacks_vertices_and_triangles() {
    let coordinates = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.500_488_76, 0.250_244_38];
    let coordinates: Vec<Vec2> = coordinates.chunks(2).map(|uv| Vec2::new(uv[0], uv[1])).collect();
    let colors: [[u8; 4]; 5] =
        [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [51, 102, 153, 204], [255, 255, 255, 0]];
    let connected = [[0, 1, 2], [2, 1, 3], [3, 1, 4], [1, 0, 4], [0, 2, 4], [3, 4, 2]];
    // Which corner of the pyramid each vertex is.
    for (data, corners, triangles) in
        [(DRACO[0], [0, 1, 2, 3, 4], TRIANGLES), (DRACO[1], [3, 4, 0, 1, 2], connected)]
    {
        let (file, rest) = draco(&bytes(data), DRACO_ATTRIBUTES);
        let scene = file.scene(&rest);
        let mesh = &scene.parts[0].mesh;
        assert_eq!(mesh.triangles, triangles);
        // Of 11 bits over the largest extent, as Draco's own decoder has them.
        let place = |corner: usize| {
            Vec3::from_array(PYRAMID[corner].to_array().map(|x| match x {
                1.0 => 1.000_488_5,
                0.5 => 0.500_244_26,
                x => x,
            }))
        };
        assert_eq!(mesh.positions, corners.map(place));
        assert_eq!(mesh.uvs, corners.map(|corner| coordinates[corner]));
        assert_eq!(mesh.colors, corners.map(|c| Vec4::from_array(colors[c].map(|x| f32::from(x) / 255.0))));
    }
}

#[test]
fn damaged_draco_data_are_errors_with_their_place() {
    let place = "mesh 0, primitive 0, KHR_draco_mesh_compression";
    for whole in DRACO.map(bytes) {
        for length in (0..whole.len()).step_by(3) {
            let (file, rest) = draco(&whole[..length], DRACO_ATTRIBUTES);
            assert_eq!(file.error(&rest).place, place, "{length} bytes");
        }
        // Bits that were flipped end in an error or in another mesh.
        for at in 0..whole.len() {
            for bit in 0..8 {
                let mut data = whole.clone();
                data[at] ^= 1 << bit;
                let (file, rest) = draco(&data, DRACO_ATTRIBUTES);
                let _ = crate::support::gltf::read(&file.glb(&rest));
            }
        }
    }
    let (file, rest) = draco(&bytes(DRACO[0]), &DRACO_ATTRIBUTES.replace('2', "7"));
    let error = file.error(&rest);
    assert_eq!((error.place.as_str(), error.expected.as_str()), (place, "an attribute 7 for COLOR_0"));
}

/// Integers for everything that the extension allows, also in targets; the node scales them back.
#[test]
fn quantised_meshes_are_where_they_were() {
    let mut file = Builder::default();
    let quantised: Vec<u8> = PYRAMID
        .iter()
        .flat_map(|p| [p.x, p.y, p.z].map(|x| (x * 500.0) as i16))
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let position = file.accessor(&quantised, I16, "VEC3", 5);
    let normal = file.accessor_with(&[0, 127, 0].repeat(5), I8, "VEC3", 5, r#", "normalized": true"#);
    let tangent = file.accessor_with(&[127, 0, 0, 0x81].repeat(5), I8, "VEC4", 5, r#", "normalized": true"#);
    let uv = file.accessor(&[2, 1].repeat(5), U8, "VEC2", 5);
    let up: Vec<u8> = [0, 50, 0].repeat(5).into_iter().flat_map(i16::to_le_bytes).collect();
    let moved = file.accessor(&up, I16, "VEC3", 5);
    let turned = file.accessor_with(&[127, 0x81, 0].repeat(5), I8, "VEC3", 5, r#", "normalized": true"#);
    let rest = format!(
        r#""nodes": [{{"mesh": 0, "scale": [0.002, 0.002, 0.002], "weights": [1]}}], "meshes": [{{"primitives": [
        {{"attributes": {{"POSITION": {position}, "NORMAL": {normal}, "TANGENT": {tangent}, "TEXCOORD_0": {uv}}},
        "targets": [{{"POSITION": {moved}, "NORMAL": {turned}}}]}}]}}]"#
    );
    let scene = file.scene(&rest);
    let (mesh, pose) = (&scene.parts[0].mesh, scene.rest());
    assert_eq!((mesh.uvs[0], mesh.tangents[0]), (Vec2::new(2.0, 1.0), Vec4::new(1.0, 0.0, 0.0, -1.0)));
    let mut out = mesh.deformed();
    let bones = scene.bones(&pose);
    avatar_mesh::deform(mesh, scene.bones_of(0, &bones), scene.weights_of(0, &pose), &mut out)
        .expect("it fits");
    for (found, corner) in out.positions.iter().zip(PYRAMID) {
        assert!((*found - corner - 0.1 * Vec3::Y).abs().max_element() < 1e-6, "{found} {corner}");
    }
    assert!(out.normals.iter().all(|normal| normal.abs_diff_eq(Vec3::X, 1e-6)), "{:?}", out.normals);
}
