//! What a frame costs: 1280×720 at 4 samples, a skin of 63,488 vertices and 30,000 triangles, on the adapter
//! at hand.
//!
//! `floor` clears and resolves and draws nothing: what remains of the others is the avatars' share.
#![allow(clippy::expect_used, clippy::panic, reason = "a benchmark stops at the first surprise")]

use avatar_mesh::{Mesh, PartKind, Shape, Skinning};
use avatar_render::headless::{Gpu, GpuOptions, open_blocking};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Deformer, Light, PartBones, PartDesc, PartTextures, Renderer,
    RendererConfig, Scene, Shading, Targets,
};
use divan::Bencher;
use glam::{Affine3A, Vec2, Vec3};
use std::sync::OnceLock;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;
const VERTICES: usize = 63_488;
const TRIANGLES: usize = 30_000;
const BONES: usize = 9;
const SHAPES: usize = 20;

fn main() {
    println!("{} ({:?}, {})", gpu().info.name, gpu().info.backend, gpu().info.driver_info);
    divan::main();
}

fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| open_blocking(GpuOptions::default()).expect("an adapter"))
}

/// A head-sized ball, stored far from welded as the original skin is: most triangles have corners of their
/// own.
fn skin() -> Mesh {
    let (columns, rows) = (150usize, 100usize);
    let point = |row: usize, column: usize| {
        let (u, v) = (column as f32 / columns as f32, row as f32 / rows as f32);
        let (yaw, polar) = (u * std::f32::consts::TAU, v * std::f32::consts::PI);
        (Vec3::new(polar.sin() * yaw.sin(), polar.cos(), polar.sin() * yaw.cos()), Vec2::new(u, v))
    };
    let mut mesh = Mesh::default();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let first = mesh.positions.len() as u32;
        for (r, c) in [(row, column), (row + 1, column), (row, column + 1), (row + 1, column + 1)] {
            let (normal, uv) = point(r, c);
            mesh.positions.push(normal * Vec3::new(8.0, 11.0, 9.0));
            mesh.normals.push(normal);
            mesh.uvs.push(uv);
        }
        mesh.triangles.extend([[first, first + 1, first + 2], [first + 2, first + 1, first + 3]]);
    }
    // The rest of the vertices is used by nobody, but deformed by the compute pass all the same.
    mesh.positions.resize(VERTICES, Vec3::ZERO);
    mesh.normals.resize(VERTICES, Vec3::Z);
    mesh.uvs.resize(VERTICES, Vec2::ZERO);
    assert_eq!(mesh.triangles.len(), TRIANGLES);
    mesh.skinning = Some(Skinning {
        bones: (0..VERTICES).map(|v| std::array::from_fn(|i| ((v + i) % BONES) as u16)).collect(),
        weights: vec![[0.55, 0.25, 0.15, 0.05]; VERTICES],
        ..Skinning::default()
    });
    mesh.shapes = (0..SHAPES)
        .map(|k| {
            let positions: Vec<Vec3> = mesh.positions.iter().map(|p| *p * (0.001 * k as f32)).collect();
            let normals: Vec<Vec3> = mesh.normals.iter().map(|n| *n * 0.01).collect();
            Shape::new(format!("shape {k}"), positions).with_normals(normals)
        })
        .collect();
    mesh
}

/// Everything a frame needs; `frame` draws one and waits for it.
struct Stage {
    renderer: Renderer,
    targets: Targets,
    view: wgpu::TextureView,
    model: AvatarModel,
    states: Vec<AvatarState>,
    weights: [f32; SHAPES],
    tick: u32,
}

