//! The window, driven as a person drives it.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common;
use crate::desk::{Desk, PATIENCE, can_run, difference, key_of, render};
use std::time::{Duration, Instant};

#[test]
fn a_person_poses_the_face_by_keys() {
    if !can_run() {
        return;
    }
    let size = ["--size", "480x360"];
    let mut desk = Desk::open(&size);
    let at_rest = render(&size);
    desk.shows(&at_rest, "at first");

    // A press starts a gradual move; another one redirects it; the last pose is what stays.
    desk.key(&key_of("yawn"));
    let half_way = {
        let start = Instant::now();
        loop {
            let picture = desk.picture();
            if difference(&picture, &at_rest) != Some(0) || start.elapsed() > PATIENCE {
                break picture;
            }
        }
    };
    let before_the_second_key = desk.picture();
    desk.key(&key_of("smile"));
    let yawn = render(&[&size[..], &["--pose", "yawn"]].concat());
    let smile = render(&[&size[..], &["--pose", "smile"]].concat());
    assert_ne!(difference(&half_way, &at_rest), Some(0), "the face moves");
    assert_ne!(difference(&half_way, &yawn), Some(0), "and it does not jump");
    assert_ne!(difference(&before_the_second_key, &yawn), Some(0), "the second key falls into the move");
    desk.shows(&smile, "after the last press");

    // The camera: by mouse and back by key.
    desk.do_xdotool(&["mousemove", "--window", &desk.window.to_string(), "200", "150"]);
    desk.do_xdotool(&["mousedown", "1", "mousemove_relative", "100", "0", "mouseup", "1"]);
    desk.shows(&render(&[&size[..], &["--pose", "smile", "--yaw", "-35"]].concat()), "dragged by 100 pixels");
    desk.key("Home");
    desk.shows(&smile, "camera to the front");

    desk.do_xdotool(&["windowsize", &desk.window.to_string(), "400", "500"]);
    desk.shows(&render(&["--size", "400x500", "--pose", "smile"]), "resized");

    desk.key("BackSpace");
    desk.shows(&render(&["--size", "400x500"]), "back to the default face");

    desk.key("Escape");
    desk.closes();
}

#[test]
fn the_command_lines_face_is_shown_until_a_pose_is_pressed() {
    if !can_run() {
        return;
    }
    let face =
        ["--size", "320x240", "--set", "eye.left.ud=20", "--rotate", "HeadJoint=x:25", "--set", "smile=0.5"];
    let mut desk = Desk::open(&face);
    desk.shows(&render(&face), "at first");
    desk.key(&key_of("surprise"));
    desk.shows(&render(&["--size", "320x240", "--pose", "surprise"]), "after a press");
    desk.close_button();
    desk.closes();
}

#[test]
fn a_real_face_is_posed_by_keys() {
    let Some(face) = common::real_face() else { return };
    if !can_run() {
        return;
    }
    let face = [face.to_str().expect("a plain path"), "--size", "400x300"];
    let mut desk = Desk::open(&face);
    desk.shows(&render(&face), "at first");
    for pose in ["laugh", "wink-left", "look-up"] {
        desk.key(&key_of(pose));
        std::thread::sleep(Duration::from_millis(120));
    }
    desk.shows(&render(&[&face[..], &["--pose", "look-up"]].concat()), "after three presses");
    desk.close_button();
    desk.closes();
}

#[test]
fn clips_of_a_file_play_and_a_pose_ends_them() {
    if !can_run() {
        return;
    }
    let pack = common::copy_of_golden_pack();
    let pose = "[[pose]]\nname = 'turn'\n[pose.controls]\n'head.turn' = 30\nsmile = 1\n";
    std::fs::write(pack.path().join("poses.toml"), pose).expect("written");
    let file = pack.path().join("face.glb");
    let file = file.to_str().expect("a plain path");
    // Poses of a pack are clips of its GLB that last no time.
    common::run(&["convert", pack.path().to_str().expect("a plain path"), "--out", file]).ok();
    let options = [file, "--size", "320x240", "--quality", "plain"];
    let mut desk = Desk::open(&options);
    let at_rest = render(&options);
    desk.shows(&at_rest, "at first");
    desk.key("space");
    let first = render(&[&options[..], &["--clip", "turn"]].concat());
    assert_ne!(difference(&first, &at_rest), Some(0), "the clip shows");
    desk.shows(&first, "the first clip");
    desk.key("BackSpace");
    desk.shows(&at_rest, "its controls' face");
    desk.key("Escape");
    desk.closes();
}

/// The window reads poses again a moment after it opened, and where there is no file of poses.
#[test]
fn a_file_keeps_the_poses_that_its_shapes_make() {
    if !can_run() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_str().expect("a plain path").to_owned();
    let write = |name: &str, text: &str| std::fs::write(at(name), text).expect("written");
    write("face.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\n");
    std::fs::create_dir(at("targets")).expect("a folder");
    write("targets/mouthSmileLeft.target", "1 1 0 0\n");
    write("targets/mouthSmileRight.target", "3 -1 0 0\n");
    let options = [&at("face.obj")[..], "--with", &at("targets"), "--size", "320x240", "--quality", "plain"];
    let at_rest = render(&options);
    let smiling = render(&[&options[..], &["--pose", "smile"]].concat());
    assert_ne!(difference(&smiling, &at_rest), Some(0), "a smile shows");
    let mut desk = Desk::open(&options);
    desk.shows(&at_rest, "at first");
    std::thread::sleep(Duration::from_millis(1500));
    desk.key(&key_of("smile"));
    desk.shows(&smiling, "a pose of the nine-joint face, by shapes");
    desk.key(&key_of("neutral"));
    desk.shows(&at_rest, "at rest again");
    desk.key("Escape");
    desk.closes();
}

#[test]
fn a_window_that_was_hidden_or_had_no_room_shows_its_face_again() {
    if !can_run() {
        return;
    }
    let size = ["--size", "320x240", "--quality", "plain"];
    let mut desk = Desk::open(&size);
    desk.shows(&render(&size), "at first");
    let window = desk.window.to_string();
    // Without a window manager, hiding is what minimising is.
    desk.do_xdotool(&["windowunmap", "--sync", &window]);
    std::thread::sleep(Duration::from_millis(300));
    desk.do_xdotool(&["windowmap", "--sync", &window]);
    desk.do_xdotool(&["windowfocus", "--sync", &window]);
    desk.key(&key_of("smile"));
    desk.shows(&render(&[&size[..], &["--pose", "smile"]].concat()), "after it was hidden");
    desk.do_xdotool(&["windowsize", &window, "1", "1"]);
    std::thread::sleep(Duration::from_millis(300));
    desk.do_xdotool(&["windowsize", &window, "240", "320"]);
    let small = ["--size", "240x320", "--quality", "plain", "--pose", "smile"];
    desk.shows(&render(&small), "after it had no room");
    desk.key("Escape");
    desk.closes();
}
