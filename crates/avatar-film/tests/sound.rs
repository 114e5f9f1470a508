//! Films with sound: what the muxer's reader finds in them, and what ffmpeg hears and sees, where it is
//! installed.
#![cfg(feature = "mp4")]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_types,
    reason = "a test may panic, and run programs"
)]
#![allow(clippy::disallowed_methods, reason = "a test reads the environment and writes files")]

mod common;

use avatar_film::{Film, FilmError, Format, Rate, Soundtrack};
use common::frames;
use mp4::Mp4Reader;
use std::io::{Cursor, Write};
use std::process::Command;

/// A tenth of a second of silence, then a sweep from 200 Hz to 2 kHz that fades over half a second: its
/// beginning is found to the sample. Two channels have it with opposite signs.
fn sweep(rate_hz: u32, channels: u16, secs: f64) -> Soundtrack {
    let frames = (secs * f64::from(rate_hz)) as usize;
    let value = |frame: usize| {
        let t = frame as f64 / f64::from(rate_hz) - 0.1;
        let phase = std::f64::consts::TAU * (200.0 * t + 1_800.0 * t * t);
        if (0.0..0.5).contains(&t) { (0.6 * (1.0 - 2.0 * t) * phase.sin()) as f32 } else { 0.0 }
    };
    let signs = [1.0, -1.0];
    let frame = |frame| signs[..usize::from(channels)].iter().map(move |sign| sign * value(frame));
    Soundtrack { rate_hz, channels, samples: (0..frames).flat_map(frame).collect() }
}

fn film(sound: Soundtrack, count: u32, rate: &str) -> Vec<u8> {
    let rate: Rate = rate.parse().expect("a rate");
    let mut film = Film::new(Format::Mp4, Cursor::new(Vec::new()), 32, 32, rate).expect("a film");
    film.set_sound(sound).expect("a sound");
    frames(32, 32, count, false).iter().for_each(|frame| film.push(frame).expect("a frame"));
    film.finish().expect("a film").into_inner()
}

/// Durations are those of frames and sound; the edit says that the sound begins behind one block of 1024
/// frames (ISO/IEC 14496-3: the first block is half made of what was before the sound).
#[test]
fn the_index_says_when_the_sound_begins_and_ends() {
    for (rate_hz, channels, fps) in [(48_000, 2, "30"), (22_050, 1, "30000/1001"), (8_000, 1, "12.5")] {
        let bytes = film(sweep(rate_hz, channels, 1.0), 60, fps);
        let reader = Mp4Reader::read_header(Cursor::new(&bytes), bytes.len() as u64).expect("an MP4");
        let rate: Rate = fps.parse().expect("a rate");
        let [film, sound] = &reader.moov.traks[..] else { panic!("expected two tracks") };
        let secs = |ticks: u64| ticks as f64 / f64::from(reader.moov.mvhd.timescale);
        assert!((secs(film.tkhd.duration) - rate.time_secs(60)).abs() < 1e-9);
        assert!((secs(sound.tkhd.duration) - 1.0).abs() < 2e-4, "{}", secs(sound.tkhd.duration));
        assert!((secs(reader.moov.mvhd.duration) - rate.time_secs(60)).abs() < 1e-9);
        let edits = sound.edts.as_ref().and_then(|edits| edits.elst.as_ref()).expect("edits");
        let edit = &edits.entries[0];
        assert_eq!((edits.entries.len(), edit.media_time, edit.media_rate), (1, 1024, 1));
        assert_eq!(edit.segment_duration, sound.tkhd.duration);
        let track = reader.tracks().get(&2).expect("a track");
        assert_eq!(track.timescale(), rate_hz);
        assert_eq!(track.channel_config().expect("channels") as u16, channels);
        // Every block of the sound, and the one that ends the last.
        assert_eq!(track.sample_count(), rate_hz.div_ceil(1024) + 1);
    }
}

/// A film that ends before its sound has no more of it than it shows.
#[test]
fn a_film_has_no_more_sound_than_frames() {
    let bytes = film(sweep(16_000, 1, 100.0), 15, "30");
    let reader = Mp4Reader::read_header(Cursor::new(&bytes), bytes.len() as u64).expect("an MP4");
    let ticks = reader.moov.traks[1].tkhd.duration;
    assert!((ticks as f64 / f64::from(reader.moov.mvhd.timescale) - 0.5).abs() < 2e-4);
    assert_eq!(reader.tracks()[&2].sample_count(), 8_000_u32.div_ceil(1024) + 1);
}

