//! Films from the command line, and the state that is written into pictures.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{copy_of_golden_pack, finish, golden_pack, has_adapter, json, run, viewer};
use image::AnimationDecoder;
use image::codecs::png::PngDecoder;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

const SIZE: [&str; 2] = ["--size", "48x36"];
const SCRIPT: &str = "0.05 smile; 0.2 look-left; 0.31 smile:0.5 wink-left";

fn record(pack: &Path, options: &[&str], out: &Path) {
    let run = finish(viewer().arg("record").arg(pack).args(options).args(SIZE).arg("--out").arg(out));
    assert_eq!(run.ok(), "");
}

fn render(pack: &Path, options: &[String]) -> image::RgbaImage {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("still.png");
    finish(viewer().arg("render").arg(pack).args(options).args(SIZE).arg("--out").arg(&out)).ok();
    image::open(&out).expect("a PNG").into_rgba8()
}

/// Numbered pictures of a folder, in their order.
fn pictures(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<_> =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    files
}

/// Names and values of `trace` at each of its rows.
fn traced(pack: &Path, options: &[&str]) -> Vec<Vec<(String, f32)>> {
    let text = finish(viewer().arg("trace").arg(pack).args(options)).ok();
    let mut lines = text.lines();
    let names: Vec<_> = lines.next().expect("a header").split(',').skip(1).collect();
    let row = |line: &str| {
        let values = line.split(',').skip(1).map(|value| value.parse().expect("a number"));
        names.iter().map(|name| (*name).to_owned()).zip(values).collect()
    };
    lines.map(row).collect()
}

#[test]
fn frames_are_pictures_of_the_traced_states() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (pack, out) = (golden_pack(), folder.path().join("frames"));
    record(&pack, &["--script", SCRIPT, "--fps", "10"], &out);
    let files = pictures(&out);
    // Many more rows than frames: a state does not depend on how often it was looked at.
    let rows = traced(&pack, &["--script", SCRIPT, "--hz", "240"]);
    assert!((8..20).contains(&files.len()), "{} frames", files.len());
    for (k, file) in files.iter().enumerate() {
        assert_eq!(file.file_name().expect("a name").to_string_lossy(), format!("{k:04}.png"));
        let settings =
            rows[k * 24].iter().flat_map(|(name, value)| ["--set".to_owned(), format!("{name}={value}")]);
        let frame = image::open(file).expect("a PNG").into_rgba8();
        assert!(frame == render(&pack, &settings.collect::<Vec<_>>()), "frame {k}");
    }
    // It lasts until everything is at rest, and not longer.
    let last = files.len() - 1;
    let end = rows.last().expect("rows");
    assert_eq!(&rows[last * 24], end);
    assert_ne!(&rows[(last - 1) * 24], end);
}

#[test]
fn every_format_holds_the_same_frames() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let pack = golden_pack();
    let options = ["--script", SCRIPT, "--fps", "12.5", "--duration", "0.8", "--quality", "low"];
    let file = |name: &str| {
        let out = folder.path().join(name);
        record(&pack, &options, &out);
        out
    };
    let frames: Vec<_> = pictures(&file("frames/"))
        .iter()
        .map(|path| image::open(path).expect("a PNG").into_rgba8())
        .collect();
    assert_eq!(frames.len(), 10);

    let animated = fs::read(file("film.png")).expect("a file");
    let decoder = PngDecoder::new(Cursor::new(&animated)).expect("a PNG").apng().expect("an animated one");
    let found = decoder.into_frames().collect_frames().expect("frames");
    assert_eq!(found.len(), 10);
    for (found, frame) in found.iter().zip(&frames) {
        assert!(found.buffer() == frame);
        assert_eq!(found.delay().numer_denom_ms(), (80, 1));
    }

    let moving = fs::read(file("film.gif")).expect("a file");
    let mut decoder = gif::DecodeOptions::new().read_info(&moving[..]).expect("a GIF");
    let mut hundredths = 0;
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        hundredths += u32::from(frame.delay);
    }
    assert_eq!(hundredths, 80);

    if cfg!(feature = "mp4") {
        let video = fs::read(file("film.mp4")).expect("a file");
        assert_eq!(&video[4..8], b"ftyp");
    }
    for name in ["film.png", "film.gif"] {
        let (first, again) = (fs::read(folder.path().join(name)).expect("a file"), fs::read(file(name)));
        assert!(first == again.expect("a file"), "{name}: two runs, the same bytes");
    }
}

