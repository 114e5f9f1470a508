use crate::cli::ConvertArgs;
use crate::ending;
use crate::files::Files;
use crate::output::{Contents, OutputFile, OutputFolder, is_nameless};
use crate::standard;
use crate::usage::usage;
use anyhow::{Result, anyhow};
use avatar_exchange::glb;
use avatar_mesh::obj::{self, ObjPart};
use avatar_pack::{FaceState, Pack, Texture};
use clap::ArgMatches;
use std::path::Path;

/// What can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Target {
    Glb,
    Obj,
    /// A pack in the raw format.
    Folder,
}

impl Target {
    fn of(path: &Path, asked: Option<&str>) -> Result<Self> {
        let named_as_folder = path.to_string_lossy().ends_with(std::path::is_separator);
        let is_folder = named_as_folder || path.extension().is_none() || path.is_dir();
        if is_folder && !is_nameless(path) && asked.is_none() {
            return Ok(Self::Folder);
        }
        let endings = &[("glb", Self::Glb), ("obj", Self::Obj)];
        ending::format(path, asked, endings, ", or (with a separator at its end) that of a new folder")
    }
}

pub(super) fn run(args: &ConvertArgs, matches: &ArgMatches) -> Result<()> {
    let Some(path) = args.out.as_ref().or(args.target.as_ref()) else {
        return Err(usage("expected the file to write, as a second name or after --out, found none"));
    };
    match Target::of(path, args.format.as_deref())? {
        Target::Folder => {
            at_rest(args)?;
            let out = OutputFolder::check(path)?;
            let files = super::open(&args.pack)?;
            let pack = files.load_pack()?;
            let raw = avatar_pack::raw_files(&pack, &files.load_textures(&Texture::ALL));
            let raw = raw.map_err(|error| anyhow!("{}: {error}", files.name()))?;
            raw.notes.iter().for_each(standard::warn);
            out.write(&raw.files)
        }
        Target::Glb => {
            at_rest(args)?;
            let out = OutputFile::check(path, Contents::Binary("GLB"))?;
            let files = super::open(&args.pack)?;
            let pack = files.load_pack()?;
            out.write(&glb(&files, &pack)?)
        }
        Target::Obj => {
            let out = OutputFile::check(path, Contents::Text)?;
            let pack = super::open(&args.pack)?.load_pack()?;
            let mut state = FaceState::new(&pack);
            args.face.resolve(&pack, matches)?.apply(&pack, &mut state)?;
            out.write(world_obj(&pack, &state)?.as_bytes())
        }
    }
}

/// A rig is written at rest, so a pose in the options is reported as an error.
fn at_rest(args: &ConvertArgs) -> Result<()> {
    match args.face.is_given() {
        true => {
            Err(usage("expected no pose, --set, --rotate or --clip, which only .obj can show, found one"))
        }
        false => Ok(()),
    }
}

/// A file's scene as it is; of a pack rig, parts, shapes, and its poses as clips.
fn glb(files: &Files, pack: &Pack) -> Result<Vec<u8>> {
    let written = match files.read_scene()? {
        Some(scene) => {
            if !scene.drivers.is_empty() {
                standard::warn(
                    "sliders of in-between and corrective shapes are left out, each shape is one of its own",
                );
            }
            if files.is_vrm() {
                standard::warn("roles of bones, expressions and look-at are left out");
            }
            glb::write(&avatar_pack::portable_pictures(&scene))
        }
        None => {
            let raw = avatar_pack::export(pack, &files.load_textures(&Texture::ALL));
            raw.notes.iter().for_each(standard::warn);
            if !pack.clips().clips.is_empty() {
                standard::warn("clips of controls are left out: poses are the clips of the file");
            }
            glb::write_raw(&raw)
        }
    };
    written.map_err(|error| anyhow!("{}: {error}", files.name()))
}

/// All parts in world space, one object each.
pub(super) fn world_obj(pack: &Pack, state: &FaceState) -> Result<String> {
    if pack.parts().is_empty() {
        return Err(anyhow!("expected a mesh to write, found a skeleton alone"));
    }
    let deformed: Vec<_> =
        (0..pack.parts().len()).map(|part| Ok(state.deform(pack, part)?)).collect::<Result<_>>()?;
    let triangles: Vec<_> = (0..pack.parts().len()).map(|part| state.triangles(pack, part)).collect();
    let parts: Vec<ObjPart<'_>> = (pack.parts().iter().zip(&deformed).zip(&triangles))
        .map(|((part, deformed), triangles)| ObjPart {
            name: &part.name,
            positions: &deformed.positions,
            normals: &deformed.normals,
            uvs: &part.mesh.uvs,
            triangles,
        })
        .collect();
    Ok(obj::write_parts(&parts))
}
