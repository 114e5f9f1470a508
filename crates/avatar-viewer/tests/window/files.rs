//! What the window keeps in files: settings, keys, and texts that others write as well.
#![allow(clippy::expect_used, reason = "a test may panic")]

use crate::desk::{Desk, PATIENCE, can_run, difference, errors, save_as_editors_do};
use crate::panel::{CLIPS, POSES, POSES_TAB, SAVE_THIS_FACE, open, pack};
use std::fs;
use std::time::{Duration, Instant};

#[test]
fn settings_stay_and_keys_are_the_users() {
    if !can_run() {
        return;
    }
    let (pack, settings) = pack();
    let keys = settings.path().join("mimik/keys.toml");
    fs::create_dir_all(settings.path().join("mimik")).expect("a folder");
    fs::write(&keys, "panel = \"F7\"\n").expect("written");
    let mut desk = open(&pack, &settings);
    let open = desk.settled();
    desk.key("F2");
    assert_eq!(difference(&desk.settled(), &open), Some(0), "the usual key means nothing now");
    desk.key("F7");
    desk.changes_from(&open, "the user's key");
    desk.do_xdotool(&["windowsize", &desk.window.to_string(), "500", "400"]);
    desk.settled();
    desk.key("Escape");
    desk.closes();
    drop(desk);

    fs::write(&keys, "panel = \"F7\"\n\nhair = 'no such key'\n").expect("written");
    let path = pack.path().to_str().expect("a plain path");
    let mut desk = Desk::with_panel(&[path, "--quality", "plain"], settings.path());
    let told = errors(&desk, 1);
    let place = format!("{}: line 3, column 8: hair: expected the name of a key", keys.display());
    assert!(told[0].contains(&place), "{}", told[0]);
    let settled = desk.settled();
    assert_eq!(settled.dimensions(), (500, 400), "as large as it was left");
    // Below the banner there is the face alone: the panel is folded as it was left.
    let ground = settled.get_pixel(495, 300);
    assert_eq!(ground, settled.get_pixel(5, 300), "no panel");
    desk.close_button();
    desk.closes();
}

#[test]
fn what_others_write_is_not_lost() {
    if !can_run() {
        return;
    }
    let (pack, settings) = pack();
    let file = pack.path().join("poses.toml");
    let mut desk = open(&pack, &settings);
    desk.click(POSES_TAB.0, POSES_TAB.1);
    desk.settled();
    desk.click(SAVE_THIS_FACE.0, SAVE_THIS_FACE.1);
    desk.settled();
    desk.write("mine");
    let broken = format!("{}# half written\n", POSES.replace("\"turn\"", "turn"));
    save_as_editors_do(pack.path(), "poses.toml", broken.as_bytes());
    errors(&desk, 1);
    desk.key("Return");
    let told = errors(&desk, 2);
    assert!(told[1].contains("which would be lost"), "{}", told[1]);
    assert_eq!(fs::read_to_string(&file).expect("the poses"), broken);

    // A mistake in the clips, mended: they are taken over, and nothing is left to be saved.
    save_as_editors_do(pack.path(), "clips.toml", CLIPS.replace("key = \"n\"", "key = n").as_bytes());
    errors(&desk, 3);
    save_as_editors_do(pack.path(), "clips.toml", CLIPS.replace("key = \"n\"", "key = \"m\"").as_bytes());
    std::thread::sleep(Duration::from_millis(500));
    let before = desk.settled();
    desk.key("m");
    desk.changes_from(&before, "the mended clip plays");
    desk.close_button();
    desk.closes();
    drop(desk);

    // With the mistake still there the window opens, with the usual poses.
    let mut desk = open(&pack, &settings);
    let told = errors(&desk, 1);
    assert!(told[0].contains("poses.toml: line 10"), "{}", told[0]);
    let before = desk.settled();
    desk.key("3");
    desk.changes_from(&before, "a pose that every face has");

    // Clips that are not saved are not thrown away without a word.
    desk.key("shift+r");
    desk.key("1");
    std::thread::sleep(Duration::from_millis(600));
    desk.key("shift+r");
    desk.close_button();
    let start = Instant::now();
    while !desk.told().contains("warning: Save them in the tab of clips") {
        assert!(start.elapsed() < PATIENCE, "{}", desk.told());
        std::thread::sleep(Duration::from_millis(50));
    }
    desk.close_button();
    desk.closes();
    assert!(!fs::read_to_string(pack.path().join("clips.toml")).expect("the clips").contains("recording"));
}
