use crate::cli::DeformArgs;
use crate::look_args::LookArgs;
use crate::offscreen::Offscreen;
use crate::output::OutputFile;
use crate::usage;
use anyhow::Result;
use avatar_mesh::{Deformed, obj};
use avatar_pack::{FaceState, Pack, Part, Textures};
use clap::ArgMatches;

pub(super) fn run(args: &DeformArgs, matches: &ArgMatches) -> Result<()> {
    let out = OutputFile::check(&args.out)?;
    let pack = super::open(&args.pack)?.load_pack()?;
    let index = usage::part(&pack, &args.part)?;
    let part = &pack.parts[index];
    let face = args.face.resolve(&pack, matches)?;

    let deformed = if args.gpu {
        let mut offscreen = Offscreen::open(&pack, &Textures::default(), 1, LookArgs::default())?;
        eprintln!("adapter: {}", offscreen.adapter());
        offscreen.deform(&pack, &face, index)?
    } else {
        let mut state = FaceState::new(&pack);
        face.apply(&pack, &mut state)?;
        on_cpu(&pack, part, &state)?
    };
    let text = obj::write(&part.name, &deformed, &part.mesh.triangles);
    out.write(text.as_bytes())
}

fn on_cpu(pack: &Pack, part: &Part, state: &FaceState) -> Result<Deformed> {
    let mut deformed = part.mesh.deformed();
    let (bones, weights) = match part.bone {
        Some(bone) => (&state.bones()[bone..=bone], &[][..]),
        None => (state.bones(), &state.weights()[..pack.shapes.len()]),
    };
    avatar_mesh::deform(&part.mesh, bones, weights, &mut deformed)?;
    Ok(deformed)
}
