//! What each quality level and each term of the shading costs: frames of the built-in avatar at 1280×720 and
//! four samples, all configurations in turns in one run, so that what else the machine does hits all alike.
//! Prints medians, ratios to plain, and the times of passes where the adapter has timestamps.
//!
//! `cargo bench -p avatar-render --bench shading [-- ROUNDS]`
#![allow(clippy::expect_used, reason = "a benchmark stops at the first surprise")]
#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "it reads the avatar and the clock")]

use avatar_pack::{FaceState, Pack, Source, SourceError, Textures};
use avatar_render::headless::{Gpu, GpuOptions, open_blocking};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Light, PassTimer, Quality, Renderer, RendererConfig, Scattering, Scene,
    Shading, Shadows, Style, Targets, Terms,
};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::time::Instant;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

struct Folder(PathBuf);

impl Source for Folder {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(std::fs::read(self.0.join(name)).ok().map(Cow::Owned))
    }
}

fn main() {
    let rounds = std::env::args().filter_map(|arg| arg.parse().ok()).next().unwrap_or(15usize);
    let gpu = open_blocking(GpuOptions::default()).expect("an adapter");
    println!("{} ({:?}, {})\n", gpu.info.name, gpu.info.backend, gpu.info.driver_info);
    let (model, state, scene) = avatar(&gpu);
    let mut stages: Vec<Stage> =
        configurations().into_iter().map(|(name, shading)| Stage::new(&gpu, name, shading)).collect();
    let empty = Stage::new(&gpu, "clear and resolve", Shading::Plain);
    // Once for everything that is made at the first use.
    for stage in &stages {
        stage.frame(&gpu, &scene, &[(&model, &state)]);
        assert_eq!(gpu.errors.take(), None, "{}", stage.name);
    }
    let mut floor = Vec::new();
    for _ in 0..rounds {
        floor.push(empty.frame(&gpu, &scene, &[]));
        for stage in &mut stages {
            let time = stage.frame(&gpu, &scene, &[(&model, &state)]);
            stage.times.push(time);
            if let Some(timer) = &stage.timer {
                stage.passes.push(timer.read(&gpu.device).expect("times"));
            }
        }
    }
    let floor = median(&mut floor);
    let plain = median(&mut stages.first_mut().expect("plain comes first").times.clone());
    println!("{:<34}{:>9}{:>12}{:>16}", "frame", "ms", "by plain", "above the floor");
    println!("{:<34}{:>9.1}{:>12.2}", "clear and resolve (floor)", floor, floor / plain);
    for stage in &mut stages {
        let time = median(&mut stage.times);
        println!(
            "{:<34}{time:>9.1}{:>12.2}{:>16.2}",
            stage.name,
            time / plain,
            (time - floor) / (plain - floor)
        );
    }
    println!("\nmedian milliseconds of passes");
    for stage in &stages {
        println!("{:<34}{}", stage.name, stage.pass_times());
    }
}

/// Quality levels, then each term of medium and high on its own switched off, and each affordable one added
/// to low.
fn configurations() -> Vec<(&'static str, Shading)> {
    let natural = |quality: Quality| quality.shading(Style::Natural);
    let (low, medium, high) = (Terms::LOW, Terms::MEDIUM, Terms::HIGH);
    vec![
        ("plain", natural(Quality::Plain)),
        ("low", natural(Quality::Low)),
        ("medium", natural(Quality::Medium)),
        ("high", natural(Quality::High)),
        ("toon", Shading::Toon),
        ("low without shadows", Shading::Natural(Terms { shadows: Shadows::Off, ..low })),
        ("low without eye optics", Shading::Natural(Terms { eye_optics: false, ..low })),
        ("low with soft shadows", Shading::Natural(Terms { shadows: Shadows::Soft, ..low })),
        ("low with reflections", Shading::Natural(Terms { reflections: true, ..low })),
        ("low with occlusion", Shading::Natural(Terms { occlusion: true, ..low })),
        (
            "low with pre-integrated skin",
            Shading::Natural(Terms { scattering: Scattering::PreIntegrated, ..low }),
        ),
        ("medium without shadows", Shading::Natural(Terms { shadows: Shadows::Off, ..medium })),
        ("medium without occlusion", Shading::Natural(Terms { occlusion: false, ..medium })),
        ("medium with wrapped skin", Shading::Natural(Terms { scattering: Scattering::Wrapped, ..medium })),
        ("medium without reflections", Shading::Natural(Terms { reflections: false, ..medium })),
        ("medium without the sharp lobe", Shading::Natural(Terms { sharp_lobe: false, ..medium })),
        ("medium without pores", Shading::Natural(Terms { pores: false, ..medium })),
        ("medium without transmission", Shading::Natural(Terms { transmission: false, ..medium })),
        ("medium without eye optics", Shading::Natural(Terms { eye_optics: false, ..medium })),
        ("high with soft shadows", Shading::Natural(Terms { shadows: Shadows::Soft, ..high })),
        (
            "high with pre-integrated skin",
            Shading::Natural(Terms { scattering: Scattering::PreIntegrated, ..high }),
        ),
    ]
}

