//! What shapes cost: frames of the built-in face, each with another turn of the head, with all its shapes at
//! weight 1 and with none, in turns, drawn and read back, at four samples, without hair; then the same for
//! deforming its skin on the CPU.
//!
//! `cargo bench -p avatar-render --bench shapes [-- ROUNDS [WIDTH HEIGHT]]`, 25 rounds of 1280×720 without
//!
//! Prints milliseconds, the median and the least, and the ratio of the least ones, which other work on the
//! machine disturbs less.
#![allow(clippy::expect_used, reason = "a benchmark stops at the first surprise")]
#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "it reads the avatar and the clock")]

use avatar_pack::{FaceState, Pack, Source, SourceError, Textures};
use avatar_render::headless::{Canvas, GpuOptions, open_blocking};
use avatar_render::{AvatarState, Light, Quality, Style};
use avatar_stage::{NamedView, upload_with_hair};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::time::Instant;

struct Folder(PathBuf);

impl Source for Folder {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(std::fs::read(self.0.join(name)).ok().map(Cow::Owned))
    }
}

/// Milliseconds with no shape and with all.
#[derive(Default)]
struct Times([Vec<f64>; 2]);

impl Times {
    fn measure(&mut self, which: usize, what: impl FnOnce()) {
        let start = Instant::now();
        what();
        self.0[which].push(start.elapsed().as_secs_f64() * 1e3);
    }

    fn print(mut self, what: &str) {
        let [none, all] = self.0.each_mut().map(|times| {
            times.sort_by(f64::total_cmp);
            (times[times.len() / 2], times[0])
        });
        println!(
            "{what}: none {:.3} ({:.3}), all {:.3} ({:.3}): {:.2} times as much",
            none.0,
            none.1,
            all.0,
            all.1,
            all.1 / none.1
        );
    }
}

fn main() {
    let mut numbers = std::env::args().filter_map(|arg| arg.parse().ok());
    let rounds = numbers.next().unwrap_or(25);
    let size = [numbers.next().unwrap_or(1280), numbers.next().unwrap_or(720)];
    let folder = Folder(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne"));
    let (pack, textures) = (Pack::load(&folder).expect("the built-in avatar"), Textures::load(&folder));
    let gpu = open_blocking(GpuOptions::default()).expect("an adapter");
    println!("{} ({:?}, {})", gpu.info.name, gpu.info.backend, gpu.info.driver_info);
    let shapes = pack.shapes().len();
    println!("{shapes} shapes, {} places of wrinkles", pack.wrinkles().len());
    let weights = [0.0, 1.0].map(|weight| vec![weight; shapes]);
    let model = upload_with_hair(&gpu.device, &gpu.queue, &pack, &textures, None).expect("a model");
    let mut state = AvatarState::new(&gpu.device, &model);
    let mut face = FaceState::new(&pack);
    let mut values = pack.controls().defaults();
    let turn = pack.controls().index("head.turn").expect("a control");
    let aspect = size[0] as f32 / size[1] as f32;
    let scene = NamedView::Front.view().scene(&pack, aspect, [0, 0, 0, 255], Light::default());
    for quality in [Quality::Plain, Quality::Low, Quality::Medium] {
        let shading = quality.shading(Style::Natural);
        let canvas = Canvas::new(&gpu, size[0], size[1], 4, shading).expect("a canvas");
        let mut times = Times::default();
        for round in 0..=rounds {
            values[turn] = (round % 20) as f32 - 10.0;
            face.pose(&pack, &values).expect("a pose");
            for (which, weights) in weights.iter().enumerate() {
                let mut frame = || {
                    state.set(&gpu.queue, face.bones(), weights).expect("a pose");
                    canvas.render(&gpu, &scene, &[(&model, &state)]).expect("a picture");
                };
                // The first round is for what is made at the first use.
                if round == 0 { frame() } else { times.measure(which, frame) }
            }
        }
        times.print(&format!("a frame, {quality:?}"));
    }
    let skin = &pack.parts()[0].mesh;
    let mut deformed = skin.deformed();
    let mut times = Times::default();
    for _ in 0..20 * rounds {
        for (which, weights) in weights.iter().enumerate() {
            let weights = &weights[..skin.shapes.len()];
            times.measure(which, || {
                avatar_mesh::deform(skin, face.bones(), weights, &mut deformed).expect("a mesh that fits");
            });
        }
    }
    times.print("the skin on the CPU");
}
