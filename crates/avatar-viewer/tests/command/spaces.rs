//! The names of other programs, and ways between them.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{finish, run, shared_data, viewer};

#[test]
fn spaces_are_listed_with_their_names() {
    let list = run(&["spaces"]).ok();
    assert_eq!(list.lines().count(), 11, "{list}");
    assert!(list.lines().any(|line| line.starts_with("arkit ") && line.contains(" 52 names ")), "{list}");
    let names = run(&["spaces", "--from", "facs"]).ok();
    let line = names.lines().find(|line| line.starts_with("AU12L ")).expect("a smile");
    assert!(
        line.contains("0..1") && line.ends_with("left   The left corner of the mouth moves up and out."),
        "{line}"
    );
    // One line for each, below the source.
    assert_eq!(names.lines().count(), 72);
}

#[test]
fn maps_are_told_as_rules() {
    let map = run(&["spaces", "--from", "arkit", "--to", "facs"]).ok();
    for line in [
        "arkit to facs",
        "  AU12L = mouthSmileLeft",
        "  AU27 = -1 + 2 jawOpen",
        "not said in facs: mouthLeft, mouthRight",
    ] {
        assert!(map.lines().any(|other| other == line), "{line} is not in: {map}");
    }
    // Two maps, one after the other.
    let map = run(&["spaces", "--from", "arkit", "--to", "vrm0"]).ok();
    assert!(map.contains("arkit to vrm1\n") && map.contains("vrm1 to vrm0\n"), "{map}");
}

#[test]
fn losses_are_told_by_name() {
    let report = run(&["spaces", "--from", "arkit", "--to", "mediapipe", "--report"]).ok();
    let expected = "arkit to mediapipe and back: of 52 names\n  51 come back as they were\n  0 come back changed\n  \
        0 count only together with others\n  1 are lost\ntongueOut is lost\nnever set in mediapipe: _neutral\n";
    assert_eq!(report, expected);
}

/// A way to the same names moves no vertex; one that loses some does, and the best values do no worse.
#[test]
fn losses_are_measured_on_the_face() {
    let Some(recording) = shared_data("livelink-recording/dao.csv") else { return };
    let measured = |to: &str| {
        let mut spaces = viewer();
        spaces.args(["spaces", "--from", "arkit", "--to", to, "--report", "--over"]).arg(&recording);
        let report = finish(&mut spaces).ok();
        let of = |what: &str, kind: &str| -> f64 {
            let line = report.lines().find(|line| line.trim_start().starts_with(what)).expect("a line");
            let number =
                line.split(kind).nth(1).and_then(|rest| rest.split([',', ' ']).find(|word| !word.is_empty()));
            number.and_then(|word| word.parse().ok()).unwrap_or_else(|| panic!("{line}"))
        };
        ["they are away", "there and back", "by least squares"]
            .map(|what| [of(what, "mean"), of(what, "largest")])
    };
    let [moved, same, best] = measured("live-link");
    assert!(moved[0] > 0.5 && moved[1] > 5.0, "a face that speaks: {moved:?}");
    assert_eq!(same, [0.0; 2]);
    assert!(best[0] < 0.02, "{best:?}");
    let [_, mapped, best] = measured("vrm1");
    assert!(mapped[0] > 0.1 && mapped[0] < moved[0] && best[0] <= mapped[0], "{mapped:?} {best:?}");
}

#[test]
fn misspelt_spaces_are_guessed() {
    run(&["spaces", "--from", "arkti"])
        .fails(2, &["expected one of arkit, live-link", "did you mean \"arkit\"?"]);
    run(&["spaces", "--to", "arkit"]).fails(2, &["--from"]);
    run(&["spaces", "--from", "arkit", "--to", "facs", "--over", "x.csv"]).fails(2, &["--report"]);
    run(&["spaces", "--from", "arkit", "--to", "facs", "--report", "--over", "nothing.csv"])
        .fails(1, &["nothing.csv: expected a recording of a face"]);
}
