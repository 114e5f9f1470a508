//! One GPU for all tests, and meshes to draw.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

pub(crate) mod head;
pub(crate) mod nearest;
pub(crate) mod stage;

use avatar_mesh::{Mesh, PartKind, Shape, Skinning};
use avatar_render::headless::{Gpu, GpuOptions, open_blocking};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Environment, Image, Lamp, Light, PartBones, PartDesc, PartTextures,
    Quality, Scene, Shading, Style, ToneMap,
};
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::io::Write as _;
use std::sync::OnceLock;

/// The GPU, or `None` after printing why the test is skipped.
///
/// With `MIMIK_REQUIRE_GPU=1` a missing GPU fails the test instead.
pub(crate) fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Result<Gpu, String>> = OnceLock::new();
    let opened = GPU.get_or_init(|| open_blocking(GpuOptions::default()).map_err(|e| e.to_string()));
    match opened {
        Ok(gpu) => Some(gpu),
        Err(reason) => {
            skip(reason);
            None
        }
    }
}

/// Prints why a test is skipped; with `MIMIK_REQUIRE_GPU=1` the test fails instead.
#[allow(clippy::disallowed_methods, reason = "a test may ask the environment how strict it is to be")]
pub(crate) fn skip(reason: &str) {
    let required = std::env::var("MIMIK_REQUIRE_GPU").is_ok_and(|value| value == "1");
    assert!(!required, "MIMIK_REQUIRE_GPU=1, but {reason}");
    // Not eprintln: the harness swallows that of tests that pass.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {reason}");
}

/// A small generator with a fixed seed: SplitMix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// From −1 to 1.
    pub(crate) fn signed(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub(crate) fn vec3(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed()) * size
    }

    pub(crate) fn unit(&mut self) -> Vec3 {
        self.vec3(1.0).normalize_or(Vec3::Z)
    }

    pub(crate) fn rigid(&mut self, reach: f32) -> Affine3A {
        let rotation = Quat::from_axis_angle(self.unit(), self.signed() * 3.0);
        Affine3A::from_rotation_translation(rotation, self.vec3(reach))
    }
}

/// A cloud of vertices with shapes and, unless it is rigid, four bones each.
pub(crate) fn random_mesh(random: &mut Random, vertices: usize, shapes: usize, bones: Option<usize>) -> Mesh {
    let vec3s = |random: &mut Random, size: f32| (0..vertices).map(|_| random.vec3(size)).collect::<Vec<_>>();
    let positions = vec3s(random, 20.0);
    let normals: Vec<Vec3> = (0..vertices).map(|_| random.unit()).collect();
    let shapes = (0..shapes)
        .map(|k| {
            let mut shape_normals = vec3s(random, 0.5);
            // Some shapes cancel a normal exactly: the undeformed one takes its place.
            shape_normals.iter_mut().zip(&normals).step_by(7).for_each(|(d, n)| *d = -*n);
            let mut offsets = vec3s(random, 2.0);
            // Some move a few vertices only, and some have no normals of their own.
            if k % 3 == 1 {
                offsets
                    .iter_mut()
                    .enumerate()
                    .filter(|(v, _)| v % 10 != 3)
                    .for_each(|(_, d)| *d = Vec3::ZERO);
                shape_normals = offsets.iter().map(|d| *d * 0.2).collect();
            }
            let shape = Shape::new(format!("shape {k}"), offsets);
            if k % 4 == 2 { shape } else { shape.with_normals(shape_normals) }
        })
        .collect();
    let skinning = bones.map(|bones| {
        let mut skinning = Skinning::default();
        for _ in 0..vertices {
            skinning.bones.push(std::array::from_fn(|_| random.below(bones) as u16));
            let raw: [f32; 4] = std::array::from_fn(|_| random.signed().abs() + 0.01);
            skinning.weights.push(raw.map(|weight| weight / raw.iter().sum::<f32>()));
        }
        skinning
    });
    let uvs = vec![Vec2::ZERO; vertices];
    Mesh { positions, uvs, normals, skinning, shapes, ..Mesh::default() }
}

