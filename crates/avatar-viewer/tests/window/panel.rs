//! The window with its panel, driven as a person drives it.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::copy_of_golden_pack;
use crate::desk::{Desk, PATIENCE, can_run, difference, errors, render, save_as_editors_do};
use image::RgbImage;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const SIZE: [&str; 4] = ["--size", "640x480", "--quality", "plain"];
/// Places in a window of that size.
const FACE_TAB: (i32, i32) = (347, 21);
pub(super) const POSES_TAB: (i32, i32) = (387, 21);
const CLIPS_TAB: (i32, i32) = (427, 21);
const TURN_SLIDER: (i32, i32) = (501, 107);
const TURN_SLIDER_FARTHER: (i32, i32) = (550, 107);
pub(super) const SAVE_THIS_FACE: (i32, i32) = (383, 51);
const SAVE_CLIPS: (i32, i32) = (449, 51);
/// The button that opens the folded panel.
const OPENER: (u32, u32) = (590, 50);

pub(super) const POSES: &str = r#"# Mine, and dear to me.

[[pose]]
name = "smile" # the first
key = "1"
controls = { smile = 1, "head.turn" = 0, "jaw.open" = 0 }

# It turns.
[[pose]]
name = "turn"
key = "2"
controls = { smile = 0, "head.turn" = 30, "jaw.open" = 0 }
"#;
pub(super) const CLIPS: &str = r#"
[[clip]]
name = "shake"
key = "n"
[clip.tracks]
"head.turn" = [{ t = 0, v = 0 }, { t = 0.5, v = 40 }, { t = 30, v = -40 }]
"#;

/// A pack with poses and a clip, and a user without settings.
pub(super) fn pack() -> (TempDir, TempDir) {
    let pack = copy_of_golden_pack();
    fs::write(pack.path().join("poses.toml"), POSES).expect("written");
    fs::write(pack.path().join("clips.toml"), CLIPS).expect("written");
    (pack, tempfile::tempdir().expect("a temporary folder"))
}

fn with<'a>(pack: &'a TempDir, further: &[&'a str]) -> Vec<&'a str> {
    [&[pack.path().to_str().expect("a plain path")], &SIZE[..], further].concat()
}

/// The window of a person who has read the hint.
pub(super) fn open(pack: &TempDir, settings: &TempDir) -> Desk {
    let folder = settings.path().join("mimik");
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("viewer.toml"), "[panel]\nseen_hint = true\n").expect("written");
    let desk = Desk::with_panel(&with(pack, &[]), settings.path());
    // Nothing is under the pointer.
    desk.point(5, 5);
    desk.idles();
    desk
}

/// Without the button that opens the panel.
fn beside_the_opener(mut picture: RgbImage) -> RgbImage {
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if x >= OPENER.0 && y < OPENER.1 {
            *pixel = image::Rgb([0; 3]);
        }
    }
    picture
}

