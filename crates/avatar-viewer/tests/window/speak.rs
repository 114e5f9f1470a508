//! A face that speaks in the window.

use crate::common::vowel;
use crate::desk::{Desk, can_run, errors, render};

/// A file of labels that is dropped on the window is spoken, and afterwards the face is what it was; a broken
/// one is told of, with its place.
#[test]
fn labels_that_are_dropped_are_spoken() {
    if !can_run() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let labels = folder.path().join("talk.lab");
    std::fs::write(&labels, "0.0 0.2 sil\n0.2 0.9 aa\n0.9 1.0 m\n1.0 1.6 ow\n1.6 1.8 sil\n")
        .expect("written");
    let options = ["--size", "320x240"];
    let at_rest = render(&options);
    let mut desk = Desk::open(&options);
    desk.shows(&at_rest, "at first");
    desk.drop_file(&labels);
    desk.changes_from(&at_rest, "she speaks");
    desk.shows(&at_rest, "when all is said");
    // The same file, changed to one that cannot be read.
    std::fs::write(&labels, "0.0 0.2 sil\n0.1 oops\n").expect("written");
    desk.drop_file(&labels);
    let told = errors(&desk, 1);
    assert!(told[0].contains("talk.lab") && told[0].contains("line 2"), "{told:?}");
    desk.shows(&at_rest, "as if nothing had been dropped");
    desk.key("Escape");
    desk.closes();
}

/// A recording that is dropped is spoken by what is heard in it, whether or not there is a device that plays
/// it; where there is none, or the program was built without, a warning says so, and nothing is an error.
#[test]
fn a_recording_that_is_dropped_is_spoken() {
    if !can_run() {
        return;
    }
    let voice = vowel();
    let options = ["--size", "320x240"];
    let at_rest = render(&options);
    let mut desk = Desk::open(&options);
    desk.shows(&at_rest, "at first");
    desk.drop_file(voice.path());
    desk.changes_from(&at_rest, "she speaks");
    desk.shows(&at_rest, "when all is said");
    let told = desk.told();
    let warnings: Vec<&str> = told.lines().filter(|line| line.starts_with("warning:")).collect();
    if cfg!(feature = "sound") {
        assert!(warnings.len() <= 1, "{told}");
    } else {
        assert!(warnings.len() == 1 && warnings[0].contains("--features sound"), "{told}");
    }
    // What is no sound is told of, and changes nothing.
    std::fs::write(voice.path(), "no sound at all").expect("written");
    desk.drop_file(voice.path());
    let told = errors(&desk, 1);
    assert!(told[0].contains("expected a sound as WAV"), "{told:?}");
    desk.shows(&at_rest, "as if nothing had been dropped");
    desk.key("Escape");
    desk.closes();
}
