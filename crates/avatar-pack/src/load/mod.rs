//! Loads packs in the raw format, and single files of them.

mod bust;
mod further;

pub(crate) use bust::head as head_of;

use crate::files;
use crate::{
    ContentsError, Identity, Pack, PackContents, PackError, PackProblem, PaletteBone, Part, Source, Springs,
    Warning,
};
use avatar_groom::Hair;
use avatar_look::Materials;
use avatar_mesh::{FACE_BONES, FACE_PARTS, Follows, MeshError, PartKind, PartSpec, Winding, raw};
use pose_anim::{ClipSet, ControlTable, PoseSet};
use rig_core::Rig;
use std::borrow::Cow;

impl Pack {
    /// Loads a pack in the raw format.
    ///
    /// # Errors
    /// The first file that is missing, unreadable or not as the format demands, and where in it.
    pub fn load(source: &impl Source) -> Result<Self, PackError> {
        let (rig_file, rig) = load_rig(source)?;
        let palette = load_palette(source, rig_file, &rig)?;
        let mut warnings = Vec::new();
        let mut parts = FACE_PARTS
            .iter()
            .map(|spec| load_part(source, *spec, &mut warnings))
            .collect::<Result<Vec<_>, _>>()?;

        let mut controls = load_controls(source)?;
        let further = further::load(source, &mut controls, &mut parts)?;
        let poses = load_poses(source, &controls)?;
        let clips = load_clips(source, &controls)?;
        let springs = load_springs(source, &rig)?;
        let skin = parts.iter().find(|part| part.kind == PartKind::Skin);
        let head = skin.and_then(|skin| bust::head(&skin.mesh, skin.bounds?));
        let contents = PackContents {
            rig,
            parts,
            palette,
            shapes: further.names,
            sliders: further.sliders,
            further_shapes: further.list,
            identity: load_identity(source)?,
            springs,
            controls,
            poses,
            clips,
            materials: load_materials(source)?,
            hair: load_hair(source)?,
            motion: None,
            look_rule: None,
            face: head,
            head,
            warnings,
        };
        Self::new(contents).map_err(|error| match error {
            ContentsError::Bind(error) => at(source, files::CONTROLS, PackProblem::Bind(error)),
            error => at(source, rig_file, PackProblem::Contents(error)),
        })
    }
}

/// The poses that a pack says, or the default set: what [`Pack::load`] takes for [`Pack::poses`], alone.
///
/// # Errors
/// A file of that name that is unreadable or not as its format demands, and where in it.
pub fn load_poses(source: &impl Source, controls: &ControlTable) -> Result<PoseSet, PackError> {
    match read_text(source, files::POSES)? {
        None => Ok(PoseSet::default_face(controls)),
        Some(text) => PoseSet::from_toml(&text, controls)
            .map_err(|error| at(source, files::POSES, PackProblem::Toml(error))),
    }
}

/// The clips that a pack says; none without `clips.toml`.
///
/// # Errors
/// A file of that name that is unreadable or not as its format demands, and where in it.
pub fn load_clips(source: &impl Source, controls: &ControlTable) -> Result<ClipSet, PackError> {
    match read_text(source, files::CLIPS)? {
        None => Ok(ClipSet::default()),
        Some(text) => ClipSet::from_toml(&text, controls)
            .map_err(|error| at(source, files::CLIPS, PackProblem::Toml(error))),
    }
}

fn at(source: &impl Source, name: &str, problem: PackProblem) -> PackError {
    PackError { file: source.locate(name), problem: problem.into() }
}

fn read<'a>(source: &'a impl Source, name: &str) -> Result<Option<Cow<'a, [u8]>>, PackError> {
    source.read(name).map_err(|error| at(source, name, PackProblem::Unreadable(error)))
}

fn read_needed<'a>(source: &'a impl Source, name: &str) -> Result<Cow<'a, [u8]>, PackError> {
    read(source, name)?.ok_or_else(|| at(source, name, PackProblem::Missing(name.to_owned())))
}

fn read_text(source: &impl Source, name: &str) -> Result<Option<String>, PackError> {
    let Some(bytes) = read(source, name)? else { return Ok(None) };
    match std::str::from_utf8(&bytes) {
        Ok(text) => Ok(Some(text.strip_prefix('\u{feff}').unwrap_or(text).to_owned())),
        Err(error) => Err(at(source, name, PackProblem::NotText { offset: error.valid_up_to() })),
    }
}

fn load_rig(source: &impl Source) -> Result<(&'static str, Rig), PackError> {
    for name in files::RIG_NAMES {
        if let Some(bytes) = read(source, name)? {
            let rig = Rig::from_xml(&bytes).map_err(|error| at(source, name, PackProblem::Rig(error)))?;
            return Ok((name, rig));
        }
    }
    Err(at(source, files::RIG, PackProblem::Missing(files::RIG_NAMES.join(" or "))))
}

