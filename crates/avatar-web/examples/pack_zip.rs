//! Makes one file of a pack's folder, for a page: `pack_zip FOLDER OUT.zip [UNPACKED]`. Numbers stay as they
//! are, packed by xz; pictures that a face is drawn with become JPEG where that is smaller and changes
//! little, others are left out. What is in the file goes to the folder UNPACKED as well, if there is to be
//! one.

#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "a program may use files")]

use avatar_stage::avatar_pack::Texture;
use avatar_stage::avatar_pack::files::RIG_NAMES;
use image::codecs::jpeg::JpegEncoder;
use std::error::Error;
use std::io::{Cursor, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Of a hundred.
const QUALITY: u8 = 95;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let (Some(folder), Some(out)) = (args.next(), args.next()) else {
        return Err("expected a pack's folder and a file to write: pack_zip FOLDER OUT.zip".into());
    };
    let unpacked = args.next();
    let mut names = Vec::new();
    for entry in std::fs::read_dir(&folder)? {
        names.push(entry?.file_name().into_string().map_err(|name| format!("{name:?}: expected UTF-8"))?);
    }
    names.sort();
    if !names.iter().any(|name| RIG_NAMES.contains(&name.as_str())) {
        return Err(format!("{folder}: expected the folder of a pack, found none of {RIG_NAMES:?}").into());
    }
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for name in names {
        let bytes = std::fs::read(Path::new(&folder).join(&name))?;
        let (stem, ending) = name.rsplit_once('.').unwrap_or((&name, ""));
        let is_picture = ["png", "jpg", "jpeg"].contains(&ending);
        if is_picture && !Texture::DRAWN.iter().any(|texture| texture.stem() == stem) {
            continue;
        }
        // The same file gives the same bytes: times are not kept.
        let options = SimpleFileOptions::default();
        let (name, bytes, method) = match is_picture {
            true => match smaller(&bytes)? {
                Some(jpeg) => (format!("{stem}.jpg"), jpeg, CompressionMethod::Stored),
                None => (name, bytes, CompressionMethod::Stored),
            },
            false => (name, bytes, CompressionMethod::Xz),
        };
        let level = (method == CompressionMethod::Xz).then_some(6);
        if let Some(unpacked) = &unpacked {
            std::fs::create_dir_all(unpacked)?;
            std::fs::write(Path::new(unpacked).join(&name), &bytes)?;
        }
        zip.start_file(name, options.compression_method(method).compression_level(level))?;
        zip.write_all(&bytes)?;
    }
    let bytes = zip.finish()?.into_inner();
    println!("{out}: {} bytes", bytes.len());
    Ok(std::fs::write(out, bytes)?)
}

/// The picture as JPEG, if it is large, has colours and no alpha, and becomes smaller by half.
fn smaller(bytes: &[u8]) -> Result<Option<Vec<u8>>, Box<dyn Error>> {
    let image = image::load_from_memory(bytes)?;
    if image.color() != image::ColorType::Rgb8 || bytes.len() < 200_000 {
        return Ok(None);
    }
    let mut jpeg = Vec::new();
    image.write_with_encoder(JpegEncoder::new_with_quality(&mut jpeg, QUALITY))?;
    Ok(Some(jpeg).filter(|jpeg| jpeg.len() < bytes.len() / 2))
}
