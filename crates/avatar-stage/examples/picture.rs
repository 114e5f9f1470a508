//! The files of a pack become a picture, smile.png: `cargo run -p avatar-stage --example picture`
#![allow(clippy::disallowed_methods, reason = "an example is a program: it reads files")]

use avatar_stage::avatar_pack::{MemorySource, Pack, Textures};
use avatar_stage::avatar_render::AvatarState;
use avatar_stage::avatar_render::headless::{GpuOptions, open_blocking, render_image};
use avatar_stage::{Performer, SAMPLES, portrait, upload};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/marsienne"))? {
        let entry = entry?;
        source.files.insert(entry.file_name().to_string_lossy().into_owned(), std::fs::read(entry.path())?);
    }
    let gpu = open_blocking(GpuOptions::default())?;
    let mut face = Performer::new(Pack::load(&source)?);
    let model = upload(&gpu.device, &gpu.queue, face.pack(), &Textures::load(&source))?;
    let mut avatar = AvatarState::new(&gpu.device, &model);

    face.press("smile")?;
    face.advance(f64::INFINITY)?; // until the face has arrived
    avatar.set(&gpu.queue, face.bones(), face.weights())?;
    let picture = render_image(&gpu, 512, 512, SAMPLES, &portrait(face.pack(), 1.0), &[(&model, &avatar)])?;
    image::save_buffer("smile.png", &picture.rgba, 512, 512, image::ColorType::Rgba8)?;
    Ok(())
}