fn load_palette(source: &impl Source, rig_file: &str, rig: &Rig) -> Result<Vec<PaletteBone>, PackError> {
    let bone = |name: &&str| {
        let joint = rig.joint(name).ok_or_else(|| {
            let problem =
                PackProblem::MissingJoint { joint: (*name).to_owned(), found: rig.names().to_vec() };
            at(source, rig_file, problem)
        })?;
        Ok(PaletteBone { joint, joint_from_mesh: rig.bind_from_world()[joint.index()] })
    };
    FACE_BONES.iter().map(bone).collect()
}

fn load_part(source: &impl Source, spec: PartSpec, warnings: &mut Vec<Warning>) -> Result<Part, PackError> {
    let (vertex_file, index_file) = (files::vertices(&spec), files::triangles(&spec));
    let vertices = read_needed(source, &vertex_file)?;
    let indices = read_needed(source, &index_file)?;
    let blame = |error: MeshError| {
        let file = match error {
            MeshError::PartialElement { element: "triangles", .. } | MeshError::IndexOutOfRange { .. } => {
                &index_file
            }
            _ => &vertex_file,
        };
        at(source, file, PackProblem::Mesh(error))
    };
    let (mut mesh, bone) = match spec.follows {
        Follows::Bones => (raw::read_skin(&vertices, &indices).map_err(blame)?, None),
        Follows::Joint(joint) => {
            let bone = FACE_BONES.iter().position(|name| *name == joint);
            (raw::read_rigid(&vertices, &indices).map_err(blame)?, bone)
        }
    };
    for warning in mesh.validate(FACE_BONES.len()).map_err(blame)? {
        warnings.push(Warning::Mesh { file: source.locate(&vertex_file), warning });
    }
    if let Some(winding) = Winding::of_inside_out(&mesh) {
        warnings.push(Warning::InsideOut {
            part: spec.name.to_owned(),
            contradicting: winding.contradicting,
            triangles: mesh.triangles.len(),
        });
    }
    Ok(Part {
        name: spec.name.to_owned(),
        kind: spec.kind,
        bounds: mesh.bounds(),
        mesh,
        first_shape: 0,
        bytes: vertices.len() + indices.len(),
        bone,
        material: None,
    })
}

/// Reads the looks of a pack's parts: `materials.toml`, or the defaults where there is none. [`Pack::load`]
/// calls it; by itself it serves programs that take over a changed file while they run.
///
/// # Errors
/// A file that cannot be read, or that is not as its format demands, and where in it.
pub fn load_materials(source: &impl Source) -> Result<Materials, PackError> {
    let file = files::MATERIALS;
    match read_text(source, file)? {
        None => Ok(Materials::default()),
        Some(text) => Materials::from_toml(&text).map_err(|error| at(source, file, PackProblem::Look(error))),
    }
}

/// Reads which hair a pack has: `hair.toml`, or `None` where there is none. [`Pack::load`] calls it; by
/// itself it serves programs that take over a changed file while they run.
///
/// # Errors
/// A file that cannot be read, or that is not as its format demands, and where in it.
pub fn load_hair(source: &impl Source) -> Result<Option<Hair>, PackError> {
    let file = files::HAIR;
    let hair = read_text(source, file)?.map(|text| Hair::from_toml(&text)).transpose();
    hair.map_err(|error| at(source, file, PackProblem::Hair(error)))
}

/// What swings by itself; nothing without `springs.toml`. [`Pack::load`] calls it; by itself it serves
/// programs that take over a changed file while they run.
///
/// # Errors
/// A file of that name that is unreadable or not as its format demands, and where in it.
pub fn load_springs(source: &impl Source, rig: &Rig) -> Result<Springs, PackError> {
    let file = files::SPRINGS;
    let springs = read_text(source, file)?.map(|text| Springs::from_toml(&text, rig)).transpose();
    Ok(springs.map_err(|error| at(source, file, PackProblem::Toml(error)))?.unwrap_or_default())
}

fn load_identity(source: &impl Source) -> Result<Option<Identity>, PackError> {
    let file = files::IDENTITY;
    let identity = read_text(source, file)?.map(|text| Identity::from_toml(&text)).transpose();
    identity.map_err(|error| at(source, file, PackProblem::Toml(error)))
}

fn load_controls(source: &impl Source) -> Result<ControlTable, PackError> {
    let file = files::CONTROLS;
    match read_text(source, file)? {
        None => Ok(ControlTable::default_face()),
        Some(text) => {
            ControlTable::from_toml(&text).map_err(|error| at(source, file, PackProblem::Toml(error)))
        }
    }
}
