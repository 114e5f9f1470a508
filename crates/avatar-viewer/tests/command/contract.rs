//! The command line as a contract: what every verb prints and writes.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{
    close, copy_of_golden_pack, finish, golden_pack, has_adapter, json, numbers, read_obj, real_face, run,
    viewer,
};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Controls of the built-in face: those of nine joints and two shapes, 52 names of ARKit, two of the tongue,
/// 15 visemes.
const CONTROLS: usize = 15 + 52 + 2 + 15;

/// The `skin` matrix of a joint after these options, row by row.
fn skin_matrix(options: &[&str], joint: &str) -> Vec<f64> {
    let mut arguments = vec!["bones"];
    arguments.extend(options);
    let report = json(&run(&arguments).ok());
    let joints = report["joints"].as_array().expect("joints").clone();
    let joint = joints.iter().find(|j| j["name"] == joint).expect("the joint");
    numbers(&joint["skin"])
}

/// Where a bone matrix turns a direction to.
fn turned(matrix: &[f64], direction: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|row| (0..3).map(|column| matrix[row * 4 + column] * direction[column]).sum())
}

#[test]
fn every_control_moves_the_face_the_way_its_name_says() {
    const FORWARD: [f64; 3] = [0.0, 0.0, 1.0];
    const UP: [f64; 3] = [0.0, 1.0, 0.0];
    // Control, joint, a direction that it turns, and where to: axis and sign.
    let expected = [
        ("head.turn", "HeadJoint", FORWARD, 0, 1.0),
        ("head.bow", "HeadJoint", FORWARD, 1, -1.0),
        ("head.bend", "HeadJoint", UP, 0, 1.0),
        ("jaw.open", "JawJoint", FORWARD, 1, -1.0),
        ("jaw.jut", "JawJoint", FORWARD, 0, 1.0),
        ("eye.left.ud", "LtEyeJoint", FORWARD, 1, 1.0),
        ("eye.right.ud", "RtEyeJoint", FORWARD, 1, 1.0),
        ("eye.left.lr", "LtEyeJoint", FORWARD, 0, 1.0),
        ("eye.right.lr", "RtEyeJoint", FORWARD, 0, 1.0),
        ("lid.left.upper", "LtUpperLidJoint", FORWARD, 1, -1.0),
        ("lid.right.upper", "RtUpperLidJoint", FORWARD, 1, -1.0),
        ("lid.left.lower", "LtLowerLidJoint", FORWARD, 1, 1.0),
        ("lid.right.lower", "RtLowerLidJoint", FORWARD, 1, 1.0),
    ];
    let mut packs = vec![None];
    packs.extend(real_face().map(Some));
    for pack in &packs {
        let pack = pack.as_deref().and_then(Path::to_str);
        let rest = skin_matrix(&pack.into_iter().collect::<Vec<_>>(), "HeadJoint");
        assert!((rest[0] - 1.0).abs() < 1e-4, "at rest every bone matrix is the identity");
        for (control, joint, direction, axis, sign) in expected {
            let setting = format!("{control}=5");
            let mut options: Vec<&str> = pack.into_iter().collect();
            options.extend(["--set", &setting]);
            let moved = turned(&skin_matrix(&options, joint), direction);
            let sine = 5f64.to_radians().sin();
            // Joint frames are not parallel to the world's axes: the real face's jaw leans by 51 degrees. The
            // sign and that nothing else moves are what matters.
            assert!(moved[axis] * sign > 0.5 * sine, "{control} in {pack:?}: {moved:?}");
            let others = (0..3).filter(|&other| other != axis && direction[other] == 0.0);
            for other in others {
                assert!(moved[other].abs() < 0.2 * sine, "{control} in {pack:?}: {moved:?}");
            }
        }
    }
}

#[test]
fn set_moves_one_control_and_nothing_else() {
    let still = json(&run(&["bones"]).ok());
    for (control, joint) in [("eye.left.ud", "LtEyeJoint"), ("lid.right.upper", "RtUpperLidJoint")] {
        let moved = json(&run(&["bones", "--set", &format!("{control}=12")]).ok());
        let pairs = still["joints"]
            .as_array()
            .expect("joints")
            .iter()
            .zip(moved["joints"].as_array().expect("joints"));
        for (before, after) in pairs {
            assert_eq!(
                before["skin"] == after["skin"],
                before["name"] != joint,
                "{control}: {}",
                before["name"]
            );
        }
    }
}

