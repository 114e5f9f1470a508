//! What hair costs: growth and drawing per strand at 1280×720 and four samples, and how close growth comes to
//! a plain kernel that copies, vec4 by vec4, so that it reads and writes as many bytes as growth must, in the
//! same run.
//!
//! `cargo bench -p avatar-render --bench hair [-- ROUNDS] [bob|curly|…] [STRANDS] [growth]`; `growth`:
//! nothing is drawn.
#![allow(clippy::expect_used, reason = "a benchmark stops at the first surprise")]
#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "it reads the avatar and the clock")]

mod kernels;

use avatar_groom::{DensityMap, Groom, SEGMENTS, Style};
use avatar_pack::{Pack, Source, SourceError, Texture, Textures};
use avatar_render::headless::{Gpu, GpuOptions, open_blocking};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Grower, HairDetail, Light, PartBones, PartDesc, PartTextures,
    PassTimer, Quality, Renderer, RendererConfig, Scene, Style as Manner, Targets,
};
use kernels::{median, pass_and_copy};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::time::Instant;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const STRANDS: [f32; 2] = [10_000.0, 100_000.0];
/// A root as the GPU reads it.
const ROOT_BYTES: usize = 64;
/// A deformed vertex: position and normal.
const VERTEX_BYTES: usize = 32;
/// The points of a strand and its normal.
const STRAND_BYTES: usize = (SEGMENTS + 2) * 16;

struct Folder(PathBuf);

impl Source for Folder {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(std::fs::read(self.0.join(name)).ok().map(Cow::Owned))
    }
}

