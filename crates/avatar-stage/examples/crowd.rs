//! A thousand faces, each on its way to a pose of its own, in one picture: a crowd for each level of detail,
//! and each face in the crowd of its height in the picture.
//!
//! `cargo run --release -p avatar-stage --example crowd [FILE]`
#![allow(clippy::disallowed_methods, reason = "an example is a program: it reads its arguments")]

use avatar_render::glam::{Affine3A, Vec3};
use avatar_render::headless::{Canvas, GpuOptions, open_blocking};
use avatar_render::{AvatarCrowd, Camera, Light, Quality, Scene, Style};
use avatar_stage::avatar_pack::{FaceCrowd, Level, Pack, Textures};
use avatar_stage::{DefaultFace, pose_anim::PlayerCrowd, upload_with_hair};

const FACES: usize = 1000;
const COLUMNS: usize = 40;
const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).unwrap_or_else(|| "crowd.png".to_owned());
    let pack = Pack::load(&DefaultFace)?;
    let gpu = open_blocking(GpuOptions::default())?;
    // Crowds have no hair.
    let textures = Textures::load(&DefaultFace);
    let upload = |pack: &Pack| upload_with_hair(&gpu.device, &gpu.queue, pack, &textures, None);
    let mut models = vec![upload(&pack)?];
    for level in Level::all(&pack, false) {
        models.push(upload(&level.pack)?);
    }
    let shading = Quality::of_adapter(&gpu.info).shading(Style::Natural);
    let canvas = Canvas::new(&gpu, WIDTH, HEIGHT, 4, shading)?;

    // Who moves them: each presses another pose, a third of a second before the picture.
    let mut players = PlayerCrowd::new(pack.controls(), FACES);
    let poses: Vec<_> = pack.poses().iter().collect();
    for face in 0..FACES {
        players.press(face, poses[face * 7 % poses.len()])?;
    }
    players.advance(1.0 / 3.0)?;

    // Where each stands, and with how much detail it is drawn there.
    let size = pack.bounds().ok_or("an empty avatar")?.size();
    let places: Vec<Vec3> = (0..FACES)
        .map(|face| {
            let (column, row) = (face % COLUMNS, face / COLUMNS);
            let beside = (column as f32 - (COLUMNS - 1) as f32 / 2.0) * 1.2 * size.x;
            Vec3::new(beside, 0.0, row as f32 * -1.5 * size.z)
        })
        .collect();
    let target = Vec3::new(0.0, -0.5 * size.y, -6.0 * size.z);
    let camera = Camera::orbit(target, 12.0 * size.y, 0.25, 0.35, 0.5, WIDTH as f32 / HEIGHT as f32);
    let level = |place: &Vec3| {
        let distance = place.distance(camera.eye()) - size.length();
        let pixels = HEIGHT as f32 / (2.0 * distance.max(0.0) * (camera.vertical_fov_rad / 2.0).tan());
        Level::for_pixels(&pack, pixels)
    };
    let levels: Vec<usize> = places.iter().map(level).collect();

    // What the players do to bones and shapes.
    let mut faces = FaceCrowd::new(&pack, FACES);
    faces.pose(&pack, &players)?;
    let mut bones = vec![Affine3A::IDENTITY; pack.palette().len()];
    let mut weights = vec![0.0; pack.shapes().len()];
    let mut crowds = Vec::new();
    for (level, model) in models.iter().enumerate() {
        let own: Vec<usize> = (0..FACES).filter(|face| levels[*face] == level).collect();
        let mut avatars = AvatarCrowd::new(&gpu.device, model, own.len())?;
        for (avatar, face) in own.into_iter().enumerate() {
            faces.copy_bones(&pack, face, &mut bones)?;
            faces.copy_weights(face, &mut weights);
            let place = Affine3A::from_translation(places[face]);
            bones.iter_mut().for_each(|bone| *bone = place * *bone);
            avatars.set(model, avatar, &bones, &weights)?;
        }
        crowds.push(avatars);
    }

    let scene = Scene { camera, background: [0.02, 0.02, 0.03, 1.0], light: Light::studio() };
    let mut drawn: Vec<_> = models.iter().zip(&mut crowds).collect();
    let picture = canvas.render_crowds(&gpu, &scene, &[], &mut drawn)?;
    for (level, crowd) in crowds.iter().enumerate().filter(|(_, crowd)| !crowd.is_empty()) {
        println!("level {level}: {} of {} faces in view", crowd.work().drawn, crowd.len());
    }
    image::save_buffer(&file, &picture.rgba, picture.width, picture.height, image::ColorType::Rgba8)?;
    Ok(())
}
