use crate::{PackError, PackProblem, SceneMotion, Sliders, Source, Warning};
use avatar_groom::Hair;
use avatar_look::{Material, Materials};
use avatar_mesh::{
    Bounds, FACE_BONES, FACE_PARTS, FACE_SHAPES, Follows, Mesh, MeshError, PartKind, PartSpec, Winding, raw,
};
use glam::Affine3A;
use pose_anim::{Binding, ClipSet, ControlTable, PoseSet};
use rig_core::{JointId, Rig};
use std::borrow::Cow;

/// The rig's file, under the two names that it has in the wild.
const RIG_FILES: [&str; 2] = ["Transformations.xml", "Transformationen.xml"];

/// A face, ready to be posed: everything of a pack but its textures.
#[derive(Clone, Debug)]
pub struct Pack {
    /// The joints.
    pub rig: Rig,
    /// The parts; of a pack in the raw format in the order of [`FACE_PARTS`].
    pub parts: Vec<Part>,
    /// What each bone index of the meshes means; in the raw format in the order of [`FACE_BONES`].
    pub palette: Vec<PaletteBone>,
    /// Names of the blend shapes, in the order of the blend weights.
    pub shapes: Vec<String>,
    /// What moves the shapes where they do not have a weight each of their own; packs in the raw format have none.
    pub sliders: Option<Sliders>,
    /// The controls, from `controls.toml` or the default table.
    pub controls: ControlTable,
    /// The controls, bound to this rig and to these sliders, or shapes where there are none.
    pub binding: Binding,
    /// The poses, from `poses.toml` or the default set.
    pub poses: PoseSet,
    /// Clips of controls, from `clips.toml`.
    pub clips: ClipSet,
    /// The looks of the parts, from `materials.toml` or the defaults.
    pub materials: Materials,
    /// The hair, from `hair.toml`; `None` where there is none of that name.
    pub hair: Option<Hair>,
    /// The clips of a file of an interchange format, of whole joints; packs in the raw format have none.
    pub motion: Option<SceneMotion>,
    /// Where an avatar is more than a face: the box around its head, or around what its shapes move, at bind pose in world space.
    pub face: Option<Bounds>,
    /// What was mended while loading.
    pub warnings: Vec<Warning>,
}

/// What a bone index of a mesh means: `X = T · joint_from_mesh`, with `T` the joint's world matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaletteBone {
    /// The joint.
    pub joint: JointId,
    /// From the space that the meshes' vertices are in to the joint's at bind pose: `W⁻¹` where meshes are in world space.
    pub joint_from_mesh: Affine3A,
}

/// One part of a face.
#[derive(Clone, Debug)]
pub struct Part {
    /// Name for people and for the command line.
    pub name: String,
    /// How it is drawn.
    pub kind: PartKind,
    /// Its valid mesh. Its shapes are the first of [`Pack::shapes`].
    pub mesh: Mesh,
    /// Bytes that it was read from.
    pub bytes: usize,
    /// For a rigid part the bone that it follows, as an index into [`Pack::palette`].
    pub bone: Option<usize>,
    /// Its looks, where the file that it comes from says them; else [`Pack::materials`] does.
    pub material: Option<Material>,
    /// The box around it at bind pose, in world space.
    pub bounds: Option<Bounds>,
}

/// The poses that a pack says, or the default set: what [`Pack::load`] takes for [`Pack::poses`], alone.
///
/// # Errors
/// A file of that name that is unreadable or not as its format demands, and where in it.
pub fn load_poses(source: &impl Source, controls: &ControlTable) -> Result<PoseSet, PackError> {
    match read_text(source, "poses.toml")? {
        None => Ok(PoseSet::default_face(controls)),
        Some(text) => PoseSet::from_toml(&text, controls)
            .map_err(|error| at(source, "poses.toml", PackProblem::Toml(error))),
    }
}

/// The clips that a pack says; none without `clips.toml`.
///
/// # Errors
/// A file of that name that is unreadable or not as its format demands, and where in it.
pub fn load_clips(source: &impl Source, controls: &ControlTable) -> Result<ClipSet, PackError> {
    match read_text(source, "clips.toml")? {
        None => Ok(ClipSet::default()),
        Some(text) => ClipSet::from_toml(&text, controls)
            .map_err(|error| at(source, "clips.toml", PackProblem::Toml(error))),
    }
}