/// Folds the panel, and expects the face of a picture; unfolds it again.
#[track_caller]
fn shows_folded(desk: &Desk, expected: &RgbImage, what: &str) {
    desk.key("F2");
    let start = Instant::now();
    let expected = beside_the_opener(expected.clone());
    loop {
        let found = beside_the_opener(desk.picture());
        if difference(&found, &expected) == Some(0) {
            break;
        }
        if start.elapsed() > PATIENCE {
            let file = std::env::temp_dir().join("folded.png");
            found.save(&file).expect("saved");
            panic!("{what}: see {}; {}", file.display(), desk.told());
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    desk.key("F2");
}

/// A text of a file, once it is as wanted.
#[track_caller]
fn text_once(file: &Path, is_right: impl Fn(&str) -> bool) -> String {
    let start = Instant::now();
    loop {
        let text = fs::read_to_string(file).unwrap_or_default();
        if is_right(&text) {
            return text;
        }
        assert!(start.elapsed() < PATIENCE, "{}: {text}", file.display());
        std::thread::sleep(Duration::from_millis(30));
    }
}

#[test]
fn the_panel_leaves_room_for_the_face_and_goes_away() {
    if !can_run() {
        return;
    }
    let (pack, settings) = pack();
    let mut desk = open(&pack, &settings);
    let whole = render(&with(&pack, &[]));
    let start = desk.settled();
    // The face is in the middle of what is left of the panel, and the ground shows on both of its sides.
    let ground = *start.get_pixel(2, 240);
    let face: Vec<u32> = (0..319).filter(|x| start.get_pixel(*x, 200) != &ground).collect();
    let (left, right) = (face[0], 319 - face[face.len() - 1]);
    assert!(left.abs_diff(right) < 12 && left > 4, "{left} pixels on the left, {right} on the right");

    desk.key("F1");
    desk.changes_from(&start, "help");
    desk.settled();
    desk.key("Escape");
    assert_eq!(difference(&desk.settled(), &start), Some(0), "help is closed, and the window is not");
    shows_folded(&desk, &whole, "folded");
    desk.key("2");
    shows_folded(&desk, &render(&with(&pack, &["--pose", "turn"])), "a pose by key");
    desk.key("1");
    std::thread::sleep(Duration::from_millis(120));
    desk.key("2");
    shows_folded(&desk, &render(&with(&pack, &["--pose", "turn"])), "the last key counts");

    // The pointer leads the eyes, and they look ahead again.
    desk.key("BackSpace");
    shows_folded(&desk, &whole, "the default face");
    let ahead = desk.settled();
    desk.key("g");
    desk.point(20, 400);
    desk.changes_from(&ahead, "eyes follow the pointer");
    desk.settled();
    desk.key("g");
    shows_folded(&desk, &whole, "eyes look ahead");

    // Small, almost nothing, and back.
    for size in [["200", "150"], ["1", "1"], ["640", "480"]] {
        desk.do_xdotool(&["windowsize", &desk.window.to_string(), size[0], size[1]]);
        std::thread::sleep(Duration::from_millis(200));
    }
    shows_folded(&desk, &whole, "as large as before");

    // Idle costs nothing: a tick of the clock is 10 ms, and a single frame of this picture takes more than
    // three.
    desk.settled();
    let before = desk.ticks();
    std::thread::sleep(Duration::from_secs(2));
    let ticks = desk.ticks() - before;
    assert!(ticks <= 3, "{ticks} ticks in two idle seconds");
    desk.key("Escape");
    desk.closes();
}

#[test]
fn a_slider_moves_the_face_until_a_key_says_otherwise_and_the_face_becomes_a_pose() {
    if !can_run() {
        return;
    }
    let (pack, settings) = pack();
    let file = pack.path().join("poses.toml");
    let mut desk = open(&pack, &settings);
    let before = desk.settled();
    desk.point(TURN_SLIDER.0, TURN_SLIDER.1);
    desk.do_xdotool(&["mousedown", "1"]);
    desk.point(TURN_SLIDER_FARTHER.0, TURN_SLIDER_FARTHER.1);
    desk.changes_from(&before, "the slider moves");
    let dragged = desk.settled();
    let face = |picture: &RgbImage| image::imageops::crop_imm(picture, 0, 60, 320, 360).to_image();
    let moved = face(&dragged).pixels().zip(face(&before).pixels()).filter(|(a, b)| a != b).count();
    // Marks of what the slider moves are some hundred pixels.
    assert!(moved > 4000, "the face moves with it: {moved} pixels");
    desk.key("2");
    desk.changes_from(&dragged, "a key while the slider is held");
    desk.settled();
    desk.do_xdotool(&["mouseup", "1"]);
    desk.point(5, 5);
    shows_folded(&desk, &render(&with(&pack, &["--pose", "turn"])), "the key is the newer wish");

    // By hand to another face, which is saved.
    desk.click(TURN_SLIDER_FARTHER.0, TURN_SLIDER_FARTHER.1);
    desk.click(POSES_TAB.0, POSES_TAB.1);
    desk.settled();
    desk.click(SAVE_THIS_FACE.0, SAVE_THIS_FACE.1);
    desk.settled();
    desk.write("mine");
    desk.key("Return");
    let text = text_once(&file, |text| text.contains("name = \"mine\""));
    assert!(text.starts_with(POSES.trim_end()), "what was there stays as it was: {text}");
    desk.point(5, 5);
    desk.key("2");
    desk.settled();
    let saved = render(&with(&pack, &["--pose", "mine"]));
    assert_ne!(difference(&saved, &render(&with(&pack, &["--pose", "turn"]))), Some(0));
    desk.key("ctrl+z");
    text_once(&file, |text| text == POSES);
    desk.key("ctrl+y");
    let again = text_once(&file, |text| text.contains("mine"));
    assert_eq!(again, text);
    desk.click(FACE_TAB.0, FACE_TAB.1);
    desk.key("Escape");
    desk.closes();
}

#[test]
fn a_mistake_in_the_poses_is_told_and_the_old_ones_stay() {
    if !can_run() {
        return;
    }
    let (pack, settings) = pack();
    let file = pack.path().join("poses.toml");
    let mut desk = open(&pack, &settings);
    let before = desk.settled();
    save_as_editors_do(pack.path(), "poses.toml", POSES.replace("\"turn\"", "turn").as_bytes());
    let told = errors(&desk, 1);
    let place = format!("{}: line 10, column", file.display());
    assert!(told[0].contains(&place) && told[0].contains("the poses stay as they were"), "{}", told[0]);
    desk.changes_from(&before, "a banner");
    // The pack on the disk is broken: the expected picture is that of the same pose by its controls.
    let (whole, _) = self::pack();
    desk.key("2");
    shows_folded_below_a_banner(&desk, &before);
    let mended = POSES.replace("key = \"2\"", "key = \"3\"");
    save_as_editors_do(pack.path(), "poses.toml", mended.as_bytes());
    desk.key("1");
    desk.settled();
    desk.key("3");
    shows_folded(&desk, &render(&with(&whole, &["--pose", "turn"])), "the new key, and no banner");
    errors(&desk, 1);
    desk.close_button();
    desk.closes();
}

/// The face has turned: it is not where it was, whatever the banner says.
#[track_caller]
fn shows_folded_below_a_banner(desk: &Desk, before: &RgbImage) {
    let settled = desk.settled();
    let face = |picture: &RgbImage| image::imageops::crop_imm(picture, 0, 150, 300, 300).to_image();
    assert_ne!(difference(&face(&settled), &face(before)), Some(0), "old poses go on working");
}

#[test]
fn clips_play_are_interrupted_and_are_recorded() {
    if !can_run() {
        return;
    }
    let (pack, settings) = pack();
    let mut desk = open(&pack, &settings);
    let before = desk.settled();
    desk.key("n");
    desk.changes_from(&before, "the clip plays");
    desk.key("2");
    shows_folded(&desk, &render(&with(&pack, &["--pose", "turn"])), "a pose ends the clip");

    desk.key("shift+r");
    desk.key("1");
    std::thread::sleep(Duration::from_millis(900));
    desk.key("shift+r");
    desk.click(CLIPS_TAB.0, CLIPS_TAB.1);
    desk.point(5, 5);
    desk.settled();
    desk.click(SAVE_CLIPS.0, SAVE_CLIPS.1);
    let text = text_once(&pack.path().join("clips.toml"), |text| text.contains("name = \"recording\""));
    assert!(text.starts_with(CLIPS.trim_end()), "what was there stays as it was: {text}");
    assert!(text.matches("t = ").count() < 60, "reduced: {text}");
    let played = render(&with(&pack, &["--clip", "recording", "--time", "30"]));
    let smile = render(&with(&pack, &["--pose", "smile"]));
    // Reduced with a tolerance of half a percent of each range.
    let differing = played.as_raw().iter().zip(smile.as_raw()).filter(|(a, b)| a.abs_diff(**b) > 40).count();
    assert!(differing < played.as_raw().len() / 200, "the clip ends where the pose is: {differing}");
    desk.close_button();
    desk.closes();
}

#[test]
fn what_is_dropped_is_opened_and_what_is_broken_leaves_the_face() {
    if !can_run() {
        return;
    }
    let (pack, settings) = pack();
    let mut desk = open(&pack, &settings);
    let before = desk.settled();
    let name = desk.name();
    let broken = settings.path().join("broken.glb");
    fs::write(&broken, b"glTF, but not really").expect("written");
    desk.drop_file(&broken);
    let told = errors(&desk, 1);
    assert!(told[0].contains("broken.glb") && told[0].contains("was not opened"), "{}", told[0]);
    desk.changes_from(&before, "a banner");
    assert_eq!(desk.name(), name);

    // What waits for ever, or never ends, is not read.
    let (pipe, device) = (settings.path().join("pipe.glb"), settings.path().join("endless.obj"));
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo starts").success());
    std::os::unix::fs::symlink("/dev/zero", &device).expect("a link");
    for (count, file, found) in [(2, pipe, "a pipe"), (3, device, "a device")] {
        desk.drop_file(&file);
        let told = errors(&desk, count);
        let found = format!("expected the folder or file of an avatar, found {found}");
        assert!(told[count - 1].contains(&found), "{}", told[count - 1]);
        assert_eq!(desk.name(), name);
    }

    let (other, _) = self::pack();
    desk.drop_file(other.path());
    let start = Instant::now();
    let folder = other.path().file_name().expect("a name").to_string_lossy().into_owned();
    while !desk.name().contains(&folder) {
        assert!(start.elapsed() < PATIENCE, "{} is not {folder}: {}", desk.name(), desk.told());
        std::thread::sleep(Duration::from_millis(50));
    }
    desk.key("2");
    shows_folded(&desk, &render(&with(&other, &["--pose", "turn"])), "the other avatar, and no banner");
    desk.close_button();
    desk.closes();
}
