//! What is said to misspelt names and to numbers that cannot be.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{copy_of_golden_pack, finish, run, viewer};
use std::fs;

#[test]
fn misspelt_names_are_guessed() {
    for (arguments, found, meant) in [
        (&["bones", "--pose", "simle"][..], "pose", "smile"),
        (&["bones", "--pose", "smile:0.5 wink-letf"], "pose", "wink-left"),
        (&["trace", "--script", "0 supprise"], "pose", "surprise"),
        (&["bones", "--set", "jaw.opne=3"], "control", "jaw.open"),
        (&["bones", "--rotate", "HeadJont=x:3"], "joint", "HeadJoint"),
        (&["deform", "--part", "skni", "--out", "-"], "part", "skin"),
        (&["render", "--frame", "left-eyebal", "--out", "-"], "part", "left-eyeball"),
    ] {
        let (expected, meant) =
            (format!("expected the name of a {found}, found"), format!("(did you mean {meant:?}?)"));
        run(arguments).fails(2, &[&expected, &meant, "; there are: "]);
    }
    for (option, value, meant) in [
        ("--view", "frnt", "front"),
        ("--light", "dramtic", "dramatic"),
        ("--hair", "bobb", "bob"),
        ("--quality", "hihg", "high"),
        ("--style", "tonn", "toon"),
        ("--tone-map", "neutrl", "neutral"),
    ] {
        let expected = format!("error: {option}: expected one of ");
        let meant = format!("found {value:?} (did you mean {meant:?}?)");
        run(&["render", option, value, "--out", "-"]).fails(2, &[&expected, &meant]);
    }
    run(&["rendr"]).fails(2, &["expected a verb", "found \"rendr\"", "(did you mean \"render\"?)"]);
    run(&["help", "rendr"])
        .fails(2, &["verb: expected one of render, record,", "(did you mean \"render\"?)"]);
    run(&["render", "--frame", "fcae", "--out", "-"]).fails(2, &["(did you mean \"face\"?)"]);
    // What looks like nothing is not guessed.
    let far = run(&["bones", "--pose", "temperature"]);
    assert!(!far.stderr.contains("did you mean"), "{}", far.stderr);
    far.fails(2, &["expected the name of a pose, found \"temperature\"; there are: neutral, smile"]);
}

#[test]
fn what_is_missing_or_in_the_wrong_place_is_said() {
    let verb_first = "A verb comes first, its options after it: avatar-viewer render …";
    run(&["--size", "10x10", "render", "--out", "x.png"]).fails(2, &["--out", verb_first]);
    run(&["bones", "--time"]).fails(2, &["a value is required for '--time <SECONDS>' but none was supplied"]);
    run(&["render", "--out", ""]).fails(2, &["a value is required for '--out <FILE>'"]);
    run(&["render", "--out", "-", "--view", ""])
        .fails(2, &["--view: expected one of front,", "found nothing"]);
    run(&["bones", "--time", "1"]).fails(2, &["--clip <NAME>"]);
}

#[test]
fn misspelt_clips_are_guessed() {
    let pack = copy_of_golden_pack();
    let nod =
        "[[clip]]\nname = \"nodding\"\n[clip.tracks]\n\"head.bow\" = [{ t = 0, v = 0 }, { t = 1, v = 9 }]\n";
    fs::write(pack.path().join("clips.toml"), nod).expect("written");
    let told =
        ["expected the name of a clip, found \"noding\" (did you mean \"nodding\"?); there are: nodding"];
    finish(viewer().arg("bones").arg(pack.path()).args(["--clip", "noding"])).fails(2, &told);
    finish(viewer().arg("record").arg(pack.path()).args(["--clip", "noding", "--out", "-"])).fails(2, &told);
    // Clips of a file and clips that its user made are one list.
    let file = pack.path().join("swing.bvh");
    let bvh = "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n\
               MOTION\nFrames: 2\nFrame Time: 0.5\n0 0 0\n30 0 0\n";
    fs::write(&file, bvh).expect("written");
    let info = finish(viewer().arg("info").arg(&file).arg("--json")).ok();
    let info: serde_json::Value = serde_json::from_str(&info).expect("JSON");
    let name = info["clips"][0]["name"].as_str().expect("a clip");
    let misspelt = format!("{name}x");
    let told = format!("found {misspelt:?} (did you mean {name:?}?); there are: {name}");
    finish(viewer().arg("bones").arg(&file).args(["--clip", &misspelt])).fails(2, &[&told]);
}

#[test]
fn a_number_below_zero_is_told_by_its_option_and_range() {
    let render = &["render", "--out", "-"][..];
    let record = &["record", "--script", "0 smile", "--out", "-"][..];
    let trace = &["trace", "--script", "0 smile"][..];
    let strands = &["strands", "--out", "-"][..];
    for (verb, option, value, expected) in [
        (render, "--size", "-5", "WIDTHxHEIGHT, each from 1 to 8192"),
        (render, "--size", "-5x10", "WIDTHxHEIGHT, each from 1 to 8192"),
        (render, "--size", "10x-5", "WIDTHxHEIGHT, each from 1 to 8192"),
        (record, "--size", "-640x360", "WIDTHxHEIGHT, each from 1 to 8192"),
        (&[], "--size", "-1280x720", "WIDTHxHEIGHT, each from 1 to 8192"),
        (render, "--samples", "-4", "1 or 4"),
        (render, "--time", "-1", "seconds from 0 on"),
        (render, "--hair-density", "-0.5", "a number from 0 to 7"),
        (render, "--hair-seed", "-1", "a whole number from 0 to 18446744073709551615"),
        (strands, "--limit", "-1", "a whole number from 0 on"),
        (record, "--fps", "-3", "frames per second from 0.01 to 240"),
        (record, "--fps", "-30/1", "frames per second from 0.01 to 240"),
        (record, "--duration", "-1", "a finite number above 0"),
        (trace, "--duration", "-1e3", "a finite number above 0"),
        (trace, "--hz", "-240", "a finite number above 0"),
    ] {
        let clip = if option == "--time" { &["--clip", "nod"][..] } else { &[] };
        for arguments in [&[option, value][..], &[&format!("{option}={value}")]] {
            let told = [&format!("invalid value '{value}' for '{option}"), &format!("expected {expected}")];
            run(&[verb, clip, arguments].concat()).fails(2, &told.map(String::as_str));
        }
    }
    run(&["trace", "--script", "-1 smile"])
        .fails(2, &["--script: expected seconds from 0 on, found -1 in \"-1 smile\""]);
    // Where numbers go both ways they stay numbers.
    run(&["bones", "--set", "head.turn=-5"]).ok();
    run(&["trace", "--script", "0 smile:-0.5", "--hz", "1"]).ok();
}