#[test]
fn later_options_win_over_the_pose_and_values_are_clamped() {
    let asleep = json(&run(&["bones", "--pose", "sleep", "--set", "smile=0.25", "--set", "frown=-3"]).ok());
    assert_eq!(asleep["weights"]["smile"], 0.25);
    assert_eq!(asleep["weights"]["frown"], 0.0);
    let clamped = run(&["bones", "--set", "head.turn=500"]);
    assert!(
        clamped.stderr.contains("head.turn") && clamped.stderr.contains("clamped to 70"),
        "{}",
        clamped.stderr
    );
    assert_eq!(clamped.ok(), run(&["bones", "--set", "head.turn=70"]).ok());
    let order = ["bones", "--rotate", "HeadJoint=x:20", "--set", "head.turn=7"];
    assert_eq!(run(&order).ok(), run(&["bones", "--set", "head.turn=7"]).ok());
    let order = ["bones", "--set", "head.turn=7", "--rotate", "HeadJoint=x:20"];
    assert_eq!(run(&order).ok(), run(&["bones", "--rotate", "HeadJoint=x:20"]).ok());
}

#[test]
fn deform_writes_every_part_in_its_order() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("part.obj");
    let info = json(&run(&["info", "--json"]).ok());
    for part in info["parts"].as_array().expect("parts") {
        let name = part["name"].as_str().expect("a name");
        finish(viewer().args(["deform", "--part", name, "--out"]).arg(&out)).ok();
        let (positions, normals, faces) = read_obj(&out);
        assert_eq!(positions.len() as u64, part["vertices"].as_u64().expect("a count"), "{name}");
        assert_eq!(normals.len(), positions.len(), "{name}");
        assert_eq!(faces.len() as u64, part["triangles"].as_u64().expect("a count"), "{name}");
        if has_adapter() {
            let run = finish(viewer().args(["deform", "--gpu", "--part", name, "--out"]).arg(&out));
            assert!(run.stderr.contains("adapter"), "--gpu names the adapter: {}", run.stderr);
            run.ok();
            let (gpu_positions, gpu_normals, gpu_faces) = read_obj(&out);
            close(&gpu_positions.concat(), &positions.concat(), name);
            close(&gpu_normals.concat(), &normals.concat(), name);
            assert_eq!(gpu_faces, faces);
        }
    }
}

#[test]
fn info_tells_everything() {
    let info = json(&run(&["info", "--json"]).ok());
    assert_eq!(info["parts"].as_array().expect("parts").len(), 7);
    assert_eq!(info["joints"].as_array().expect("joints").len(), 9);
    assert_eq!(info["controls"].as_array().expect("controls").len(), CONTROLS);
    assert_eq!(info["poses"].as_array().expect("poses").len(), 27);
    assert_eq!(info["warnings"].as_array().expect("warnings").len(), 0, "{}", info["warnings"]);
    let skin = &info["parts"][0];
    assert_eq!(skin["name"], "skin");
    assert!(numbers(&skin["min"])[1] < numbers(&skin["max"])[1]);
    let turn = &info["controls"][0];
    let fields = ["name", "min", "max", "default"].map(|field| turn[field].clone());
    assert_eq!(fields, [Value::from("head.turn"), (-70.0).into(), 70.0.into(), 0.0.into()]);
    let text = run(&["info"]).ok();
    for word in ["skin", "HeadJoint", "head.turn", "neutral"] {
        assert!(text.contains(word), "{word} is not in: {text}");
    }
    // The golden pack's right eye is a mirror copy with the left one's index buffer.
    let golden = finish(viewer().arg("info").arg(golden_pack()).arg("--json")).ok();
    assert!(golden.contains("right-eyeball: expected triangles that agree"), "{golden}");
}

