//! What `--out` takes: formats by their ends, standard output, and what is refused before anything is drawn.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{self, Run, finish, finish_bytes, golden_pack, has_adapter, json, viewer};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use std::fs;
use std::io::{Cursor, Read};
use std::path::Path;
use std::process::{Command, Stdio};

const SMALL: [&str; 4] = ["--size", "96x72", "--quality", "plain"];
const PICTURES: &str =
    "expected a name that ends in .png, .jpg, .jpeg or .webp, or - for standard output, found";

fn render() -> Command {
    let mut command = viewer();
    command.arg("render").arg(golden_pack()).args(SMALL);
    command
}

/// A picture, its format and its EXIF.
fn decoded(bytes: &[u8]) -> (DynamicImage, ImageFormat, Vec<u8>) {
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().expect("bytes");
    let format = reader.format().expect("a known format");
    let mut decoder = reader.into_decoder().expect("a picture");
    let exif = decoder.exif_metadata().expect("readable").unwrap_or_default();
    (DynamicImage::from_decoder(decoder).expect("a picture"), format, exif)
}

/// The texts of a TIFF's directory (TIFF 6.0, section 2), by their tags.
fn texts(tiff: &[u8]) -> Vec<(u16, String)> {
    let short = |at: usize| u16::from_le_bytes([tiff[at], tiff[at + 1]]);
    let long = |at: usize| u32::from_le_bytes([tiff[at], tiff[at + 1], tiff[at + 2], tiff[at + 3]]) as usize;
    assert_eq!((&tiff[..2], short(2)), (&b"II"[..], 42));
    let directory = long(4);
    let entries = (0..usize::from(short(directory))).map(|entry| directory + 2 + 12 * entry);
    let text = |entry: usize| {
        assert_eq!(short(entry + 2), 2, "ASCII");
        let (at, length) = (long(entry + 8), long(entry + 4));
        assert_eq!(tiff[at + length - 1], 0, "texts end in a zero");
        (short(entry), String::from_utf8(tiff[at..at + length - 1].to_vec()).expect("a text"))
    };
    entries.map(text).collect()
}

#[test]
fn the_end_of_a_name_says_the_format_of_a_picture() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let face = ["--pose", "smile", "--set", "jaw.open=3"];
    let draw = |name: &str| {
        let out = folder.path().join(name);
        finish(render().args(face).arg("--out").arg(&out)).ok();
        decoded(&fs::read(out).expect("a file"))
    };
    let (png, format, _) = draw("face.png");
    assert_eq!(format, ImageFormat::Png);
    let (webp, format, exif) = draw("face.WebP");
    assert_eq!(format, ImageFormat::WebP);
    assert!(webp.into_rgba8() == png.to_rgba8(), "WebP loses nothing");
    // 270 is the description, 305 the program.
    let said = vec![
        (270, "Mimik: pose=smile; jaw.open=3".to_owned()),
        (305, format!("Mimik {}", env!("CARGO_PKG_VERSION"))),
    ];
    assert_eq!(texts(&exif), said);
    for name in ["face.jpg", "face.JPEG"] {
        let (jpeg, format, exif) = draw(name);
        assert_eq!((format, texts(&exif)), (ImageFormat::Jpeg, said.clone()), "{name}");
        let (found, expected) = (jpeg.into_rgb8(), png.to_rgb8());
        assert_eq!(found.dimensions(), (96, 72), "{name}");
        let squares = found.iter().zip(expected.iter()).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
        let mean = squares.sum::<f64>() / f64::from(96 * 72 * 3);
        let decibels = 10.0 * (255.0 * 255.0 / mean).log10();
        assert!(decibels > 35.0, "{name}: {decibels} dB");
    }
    let sheet = folder.path().join("sheet.jpg");
    let mut command = viewer();
    command.arg("sheet").arg(golden_pack()).args(["--quality", "plain", "--out"]).arg(&sheet);
    finish(&mut command).ok();
    assert_eq!(decoded(&fs::read(sheet).expect("a file")).1, ImageFormat::Jpeg);
}