#[test]
fn clips_of_a_pack_are_shown_recorded_and_listed() {
    let pack = copy_of_golden_pack();
    let text = "[[clip]]\nname = \"nod\"\nwrap = \"loop\"\n[clip.tracks]\n\"head.bow\" = [{ t = 0, v = 0 }, { t = 0.25, v = 10 }, { t = 0.5, v = 0 }]\n";
    fs::write(pack.path().join("clips.toml"), text).expect("written");
    let info = json(&finish(viewer().arg("info").arg(pack.path()).arg("--json")).ok());
    assert_eq!((&info["clips"][0]["name"], info["clips"][0]["seconds"].as_f64()), (&"nod".into(), Some(0.5)));
    let bones = |options: &[&str]| finish(viewer().arg("bones").arg(pack.path()).args(options)).ok();
    assert_eq!(bones(&["--clip", "nod", "--time", "0.125"]), bones(&["--set", "head.bow=5"]));
    if has_adapter() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("frames");
        record(pack.path(), &["--clip", "nod", "--fps", "8"], &out);
        let files = pictures(&out);
        assert_eq!(files.len(), 4, "the frame at 0.5 s is the first one again");
        for (file, bow) in files.iter().zip([0, 5, 10, 5]) {
            let frame = image::open(file).expect("a PNG").into_rgba8();
            assert!(frame == render(pack.path(), &["--set".into(), format!("head.bow={bow}")]), "{bow}");
        }
    }
    fs::write(pack.path().join("clips.toml"), text.replace("head.bow", "head.bwo")).expect("written");
    finish(viewer().arg("info").arg(pack.path())).fails(1, &["clips.toml: line 5", "head.bwo", "head.bow"]);
}

/// The state in a picture's text.
fn state(path: &Path) -> String {
    let reader = png::Decoder::new(Cursor::new(fs::read(path).expect("a file"))).read_info().expect("a PNG");
    let text = reader.info().utf8_text.iter().find(|text| text.keyword == "Mimik").expect("the text");
    text.get_text().expect("text")
}

#[test]
fn pictures_say_how_to_draw_them_again() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("face.png");
    let draw = |options: &[String]| {
        finish(viewer().arg("render").arg(golden_pack()).args(options).args(SIZE).arg("--out").arg(&out))
            .ok();
        (image::open(&out).expect("a PNG").into_rgba8(), state(&out))
    };
    let cases: [(&[&str], &str); 4] = [
        (&[], ""),
        (&["--set", "jaw.open=3", "--set", "smile=0"], "jaw.open=3"),
        (&["--pose", "smile:0.5 wink-left", "--set", "smile=0.125"], "pose=smile:0.5 wink-left; smile=0.125"),
        (
            &["--set", "head.turn=7", "--rotate", "JawJoint=z:-12,y:5"],
            "head.turn=7; rotate=JawJoint=z:-12,y:5",
        ),
    ];
    for (options, expected) in cases {
        let options: Vec<_> = options.iter().map(|option| (*option).to_owned()).collect();
        let (picture, state) = draw(&options);
        assert_eq!(state, expected);
        let options = state.split("; ").filter(|entry| !entry.is_empty()).flat_map(|entry| {
            match ["pose", "clip", "time", "rotate"]
                .iter()
                .find(|name| entry.starts_with(&format!("{name}=")))
            {
                Some(name) => [format!("--{name}"), entry[name.len() + 1..].to_owned()],
                None => ["--set".to_owned(), entry.to_owned()],
            }
        });
        let (again, same) = draw(&options.collect::<Vec<_>>());
        assert!(picture == again && state == same, "{expected}");
    }
}

#[test]
fn wrong_usage() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("film.gif");
    let out = out.to_str().expect("a plain name");
    let usage = |arguments: &[&str], part: &str| {
        let run = run(&[&["record"], arguments].concat());
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains("error:") && run.stderr.contains(part), "{arguments:?}: {}", run.stderr);
    };
    usage(&["--script", "0 smile"], "--out");
    usage(&["--out", out], "--script");
    usage(&["--out", out, "--script", "0 smile", "--clip", "Wave"], "--clip");
    usage(&["--out", out, "--script", "smile"], "SECONDS POSE");
    usage(&["--out", out, "--script", "0 nosuch"], "nosuch");
    usage(&["--out", out, "--clip", "nosuch"], "there are: none");
    for fps in ["0", "-1", "nan", "241", "1/0"] {
        usage(&["--out", out, "--script", "0 smile", "--fps", fps], "frames per second from 0.01 to 240");
    }
    usage(
        &["--out", out, "--script", "0 smile", "--fps", "60"],
        "GIF: expected at most 50 frames per second",
    );
    usage(&["--out", out, "--script", "0 smile", "--duration", "0"], "--duration");
    usage(&["--out", out, "--script", "0 smile", "--duration", "1e9"], "at most 1000000 frames");
    usage(&["--out", out, "--script", "0 smile", "--frame", "beard"], "beard");
    usage(&["--out", "film.avi", "--script", "0 smile"], ".gif, .png, .apng");
    if cfg!(feature = "mp4") {
        usage(&["--out", "film.mp4", "--script", "0 smile", "--size", "4000x3000"], "3840x2160");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "a file was left behind");
}

