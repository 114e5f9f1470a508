//! Pictures with text in them.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use avatar_film::{FilmError, frame_name, png};
use std::io::Cursor;

#[test]
fn texts_come_back() {
    let rgba: Vec<u8> = (0..60).collect();
    let texts = [("Software", "Mimik"), ("Mimik", "pose=Ärger; jaw.open=3 ☺"), ("Description", "")];
    let bytes = png(5, 3, &rgba, &texts).expect("a PNG");
    let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG");
    let mut found = vec![0; 60];
    reader.next_frame(&mut found).expect("a picture");
    reader.finish().expect("an end");
    assert_eq!(found, rgba);
    let read: Vec<_> = reader
        .info()
        .utf8_text
        .iter()
        .map(|text| (text.keyword.clone(), text.get_text().expect("text")))
        .collect();
    assert_eq!(read, texts.map(|(keyword, text)| (keyword.to_owned(), text.to_owned())));
    assert!(image::load_from_memory(&bytes).expect("a PNG").into_rgba8().into_raw() == rgba);
}

#[test]
fn what_is_no_picture_is_told() {
    assert!(matches!(png(2, 2, &[0; 15], &[]), Err(FilmError::Frame { expected: 16, found: 15 })));
    png(0, 0, &[], &[]).expect_err("no pixels");
    png(u32::MAX, u32::MAX, &[], &[]).expect_err("too many pixels");
    for keyword in ["", "a\u{0}b", "ключ", &"x".repeat(80)] {
        let error = png(1, 1, &[0; 4], &[(keyword, "text")]).expect_err("no keyword").to_string();
        assert!(error.starts_with("expected a keyword of 1 to 79 Latin letters"), "{error}");
    }
}

#[test]
fn names_of_frames_sort_as_frames_do() {
    assert_eq!(frame_name(0, 1), "0000.png");
    assert_eq!(frame_name(7, 10_000), "0007.png");
    assert_eq!(frame_name(7, 10_001), "00007.png");
    assert_eq!(frame_name(10_000, 10_001), "10000.png");
}
