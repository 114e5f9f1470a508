//! A pack's bytes become a picture: `cargo run -p avatar-stage --example picture -- [FOLDER [POSE [VIEW
//! [FILE]]]]`
#![allow(clippy::disallowed_methods, reason = "an example is a program: it reads its arguments and files")]

use avatar_stage::avatar_pack::{MemorySource, Pack, Textures};
use avatar_stage::avatar_render::AvatarState;
use avatar_stage::avatar_render::headless::{GpuOptions, open_blocking, render_image};
use avatar_stage::{BACKGROUND, NamedView, Performer, SAMPLES, upload};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut argument = |default: &str| arguments.next().unwrap_or_else(|| default.to_owned());
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(argument(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/marsienne")))?
    {
        let entry = entry?;
        source.files.insert(entry.file_name().to_string_lossy().into_owned(), std::fs::read(entry.path())?);
    }
    let gpu = open_blocking(GpuOptions::default())?;
    let mut face = Performer::new(Pack::load(&source)?);
    let model = upload(&gpu.device, &gpu.queue, face.pack(), &Textures::load(&source))?;
    let mut avatar = AvatarState::new(&gpu.device, &model);

    face.press(&argument("smile"))?;
    face.advance(f64::INFINITY)?; // until the face has arrived
    avatar.set(&gpu.queue, face.bones(), face.weights())?;

    let view = NamedView::from_name(&argument("front"))
        .ok_or("expected front, three-quarter, left, right or back")?;
    let scene = view.view().scene(face.pack(), 1.0, BACKGROUND, Default::default());
    let picture = render_image(&gpu, 512, 512, SAMPLES, &scene, &[(&model, &avatar)])?;
    image::RgbaImage::from_raw(512, 512, picture.rgba)
        .ok_or("a whole picture")?
        .save(argument("smile.png"))?;
    Ok(())
}
