//! How the window's picture looks: the options, and `materials.toml` edited while the window is open.
//! Expected is what `render` draws of the same pack.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common;
use crate::common::{copy_of_golden_pack, golden_pack, viewer};
use crate::desk::{
    A_WHILE, Desk, PATIENCE, can_run, difference, ends_without_a_window, errors, render, save_as_editors_do,
};
use notify::event::AccessKind;
use notify::{EventKind, RecursiveMode, Watcher};
use std::fs;

const GREEN: &str = "[skin]\ncolor = [0.1, 0.5, 0.2]\n";
const BLUE: &str = "[skin]\ncolor = [0.1, 0.2, 0.6]\n\n[left-eyeball]\ncolor = [0.9, 0.1, 0.1]\n";

#[test]
fn the_open_window_follows_the_materials_file() {
    if !can_run() {
        return;
    }
    let pack = copy_of_golden_pack();
    let file = pack.path().join("materials.toml");
    let options = [pack.path().to_str().expect("a plain path"), "--size", "160x120", "--quality", "plain"];
    let defaults = render(&options);
    let mut desk = Desk::open(&options);
    desk.shows(&defaults, "without the file");

    fs::write(&file, GREEN).expect("written");
    let green = render(&options);
    assert_ne!(difference(&green, &defaults), Some(0), "the skin's colour shows");
    desk.shows(&green, "after the file appeared");

    // Saved in place: the file is empty for a moment, which must not be taken for the defaults.
    fs::write(&file, "[skin]\ncolour = [0.9, 0.1, 0.1]\n").expect("written");
    let told = errors(&desk, 1);
    let place = format!("{}: line 2, column 1: skin.colour: expected", file.display());
    for part in [&place, "found \"colour\"; did you mean \"color\"?", "the materials stay as they were"] {
        assert!(told[0].contains(part), "expected {part:?} in: {}", told[0]);
    }
    assert_eq!(difference(&desk.picture(), &green), Some(0), "a broken file changes nothing");

    save_as_editors_do(pack.path(), "materials.toml", BLUE.as_bytes());
    let blue = render(&options);
    assert_ne!(difference(&blue, &green), Some(0));
    desk.shows(&blue, "after the file was mended");

    save_as_editors_do(pack.path(), "materials.toml", b"[skin]\n# \xFF\n");
    let told = errors(&desk, 2);
    assert!(
        told[1].contains("materials.toml: expected UTF-8 text, found a bad byte at offset 9"),
        "{}",
        told[1]
    );
    assert_eq!(difference(&desk.picture(), &blue), Some(0), "what is no text changes nothing");

    fs::remove_file(&file).expect("removed");
    desk.shows(&defaults, "after the file was removed");
    fs::create_dir(&file).expect("created");
    let told = errors(&desk, 3);
    assert!(told[2].contains("materials.toml: expected a file, found a folder"), "{}", told[2]);
    fs::remove_dir(&file).expect("removed");

    save_as_editors_do(pack.path(), "materials.toml", GREEN.as_bytes());
    desk.shows(&green, "still following");
    errors(&desk, 3);
    desk.key("Escape");
    desk.closes();
}

#[test]
fn saving_the_same_materials_or_another_file_says_nothing() {
    if !can_run() {
        return;
    }
    let pack = copy_of_golden_pack();
    fs::write(pack.path().join("materials.toml"), GREEN).expect("written");
    let options = [pack.path().to_str().expect("a plain path"), "--size", "160x120", "--quality", "plain"];
    let green = render(&options);
    let mut desk = Desk::open(&options);
    desk.shows(&green, "the file that was there at the start");
    let told = desk.told();
    fs::write(pack.path().join("materials.toml"), GREEN).expect("written");
    fs::write(pack.path().join("materials.toml~"), "no [ TOML").expect("written");
    fs::write(pack.path().join("Materials.toml.bak"), "no [ TOML").expect("written");
    std::thread::sleep(A_WHILE);
    assert_eq!(desk.told(), told);
    assert_eq!(difference(&desk.picture(), &green), Some(0));
    desk.close_button();
    desk.closes();
}

#[test]
fn materials_that_change_while_the_window_opens_are_not_missed() {
    if !can_run() {
        return;
    }
    let pack = copy_of_golden_pack();
    // A texture that takes a while to be decoded. When it is opened, the materials have been read, and nobody
    // watches them yet.
    let slow = pack.path().join("SkinTex_Decal.png");
    let noise = image::RgbImage::from_fn(4096, 4096, |x, y| {
        image::Rgb(
            (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(2_246_822_519)).to_le_bytes()[1..]
                .try_into()
                .expect("three"),
        )
    });
    noise.save(&slow).expect("written");
    let file = pack.path().join("materials.toml");
    let (opened, is_opened) = std::sync::mpsc::channel();
    let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
        let event = event.expect("an event");
        if matches!(event.kind, EventKind::Access(AccessKind::Open(_))) && event.paths.contains(&slow) {
            let _ = opened.send(());
        }
    })
    .expect("a watcher");
    watcher.watch(pack.path(), RecursiveMode::NonRecursive).expect("watched");
    let writer = std::thread::spawn(move || {
        is_opened.recv_timeout(PATIENCE).expect("the texture is opened");
        fs::write(file, GREEN).expect("written");
    });
    let options = [pack.path().to_str().expect("a plain path"), "--size", "160x120", "--quality", "plain"];
    let mut desk = Desk::open(&options);
    writer.join().expect("the texture was read");
    drop(watcher);
    desk.shows(&render(&options), "changed while the textures were loaded");
    desk.close_button();
    desk.closes();
}

#[test]
fn the_look_of_the_command_line_is_the_windows() {
    if !can_run() {
        return;
    }
    let golden = common::golden_pack();
    let pack = [golden.to_str().expect("a plain path"), "--size", "160x120"];
    let mut pictures = vec![render(&pack)];
    for look in [
        &["--style", "toon"][..],
        &["--quality", "medium", "--light", "dramatic"],
        &["--quality", "plain", "--light", "daylight", "--tone-map", "agx", "--exposure", "-0.5"],
    ] {
        let options = [&pack[..], look].concat();
        let expected = render(&options);
        for other in &pictures {
            assert_ne!(difference(&expected, other), Some(0), "{look:?} changes the picture");
        }
        let mut desk = Desk::open(&options);
        desk.shows(&expected, &format!("{look:?}"));
        desk.do_xdotool(&["windowsize", &desk.window.to_string(), "120", "150"]);
        let resized = [&[pack[0], "--size", "120x150"], look].concat();
        desk.shows(&render(&resized), &format!("{look:?}, resized"));
        desk.close_button();
        desk.closes();
        pictures.push(expected);
    }
}

/// The window says what to install, as `render` does, and not that it found no surface.
#[cfg(target_os = "linux")]
#[test]
fn no_driver() {
    if !can_run() {
        return;
    }
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        for file in ["/dev/null", "/nonexistent.json"] {
            let mut command = viewer();
            command.arg(golden_pack()).env_remove("VK_DRIVER_FILES").env(variable, file);
            let named = format!("{variable}={file} names the only Vulkan drivers that are looked at");
            let install = "Debian, Ubuntu, Mint   apt install mesa-vulkan-drivers";
            ends_without_a_window(&mut command).fails(1, &["expected a GPU adapter", &named, install]);
        }
    }
}
