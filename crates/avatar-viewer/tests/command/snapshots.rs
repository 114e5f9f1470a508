//! A handful of small pictures and texts that were looked at, and must stay as they are.
//!
//! `MIMIK_UPDATE_SNAPSHOTS=1 cargo test -p avatar-viewer --test command snapshots` draws the pictures anew,
//! and `INSTA_UPDATE=always` writes the texts anew: look at them before they are committed.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common;
use crate::common::{finish, golden_pack, has_adapter, viewer};
use std::path::Path;

/// Adapters round differently at edges: this share of the channels may differ by more than `SMALL`.
const FEW: f64 = 0.01;
/// Differences that nobody sees.
const SMALL: u8 = 6;
/// No difference is larger: at an edge one of a pixel's four samples falls to the other side. The largest
/// that was seen between two versions of the software adapter is 72.
const LARGE: u8 = 96;
/// With one sample a pixel changes as a whole: this share of the channels may differ by more than `LARGE`.
const FLIPPED: f64 = 0.001;

/// Renders the small pack and compares with the picture of this name.
fn looks_like(name: &str, options: &[&str]) {
    if !has_adapter() {
        return;
    }
    let expected =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/command/snapshots").join(format!("{name}.png"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let found = folder.path().join("found.png");
    let mut render = viewer();
    render
        .arg("render")
        .arg(golden_pack())
        .args(["--size", "160x160"])
        .args(options)
        .arg("--out")
        .arg(&found);
    finish(&mut render).ok();
    if std::env::var_os("MIMIK_UPDATE_SNAPSHOTS").is_some_and(|value| value == "1") {
        std::fs::create_dir_all(expected.parent().expect("a folder")).expect("made");
        std::fs::copy(&found, &expected).expect("written");
    }
    let size = std::fs::metadata(&expected).expect("a committed picture").len();
    assert!(size <= 64 * 1024, "{name}: {size} bytes");
    let open = |path: &Path| image::open(path).expect("a picture").into_rgba8();
    let (found, expected) = (open(&found), open(&expected));
    assert_eq!(found.dimensions(), expected.dimensions(), "{name}");
    let differences = || found.as_raw().iter().zip(expected.as_raw()).map(|(a, b)| a.abs_diff(*b));
    let share = |above: u8| {
        differences().filter(|difference| *difference > above).count() as f64 / found.as_raw().len() as f64
    };
    assert!(share(SMALL) <= FEW, "{name}: {:.2} % of the channels differ", share(SMALL) * 100.0);
    let one_sample = options.windows(2).any(|pair| pair == ["--samples", "1"]);
    let flipped = if one_sample { FLIPPED } else { 0.0 };
    let largest = differences().max().unwrap_or(0);
    assert!(share(LARGE) <= flipped, "{name}: a channel differs by {largest}");
}

#[test]
fn front() {
    looks_like("front", &["--quality", "plain"]);
}

#[test]
fn three_quarter_smile() {
    let options = ["--view", "three-quarter", "--set", "smile=1", "--pitch", "15", "--quality", "plain"];
    looks_like("three-quarter-smile", &options);
}

#[test]
fn every_quality_and_style() {
    for quality in ["low", "medium", "high"] {
        looks_like(&format!("quality-{quality}"), &["--quality", quality, "--view", "three-quarter"]);
    }
    looks_like("style-toon", &["--style", "toon", "--view", "three-quarter"]);
}

#[test]
fn other_light() {
    looks_like("light-dramatic-agx", &["--quality", "medium", "--light", "dramatic", "--tone-map", "agx"]);
    looks_like("light-daylight", &["--quality", "medium", "--light", "daylight", "--exposure", "-0.5"]);
}

#[test]
fn transparent_side() {
    let options = [
        "--view",
        "left",
        "--background",
        "transparent",
        "--samples",
        "1",
        "--set",
        "jaw.open=20",
        "--quality",
        "plain",
    ];
    looks_like("transparent-side", &options);
}

#[test]
fn keys() {
    insta::assert_snapshot!(common::run(&["keys"]).ok());
}

#[test]
fn info_of_the_small_pack() {
    let mut info = viewer();
    // Relative, so that no folder of this machine stands in the text.
    info.current_dir(golden_pack()).args(["info", "."]);
    insta::assert_snapshot!(finish(&mut info).ok());
}
