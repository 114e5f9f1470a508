//! Films are read back by decoders that know nothing of how they were made.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod common;

use avatar_film::{Film, FilmError, Format, Rate};
use common::{apng, film, frames, gif, psnr};
use std::io::{Cursor, Seek, SeekFrom, Write};

fn rate(text: &str) -> Rate {
    text.parse().expect("a rate")
}

const SIZES: [(u32, u32); 6] = [(1, 1), (2, 1), (1, 7), (5, 3), (33, 17), (160, 90)];

#[test]
fn animated_png_is_lossless_and_exactly_timed() {
    for (width, height) in SIZES {
        for (text, delay) in
            [("30", (1, 30)), ("240", (1, 240)), ("30000/1001", (1001, 30000)), ("0.4", (5, 2))]
        {
            let pictures = frames(width, height, 7, true);
            let found = apng(&film(Format::Apng, &pictures, width, height, rate(text)));
            assert_eq!(found.len(), 7, "{width}x{height}");
            for (k, (picture, frame)) in pictures.iter().zip(&found).enumerate() {
                assert!(&frame.rgba == picture, "{width}x{height}: frame {k}");
                assert_eq!(frame.delay, delay);
            }
        }
    }
}

#[test]
fn gif_delays_never_drift() {
    for text in ["50", "30", "24", "15", "29.97", "48", "7", "30000/1001", "0.3"] {
        let pictures = vec![vec![9, 8, 7, 255]; 400];
        let (found, _) = gif(&film(Format::Gif, &pictures, 1, 1, rate(text)));
        assert_eq!(found.len(), 400);
        let mut begin = 0u64;
        for (k, frame) in found.iter().enumerate() {
            let exact = 100.0 * k as f64 / rate(text).per_second();
            assert!((begin as f64 - exact).abs() <= 0.5 + 1e-9, "{text}: frame {k} at {begin}, not {exact}");
            assert!(frame.delay >= 2, "{text}: programs take such a delay for another one");
            begin += u64::from(frame.delay);
        }
    }
}

#[test]
fn gif_keeps_few_colours_exactly_and_many_closely() {
    for (width, height) in SIZES {
        let few: Vec<Vec<u8>> = (0..6u8)
            .map(|k| (0..width * height).flat_map(|at| [(at % 15) as u8 * 16 + k, k * 40, 77, 255]).collect())
            .collect();
        let (found, repeats) = gif(&film(Format::Gif, &few, width, height, rate("10")));
        assert!(repeats);
        assert!(found.iter().map(|frame| &frame.rgba).eq(&few), "{width}x{height}");
    }
    let many = frames(160, 90, 12, false);
    let (found, _) = gif(&film(Format::Gif, &many, 160, 90, rate("25")));
    assert_eq!(found.len(), many.len());
    for (k, (frame, picture)) in found.iter().zip(&many).enumerate() {
        let psnr = psnr(&frame.rgba, picture);
        assert!(psnr > 30.0, "frame {k}: {psnr} dB");
    }
}

#[test]
fn gif_keeps_what_is_small_and_of_other_colours() {
    let green = [60, 200, 90];
    let mut picture = frames(160, 90, 1, false).remove(0);
    picture[4000 * 4..4012 * 4].chunks_exact_mut(4).for_each(|pixel| pixel[..3].copy_from_slice(&green));
    let (found, _) = gif(&film(Format::Gif, std::slice::from_ref(&picture), 160, 90, rate("25")));
    for pixel in found[0].rgba[4000 * 4..4012 * 4].chunks_exact(4) {
        let near = pixel.iter().zip(green).all(|(found, wanted)| found.abs_diff(wanted) <= 16);
        assert!(near, "{pixel:?} for {green:?}");
    }
}

