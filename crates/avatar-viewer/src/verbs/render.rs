use crate::cli::RenderArgs;
use crate::ending;
use crate::offscreen::Offscreen;
use crate::output::{Contents, OutputFile};
use crate::picture_file::{self, PictureFormat};
use anyhow::Result;
use clap::ArgMatches;

pub(super) fn run(args: &RenderArgs, matches: &ArgMatches) -> Result<()> {
    let format = ending::format(&args.out, args.format.as_deref(), PictureFormat::ENDINGS, "")?;
    format.check([args.size.width, args.size.height], args.picture.background.0)?;
    let out = OutputFile::check(&args.out, Contents::Binary("a picture"))?;
    let files = super::open(&args.pack)?;
    let pack = files.load_pack()?;
    let face = args.face.resolve(&pack, matches)?;
    let view = args.picture.view(&pack)?;
    let level = args.lod.level(&pack, &args.look, &view, args.size.sides(), 1);
    let mut offscreen = Offscreen::of_files(&files, &level, args.size, args.picture.samples, args.look)?;
    let picture = offscreen.picture(&pack, &face, view, args.size, args.picture.background.0)?;
    picture_file::still(&out, format, &picture, &face.describe(&pack))
}
