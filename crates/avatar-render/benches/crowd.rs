//! What many avatars of one model cost: 1, 4, 16, 64 and 1,000 of them in a grid that fills the picture,
//! 1280×720 at four samples, without textures, in plain shading and in low quality. All of them move before
//! each frame: the head turns and shapes follow.
//!
//! `cargo bench -p avatar-render --bench crowd -- [SECONDS] [MOST] [PACK]`: about so many seconds for each
//! row, at most so many avatars, of a folder in the raw format; without one of the built-in avatar.
//!
//! Prints milliseconds, the fastest and the median of all frames: `pose`, handing bones and weights over;
//! `record`, everything that one core does until the frame is submitted; `frame`, from then until it is
//! there; `still`, the same where nothing moved, so that nothing is deformed. A crowd `by level` has the
//! level of detail for its height in the picture, a quarter of a pixel off at most; one avatar has that of
//! sixteen, so that the difference is what further ones cost. Rows beside each other are measured in turns.
//! Where a frame takes long, more are recorded than are submitted.
#![allow(clippy::expect_used, reason = "a benchmark stops at the first surprise")]
#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "it reads the avatar and the clock")]

use avatar_mesh::PartKind;
use avatar_pack::{FaceState, Level, Pack, Source, SourceError, Textures};
use avatar_render::headless::{Gpu, GpuOptions, open_blocking};
use avatar_render::{
    AvatarCrowd, AvatarModel, AvatarState, Camera, Light, Quality, Renderer, RendererConfig, Scene, Style,
    Targets,
};
use glam::{Affine3A, Vec3};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::time::Instant;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const COUNTS: [usize; 5] = [1, 4, 16, 64, 1000];
/// Frames that are recorded for each row, at least.
const RECORDED: usize = 20;
/// A cell of the grid, across and up, for a skin of this height.
const CELL: [f32; 2] = [28.0, 32.0];
const SKIN_HEIGHT: f32 = 30.0;

struct Folder(PathBuf);

impl Source for Folder {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(std::fs::read(self.0.join(name)).ok().map(Cow::Owned))
    }
}

/// One way to draw so many avatars.
enum Avatars {
    OneByOne(Vec<AvatarState>),
    Crowd(Box<AvatarCrowd>),
}

/// Milliseconds of one frame.
#[derive(Clone, Copy, Default)]
struct Times {
    pose: f64,
    record: f64,
    frame: f64,
}

struct Row<'a> {
    name: String,
    model: &'a AvatarModel,
    avatars: Avatars,
    count: usize,
    moving: Vec<Times>,
    still: Vec<Times>,
}

struct Stage<'a> {
    gpu: &'a Gpu,
    pack: &'a Pack,
    renderer: Renderer,
    targets: Targets,
    view: wgpu::TextureView,
    face: FaceState,
    tick: u32,
}