fn main() {
    let numbers: Vec<usize> = std::env::args().filter_map(|arg| arg.parse().ok()).collect();
    let rounds = numbers.first().copied().unwrap_or(5);
    let counts: Vec<f32> = match numbers.get(1..) {
        Some(counts @ [_, ..]) => counts.iter().map(|count| *count as f32).collect(),
        _ => STRANDS.to_vec(),
    };
    let named: Vec<String> = std::env::args().skip(1).collect();
    let is_asked = |name: &str| match Style::PRESETS.iter().any(|(name, _)| named.iter().any(|n| n == name)) {
        true => named.iter().any(|n| n == name),
        false => name == "bob",
    };
    let gpu = open_blocking(GpuOptions::default()).expect("an adapter");
    println!("{} ({:?}, {})\n", gpu.info.name, gpu.info.backend, gpu.info.driver_info);
    let folder = Folder(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne"));
    let pack = Pack::load(&folder).expect("the built-in avatar");
    let textures = Textures::load(&folder);
    let map = textures.get(Texture::HairDensity).expect("a map of hair");
    let reds = map.as_raw().iter().copied().step_by(4).collect();
    let density = DensityMap::new(map.width(), map.height(), reds).expect("a map");
    let shading = Quality::of_adapter(&gpu.info).shading(Manner::Natural);
    let config = RendererConfig { color_format: FORMAT, samples: 4, shading };
    let renderer = Renderer::new(&gpu.device, &gpu.queue, config).expect("a renderer");
    let targets = Targets::new(&gpu.device, &renderer, WIDTH, HEIGHT).expect("targets");
    let mut bald = None;
    for (name, style) in Style::PRESETS.into_iter().filter(|(name, _)| is_asked(name)) {
        for &strands in &counts {
            let (model, state, scene, bytes) = avatar(&gpu, &pack, &density, style, strands);
            let count = model.strand_count();
            if named.iter().any(|n| n == "growth") {
                println!("{name}, {count} strands:");
                print_growth(&gpu, &model, &state, bytes, rounds);
                continue;
            }
            let bench = Bench { gpu: &gpu, renderer: &renderer, targets: &targets, scene: &scene };
            let bald = *bald.get_or_insert_with(|| {
                let (model, state, ..) = avatar(&gpu, &pack, &density, style, 0.0);
                bench.frames(&model, &state, rounds).0
            });
            let (frame, passes) = bench.frames(&model, &state, rounds);
            println!("{name}, {count} strands: a frame takes {frame:.2} ms, {bald:.2} ms without hair");
            let per = |ms: f64| ms * 1e6 / count as f64;
            // Software adapters do not wait for compute passes to note their end.
            let is_software = gpu.info.device_type == wgpu::DeviceType::Cpu;
            let is_noted = |pass: &str| !(is_software && ["deform", "grow hair"].contains(&pass));
            for (pass, ms) in passes.iter().filter(|(pass, _)| is_noted(pass)) {
                println!("  {pass:<20}{ms:>9.2} ms{:>9.0} ns per strand", per(*ms));
            }
            print_growth(&gpu, &model, &state, bytes, rounds);
        }
    }
}

fn print_growth(gpu: &Gpu, model: &AvatarModel, state: &AvatarState, bytes: usize, rounds: usize) {
    let grower = Grower::new(&gpu.device);
    let (growing, copying) = pass_and_copy(gpu, bytes, rounds, |encoder| grower.grow(encoder, model, state));
    let rate = |seconds: f64| bytes as f64 / seconds * 1e-9;
    println!(
        "  growth alone {:.2} ms, {:.0} ns per strand, {:.2} GB/s; copying {:.2} GB/s: {:.2} of it\n",
        growing * 1e3,
        growing * 1e9 / model.strand_count() as f64,
        rate(growing),
        rate(copying),
        copying / growing
    );
}

/// The built-in avatar's skin with hair, so large that the head fills the picture's height, and the bytes
/// that its growth must read and write.
fn avatar(
    gpu: &Gpu,
    pack: &Pack,
    density: &DensityMap,
    style: Style,
    strands: f32,
) -> (AvatarModel, AvatarState, Scene, usize) {
    let skin = &pack.parts()[0];
    let part = PartDesc {
        label: "skin",
        mesh: &skin.mesh,
        first_weight: 0,
        kind: skin.kind,
        bones: PartBones::PerVertex,
        textures: PartTextures::default(),
    };
    let mut model =
        AvatarModel::new(&gpu.device, &gpu.queue, &[part], pack.palette().len()).expect("a model");
    let eyes: Vec<_> =
        ["right-eyeball", "left-eyeball"].iter().filter_map(|name| pack.part(name)?.mesh.bounds()).collect();
    let head = pack.head();
    if let Some(head) = head {
        model.set_height(head.size().y);
    }
    let head = head.or_else(|| skin.mesh.bounds());
    let groom = Groom::on_head(&skin.mesh, head, density, &eyes, style, strands, 1);
    model.set_hair(&gpu.device, &gpu.queue, 0, Some(&groom)).expect("hair");
    let mut state = AvatarState::new(&gpu.device, &model);
    state.set_hair_detail(HairDetail { is_automatic: false, ..HairDetail::default() });
    let mut corners: Vec<u32> = groom.strands().iter().flat_map(|strand| strand.root.corners).collect();
    corners.sort_unstable();
    corners.dedup();
    let bytes = groom.strands().len() * (ROOT_BYTES + STRAND_BYTES) + corners.len() * VERTEX_BYTES;
    let bounds = head.or_else(|| pack.bounds()).expect("a face");
    let camera = Camera::frame(bounds, 0.0, 0.0, 0.42, WIDTH as f32 / HEIGHT as f32);
    (model, state, Scene { camera, background: [0.02, 0.02, 0.03, 1.0], light: Light::studio() }, bytes)
}

struct Bench<'a> {
    gpu: &'a Gpu,
    renderer: &'a Renderer,
    targets: &'a Targets,
    scene: &'a Scene,
}

impl Bench<'_> {
    /// Medians: a frame, and its passes, in milliseconds.
    fn frames(&self, model: &AvatarModel, state: &AvatarState, rounds: usize) -> (f64, Vec<(String, f64)>) {
        let Self { gpu, renderer, targets, scene } = self;
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
        let mut frames = Vec::new();
        let mut passes: Vec<(String, Vec<f64>)> = Vec::new();
        for round in 0..=rounds {
            let start = Instant::now();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            renderer
                .draw_timed(
                    &mut encoder,
                    &view,
                    targets,
                    &gpu.queue,
                    scene,
                    &[(model, state)],
                    timer.as_ref(),
                )
                .expect("recorded");
            gpu.queue.submit([encoder.finish()]);
            gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("drawn");
            let time = start.elapsed().as_secs_f64() * 1e3;
            // The first frame makes what is made at the first use.
            if round == 0 {
                continue;
            }
            frames.push(time);
            for (pass, ns) in
                timer.iter().flat_map(|timer| timer.read(&gpu.device).expect("times")).collect::<Vec<_>>()
            {
                match passes.iter_mut().find(|(name, _)| name == pass) {
                    Some((_, times)) => times.push(ns / 1e6),
                    None => passes.push((pass.to_owned(), vec![ns / 1e6])),
                }
            }
        }
        assert_eq!(gpu.errors.take(), None);
        let passes = passes.into_iter().map(|(name, mut times)| (name, median(&mut times)));
        (median(&mut frames), passes.collect())
    }
}