#[test]
fn failures_leave_nothing_behind() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let full = folder.path().join("full");
    fs::create_dir(&full).expect("made");
    fs::write(full.join("precious.txt"), "old").expect("written");
    let record = |out: &Path| {
        let mut command = viewer();
        command.args(["record", "--script", "0 smile", "--duration", "0.1", "--out"]).arg(out).args(SIZE);
        command
    };
    finish(&mut record(&full)).fails(1, &["full", "expected a new or an empty folder, found one with files"]);
    let file = full.join("precious.txt");
    fs::rename(&file, full.join("precious")).expect("renamed");
    finish(&mut record(&full.join("precious"))).fails(1, &["a new or an empty folder, found a file"]);
    finish(&mut record(&folder.path().join("no/film.gif")))
        .fails(1, &["no", "expected a folder to write to"]);
    finish(&mut record(&folder.path().join("no/frames"))).fails(1, &["no", "expected a folder to write to"]);
    for out in ["film.gif", "frames"] {
        let mut command = record(&folder.path().join(out));
        command.env("VK_DRIVER_FILES", "/nonexistent.json").env("VK_ICD_FILENAMES", "/nonexistent.json");
        finish(&mut command).fails(1, &["adapter"]);
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    assert_eq!(fs::read(full.join("precious")).expect("still there"), b"old");
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_nothing_behind() {
    if !has_adapter() {
        return;
    }
    for out in ["film.gif", "frames"] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut command = viewer();
        command
            .arg("record")
            .arg(golden_pack())
            .args(["--script", "0 smile", "--duration", "600"])
            .args(SIZE);
        command.arg("--out").arg(folder.path().join(out)).stderr(std::process::Stdio::piped());
        let mut child = command.spawn().expect("the program starts");
        let is_empty = || fs::read_dir(folder.path()).expect("a folder").next().is_none();
        while is_empty() {
            assert!(child.try_wait().expect("a state").is_none(), "it has ended");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(kill.expect("kill").success());
        let output = child.wait_with_output().expect("an end");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        assert!(stderr.contains("error: interrupted after"), "{stderr}");
        assert!(is_empty(), "a file was left behind");
    }
}

#[test]
fn an_empty_folder_is_filled_and_an_old_film_replaced() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (frames, film) = (folder.path().join("frames"), folder.path().join("film.gif"));
    fs::create_dir(&frames).expect("made");
    fs::write(&film, "old").expect("written");
    for out in [&frames, &film] {
        record(&golden_pack(), &["--script", "0 smile", "--duration", "0.1"], out);
    }
    assert_eq!(pictures(&frames).len(), 3);
    assert!(fs::read(&film).expect("a film").starts_with(b"GIF89a"));
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2);
}

#[test]
fn a_face_trackers_recording_is_a_clip() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("talk.csv");
    let header = "FrameNumber,SubFrame,Numerator,Denominator,Smile,HeadYaw,TongueOut,JawOpen";
    fs::write(&file, format!("{header}\n7,0,16,1,0,0,1,1\n9,0,16,1,0.5,0.5,1,1\n")).expect("written");
    let pack = golden_pack();
    let joints = |options: &[&str]| {
        let run = finish(viewer().arg("bones").arg(&pack).args(options));
        (json(&run.stdout)["joints"].clone(), run.stderr)
    };
    let name = file.to_str().expect("a name in UTF-8");
    // Half way between both rows: a quarter of a radian.
    let (half, told) = joints(&["--clip", name, "--time", "0.0625"]);
    assert!(told.contains("no control for 1 of the columns: TongueOut\n"), "{told}");
    let turn = format!("head.turn={}", 0.25 * 180.0 / std::f64::consts::PI);
    // There is no shape JawOpen, but a jaw that opens.
    assert_eq!(half, joints(&["--set", &turn, "--set", "jaw.open=20"]).0);
    // What the tracker says of the face at rest is beside the recording.
    fs::write(folder.path().join("face.toml"), "[neutral]\nheadYaw = 0.5\njawOpen = 1\n").expect("written");
    assert_eq!(joints(&["--clip", name, "--time", "0.125"]).0, joints(&[]).0);
    fs::write(folder.path().join("face.toml"), "[neutral]\nheadYawn = 0.25\n").expect("written");
    let wrong = "face.toml: line 2, column 1: neutral.headYawn: expected one of the names";
    finish(viewer().arg("bones").arg(&pack).args(["--clip", name])).fails(1, &[wrong]);
    fs::remove_file(folder.path().join("face.toml")).expect("removed");
    assert_ne!(half, joints(&[]).0);
    fs::write(&file, format!("{header}\n7,0,30,1,wide,0,1,1\n")).expect("written");
    let place = "talk.csv: line 2: expected a number as Smile, found \"wide\"";
    finish(viewer().arg("bones").arg(&pack).args(["--clip", name])).fails(1, &[place]);
    let missing = "none.csv: expected a recording of a face, found nothing of that name";
    finish(viewer().arg("bones").arg(&pack).args(["--clip", "none.csv"])).fails(1, &[missing]);
}
