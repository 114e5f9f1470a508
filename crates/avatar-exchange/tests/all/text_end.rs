//! Text files that end in a zero, as programs in C leave it, or in the end mark of CP/M and DOS.

#[test]
fn a_zero_at_the_end_changes_nothing() {
    let texts: [(&str, &[u8]); 5] = [
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3"),
        (
            "a.bvh",
            b"HIERARCHY\nROOT a {\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: 1\n30",
        ),
        ("a.md5mesh", b"MD5Version 10 numJoints 1 numMeshes 0\njoints { \"a\" -1 ( 0 0 1 ) ( 0 0 0 ) }"),
        (
            "a.dae",
            b"<COLLADA version=\"1.4.1\"><library_visual_scenes><visual_scene id=\"s\"><node id=\"a\"/>\
              </visual_scene></library_visual_scenes></COLLADA>",
        ),
        ("a.fbx", include_bytes!("fbx/face.fbx")),
    ];
    for (file, text) in texts {
        let read = |bytes: &[u8]| avatar_exchange::read(file, bytes, &[], &mut |_| Err(String::new()));
        let expected = read(text).expect(file);
        for end in [&b"\0"[..], b"\n\0", b"\n\0\0\0\n", b"\n\x1a", b"\r\n\0\r\n"] {
            // The library that reads FBX knows zeros only.
            if file != "a.fbx" || !end.contains(&0x1a) {
                let same = read(&[text, end].concat()).as_ref() == Ok(&expected);
                assert!(same, "{file} {end:?}");
            }
        }
        if file != "a.fbx" {
            // UTF-16 with a byte-order mark, and a zero of two bytes.
            let units = std::str::from_utf8(text).expect("text").encode_utf16().chain([0]);
            let wide: Vec<u8> = [0xfeff].into_iter().chain(units).flat_map(u16::to_le_bytes).collect();
            assert!(read(&wide).as_ref() == Ok(&expected), "{file} in UTF-16");
        }
    }
}
