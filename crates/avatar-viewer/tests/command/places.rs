//! Places to write to that are no ordinary files, or have no room.
#![cfg(unix)]
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{copy_of_golden_pack, finish, golden_pack, has_adapter, viewer};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

fn entries(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> =
        names.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_pipe_with_a_name_gets_what_the_name_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let golden = golden_pack();
    let golden = golden.to_str().expect("a plain path");
    let film = ["record", golden, "--script", "0 smile", "--duration", "0.1", "--size", "32x32", "--out"];
    let picture = ["render", golden, "--size", "32x32", "--out"];
    let convert = ["convert", golden, "--out"];
    for (name, verb, begins, draws) in [
        ("mesh.obj", &convert[..], &b"#"[..], false),
        ("mesh.glb", &convert, b"glTF", false),
        ("mesh", &convert, b"glTF", false),
        ("face.jpg", &picture, &[0xff, 0xd8], true),
        ("face.WEBP", &picture, b"RIFF", true),
        ("face", &picture, b"\x89PNG", true),
        ("film.png", &film, b"\x89PNG", true),
        ("film", &film, b"GIF8", true),
    ] {
        if draws && !has_adapter() {
            continue;
        }
        let pipe = folder.path().join(name);
        assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo starts").success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read(pipe).expect("what comes out")
        });
        finish(viewer().args(verb).arg(&pipe)).ok();
        let found = reader.join().expect("read");
        let first = found.iter().take(4).map(|byte| char::from(*byte)).collect::<String>();
        // The first line of an OBJ is a comment or a vertex's.
        let is_it = found.starts_with(begins) || (name == "mesh.obj" && found.starts_with(b"o "));
        assert!(is_it, "{name}: {first:?}");
    }
    let pipe = folder.path().join("face.jpg");
    finish(viewer().args(["render", "--format", "png", "--out"]).arg(&pipe))
        .fails(2, &["--format png: expected the format that the name ends in"]);
}

#[test]
fn links_in_a_circle_and_files_for_folders_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    symlink("circle.json", at("circle.json")).expect("a link");
    symlink("b.json", at("a.json")).expect("a link");
    symlink("a.json", at("b.json")).expect("a link");
    fs::write(at("file"), "old").expect("written");
    let before = entries(folder.path());
    let bones = |name: &str| finish(viewer().arg("bones").arg(golden_pack()).arg("--out").arg(at(name)));
    bones("circle.json")
        .fails(1, &["circle.json: expected the name of a file to write, found links in a circle"]);
    bones("a.json").fails(1, &["a.json: expected the name of a file to write, found links in a circle"]);
    bones("file/bones.json").fails(1, &["file: expected a folder to write to, found a file"]);
    bones("none/bones.json").fails(1, &["none: expected a folder to write to, found none"]);
    finish(viewer().arg("convert").arg(golden_pack()).arg(at("file/pack/")))
        .fails(1, &["file: expected a folder to write to, found a file"]);
    assert_eq!(entries(folder.path()), before);
    assert_eq!(fs::read(at("file")).expect("still there"), b"old");
    // A link to a file that is yet to be made stays, and the file is made.
    symlink("new.json", at("link.json")).expect("a link");
    bones("link.json").ok();
    assert!(at("link.json").is_symlink() && at("new.json").is_file());
}

/// As on a disk with little room: the program can write two kilobytes into a file, and then no more.
fn without_room(arguments: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.args([
        "-c",
        "trap '' XFSZ; ulimit -f 4; exec \"$0\" \"$@\"",
        env!("CARGO_BIN_EXE_avatar-viewer"),
    ]);
    command.args(arguments).env("XDG_CONFIG_HOME", "/nonexistent");
    // Mesa keeps compiled programs in files of its own.
    command.env("MESA_SHADER_CACHE_DISABLE", "true");
    command
}

#[test]
fn what_finds_no_room_leaves_nothing_and_the_old_file() {
    let (pack, folder) = (copy_of_golden_pack(), tempfile::tempdir().expect("a folder"));
    let pack = pack.path().to_str().expect("a plain path");
    let film = ["record", pack, "--script", "0 smile", "--duration", "0.2", "--size", "64x64"];
    for (name, verb, draws) in [
        ("bones.json", &["bones", pack][..], false),
        ("mesh.obj", &["deform", pack], false),
        ("motion.csv", &["trace", pack, "--script", "0 smile"], false),
        ("avatar.glb", &["convert", pack], false),
        ("avatar/", &["convert", pack], false),
        ("face.png", &["render", pack, "--size", "200x200"], true),
        ("film.gif", &film, true),
        ("frames", &[&film[..7], &["200x200"]].concat(), true),
    ] {
        if draws && !has_adapter() {
            continue;
        }
        let out = folder.path().join(name);
        let is_file = name.contains('.');
        if is_file {
            fs::write(&out, "old").expect("written");
        }
        let told = if is_file {
            "expected a file that can be written"
        } else {
            "expected a folder that can be written"
        };
        let text = out.to_str().expect("a plain path");
        finish(without_room(verb).args(["--out", text])).fails(1, &[text.trim_end_matches('/'), told]);
        match is_file {
            true => assert_eq!(fs::read(&out).expect("still there"), b"old"),
            false => assert!(!out.exists(), "{name}"),
        }
    }
    assert!(entries(folder.path()).iter().all(|name| !name.starts_with('.')), "{:?}", entries(folder.path()));
}