#[test]
fn any_other_end_is_an_error_before_anything_is_read() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let fails = |verb: &[&str], name: &str, parts: &[&str]| {
        // A pack that does not exist is not missed.
        let mut command = viewer();
        command.arg(verb[0]).arg("no-such-pack").args(&verb[1..]).arg("--out").arg(folder.path().join(name));
        finish(&mut command).fails(2, &[parts, &[name]].concat());
    };
    for name in ["face.bmp", "face", "face.pngx", "face.gif"] {
        fails(&["render"], name, &[PICTURES]);
        fails(&["sheet"], name, &[PICTURES]);
    }
    let mp4 = if cfg!(feature = "mp4") { ", .apng or .mp4, or" } else { " or .apng, or" };
    let films = format!("ends in .gif, .png{mp4} that of a folder of pictures (without an end), or - for");
    fails(&["record", "--script", "0 smile"], "film.avi", &[&films]);
    fails(&["record", "--script", "0 smile"], "film.jpg", &[&films]);
    fails(&["deform"], "skin.ply", &["ends in .obj, or - for standard output"]);
    fails(&["strands"], "strands.txt", &["ends in .json, or - for standard output"]);
    fails(&["bones"], "bones.csv", &["ends in .json, or - for standard output"]);
    fails(&["trace", "--script", "0 smile"], "motion.json", &["ends in .csv, or - for standard output"]);
    fails(&["convert"], "face.fbx", &["ends in .glb or .obj, or (with a separator at its end)"]);
    // What is said twice has to agree.
    fails(
        &["render", "--format", "png"],
        "face.jpg",
        &["--format png: expected the format that the name ends in"],
    );
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "a file was left behind");
}

#[test]
fn a_transparent_background_needs_a_format_that_keeps_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let with = |verb: &[&str], name: &str| {
        let mut command = viewer();
        command.arg(verb[0]).arg(golden_pack()).args(&verb[1..]).args(SMALL);
        finish(command.args(["--background", "transparent", "--out"]).arg(folder.path().join(name)))
    };
    with(&["render"], "face.jpg").fails(2, &["--background transparent", "(.png or .webp), found JPEG"]);
    with(&["render"], "face.jpeg").fails(2, &["(.png or .webp), found JPEG"]);
    let record = ["record", "--script", "0 smile", "--duration", "0.1"];
    if cfg!(feature = "mp4") {
        let others = "(.gif, .png or .apng, or a folder of pictures), found MP4";
        with(&record, "film.mp4").fails(2, &["--background transparent", others]);
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "a file was left behind");
    if !has_adapter() {
        return;
    }
    with(&["render"], "face.webp").ok();
    let picture = decoded(&fs::read(folder.path().join("face.webp")).expect("a file")).0.into_rgba8();
    assert_eq!((picture.get_pixel(0, 0).0[3], picture.get_pixel(48, 36).0[3]), (0, 255));
    with(&record, "film.gif").ok();
}

#[test]
fn standard_output_takes_everything() {
    let golden = golden_pack();
    let golden = golden.to_str().expect("a plain path");
    let folder = tempfile::tempdir().expect("a temporary folder");
    // What arrives is what a file would hold, and nothing else is written to it.
    let same = |verb: &[&str], asked: &[&str], name: &str| {
        let file = folder.path().join(name);
        finish(viewer().args(verb).arg("--out").arg(&file)).ok();
        let (bytes, run) = finish_bytes(viewer().args(verb).args(["--out", "-"]).args(asked));
        run.ok();
        assert!(bytes == fs::read(&file).expect("a file"), "{verb:?} {asked:?}");
    };
    same(&["deform", golden], &[], "skin.obj");
    same(&["bones", golden], &[], "bones.json");
    same(&["trace", golden, "--script", "0 smile"], &[], "motion.csv");
    same(&["convert", golden], &[], "face.glb");
    same(&["convert", golden], &["--format", "glb"], "face.glb");
    same(&["convert", golden], &["--format", "obj"], "face.obj");
    let (glb, run) = finish_bytes(viewer().args(["convert", golden, "-"]));
    run.ok();
    assert!(glb.starts_with(b"glTF"), "also as a second name");
    assert_eq!(
        finish(viewer().args(["bones", golden])).ok(),
        finish(viewer().args(["bones", golden, "--out", "-"])).ok()
    );
    if !has_adapter() {
        return;
    }
    let render = [&["render", golden][..], &SMALL].concat();
    same(&render, &[], "face.png");
    same(&render, &["--format", "jpeg"], "face.jpg");
    same(&render, &["--format", "webp"], "face.webp");
    same(&["sheet", golden, "--quality", "plain"], &["--format", "png"], "sheet.png");
    let record = [&["record", golden, "--script", "0 smile", "--duration", "0.1"][..], &SMALL].concat();
    same(&record, &[], "film.gif");
    same(&record, &["--format", "png"], "film.png");
    if cfg!(feature = "mp4") {
        same(&record, &["--format", "mp4"], "film.mp4");
    }
    let strands = finish(viewer().args(["strands", golden, "--out", "-"])).ok();
    assert!(json(&strands)["strands"].is_array());
    finish(viewer().args(render).args(["--out", "-", "--format", "jgp"]))
        .fails(2, &["--format: expected one of png, jpg, jpeg, webp, found \"jgp\" (did you mean \"jpg\"?)"]);
    finish(viewer().args(record).args(["--out", "-", "--format", "avi"]))
        .fails(2, &["--format: expected one of gif"]);
}

