//! Damaged and lying files: an error with a place or a scene that can be posed, never a panic, in little
//! time.

use crate::support::data::shared_data;
use crate::support::gltf::{Builder, floats, glb, one_primitive, read};
use avatar_exchange::{ImportError, Scene, gltf};
use avatar_mesh::deform;
use std::time::{Duration, Instant};

/// Far more than any file here takes, far less than what an unchecked count would.
const LIMIT: Duration = Duration::from_secs(5);

/// Uses everything that a scene says.
fn exercise(scene: &Scene) {
    let mut poses = vec![scene.rest()];
    for (number, clip) in scene.clips.iter().enumerate() {
        for time in [-1.0, 0.3 * clip.duration_secs(), f64::INFINITY, f64::NAN] {
            poses.push(scene.at(number, time).expect("a clip"));
        }
    }
    for pose in &poses {
        let bones = scene.bones(pose);
        for (number, part) in scene.parts.iter().enumerate() {
            let mut out = part.mesh.deformed();
            let (bones, weights) = (scene.bones_of(number, &bones), scene.weights_of(number, pose));
            deform(&part.mesh, bones, weights, &mut out).expect("a checked part");
        }
    }
}

/// Reads what may be broken. Whether it was.
fn survives(bytes: &[u8], resolve: &mut avatar_exchange::Resolve<'_>) -> bool {
    let start = Instant::now();
    let result = gltf::read("damaged", bytes, resolve);
    let took = start.elapsed();
    assert!(took < LIMIT, "{took:?}");
    match result {
        Ok(scene) => {
            exercise(&scene);
            false
        }
        Err(error) => {
            assert!(
                !error.place.is_empty() && !error.expected.is_empty() && !error.found.is_empty(),
                "{error:?}"
            );
            assert_eq!(error.file, "damaged");
            true
        }
    }
}

/// A GLB with everything: hierarchy, skin, targets (one sparse), clips of all kinds, a material with an
/// image.
fn small_sample() -> Vec<u8> {
    let mut file = Builder::default();
    let position = file.triangle();
    let normal = file.floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0], "VEC3");
    let joints = file.accessor(&[0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0], crate::support::gltf::U8, "VEC4", 3);
    let weights = file.floats(&[0.5, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], "VEC4");
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let binds = file.floats(&[identity, identity].concat(), "MAT4");
    let (index, value) = (file.view(&[1, 0], ""), file.view(&floats(&[1.0, 2.0, 3.0]), ""));
    let sparse = file.raw_accessor(format!(
        r#"{{"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {{"count": 1,
        "indices": {{"bufferView": {index}, "componentType": 5123}}, "values": {{"bufferView": {value}}}}}}}"#
    ));
    let indices = file.accessor(&[0, 1, 2], crate::support::gltf::U8, "SCALAR", 3);
    let times = file.floats(&[0.0, 1.0], "SCALAR");
    let straight = file.floats(&[0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0], "VEC4");
    let spline = file.floats(&[0.5; 18], "VEC3");
    let blend = file.floats(&[0.0, 1.0, 1.0, 0.0], "SCALAR");
    let image = file.view(b"\x89PNG....", "");
    file.glb(&format!(
        r#""scene": 0, "scenes": [{{"nodes": [0, 1]}}], "nodes": [{{"mesh": 0, "skin": 0}}, {{"children": [2]}}, {{"name": "tip"}}],
        "meshes": [{{"extras": {{"targetNames": ["a", "b"]}}, "primitives": [{{"attributes": {{"POSITION": {position}, "NORMAL": {normal},
        "JOINTS_0": {joints}, "WEIGHTS_0": {weights}}}, "indices": {indices}, "material": 0,
        "targets": [{{"POSITION": {sparse}}}, {{"POSITION": {position}, "NORMAL": {normal}}}]}}]}}],
        "skins": [{{"joints": [1, 2], "inverseBindMatrices": {binds}}}],
        "materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}}}}],
        "textures": [{{"source": 0}}], "images": [{{"bufferView": {image}, "mimeType": "image/png"}}],
        "animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 1, "path": "rotation"}}}},
        {{"sampler": 1, "target": {{"node": 2, "path": "translation"}}}}, {{"sampler": 2, "target": {{"node": 0, "path": "weights"}}}}],
        "samplers": [{{"input": {times}, "output": {straight}}},
        {{"input": {times}, "output": {spline}, "interpolation": "CUBICSPLINE"}},
        {{"input": {times}, "output": {blend}, "interpolation": "STEP"}}]}}]"#
    ))
}

#[test]
fn the_sample_is_whole_and_every_cut_of_it_is_not() {
    let sample = small_sample();
    exercise(&read(&sample).expect("a scene"));
    for length in 0..sample.len() {
        assert!(survives(&sample[..length], &mut |_| Err("none".to_owned())), "{length} bytes are a scene");
    }
}