fn main() {
    let mut numbers = std::env::args().filter_map(|arg| arg.parse().ok());
    let (seconds, most) = (numbers.next().unwrap_or(4.0f64), numbers.next().unwrap_or(1000.0));
    let built_in = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let given = std::env::args().skip(1).map(PathBuf::from).find(|path| path.is_dir());
    let folder = given.unwrap_or(built_in);
    let pack = Pack::load(&Folder(folder.clone())).expect("an avatar");
    let gpu = open_blocking(GpuOptions::default()).expect("an adapter");
    println!("{} ({:?}, {})", gpu.info.name, gpu.info.backend, gpu.info.driver_info);
    let skin = pack.parts().iter().find(|part| part.kind == PartKind::Skin).expect("a skin");
    let vertices: usize = pack.parts().iter().map(|part| part.mesh.positions.len()).sum();
    println!(
        "{}: a skin of {} vertices and {} triangles, {vertices} vertices in all",
        folder.display(),
        skin.mesh.positions.len(),
        skin.mesh.triangles.len()
    );
    let upload = |pack: &Pack| {
        avatar_stage::upload_with_hair(&gpu.device, &gpu.queue, pack, &Textures::default(), None)
            .expect("a model")
    };
    let mut models = vec![upload(&pack)];
    let triangles = |pack: &Pack| pack.parts().iter().map(|part| part.mesh.triangles.len()).sum::<usize>();
    print!("triangles by level: {}", triangles(&pack));
    for level in Level::all(&pack, false) {
        print!(", {}", triangles(&level.pack));
        models.push(upload(&level.pack));
    }
    println!();
    for quality in [Quality::Plain, Quality::Low] {
        println!(
            "\n{quality:?}\n{:<24}{:>16}{:>16}{:>18}{:>18}",
            "ms: least, median", "pose", "record", "frame", "still"
        );
        let mut stage = Stage::new(&gpu, &pack, quality);
        let mut least = Vec::new();
        for count in COUNTS.into_iter().filter(|count| *count as f64 <= most) {
            let (model, simple) = (&models[0], &models[stage.level(if count == 1 { 16 } else { count })]);
            let states = (0..count).map(|_| AvatarState::new(&gpu.device, model)).collect();
            let crowd =
                |model| Avatars::Crowd(Box::new(AvatarCrowd::new(&gpu.device, model, count).expect("room")));
            let row = |name, model, avatars| Row {
                name: format!("{count} {name}"),
                model,
                avatars,
                count,
                moving: Vec::new(),
                still: Vec::new(),
            };
            let mut rows = [
                row("as a crowd", model, crowd(model)),
                row("by level", simple, crowd(simple)),
                row("one by one", model, Avatars::OneByOne(states)),
            ];
            // For what is made at the first use.
            for row in rows.iter_mut().filter(|_| count <= 64) {
                stage.step(row);
                row.moving.clear();
                row.still.clear();
            }
            let start = Instant::now();
            while start.elapsed().as_secs_f64() < seconds || rows[0].moving.is_empty() {
                rows.iter_mut().for_each(|row| stage.step(row));
            }
            for _ in rows[0].moving.len()..RECORDED {
                rows.iter_mut().for_each(|row| stage.record(row));
            }
            rows.iter().for_each(Row::print);
            assert_eq!(gpu.errors.take(), None);
            let whole = |row: &Row<'_>| {
                fastest(&row.moving, |times| match times.frame {
                    0.0 => f64::INFINITY,
                    frame => times.record + frame,
                })
            };
            least.push((count, rows.each_ref().map(whole)));
        }
        let [Some((_, one)), Some((_, sixteen))] =
            [1, 16].map(|n| least.iter().find(|(count, _)| *count == n))
        else {
            continue;
        };
        let [crowd, by_level, one_by_one] = [0, 1, 2].map(|row| (sixteen[row] - one[row]) / 15.0);
        println!(
            "each further avatar, from 1 to 16: {crowd:.2} ms in a crowd, {by_level:.2} by level, \
             {one_by_one:.2} one by one"
        );
    }
}

fn fastest(times: &[Times], of: impl Fn(&Times) -> f64) -> f64 {
    times.iter().map(of).fold(f64::INFINITY, f64::min)
}

fn shown<'a>(times: impl Iterator<Item = &'a Times>, of: impl Fn(&Times) -> f64) -> String {
    let mut all: Vec<f64> = times.map(&of).collect();
    all.sort_by(f64::total_cmp);
    format!("{:.2}, {:.2}", all[0], all[all.len() / 2])
}

impl Row<'_> {
    fn print(&self) {
        println!(
            "{:<24}{:>16}{:>16}{:>18}{:>18}",
            self.name,
            shown(self.moving.iter(), |times| times.pose),
            shown(self.moving.iter(), |times| times.record),
            shown(self.moving.iter().filter(|times| times.frame > 0.0), |times| times.frame),
            shown(self.still.iter(), |times| times.frame)
        );
    }
}

impl<'a> Stage<'a> {
    fn new(gpu: &'a Gpu, pack: &'a Pack, quality: Quality) -> Self {
        let shading = quality.shading(Style::Natural);
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
        Self { gpu, pack, renderer, targets, view, face: FaceState::new(pack), tick: 0 }
    }

    /// A frame in which all move, and one in which none does.
    fn step(&mut self, row: &mut Row<'_>) {
        let pose = self.animate(row);
        let moving = self.frame(row, true);
        row.moving.push(Times { pose, ..moving });
        let still = self.frame(row, true);
        row.still.push(still);
    }

    /// A frame in which all move, which is recorded and thrown away.
    fn record(&mut self, row: &mut Row<'_>) {
        let pose = self.animate(row);
        let recorded = self.frame(row, false);
        row.moving.push(Times { pose, ..recorded });
    }

    /// How much larger the pack is than the skin that cells are for.
    fn scale(&self) -> f32 {
        let skin = self.pack.parts().iter().find(|part| part.kind == PartKind::Skin);
        skin.and_then(|skin| skin.mesh.bounds()).map_or(1.0, |bounds| bounds.size().y / SKIN_HEIGHT)
    }