/// Standard output is what a device is opened as.
#[cfg(target_os = "linux")]
fn to_device(device: &str, command: &mut Command) -> Run {
    let out = fs::OpenOptions::new().read(true).write(true).open(device).expect("a device");
    let output = command.stdout(out).stderr(Stdio::piped()).spawn().expect("started").wait_with_output();
    let output = output.expect("an end");
    let stderr = String::from_utf8(output.stderr).expect("text");
    assert!(!stderr.contains("panicked"), "{stderr}");
    Run { status: output.status.code().expect("no signal"), stdout: String::new(), stderr }
}

#[cfg(target_os = "linux")]
#[test]
fn nothing_but_text_goes_to_a_terminal() {
    let golden = golden_pack();
    let golden = golden.to_str().expect("a plain path");
    // The side of a terminal that a program which shows one holds: it is a terminal, too.
    let terminal = "/dev/ptmx";
    let film = ["record", golden, "--script", "0 smile"];
    for (what, verb) in [
        ("a picture", &["render", golden][..]),
        ("a picture", &["sheet", golden]),
        ("a film", &film),
        ("GLB", &["convert", golden]),
    ] {
        let refused = format!("--out -: expected a file or a pipe for {what}, found a terminal");
        to_device(terminal, viewer().args(verb).args(["--out", "-"])).fails(2, &[&refused]);
    }
    let refused = "--out /dev/ptmx: expected a file or a pipe for a picture, found a terminal";
    finish(viewer().args(["render", golden, "--out", terminal])).fails(2, &[refused]);
    for verb in [&["deform", golden, "--out", "-"][..], &["convert", golden, "-", "--format", "obj"]] {
        // Nobody takes what is written there, so a little has to do.
        let run = to_device("/dev/null", viewer().args(verb));
        assert_eq!(run.status, 0, "{}", run.stderr);
    }
    assert_eq!(
        to_device(terminal, viewer().args(["trace", "--script", "", "--hz", "1", "--duration", "1"])).status,
        0
    );
}

#[cfg(target_os = "linux")]
#[test]
fn an_output_that_fails_is_one_clear_error() {
    let golden = golden_pack();
    let golden = golden.to_str().expect("a plain path");
    let full = "standard output: No space left on device";
    for verb in [
        &["bones", golden][..],
        &["info", golden],
        &["convert", golden, "-"],
        &["deform", golden, "--out", "-"],
    ] {
        to_device("/dev/full", viewer().args(verb)).fails(1, &[full]);
    }
    finish(viewer().args(["deform", golden, "--out", "/dev/full"]))
        .fails(1, &["/dev/full: expected a file that can be written"]);
    // Warnings that nobody can read stop nothing.
    let errors = fs::OpenOptions::new().write(true).open("/dev/full").expect("a device");
    let output =
        viewer().args(["bones", golden, "--set", "head.turn=500"]).stderr(errors).output().expect("an end");
    assert_eq!(output.status.code(), Some(0));
    if !has_adapter() {
        return;
    }
    let film = [&["record", golden, "--script", "0 smile", "--duration", "0.1"][..], &SMALL].concat();
    for verb in [&[&["render", golden][..], &SMALL].concat(), &film] {
        to_device("/dev/full", viewer().args(verb).args(["--out", "-"])).fails(1, &[full]);
    }
}

/// The reader takes a few bytes and goes away.
fn with_a_reader_that_goes_away(command: &mut Command) -> Run {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    let mut out = child.stdout.take().expect("piped");
    let mut first = [0; 4];
    out.read_exact(&mut first).expect("the beginning");
    drop(out);
    let output = child.wait_with_output().expect("an end");
    let stderr = String::from_utf8(output.stderr).expect("text");
    assert!(!stderr.contains("panicked"), "{stderr}");
    Run { status: output.status.code().expect("no signal"), stdout: String::new(), stderr }
}