/// A small generator of numbers (xorshift64, Marsaglia 2003), so that failures can be repeated.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit as u64) as usize
    }
}

#[test]
fn flipped_bits_never_panic() {
    let sample = small_sample();
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut broken, rounds) = (0, 6000);
    for _ in 0..rounds {
        let mut damaged = sample.clone();
        for _ in 0..=random.below(3) {
            let at = random.below(damaged.len());
            damaged[at] ^= 1 << random.below(8);
        }
        broken += usize::from(survives(&damaged, &mut |_| Err("none".to_owned())));
    }
    assert!(broken > rounds / 4 && broken < rounds, "{broken} of {rounds} were noticed");
}

/// Digits of the JSON become other numbers: counts, offsets, positions, types.
#[test]
fn numbers_that_lie_never_panic() {
    let sample = small_sample();
    let json_length = u32::from_le_bytes(*sample[12..].first_chunk().expect("a word")) as usize;
    let json = std::str::from_utf8(&sample[20..20 + json_length]).expect("JSON").to_owned();
    let bin = &sample[28 + json_length..];
    let lies = [
        "-1",
        "0",
        "1",
        "3",
        "255",
        "65536",
        "4294967295",
        "4294967296",
        "18446744073709551615",
        "1e300",
        "0.5",
        "null",
    ];
    let (mut tried, mut broken, mut at) = (0, 0, 0);
    while let Some(start) = json[at..].find(|c: char| c.is_ascii_digit()).map(|found| at + found) {
        let end = json[start..].find(|c: char| !c.is_ascii_digit()).map_or(json.len(), |found| start + found);
        for lie in lies {
            let lying = format!("{}{lie}{}", &json[..start], &json[end..]);
            broken += usize::from(survives(&glb(&lying, bin), &mut |_| Err("none".to_owned())));
            tried += 1;
        }
        at = end;
    }
    assert!(tried > 1000 && broken > tried / 2, "{broken} of {tried} were noticed");
}

#[test]
fn published_files_cut_and_damaged() {
    let files = [
        ("khronos-gltf/RiggedSimple", "RiggedSimple.glb"),
        ("khronos-gltf/SimpleSkin", "SimpleSkin.gltf"),
        ("khronos-gltf/SimpleMorph/glTF", "SimpleMorph.gltf"),
        ("khronos-gltf/AnimatedMorphCube/glTF", "AnimatedMorphCube.gltf"),
        ("khronos-gltf/MorphPrimitivesTest/glTF", "MorphPrimitivesTest.gltf"),
    ];
    let mut random = Random(7);
    for (folder, file) in files {
        let Some(folder) = shared_data(folder) else { continue };
        let bytes = std::fs::read(folder.join(file)).expect("a file");
        let mut resolve = |uri: &str| std::fs::read(folder.join(uri)).map_err(|error| error.to_string());
        assert!(!survives(&bytes, &mut resolve), "{file}");
        let text = bytes.trim_ascii_end().len();
        for length in (0..text).step_by(64) {
            assert!(survives(&bytes[..length], &mut resolve), "{file}: {length} bytes are a scene");
        }
        for _ in 0..300 {
            let mut damaged = bytes.clone();
            let at = random.below(damaged.len());
            damaged[at] ^= 1 << random.below(8);
            survives(&damaged, &mut resolve);
        }
        // What it refers to is cut, too; the name and the place say which.
        let mut cut = |uri: &str| Ok(std::fs::read(folder.join(uri)).expect("a file")[..50].to_vec());
        if file.ends_with("gltf") && file != "SimpleSkin.gltf" {
            let error = gltf::read(file, &bytes, &mut cut).expect_err("a short buffer");
            assert_eq!((error.file.as_str(), error.place.as_str()), (file, "buffer 0"), "{error}");
        }
    }
}

/// The error of JSON text.
fn wrong(json: &str) -> ImportError {
    let start = Instant::now();
    let error = read(json.as_bytes()).expect_err("an error");
    assert!(start.elapsed() < LIMIT, "{:?}", start.elapsed());
    error
}

