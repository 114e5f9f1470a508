//! What one waits for a picture of the built-in avatar: the program from its start to the file, for `render`
//! and `sheet`, and the stages of `render` one after the other in this process. The program does two of them
//! at a time where there are two processors, and has less to do in a stage that this process has been through
//! before.
//!
//! `cargo bench -p avatar-viewer --bench start [-- ROUNDS]`
#![allow(clippy::expect_used, reason = "a benchmark stops at the first surprise")]

use avatar_pack::{FaceState, Pack, Texture, Textures};
use avatar_render::headless::{Canvas, GpuOptions, open_blocking};
use avatar_render::{AvatarState, Quality, Style};
use avatar_stage::{BACKGROUND, DefaultFace, NamedView, SAMPLES, View, upload_with_hair};
use std::process::Command;
use std::time::Instant;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;

fn main() {
    let rounds = std::env::args().filter_map(|arg| arg.parse().ok()).next().unwrap_or(5usize);
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("picture.png");
    println!("{:<34}{:>9}{:>9}", "ms", "median", "least");
    for verb in ["render", "sheet"] {
        let times = (0..rounds).map(|_| {
            let start = Instant::now();
            let mut program = Command::new(env!("CARGO_BIN_EXE_avatar-viewer"));
            let status = program.arg(verb).arg("--out").arg(&out).status();
            assert!(status.expect("the program").success());
            start.elapsed().as_secs_f64() * 1e3
        });
        tell(verb, times.collect());
    }
    println!();
    let mut stages: Vec<(&str, Vec<f64>)> = Vec::new();
    for _ in 0..rounds {
        for (place, (stage, time)) in render().into_iter().enumerate() {
            match stages.get_mut(place) {
                Some((_, times)) => times.push(time),
                None => stages.push((stage, vec![time])),
            }
        }
    }
    stages.into_iter().for_each(|(stage, times)| tell(stage, times));
}

fn tell(what: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    let at = |place: usize| times.get(place).copied().unwrap_or_default();
    println!("{what:<34}{:>9.1}{:>9.1}", at(times.len() / 2), at(0));
}

/// The stages of one picture, and how many milliseconds each took.
fn render() -> Vec<(&'static str, f64)> {
    let mut stages = Vec::new();
    let mut last = Instant::now();
    let mut done = |stage| {
        stages.push((stage, last.elapsed().as_secs_f64() * 1e3));
        last = Instant::now();
    };
    let pack = Pack::load(&DefaultFace).expect("the built-in avatar");
    done("  pack");
    let textures = Textures::load_by(&DefaultFace, &Texture::DRAWN, |_, _| {});
    done("  textures, on one thread");
    let gpu = open_blocking(GpuOptions::default()).expect("an adapter");
    done("  device");
    let shading = Quality::of_adapter(&gpu.info).shading(Style::Natural);
    let canvas = Canvas::new(&gpu, WIDTH, HEIGHT, SAMPLES, shading).expect("a canvas");
    done("  pipelines and targets");
    let model = upload_with_hair(&gpu.device, &gpu.queue, &pack, &textures, None).expect("a model");
    done("  mip levels, upload");
    let mut avatar = AvatarState::new(&gpu.device, &model);
    let mut state = FaceState::new(&pack);
    state.pose(&pack, &pack.controls().defaults()).expect("a pose");
    avatar.set(&gpu.queue, state.bones(), state.weights()).expect("lengths that fit");
    let view: View = NamedView::Front.view();
    let scene = view.scene(&pack, WIDTH as f32 / HEIGHT as f32, BACKGROUND, avatar_render::Light::default());
    let picture = canvas.render(&gpu, &scene, &[(&model, &avatar)]).expect("a picture");
    done("  the first frame, read back");
    canvas.render(&gpu, &scene, &[(&model, &avatar)]).expect("a picture");
    done("  (another frame, read back)");
    avatar_film::png(picture.width, picture.height, &picture.rgba, &[]).expect("a PNG");
    done("  PNG");
    stages
}
