use crate::cli::StrandsArgs;
use crate::ending;
use crate::look_args::LookArgs;
use crate::offscreen::Offscreen;
use crate::output::{Contents, OutputFile};
use crate::standard;
use anyhow::Result;
use avatar_groom::PlantedStrand;
use avatar_pack::Texture;
use clap::ArgMatches;
use serde_json::json;

pub(super) fn run(args: &StrandsArgs, matches: &ArgMatches) -> Result<()> {
    ending::format(&args.out, None, &[("json", ())], "")?;
    let out = OutputFile::check(&args.out, Contents::Text)?;
    let files = super::open(&args.pack)?;
    let pack = files.load_pack()?;
    let face = args.face.resolve(&pack, matches)?;
    let textures = files.load_textures(&Texture::DRAWN);
    let look = LookArgs::with_hair(args.hair);
    let mut offscreen = Offscreen::open(&pack, &textures, 1, look)?;
    let strands = offscreen.strands(&pack, &face)?;
    let hair = args.hair.choose(pack.hair());
    let groom = hair.and_then(|hair| pack.groom(&textures, &hair));
    let planted = groom.as_ref().map_or(&[][..], |(_, groom)| groom.strands());
    if strands.is_empty() {
        standard::warn(
            "expected hair to grow, found none: --hair is off, density is 0, or the pack has no HairMap",
        );
    }
    let strands: Vec<_> = (planted.iter().zip(&strands))
        .take(args.limit.unwrap_or(usize::MAX))
        .map(|(PlantedStrand { root, .. }, points)| {
            let points: Vec<_> = points.iter().map(|point| point.to_array()).collect();
            json!({ "triangle": root.triangle, "barycentric": root.barycentric, "points": points })
        })
        .collect();
    out.write(format!("{}\n", json!({ "strands": strands })).as_bytes())
}
