use crate::cli::ConvertArgs;
use crate::files::Files;
use crate::output::OutputFile;
use crate::usage::usage;
use anyhow::{Result, anyhow};
use avatar_exchange::glb;
use avatar_mesh::obj::{self, ObjPart};
use avatar_pack::{FaceState, Pack};
use clap::ArgMatches;
use std::path::Path;

/// What can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Target {
    Glb,
    Obj,
}

impl Target {
    fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("glb") => Ok(Self::Glb),
            Some("obj") => Ok(Self::Obj),
            _ => Err(usage(format!(
                "--out: expected a name that ends in .glb or .obj, found {:?}",
                path.display().to_string()
            ))),
        }
    }
}

pub(super) fn run(args: &ConvertArgs, matches: &ArgMatches) -> Result<()> {
    let target = Target::of(&args.out)?;
    let out = OutputFile::check(&args.out)?;
    let files = super::open(&args.pack)?;
    let pack = files.load_pack()?;
    let face = args.face.resolve(&pack, matches)?;
    let bytes = match target {
        Target::Glb => glb(&files, &pack)?,
        Target::Obj => {
            let mut state = FaceState::new(&pack);
            face.apply(&pack, &mut state)?;
            world_obj(&pack, &state)?.into_bytes()
        }
    };
    out.write(&bytes)
}

/// A file's scene as it is; of a pack rig, parts, shapes, and its poses as clips.
fn glb(files: &Files, pack: &Pack) -> Result<Vec<u8>> {
    let written = match &pack.motion {
        Some(motion) => glb::write(motion.scene()),
        None => {
            let raw = avatar_pack::export(pack, &files.load_textures());
            glb::write_raw(&raw)
        }
    };
    written.map_err(|error| anyhow!("{}: {error}", files.name()))
}

/// All parts in world space, one object each.
pub(super) fn world_obj(pack: &Pack, state: &FaceState) -> Result<String> {
    let deformed: Vec<_> =
        (0..pack.parts.len()).map(|part| Ok(state.deform(pack, part)?)).collect::<Result<_>>()?;
    let parts: Vec<ObjPart<'_>> = (pack.parts.iter().zip(&deformed))
        .map(|(part, deformed)| ObjPart {
            name: &part.name,
            positions: &deformed.positions,
            normals: &deformed.normals,
            uvs: &part.mesh.uvs,
            triangles: &part.mesh.triangles,
        })
        .collect();
    Ok(obj::write_parts(&parts))
}