#[test]
fn all_default_poses_are_there() {
    let info = json(&run(&["info", "--json"]).ok());
    let names: Vec<_> =
        info["poses"].as_array().expect("poses").iter().filter_map(|p| p["name"].as_str()).collect();
    let wanted = "neutral smile frown laugh surprise anger sadness disgust wink-left wink-right sleep cross-eyed \
                  look-left look-up yawn skeptical";
    for pose in wanted.split_whitespace() {
        assert!(names.contains(&pose), "{pose} is not in {names:?}");
        run(&["bones", "--pose", pose]).ok();
    }
}

#[test]
fn trace_presses_at_exact_times() {
    let script = "0 smile; 0.3 frown; 0.9 neutral";
    let text = run(&["trace", "--script", script]).ok();
    let mut lines = text.lines();
    let header: Vec<_> = lines.next().expect("a header").split(',').collect();
    assert_eq!(header[0], "t");
    assert_eq!(header.len(), 1 + CONTROLS);
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), 721, "three seconds at 240 Hz, both ends");
    assert_eq!(rows[0][0], 0.0);
    assert_eq!(rows[720][0], 3.0);
    assert!(rows[0][1..].iter().all(|&x| x == 0.0), "the motion starts from the defaults");
    let column = |name: &str| header.iter().position(|h| *h == name).expect("a column");
    let smile = column("mouthSmileLeft");
    assert!(rows[72][smile] > 0.2, "the smile is under way at 0.3 s");
    assert!(rows[720][1..].iter().all(|&x| x == 0.0), "neutral is reached to the bit");
    // The same motion, sampled three times less often: presses do not wait for ticks.
    let sparse = run(&["trace", "--script", script, "--hz", "80"]).ok();
    for (row, line) in sparse.lines().skip(1).enumerate() {
        let values: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
        for (a, b) in values.iter().zip(&rows[row * 3]) {
            assert!((a - b).abs() < 1e-4, "row {row}: {a} and {b}");
        }
    }
    assert_eq!(run(&["trace", "--script", "", "--hz", "10", "--duration", "1"]).ok().lines().count(), 12);
}

#[test]
fn trace_prints_derivatives_that_are_those_of_the_values() {
    let script = "0 laugh; 0.15 look-left; 0.2 smile:0.5 wink-left; 0.6 neutral";
    let hz = 4000.0;
    let text = run(&["trace", "--script", script, "--derivatives", "--hz", "4000", "--duration", "1.5"]).ok();
    let header: Vec<_> = text.lines().next().expect("a header").split(',').collect();
    assert_eq!(header.len(), 1 + 3 * CONTROLS);
    for control in 1..=CONTROLS {
        assert_eq!(header[control + CONTROLS], format!("{}'", header[control]));
        assert_eq!(header[control + 2 * CONTROLS], format!("{}''", header[control]));
    }
    let rows: Vec<Vec<f64>> = (text.lines().skip(1))
        .map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect())
        .collect();
    // Hermite's rule takes both ends' slopes into account, so that its error is far below f32's.
    for column in 1..=2 * CONTROLS {
        let mut integral = rows[0][column];
        for pair in rows.windows(2) {
            let (a, b, dt) = (&pair[0], &pair[1], 1.0 / hz);
            integral += (a[column + CONTROLS] + b[column + CONTROLS]) * dt / 2.0;
            if column <= CONTROLS {
                integral += (a[column + 2 * CONTROLS] - b[column + 2 * CONTROLS]) * dt * dt / 12.0;
                assert!(
                    (integral - b[column]).abs() < 1e-5 * (1.0 + b[column].abs()),
                    "{}: {integral} {}",
                    header[column],
                    b[column]
                );
            }
        }
        let last = rows[rows.len() - 1][column];
        assert!(
            (integral - last).abs() < 1e-2 * (1.0 + last.abs()),
            "{}: {integral} and {last}",
            header[column]
        );
    }
}

#[test]
fn keys_name_every_pose_with_a_key() {
    let keys = run(&["keys"]).ok();
    let info = json(&run(&["info", "--json"]).ok());
    for pose in info["poses"].as_array().expect("poses") {
        let name = pose["name"].as_str().expect("a name");
        if let Some(key) = pose["key"].as_str() {
            let line = keys.lines().find(|line| line.ends_with(&format!("pose {name}")));
            assert!(line.is_some_and(|line| line.starts_with(key)), "{name} ({key}) is not in: {keys}");
        }
    }
    assert!(keys.contains("Escape"));
}

