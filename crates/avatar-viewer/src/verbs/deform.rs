use crate::cli::DeformArgs;
use crate::offscreen::Offscreen;
use crate::output;
use crate::usage::unknown;
use anyhow::Result;
use avatar_mesh::{Deformed, obj};
use avatar_pack::{FaceState, Pack, Part, Textures};
use clap::ArgMatches;

pub(super) fn run(args: &DeformArgs, matches: &ArgMatches) -> Result<()> {
    let pack = super::open(&args.pack)?.load_pack()?;
    let part = pack.part(&args.part);
    let part =
        part.ok_or_else(|| unknown("part", &args.part, pack.parts.iter().map(|part| part.spec.name)))?;
    let face = args.face.resolve(&pack, matches)?;

    let deformed = if args.gpu {
        let mut offscreen = Offscreen::open(&pack, &Textures::default(), 1)?;
        eprintln!("adapter: {}", offscreen.adapter());
        let index = pack.parts.iter().position(|other| other.spec.name == part.spec.name).unwrap_or(0);
        offscreen.deform(&pack, &face, index)?
    } else {
        let mut state = FaceState::new(&pack);
        face.apply(&pack, &mut state)?;
        on_cpu(&pack, part, &state)?
    };
    let text = obj::write(part.spec.name, &deformed, &part.mesh.triangles);
    output::write_file(&args.out, text.as_bytes())
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
