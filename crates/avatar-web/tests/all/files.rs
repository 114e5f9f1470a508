//! What is read, and what is refused.

use avatar_web::{Archive, Avatar};
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

const FACE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/marsienne");

/// A zip of these files, packed in this way.
fn zipped<'a>(files: impl IntoIterator<Item = (&'a str, &'a [u8])>, method: CompressionMethod) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        zip.start_file(name, SimpleFileOptions::default().compression_method(method)).expect("a file");
        zip.write_all(bytes).expect("written");
    }
    zip.finish().expect("an archive").into_inner()
}

/// A triangle.
const OBJ: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn a_pack_in_an_archive_is_that_pack() {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(FACE).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("UTF-8");
        files.push((format!("faces/marsienne/{name}"), std::fs::read(&path).expect("read")));
    }
    let files = files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice()));
    let bytes = zipped(files, CompressionMethod::Deflated);
    let avatar = Avatar::read("marsienne.zip", &bytes).expect("sound");
    let own = Avatar::of_pack("marsienne", &avatar_stage::DefaultFace).expect("sound");
    assert_eq!(avatar.pack.shapes(), own.pack.shapes());
    for (part, other) in avatar.pack.parts().iter().zip(own.pack.parts()) {
        assert_eq!(part.mesh.positions, other.mesh.positions, "{}", part.name);
    }
    assert!(avatar.textures.get(avatar_pack::Texture::SkinColor).is_some());
}

#[test]
fn all_ways_of_packing_are_read() {
    for method in [CompressionMethod::Stored, CompressionMethod::Deflated, CompressionMethod::Xz] {
        let archive = Archive::read("a.zip", &zipped([("one/triangle.obj", OBJ)], method)).expect("sound");
        assert_eq!(archive.get("one/triangle.obj"), Some(OBJ), "{method:?}");
    }
}

#[test]
fn a_file_in_an_archive_finds_what_it_refers_to() {
    let mtl = b"newmtl red\nKd 1 0 0\n";
    let obj = [b"mtllib looks/red.mtl\nusemtl red\n", OBJ].concat();
    let files = [("thing/a.obj", obj.as_slice()), ("thing/looks/red.mtl", mtl.as_slice())];
    let avatar = Avatar::read("a.zip", &zipped(files, CompressionMethod::Deflated)).expect("sound");
    assert_eq!(avatar.pack.parts().len(), 1);
    assert!(!avatar.notes.iter().any(|note| note.contains("mtl")), "{:?}", avatar.notes);
    let alone = Avatar::read("a.zip", &zipped([("a.obj", obj.as_slice())], CompressionMethod::Stored));
    let alone = alone.expect("sound without its looks");
    assert!(alone.notes.iter().any(|note| note.contains("red.mtl")), "{:?}", alone.notes);
}

#[test]
fn what_is_no_avatar_is_told_with_its_name() {
    let empty = zipped([("readme.txt", b"hello".as_slice())], CompressionMethod::Stored);
    let told = Avatar::read("a.zip", &empty).expect_err("no avatar").to_string();
    assert!(told.starts_with("a.zip: expected an archive with Transformations.xml"), "{told}");
    let told = Avatar::read("a.txt", b"hello").expect_err("no avatar").to_string();
    assert!(told.starts_with("a.txt: expected a zip archive, or a name that ends in .glb"), "{told}");
    // Tests of the whole workspace build the viewer's reader of FBX in.
    let told = Avatar::read("a.fbx", b"hello").expect_err("no FBX file").to_string();
    let alone = told.contains("this build does not read");
    assert!(told.starts_with("a.fbx: ") && (alone || told.contains("expected an FBX file")), "{told}");
    assert!(Avatar::read("", b"glTF").is_err());
    assert!(Avatar::read("", b"").is_err());
}

#[test]
fn broken_archives_are_refused_and_none_grows_beyond_its_room() {
    let whole = zipped([("a.obj", OBJ)], CompressionMethod::Deflated);
    for end in 4..whole.len() {
        assert!(Archive::read("a.zip", &whole[..end]).is_err(), "{end} bytes");
    }
    // Whatever byte is wrong, nothing panics.
    for place in 0..whole.len() {
        let mut broken = whole.clone();
        broken[place] ^= 0xff;
        let _ = Avatar::read("a.zip", &broken);
    }
    for name in ["../a.obj", "/a.obj"] {
        let escaped = zipped([(name, OBJ)], CompressionMethod::Stored);
        if let Ok(archive) = Archive::read("a.zip", &escaped) {
            assert!(archive.names().all(|name| !name.starts_with('/') && !name.contains("..")), "{name}");
        }
    }
    // Zeros unpack to a thousand times their size.
    let zeros = vec![0u8; 1 << 20];
    let many: Vec<String> = (0..1200).map(|index| format!("{index}.raw")).collect();
    let files = many.iter().map(|name| (name.as_str(), zeros.as_slice()));
    let told = Archive::read("bomb.zip", &zipped(files, CompressionMethod::Deflated));
    let told = told.expect_err("1.2 GB").to_string();
    assert!(told.starts_with("bomb.zip: expected files of at most"), "{told}");
}
