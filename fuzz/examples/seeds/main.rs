//! Writes the inputs that fuzzing begins with, as far as code makes them: `seeds FOLDER` puts them into a
//! folder for each target. Texts that people wrote lie in `fuzz/corpus` beside what was found.

use avatar_exchange::{fbx, glb};
use avatar_fuzz::SEPARATOR;
use avatar_pack::{MemorySource, Pack, Textures, export};
use image::{DynamicImage, ImageFormat, RgbaImage};
use std::error::Error;
use std::io::Cursor;
use std::path::Path;

mod binary_fbx;
#[path = "../../../crates/avatar-exchange/tests/all/support/random.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with tests")]
mod random;

/// How many random scenes; more of them do not reach more of the readers.
const SCENES: u64 = 24;
/// Larger ones are left out: fuzzing is fastest with small inputs.
const LARGEST: usize = 12_000;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("expected FOLDER")?;
    let write = |target: &str, name: &str, bytes: &[u8]| -> Result<(), Box<dyn Error>> {
        let folder = Path::new(&folder).join(target);
        std::fs::create_dir_all(&folder)?;
        Ok(std::fs::write(folder.join(name), bytes)?)
    };
    for seed in 0..SCENES {
        for (name, scene) in [("scene", random::scene(seed)), ("awkward", random::awkward(seed))] {
            let packed = packed(&glb::write_raw(&scene)?)?;
            if packed.len() < LARGEST {
                write("glb", &format!("{name}-{seed}"), &packed)?;
            }
        }
    }
    let face = export(&Pack::load(&golden()?)?, &Textures::default());
    write("glb", "face", &packed(&glb::write_raw(&face)?)?)?;
    let text = include_str!("../../../crates/avatar-exchange/tests/all/fbx/face.fbx");
    write("fbx", "text", text.as_bytes())?;
    let binary = binary_fbx::binary(text);
    fbx::read("seed.fbx", &binary, &mut |_| Err("no other files".to_owned()))?;
    write("fbx", "binary", &binary)?;
    write("poses", "default", pose_anim::DEFAULT_POSES_TOML.as_bytes())?;
    write("controls", "default", pose_anim::ControlTable::default_face().to_toml().as_bytes())?;
    write("materials", "default", avatar_look::Materials::EXAMPLE.as_bytes())?;
    write("hair", "default", avatar_groom::Hair::EXAMPLE.as_bytes())?;
    let picture = RgbaImage::from_fn(5, 3, |x, y| image::Rgba([(x * 50) as u8, (y * 80) as u8, 7, 255]));
    let picture = DynamicImage::ImageRgba8(picture);
    for (name, format, picture) in [
        ("png", ImageFormat::Png, picture.clone()),
        ("grey.png", ImageFormat::Png, DynamicImage::ImageLuma16(picture.to_luma16())),
        ("jpeg", ImageFormat::Jpeg, DynamicImage::ImageRgb8(picture.to_rgb8())),
        ("bmp", ImageFormat::Bmp, picture.clone()),
        ("webp", ImageFormat::WebP, picture.clone()),
        ("tga", ImageFormat::Tga, picture),
    ] {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format)?;
        write("picture", name, bytes.get_ref())?;
    }
    Ok(())
}

/// JSON, separator, the other chunk of a GLB.
fn packed(glb: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let word = |at: usize| Some(u32::from_le_bytes(*glb.get(at..)?.first_chunk()?) as usize);
    let json_length = word(12).ok_or("a GLB has a chunk of JSON")?;
    let mut packed = glb[20..20 + json_length].trim_ascii_end().to_vec();
    packed.push(SEPARATOR);
    packed.extend(glb.get(28 + json_length..).unwrap_or_default());
    Ok(packed)
}

fn golden() -> Result<MemorySource, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/golden/pack");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        source.files.insert(name, std::fs::read(&path)?);
    }
    Ok(source)
}
