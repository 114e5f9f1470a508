//! A thousand faces, each on its way to a pose of its own, in one picture.
//!
//! `cargo run --release -p avatar-stage --example crowd [FILE]`
#![allow(clippy::disallowed_methods, reason = "an example is a program: it reads its arguments")]

use avatar_render::glam::{Affine3A, Vec3};
use avatar_render::headless::{Canvas, GpuOptions, open_blocking};
use avatar_render::{AvatarCrowd, Camera, Light, Quality, Scene, Style};
use avatar_stage::avatar_pack::{FaceCrowd, Pack, Textures};
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
    let model = upload_with_hair(&gpu.device, &gpu.queue, &pack, &Textures::load(&DefaultFace), None)?;
    let shading = Quality::of_adapter(&gpu.info).shading(Style::Natural);
    let canvas = Canvas::new(&gpu, WIDTH, HEIGHT, 4, shading)?;

    // Who moves them: each presses another pose, a third of a second before the picture.
    let mut players = PlayerCrowd::new(pack.controls(), FACES);
    let poses: Vec<_> = pack.poses().iter().collect();
    for face in 0..FACES {
        players.press(face, poses[face * 7 % poses.len()])?;
    }
    players.advance(1.0 / 3.0)?;

    // What that does to bones and shapes, and where each stands.
    let mut faces = FaceCrowd::new(&pack, FACES);
    faces.pose(&pack, &players)?;
    let mut avatars = AvatarCrowd::new(&gpu.device, &model, FACES)?;
    let mut bones = vec![Affine3A::IDENTITY; pack.palette().len()];
    let mut weights = vec![0.0; pack.shapes().len()];
    let size = pack.parts()[0].mesh.bounds().ok_or("an empty skin")?.size();
    for face in 0..FACES {
        faces.copy_bones(&pack, face, &mut bones)?;
        faces.copy_weights(face, &mut weights);
        let (column, row) = (face % COLUMNS, face / COLUMNS);
        let beside = (column as f32 - (COLUMNS - 1) as f32 / 2.0) * 1.2 * size.x;
        let behind = row as f32 * 1.5 * size.z;
        let place = Affine3A::from_translation(Vec3::new(beside, 0.0, -behind));
        bones.iter_mut().for_each(|bone| *bone = place * *bone);
        avatars.set(&model, face, &bones, &weights)?;
    }

    let target = Vec3::new(0.0, -0.5 * size.y, -6.0 * size.z);
    let camera = Camera::orbit(target, 12.0 * size.y, 0.25, 0.35, 0.5, WIDTH as f32 / HEIGHT as f32);
    let scene = Scene { camera, background: [0.02, 0.02, 0.03, 1.0], light: Light::studio() };
    let picture = canvas.render_crowds(&gpu, &scene, &[], &mut [(&model, &mut avatars)])?;
    let work = avatars.work();
    println!("{} of {FACES} faces in view, {} deformed: {file}", work.drawn, work.deformed);
    image::save_buffer(&file, &picture.rgba, picture.width, picture.height, image::ColorType::Rgba8)?;
    Ok(())
}
