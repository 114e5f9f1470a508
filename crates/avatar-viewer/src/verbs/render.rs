use crate::cli::{Background, RenderArgs};
use crate::offscreen::Offscreen;
use crate::output;
use crate::scene::View;
use anyhow::{Context, Result};
use clap::ArgMatches;
use image::{ImageFormat, RgbaImage};
use std::io::Cursor;

pub(super) fn run(args: &RenderArgs, matches: &ArgMatches) -> Result<()> {
    let files = super::open(&args.pack)?;
    let pack = files.load_pack()?;
    let face = args.face.resolve(&pack, matches)?;
    let textures = files.load_textures();
    let mut offscreen = Offscreen::open(&pack, &textures, args.samples)?;

    let view = View {
        yaw_degrees: args.yaw.unwrap_or(args.view.yaw_degrees()),
        pitch_degrees: args.pitch.unwrap_or(0.0),
        ..View::FRONT
    };
    let background = match args.background {
        Background::Transparent => [0; 4],
        Background::Color([red, green, blue]) => [red, green, blue, 255],
    };
    let picture = offscreen.picture(&pack, &face, view, args.size, background)?;
    output::write_file(&args.out, &png(&picture)?)
}

/// A picture as the bytes of a PNG.
pub(super) fn png(picture: &RgbaImage) -> Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).context("encoding the picture")?;
    Ok(bytes.into_inner())
}