    fn columns(count: usize) -> usize {
        (count as f64).sqrt().ceil() as usize
    }

    fn rows(count: usize) -> usize {
        count.div_ceil(Self::columns(count))
    }

    /// The level of detail for the height that so many avatars have in the picture.
    fn level(&self, count: usize) -> usize {
        let height = Self::rows(count) as f32 * CELL[1] * self.scale();
        Level::for_pixels(self.pack, HEIGHT as f32 / height)
    }

    /// A new pose for every avatar. Returns what handing them over took.
    fn animate(&mut self, row: &mut Row<'_>) -> f64 {
        self.tick += 1;
        let phase = self.tick as f32 / 30.0;
        let poses: Vec<_> = self.pack.poses().iter().collect();
        let pose = poses[self.tick as usize % poses.len()];
        let mut values = self.pack.controls().defaults();
        let share = 0.5 + 0.4 * phase.sin();
        pose.values.iter().for_each(|&(control, value)| values[control] += share * (value - values[control]));
        self.face.pose(self.pack, &values).expect("values of this pack");
        let turn = Affine3A::from_rotation_y(0.4 * phase.sin());
        let middle = self.pack.parts()[0].mesh.bounds().map_or(Vec3::ZERO, |bounds| bounds.center());
        let (columns, rows) = (Self::columns(row.count), Self::rows(row.count));
        let cell = Vec3::new(CELL[0], CELL[1], 0.0) * self.scale();
        let (bones, weights) = (self.face.bones(), self.face.weights());
        let placed = |avatar: usize| {
            let at = Vec3::new(
                (avatar % columns) as f32 - (columns as f32 - 1.0) / 2.0,
                (rows as f32 - 1.0) / 2.0 - (avatar / columns) as f32,
                0.0,
            );
            let place = Affine3A::from_translation(at * cell) * turn * Affine3A::from_translation(-middle);
            bones.iter().map(|bone| place * *bone).collect::<Vec<_>>()
        };
        let all: Vec<_> = (0..row.count).map(placed).collect();
        let start = Instant::now();
        match &mut row.avatars {
            Avatars::OneByOne(states) => {
                for (state, bones) in states.iter_mut().zip(&all) {
                    state.set(&self.gpu.queue, bones, weights).expect("bones and weights of this model");
                }
            }
            Avatars::Crowd(crowd) => {
                for (avatar, bones) in all.iter().enumerate() {
                    crowd.set(row.model, avatar, bones, weights).expect("bones and weights of this model");
                }
            }
        }
        1e3 * start.elapsed().as_secs_f64()
    }

    /// Without submission the frame takes no time.
    fn frame(&self, row: &mut Row<'_>, is_submitted: bool) -> Times {
        let rows = Self::rows(row.count) as f32;
        let fov = 30f32.to_radians();
        let distance = rows * CELL[1] * self.scale() * 0.5 / (fov * 0.5).tan();
        let camera = Camera::orbit(Vec3::ZERO, distance, 0.0, 0.0, fov, WIDTH as f32 / HEIGHT as f32);
        let scene = Scene { camera, background: [0.02, 0.02, 0.03, 1.0], light: Light::studio() };
        let gpu = self.gpu;
        // What was posed has been written before.
        gpu.queue.submit([]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("an idle device");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let start = Instant::now();
        let (renderer, view, targets, queue) = (&self.renderer, &self.view, &self.targets, &gpu.queue);
        let drawn = match &mut row.avatars {
            Avatars::OneByOne(states) => {
                let avatars: Vec<_> = states.iter().map(|state| (row.model, state)).collect();
                renderer.draw(&mut encoder, view, targets, queue, &scene, &avatars)
            }
            Avatars::Crowd(crowd) => {
                let crowds = &mut [(row.model, &mut **crowd)];
                renderer.draw_crowds(&mut encoder, view, targets, queue, &scene, &[], crowds, None)
            }
        };
        drawn.expect("recorded");
        let commands = encoder.finish();
        let record = 1e3 * start.elapsed().as_secs_f64();
        if !is_submitted {
            return Times { pose: 0.0, record, frame: 0.0 };
        }
        gpu.queue.submit([commands]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a frame");
        Times { pose: 0.0, record, frame: 1e3 * start.elapsed().as_secs_f64() - record }
    }
}