#[test]
fn a_pipe_that_breaks_is_an_error_for_what_is_of_use_only_as_a_whole() {
    let broken =
        "error: standard output: expected a reader that takes all of it, found a pipe that was closed";
    // Much more than a pipe holds.
    with_a_reader_that_goes_away(viewer().args(["convert", "--out", "-"])).fails(1, &[broken]);
    // Lines are of use by themselves.
    let script = ["trace", "--script", "0 smile", "--duration", "100"];
    for verb in [&["deform", "--out", "-"][..], &script, &["convert", "--out", "-", "--format", "obj"]] {
        assert_eq!(with_a_reader_that_goes_away(viewer().args(verb)).ok(), "", "{verb:?}");
    }
    if !has_adapter() {
        return;
    }
    let large = ["--size", "640x480", "--out", "-"];
    with_a_reader_that_goes_away(viewer().arg("render").args(large)).fails(1, &[broken]);
    let record = ["record", "--script", "0 yawn", "--duration", "0.2", "--format", "png"];
    with_a_reader_that_goes_away(viewer().args(record).args(large)).fails(1, &[broken]);
}

#[test]
fn a_file_takes_its_place_only_when_it_is_whole() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let names =
        || fs::read_dir(folder.path()).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    let old = folder.path().join("motion.csv");
    fs::write(&old, "old").expect("written");
    // Ten million rows take minutes.
    let mut child = viewer()
        .args(["trace", "--script", "0 smile", "--hz", "100000", "--duration", "90", "--out"])
        .arg(&old)
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    while names().count() < 2 {
        assert!(child.try_wait().expect("a state").is_none(), "it has ended");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    #[cfg(unix)]
    {
        let kill = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
        assert!(kill.expect("kill").success());
        let output = child.wait_with_output().expect("an end");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        assert!(stderr.contains("error: interrupted: what was not finished was removed"), "{stderr}");
        assert_eq!(names().collect::<Vec<_>>(), ["motion.csv"]);
    }
    #[cfg(not(unix))]
    child.kill().expect("ended");
    assert_eq!(fs::read(&old).expect("still there"), b"old");
}

/// Packs with so many poses that a sheet takes a while.
fn many_poses() -> tempfile::TempDir {
    let pack = common::copy_of_golden_pack();
    let poses: String =
        (0..120).map(|pose| format!("[[pose]]\nname = \"pose {pose}\"\n[pose.controls]\n")).collect();
    fs::write(pack.path().join("poses.toml"), poses).expect("written");
    pack
}

#[cfg(target_os = "linux")]
#[test]
fn a_sheet_tells_how_far_it_is() {
    if !has_adapter() {
        return;
    }
    let (pack, folder) = (many_poses(), tempfile::tempdir().expect("a temporary folder"));
    let (sheet, seen) = (folder.path().join("sheet.png"), folder.path().join("seen"));
    // `script` (Debian: bsdutils) runs a program on a terminal, and keeps what is seen there.
    let line = format!(
        "'{}' sheet '{}' --out '{}'",
        env!("CARGO_BIN_EXE_avatar-viewer"),
        pack.path().display(),
        sheet.display()
    );
    let mut terminal = Command::new("script");
    terminal.args(["--quiet", "--return", "--command", &line]).arg(&seen);
    let output =
        terminal.stdin(Stdio::null()).output().expect("the program `script` of bsdutils or util-linux");
    assert!(output.status.success(), "{output:?}");
    let seen = fs::read_to_string(&seen).expect("what was seen");
    assert!(seen.contains(" of 120, 0:"), "{seen}");
    assert!(seen.contains("░ pose "), "{seen}");
    assert_eq!(image::image_dimensions(&sheet).expect("a picture").0, 12 + 4 * (480 + 12));
}

#[test]
fn a_sheet_that_a_format_cannot_hold_is_refused_before_it_is_drawn() {
    let (pack, folder) = (many_poses(), tempfile::tempdir().expect("a temporary folder"));
    let poses: String =
        (0..200).map(|pose| format!("[[pose]]\nname = \"pose {pose}\"\n[pose.controls]\n")).collect();
    fs::write(pack.path().join("poses.toml"), poses).expect("written");
    let mut command = viewer();
    command.arg("sheet").arg(pack.path()).arg("--out").arg(folder.path().join("sheet.webp"));
    command.env("VK_DRIVER_FILES", "/nonexistent.json").env("VK_ICD_FILENAMES", "/nonexistent.json");
    finish(&mut command)
        .fails(2, &["WebP: expected a picture of at most 16384 pixels a side, found 1980x17312", ".png"]);
    assert!(Path::new(folder.path()).read_dir().expect("a folder").next().is_none());
}
