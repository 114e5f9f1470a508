use crate::cli::ConvertArgs;
use crate::ending;
use crate::files::Files;
use crate::output::{Contents, OutputFile, OutputFolder, is_nameless};
use crate::standard;
use crate::usage::usage;
use anyhow::{Result, anyhow};
use avatar_exchange::glb;
use avatar_mesh::obj::{self, ObjPart};
use avatar_pack::{ExportTarget, FaceState, Pack, Texture, retarget};
use clap::ArgMatches;
use face_space::{Route, Standard};
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
    let target = Target::of(path, args.format.as_deref())?;
    if args.shapes.is_some() && target != Target::Glb {
        return Err(usage("expected --shapes with a .glb, which has morph targets, found another format"));
    }
    match target {
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
            match args.shapes {
                Some(space) => out.write(&with_shapes(&files, &pack, space)?),
                None => out.write(&glb(&files, &pack)?),
            }
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

/// The avatar with the morph targets of a space in place of its own.
fn with_shapes(files: &Files, pack: &Pack, space: Standard) -> Result<Vec<u8>> {
    let Some(mut way) = Route::between(space, Standard::ArKit) else {
        return Err(anyhow!("expected a way from {} to arkit, found none", space.key()));
    };
    let mut retarget = retarget(pack);
    let (mut said, mut arkit) = (space.space().rest(), Standard::ArKit.space().rest());
    let mut targets = Vec::new();
    for (place, name) in space.space().names().iter().enumerate() {
        said[place] = name.max;
        way.apply(&said, &mut arkit);
        said[place] = name.rest;
        let mut values = pack.controls().defaults();
        retarget.apply_arkit(&arkit, &mut values);
        targets.push(ExportTarget { name: name.name.clone(), values });
    }
    let rest = pack.controls().defaults();
    let still: Vec<&str> =
        targets.iter().filter(|target| target.values == rest).map(|target| target.name.as_str()).collect();
    if still.len() == targets.len() {
        return Err(anyhow!(
            "{}: expected a face that can show names of {}, found none",
            files.name(),
            space.key()
        ));
    }
    if !still.is_empty() {
        standard::warn(format_args!(
            "the face does not show, and the file does not have: {}",
            still.join(", ")
        ));
    }
    let raw = avatar_pack::export_targets(pack, &files.load_textures(&Texture::ALL), &targets);
    raw.notes.iter().for_each(standard::warn);
    glb::write_raw(&raw).map_err(|error| anyhow!("{}: {error}", files.name()))
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
