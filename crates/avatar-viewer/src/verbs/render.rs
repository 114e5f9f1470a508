use crate::cli::RenderArgs;
use crate::offscreen::Offscreen;
use crate::output::OutputFile;
use crate::scene::View;
use crate::usage;
use anyhow::{Context, Result};
use clap::ArgMatches;
use image::{ImageFormat, RgbaImage};
use std::io::Cursor;

pub(super) fn run(args: &RenderArgs, matches: &ArgMatches) -> Result<()> {
    let out = OutputFile::check(&args.out)?;
    let files = super::open(&args.pack)?;
    let pack = files.load_pack()?;
    let face = args.face.resolve(&pack, matches)?;
    let part = args.frame.as_deref().map(|name| usage::part(&pack, name)).transpose()?;
    let textures = files.load_textures();
    let mut offscreen = Offscreen::open(&pack, &textures, args.samples, args.look)?;

    let mut view = View { part, ..args.view.view() };
    view.yaw_degrees = args.yaw.unwrap_or(view.yaw_degrees);
    view.pitch_degrees = args.pitch.unwrap_or(view.pitch_degrees);
    let picture = offscreen.picture(&pack, &face, view, args.size, args.background.0)?;
    out.write(&png(&picture)?)
}

/// A picture as the bytes of a PNG.
pub(super) fn png(picture: &RgbaImage) -> Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).context("encoding the picture")?;
    Ok(bytes.into_inner())
}