struct Stage {
    name: &'static str,
    renderer: Renderer,
    targets: Targets,
    view: wgpu::TextureView,
    timer: Option<PassTimer>,
    times: Vec<f64>,
    passes: Vec<Vec<(&'static str, f64)>>,
}

impl Stage {
    fn new(gpu: &Gpu, name: &'static str, shading: Shading) -> Self {
        let config = RendererConfig { color_format: FORMAT, samples: 4, shading };
        let renderer = Renderer::new(&gpu.device, &gpu.queue, config).expect("a renderer");
        let targets = Targets::new(&gpu.device, &renderer, WIDTH, HEIGHT).expect("targets");
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("bench"),
            size: wgpu::Extent3d { width: WIDTH, height: HEIGHT, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        let timer = PassTimer::new(&gpu.device, &gpu.queue);
        Self { name, renderer, targets, view, timer, times: Vec::new(), passes: Vec::new() }
    }

    /// Draws a frame and waits for it, in milliseconds.
    fn frame(&self, gpu: &Gpu, scene: &Scene, avatars: &[(&AvatarModel, &AvatarState)]) -> f64 {
        let start = Instant::now();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let (view, targets, timer) = (&self.view, &self.targets, self.timer.as_ref());
        self.renderer
            .draw_timed(&mut encoder, view, targets, &gpu.queue, scene, avatars, timer)
            .expect("recorded");
        gpu.queue.submit([encoder.finish()]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("drawn");
        start.elapsed().as_secs_f64() * 1e3
    }

    fn pass_times(&self) -> String {
        let Some(first) = self.passes.first() else { return "no timestamps".to_owned() };
        let of = |pass: usize| {
            let mut times: Vec<f64> =
                self.passes.iter().filter_map(|frame| frame.get(pass)).map(|(_, ns)| ns / 1e6).collect();
            median(&mut times)
        };
        let each = first.iter().enumerate().map(|(i, (name, _))| format!("{name} {:.2}", of(i)));
        each.collect::<Vec<_>>().join(", ")
    }
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The built-in avatar, smiling, from the front, so large that its head fills the picture's height.
fn avatar(gpu: &Gpu) -> (AvatarModel, AvatarState, Scene) {
    let folder = Folder(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne"));
    let pack = Pack::load(&folder).expect("the built-in avatar");
    let textures = Textures::load(&folder);
    let model = avatar_stage::upload(&gpu.device, &gpu.queue, &pack, &textures).expect("a model");
    let mut state = AvatarState::new(&gpu.device, &model);
    let mut face = FaceState::new(&pack);
    let mut values = pack.controls().defaults();
    let smile = pack.poses().get("smile").expect("a smile");
    smile.values.iter().for_each(|&(control, value)| values[control] = value);
    face.pose(&pack, &values).expect("a pose");
    state.set(&gpu.queue, face.bones(), face.weights()).expect("lengths fit");
    let bounds = pack.bounds().expect("a face");
    let camera = Camera::frame(bounds, 0.0, 0.0, 0.42, WIDTH as f32 / HEIGHT as f32);
    (model, state, Scene { camera, background: [0.02, 0.02, 0.03, 1.0], light: Light::studio() })
}