/// A ball around `center`.
pub(crate) fn ball(center: Vec3, radius: f32, steps: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=steps {
        for column in 0..=2 * steps {
            let (u, v) = (column as f32 / (2 * steps) as f32, row as f32 / steps as f32);
            let (yaw, polar) = (u * std::f32::consts::TAU, v * std::f32::consts::PI);
            let normal = Vec3::new(polar.sin() * yaw.sin(), polar.cos(), polar.sin() * yaw.cos());
            mesh.positions.push(center + radius * normal);
            mesh.normals.push(normal);
            mesh.uvs.push(Vec2::new(u, v));
        }
    }
    let across = 2 * steps + 1;
    for row in 0..steps {
        for column in 0..2 * steps {
            let a = row * across + column;
            mesh.triangles.push([a, a + across, a + 1]);
            mesh.triangles.push([a + 1, a + across, a + across + 1]);
        }
    }
    mesh
}

/// The mesh mirrored at x = 0 with the indices of the original: every triangle contradicts its normals.
pub(crate) fn mirrored(mesh: &Mesh) -> Mesh {
    let flip = |v: &Vec3| Vec3::new(-v.x, v.y, v.z);
    Mesh {
        positions: mesh.positions.iter().map(flip).collect(),
        normals: mesh.normals.iter().map(flip).collect(),
        ..mesh.clone()
    }
}

/// A square that looks along +Z.
pub(crate) fn square(center: Vec3, half: f32) -> Mesh {
    let corner = |x: f32, y: f32| center + half * Vec3::new(x, y, 0.0);
    Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        uvs: vec![Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(1.0, 0.0), Vec2::new(0.0, 0.0)],
        normals: vec![Vec3::Z; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A rigid part without textures that follows bone 0.
pub(crate) fn part<'a>(mesh: &'a Mesh, kind: PartKind, textures: PartTextures<'a>) -> PartDesc<'a> {
    PartDesc { label: "part", mesh, first_weight: 0, kind, bones: PartBones::Rigid(0), textures }
}

/// A model of rigid parts and its state at bind pose.
pub(crate) fn model(gpu: &Gpu, parts: &[PartDesc<'_>]) -> (AvatarModel, AvatarState) {
    let model = AvatarModel::new(&gpu.device, &gpu.queue, parts, 1).expect("a valid model");
    let state = AvatarState::new(&gpu.device, &model);
    (model, state)
}

/// From the front, on black.
pub(crate) fn scene(distance: f32) -> Scene {
    Scene {
        camera: Camera::orbit(Vec3::ZERO, distance, 0.0, 0.0, 0.6, 1.0),
        background: [0.0, 0.0, 0.0, 1.0],
        light: Light::default(),
    }
}

/// White light from everywhere, alike: colours come out as the textures have them (but for tone mapping).
pub(crate) fn flat_light() -> Light {
    let off = Lamp { direction_world: Vec3::Z, radiance: [0.0; 3] };
    let environment = Environment::uniform([0.7; 3]);
    Light { key: off, fill: off, rim: off, environment, exposure: 1.0, tone_map: ToneMap::Neutral }
}

/// A checkered plate as an iris, and a cornea in front of it.
pub(crate) fn checkered_eye(gpu: &Gpu, with_cornea: bool) -> (AvatarModel, AvatarState) {
    let iris = square(Vec3::new(0.0, 0.0, -0.2), 1.5);
    let cornea = ball(Vec3::new(0.0, 0.0, -0.9), 1.2, 24);
    let checker = Image {
        width: 2,
        height: 2,
        rgba: [[200, 30, 30, 255], [20, 40, 200, 255], [20, 40, 200, 255], [200, 30, 30, 255]].concat(),
    };
    let textures = PartTextures { color: Some(&checker), ..PartTextures::default() };
    let mut parts = vec![part(&iris, PartKind::Eyeball, textures)];
    if with_cornea {
        // Given first: the order of the parts does not decide about the order of drawing.
        parts.insert(0, part(&cornea, PartKind::Cornea, PartTextures::default()));
    }
    model(gpu, &parts)
}

/// A picture of one colour.
pub(crate) fn plain(rgba: [u8; 4]) -> Image {
    Image { width: 1, height: 1, rgba: rgba.to_vec() }
}

/// The largest difference of two pictures in one channel.
pub(crate) fn largest_difference(a: &Image, b: &Image) -> u8 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    a.rgba.iter().zip(&b.rgba).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// Every shading that users choose, by name.
pub(crate) fn shadings() -> [(&'static str, Shading); 5] {
    let natural = |quality: Quality| quality.shading(Style::Natural);
    [
        ("plain", natural(Quality::Plain)),
        ("low", natural(Quality::Low)),
        ("medium", natural(Quality::Medium)),
        ("high", natural(Quality::High)),
        ("toon", Quality::High.shading(Style::Toon)),
    ]
}
