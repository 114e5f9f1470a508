//! The example and the README's program show a face in a window, driven by real keys on a virtual display.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "it starts programs and writes a project"
)]

mod common;
#[path = "common/desk.rs"]
mod desk;

use avatar_stage::avatar_render::AvatarState;
use avatar_stage::avatar_render::headless::render_image;
use avatar_stage::{Performer, SAMPLES, portrait, upload};
use common::{gpu, pack, textures};
use desk::{Desk, can_run};
use std::path::Path;
use std::process::Command;

const SIZE: [u32; 2] = [320, 240];

/// The default face with a pose, as it is to be in a window of [`SIZE`].
fn picture_of(pose: &str) -> Option<Vec<u8>> {
    let gpu = gpu()?;
    let model = upload(&gpu.device, &gpu.queue, pack(), textures()).unwrap();
    let mut avatar = AvatarState::new(&gpu.device, &model);
    let mut face = Performer::new(pack().clone());
    face.press(pose).unwrap();
    face.advance(f64::INFINITY).unwrap();
    avatar.set(&gpu.queue, face.bones(), face.weights()).unwrap();
    let [width, height] = SIZE;
    let scene = portrait(face.pack(), width as f32 / height as f32);
    Some(render_image(&gpu, width, height, SAMPLES, &scene, &[(&model, &avatar)]).unwrap().rgba)
}

/// Whether two pictures show the same, but for the rounding of another format's encoding.
fn is_same(a: &[u8], b: &[u8]) -> bool {
    let colors = |pixels: &[u8]| pixels.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect::<Vec<_>>();
    a.len() == b.len() && colors(a).iter().zip(colors(b)).all(|(a, b)| a.abs_diff(b) <= 2)
}

fn target_folder() -> std::path::PathBuf {
    // …/target/<profile>/deps/<test>
    std::env::current_exe().unwrap().ancestors().nth(3).unwrap().to_owned()
}

#[test]
fn digit_keys_press_poses_in_the_example() {
    if !can_run() {
        return;
    }
    let Some(at_rest) = picture_of("neutral") else { return };
    let example = std::env::current_exe().unwrap().ancestors().nth(2).unwrap().join("examples/window");
    assert!(example.exists(), "{} is built by `cargo test -p avatar-stage`", example.display());
    let desk = Desk::open(&mut Command::new(example), SIZE);
    desk.rests(|picture| is_same(picture, &at_rest));
    for pose in ["smile", "surprise"] {
        let key = pack().poses().get(pose).unwrap().key.clone().unwrap();
        assert!(key.parse::<u8>().is_ok_and(|digit| digit < 10), "{pose} has a digit: {key}");
        let expected = picture_of(pose).unwrap();
        assert!(!is_same(&expected, &at_rest));
        desk.key(&key);
        desk.rests(|picture| is_same(picture, &expected));
    }
}

/// The window's program in the README, in a project outside of the workspace, with only the lines that stand
/// there.
#[test]
fn twenty_two_lines_outside_the_workspace_show_the_default_face() {
    if !can_run() {
        return;
    }
    let Some(smile) = picture_of("smile") else { return };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap();
    let readme = std::fs::read_to_string(root.join("crates/avatar-stage/README.md")).unwrap();
    let block = |fence: &str| {
        let start = readme.split(&format!("```{fence}\n")).nth(1).expect("a block");
        start.split("```").next().unwrap().to_owned()
    };
    let (manifest, program) = (block("toml"), block("rust window"));
    let body = program.lines().filter(|line| !line.is_empty() && !line.starts_with("use "));
    assert!(body.count() <= 22, "it stays short");
    let scratch = tempfile::tempdir().unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(&root, scratch.path().join("mimik")).unwrap();
    let project = scratch.path().join("a-window");
    std::fs::create_dir_all(project.join("src")).unwrap();
    let package = "[package]\nname = \"a-window\"\nedition = \"2024\"\n\n";
    std::fs::write(project.join("Cargo.toml"), format!("{package}{manifest}\n[workspace]\n")).unwrap();
    std::fs::write(project.join("src/main.rs"), program).unwrap();
    std::fs::copy(root.join("Cargo.lock"), project.join("Cargo.lock")).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--offline"]).current_dir(&project);
    // The workspace's own profile and folder, so that dependencies are not built a second time.
    cargo.env("CARGO_TARGET_DIR", target_folder());
    for (setting, own) in [("OPT_LEVEL", "1"), ("DEBUG", "line-tables-only")] {
        let setting = format!("CARGO_PROFILE_DEV_{setting}");
        if std::env::var_os(&setting).is_none() {
            cargo.env(setting, own);
        }
    }
    let built = cargo.output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let desk = Desk::open(&mut Command::new(target_folder().join("debug/a-window")), SIZE);
    desk.rests(|picture| is_same(picture, &smile));
}
