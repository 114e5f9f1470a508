use crate::cli::RenderArgs;
use crate::film;
use crate::offscreen::Offscreen;
use crate::output::OutputFile;
use anyhow::Result;
use clap::ArgMatches;

pub(super) fn run(args: &RenderArgs, matches: &ArgMatches) -> Result<()> {
    let out = OutputFile::check(&args.out)?;
    let files = super::open(&args.pack)?;
    let pack = files.load_pack()?;
    let face = args.face.resolve(&pack, matches)?;
    let view = args.picture.view(&pack)?;
    let textures = files.load_textures();
    let mut offscreen = Offscreen::open(&pack, &textures, args.picture.samples, args.look)?;
    let picture = offscreen.picture(&pack, &face, view, args.size, args.picture.background.0)?;
    film::still(&out, &picture, &face.describe(&pack))
}