#[test]
fn help_explains_every_verb() {
    let help = run(&["--help"]).ok();
    // As the program lists them, each with a sentence, up to an empty line; sentences go on farther to the
    // right.
    let listed = help.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("a list");
    let starts =
        listed.lines().filter_map(|line| line.strip_prefix("  ")).filter(|line| !line.starts_with(' '));
    let verbs: Vec<_> = starts.map(|line| line.split_once(' ').expect("a sentence")).collect();
    for known in [
        "render", "record", "sheet", "bones", "deform", "strands", "convert", "trace", "info", "keys",
        "spaces", "speak", "live",
    ] {
        assert!(verbs.iter().any(|(verb, _)| *verb == known), "{known} is not in: {listed}");
    }
    // `help` itself has no options.
    for (verb, explained) in verbs.into_iter().filter(|(verb, _)| *verb != "help") {
        assert!(!explained.trim().is_empty(), "{verb}");
        let of_verb = run(&[verb, "--help"]).ok();
        assert!(of_verb.contains(&format!("Usage: avatar-viewer {verb}")), "{verb}: {of_verb}");
    }
}

#[test]
fn render_makes_a_picture_of_the_wanted_size_and_background() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("face.png");
    let render = |options: &[&str]| {
        finish(viewer().arg("render").args(options).arg("--out").arg(&out)).ok();
        image::open(&out).expect("a PNG").into_rgba8()
    };
    let front = render(&["--size", "160x90", "--background", "#336699"]);
    assert_eq!(front.dimensions(), (160, 90));
    assert_eq!(front.get_pixel(0, 0).0, [0x33, 0x66, 0x99, 255]);
    assert_ne!(front.get_pixel(80, 45).0, [0x33, 0x66, 0x99, 255], "the face is in the middle");
    let clear = render(&["--size", "160x90", "--background", "transparent", "--samples", "1"]);
    assert_eq!(clear.get_pixel(0, 0).0[3], 0);
    assert_eq!(clear.get_pixel(80, 45).0[3], 255);
    let left = render(&["--size", "160x90", "--view", "left"]);
    assert_eq!(left, render(&["--size", "160x90", "--yaw", "90"]));
    assert_ne!(left, render(&["--size", "160x90", "--yaw", "-90", "--pitch", "-10"]));
}

#[test]
fn two_runs_give_identical_bytes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut writing = vec![("obj", vec!["deform", "--pose", "yawn"])];
    if has_adapter() {
        writing.push(("obj", vec!["deform", "--pose", "yawn", "--gpu"]));
        let laugh = ["render", "--pose", "laugh", "--view", "three-quarter", "--size", "320x240"];
        writing.extend(["png", "jpg", "webp"].map(|ending| (ending, laugh.to_vec())));
        writing.push(("png", vec!["sheet"]));
    }
    for (ending, verb) in writing {
        let bytes = ["a", "b"].map(|name| {
            let file = folder.path().join(format!("{name}.{ending}"));
            finish(viewer().args(&verb).arg("--out").arg(&file)).ok();
            fs::read(file).expect("a file")
        });
        assert!(bytes[0] == bytes[1], "{verb:?}");
    }
    for verb in [
        &["info", "--json"][..],
        &["info"],
        &["bones", "--pose", "anger"],
        &["keys"],
        &["trace", "--script", "0 yawn"],
    ] {
        assert_eq!(run(verb).ok(), run(verb).ok(), "{verb:?}");
    }
}

#[test]
fn an_existing_file_is_replaced_and_a_device_is_not() {
    let pack = copy_of_golden_pack();
    let out = pack.path().join("old.obj");
    fs::write(&out, "old").expect("written");
    finish(viewer().arg("deform").arg(pack.path()).arg("--out").arg(&out)).ok();
    assert!(fs::read_to_string(&out).expect("a file").starts_with("o skin"));
    if Path::new("/dev/null").exists() {
        finish(viewer().arg("deform").arg(pack.path()).args(["--out", "/dev/null"])).ok();
        assert!(!fs::metadata("/dev/null").expect("still there").is_file());
    }
}