#[test]
fn two_runs_are_the_same_bytes_and_a_film_without_sound_has_one_track() {
    let run = || film(sweep(44_100, 2, 0.5), 10, "25");
    assert_eq!(run(), run());
    let rate = Rate::new(25, 1).expect("a rate");
    let bytes = common::film(Format::Mp4, &frames(32, 32, 2, false), 32, 32, rate);
    let reader = Mp4Reader::read_header(Cursor::new(&bytes), bytes.len() as u64).expect("an MP4");
    assert_eq!(reader.tracks().len(), 1);
}

#[test]
fn sounds_that_a_film_cannot_have_are_refused() {
    let try_it = |format, sound| {
        let rate = Rate::new(25, 1).expect("a rate");
        let mut film = Film::new(format, Cursor::new(Vec::new()), 32, 32, rate).expect("a film");
        film.set_sound(sound).map_err(|error: FilmError| error.to_string())
    };
    let sound = |rate_hz, channels| Soundtrack { rate_hz, channels, samples: vec![0.0; 100] };
    assert_eq!(
        try_it(Format::Gif, sound(48_000, 1)),
        Err("GIF: expected no sound, which it cannot hold, found sound".to_owned())
    );
    let told = try_it(Format::Mp4, sound(44_000, 1)).expect_err("a strange rate");
    assert!(told.starts_with("MP4: expected one of 8000, 11025,") && told.ends_with("found 44000"), "{told}");
    let told = try_it(Format::Mp4, sound(48_000, 3)).expect_err("three channels");
    assert_eq!(told, "MP4: expected sound of one or two channels, found 3 channels");
    assert_eq!(try_it(Format::Mp4, sound(48_000, 2)), Ok(()));
    assert_eq!(
        [7_999, 8_000, 22_051, 48_000, 192_000].map(Soundtrack::rate_for),
        [8_000, 8_000, 24_000, 48_000, 48_000]
    );
    // Nonsense in a sound is silence, or cut off.
    let nonsense = Soundtrack { rate_hz: 8_000, channels: 2, samples: vec![f32::NAN, f32::INFINITY, -9.0] };
    assert!(!film(nonsense, 2, "25").is_empty());
    let empty = Soundtrack { rate_hz: 8_000, channels: 1, samples: Vec::new() };
    assert!(!film(empty, 2, "25").is_empty());
}

/// Whether a program runs here. Without it a test says on the terminal that it is skipped, or fails under
/// `MIMIK_REQUIRE_DATA=1`.
fn has(program: &str) -> bool {
    if Command::new(program).arg("-version").output().is_ok() {
        return true;
    }
    let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(!required, "expected the program {program} (MIMIK_REQUIRE_DATA=1), found none");
    let _ = writeln!(std::io::stderr(), "SKIPPED: {program} is not installed");
    false
}

/// Another decoder hears the sound where it is: to the frame of sound or the one beside it, and hardly
/// changed.
#[test]
fn another_program_hears_the_sound_in_its_place() {
    if !has("ffmpeg") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (rate_hz, channels, fps) in [
        (48_000, 2, "30"),
        (44_100, 1, "24"),
        (22_050, 1, "30000/1001"),
        (16_000, 1, "60"),
        (8_000, 1, "12.5"),
    ] {
        let sound = sweep(rate_hz, channels, 1.5);
        let path = folder.path().join(format!("{rate_hz}.mp4"));
        std::fs::write(&path, film(sound.clone(), 120, fps)).expect("written");
        let run =
            Command::new("ffmpeg").args(["-v", "error", "-i"]).arg(&path).args(["-f", "f32le", "-"]).output();
        let output = run.expect("ffmpeg runs");
        assert!(
            output.status.success() && output.stderr.is_empty(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let heard: Vec<f32> =
            output.stdout.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        let width = usize::from(channels);
        for channel in 0..width {
            let of = |samples: &[f32]| -> Vec<f64> {
                samples.iter().skip(channel).step_by(width).map(|sample| f64::from(*sample)).collect()
            };
            let (meant, heard) = (of(&sound.samples), of(&heard));
            let fit = |lag: i64| -> f64 {
                let at = |frame: usize| heard.get((frame as i64 + lag) as usize).copied().unwrap_or(0.0);
                let loud = meant.iter().enumerate().filter(|(_, sample)| **sample != 0.0);
                loud.map(|(frame, sample)| sample * at(frame)).sum()
            };
            let most = i64::from(rate_hz) / 20;
            let fits = (-most..=most).map(|lag| (fit(lag), lag));
            let (_, best) = fits.max_by(|a, b| a.0.total_cmp(&b.0)).expect("a lag");
            let loud = fit(best) / meant.iter().map(|sample| sample * sample).sum::<f64>();
            println!("{rate_hz} Hz, channel {channel}: {best} frames late, {loud:.4} as loud");
            assert!(best.abs() <= 1, "{rate_hz} {channel}: {best} frames late");
            assert!((loud - 1.0).abs() < 0.05, "{rate_hz} {channel}: {loud}");
        }
    }
}
