use crate::cli::DeformArgs;
use crate::ending;
use crate::look_args::LookArgs;
use crate::offscreen::Offscreen;
use crate::output::{Contents, OutputFile};
use crate::standard;
use crate::usage;
use anyhow::Result;
use avatar_mesh::Deformed;
use avatar_mesh::obj::{self, ObjPart};
use avatar_pack::{FaceState, Pack, Textures};
use clap::ArgMatches;

pub(super) fn run(args: &DeformArgs, matches: &ArgMatches) -> Result<()> {
    ending::format(&args.out, None, &[("obj", ())], "")?;
    let out = OutputFile::check(&args.out, Contents::Text)?;
    let pack = super::open(&args.pack)?.load_pack()?;
    let parts = if args.world { (0..pack.parts().len()).collect() } else { vec![part(&pack, args)?] };
    let face = args.face.resolve(&pack, matches)?;

    let mut state = FaceState::new(&pack);
    face.apply(&pack, &mut state)?;
    let deformed: Vec<Deformed> = if args.gpu {
        let mut offscreen = Offscreen::open(&pack, &Textures::default(), 1, LookArgs::default())?;
        standard::tell(format_args!("adapter: {}", offscreen.adapter()));
        parts.iter().map(|part| offscreen.deform(&pack, &face, *part)).collect::<Result<_>>()?
    } else {
        parts.iter().map(|part| Ok(state.deform(&pack, *part)?)).collect::<Result<_>>()?
    };
    let triangles: Vec<_> = parts.iter().map(|part| state.triangles(&pack, *part)).collect();
    let objects: Vec<ObjPart<'_>> = (parts.iter().map(|part| &pack.parts()[*part]).zip(&deformed))
        .zip(&triangles)
        .map(|((part, deformed), triangles)| ObjPart {
            name: &part.name,
            positions: &deformed.positions,
            normals: &deformed.normals,
            // A single part is for comparing numbers.
            uvs: if args.world { &part.mesh.uvs } else { &[] },
            triangles,
        })
        .collect();
    out.write(obj::write_parts(&objects).as_bytes())
}

/// The part that was asked for. The default is the skin, or the first part if the avatar has no skin.
fn part(pack: &Pack, args: &DeformArgs) -> Result<usize> {
    match &args.part {
        Some(name) => usage::part(pack, name),
        None => Ok(pack.parts().iter().position(|part| part.name == "skin").unwrap_or(0)),
    }
}
