use crate::cli::DeformArgs;
use crate::output;
use crate::usage::unknown;
use anyhow::Result;
use avatar_mesh::{Deformed, obj};
use avatar_pack::{FaceState, Pack, Part};
use clap::ArgMatches;

pub(super) fn run(args: &DeformArgs, matches: &ArgMatches) -> Result<()> {
    let pack = super::open(&args.pack)?.load_pack()?;
    let part = pack.part(&args.part);
    let part = part.ok_or_else(|| unknown("part", &args.part, pack.parts.iter().map(|part| part.spec.name)))?;
    let mut state = FaceState::new(&pack);
    args.face.resolve(&pack, matches)?.apply(&pack, &mut state)?;

    let deformed = if args.gpu { anyhow::bail!("not yet") } else { on_cpu(&pack, part, &state)? };
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
