//! Saves a picture of a face made of three balls: `cargo run -p avatar-render --example render_png --
//! OUT.png`.
#![allow(clippy::disallowed_methods, reason = "a program: it reads its arguments")]

use avatar_mesh::{Mesh, PartKind};
use avatar_render::headless::{GpuOptions, open_blocking, render_image};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Image, Light, PartBones, PartDesc, PartTextures, Scene,
};
use glam::{Affine3A, Vec2, Vec3};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let out = std::env::args().nth(1).unwrap_or_else(|| "balls.png".to_owned());
    let gpu = open_blocking(GpuOptions::default())?;

    let head = ball(Vec3::ZERO, Vec3::new(0.85, 1.0, 0.9));
    let eyes = [-1.0, 1.0].map(|side| ball(Vec3::new(0.33 * side, 0.2, 0.62), Vec3::splat(0.24)));
    let corneas = [-1.0, 1.0].map(|side| ball(Vec3::new(0.33 * side, 0.2, 0.65), Vec3::splat(0.23)));
    let iris = iris();
    let part = |label, mesh, kind, color| PartDesc {
        label,
        mesh,
        first_weight: 0,
        kind,
        bones: PartBones::Rigid(0),
        textures: PartTextures { color, ..PartTextures::default() },
    };
    let parts = [
        part("head", &head, PartKind::Skin, None),
        part("right eye", &eyes[0], PartKind::Eyeball, Some(&iris)),
        part("left eye", &eyes[1], PartKind::Eyeball, Some(&iris)),
        part("right cornea", &corneas[0], PartKind::Cornea, None),
        part("left cornea", &corneas[1], PartKind::Cornea, None),
    ];
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &parts, 1)?;
    let mut state = AvatarState::new(&gpu.device, &model);
    state.set(&gpu.queue, &[Affine3A::from_rotation_y(0.2)], &[])?;

    let scene = Scene {
        camera: Camera::orbit(Vec3::ZERO, 4.5, 0.0, 0.1, 0.5, 4.0 / 3.0),
        background: [0.05, 0.06, 0.08, 1.0],
        light: Light::default(),
    };
    let picture = render_image(&gpu, 640, 480, 4, &scene, &[(&model, &state)])?;
    image::save_buffer(&out, &picture.rgba, picture.width, picture.height, image::ColorType::Rgba8)?;
    println!("{out}, drawn by {}", gpu.info.name);
    Ok(())
}

/// An ellipsoid whose texture looks along +Z with its middle.
fn ball(center: Vec3, radii: Vec3) -> Mesh {
    let (columns, rows) = (64, 32);
    let mut mesh = Mesh::default();
    for (row, column) in (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column))) {
        let uv = Vec2::new(column as f32 / columns as f32, row as f32 / rows as f32);
        let (yaw, polar) = ((uv.x - 0.5) * std::f32::consts::TAU, uv.y * std::f32::consts::PI);
        let direction = Vec3::new(polar.sin() * yaw.sin(), polar.cos(), polar.sin() * yaw.cos());
        mesh.positions.push(center + radii * direction);
        mesh.normals.push((direction / radii).normalize_or(direction));
        mesh.uvs.push(uv);
    }
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let a = row * (columns + 1) + column;
        let below = a + columns + 1;
        mesh.triangles.extend([[a, below, a + 1], [a + 1, below, below + 1]]);
    }
    mesh
}

/// An iris in the middle of a white picture, twice as wide as high.
fn iris() -> Image {
    let (width, height) = (512, 256);
    let pixel = |x: u32, y: u32| {
        let from_middle = Vec2::new(x as f32 + 0.5 - 256.0, y as f32 + 0.5 - 128.0).length();
        match from_middle {
            r if r < 16.0 => [8, 8, 10, 255],
            r if r < 38.0 => [70, 110, 130, 255],
            r if r < 42.0 => [30, 45, 55, 255],
            _ => [225, 222, 215, 255],
        }
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    Image { width, height, rgba: pixels.flat_map(|(x, y)| pixel(x, y)).collect() }
}