impl Pack {
    /// Loads a pack in the raw format.
    ///
    /// # Errors
    /// The first file that is missing, unreadable or not as the format demands, and where in it.
    pub fn load(source: &impl Source) -> Result<Self, PackError> {
        let (rig_file, rig) = load_rig(source)?;
        let palette = load_palette(source, rig_file, &rig)?;
        let mut warnings = Vec::new();
        let parts = FACE_PARTS
            .iter()
            .map(|spec| load_part(source, *spec, &mut warnings))
            .collect::<Result<Vec<_>, _>>()?;

        let (controls, binding) = load_controls(source, &rig)?;
        let poses = load_poses(source, &controls)?;
        let clips = load_clips(source, &controls)?;
        let materials = load_materials(source)?;
        let hair = load_hair(source)?;
        let shapes = FACE_SHAPES.map(str::to_owned).into();
        Ok(Self {
            rig,
            parts,
            palette,
            shapes,
            sliders: None,
            controls,
            binding,
            poses,
            clips,
            materials,
            hair,
            motion: None,
            face: None,
            warnings,
        })
    }

    /// The part of this name.
    pub fn part(&self, name: &str) -> Option<&Part> {
        self.parts.iter().find(|part| part.name == name)
    }

    /// Whether a shape, by its place in [`Pack::shapes`], moves with controls that drive this name.
    pub fn follows(&self, shape: usize, driven: &str) -> bool {
        match &self.sliders {
            None => self.shapes.get(shape).is_some_and(|name| name == driven),
            Some(sliders) => {
                let followed = sliders.of_shapes.get(shape).map_or(&[][..], Vec::as_slice);
                followed.iter().any(|slider| sliders.names.get(*slider).is_some_and(|name| name == driven))
            }
        }
    }

    /// The looks of the part of this index; the default ones of skin where there is no such part.
    pub fn material(&self, part: usize) -> Material {
        match self.parts.get(part) {
            Some(part) => part.material.unwrap_or_else(|| self.materials.of(&part.name, part.kind)),
            None => Material::of(PartKind::Skin),
        }
    }

    /// The box around all parts at bind pose.
    pub fn bounds(&self) -> Option<Bounds> {
        self.parts.iter().filter_map(|part| part.bounds).reduce(Bounds::union)
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
    for name in RIG_FILES {
        if let Some(bytes) = read(source, name)? {
            let rig = Rig::from_xml(&bytes).map_err(|error| at(source, name, PackProblem::Rig(error)))?;
            return Ok((name, rig));
        }
    }
    Err(at(source, RIG_FILES[0], PackProblem::Missing(RIG_FILES.join(" or "))))
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
    let (vertex_file, index_file) = (format!("{}_VB.raw", spec.stem), format!("{}_IB.raw", spec.stem));
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
    let winding = Winding::of(&mesh);
    if winding.is_inside_out() {
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
        bytes: vertices.len() + indices.len(),
        bone,
        material: None,
    })
}

/// Reads the looks of a pack's parts: `materials.toml`, or the defaults where there is none. [`Pack::load`] calls it;
/// by itself it serves programs that take over a changed file while they run.
///
/// # Errors
/// A file that cannot be read, or that is not as its format demands, and where in it.
pub fn load_materials(source: &impl Source) -> Result<Materials, PackError> {
    let file = "materials.toml";
    match read_text(source, file)? {
        None => Ok(Materials::default()),
        Some(text) => Materials::from_toml(&text).map_err(|error| at(source, file, PackProblem::Look(error))),
    }
}

/// Reads which hair a pack has: `hair.toml`, or `None` where there is none. [`Pack::load`] calls it; by itself it serves
/// programs that take over a changed file while they run.
///
/// # Errors
/// A file that cannot be read, or that is not as its format demands, and where in it.
pub fn load_hair(source: &impl Source) -> Result<Option<Hair>, PackError> {
    let file = "hair.toml";
    let hair = read_text(source, file)?.map(|text| Hair::from_toml(&text)).transpose();
    hair.map_err(|error| at(source, file, PackProblem::Hair(error)))
}

fn load_controls(source: &impl Source, rig: &Rig) -> Result<(ControlTable, Binding), PackError> {
    let file = "controls.toml";
    let controls = match read_text(source, file)? {
        None => ControlTable::default_face(),
        Some(text) => {
            ControlTable::from_toml(&text).map_err(|error| at(source, file, PackProblem::Toml(error)))?
        }
    };
    let binding = controls.bind(rig, &FACE_SHAPES);
    let binding = binding.map_err(|error| at(source, file, PackProblem::Bind(error)))?;
    Ok((controls, binding))
}
