//! Frames in motion: drafts that follow each other smoothly where software draws, and the whole picture at
//! rest.

use crate::desk::{Desk, PATIENCE, can_run, difference, key_of, render};
use image::RgbImage;
use std::time::{Duration, Instant};

/// What the window shows for so long, each picture once.
fn pictures(desk: &Desk, secs: f64) -> Vec<RgbImage> {
    let start = Instant::now();
    let mut pictures = vec![desk.picture()];
    while start.elapsed().as_secs_f64() < secs {
        let now = desk.picture();
        if difference(&now, pictures.last().expect("the first")) != Some(0) {
            pictures.push(now);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    pictures
}

/// The mean difference of a channel.
fn mean_difference(a: &RgbImage, b: &RgbImage) -> f64 {
    let sum: u64 = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.as_raw().len() as f64
}

#[test]
fn a_motion_is_shown_in_drafts_and_ends_with_the_whole_picture() {
    if !can_run() {
        return;
    }
    let options = ["--size", "640x360", "--hair", "bob", "--hair-density", "0.3"];
    let (first, pose) = (render(&options), "surprise");
    let expected = render(&[&options[..], &["--pose", pose]].concat());
    let far = mean_difference(&first, &expected);
    let mut desk = Desk::open(&options);
    desk.shows(&first, "whole from the start");
    desk.settled();
    desk.key(&key_of(pose));
    let shown = pictures(&desk, 2.5);
    println!("{} pictures in 2.5 s", shown.len());
    desk.shows(&expected, "whole again at rest");
    // A draft of the end of the motion is nearer to it than its beginning is.
    let last = shown.iter().rev().find(|picture| difference(picture, &expected) != Some(0));
    let off = mean_difference(last.expect("the beginning at least"), &expected);
    assert!(shown.len() > 4, "{} pictures", shown.len());
    println!("the last before: {off}; the beginning: {far}");
    assert!(off < far, "{off} beside {far}: the last picture before the whole one is one of the same face");
    desk.key("Escape");
    desk.closes();
}

#[test]
#[ignore = "measures: how many pictures a second the window of scripts/run shows, and how soon the whole one"]
fn pictures_a_second() {
    assert!(can_run());
    let settings = tempfile::tempdir().expect("a temporary folder");
    for hair in ["bob", "off"] {
        let mut desk = Desk::with_panel(&["--hair", hair], settings.path());
        // A window is black until its first frame.
        let black = RgbImage::new(1280, 720);
        desk.changes_from(&black, "the first picture");
        desk.settled();
        for pose in ["smile", "surprise", "anger", "smile"] {
            desk.key(&key_of(pose));
            let shown = pictures(&desk, 1.5);
            if let Some(folder) = std::env::var_os("MIMIK_PICTURES") {
                let name = format!("{hair}-{pose}.png");
                let middle = shown.get(shown.len() / 2).expect("one");
                middle.save(std::path::Path::new(&folder).join(name)).expect("saved");
            }
            let start = Instant::now();
            let settled = desk.settled();
            println!(
                "{hair}, {pose}: {:.1} pictures a second; the whole one after {:.2} s more",
                shown.len() as f64 / 1.5,
                start.elapsed().as_secs_f64()
            );
            if let Some(folder) = std::env::var_os("MIMIK_PICTURES") {
                let name = format!("{hair}-{pose}-rest.png");
                settled.save(std::path::Path::new(&folder).join(name)).expect("saved");
            }
        }
        desk.key("Escape");
        desk.closes();
    }
}

/// The face lives from one press of the key to the next, and then is what it was.
#[test]
fn a_face_lives_until_it_is_told_to_be_still() {
    if !can_run() {
        return;
    }
    let size = ["--size", "320x240"];
    let mut desk = Desk::open(&size);
    let at_rest = render(&size);
    desk.shows(&at_rest, "at first");
    desk.key("shift+l");
    let differs_from = |desk: &mut Desk, other: &RgbImage| {
        let start = Instant::now();
        loop {
            let picture = desk.picture();
            if difference(&picture, other) != Some(0) {
                return picture;
            }
            assert!(start.elapsed() < PATIENCE, "the face keeps still");
        }
    };
    let living = differs_from(&mut desk, &at_rest);
    differs_from(&mut desk, &living);
    desk.key("shift+l");
    desk.shows(&at_rest, "still again");
    desk.key("Escape");
    desk.closes();
}

/// Nobody has to say that the face lives.
#[test]
fn a_face_lives_as_it_comes() {
    if !can_run() {
        return;
    }
    let settings = tempfile::tempdir().expect("a temporary folder");
    let mut desk = Desk::as_it_comes(&["--size", "320x240", "--no-panel"], settings.path());
    desk.changes_from(&RgbImage::new(320, 240), "the first picture");
    let first = desk.picture();
    desk.changes_from(&first, "it blinks, or looks elsewhere");
    desk.key("Escape");
    desk.closes();
}

#[test]
#[ignore = "measures: processor time of a window that nobody touches"]
fn idle_costs() {
    assert!(can_run());
    let settings = tempfile::tempdir().expect("a temporary folder");
    let per_second = 100.0;
    for hair in ["off", "bob"] {
        for life in ["off", "calm", "lively"] {
            let mut desk = Desk::with_panel(&["--hair", hair, "--life", life], settings.path());
            desk.changes_from(&RgbImage::new(1280, 720), "the first picture");
            std::thread::sleep(Duration::from_secs(4));
            let (before, start) = (desk.ticks(), Instant::now());
            let mut shown = 0;
            let mut last = desk.picture();
            while start.elapsed() < Duration::from_secs(30) {
                std::thread::sleep(Duration::from_millis(30));
                let now = desk.picture();
                shown += usize::from(difference(&now, &last) != Some(0));
                last = now;
            }
            let ticks = (desk.ticks() - before) as f64;
            let secs = start.elapsed().as_secs_f64();
            let core = 100.0 * ticks / per_second / secs;
            println!(
                "hair {hair}, life {life}: {core:.1} % of a core, {:.1} pictures a second",
                shown as f64 / secs
            );
            desk.key("Escape");
            desk.closes();
        }
    }
}
