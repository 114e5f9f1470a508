//! What is said to misspelt names and to numbers that cannot be.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{copy_of_golden_pack, finish, golden_pack, run, viewer};
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
    // Also with what would belong to the verb.
    for arguments in [
        &["rendr", "face.glb", "--out", "x.png"][..],
        &["rendr", "--out", "x.png"],
        &["rendr", "face.glb"],
        &["rendr", "--size", "3x3"],
        &["rendr", "face.glb", "--otu", "x.png"],
    ] {
        run(arguments).fails(
            2,
            &[
                "expected a verb, or the folder or file of an avatar, found \"rendr\"",
                "(did you mean \"render\"?)",
            ],
        );
    }
    let golden = golden_pack();
    let golden = golden.to_str().expect("a plain path");
    run(&[golden, "rendr", "--out", "x.png"])
        .fails(2, &["expected no further name, found \"rendr\" (did you mean \"render\"?)"]);
    run(&["help", "rendr"])
        .fails(2, &["verb: expected one of render, record,", "(did you mean \"render\"?)"]);
    run(&["render", "--frame", "fcae", "--out", "-"]).fails(2, &["(did you mean \"face\"?)"]);
    // What looks like nothing is not guessed.
    let far = run(&["bones", "--pose", "temperature"]);
    assert!(!far.stderr.contains("did you mean"), "{}", far.stderr);
    far.fails(2, &["expected the name of a pose, found \"temperature\"; there are: neutral, smile"]);
}

#[test]
fn misspelt_options_are_guessed_by_every_verb() {
    for (verb, misspelt, meant) in [
        ("", "--no-panle", "--no-panel"),
        ("", "--poze", "--pose"),
        ("render", "--otu", "--out"),
        ("render", "-otu", "--out"),
        ("render", "--hair-densty=2", "--hair-density"),
        ("record", "--scirpt", "--script"),
        ("sheet", "--formt", "--format"),
        ("bones", "--rotat", "--rotate"),
        ("deform", "--wrld", "--world"),
        ("convert", "--ou", "--out"),
        ("strands", "--limti", "--limit"),
        ("trace", "--derivative", "--derivatives"),
        ("info", "--jsn", "--json"),
        ("keys", "--wiht", "--with"),
        ("keys", "--hepl", "--help"),
    ] {
        let place = if verb.is_empty() { "the window" } else { verb };
        let found = misspelt.split('=').next().expect("a name");
        let told = format!("expected an option of {place}, found {found:?} (did you mean {meant:?}?)");
        let verb: &[&str] = if verb.is_empty() { &[] } else { &[verb] };
        run(&[verb, &[misspelt]].concat()).fails(2, &[&told]);
    }
    run(&["info", "--script", "0 smile"])
        .fails(2, &["expected an option of info, found \"--script\", an option of record, trace"]);
    run(&["info", "--no-panel"])
        .fails(2, &["expected an option of info, found \"--no-panel\", an option of the window"]);
    let far = run(&["info", "--temperature"]);
    assert!(
        !far.stderr.contains("did you mean") && !far.stderr.contains("an option of the"),
        "{}",
        far.stderr
    );
    far.fails(2, &["expected an option of info, found \"--temperature\""]);
    // A file to write in the place of a further name.
    for arguments in [&["render", "face.glb", "face.png", "--out", "x.png"][..], &["face.glb", "face.png"]] {
        run(arguments).fails(2, &["expected no further name, found \"face.png\"", "follows --out"]);
    }
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
    // Names: what has no such name says so, and nothing speaks of another option.
    let golden = golden_pack();
    let golden = golden.to_str().expect("a plain path");
    let nothing = "-3: expected the folder or file of an avatar, found nothing of that name";
    let (film, table) = (&["record", "--out", "-"][..], &["info"][..]);
    let (mesh, sheet, glb) = (&["deform", "--out", "-"][..], &["sheet"][..], &["convert"][..]);
    for (verb, option, status, expected) in [
        (render, "--pose", 2, "expected the name of a pose, found \"-3\"; there are: "),
        (render, "--clip", 2, "expected the name of a clip, found \"-3\"; there are: none"),
        (render, "--frame", 2, "expected the name of a part, found \"-3\"; there are: "),
        (render, "--set", 2, "expected CONTROL=VALUE"),
        (render, "--rotate", 2, "expected JOINT=AXIS:DEGREES"),
        (render, "--view", 2, "--view: expected one of front, "),
        (render, "--light", 2, "--light: expected one of "),
        (render, "--quality", 2, "--quality: expected one of "),
        (render, "--style", 2, "--style: expected one of "),
        (render, "--tone-map", 2, "--tone-map: expected one of "),
        (render, "--hair", 2, "--hair: expected one of "),
        (render, "--format", 2, "--format: expected one of png, "),
        (render, "--background", 2, "expected #RRGGBB or transparent"),
        (render, "--exposure", 2, ""),
        (film, "--clip", 2, "expected the name of a clip, found \"-3\"; there are: none"),
        (film, "--script", 2, "expected"),
        (mesh, "--part", 2, "expected the name of a part, found \"-3\"; there are: skin"),
        (sheet, "--out", 2, "--out: expected a name that ends in .png, .jpg, .jpeg or .webp, "),
        (&["bones"], "--out", 2, "--out: expected a name that ends in .json, "),
        (trace, "--out", 2, "--out: expected a name that ends in .csv, "),
        (&["strands"], "--out", 2, "--out: expected a name that ends in .json, "),
        (glb, "--out", 2, ""),
        (table, "--with", 1, "expected a file that further files belong to, found a folder"),
        (&[], "--quality", 2, "--quality: expected one of "),
    ] {
        // Exposure goes both ways, and a folder may have this name.
        let value = match option {
            "--exposure" => "-3000",
            "--out" if verb == glb => "-3.5",
            _ => "-3",
        };
        for arguments in [&[option, value][..], &[&format!("{option}={value}")]] {
            let run = run(&[verb, &[golden], arguments].concat());
            assert!(
                !run.stderr.contains("as a value, use") && !run.stderr.contains("unexpected"),
                "{}",
                run.stderr
            );
            run.fails(status, &[expected]);
        }
    }
    for verb in
        [&[][..], render, &["sheet", "--out", "-"], &["bones"], mesh, glb, strands, trace, table, &["keys"]]
    {
        run(&[verb, &["-3"], if verb == glb { &["x.glb"][..] } else { &[] }].concat()).fails(1, &[nothing]);
    }
    run(&["trace", "--script", "-1 smile"])
        .fails(2, &["--script: expected seconds from 0 on, found -1 in \"-1 smile\""]);
    // Where numbers go both ways they stay numbers.
    run(&["bones", "--set", "head.turn=-5"]).ok();
    run(&["trace", "--script", "0 smile:-0.5", "--hz", "1"]).ok();
}
