//! What hair costs: growth and drawing per strand at 1280×720 and four samples, and how close growth comes to copying
//! as many bytes as it must read and write with a plain kernel, vec4 by vec4, in the same run.
//!
//! `cargo bench -p avatar-render --bench hair [-- ROUNDS]`
#![allow(clippy::expect_used, reason = "a benchmark stops at the first surprise")]
#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "it reads the avatar and the clock")]

use avatar_groom::{DensityMap, Groom, SEGMENTS, Style};
use avatar_pack::{Pack, Source, SourceError, Texture, Textures};
use avatar_render::headless::{Gpu, GpuOptions, open_blocking};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Light, PartBones, PartDesc, PartTextures, PassTimer, Quality, Renderer,
    RendererConfig, Scene, Style as Manner, Targets,
};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::time::Instant;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const STRANDS: [f32; 3] = [10_000.0, 50_000.0, 150_000.0];
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
    let rounds = std::env::args().filter_map(|arg| arg.parse().ok()).next().unwrap_or(9usize);
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
    for (name, style) in Style::PRESETS.into_iter().filter(|(name, _)| ["bob", "curly"].contains(name)) {
        for strands in STRANDS {
            let (model, state, scene, bytes) = avatar(&gpu, &pack, &density, style, strands);
            let bench = Bench { gpu: &gpu, renderer: &renderer, targets: &targets, scene: &scene };
            let bald = *bald.get_or_insert_with(|| {
                let (model, state, ..) = avatar(&gpu, &pack, &density, style, 0.0);
                bench.frames(&model, &state, rounds).0
            });
            let (frame, passes) = bench.frames(&model, &state, rounds);
            let count = model.strand_count();
            println!("{name}, {count} strands: a frame takes {frame:.2} ms, {bald:.2} ms without hair");
            let per = |ms: f64| ms * 1e6 / count as f64;
            for (pass, ms) in &passes {
                println!("  {pass:<20}{ms:>9.2} ms{:>9.0} ns per strand", per(*ms));
            }
            let grow = passes.iter().find(|(pass, _)| pass == "grow hair").map(|(_, ms)| *ms);
            let copied = copy_bytes_per_second(&gpu, bytes / 2, rounds);
            match grow {
                Some(ms) => {
                    let grown = bytes as f64 / (ms * 1e-3);
                    println!(
                        "  growth {:.2} GB/s, copying {:.2} GB/s: {:.2} of it\n",
                        grown * 1e-9,
                        copied * 1e-9,
                        grown / copied
                    );
                }
                None => println!("  no timestamps; copying {:.2} GB/s\n", copied * 1e-9),
            }
        }
    }
}

/// The built-in avatar's skin with hair, so large that the head fills the picture's height, and the bytes that its
/// growth must read and write.
fn avatar(
    gpu: &Gpu,
    pack: &Pack,
    density: &DensityMap,
    style: Style,
    strands: f32,
) -> (AvatarModel, AvatarState, Scene, usize) {
    let skin = &pack.parts[0];
    let part = PartDesc {
        label: "skin",
        mesh: &skin.mesh,
        kind: skin.spec.kind,
        bones: PartBones::PerVertex,
        textures: PartTextures::default(),
    };
    let mut model = AvatarModel::new(&gpu.device, &gpu.queue, &[part], pack.palette.len()).expect("a model");
    let eyes: Vec<_> =
        ["right-eyeball", "left-eyeball"].iter().filter_map(|name| pack.part(name)?.mesh.bounds()).collect();
    let groom = Groom::new(&skin.mesh, density, &eyes, style, strands, 1);
    model.set_hair(&gpu.device, 0, &skin.mesh, Some(&groom)).expect("hair");
    let state = AvatarState::new(&gpu.device, &model);
    let mut corners: Vec<u32> = groom.roots.iter().flat_map(|root| root.corners).collect();
    corners.sort_unstable();
    corners.dedup();
    let bytes = groom.roots.len() * (ROOT_BYTES + STRAND_BYTES) + corners.len() * VERTEX_BYTES;
    let bounds = pack.bounds().expect("a face");
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

const COPY: &str = "
@group(0) @binding(0) var<storage, read> source: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> copied: array<vec4f>;

@compute @workgroup_size(64)
fn copy_main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&copied); i += groups.x * 64u) {
        copied[i] = source[i];
    }
}
";

/// Bytes that a plain kernel reads and writes per second, as the median over rounds of copying `bytes`.
fn copy_bytes_per_second(gpu: &Gpu, bytes: usize, rounds: usize) -> f64 {
    let device = &gpu.device;
    let size = (bytes as u64).next_multiple_of(16);
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("bench: copy"),
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let [source, copied] = [0; 2].map(|_| buffer(wgpu::BufferUsages::STORAGE));
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("bench: copy"),
        source: wgpu::ShaderSource::Wgsl(COPY.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("bench: copy"),
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("bench: copy"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: source.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: copied.as_entire_binding() },
        ],
    });
    let queries = device.features().contains(wgpu::Features::TIMESTAMP_QUERY).then(|| {
        let ty = wgpu::QueryType::Timestamp;
        device.create_query_set(&wgpu::QuerySetDescriptor { label: Some("bench: copy"), ty, count: 2 })
    });
    let resolved = buffer_of_times(device, wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC);
    let readable = buffer_of_times(device, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let mut times = Vec::new();
    for round in 0..=rounds {
        let start = Instant::now();
        let mut encoder = device.create_command_encoder(&Default::default());
        let timestamp_writes = queries.as_ref().map(|query_set| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        });
        {
            let label = Some("bench: copy");
            let mut pass =
                encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((size / 16).div_ceil(64).min(65_535) as u32, 1, 1);
        }
        if let Some(queries) = &queries {
            encoder.resolve_query_set(queries, 0..2, &resolved, 0);
            encoder.copy_buffer_to_buffer(&resolved, 0, &readable, 0, readable.size());
        }
        gpu.queue.submit([encoder.finish()]);
        readable.map_async(wgpu::MapMode::Read, .., |result| result.expect("mapped"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("copied");
        let wall = start.elapsed().as_secs_f64();
        let ticks: [u64; 2] = {
            let view = readable.get_mapped_range(..).expect("mapped");
            [0, 8].map(|at| u64::from_le_bytes(view[at..at + 8].try_into().expect("eight bytes")))
        };
        readable.unmap();
        let seconds = match &queries {
            Some(_) => (ticks[1] - ticks[0]) as f64 * f64::from(gpu.queue.get_timestamp_period()) * 1e-9,
            None => wall,
        };
        if round > 0 {
            times.push(seconds);
        }
    }
    2.0 * size as f64 / median(&mut times)
}

fn buffer_of_times(device: &wgpu::Device, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("bench: times"),
        size: 16,
        usage,
        mapped_at_creation: false,
    })
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}