#[test]
fn gif_forgets_what_becomes_transparent() {
    let pictures = frames(33, 17, 9, true);
    let (found, _) = gif(&film(Format::Gif, &pictures, 33, 17, rate("20")));
    for (k, (frame, picture)) in found.iter().zip(&pictures).enumerate() {
        for (found, wanted) in frame.rgba.chunks_exact(4).zip(picture.chunks_exact(4)) {
            assert_eq!(found[3] == 255, wanted[3] >= 128, "frame {k}: {found:?} for {wanted:?}");
        }
    }
}

#[test]
fn gif_of_a_still_stays_small() {
    let still = frames(160, 90, 1, false).remove(0);
    let one = film(Format::Gif, std::slice::from_ref(&still), 160, 90, rate("25")).len();
    let many = film(Format::Gif, &vec![still; 100], 160, 90, rate("25")).len();
    assert!(many < one + 100 * 40, "{one} bytes grew to {many}");
}

#[test]
fn two_runs_give_the_same_bytes() {
    let pictures = frames(97, 61, 6, true);
    for format in Format::ALL {
        let make = || film(*format, &pictures, 97, 61, rate("25"));
        assert!(make() == make(), "{format}");
    }
}

#[test]
fn what_cannot_be_is_told() {
    let new = |format, width, height, text: &str| {
        Film::new(format, Cursor::new(Vec::new()), width, height, rate(text))
    };
    for format in Format::ALL {
        let film = new(*format, 4, 4, "25").expect("a film");
        assert!(matches!(film.finish(), Err(FilmError::NoFrames)), "{format}");
        let mut film = new(*format, 4, 4, "25").expect("a film");
        for bytes in [0, 63, 65] {
            let error = film.push(&vec![0; bytes]).expect_err("a frame of another size");
            assert_eq!(error.to_string(), format!("expected a frame of 64 bytes, found {bytes}"));
        }
        film.push(&[255; 64]).expect("it goes on");
        assert_eq!(film.frames(), 1);
        film.finish().expect("a film of one frame");
        for (width, height) in [(0, 4), (4, 0), (0, 0), (u32::MAX, 1), (u32::MAX, u32::MAX)] {
            let error = new(*format, width, height, "25").expect_err("no such size").to_string();
            assert!(error.contains(&format!("found {width}x{height}")), "{error}");
        }
    }
    let error = new(Format::Gif, 4, 4, "50.1").expect_err("too fast").to_string();
    assert_eq!(error, "GIF: expected at most 50 frames per second, found 501/10");
}

#[test]
fn formats_are_known_by_the_end_of_the_name() {
    for (name, format) in [
        ("a.gif", Some(Format::Gif)),
        ("x/y.GIF", Some(Format::Gif)),
        ("a.b.png", Some(Format::Apng)),
        ("a.apng", Some(Format::Apng)),
        ("gif", None),
        ("a.jpg", None),
        ("a.gif/", None),
        ("", None),
    ] {
        assert_eq!(Format::of_name(name), format, "{name}");
    }
}

/// A disk that is full after so many bytes.
#[derive(Debug)]
struct Full(Cursor<Vec<u8>>, usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.0.get_ref().len() + bytes.len() > self.1 {
            return Err(std::io::ErrorKind::StorageFull.into());
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for Full {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

#[test]
fn a_full_disk_is_told_and_nothing_panics() {
    let pictures = frames(33, 17, 3, false);
    for format in Format::ALL {
        let bytes = film(*format, &pictures, 33, 17, rate("25")).len();
        for room in (0..bytes).step_by(13) {
            let write = || -> Result<Full, FilmError> {
                let mut film = Film::new(*format, Full(Cursor::default(), room), 33, 17, rate("25"))?;
                pictures.iter().try_for_each(|picture| film.push(picture))?;
                film.finish()
            };
            let error = write().expect_err("no room");
            assert!(
                matches!(&error, FilmError::Io(io) if io.kind() == std::io::ErrorKind::StorageFull),
                "{error:?}"
            );
        }
    }
}