impl Stage {
    fn new(avatars: usize, active_shapes: usize) -> Self {
        let gpu = gpu();
        let color_format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let renderer = Renderer::new(
            &gpu.device,
            &gpu.queue,
            RendererConfig { color_format, samples: 4, shading: Shading::Plain },
        )
        .expect("a renderer");
        let targets = Targets::new(&gpu.device, &renderer, WIDTH, HEIGHT).expect("targets");
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("bench"),
            size: wgpu::Extent3d { width: WIDTH, height: HEIGHT, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: color_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let mesh = skin();
        let part = PartDesc {
            label: "skin",
            mesh: &mesh,
            first_weight: 0,
            kind: PartKind::Skin,
            bones: PartBones::PerVertex,
            textures: PartTextures::default(),
        };
        let model = AvatarModel::new(&gpu.device, &gpu.queue, &[part], BONES).expect("a model");
        let states = (0..avatars).map(|_| AvatarState::new(&gpu.device, &model)).collect();
        let weights = std::array::from_fn(|k| if k < active_shapes { 0.5 } else { 0.0 });
        let view = texture.create_view(&Default::default());
        let mut stage = Self { renderer, targets, view, model, states, weights, tick: 0 };
        stage.animate();
        stage.frame();
        stage
    }

    /// A new pose for every avatar; they stand in a row and share the picture.
    fn animate(&mut self) {
        self.tick += 1;
        let turn = Affine3A::from_rotation_y((self.tick as f32 * 0.1).sin() * 0.2);
        let count = self.states.len() as f32;
        for (i, state) in self.states.iter_mut().enumerate() {
            let at = Vec3::X * 20.0 * (i as f32 - (count - 1.0) * 0.5);
            let bones = [Affine3A::from_translation(at) * turn; BONES];
            state.set(&gpu().queue, &bones, &self.weights).expect("lengths fit");
        }
    }

    fn frame(&self) {
        let gpu = gpu();
        let distance = 20.0 * (self.states.len().max(1) as f32).max(2.0);
        let scene = Scene {
            camera: Camera::orbit(Vec3::ZERO, distance, 0.0, 0.0, 0.6, WIDTH as f32 / HEIGHT as f32),
            background: [0.1, 0.1, 0.1, 1.0],
            light: Light::default(),
        };
        let avatars: Vec<_> = self.states.iter().map(|state| (&self.model, state)).collect();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.renderer
            .draw(&mut encoder, &self.view, &self.targets, &gpu.queue, &scene, &avatars)
            .expect("recorded");
        gpu.queue.submit([encoder.finish()]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("drawn");
    }
}

/// Clear and resolve only.
#[divan::bench]
fn floor(bencher: Bencher<'_, '_>) {
    let stage = Stage::new(0, 0);
    bencher.bench_local(|| stage.frame());
}

/// One avatar whose pose changes every frame, by active shapes.
#[divan::bench(args = [0, 2, 20])]
fn animated(bencher: Bencher<'_, '_>, active_shapes: usize) {
    let mut stage = Stage::new(1, active_shapes);
    bencher.bench_local(|| {
        stage.animate();
        stage.frame();
    });
}

/// One avatar that keeps its pose, by active shapes.
#[divan::bench(args = [0, 2, 20])]
fn frozen(bencher: Bencher<'_, '_>, active_shapes: usize) {
    let stage = Stage::new(1, active_shapes);
    bencher.bench_local(|| stage.frame());
}

/// Avatars of one model, each in its own changing pose.
#[divan::bench(args = [1, 4, 16])]
fn avatars(bencher: Bencher<'_, '_>, count: usize) {
    let mut stage = Stage::new(count, 2);
    bencher.bench_local(|| {
        stage.animate();
        stage.frame();
    });
}

/// The deformation alone, as a compute pass with reading back.
#[divan::bench(args = [0, 2, 20])]
fn deform_and_read_back(bencher: Bencher<'_, '_>, active_shapes: usize) {
    let stage = Stage::new(1, active_shapes);
    let deformer = Deformer::new(&gpu().device);
    bencher.bench_local(|| {
        deformer.run(&gpu().device, &gpu().queue, &stage.model, &stage.states[0], 0).expect("deformed")
    });
}
