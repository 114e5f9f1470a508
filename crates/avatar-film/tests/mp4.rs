//! MP4 is read back by the muxer's reader and the codec's decoder; the colours by BT.709's own formulas.
#![cfg(feature = "mp4")]
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod common;

use avatar_film::{Film, Format, Rate};
use common::{film, frames, psnr};
use mp4::Mp4Reader;
use openh264::decoder::Decoder;
use openh264::formats::YUVSource;
use std::io::Cursor;

struct Sample {
    begin: u64,
    duration: u32,
    is_sync: bool,
    /// A picture of the film's size, in RGBA.
    rgba: Vec<u8>,
}

struct Read {
    timescale: u32,
    coded: (usize, usize),
    samples: Vec<Sample>,
}

fn read(bytes: &[u8], width: usize, height: usize) -> Read {
    let mut reader = Mp4Reader::read_header(Cursor::new(bytes), bytes.len() as u64).expect("an MP4");
    let track = reader.tracks().get(&1).expect("a track");
    let timescale = track.timescale();
    let coded = (track.width().into(), track.height().into());
    let sets = [track.sequence_parameter_set(), track.picture_parameter_set()];
    let start = |unit: &[u8]| [&[0, 0, 0, 1], unit].concat();
    let mut stream: Vec<u8> = sets.into_iter().flat_map(|set| start(set.expect("a set"))).collect();
    let mut decoder = Decoder::new().expect("a decoder");
    let mut samples = Vec::new();
    for number in 1..=reader.sample_count(1).expect("a count") {
        let sample = reader.read_sample(1, number).expect("readable").expect("a sample");
        let mut rest = &sample.bytes[..];
        while let Some((length, after)) = rest.split_first_chunk::<4>() {
            let (unit, after) = after.split_at(u32::from_be_bytes(*length) as usize);
            stream.extend(start(unit));
            rest = after;
        }
        let picture = decoder.decode(&stream).expect("decodable").expect("a picture at once");
        stream.clear();
        assert_eq!(picture.dimensions(), coded);
        let (strides, mut rgba) = (picture.strides(), Vec::new());
        for at in 0..width * height {
            let (x, y) = (at % width, at / width);
            let luma = (f64::from(picture.y()[y * strides.0 + x]) - 16.0) / 219.0;
            let chroma =
                |plane: &[u8], stride: usize| (f64::from(plane[y / 2 * stride + x / 2]) - 128.0) / 224.0;
            let (u, v) = (chroma(picture.u(), strides.1), chroma(picture.v(), strides.2));
            let (red, blue) = (luma + 1.5748 * v, luma + 1.8556 * u);
            let green = (luma - 0.2126 * red - 0.0722 * blue) / 0.7152;
            rgba.extend(
                [red, green, blue, 1.0].map(|channel| (channel * 255.0).round().clamp(0.0, 255.0) as u8),
            );
        }
        let (begin, duration, is_sync) = (sample.start_time, sample.duration, sample.is_sync);
        samples.push(Sample { begin, duration, is_sync, rgba });
    }
    Read { timescale, coded, samples }
}

#[test]
fn frames_come_back_at_their_times() {
    for (text, timescale, duration) in
        [("30", 30, 1), ("30000/1001", 30000, 1001), ("12.5", 25, 2), ("240", 240, 1)]
    {
        let pictures = frames(160, 90, 70, false);
        let rate: Rate = text.parse().expect("a rate");
        let read = read(&film(Format::Mp4, &pictures, 160, 90, rate), 160, 90);
        assert_eq!((read.timescale, read.coded, read.samples.len()), (timescale, (160, 90), 70));
        for (k, (sample, picture)) in read.samples.iter().zip(&pictures).enumerate() {
            assert_eq!((sample.begin, sample.duration), (k as u64 * u64::from(duration), duration));
            let key_frames = (2.0 * rate.per_second()).ceil() as usize;
            assert_eq!(sample.is_sync, k % key_frames == 0, "{text}: frame {k}");
            let psnr = psnr(&sample.rgba, picture);
            assert!(psnr > 36.0, "{text}: frame {k}: {psnr} dB");
        }
    }
}

#[test]
fn odd_and_tiny_sizes_are_padded() {
    for (size, coded) in
        [((1, 1), (16, 16)), ((33, 17), (34, 18)), ((15, 99), (16, 100)), ((640, 1), (640, 16))]
    {
        let (width, height) = size;
        let pictures = vec![[200, 100, 50, 255].repeat(width * height); 3];
        let rate = Rate::new(25, 1).expect("a rate");
        let bytes = film(Format::Mp4, &pictures, width as u32, height as u32, rate);
        let read = read(&bytes, width, height);
        assert_eq!((read.coded, read.samples.len()), (coded, 3));
        for sample in read.samples {
            let psnr = psnr(&sample.rgba, &pictures[0]);
            assert!(psnr > 36.0, "{size:?}: {psnr} dB");
        }
    }
}

#[test]
fn the_colours_are_tagged() {
    let bytes = film(Format::Mp4, &frames(32, 32, 1, false), 32, 32, Rate::new(25, 1).expect("a rate"));
    let reader = Mp4Reader::read_header(Cursor::new(&bytes), bytes.len() as u64).expect("an MP4");
    let sps = reader.tracks()[&1].sequence_parameter_set().expect("a set");
    // In the SPS's usability information (H.264, E.1.1): a video of no certain format (5), limited range (0),
    // with a description of colours (1): BT.709's primaries (1), sRGB's transfer (13), BT.709's matrix (1).
    // It may begin at any bit.
    let wanted = [true, false, true, false, true].into_iter().chain([1u8, 13, 1].into_iter().flat_map(bits));
    let wanted: Vec<bool> = wanted.collect();
    let found: Vec<bool> = sps.iter().copied().flat_map(bits).collect();
    assert!(found.windows(wanted.len()).any(|window| window == wanted), "{sps:02x?}");
}

fn bits(byte: u8) -> impl Iterator<Item = bool> {
    (0..8).rev().map(move |bit| byte >> bit & 1 == 1)
}

#[test]
fn larger_pictures_than_the_encoder_takes_are_refused() {
    let new = |width, height| {
        Film::new(Format::Mp4, Cursor::new(Vec::new()), width, height, Rate::new(25, 1).expect("a rate"))
    };
    for (width, height) in [(3841, 16), (16, 3841), (2161, 2161)] {
        let error = new(width, height).expect_err("too large").to_string();
        assert!(error.contains("3840x2160") && error.contains(&format!("{width}x{height}")), "{error}");
    }
    for (width, height) in [(3840, 2160), (2160, 3840)] {
        new(width, height)
            .expect("a film")
            .push(&vec![0; width as usize * height as usize * 4])
            .expect("a frame");
    }
}