#[test]
fn hierarchies_are_forests() {
    let asset = r#"{"asset": {"version": "2.0"}"#;
    let cycle = wrong(&format!(r#"{asset}, "nodes": [{{}}, {{"children": [2]}}, {{"children": [1]}}]}}"#));
    assert!(cycle.place == "node 1 ''" && cycle.found == "a cycle", "{cycle}");
    let own = wrong(&format!(r#"{asset}, "nodes": [{{"children": [0]}}]}}"#));
    assert_eq!(own.found, "a cycle");
    let two = wrong(&format!(r#"{asset}, "nodes": [{{"children": [2]}}, {{"children": [2]}}, {{}}]}}"#));
    assert!(two.place == "node 1, children" && two.found.contains("child of node 0"), "{two}");
    let missing = wrong(&format!(r#"{asset}, "nodes": [{{"children": [1]}}]}}"#));
    assert_eq!((missing.expected.as_str(), missing.found.as_str()), ("nodes below 1", "1"));

    // As deep as it gets.
    let chain: Vec<_> = (1..=200_000).map(|child| format!(r#"{{"children": [{child}]}}"#)).collect();
    let chain = format!(r#"{asset}, "nodes": [{}, {{}}]}}"#, chain.join(","));
    let start = Instant::now();
    let scene = read(chain.as_bytes()).expect("a chain");
    assert_eq!(scene.worlds(&scene.rest()).len(), 200_001);
    assert!(start.elapsed() < LIMIT);
    let nested = format!(r#"{asset}, "extras": {}1{}}}"#, "[".repeat(500_000), "]".repeat(500_000));
    assert!(read(nested.as_bytes()).is_ok(), "extras are not looked into");
    let nested =
        format!(r#"{asset}, "extensions": {{"x": {}1{}}}}}"#, "[".repeat(500_000), "]".repeat(500_000));
    assert!(wrong(&nested).found.contains("recursion"));
}

/// Valid: the list of nodes of a scene is optional.
#[test]
fn scenes_may_be_empty() {
    let json = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{}, {"nodes": [0]}], "nodes": [{"name": "hip"}]}"#;
    assert_eq!(read(json.as_bytes()).expect("a scene").nodes[0].name, "hip");
}

#[test]
fn versions_and_extensions_that_are_not_read() {
    let error = wrong(r#"{"asset": {"version": "1.0"}}"#);
    assert_eq!((error.place.as_str(), error.found.as_str()), ("asset.version", "'1.0'"));
    // In glTF 1.0 lists are objects, and some exporters wrote the version as a number.
    for (version, found) in [(r#""1.0""#, "'1.0'"), ("1", "1"), ("1.1", "1.1")] {
        let first = format!(
            r#"{{"accessors": {{"a": {{}}}}, "asset": {{"version": {version}}}, "scenes": {{"s": {{}}}}}}"#
        );
        let error = wrong(&first);
        assert_eq!((error.place.as_str(), error.found.as_str()), ("asset.version", found), "{error}");
    }
    let error = wrong(r#"{"asset": {"version": "2.1", "minVersion": "2.1"}}"#);
    assert_eq!(error.place, "asset.minVersion");
    let error = wrong(
        r#"{"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_mesh_quantization", "KHR_gaussian_splatting", "ACME_anvil"],
        "nodes": [{"extensions": {"ACME_anvil": {}}}]}"#,
    );
    assert_eq!(
        (error.place.as_str(), error.found.as_str()),
        ("extensionsRequired", "'KHR_gaussian_splatting', 'ACME_anvil'")
    );
    let many = vec![r#""ACME_anvil""#; 1000].join(", ");
    let error = wrong(&format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsRequired": [{many}], "nodes": [{{"extensions": {{"ACME_anvil": {{}}}}}}]}}"#
    ));
    assert!(error.found.ends_with(" and 992 more") && error.found.len() < 200, "{error}");
}

#[test]
fn addresses_do_not_lead_out_of_the_folder() {
    for uri in [
        "../x.bin",
        "/x.bin",
        "a/%2e%2e/%2e%2e/x",
        "file:///x",
        "C:/x",
        "data:application/octet-stream;base64,A",
    ] {
        let json =
            format!(r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 1, "uri": "{uri}"}}]}}"#);
        let mut asked = false;
        let mut resolve = |_: &str| {
            asked = true;
            Ok(vec![0; 9])
        };
        let error = gltf::read("test", json.as_bytes(), &mut resolve).expect_err("an error");
        assert!(error.place == "buffer 0" && !asked, "{error}");
    }
    let json = r#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": "a%20b.bin"}, {"byteLength": 2, "uri": "a%20b.bin"}]}"#;
    let mut asked = Vec::new();
    let mut resolve = |uri: &str| {
        asked.push(uri.to_owned());
        Ok(vec![0; 9])
    };
    gltf::read("test", json.as_bytes(), &mut resolve).expect("a scene");
    assert_eq!(asked, ["a b.bin"], "once");
}

#[test]
fn a_missing_picture_is_a_note() {
    let json = br#"{"asset": {"version": "2.0"}, "images": [{"uri": "skin.png"}, {"uri": "data:image/png;base64,Zm9v"}]}"#;
    let scene = read(json).expect("a scene");
    assert_eq!((scene.images[0].name.as_str(), scene.images[0].bytes.len()), ("skin.png", 0));
    assert_eq!((scene.images[1].mime.as_str(), scene.images[1].bytes.as_slice()), ("image/png", &b"foo"[..]));
    assert_eq!(scene.notes[0].to_string(), "image 0: expected the file 'skin.png', found no other files");
}

/// Small files that describe more than there is memory for.
#[test]
fn claims_are_limited_by_the_size_of_the_file() {
    for count in [100_000_000u64, 4_000_000_000, u64::MAX] {
        let mut file = Builder::default();
        let position =
            file.raw_accessor(format!(r#"{{"componentType": 5126, "type": "VEC3", "count": {count}}}"#));
        let error = file.error(&one_primitive(&format!(r#"{{"attributes": {{"POSITION": {position}}}}}"#)));
        assert_eq!(error.place, "accessor 0", "{error}");
    }
    // Many primitives of one accessor.
    let mut file = Builder::default();
    let position = file.floats(&vec![0.0; 3 * 50_000], "VEC3");
    let primitive = format!(r#"{{"attributes": {{"POSITION": {position}}}}}"#);
    let start = Instant::now();
    let error = file.error(&one_primitive(&vec![primitive; 2000].join(", ")));
    assert!(error.place.starts_with("mesh 0") || error.place.starts_with("accessor 0"), "{error}");
    assert!(start.elapsed() < LIMIT, "{:?}", start.elapsed());
}

/// Lists that are read once for each of many nodes.
#[test]
fn many_nodes_with_one_long_mesh_end_soon() {
    let nodes = vec![r#"{"mesh":0}"#; 20_000].join(",");
    let long = format!(r#"{{"attributes":{{"_{}":0}}}}"#, "x".repeat(300_000));
    let many = vec![r#"{"attributes":{}}"#; 20_000].join(",");
    let targets = format!(r#"{{"attributes":{{}},"targets":[{}]}}"#, vec!["{}"; 100_000].join(","));
    for primitives in [long, many, targets] {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{primitives}]}}],"nodes":[{nodes}]}}"#
        );
        assert!(wrong(&json).place.starts_with("mesh 0"));
    }
    let channel = r#"{"sampler":0,"target":{"node":0,"path":"?"}}"#;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{}}],"animations":[{{"name":"{}","samplers":[],"channels":[{}]}}]}}"#,
        "é".repeat(500_000),
        vec![channel; 10_000].join(",")
    );
    let start = Instant::now();
    let scene = read(json.as_bytes()).expect("a scene");
    assert!(scene.notes.len() == 10_000 && scene.notes[0].place.len() < 200, "{}", scene.notes[0]);
    assert!(start.elapsed() < LIMIT, "{:?}", start.elapsed());
}

/// Lists in the place of objects, which the structures take for their members in order.
#[test]
fn arrays_instead_of_objects_are_errors() {
    let target = r#"[[], [{"channels": [{"sampler": 0, "target": {}}], "samplers": []}]]"#;
    for json in [target, "[]", "[[]]", "null", "7", "", r#"{"asset": []}"#, r#"{"asset": {"version": 2}}"#] {
        assert!(!wrong(json).place.is_empty());
    }
}

#[test]
fn views_and_accessors_beyond_their_bytes() {
    let beyond = |view: &str, accessor: &str| {
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 36}}], "bufferViews": [{{"buffer": 0, {view}}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", {accessor}}}], {}}}"#,
            one_primitive(r#"{"attributes": {"POSITION": 0}}"#)
        );
        read(&glb(&json, &[0; 36])).err().map(|error| error.place)
    };
    let whole = r#""byteLength": 36"#;
    let view = |place: &str| Some(place.to_owned());
    assert_eq!(beyond(whole, r#""count": 3"#), None);
    assert_eq!(beyond(whole, r#""count": 4"#), view("accessor 0 in bufferView 0"));
    assert_eq!(beyond(whole, r#""count": 3, "byteOffset": 1"#), view("accessor 0 in bufferView 0"));
    assert_eq!(
        beyond(whole, r#""count": 1, "byteOffset": 18446744073709551615"#),
        view("accessor 0 in bufferView 0")
    );
    assert_eq!(beyond(r#""byteLength": 37"#, r#""count": 1"#), view("bufferView 0"));
    assert_eq!(
        beyond(r#""byteLength": 2, "byteOffset": 18446744073709551615"#, r#""count": 1"#),
        view("bufferView 0")
    );
    assert_eq!(
        beyond(r#""byteLength": 36, "byteStride": 8"#, r#""count": 1"#),
        view("accessor 0 in bufferView 0")
    );
    assert_eq!(
        beyond(r#""byteLength": 36, "byteStride": 18446744073709551615"#, r#""count": 2"#),
        view("accessor 0 in bufferView 0")
    );
}
